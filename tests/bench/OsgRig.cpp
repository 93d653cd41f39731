// SPDX-License-Identifier: MIT
#include "OsgRig.h"

#include <osgSkin/GlmOsg>
#include <osgSkinRig/ApplyFrame>
#include <osgSkinRig/MakeSkeleton>

#include <osgAnimation/RigTransformSoftware>

#include <glm/geometric.hpp>

#include <algorithm>

namespace bench {
namespace {

osg::ref_ptr<osg::Vec3Array> toArray(const std::vector<glm::vec3>& vectors) {
    osg::ref_ptr<osg::Vec3Array> array =
        new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, static_cast<unsigned int>(vectors.size()));
    std::copy(vectors.begin(), vectors.end(), osgSkin::asGlm(array->asVector().data()));
    return array;
}

} // namespace

OsgRig::OsgRig(const Body& body)
    : _body(body), _skeleton(osgSkin::makeSkeleton(body.rig)), _rig(new osgAnimation::RigGeometry) {
    const osg::ref_ptr<osg::Geometry> source = new osg::Geometry;
    source->setVertexArray(toArray(body.positions));
    source->setNormalArray(toArray(body.normals));
    source->addPrimitiveSet(new osg::DrawElementsUInt(
        GL_TRIANGLES, static_cast<unsigned int>(body.triangles.size()), body.triangles.data()));
    const osg::ref_ptr<osgAnimation::VertexInfluenceMap> map = new osgAnimation::VertexInfluenceMap;
    for (unsigned int v = 0; v < body.weights.vertices.size(); ++v)
        for (const auto& [joint, weight] : body.weights.vertices[v]) {
            osgAnimation::VertexInfluence& influence = (*map)[body.binding.joints[joint].name];
            influence.setName(body.binding.joints[joint].name);
            influence.emplace_back(v, weight);
        }
    _rig->setInfluenceMap(map);
    _rig->setSourceGeometry(source);
    _rig->setRigTransformImplementation(new osgAnimation::RigTransformSoftware);
    _skeleton->addChild(_rig);
    // The first update finds the skeleton and groups the vertices.
    osgAnimation::UpdateRigGeometry().update(nullptr, _rig);
}

void OsgRig::pose(std::size_t frame) {
    osgSkin::applyFrame(_body.clip, _body.rig, frame, *_skeleton);
}

double OsgRig::error(std::size_t frame) const {
    const auto& skinned = static_cast<const osg::Vec3Array&>(*_rig->getVertexArray());
    double worst = 0.0;
    for (std::size_t v = 0; v < _body.positions.size(); ++v) {
        glm::dvec3 sum(0.0);
        for (const auto& [joint, weight] : _body.weights.vertices[v])
            sum += static_cast<double>(weight) *
                   glm::dvec3(_body.skinning[frame][joint] *
                              glm::dvec4(glm::dvec3(_body.positions[v]), 1.0));
        worst = std::max(
            worst,
            glm::distance(sum, osgSkin::toGlm(osg::Vec3d(skinned[static_cast<unsigned int>(v)]))));
    }
    return worst;
}

} // namespace bench
