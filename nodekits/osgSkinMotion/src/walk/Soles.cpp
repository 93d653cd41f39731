// SPDX-License-Identifier: MIT
#include "walk/Soles.h"

#include "walk/GaitCycle.h"

#include <osgSkin/DeformableSkin>

#include <osg/Geometry>
#include <osg/NodeVisitor>

#include <algorithm>
#include <vector>

namespace osgSkin {
namespace {

constexpr double kFootLength = 0.35; ///< leg lengths from the ankle to the end of a foot
constexpr double kSole = 0.04;       ///< leg lengths above the floor, of a sole's vertices

/// The vertices of a character in its rest pose.
class FindVertices : public osg::NodeVisitor {
public:
    FindVertices() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }

    void in(osg::Node& node, const osg::Matrixd& toSpace) {
        _toSpace = toSpace;
        node.accept(*this);
    }
    void apply(osg::Drawable& drawable) override {
        const auto* skin = dynamic_cast<const DeformableSkin*>(&drawable);
        const osg::Geometry* geometry = skin ? skin->getRestGeometry() : drawable.asGeometry();
        const auto* array =
            geometry ? dynamic_cast<const osg::Vec3Array*>(geometry->getVertexArray()) : nullptr;
        if (!array) return;
        const osg::Matrixd toSpace = osg::computeLocalToWorld(getNodePath()) * _toSpace;
        for (const osg::Vec3& vertex : *array) vertices.push_back(osg::Vec3d(vertex) * toSpace);
    }
    std::vector<osg::Vec3d> vertices; ///< the space of `toSpace`

private:
    osg::Matrixd _toSpace;
};

} // namespace

void measureSoles(const ClipCharacter& character, const osg::Matrixd& toSpace,
                  const osg::Vec3d& forward, double leg, std::array<RestFoot, 2>& feet) {
    const osg::Matrixd toRest = osg::Matrixd::inverse(character.toWorld());
    FindVertices find;
    for (const ClipCharacter::Skin& skin : character.skins())
        find.in(*skin.skin, skin.toWorld * toRest * toSpace);
    for (const ClipCharacter::Rigid& rigid : character.rigids())
        for (const osg::ref_ptr<osg::Node>& part : rigid.parts) find.in(*part, toSpace);
    for (std::size_t side = 0; side < feet.size(); ++side) {
        RestFoot& foot = feet[side];
        std::vector<osg::Vec3d> vertices;
        double floor = foot.ball.z();
        for (const osg::Vec3d& vertex : find.vertices) {
            const double away = flat(vertex - foot.ankle).length();
            if (vertex.z() > foot.ankle.z() || away > kFootLength * leg ||
                away > flat(vertex - feet[1 - side].ankle).length())
                continue;
            vertices.push_back(vertex);
            floor = std::min(floor, vertex.z());
        }
        double rear = foot.ball * forward, front = rear;
        for (const osg::Vec3d& vertex : vertices) {
            if (vertex.z() > floor + kSole * leg) continue;
            rear = std::min(rear, vertex * forward);
            front = std::max(front, vertex * forward);
        }
        const auto onFloor = [&](const osg::Vec3d& beside, double ahead) {
            osg::Vec3d place = beside + forward * (ahead - beside * forward);
            place.z() = floor;
            return place;
        };
        foot.heel = onFloor(foot.ankle, rear);
        foot.tip = onFloor(foot.ball, front);
    }
}

} // namespace osgSkin
