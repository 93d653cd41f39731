// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_MISSINGTEXTURES_H
#define OSGSKINIMPORT_MISSINGTEXTURES_H 1

#include <set>
#include <string>
#include <utility>

namespace osgSkin {

/// Gathers the textures of a file that cannot be read, and says so in one notice when it goes.
class MissingTextures {
public:
    /// \param path of the file that names the textures
    explicit MissingTextures(std::string path) : _path(std::move(path)) {}
    ~MissingTextures();
    MissingTextures(const MissingTextures&) = delete;
    MissingTextures& operator=(const MissingTextures&) = delete;

    void add(const std::string& name) { _names.insert(name); }

private:
    const std::string _path;
    std::set<std::string> _names;
};

} // namespace osgSkin

#endif
