// SPDX-License-Identifier: MIT
#include "Figures.h"

#include "Drawing.h"
#include "Ground.h"

#include <osgSkinBind/Bind>
#include <osgSkinBind/ShowRegions>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <osg/BoundingBox>
#include <osg/Camera>
#include <osg/Math>
#include <osg/Matrix>
#include <osg/PolygonOffset>
#include <osg/PositionAttitudeTransform>
#include <osg/ShapeDrawable>
#include <osg/Vec4>
#include <osg/ref_ptr>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace figures {

namespace {

/// A plot of a ratio over the position along a bone, in the lower half of a picture.
struct RatioPlot {
    struct Dots {
        std::string name;
        osg::Vec4 colour;
        std::vector<double> positions; ///< along the bone, in bone lengths
        std::vector<double> ratios;    ///< one per position
    };
    double low = 0.0, high = 1.0;       ///< range of the positions
    std::optional<double> upper, lower; ///< boundaries of eq. 5, if any
    std::vector<Dots> dots;             ///< drawn in this order
    std::string axis;                   ///< label: meaning of position 0, and the unit
};

constexpr double kFloor = 150.0; ///< height of ratio 0, in pixels
constexpr double kRise = 190.0;  ///< height from ratio 0 to 1, in pixels

const osg::Vec4 kFrame(0.55f, 0.57f, 0.60f, 1.0f);
const osg::Vec4 kCurve(1.0f, 0.75f, 0.25f, 1.0f);

/// Eq. 5 between two boundaries.
double hermite(double position, double upper, double lower) {
    const double t = std::clamp((position - upper) / (lower - upper), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

osg::ref_ptr<osg::Geometry> makePanel(float width, float height) {
    return makeLines({{0, 0, 0}, {width, 0, 0}, {width, height, 0}, {0, height, 0}},
                     osg::Vec4(0.09f, 0.10f, 0.11f, 1.0f), GL_QUADS);
}

/// Draws a plot.
/// \param plot the plot
/// \param width of the picture, in pixels
/// \param height of the picture, in pixels; the plot fills its lower part
osg::ref_ptr<osg::Camera> drawPlot(const RatioPlot& plot, int width, int height) {
    const auto at = [&](double position, double ratio) {
        const double share = (position - plot.low) / (plot.high - plot.low);
        return osg::Vec3(float(60.0 + (width - 100.0) * share), float(kFloor + kRise * ratio), 0);
    };
    osg::ref_ptr<osg::Camera> camera = makeOverlay(width, height);
    const double legend = 24.0 * double(plot.dots.size() + (plot.upper ? 1 : 0));
    camera->addChild(makePanel(float(width), float(kFloor + kRise + 26.0 + legend)));
    camera->addChild(makeLines({at(plot.low, 1), at(plot.high, 1), at(plot.low, 0),
                                at(plot.high, 0), at(plot.low, 0), at(plot.low, 1)},
                               kFrame, GL_LINES, 1.0f));
    camera->addChild(makeText("1", at(plot.low, 1) - osg::Vec3(22, 6, 0), 18.0f));
    camera->addChild(makeText("0", at(plot.low, 0) - osg::Vec3(22, 6, 0), 18.0f));
    camera->addChild(makeText(plot.axis, at(plot.low, 0) - osg::Vec3(0, 52, 0), 16.0f));
    camera->addChild(makeLines({at(0, 0), at(0, 1)}, kFrame, GL_LINES, 1.0f));
    camera->addChild(makeText("0", at(0, 0) - osg::Vec3(5, 22, 0), 16.0f));

    osg::Vec3 line = at(plot.low, 1) + osg::Vec3(0, 16, 0);
    for (const RatioPlot::Dots& dots : plot.dots) {
        std::vector<osg::Vec3> points;
        for (std::size_t i = 0; i < dots.positions.size(); ++i)
            if (dots.positions[i] >= plot.low && dots.positions[i] <= plot.high)
                points.push_back(at(dots.positions[i], dots.ratios[i]));
        camera->addChild(makeLines(points, dots.colour, GL_POINTS, 4.0f));
        camera->addChild(makeText(dots.name, line, 16.0f, dots.colour));
        line.y() += 24.0f;
    }
    if (!plot.upper || !plot.lower) return camera;
    std::vector<osg::Vec3> curve;
    for (int i = 0; i <= 300; ++i) {
        const double p = plot.low + (plot.high - plot.low) * i / 300.0;
        curve.push_back(at(p, hermite(p, *plot.upper, *plot.lower)));
    }
    camera->addChild(makeLines(curve, kCurve, GL_LINE_STRIP, 2.5f));
    camera->addChild(makeText("curve: eq. 5 between the boundaries", line, 16.0f, kCurve));
    for (const double boundary : {*plot.upper, *plot.lower}) {
        char text[32];
        std::snprintf(text, sizeof text, "%.2f", boundary);
        camera->addChild(makeLines({at(boundary, 0), at(boundary, 1)}, kCurve, GL_LINES, 1.0f));
        if (std::abs(boundary) > 0.05)
            camera->addChild(makeText(text, at(boundary, 0) - osg::Vec3(20, 22, 0), 16.0f, kCurve));
    }
    return camera;
}

constexpr int kRatioWidth = 720;
constexpr int kRatioHeight = 900;

const osg::Vec4 kPaper(0.95f, 0.45f, 0.40f, 1.0f);
const osg::Vec4 kSmooth(0.45f, 0.75f, 0.95f, 1.0f);

/// The left arm: its vertices, and their positions along it.
class Arm {
public:
    explicit Arm(const Body& body)
        : _body(body), _shoulder(body.character.jointByRole("LeftUpperArm")),
          elbow(body.character.jointByRole("LeftLowerArm")),
          hand(body.character.jointByRole("LeftHand")), _centre(body.joint(elbow).centre),
          _above(glm::normalize(_centre - body.joint(_shoulder).centre)) {
        const glm::dvec3 bone = body.joint(hand).centre - _centre;
        _length = glm::length(bone);
        _along = bone / _length;
    }

    bool holds(std::size_t vertex) const {
        const int region = int(_body.character.binding.regions[vertex]);
        return _body.character.rest.isInSubtree(region, int(_shoulder));
    }

    /// Position relative to the elbow in forearm lengths, along the forearm or else along the upper
    /// arm, because the elbow is slightly bent at rest.
    double position(std::size_t vertex) const {
        const glm::dvec3 d = _body.rest()[vertex] - _centre;
        const double below = glm::dot(d, _along);
        return (below > 0.0 ? below : std::min(glm::dot(d, _above), 0.0)) / _length;
    }

private:
    const Body& _body;
    std::size_t _shoulder;

public:
    std::size_t elbow, hand;

private:
    glm::dvec3 _centre, _above, _along;
    double _length;
};

double ratio(const osgSkin::Binding& binding, std::size_t vertex, std::size_t joint, bool twist) {
    const osgSkin::Influence share = influenceOf(binding, vertex, joint);
    return double(twist ? share.twist : share.bend);
}

RatioPlot::Dots dotsOf(const Body& body, const Arm& arm, const osgSkin::Binding& binding,
                       std::size_t joint, bool twist) {
    RatioPlot::Dots dots;
    for (std::size_t v = 0; v < body.rest().size(); ++v) {
        if (!arm.holds(v)) continue;
        dots.positions.push_back(arm.position(v));
        dots.ratios.push_back(ratio(binding, v, joint, twist));
    }
    return dots;
}

/// The arm coloured by a ratio, over its plot.
Tile picture(const Body& body, const Arm& arm, const RatioPlot& plot,
             const std::function<double(std::size_t)>& ratioAt, const std::string& caption) {
    const osg::Vec3d toCamera(0.1, -1.7, 0.3);
    const osg::ref_ptr<osg::Group> scene = makeLit(toCamera);
    scene->addChild(
        makeSkin(body, body.rest(), [&](std::size_t v) { return ratioColour(ratioAt(v)); }));
    scene->addChild(drawPlot(plot, kRatioWidth, kRatioHeight));
    scene->addChild(makeCaption(caption, kRatioWidth, kRatioHeight));
    const double size = body.size();
    // The arm in the upper half, the plot below it.
    const osg::Vec3d at(toScene(body.toWorld(body.joint(arm.elbow).centre)));
    const osg::Vec3d centre = at - osg::Vec3d(0, 0, 0.23 * size);
    return photograph(scene, {centre + toCamera * size, centre}, kRatioWidth, kRatioHeight);
}

/// Fig. 3a. Only the binding method `paper` has boundaries; `smooth` is drawn for comparison.
Tile bendPicture(const Body& body, const Arm& arm) {
    const osgSkin::Character& character = body.character;
    osgSkin::BindOptions options = character.bindOptions;
    options.method = osgSkin::BindOptions::Method::Paper;
    osgSkin::BindReport report;
    const osgSkin::Binding printed =
        osgSkin::bind(character.body.mesh, character.rest, options, &report);
    RatioPlot plot;
    plot.low = -0.8;
    plot.high = 0.8;
    plot.axis = "0: elbow; unit: the forearm's length";
    plot.upper = report.boundaries[arm.elbow].bendUpper;
    plot.lower = report.boundaries[arm.elbow].bendLower;
    plot.dots.push_back(dotsOf(body, arm, character.binding, arm.elbow, false));
    plot.dots.back().name = "vertices, as the character is bound: over the whole skin";
    plot.dots.back().colour = kSmooth;
    plot.dots.push_back(dotsOf(body, arm, printed, arm.elbow, false));
    plot.dots.back().name = "vertices, bound as printed: between two planes";
    plot.dots.back().colour = kPaper;
    return picture(
        body, arm, plot, [&](std::size_t v) { return ratio(printed, v, arm.elbow, false); },
        "Fig. 3a  Bend ratio of the elbow\nblue 0, red 1; the arm is bound as printed");
}

Tile twistPicture(const Body& body, const Arm& arm) {
    const osgSkin::Character& character = body.character;
    RatioPlot plot;
    plot.low = -0.3;
    plot.high = 1.3;
    plot.axis = "0: elbow; 1: wrist; unit: the forearm's length";
    // The hand's boundaries are relative to the wrist.
    if (!character.bindReport.boundaries.empty()) {
        const auto& boundaries = character.bindReport.boundaries[arm.hand];
        if (boundaries.twistUpper && boundaries.twistLower) {
            plot.upper = 1.0 + *boundaries.twistUpper;
            plot.lower = 1.0 + *boundaries.twistLower;
        }
    }
    plot.dots.push_back(dotsOf(body, arm, character.binding, arm.hand, true));
    plot.dots.back().name = "vertices, as the character is bound: at even shear";
    plot.dots.back().colour = kSmooth;
    return picture(
        body, arm, plot, [&](std::size_t v) { return ratio(character.binding, v, arm.hand, true); },
        "Fig. 3b  Twist ratio of the hand:\nit builds up along the forearm");
}

} // namespace

Tile ratioFigure(const Body& body) {
    const Arm arm(body);
    return tiled({bendPicture(body, arm), twistPicture(body, arm)}, 2);
}

namespace {

constexpr int kCompareSize = 400;

/// A close-up of a single rotated joint. Directions are in the scene's frame: Z up, facing -Y.
struct Shot {
    const char* name;
    const char* joint; ///< its role
    double degrees;
    glm::dvec3 axis;  ///< if zero, perpendicular to the bone and the one above; see axisOf()
    bool twist;       ///< about the bone above
    glm::dvec3 eye;   ///< direction from the joint to the camera
    double distance;  ///< in body sizes
    glm::dvec3 aside; ///< from the joint to the picture's centre, in body sizes
};

const Shot kShots[] = {
    {"shoulder", "LeftUpperArm", 95.0, {0, -1, 0}, false, {0.15, -1.0, 0.1}, 0.85, {-0.02, 0, 0.0}},
    {"elbow", "LeftLowerArm", 115.0, {0, 0, 0}, false, {0.55, -1.0, 0.55}, 0.68, {-0.055, 0, 0}},
    {"wrist", "LeftHand", 160.0, {0, 0, 0}, true, {0.1, -1.0, 0.3}, 0.5, {0, 0, 0}},
    {"hip", "LeftUpperLeg", -95.0, {1, 0, 0}, false, {1.0, -0.75, 0.25}, 0.95, {0, -0.06, 0.03}},
    {"knee", "LeftLowerLeg", 120.0, {1, 0, 0}, false, {1.0, 0.25, 0.1}, 0.7, {0, 0.04, 0.03}},
};

glm::dvec3 axisOf(const Body& body, const Shot& shot, std::size_t joint) {
    const osgSkin::BoundJoint& bone = body.joint(joint);
    const auto parent = static_cast<std::size_t>(std::max(bone.parent, 0));
    const glm::dvec3 above = glm::normalize(bone.centre - body.joint(parent).centre);
    if (shot.twist) return above;
    if (shot.axis != glm::dvec3(0.0)) return body.fromWorld(shot.axis);
    // An elbow is slightly bent at rest; bend it further in the same direction.
    const glm::dvec3 fold = glm::cross(above, bone.boneAxis);
    return glm::length(fold) > 1e-3 ? glm::normalize(fold) : body.fromWorld({0, 0, -1});
}

Tile tile(const Body& body, const Shot& shot, Method method, const std::string& caption) {
    const std::size_t joint = body.character.jointByRole(shot.joint);
    const auto posed =
        body.deform(method, body.turned(joint, axisOf(body, shot, joint), shot.degrees));
    const osg::ref_ptr<osg::Group> scene = makeLit(osg::Vec3d(toScene(shot.eye)));
    scene->addChild(makeSkin(body, posed, [](std::size_t) { return kSkin; }));
    scene->addChild(makeCaption(caption, kCompareSize, kCompareSize, 16.0f));
    glm::dvec3 centre = body.joint(joint).centre;
    if (shot.twist) // the twist is along the forearm
        centre = glm::mix(centre, body.joint(std::size_t(body.joint(joint).parent)).centre, 0.4);
    const double distance = shot.distance * body.size();
    const osg::Vec3d at(toScene(body.toWorld(centre) + body.size() * shot.aside));
    const osg::Vec3d eye = at + osg::Vec3d(toScene(glm::normalize(shot.eye) * distance));
    return photograph(scene, {eye, at}, kCompareSize, kCompareSize);
}

} // namespace

std::vector<Comparison> comparisons(const Body& body, bool painted) {
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
        result.push_back(row);
    }
    return result;
}

namespace {

constexpr int kRegionWidth = 760;
const osg::Vec4 kBare(0.62f, 0.60f, 0.58f, 1.0f);
constexpr int kRegionHeight = 860;

/// The seed's joint, or the rigid joint above it whose region contains the seed.
std::size_t rigidOf(const Body& body, std::size_t vertex) {
    const auto& report = body.character.bindReport;
    int joint = report.seeds[vertex];
    const auto holds = [&](int j) {
        for (const auto& region : report.regions)
            if (region.joint == body.joint(std::size_t(j)).name) return true;
        return false;
    };
    while (joint > 0 && !holds(joint)) joint = body.joint(std::size_t(joint)).parent;
    return std::size_t(std::max(joint, 0));
}

/// The seeds as points on the skin.
osg::ref_ptr<osg::Node> makeSeeds(const Body& body) {
    osg::ref_ptr<osg::Group> group = new osg::Group;
    std::map<std::size_t, std::vector<osg::Vec3>> points;
    for (std::size_t v = 0; v < body.rest().size(); ++v)
        if (body.character.bindReport.seeds[v] >= 0)
            points[rigidOf(body, v)].push_back(toScene(body.toWorld(body.rest()[v])));
    for (const auto& [joint, places] : points)
        group->addChild(makeLines(places, osgSkin::regionColor(joint), GL_POINTS, 5.0f));
    return group;
}

/// The joints, drawn over the skin that they lie in.
osg::ref_ptr<osg::Node> makeJoints(const Body& body, float radius) {
    osg::ref_ptr<osg::Group> joints = new osg::Group;
    joints->getOrCreateStateSet()->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    joints->getOrCreateStateSet()->setRenderBinDetails(5, "RenderBin");
    for (const auto& region : body.character.bindReport.regions) {
        if (region.vertices == 0) continue;
        const osg::Vec3 centre = toScene(body.toWorld(body.joint(body.find(region.joint)).centre));
        joints->addChild(makeBall(centre, radius, osg::Vec4(0.1f, 0.1f, 0.12f, 1.0f)));
    }
    return joints;
}

/// A picture of the coloured figure with its joints.
Tile picture(const Body& body, const std::function<osg::Vec4(std::size_t)>& colour,
             const std::string& caption, bool dots) {
    const osg::Vec3d toCamera(0.35, -2.25, 0.25);
    const osg::ref_ptr<osg::Group> scene = makeLit(toCamera);
    const auto skin = makeSkin(body, body.rest(), colour);
    // Offset the skin, so that it does not cut off the points on it.
    skin->getOrCreateStateSet()->setAttributeAndModes(new osg::PolygonOffset(4.0f, 8.0f));
    scene->addChild(skin);
    const osg::BoundingBox box = skin->getBoundingBox();
    const float height = box.zMax() - box.zMin();
    if (dots) scene->addChild(makeSeeds(body));
    scene->addChild(makeJoints(body, 0.007f * height));
    scene->addChild(makeCaption(caption, kRegionWidth, kRegionHeight));
    const osg::Vec3d centre = osg::Vec3d(box.center()) - osg::Vec3d(0, 0, 0.05 * double(height));
    return photograph(scene, {centre + toCamera * double(height), centre}, kRegionWidth,
                      kRegionHeight);
}

} // namespace

Tile regionFigure(const Body& body) {
    const auto& regions = body.character.binding.regions;
    const osgSkin::BindReport& report = body.character.bindReport;
    if (regions.empty() || report.seeds.empty())
        throw std::runtime_error(body.character.file +
                                 ": follows painted weights, expected a body that is bound");
    std::size_t seeds = 0;
    std::size_t count = 0;
    for (const auto& region : report.regions) {
        seeds += region.seeds;
        count += region.vertices > 0 ? 1 : 0;
    }
    return tiled({picture(
                      body, [](std::size_t) { return kBare; },
                      "Fig. 1a  Joint centres, and the " + std::to_string(seeds) + " of " +
                          std::to_string(report.weldedVertices) +
                          " vertices\nthat the Delaunay step gives to one of them: seeds",
                      true),
                  picture(
                      body, [&](std::size_t v) { return osgSkin::regionColor(regions[v]); },
                      "Fig. 1b  Flooded from the seeds:\n" + std::to_string(count) +
                          " regions, each of one piece",
                      false)},
                 2);
}

namespace {

constexpr int kSplitWidth = 900;
constexpr int kSplitHeight = 700;
const osg::Vec4 kBend(0.98f, 0.62f, 0.20f, 1.0f);
const osg::Vec4 kTwist(0.35f, 0.78f, 0.95f, 1.0f);
constexpr double kBendAngle = 60.0;
constexpr double kTwistAngle = 110.0;

osg::ref_ptr<osg::Node> makeLimb(const osg::Vec3& along, const osg::Vec4& colour) {
    const osg::ref_ptr<osg::Capsule> capsule = new osg::Capsule(along * 0.5f, 0.16f, 1.0f);
    capsule->setRotation(osg::Quat(osg::Quat::value_type(0), osg::Vec3d(0, 0, 1)));
    osg::Quat turn;
    turn.makeRotate(osg::Vec3(0, 0, 1), along);
    capsule->setRotation(turn);
    const osg::ref_ptr<osg::ShapeDrawable> limb = new osg::ShapeDrawable(capsule);
    limb->setColor(colour);
    return limb;
}

/// An arc with a ball at its end: rotates `from` about `axis` by `degrees`, around `centre`.
osg::ref_ptr<osg::Node> makeArc(const osg::Vec3& centre, const osg::Vec3& from,
                                const osg::Vec3& axis, double degrees, const osg::Vec4& colour) {
    std::vector<osg::Vec3> points;
    for (int i = 0; i <= 40; ++i)
        points.push_back(centre +
                         osg::Quat(osg::DegreesToRadians(degrees * i / 40.0), axis) * from);
    const osg::ref_ptr<osg::Group> arc = new osg::Group;
    arc->addChild(makeLines(points, colour, GL_LINE_STRIP, 4.0f));
    arc->addChild(makeBall(points.back(), 0.03f, colour));
    return arc;
}

void addArrow(osg::Group& group, const osg::Vec3& to, const osg::Vec4& colour, const char* name) {
    group.addChild(makeLines({osg::Vec3(), to}, colour, GL_LINES, 3.0f));
    group.addChild(makeBall(to, 0.03f, colour));
    const osg::Vec3 besideBall(0.06f, 0.0f, 0.0f); // for an axis that points at the camera
    const auto label = makeText(name, to * 1.03f + besideBall, 0.10f, colour);
    label->setAxisAlignment(osgText::Text::SCREEN);
    group.addChild(label);
}

void addLabel(osg::Group& group, const osg::Vec3& place, const osg::Vec4& colour,
              const char* text) {
    const auto label = makeText(text, place, 0.085f, colour);
    label->setAxisAlignment(osgText::Text::SCREEN);
    group.addChild(label);
}

} // namespace

Tile splitFigure() {
    const osg::Vec3 w(1, 0, 0);
    const osg::Vec3 v(0, -1, 0); // towards the camera: the bend lies in the picture's plane
    const osg::Quat bend(osg::DegreesToRadians(kBendAngle), v);
    const osg::Vec3 bent = bend * w;
    const osg::ref_ptr<osg::Group> scene = makeLit();
    scene->addChild(makeLimb(-w, osg::Vec4(0.45f, 0.47f, 0.50f, 1.0f)));
    scene->addChild(makeLimb(bent, kSkin));
    // Axes and arcs are also visible inside the limbs.
    const osg::ref_ptr<osg::Group> marks = new osg::Group;
    marks->getOrCreateStateSet()->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    marks->getOrCreateStateSet()->setRenderBinDetails(5, "RenderBin");
    addArrow(*marks, w * 1.35f, kInk, "w  bone axis");
    addArrow(*marks, bent * 1.45f, kInk, "q w q*  turned bone");
    addArrow(*marks, v * 0.95f, kBend, "v  bend axis");
    marks->addChild(makeArc(osg::Vec3(), w * 0.95f, v, kBendAngle, kBend));
    addLabel(*marks, osg::Quat(osg::DegreesToRadians(22.0), v) * w * 1.02f, kBend, "psi  bend");
    marks->addChild(makeArc(bent * 1.2f, v * 0.3f, bent, kTwistAngle, kTwist));
    addLabel(*marks, bent * 1.2f + osg::Vec3(0.3f, 0, -0.1f), kTwist, "phi  twist");
    scene->addChild(marks);
    scene->addChild(
        makeCaption("Fig. 2  A joint rotation split: q = exp(psi v / 2) exp(phi w / 2)\n"
                    "first the twist by phi about the bone, then the bend by psi",
                    kSplitWidth, kSplitHeight));
    return photograph(scene, {{1.7, -5.9, 1.5}, {0.65, 0, 0.3}}, kSplitWidth, kSplitHeight);
}

namespace {

constexpr int kThrowSize = 400;
constexpr int kFrames = 8;
// The part of the motion from the first steps to the follow-through.
constexpr double kFrom = 0.15;
constexpr double kTo = 0.6;

} // namespace

Tile throwFigure(Body& body) {
    osgSkin::Character& character = body.character;
    if (character.motions.empty())
        throw std::runtime_error(character.file + ": expected a motion, for Fig. 4");
    const osgSkin::Clip& clip = character.motions.front().clip;
    const osg::ref_ptr<osg::Group> scene = example::withShadow(character.root);
    const double size = body.size();
    scene->addChild(example::makeFloor(float(5.0 * size)));
    const osg::ref_ptr<osg::Camera> overlay = makeCaption("", kThrowSize, kThrowSize, 18.0f);
    auto& caption = static_cast<osgText::Text&>(*overlay->getChild(0));
    scene->addChild(overlay);
    // The centre of the root's path.
    glm::dvec3 low = clip.rootPositions.front();
    glm::dvec3 high = low;
    for (const glm::dvec3& place : clip.rootPositions) {
        low = glm::min(low, place);
        high = glm::max(high, place);
    }
    const glm::dvec3 way = body.toWorld(0.5 * (low + high));
    const osg::Vec3d centre(way.x, way.y, 0.52 * size);
    const example::View view{centre + osg::Vec3d(0.1, -3.0, 0.3) * size, centre};
    example::Snapshots snapshots(scene, view, kThrowSize, kThrowSize);
    const double seconds = clip.frameTime * double(clip.frames);
    std::vector<Tile> tiles;
    for (int i = 0; i < kFrames; ++i) {
        const double time = seconds * (kFrom + (kTo - kFrom) * i / (kFrames - 1));
        char text[60];
        std::snprintf(text, sizeof text, "%s%.2f s", i == 0 ? "Fig. 4  The motion  " : "", time);
        caption.setText(text);
        if (i == 0) snapshots.take(0.0); // the clip starts with the first frame that is drawn
        tiles.push_back(snapshots.take(time));
    }
    return tiled(tiles, 4);
}

} // namespace figures
