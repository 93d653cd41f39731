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
    Plain, ///< osgSkin without correctives: the paper's model
    Ours
};

/// Loads a character and shows the progress on stderr.
/// \throw osgSkin::Error with the file and the reason
osgSkin::Character load(const std::string& file, osgSkin::LoadOptions options);

/// A character and the methods that can deform it. Points are in rest space.
class Body {
public:
    /// \param loaded with a body, see osgSkin::Character::hasBody()
    /// \param weights file of painted weights (JSON); if empty, they are computed from the ratios
    /// \throw osgSkin::Error with the file and the reason
    Body(osgSkin::Character loaded, const std::string& weights);

    osgSkin::Character character;
    std::vector<std::uint32_t> triangles;
    float tension = 0.0f; ///< of all muscles, 0 to 1

    const std::vector<glm::dvec3>& rest() const { return character.body.mesh.positions; }
    const osgSkin::BoundJoint& joint(std::size_t index) const {
        return character.binding.joints[index];
    }

    /// \param name of a joint, or else its role, such as "LeftLowerArm"
    /// \throw osgSkin::Error if the character has no such joint
    std::size_t find(const std::string& name) const;

    /// Skinning matrices that rotate a joint and its subtree by `degrees`.
    std::vector<glm::dmat4> turned(std::size_t joint, const glm::dvec3& axis, double degrees) const;
    std::vector<glm::dvec3> deform(Method method, const std::vector<glm::dmat4>& skinning) const;

    /// The length of its longest side in the scene.
    double size() const { return character.body.mesh.size() * character.metresPerUnit(); }

    /// Converts to the scene's frame: Z up, the figure facing -Y.
    glm::dvec3 toWorld(const glm::dvec3& v) const;
    glm::dvec3 fromWorld(const glm::dvec3& v) const;

private:
    osg::ref_ptr<const osgSkin::SkinModel> _model, _plain;
    compare::SkinWeights _weights;
};

/// The bend and twist ratio of a vertex for a joint; zeros if the joint does not influence it.
osgSkin::Influence influenceOf(const osgSkin::Binding& binding, std::size_t vertex,
                               std::size_t joint);

} // namespace figures
