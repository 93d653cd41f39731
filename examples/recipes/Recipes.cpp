// SPDX-License-Identifier: MIT
#include "Recipes.h"
#include "Ground.h"
#include "Performer.h"
#include "Samples.h"

#include <osgSkinCharacter/LoadCharacter>

#include <osg/ComputeBoundsVisitor>
#include <osg/CoordinateSystemNode>
#include <osg/Group>
#include <osg/Math>
#include <osg/MatrixTransform>
#include <osg/PolygonMode>
#include <osg/ShapeDrawable>

#include <algorithm>

using File = const std::string&;
using Scene = osg::ref_ptr<osg::Node>;

// Each is in the file of its name.
Scene attachSword(File);
Scene castShadow(File);
Scene chooseClip(File);
Scene climbStairs(File, osg::Node&);
Scene convertScene(File);
Scene deformOnCard(File);
Scene driveBone(File);
Scene fadeClips(File);
Scene fallDownStairs(File, double);
Scene largeWorld(File);
Scene levelsOfDetail(File, File);
Scene loadAndPlay(File);
Scene lookAtTarget(File);
Scene makeCrowd(osg::Node&);
Scene makeFace(File);
Scene makePedestrians(osg::Node&);
Scene ownShader(File);
Scene pickPoint(File);
Scene reachTarget(File);
Scene shipAsOsgb(File);
Scene swingHair(File);

namespace {

using osg::Vec3d;

const example::View kFigure{Vec3d(-1.9, -4.6, 1.5), Vec3d(0, 0, 0.93)};

osg::Matrixd onEarth() {
    osg::Matrixd place;
    osg::EllipsoidModel().computeLocalToWorldTransformFromLatLongHeight(
        osg::DegreesToRadians(37.57), osg::DegreesToRadians(126.98), 38.0, place);
    return place;
}

/// A recipe that has no metres of its own.
template <Scene (*make)(File)>
Scene ofFile(File file, double) {
    return make(file);
}

/// A figure on stairs, and one on a slope of 20 degrees, beside each other.
Scene climb(File file, double size) {
    const osg::ref_ptr<osg::Group> scene = new osg::Group, stairs = new osg::Group;
    const auto box = [&](float y, float z, float length, float high) {
        return new osg::Box(osg::Vec3(0.0f, y, z) * float(size), 0.9f * float(size),
                            length * float(size), high * float(size));
    };
    for (int i = 1; i <= 12; ++i) // 36 x 13.1 cm
        stairs->addChild(new osg::ShapeDrawable(
            box(-0.82f - 0.36f * float(i), 0.0655f * float(i), 0.36f, 0.131f * float(i))));
    const osg::ref_ptr<osg::Box> slope = box(-3.178f, 0.74f, 4.6f, 0.1f);
    slope->setRotation(osg::Quat(osg::DegreesToRadians(-20.0), osg::X_AXIS));
    const osg::ref_ptr<osg::Node> ramp = new osg::ShapeDrawable(slope);
    for (osg::Node* ground : {static_cast<osg::Node*>(stairs.get()), ramp.get()}) {
        const osg::ref_ptr<osg::MatrixTransform> side = new osg::MatrixTransform(
            osg::Matrixd::translate((ground == ramp ? 0.7 : -0.7) * size, 0.0, 0.0));
        side->addChild(ground);
        side->addChild(climbStairs(file, *ground));
        scene->addChild(side);
    }
    return scene;
}

/// A figure's size and head, to which the view and the floor are fitted.
struct Figure {
    double size = 1.0;                 ///< in heights of the samples
    osg::Vec3d head{0.0, 0.015, 1.67}; ///< its middle
};

Figure measure(File file) {
    const osgSkin::Character character = osgSkin::loadCharacter(file);
    osg::ComputeBoundsVisitor bounds;
    character.root->accept(bounds);
    Figure result;
    const osg::BoundingBox& box = bounds.getBoundingBox(); // an animal is longer than high
    const float size = std::max(box.zMax(), 0.6f * (box.yMax() - box.yMin()));
    if (size > 0.0f) result.size = double(size) / 1.75;
    result.head *= result.size;
    if (character.roles.joint("Head") < 0) return result;
    result.head = character.restPosition("Head");
    result.head.z() = 0.5 * (result.head.z() + double(box.zMax()));
    return result;
}

/// The recipe's view, for a figure.
example::View viewOf(const Recipe& recipe, const Figure& figure) {
    example::View view = recipe.view;
    const Vec3d shift =
        (recipe.needs & kHead) != 0 ? figure.head - Figure().head * figure.size : Vec3d();
    view.up = osg::Matrixd::transform3x3(view.up, recipe.place);
    view.eye = (view.eye * figure.size + shift) * recipe.place;
    view.centre = (view.centre * figure.size + shift) * recipe.place;
    return view;
}

} // namespace

const std::vector<Recipe>& recipes() {
    static const std::vector<Recipe> all{
        {"loadAndPlay", ofFile<loadAndPlay>, "walker.skin", 0.25, kFigure},
        {"chooseClip", ofFile<chooseClip>, "walker.skin", 0.15, kFigure},
        {"climbStairs",
         climb,
         "pedestrian.skin",
         2.4,
         {Vec3d(-6.2, -8.0, 3.1), Vec3d(0, -3.0, 1.2)},
         Floor::Plain,
         kFirstFrame},
        {"fadeClips", ofFile<fadeClips>, "walker.skin", 0.4, kFigure, Floor::Shadowed, kFirstFrame},
        {"driveBone", ofFile<driveBone>, "walker.skin", 0.5, kFigure},
        {"lookAtTarget",
         ofFile<lookAtTarget>,
         "walker.skin",
         0.3,
         {Vec3d(-0.2, -2.9, 1.5), Vec3d(0.2, 0, 1.3)},
         Floor::Shadowed,
         kHead},
        {"reachTarget",
         ofFile<reachTarget>,
         "walker.skin",
         0.3,
         {Vec3d(-1.6, -2.6, 1.5), Vec3d(-0.1, 0, 1.15)}},
        {"swingHair",
         ofFile<swingHair>,
         "walker.skin",
         0.2,
         {Vec3d(-1.9, 1.6, 1.75), Vec3d(0, 0.1, 1.45)},
         Floor::Shadowed,
         kFirstFrame | kHead},
#ifdef OSGSKIN_LIBLO
        {"receivePoses", ofFile<perform>, "walker.skin", 0.4, kFigure, Floor::Shadowed,
         kFirstFrame},
#endif
#ifdef OSGSKIN_BULLET
        {"fallDown",
         fallDownStairs,
         "pedestrian.skin",
         1.1,
         {Vec3d(-5.2, -4.6, 2.6), Vec3d(0, -1.2, 0.95)},
         Floor::Plain,
         kFirstFrame},
#endif
        {"attachSword",
         ofFile<attachSword>,
         "walker.skin",
         0.0,
         {Vec3d(-2.2, -3.6, 1.4), Vec3d(-0.1, 0, 1.0)}},
        {"pickPoint",
         ofFile<pickPoint>,
         "walker.skin",
         0.25,
         {Vec3d(-1.8, -3.2, 1.6), Vec3d(0, 0, 1.1)}},
        {"castShadow",
         ofFile<castShadow>,
         "walker.skin",
         0.25,
         {Vec3d(-1.2, -4.4, 2.2), Vec3d(0.2, 0, 0.8)},
         Floor::Own},
        {"levelsOfDetail",
         [](File file, double) { return levelsOfDetail(file, coarserOf(file)); },
         "walker.skin",
         0.25,
         {Vec3d(-0.4, -3.4, 1.6), Vec3d(0.3, 0, 1.2)},
         Floor::Plain,
         kWireframe},
        {"makeFace",
         ofFile<makeFace>,
         "face.osgb",
         1.5,
         {Vec3d(-0.28, -0.75, 1.68), Vec3d(0, 0, 1.655)},
         Floor::Shadowed,
         kHead},
        {"makeCrowd",
         [](File file, double) { return makeCrowd(*osgSkin::loadCharacter(file).root); },
         "walker.skin",
         0.4,
         {Vec3d(9, -5, 1.6), Vec3d(11, 3, 0.95)},
         Floor::Own},
        {"makePedestrians",
         [](File file, double) { return makePedestrians(*osgSkin::loadCharacter(file).root); },
         "pedestrian.skin",
         0.4,
         {Vec3d(-6.5, -6.5, 2.4), Vec3d(0.4, 0.4, 0.7)},
         Floor::Plain,
         kFirstFrame},
        {"deformOnCard", ofFile<deformOnCard>, "walker.skin", 0.25, kFigure, Floor::Plain},
        {"ownShader",
         ofFile<ownShader>,
         "walker.skin",
         0.25,
         {Vec3d(-1.3, -3.3, 1.5), Vec3d(0, 0, 0.98)}},
        {"shipAsOsgb", ofFile<shipAsOsgb>, "walker.skin", 0.75, kFigure},
        {"convertScene",
         ofFile<convertScene>,
         "rig.osgt",
         0.15,
         {Vec3d(-0.7, -3.5, 1.7), Vec3d(-0.2, 0, 1.55)}},
        {"largeWorld",
         ofFile<largeWorld>,
         "walker.skin",
         0.5,
         {Vec3d(-0.8, -4.6, 2.4), Vec3d(0, 0, 0.8)},
         Floor::Own,
         kNothing,
         onEarth()},
    };
    return all;
}

Stage stageOf(const Recipe& recipe, const std::string& file, const std::string& samples) {
    const Figure figure = file.empty() ? Figure() : measure(file);
    const osg::ref_ptr<osg::Node> scene =
        recipe.make(file.empty() ? samples + "/" + recipe.sample : file, figure.size);
    Stage stage{scene, viewOf(recipe, figure)};
    if ((recipe.needs & kWireframe) != 0)
        scene->getOrCreateStateSet()->setAttribute(
            new osg::PolygonMode(osg::PolygonMode::FRONT_AND_BACK, osg::PolygonMode::LINE));
    if (recipe.floor == Floor::Own) return stage;
    osg::ref_ptr<osg::Group> group = new osg::Group;
    if (recipe.floor == Floor::Shadowed)
        group = example::withShadow(scene);
    else
        group->addChild(scene);
    group->addChild(example::makeFloor(4.0f * float(figure.size), float(figure.size)));
    stage.scene = group;
    return stage;
}

osg::ref_ptr<osg::Image> pictureOf(const Recipe& recipe, const std::string& file,
                                   const std::string& samples) {
    const Stage stage = stageOf(recipe, file, samples);
    example::Snapshots snapshots(stage.scene, stage.view, 320, 240);
    if ((recipe.needs & kFirstFrame) != 0) snapshots.take(0.0);
    const osg::ref_ptr<osg::Image> picture = snapshots.take(recipe.time);
    // Fewer shades, for small files.
    for (unsigned int i = 0; i < picture->getTotalSizeInBytes(); ++i)
        picture->data()[i] = static_cast<unsigned char>(picture->data()[i] / 8 * 8 + 4);
    return picture;
}
