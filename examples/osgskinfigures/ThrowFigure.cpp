// SPDX-License-Identifier: MIT
#include "ThrowFigure.h"

#include "Drawing.h"
#include "Ground.h"

#include <glm/common.hpp>

#include <cstdio>
#include <stdexcept>

namespace figures {
namespace {

constexpr int kSize = 400;
constexpr int kFrames = 8;
// The action: after the first steps, and up to the follow-through.
constexpr double kFrom = 0.15;
constexpr double kTo = 0.6;

} // namespace

Tile throwFigure(Body& body) {
    osgSkin::Character& character = body.character;
    if (character.motions.empty())
        throw std::runtime_error(character.file + ": expected a motion, for Fig. 4");
    const osgSkin::Clip& clip = character.motions.front().clip;
    const osg::ref_ptr<osg::Group> scene = example::withShadow(character.root);
    const double size = character.body.mesh.size();
    scene->addChild(example::makeFloor(float(5.0 * size)));
    const osg::ref_ptr<osg::Camera> overlay = makeCaption("", kSize, kSize, 18.0f);
    auto& caption = static_cast<osgText::Text&>(*overlay->getChild(0));
    scene->addChild(overlay);
    // Midway between the ends of the way that the figure's root goes.
    glm::dvec3 low = clip.rootPositions.front();
    glm::dvec3 high = low;
    for (const glm::dvec3& place : clip.rootPositions) {
        low = glm::min(low, place);
        high = glm::max(high, place);
    }
    const glm::dvec3 way = body.toWorld(0.5 * (low + high));
    const osg::Vec3d centre(way.x, way.y, 0.52 * size);
    const example::View view{centre + osg::Vec3d(0.1, -3.0, 0.3) * size, centre};
    example::Snapshots snapshots(scene, view, kSize, kSize);
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
