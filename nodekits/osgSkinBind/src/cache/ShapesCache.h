// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_SHAPESCACHE_H
#define OSGSKINBIND_SHAPESCACHE_H

#include <osgSkin/Binding>

#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// Shapes that took long to make, and what was said about them.
struct MadeShapes {
    Correctives correctives;
    std::vector<std::string> notes;
};

/// A folder with a file for each digest of what shapes are made of. Any number of programs may use
/// it at once: files are written beside and renamed.
class ShapesCache {
public:
    /// \param folder made where it is missing; empty: nothing is found nor kept
    ShapesCache(std::string folder, const std::string& digest);

    /// \param binding that the shapes are for
    /// \param notes gets a line where there is a file that is no use
    /// \return nothing where there is no file, or no good one
    std::optional<MadeShapes> read(const Binding& binding, std::vector<std::string>& notes) const;

    /// \param notes gets a line where the file cannot be written
    void write(const MadeShapes& shapes, std::vector<std::string>& notes) const;

private:
    std::string _folder, _file, _digest;
};

} // namespace osgSkin

#endif
