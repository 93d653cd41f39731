// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_ASSIMPMATERIALS_H
#define OSGSKINIMPORT_ASSIMPMATERIALS_H 1

#include "mesh/Material.h"

#include <osgDB/Options>

#include <assimp/scene.h>

#include <glm/vec4.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace osgSkin {

/// An Assimp scene's materials, and the colours of its vertices where it has any.
class AssimpMaterials {
public:
    /// Textures are read from beside `path`, or out of the scene's own file.
    AssimpMaterials(const aiScene& scene, const std::string& path, const osgDB::Options* options);

    /// A state set for each material, and one for meshes without.
    const std::vector<osg::ref_ptr<osg::StateSet>>& stateSets() const { return _stateSets; }

    /// The index of a mesh's state set.
    std::uint32_t indexOf(const aiMesh& mesh) const;

    /// Which of the mesh's sets of texture coordinates its texture takes.
    unsigned texCoordsOf(const aiMesh& mesh) const;

    /// Whether some mesh has vertex colours; then all have, some of them their material's.
    bool hasColours() const { return _hasColours; }

    /// A vertex's colour in sRGB; its material's where it has none of its own.
    glm::vec4 colour(const aiMesh& mesh, unsigned vertex) const;

private:
    std::vector<Material> _materials;
    std::vector<unsigned> _texCoords;
    std::vector<bool> _isLinear; ///< glTF's colours are, and are multiplied
    std::vector<osg::ref_ptr<osg::StateSet>> _stateSets;
    bool _hasColours = false;
};

} // namespace osgSkin

#endif
