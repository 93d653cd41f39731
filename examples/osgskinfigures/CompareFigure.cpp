// SPDX-License-Identifier: MIT
#include "CompareFigure.h"

#include "Drawing.h"

#include <glm/geometric.hpp>

namespace figures {
namespace {

constexpr int kSize = 400;

/// A joint turned alone, seen from close by. Directions are the scene's: Z up, facing -Y.
struct Shot {
    const char* name;
    const char* joint;
    double degrees;
    glm::dvec3 axis;  ///< zero: the fold between the bone above and the bone; see axisOf()
    bool twist;       ///< about the bone above
    glm::dvec3 eye;   ///< direction from the joint to the camera
    double distance;  ///< in body sizes
    glm::dvec3 aside; ///< from the joint to the picture's middle, in body sizes
};

const Shot kShots[] = {
    {"shoulder", "LeftArm", 95.0, {0, -1, 0}, false, {0.15, -1.0, 0.1}, 0.85, {-0.02, 0, 0.0}},
    {"elbow", "LeftForeArm", 115.0, {0, 0, 0}, false, {0.55, -1.0, 0.55}, 0.68, {-0.055, 0, 0}},
    {"wrist", "LeftHand", 160.0, {0, 0, 0}, true, {0.1, -1.0, 0.3}, 0.5, {0, 0, 0}},
    {"hip", "LeftUpLeg", -95.0, {1, 0, 0}, false, {1.0, -0.75, 0.25}, 0.95, {0, -0.06, 0.03}},
    {"knee", "LeftLeg", 120.0, {1, 0, 0}, false, {1.0, 0.25, 0.1}, 0.7, {0, 0.04, 0.03}},
};

glm::dvec3 axisOf(const Body& body, const Shot& shot, std::size_t joint) {
    const osgSkin::BoundJoint& bone = body.joint(joint);
    const auto parent = static_cast<std::size_t>(std::max(bone.parent, 0));
    const glm::dvec3 above = glm::normalize(bone.centre - body.joint(parent).centre);
    if (shot.twist) return above;
    if (shot.axis != glm::dvec3(0.0)) return body.fromWorld(shot.axis);
    // An elbow rests a little bent; it bends on the same way.
    const glm::dvec3 fold = glm::cross(above, bone.boneAxis);
    return glm::length(fold) > 1e-3 ? glm::normalize(fold) : body.fromWorld({0, 0, -1});
}

Tile tile(const Body& body, const Shot& shot, Method method, const std::string& caption) {
    const std::size_t joint = body.find(shot.joint);
    const auto posed =
        body.deform(method, body.turned(joint, axisOf(body, shot, joint), shot.degrees));
    const osg::ref_ptr<osg::Group> scene = makeLit(osg::Vec3d(toScene(shot.eye)));
    scene->addChild(makeSkin(body, posed, [](std::size_t) { return kSkin; }));
    scene->addChild(makeCaption(caption, kSize, kSize, 16.0f));
    glm::dvec3 centre = body.joint(joint).centre;
    if (shot.twist) // the twist is along the forearm
        centre = glm::mix(centre, body.joint(std::size_t(body.joint(joint).parent)).centre, 0.4);
    const double distance = shot.distance * body.character.body.mesh.size();
    const osg::Vec3d at(
        toScene(body.toWorld(centre) + body.character.body.mesh.size() * shot.aside));
    const osg::Vec3d eye = at + osg::Vec3d(toScene(glm::normalize(shot.eye) * distance));
    return photograph(scene, {eye, at}, kSize, kSize);
}

} // namespace

std::vector<Comparison> comparisons(const Body& body, bool painted, const Body* elastic) {
    const std::string note = painted ? "painted" : "our ratios";
    std::vector<Comparison> result;
    for (const Shot& shot : kShots) {
        const std::string what = std::string(shot.name) + (shot.twist ? ", twisted " : ", bent ") +
                                 std::to_string(int(std::abs(shot.degrees))) + " degrees\n";
        Comparison row{shot.name, {}};
        row.tiles.push_back(tile(body, shot, Method::Linear, what + "linear blending, " + note));
        row.tiles.push_back(
            tile(body, shot, Method::DualQuaternion, what + "dual quaternions, " + note));
        if (!body.character.binding.correctives.empty())
            row.tiles.push_back(
                tile(body, shot, Method::Plain, what + "osgSkin, the paper's model"));
        row.tiles.push_back(tile(body, shot, Method::Ours, what + "osgSkin"));
        if (elastic)
            row.tiles.push_back(tile(*elastic, shot, Method::Ours, what + "osgSkin, elastic"));
        result.push_back(row);
    }
    return result;
}

} // namespace figures
