// SPDX-License-Identifier: MIT
//
// Morph targets of a scene's meshes, as its readers make them.
#ifndef OSGSKINIMPORT_SCENE_SCENEMORPHS_H
#define OSGSKINIMPORT_SCENE_SCENEMORPHS_H

#include "files/UniqueName.h"
#include "scene/SourceScene.h"

#include <osgSkin/MorphTargets>

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace osgSkin {

/// Names the morph targets of a scene. Targets of several meshes that have the same name (face,
/// teeth and lashes) become one, unless they begin with different weights.
class MorphNames {
public:
    /// \param taken names that targets of meshes do not get, such as those of expressions
    explicit MorphNames(const std::vector<std::string>& taken = {});

    /// Names for the targets of one mesh, each a name of its own.
    ///
    /// \param wanted the file's names
    /// \param initial a weight each, finite
    std::vector<std::string> of(const std::vector<std::string>& wanted,
                                const std::vector<float>& initial);

    /// Reports targets that did not get the name of the file.
    void warnRenamed(const std::string& path) const;

private:
    /// The file's name, which of the mesh's targets of that name it is, and the initial weight.
    using Key = std::tuple<std::string, std::size_t, float>;
    std::map<Key, std::string> _known;
    UniqueNames _taken;
    std::size_t _renamed = 0;
    std::string _first; ///< that did not get its name
};

/// Gives targets of several meshes that share a name, but that animations move differently, names
/// of their own, and reports them.
void separateMorphs(SourceScene& scene, const std::string& path);

/// Offsets of vertices, or changes of their normals or tangents.
struct VertexOffsets {
    std::vector<std::uint32_t> vertices; ///< increasing
    std::vector<glm::vec3> offsets;      ///< of each
};

/// Fills in morph targets of one mesh.
class MorphFiller {
public:
    /// \param mesh with its positions
    explicit MorphFiller(const SourceMesh& mesh);

    /// Sets a target's vertices, without those that are moved by no more than rounding.
    void fill(const VertexOffsets& positions, const VertexOffsets& normals,
              const VertexOffsets& tangents, MorphTarget& target) const;

private:
    float _rounding = 0.0f; ///< of the mesh's coordinates
};

/// The sum of some targets of one mesh, each times a weight.
/// \param parts not null
MorphTarget sumOf(const std::vector<std::pair<const MorphTarget*, double>>& parts);

} // namespace osgSkin

#endif
