// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SCENE_SCENEBIND_H
#define OSGSKINIMPORT_SCENE_SCENEBIND_H

#include "scene/SourceScene.h"

#include <glm/mat4x4.hpp>

#include <string>
#include <unordered_map>
#include <vector>

namespace osgSkin {

/// The bind pose of a scene, in the scene's own space.
///
/// Skins say where each bone was, seen from the mesh, when they were painted (offset matrices). The
/// topmost bone of a skin is taken to stand there as its node does; what hangs on it follows from
/// the offsets, which may differ from the nodes' pose (often the first sample of a motion). Where
/// that one is posed, too, the skin is bound where the node of its mesh has it. Nodes
/// that no skin names keep their transform under the node above, and so do bones without weights
/// whose offsets cannot be right: exporters list helpers with any matrix (see TrustedBones).
class SceneBind {
public:
    /// \param scene must outlive this
    explicit SceneBind(const SourceScene& scene);

    /// All nodes, parents before children, children in file order.
    const std::vector<const SourceNode*>& nodes() const { return _nodes; }

    /// The first node called `name`, null where there is none.
    const SourceNode* find(const std::string& name) const;

    /// The node above, null for the root.
    const SourceNode* parent(const SourceNode& node) const {
        return node.parent < 0 ? nullptr : &_scene.nodes[static_cast<std::size_t>(node.parent)];
    }

    /// One of a node's children, by what the node lists.
    const SourceNode& child(int index) const {
        return _scene.nodes[static_cast<std::size_t>(index)];
    }

    /// Whether some skin has this node for a bone.
    bool isBone(const SourceNode& node) const { return _isBone.at(&node); }

    /// From a node's own frame to the scene, in the bind pose.
    const glm::dmat4& node(const SourceNode& node) const { return _bind.at(&node); }

    /// The same in the pose of the nodes' own matrices.
    const glm::dmat4& posed(const SourceNode& node) const { return _posed.at(&node); }

    /// From the vertices of one of a node's meshes to the scene, in the bind pose. A skin stands
    /// where its bones put it, whatever node holds it.
    glm::dmat4 mesh(const SourceNode& node, std::size_t meshIndex) const;

private:
    void bindSkin(const std::vector<const SourceBone*>& bones, const glm::dmat4& meshToScene,
                  glm::dmat4& toScene);
    const SourceBone* topmost(const std::vector<const SourceBone*>& bones) const; ///< null for none
    glm::dmat4 bindFromAbove(const SourceNode& node) const;

    const SourceScene& _scene;
    std::vector<const SourceNode*> _nodes;
    std::unordered_map<std::string, const SourceNode*> _byName;
    std::unordered_map<const SourceNode*, int> _depth;
    std::unordered_map<const SourceNode*, bool> _isBone;
    std::unordered_map<const SourceNode*, glm::dmat4> _posed;
    std::unordered_map<const SourceNode*, glm::dmat4> _bind;
    std::unordered_map<std::size_t, glm::dmat4> _skins; ///< by the index of the mesh
};

} // namespace osgSkin

#endif
