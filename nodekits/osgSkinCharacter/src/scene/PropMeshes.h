// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinImport/ImportMesh>

#include <osg/ref_ptr>
#include <osgDB/Options>

#include <map>
#include <string>

namespace osgSkin {

/// The meshes of a character's props: each file is read once, and props of the same share it.
class PropMeshes {
public:
    /// \param options for the meshes; may be null
    explicit PropMeshes(const osgDB::Options* options) : _options(options) {}

    /// \throw Error with the file and the place in it
    const ImportedMesh& of(const std::string& file);

private:
    const osg::ref_ptr<const osgDB::Options> _options;
    std::map<std::string, ImportedMesh> _meshes; ///< by path
};

} // namespace osgSkin
