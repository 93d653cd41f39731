// SPDX-License-Identifier: MIT
#include "Drawing.h"
#include "Figures.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdio>

namespace figures {
namespace {

constexpr int kWidth = 720;
constexpr int kHeight = 820;

struct Sample {
    double position; ///< along the bone, in its lengths
    double ratio;
};

/// Eq. 5 between two boundaries.
double hermite(double position, double upper, double lower) {
    const double t = std::clamp((position - upper) / (lower - upper), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// The boundaries whose curve comes nearest to the samples, to a fiftieth of the bone.
std::pair<double, double> fit(const std::vector<Sample>& samples, double low, double high) {
    std::pair<double, double> best{low, high};
    double least = 1e300;
    for (double upper = low; upper < high; upper += 0.02)
        for (double lower = upper + 0.02; lower <= high; lower += 0.02) {
            double error = 0.0;
            for (const Sample& s : samples) {
                const double d = hermite(s.position, upper, lower) - s.ratio;
                error += d * d;
            }
            if (error < least) {
                least = error;
                best = {upper, lower};
            }
        }
    return best;
}

osg::ref_ptr<osg::Camera> makePlot(const std::vector<Sample>& samples, double low, double high,
                                   const std::string& caption, const std::string& axis) {
    const auto at = [&](double position, double ratio) {
        return osg::Vec3(float(80.0 + (kWidth - 120.0) * (position - low) / (high - low)),
                         float(150.0 + 190.0 * ratio), 0.0f);
    };
    osg::ref_ptr<osg::Camera> plot = makeCaption(caption, kWidth, kHeight);
    const osg::Vec4 grey(0.55f, 0.57f, 0.60f, 1.0f);
    plot->addChild(makeLines({at(low, 1.0), at(high, 1.0), at(low, 0.0), at(high, 0.0),
                              at(low, 0.0), at(low, 1.0), at(0.0, 0.0), at(0.0, 1.0)},
                             grey, GL_LINES, 1.0f));
    std::vector<osg::Vec3> dots, curve;
    for (const Sample& s : samples) dots.push_back(at(s.position, s.ratio));
    plot->addChild(makeLines(dots, osg::Vec4(0.45f, 0.75f, 0.95f, 1.0f), GL_POINTS, 4.0f));
    const auto [upper, lower] = fit(samples, low, high);
    for (int i = 0; i <= 200; ++i) {
        const double p = low + (high - low) * i / 200.0;
        curve.push_back(at(p, hermite(p, upper, lower)));
    }
    plot->addChild(makeLines(curve, osg::Vec4(1.0f, 0.75f, 0.25f, 1.0f), GL_LINE_STRIP, 3.0f));
    const osg::Vec3 down(0, -24, 0);
    plot->addChild(makeText("1", at(low, 1.0) - osg::Vec3(24, 6, 0), 18.0f));
    plot->addChild(makeText("0", at(low, 0.0) - osg::Vec3(24, 6, 0), 18.0f));
    plot->addChild(makeText(axis, at(0.0, 0.0) + down, 16.0f));
    plot->addChild(makeText("dots: vertices   curve: eq. 5, nearest boundaries",
                            at(low, 1.0) + osg::Vec3(0, 12, 0), 16.0f));
    return plot;
}

/// The arm coloured by one of a joint's ratios, over the plot along the bone from `from`.
Tile ratioTile(const Body& body, const char* joint, bool twist, const std::string& caption) {
    const std::size_t turning = body.find(joint);
    const std::size_t elbow = body.find("LeftForeArm");
    const std::size_t shoulder = body.find("LeftArm");
    const glm::dvec3 from = body.joint(elbow).centre;
    const glm::dvec3 bone = body.joint(body.find("LeftHand")).centre - from;
    const double low = twist ? -0.3 : -0.8;
    const double high = twist ? 1.3 : 0.8;
    const auto ratioOf = [&](std::size_t v) {
        const osgSkin::Influence share = body.influence(v, turning);
        return double(twist ? share.twist : share.bend);
    };
    std::vector<Sample> samples;
    for (std::size_t v = 0; v < body.rest().size(); ++v) {
        const int region = int(body.character.binding.regions[v]);
        if (!body.character.rig.isInSubtree(region, int(shoulder))) continue;
        const double position = glm::dot(body.rest()[v] - from, bone) / glm::dot(bone, bone);
        if (position >= low && position <= high) samples.push_back({position, ratioOf(v)});
    }
    const osg::ref_ptr<osg::Group> scene = makeLit();
    scene->addChild(
        makeSkin(body, body.rest(), [&](std::size_t v) { return ratioColour(ratioOf(v)); }));
    scene->addChild(makePlot(samples, low, high, caption, "elbow; unit: the forearm's length"));
    const double size = body.character.body.mesh.size();
    // The arm in the upper half, the plot below it.
    const osg::Vec3d at(toScene(body.toWorld(from)));
    const osg::Vec3d centre = at - osg::Vec3d(0, 0, 0.2 * size);
    return photograph(scene, {centre + osg::Vec3d(0.1, -1.6, 0.3) * size, centre}, kWidth, kHeight);
}

} // namespace

Tile ratioFigure(const Body& body) {
    return tiled(
        {ratioTile(body, "LeftForeArm", false, "Fig. 3a  Bend ratio of the elbow\nblue 0, red 1"),
         ratioTile(body, "LeftHand", true,
                   "Fig. 3b  Twist ratio of the hand: it builds up\nalong the forearm")},
        2);
}

} // namespace figures
