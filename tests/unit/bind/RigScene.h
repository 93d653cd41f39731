// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "Shapes.h"

#include <osgSkin/GlmOsg>

#include <osg/FrameStamp>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>
#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/UpdateBone>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

/// osgAnimation rigs in a scene: a cylinder over a chain of three bones.
namespace rigs {

inline const std::array<double, 3> kHeights{0.6, 3.0, 5.5};

/// The painted weights of a vertex at a height, one per bone.
using Paint = std::array<float, 3> (*)(double height);

inline std::array<float, 3> rigid(double height) {
    return {height < 3.0 ? 1.0f : 0.0f, height >= 3.0 && height < 5.5 ? 1.0f : 0.0f,
            height >= 5.5 ? 1.0f : 0.0f};
}

inline std::array<float, 3> blended(double height) {
    const auto share = [height](double at) {
        return float(std::clamp(height - at + 0.5, 0.0, 1.0));
    };
    const float low = share(3.0), high = share(5.5);
    return {1.0f - low, low - high, high};
}

/// A cylinder as an osgAnimation rig over a chain of three bones.
inline osg::ref_ptr<osgAnimation::RigGeometry> makeRig(Paint paint,
                                                       const std::string& name = "rig") {
    const osgSkin::SkinMesh mesh = shapes::cylinder();
    const osg::ref_ptr<osg::Geometry> source = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    const osg::ref_ptr<osg::Vec2Array> texCoords = new osg::Vec2Array;
    const osg::ref_ptr<osgAnimation::VertexInfluenceMap> map = new osgAnimation::VertexInfluenceMap;
    for (const glm::dvec3& p : mesh.positions) {
        const std::array<float, 3> weights = paint(p.y);
        for (std::size_t b = 0; b < 3; ++b)
            if (weights[b] > 0.0f)
                (*map)["bone" + std::to_string(b)].emplace_back(unsigned(vertices->size()),
                                                                weights[b]);
        vertices->push_back(osg::Vec3(osgSkin::toOsg(p)));
        texCoords->push_back(osg::Vec2(float(vertices->size()), 0.5f));
    }
    const std::vector<std::uint32_t> corners = mesh.triangles();
    source->setVertexArray(vertices);
    source->setTexCoordArray(0, texCoords, osg::Array::BIND_PER_VERTEX);
    source->addPrimitiveSet(
        new osg::DrawElementsUInt(GL_TRIANGLES, unsigned(corners.size()), corners.data()));
    osg::ref_ptr<osgAnimation::RigGeometry> rig = new osgAnimation::RigGeometry;
    rig->setName(name);
    rig->setSourceGeometry(source);
    rig->setInfluenceMap(map);
    return rig;
}

struct Scene {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    std::vector<osg::ref_ptr<osgAnimation::Bone>> bones;

    Scene() {
        skeleton->setDefaultUpdateCallback();
        root->addChild(skeleton);
        osg::Group* above = skeleton;
        double below = 0.0;
        for (std::size_t b = 0; b < kHeights.size(); ++b) {
            const std::string name = "bone" + std::to_string(b);
            bones.push_back(new osgAnimation::Bone(name));
            const osg::ref_ptr<osgAnimation::UpdateBone> update =
                new osgAnimation::UpdateBone(name);
            update->getStackedTransforms().push_back(new osgAnimation::StackedMatrixElement(
                "matrix", osg::Matrix::translate(0, kHeights[b] - below, 0)));
            bones.back()->setUpdateCallback(update);
            bones.back()->setInvBindMatrixInSkeletonSpace(
                osg::Matrix::translate(0, -kHeights[b], 0));
            above->addChild(bones.back());
            above = bones.back();
            below = kHeights[b];
        }
    }

    /// Rotates and moves the bones, and updates the skins with an update traversal.
    void pose(const std::vector<osg::Quat>& turns, const osg::Vec3d& step) {
        double below = 0.0;
        for (std::size_t b = 0; b < bones.size(); ++b) {
            auto& update = dynamic_cast<osgAnimation::UpdateBone&>(*bones[b]->getUpdateCallback());
            auto& element = static_cast<osgAnimation::StackedMatrixElement&>(
                *update.getStackedTransforms().front());
            element.setMatrix(osg::Matrix::rotate(turns[b]) *
                              osg::Matrix::translate(0, kHeights[b] - below, 0) *
                              osg::Matrix::translate(b == 0 ? step : osg::Vec3d()));
            below = kHeights[b];
        }
        const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        osgUtil::UpdateVisitor visitor;
        visitor.setFrameStamp(stamp);
        root->accept(visitor);
    }

    osg::Matrixd skinning(std::size_t bone) const {
        return bones[bone]->getInvBindMatrixInSkeletonSpace() *
               bones[bone]->getMatrixInSkeletonSpace();
    }
};

inline const osg::Vec3Array& verticesOf(const osg::Geometry& geometry) {
    return static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
}

/// The source vertex of a skin's vertex, read from its texture coordinate.
inline std::size_t sourceOf(const osg::Geometry& geometry, std::size_t vertex) {
    const auto& coordinates = static_cast<const osg::Vec2Array&>(*geometry.getTexCoordArray(0));
    return std::size_t(coordinates[vertex].x()) - 1;
}

} // namespace rigs
