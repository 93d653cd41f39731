// SPDX-License-Identifier: MIT
#pragma once

#include "Blending.h"

#include <osgSkin/SkinModel>
#include <osgSkinCharacter/Character>
#include <osgSkinCharacter/LoadOptions>

#include <glm/mat4x4.hpp>

#include <memory>
#include <string>
#include <vector>

namespace figures {

enum class Method {
    Linear,
    DualQuaternion,
    Plain, ///< ours without correctives: the paper's model alone
    Ours
};

/// A character with all that the figures ask of it. Points are in rest space.
class Body {
public:
    /// \param weights painted weights (JSON); empty: taken from the ratios, see weightsOf()
    /// \param options of the load; its progress is shown on stderr
    Body(const std::string& file, const std::string& weights, osgSkin::LoadOptions options = {});

    osgSkin::Character character;
    std::vector<std::uint32_t> triangles;
    float tension = 0.0f; ///< of all muscles, where there are any: 0 to 1

    const std::vector<glm::dvec3>& rest() const { return character.body.mesh.positions; }
    const osgSkin::BoundJoint& joint(std::size_t index) const {
        return character.binding.joints[index];
    }
    /// \throw std::runtime_error where the character has no such joint
    std::size_t find(const std::string& name) const;

    /// Skinning matrices with joint `joint` rotated by `degrees` and its subtree with it.
    std::vector<glm::dmat4> turned(std::size_t joint, const glm::dvec3& axis, double degrees) const;
    std::vector<glm::dvec3> deform(Method method, const std::vector<glm::dmat4>& skinning) const;

    /// The scene's frame: Z up, the figure facing -Y.
    glm::dvec3 toWorld(const glm::dvec3& v) const;
    glm::dvec3 fromWorld(const glm::dvec3& v) const;

private:
    osg::ref_ptr<const osgSkin::SkinModel> _model, _plain;
    compare::SkinWeights _weights;
};

/// A vertex's bend and twist ratio of a joint; zeros where it has none.
osgSkin::Influence influenceOf(const osgSkin::Binding& binding, std::size_t vertex,
                               std::size_t joint);

} // namespace figures
