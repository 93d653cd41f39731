// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SCENEFILE_H
#define OSGSKINIMPORT_SCENEFILE_H 1

#include <assimp/DefaultIOSystem.h>

#include <string>
#include <utility>

namespace osgSkin {

/// The files that Assimp sees: those of the disk, and one whose content is given.
class SceneFile : public Assimp::DefaultIOSystem {
public:
    SceneFile(std::string name, std::string content)
        : _name(std::move(name)), _content(std::move(content)) {}

    bool Exists(const char* file) const override;
    Assimp::IOStream* Open(const char* file, const char* mode) override;

private:
    const std::string _name, _content;
};

} // namespace osgSkin

#endif
