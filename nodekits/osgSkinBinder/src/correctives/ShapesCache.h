// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_CORRECTIVES_SHAPESCACHE_H
#define OSGSKINBINDER_CORRECTIVES_SHAPESCACHE_H

#include <osgSkin/Binding>

#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// 36 letters, digits and hyphens (SHA-1, as a UUID of version 5).
std::string digestOf(const std::string& bytes);

/// Shapes, and the notes from making them.
struct MadeShapes {
    Correctives correctives;
    std::vector<std::string> notes;
};

/// A folder with a file for each digest of the input. A file contains that digest, the digest of
/// the rest, and the rest. Any number of programs may use the folder at once, since files are
/// written under another name and then renamed.
class ShapesCache {
public:
    /// \param folder is made if it is missing
    ShapesCache(const std::string& folder, const std::string& digest);

    /// \return nothing if there is no file, or no good one; the latter adds a note
    std::optional<MadeShapes> read(const Binding& binding, std::vector<std::string>& notes) const;

    /// Adds a note if the file cannot be written.
    void write(const MadeShapes& shapes, std::vector<std::string>& notes) const;

private:
    std::string _folder, _file, _digest;
};

} // namespace osgSkin

#endif
