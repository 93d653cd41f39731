// SPDX-License-Identifier: MIT
#include "RatioPlot.h"

#include "Drawing.h"

#include <algorithm>
#include <cstdio>

namespace figures {
namespace {

constexpr double kFloor = 150.0; ///< of ratio 0, in pixels
constexpr double kRise = 190.0;  ///< from ratio 0 to 1

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

} // namespace

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

} // namespace figures
