// SPDX-License-Identifier: MIT
#pragma once

#include "Tube.h"
#include "Turns.h"

#include <osgSkin/DeformableSkin>

#include <osg/Geometry>
#include <osgAnimation/Bone>
#include <osgAnimation/Skeleton>
#include <osgUtil/CullVisitor>

#include <gtest/gtest.h>

namespace test {

inline osg::ref_ptr<osg::Geometry> makeGeometry(const Tube& tube) {
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    const osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    for (std::size_t v = 0; v < tube.positions.size(); ++v) {
        vertices->push_back({tube.positions[v].x, tube.positions[v].y, tube.positions[v].z});
        normals->push_back({tube.normals[v].x, tube.normals[v].y, tube.normals[v].z});
    }
    geometry->setVertexArray(vertices);
    geometry->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    const unsigned int sides = 12;
    const osg::ref_ptr<osg::DrawElementsUInt> elements = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (unsigned int v = 0; v + sides < vertices->size(); ++v) {
        const unsigned int next = v % sides == sides - 1 ? v + 1 - sides : v + 1;
        for (const unsigned int corner : {v, v + sides, next, next, v + sides, next + sides})
            elements->push_back(corner);
    }
    geometry->addPrimitiveSet(elements);
    return geometry;
}

inline osg::ref_ptr<osgSkin::DeformableSkin> makeSkin() {
    const Tube tube;
    osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    skin->setSkin(makeGeometry(tube), tube.model());
    return skin;
}

/// Bends the middle joint by `angle` about x, but not the end joint.
inline void bend(osgSkin::DeformableSkin& skin, double angle) {
    const auto skinning =
        skinningFrom(skin.getModel()->joints(),
                     {glm::dquat(1, 0, 0, 0), glm::angleAxis(angle, glm::dvec3(1, 0, 0)),
                      glm::dquat(1, 0, 0, 0)});
    ASSERT_TRUE(skin.setPose(skinning.data(), skinning.size()));
}

/// Bones for the tube's three joints, in the rest pose.
inline osg::ref_ptr<osgAnimation::Skeleton> makeBones() {
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    osg::Group* parent = skeleton;
    double height = 0.0;
    for (const char* name : {"root", "middle", "end"}) {
        const osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone(name);
        bone->setMatrix(osg::Matrix::translate(0, height == 0.0 ? 0.0 : 2.0, 0));
        bone->setMatrixInSkeletonSpace(osg::Matrix::translate(0, height, 0));
        bone->setInvBindMatrixInSkeletonSpace(osg::Matrix::translate(0, -height, 0));
        parent->addChild(bone);
        parent = bone;
        height += 2.0;
    }
    return skeleton;
}

inline osgAnimation::Bone& middleOf(osgAnimation::Skeleton& skeleton) {
    return static_cast<osgAnimation::Bone&>(*skeleton.getChild(0)->asGroup()->getChild(0));
}

/// Rotates the middle one of these bones about its joint; the end bone moves with it.
inline void rotateMiddle(osgAnimation::Skeleton& skeleton, double angle,
                         const osg::Vec3d& axis = osg::Vec3d(1, 0, 0)) {
    osgAnimation::Bone& middle = middleOf(skeleton);
    auto& end = static_cast<osgAnimation::Bone&>(*middle.getChild(0));
    middle.setMatrixInSkeletonSpace(osg::Matrix::rotate(angle, axis) *
                                    osg::Matrix::translate(0, 2, 0));
    end.setMatrixInSkeletonSpace(osg::Matrix::translate(0, 2, 0) *
                                 middle.getMatrixInSkeletonSpace());
}

/// The angle by which the middle joint is bent.
inline double bendOf(const osgSkin::DeformableSkin& skin) {
    return skin.getPose().transform(1).split.bendAngle;
}

/// The vertices that would be drawn.
inline std::vector<osg::Vec3> verticesOf(const osgSkin::DeformableSkin& skin) {
    return static_cast<const osg::Vec3Array&>(*skin.getDeformedGeometry()->getVertexArray())
        .asVector();
}

/// One cull traversal over `node` with everything in view (or nothing).
inline void cull(osg::Node& node, bool inView) {
    const osg::ref_ptr<osgUtil::CullVisitor> visitor = new osgUtil::CullVisitor;
    const osg::ref_ptr<osgUtil::StateGraph> graph = new osgUtil::StateGraph;
    const osg::ref_ptr<osgUtil::RenderStage> stage = new osgUtil::RenderStage;
    visitor->setStateGraph(graph);
    visitor->setRenderStage(stage);
    visitor->pushViewport(new osg::Viewport(0, 0, 100, 100));
    visitor->pushProjectionMatrix(new osg::RefMatrix(osg::Matrix::perspective(60, 1, 0.1, 1000)));
    visitor->pushModelViewMatrix(new osg::RefMatrix(osg::Matrix::lookAt(
                                     osg::Vec3d(0, 3, inView ? 30 : -30),
                                     osg::Vec3d(0, 3, inView ? 0 : -60), osg::Vec3d(0, 1, 0))),
                                 osg::Transform::ABSOLUTE_RF);
    node.accept(*visitor);
}

} // namespace test
