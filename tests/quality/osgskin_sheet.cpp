// SPDX-License-Identifier: GPL-3.0-or-later
// Draws bodies in demanding poses, deformed by osgSkin and, beside it, by dual quaternions.
#include "CommandLine.h"
#include "DemandingPoses.h"
#include "Drawing.h"
#include "Snapshots.h"
#include "Subject.h"

#include <osgSkinBind/Bind>

#include <CLI/CLI.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <iostream>

namespace {

using namespace quality;

constexpr int kWidth = 250, kHeight = 270; ///< of a tile, pixels
constexpr std::size_t kColumns = 12;       ///< of tiles
constexpr double kFieldOfView = 12.0;      ///< degrees

struct Options {
    std::vector<std::string> bodies = kShapes;
    std::string folder = ".";
    std::string shapes = "fast";
};

/// From the body's space, +y up and facing +z, to the pictures', +z up and facing -y.
osg::Vec3 toPicture(const glm::dvec3& v) {
    return {float(v.x), float(-v.z), float(v.y)};
}

osg::ref_ptr<osg::Geometry> drawn(const Subject& subject, const PosedSkin& posed,
                                  const osg::Vec4& colour) {
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    const osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    const osg::ref_ptr<osg::Vec4Array> colours = new osg::Vec4Array(osg::Array::BIND_OVERALL);
    colours->push_back(colour);
    for (std::size_t v = 0; v < posed.points.size(); ++v) {
        vertices->push_back(toPicture(posed.points[v]));
        normals->push_back(toPicture(posed.normals[v]));
    }
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(vertices);
    geometry->setNormalArray(normals);
    geometry->setColorArray(colours);
    geometry->addPrimitiveSet(new osg::DrawElementsUInt(
        GL_TRIANGLES, unsigned(subject.triangles.size()), subject.triangles.data()));
    return geometry;
}

double heightOf(const Subject& subject) {
    const auto [low, high] =
        std::minmax_element(subject.rest.begin(), subject.rest.end(),
                            [](const glm::dvec3& a, const glm::dvec3& b) { return a.y < b.y; });
    return high->y - low->y;
}

figures::Tile tile(const Subject& subject, const DemandingPose& demanding, Method method) {
    const double azimuth = osg::DegreesToRadians(demanding.azimuth);
    const double elevation = osg::DegreesToRadians(demanding.elevation);
    const osg::Vec3d toCamera =
        toPicture({std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                   std::cos(azimuth) * std::cos(elevation)});
    const std::vector<glm::dmat4>& skinning = demanding.pose.skinning;
    const auto joint = static_cast<std::size_t>(std::max(subject.rig.find(demanding.centre), 0));
    const glm::dvec3 centre(skinning[joint] * glm::dvec4(subject.rig.joints[joint].centre, 1.0));
    const double distance = 0.5 * demanding.height * heightOf(subject) /
                            std::tan(0.5 * osg::DegreesToRadians(kFieldOfView));
    const bool ours = method == Method::Ours;
    const osg::ref_ptr<osg::Group> scene = figures::makeLit(toCamera);
    scene->addChild(drawn(subject, deformWithNormals(subject, method, skinning),
                          ours ? figures::kSkin : osg::Vec4(0.66f, 0.70f, 0.78f, 1.0f)));
    scene->addChild(figures::makeCaption(demanding.pose.name + (ours ? ": osgSkin" : ": DQS"),
                                         kWidth, kHeight, 13.0f));
    example::View view;
    view.centre = osg::Vec3d(toPicture(centre));
    view.eye = view.centre + toCamera * distance;
    view.fieldOfView = kFieldOfView;
    return figures::photograph(scene, view, kWidth, kHeight);
}

void drawSheet(const std::string& shape, const Options& options) {
    Subject subject = loadSubject(makeHumanFiles(shape));
    if (options.shapes != "fast") {
        subject.options->shapes = osgSkin::BindOptions::Shapes::None;
        subject.binding =
            osgSkin::bind(subject.mesh, subject.rig, *subject.options, &subject.report);
        subject.model = modelOf(subject);
    }
    std::vector<figures::Tile> tiles;
    for (const DemandingPose& pose : demandingPoses(subject.rig))
        for (const Method method : {Method::Ours, Method::DualQuaternion})
            tiles.push_back(tile(subject, pose, method));
    figures::writePicture(*figures::tiled(tiles, kColumns),
                          options.folder + "/sheet_" + shape + ".png");
}

} // namespace

int main(int argc, char** argv) {
    example::CommandLine line(
        "osgskin_sheet",
        "Draws bodies in 24 demanding poses, each by osgSkin (skin) and beside it by dual "
        "quaternions with painted weights (grey): FOLDER/sheet_SHAPE.png. Needs a display.");
    Options options;
    line.add("--body", options.bodies, "one of MakeHuman's shapes, as often as wanted")
        .oneOf(kShapes);
    line.add("--out", options.folder, "the folder of the pictures").showDefault();
    line.add("--shapes", options.shapes, "ours with these").oneOf({"none", "fast"}).showDefault();
    return line.run(argc, argv, [&] {
        line.parse(argc, argv);
        for (const std::string& shape : options.bodies) drawSheet(shape, options);
        return 0;
    });
}
