// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SAVEDIMAGE_H
#define OSGSKINIMPORT_SAVEDIMAGE_H 1

#include "pictures/PictureCheck.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace osgSkin {

class SavedInput;

/// A picture within a saved file, followed while OSG reads it: its size must be that of its data,
/// which OSG does not compare.
///
/// After its write hint come its kind and, of one with its data in the file: origin, width, height,
/// depth, internal format, pixel format, data type, packing, how its memory was taken; then in
/// binary files its bytes, their number first, and where the smaller levels begin; in text files
/// the number of levels and a text for each.
class SavedImage {
public:
    /// \param shared what its files count together with; null: with none
    SavedImage(const ReadLimits& limits, SharedPictures* shared) : _pictures(limits, shared) {}

    void tookProperty(const std::string& name);
    /// A picture that is a whole file within this one is looked at where its size is told: OSG
    /// takes memory for it next, which it would lose.
    /// \param rest of the saved file, behind the number
    /// \return the number for OSG to see
    std::int64_t tookNumber(std::int64_t number, std::string_view rest, SavedInput& input);
    void tookText(const std::string& text, SavedInput& input);

    /// Between a picture's class and its file's name.
    bool isNamed() const { return _named; }
    /// While its data are read.
    bool isOpen() const { return _open; }

private:
    void checkSize(SavedInput& input, std::uint64_t level, double bytes) const;
    void checkFile(std::string_view bytes);

    std::vector<std::int64_t> _numbers; ///< since the write hint
    std::uint64_t _texts = 0;           ///< of these, read
    bool _named = false, _fileName = false, _open = false;
    std::string _name; ///< of the picture's file
    PictureCheck _pictures;
};

} // namespace osgSkin

#endif
