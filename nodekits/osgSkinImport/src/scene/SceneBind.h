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
/// A skin's offset matrices give each bone's bind transform relative to the mesh. The topmost bone
/// of a skin is assumed to be bound where its node is; bones below it follow from the offsets,
/// which may differ from the nodes' pose (often the first frame of a motion). If the topmost node
/// is posed as well, the skin is bound at the node of its mesh. Nodes that are not bones keep their
/// transform relative to their parent. So do unweighted bones whose offsets cannot be right,
/// because exporters list helper bones with arbitrary matrices (see reliableInverseBinds()).
class SceneBind {
public:
    /// \param scene must outlive this
    explicit SceneBind(const SourceScene& scene);

    /// All nodes, parents before children, children in file order.
    const std::vector<const SourceNode*>& nodes() const { return _nodes; }

    /// The first node called `name`; null if there is none.
    const SourceNode* find(const std::string& name) const;

    /// The parent node; null for the root.
    const SourceNode* parent(const SourceNode& node) const {
        return node.parent < 0 ? nullptr : &_scene.nodes[static_cast<std::size_t>(node.parent)];
    }

    /// A child node, by its index in SourceNode::children.
    const SourceNode& child(int index) const {
        return _scene.nodes[static_cast<std::size_t>(index)];
    }

    /// Whether the node is a bone of some skin.
    bool isBone(const SourceNode& node) const { return _isBone.at(&node); }

    /// From a node's own frame to the scene, in the bind pose.
    const glm::dmat4& node(const SourceNode& node) const { return _bind.at(&node); }

    /// The same, in the pose of the nodes' own matrices.
    const glm::dmat4& posed(const SourceNode& node) const { return _posed.at(&node); }

    /// From the vertices of one of a node's meshes to the scene, in the bind pose. A skinned mesh
    /// is placed by its bones, whatever its node.
    glm::dmat4 mesh(const SourceNode& node, std::size_t meshIndex) const;

private:
    void bindSkin(const std::vector<const SourceBone*>& bones, const glm::dmat4& meshToScene,
                  glm::dmat4& toScene);
    const SourceBone* topmost(const std::vector<const SourceBone*>& bones) const; ///< may be null
    glm::dmat4 bindFromAbove(const SourceNode& node) const;

    const SourceScene& _scene;
    std::vector<const SourceNode*> _nodes;
    std::unordered_map<std::string, const SourceNode*> _byName;
    std::unordered_map<const SourceNode*, int> _depth;
    std::unordered_map<const SourceNode*, bool> _isBone;
    std::unordered_map<const SourceNode*, glm::dmat4> _posed;
    std::unordered_map<const SourceNode*, glm::dmat4> _bind;
    std::unordered_map<std::size_t, glm::dmat4> _skins; ///< by mesh
};

} // namespace osgSkin

#endif
