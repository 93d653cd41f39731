// SPDX-License-Identifier: MIT
#include "RegionFigure.h"

#include "Drawing.h"

#include <osg/BoundingBox>
#include <osg/PolygonOffset>
#include <osgSkinBind/ShowRegions>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>

namespace figures {
namespace {

constexpr int kWidth = 760;
const osg::Vec4 kBare(0.62f, 0.60f, 0.58f, 1.0f);
constexpr int kHeight = 860;

/// The seed's joint, or the rigid joint above it, whose region takes the seed in.
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

/// The seeds as points a little above the skin.
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

/// The joints lie inside: they are drawn over the skin.
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

/// A picture of the figure in its own colours, with its joints.
Tile picture(const Body& body, const std::function<osg::Vec4(std::size_t)>& colour,
             const std::string& caption, bool dots) {
    const osg::Vec3d toCamera(0.35, -2.25, 0.25);
    const osg::ref_ptr<osg::Group> scene = makeLit(toCamera);
    const auto skin = makeSkin(body, body.rest(), colour);
    // Set back a little, so that points on it are seen whole.
    skin->getOrCreateStateSet()->setAttributeAndModes(new osg::PolygonOffset(4.0f, 8.0f));
    scene->addChild(skin);
    const osg::BoundingBox box = skin->getBoundingBox();
    const float height = box.zMax() - box.zMin();
    if (dots) scene->addChild(makeSeeds(body));
    scene->addChild(makeJoints(body, 0.007f * height));
    scene->addChild(makeCaption(caption, kWidth, kHeight));
    const osg::Vec3d centre = osg::Vec3d(box.center()) - osg::Vec3d(0, 0, 0.05 * double(height));
    return photograph(scene, {centre + toCamera * double(height), centre}, kWidth, kHeight);
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

} // namespace figures
