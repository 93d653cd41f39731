// SPDX-License-Identifier: MIT
#include "crowd/CrowdMembers.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>

#include <osg/BufferObject>

#include <algorithm>
#include <cmath>
#include <string>

namespace osgSkin {
namespace {

constexpr float kLargestScale = 1e9f; ///< as of poses

/// For shaders, which have single precision.
bool areFinite(std::initializer_list<double> numbers) {
    return std::all_of(numbers.begin(), numbers.end(),
                       [](double x) { return std::isfinite(static_cast<float>(x)); });
}

/// So that no vertex and no sphere is infinite.
bool isPlaceable(const CrowdInstance& one) {
    const glm::dvec3 position(one.position.x(), one.position.y(), one.position.z());
    return isInRange(position) && std::abs(one.scale) <= kLargestScale &&
           std::abs(one.rotation.length2() - 1.0) <= 0.02; // false for NaN
}

bool isPlayable(const CrowdInstance& one) {
    const osg::Vec4d colour(one.colour);
    return areFinite({one.phase, double(one.speed), one.otherPhase, double(one.otherSpeed),
                      colour.x(), colour.y(), colour.z(), colour.w()}) &&
           one.blend >= 0.0f && one.blend <= 1.0f;
}

} // namespace

void checkMembers(const CrowdCharacter& character, const std::vector<CrowdInstance>& instances) {
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const CrowdInstance& one = instances[i];
        const std::string label = "crowd: member " + std::to_string(i);
        for (const unsigned int clip : {one.clip, one.blend != 0.0f ? one.otherClip : 0u})
            if (clip >= character.clipCount())
                throw Error(label + " plays clip " + std::to_string(clip) +
                            ", expected less than " + std::to_string(character.clipCount()));
        if (!isPlaceable(one))
            throw Error(label + " is beyond 1e18, scaled by more than 1e9 or turned by no unit "
                                "quaternion");
        if (!isPlayable(one))
            throw Error(label + " has a number that is not finite, or a blend beyond 0..1");
    }
}

CrowdMembers::CrowdMembers(const CrowdCharacter& character,
                           const std::vector<CrowdInstance>& instances, double since)
    : _character(character), _since(since), _texels(new osg::Vec4uiArray) {
    const osg::ref_ptr<osg::VertexBufferObject> buffer = new osg::VertexBufferObject;
    buffer->setUsage(GL_DYNAMIC_DRAW_ARB);
    _texels->setVertexBufferObject(buffer);
    _texels->resize(std::max<std::size_t>(1, instances.size()) * CrowdInstance::kTexels);
    _texture = new osg::TextureBuffer(_texels);
    _texture->setInternalFormat(GL_RGBA32UI_EXT);
    set(instances);
}

void CrowdMembers::set(const std::vector<CrowdInstance>& instances) {
    _instances = instances;
    pack();
    findSpheres();
}

void CrowdMembers::setSince(double seconds) {
    _since = seconds;
    pack();
}

double CrowdMembers::phaseOf(unsigned int clip, double phase, float speed) const {
    const double at = phase + double(speed) * _since;
    const double loop = clip < _character.clipCount() ? _character.loopSeconds(clip) : 0.0;
    return loop > 0.0 ? at - loop * std::floor(at / loop) : at;
}

void CrowdMembers::pack() {
    for (std::size_t i = 0; i < _instances.size(); ++i) {
        CrowdInstance one = _instances[i];
        one.phase = phaseOf(one.clip, one.phase, one.speed);
        one.otherPhase = phaseOf(one.otherClip, one.otherPhase, one.otherSpeed);
        one.pack(&(*_texels)[i * CrowdInstance::kTexels]);
    }
    _texels->dirty();
}

void CrowdMembers::findSpheres() {
    const osg::Vec3d centre = _character.bounds().center();
    const float radius = _character.bounds().radius();
    _spheres.clear();
    _box.init();
    for (const CrowdInstance& one : _instances) {
        const osg::Vec3f place(one.position + one.rotation * (centre * double(one.scale)));
        _spheres.emplace_back(place, radius * std::abs(one.scale));
        _box.expandBy(osg::BoundingSphere(place, _spheres.back().w()));
    }
}

} // namespace osgSkin
