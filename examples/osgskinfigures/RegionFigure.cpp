// SPDX-License-Identifier: MIT
#include "Drawing.h"
#include "Figures.h"

#include <osg/BoundingBox>

#include <cmath>

namespace figures {
namespace {

constexpr int kWidth = 900;
constexpr int kHeight = 1000;

/// Hues a golden angle apart: neighbours in the list look different.
osg::Vec4 colourOf(std::size_t joint) {
    const double hue = std::fmod(0.618 * double(joint), 1.0) * 6.0;
    const auto channel = [hue](double shift) {
        const double k = std::fmod(hue + shift, 6.0);
        return float(0.92 - 0.55 * std::max(0.0, std::min({k, 4.0 - k, 1.0})));
    };
    return {channel(5.0), channel(3.0), channel(1.0), 1.0f};
}

} // namespace

Tile regionFigure(const Body& body) {
    const osg::ref_ptr<osg::Group> scene = makeLit();
    const auto& regions = body.character.binding.regions;
    const auto skin =
        makeSkin(body, body.rest(), [&](std::size_t v) { return colourOf(regions[v]); });
    scene->addChild(skin);
    const osg::BoundingBox box = skin->getBoundingBox();
    const float height = box.zMax() - box.zMin();
    // The joints lie inside: they are drawn over the skin.
    const osg::ref_ptr<osg::Group> joints = new osg::Group;
    joints->getOrCreateStateSet()->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    joints->getOrCreateStateSet()->setRenderBinDetails(5, "RenderBin");
    std::size_t seeds = 0;
    std::size_t count = 0;
    for (const auto& region : body.character.report.regions) {
        seeds += region.seeds;
        if (region.vertices == 0) continue;
        ++count;
        const std::size_t joint = body.find(region.joint);
        const osg::Vec3 centre = toScene(body.toWorld(body.joint(joint).centre));
        joints->addChild(makeBall(centre, 0.008f * height, osg::Vec4(0.1f, 0.1f, 0.12f, 1.0f)));
    }
    scene->addChild(joints);
    scene->addChild(makeCaption("Fig. 1  Skin regions and their joint centres\n" +
                                    std::to_string(body.rest().size()) + " vertices in " +
                                    std::to_string(count) + " regions; the Delaunay step seeds " +
                                    std::to_string(seeds),
                                kWidth, kHeight));
    const osg::Vec3d centre = osg::Vec3d(box.center()) - osg::Vec3d(0, 0, 0.06 * double(height));
    const osg::Vec3d eye = centre + osg::Vec3d(0.35, -2.25, 0.25) * double(height);
    return photograph(scene, {eye, centre}, kWidth, kHeight);
}

} // namespace figures
