// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SCENEBIND_H
#define OSGSKINIMPORT_SCENEBIND_H 1

#include <assimp/scene.h>

#include <glm/mat4x4.hpp>

#include <string>
#include <unordered_map>
#include <vector>

namespace osgSkin {

/// The bind pose of an Assimp scene, in the scene's own space.
///
/// Skins say where each bone was, seen from the mesh, when they were painted (offset matrices). The
/// topmost bone of a skin is taken to stand there as its node does; what hangs on it follows from
/// the offsets, which may differ from the nodes' pose (often the first sample of a motion). Where
/// that one is posed, too, the skin is bound where the node of its mesh has it. Nodes
/// that no skin names keep their transform under the node above, and so do bones without weights
/// whose offsets cannot be right: exporters list helpers with any matrix (see TrustedBones).
class SceneBind {
public:
    explicit SceneBind(const aiScene& scene);

    /// All nodes, parents before children, children in file order.
    const std::vector<const aiNode*>& nodes() const { return _nodes; }

    /// The first node called `name`, null where there is none.
    const aiNode* find(const std::string& name) const;

    /// The node above, null for the root. Not every reader of Assimp's sets aiNode::mParent.
    const aiNode* parent(const aiNode& node) const { return _parent.at(&node); }

    /// Whether some skin has this node for a bone.
    bool isBone(const aiNode& node) const { return _isBone.at(&node); }

    /// From a node's own frame to the scene, in the bind pose.
    const glm::dmat4& node(const aiNode& node) const { return _bind.at(&node); }

    /// The same in the pose of the nodes' own matrices.
    const glm::dmat4& posed(const aiNode& node) const { return _posed.at(&node); }

    /// From the vertices of one of a node's meshes to the scene, in the bind pose. A skin stands
    /// where its bones put it, whatever node holds it.
    glm::dmat4 mesh(const aiNode& node, unsigned meshIndex) const;

private:
    void bindSkin(const std::vector<const aiBone*>& bones, const glm::dmat4& meshToScene,
                  glm::dmat4& toScene);
    const aiBone* topmost(const std::vector<const aiBone*>& bones) const; ///< null for none
    glm::dmat4 bindFromAbove(const aiNode& node) const;

    std::vector<const aiNode*> _nodes;
    std::unordered_map<std::string, const aiNode*> _byName;
    std::unordered_map<const aiNode*, const aiNode*> _parent;
    std::unordered_map<const aiNode*, int> _depth;
    std::unordered_map<const aiNode*, bool> _isBone;
    std::unordered_map<const aiNode*, glm::dmat4> _posed;
    std::unordered_map<const aiNode*, glm::dmat4> _bind;
    std::unordered_map<unsigned, glm::dmat4> _skins; ///< by the index of the mesh
};

std::string nameOf(const aiNode& node);
std::string nameOf(const aiBone& bone);

} // namespace osgSkin

#endif
