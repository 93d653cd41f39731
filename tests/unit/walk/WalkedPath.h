// SPDX-License-Identifier: MIT
// Moves a transform above a walker frame by frame, and looks at its feet.
#pragma once

#include "FindNodes.h"
#include "WalkingFigure.h"

#include <osgSkin/DeformableSkin>
#include <osgSkinMotion/Walker>

#include <osg/FrameStamp>
#include <osg/MatrixTransform>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace walking {

using Vertices = std::vector<osg::Vec3d>;

/// The skin's vertices, in the space of the node at the top of the walker's parents.
inline Vertices verticesOf(osg::Node& top) {
    Vertices result;
    for (const auto& found : test::findNodes<osgSkin::DeformableSkin>(top)) {
        const osg::Matrixd& place = found.toWorld;
        const auto& array = static_cast<const osg::Vec3Array&>(
            *found.node->getDeformedGeometry()->getVertexArray());
        for (const osg::Vec3& vertex : array) result.push_back(osg::Vec3d(vertex) * place);
    }
    return result;
}

inline double difference(const Vertices& a, const Vertices& b) {
    double most = a.size() == b.size() ? 0.0 : 1e9;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        most = std::max(most, (a[i] - b[i]).length());
    return most;
}

/// A transform with a walker below it, in frames of an update traversal.
struct Walk {
    explicit Walk(const osg::ref_ptr<osgSkin::Walker>& figure = makeFigureWalker())
        : walker(figure) {
        transform->addChild(walker);
    }

    osg::ref_ptr<osgSkin::Walker> walker;
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform;
    unsigned int frame = 0;
    double time = 0.0;

    /// One frame in which the figure is at a place, looking in a direction.
    void show(const osg::Vec3d& position, double heading, double dt,
              const osg::Vec3d& scale = osg::Vec3d(1, 1, 1)) {
        transform->setMatrix(osg::Matrixd::scale(scale) *
                             osg::Matrixd::rotate(heading, osg::Vec3d(0, 0, 1)) *
                             osg::Matrixd::translate(position));
        const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        stamp->setFrameNumber(++frame);
        stamp->setSimulationTime(time += dt);
        osgUtil::UpdateVisitor visitor;
        visitor.setFrameStamp(stamp);
        transform->accept(visitor);
    }

    std::array<osg::Vec3d, 2> balls() {
        const Vertices vertices = verticesOf(*transform);
        const osgSkin::RestSkeleton rig = figureRig();
        return {vertices[3 * jointOf(rig, "LeftFoot")], vertices[3 * jointOf(rig, "RightFoot")]};
    }
};

/// How a figure moves: its speed and turning at a time.
struct Course {
    std::function<double(double)> speed = [](double) { return 1.4; };
    std::function<double(double)> turn = [](double) { return 0.0; };
    double seconds = 6.0;
};

/// How far the feet slide on the floor, as a share of the way.
inline double slideOn(const Course& course, double dt) {
    Walk walk;
    osg::Vec3d position;
    double heading = 0.0, way = 0.0, slide = 0.0;
    std::array<osg::Vec3d, 2> before;
    std::array<bool, 2> wasLow{};
    for (double t = 0.0; t < course.seconds; t += dt) {
        const double step = course.speed(t) * dt;
        heading += course.turn(t) * dt;
        position += osg::Vec3d(std::cos(heading), std::sin(heading), 0.0) * step;
        way += std::abs(step);
        walk.show(position, heading, dt);
        const std::array<osg::Vec3d, 2> now = walk.balls();
        for (std::size_t side = 0; side < now.size(); ++side) {
            const bool isLow = now[side].z() < 0.01;
            if (isLow && wasLow[side])
                slide +=
                    std::hypot(now[side].x() - before[side].x(), now[side].y() - before[side].y());
            wasLow[side] = isLow;
        }
        before = now;
    }
    return slide / way;
}

} // namespace walking
