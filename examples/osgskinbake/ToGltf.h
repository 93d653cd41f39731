// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinCharacter/Character>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

namespace bake {

/// From rest space to glTF's: metres, Y up, facing +Z.
class ToGltf {
public:
    explicit ToGltf(const osgSkin::Character& character) : _scale(character.metresPerUnit()) {
        glm::dmat3 rotation;
        for (int axis = 0; axis < 3; ++axis) {
            osg::Vec3d unit;
            unit[axis] = 1.0;
            const osg::Vec3d world =
                osg::Matrixd::transform3x3(unit, character.toWorld) / _scale; // Z up, facing -Y
            rotation[axis] = {world.x(), world.z(), -world.y()};
        }
        _rotation = glm::normalize(glm::quat_cast(rotation));
    }
    double scale() const { return _scale; }
    glm::dvec3 direction(const glm::dvec3& v) const { return _rotation * v; }
    glm::dvec3 vector(const glm::dvec3& v) const { return _scale * direction(v); }
    glm::dquat rotation(const glm::dquat& q) const {
        return _rotation * q * glm::conjugate(_rotation);
    }

private:
    double _scale;
    glm::dquat _rotation;
};

} // namespace bake
