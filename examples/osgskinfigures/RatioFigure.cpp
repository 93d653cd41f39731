// SPDX-License-Identifier: MIT
#include "RatioFigure.h"

#include "Drawing.h"
#include "RatioPlot.h"

#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>

#include <algorithm>

namespace figures {
namespace {

constexpr int kWidth = 720;
constexpr int kHeight = 900;

const osg::Vec4 kPaper(0.95f, 0.45f, 0.40f, 1.0f);
const osg::Vec4 kSmooth(0.45f, 0.75f, 0.95f, 1.0f);

/// The left arm: where a vertex lies along it, and whether it belongs to it.
class Arm {
public:
    explicit Arm(const Body& body)
        : _body(body), _shoulder(body.find("LeftArm")), elbow(body.find("LeftForeArm")),
          hand(body.find("LeftHand")), _centre(body.joint(elbow).centre),
          _above(glm::normalize(_centre - body.joint(_shoulder).centre)) {
        const glm::dvec3 bone = body.joint(hand).centre - _centre;
        _length = glm::length(bone);
        _along = bone / _length;
    }

    bool holds(std::size_t vertex) const {
        const int region = int(_body.character.binding.regions[vertex]);
        return _body.character.rest.isInSubtree(region, int(_shoulder));
    }

    /// From the elbow, in forearms: down the forearm, or else up the upper arm (an elbow rests a
    /// little bent).
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
    scene->addChild(drawPlot(plot, kWidth, kHeight));
    scene->addChild(makeCaption(caption, kWidth, kHeight));
    const double size = body.character.body.mesh.size();
    // The arm in the upper half, the plot below it.
    const osg::Vec3d at(toScene(body.toWorld(body.joint(arm.elbow).centre)));
    const osg::Vec3d centre = at - osg::Vec3d(0, 0, 0.23 * size);
    return photograph(scene, {centre + toCamera * size, centre}, kWidth, kHeight);
}

/// Fig. 3a: only the method `paper` bends between boundaries; `smooth` is drawn beside it.
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
    // The hand's boundaries are told from the wrist.
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

} // namespace figures
