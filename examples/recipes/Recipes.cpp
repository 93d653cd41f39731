// SPDX-License-Identifier: MIT
#include "Recipes.h"
#include "Ground.h"
#include "Performer.h"

#include <osgSkin/DeformableSkin>
#include <osgSkinCharacter/LoadCharacter>

#include <osg/CoordinateSystemNode>
#include <osg/Group>
#include <osg/Math>
#include <osg/MatrixTransform>
#include <osg/PolygonMode>
#include <osg/ShapeDrawable>

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
Scene fallDownStairs(File);
Scene largeWorld(File);
Scene levelsOfDetail(File);
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

/// A figure on stairs, and one on a slope of 20 degrees, beside each other.
Scene climb(File file) {
    const osg::ref_ptr<osg::Group> scene = new osg::Group, stairs = new osg::Group;
    for (int i = 1; i <= 12; ++i) // 36 x 13.1 cm
        stairs->addChild(new osg::ShapeDrawable(
            new osg::Box({0.0f, -0.82f - 0.36f * float(i), 0.0655f * float(i)}, 0.9f, 0.36f,
                         0.131f * float(i))));
    const osg::ref_ptr<osg::Box> slope = new osg::Box({0.0f, -3.178f, 0.74f}, 0.9f, 4.6f, 0.1f);
    slope->setRotation(osg::Quat(osg::DegreesToRadians(-20.0), osg::X_AXIS));
    const osg::ref_ptr<osg::Node> ramp = new osg::ShapeDrawable(slope);
    for (osg::Node* ground : {static_cast<osg::Node*>(stairs.get()), ramp.get()}) {
        const double x = ground == ramp ? 0.7 : -0.7;
        const osg::ref_ptr<osg::MatrixTransform> side =
            new osg::MatrixTransform(osg::Matrixd::translate(x, 0.0, 0.0));
        side->addChild(ground);
        side->addChild(climbStairs(file, *ground));
        scene->addChild(side);
    }
    return scene;
}

/// The recipe's view, for the samples' size.
example::View ownView(const Recipe& recipe) {
    example::View view = recipe.view;
    view.up = osg::Matrixd::transform3x3(view.up, recipe.place);
    view.eye = view.eye * recipe.place;
    view.centre = view.centre * recipe.place;
    return view;
}

/// The extent of the skins, in the world; invalid where there are none, as in crowds.
class SkinExtent : public osg::NodeVisitor {
public:
    SkinExtent() : osg::NodeVisitor(TRAVERSE_ACTIVE_CHILDREN) {}
    void apply(osg::Drawable& drawable) override {
        if (!dynamic_cast<osgSkin::DeformableSkin*>(&drawable)) return;
        const osg::Matrix toWorld = osg::computeLocalToWorld(getNodePath());
        for (unsigned int corner = 0; corner < 8; ++corner)
            box.expandBy(drawable.getBoundingBox().corner(corner) * toWorld);
    }
    osg::BoundingBox box;
};

/// The same direction, with all skins of a scene in view.
example::View viewOfAll(const Recipe& recipe, osg::Node& scene) {
    example::View view = ownView(recipe);
    SkinExtent skins;
    scene.accept(skins);
    const osg::BoundingSphere bound =
        skins.box.valid() ? osg::BoundingSphere(skins.box) : scene.getBound();
    osg::Vec3d back = view.eye - view.centre;
    back.normalize();
    view.centre = bound.center();
    view.eye = view.centre + back * (4.5 * double(bound.radius()));
    return view;
}

} // namespace

const std::vector<Recipe>& recipes() {
    static const std::vector<Recipe> all{
        {"loadAndPlay", loadAndPlay, "walker.skin", 0.25, kFigure},
        {"chooseClip", chooseClip, "walker.skin", 0.15, kFigure},
        {"climbStairs",
         climb,
         "pedestrian.skin",
         2.4,
         {Vec3d(-5.4, -7.4, 2.9), Vec3d(0, -2.9, 1.1)},
         Floor::Plain,
         false,
         {},
         true},
        {"fadeClips", fadeClips, "walker.skin", 0.4, kFigure, Floor::Shadowed, false, {}, true},
        {"driveBone", driveBone, "walker.skin", 0.5, kFigure},
        {"lookAtTarget",
         lookAtTarget,
         "walker.skin",
         0.3,
         {Vec3d(-0.2, -2.6, 1.5), Vec3d(0.2, 0, 1.35)}},
        {"reachTarget",
         reachTarget,
         "walker.skin",
         0.3,
         {Vec3d(-1.6, -2.6, 1.5), Vec3d(-0.1, 0, 1.15)}},
        {"swingHair",
         swingHair,
         "walker.skin",
         0.2,
         {Vec3d(-1.5, 1.3, 1.75), Vec3d(0, 0.05, 1.5)},
         Floor::Shadowed,
         false,
         {},
         true},
#ifdef OSGSKIN_LIBLO
        {"receivePoses", perform, "walker.skin", 0.4, kFigure, Floor::Shadowed, false, {}, true},
#endif
#ifdef OSGSKIN_BULLET
        {"fallDown",
         fallDownStairs,
         "pedestrian.skin",
         1.1,
         {Vec3d(-5.2, -4.6, 2.6), Vec3d(0, -1.2, 0.95)},
         Floor::Plain,
         false,
         {},
         true},
#endif
        {"attachSword",
         attachSword,
         "walker.skin",
         0.0,
         {Vec3d(-2.2, -3.6, 1.4), Vec3d(-0.1, 0, 1.0)}},
        {"pickPoint", pickPoint, "walker.skin", 0.25, {Vec3d(-1.8, -3.2, 1.6), Vec3d(0, 0, 1.1)}},
        {"castShadow",
         castShadow,
         "walker.skin",
         0.25,
         {Vec3d(-1.2, -4.4, 2.2), Vec3d(0.2, 0, 0.8)},
         Floor::Own},
        {"levelsOfDetail",
         levelsOfDetail,
         "walker.skin",
         0.25,
         {Vec3d(-0.4, -3.4, 1.6), Vec3d(0.3, 0, 1.2)},
         Floor::Plain,
         true},
        {"makeFace", makeFace, "face.osgb", 1.5, {Vec3d(-0.28, -0.75, 1.68), Vec3d(0, 0, 1.655)}},
        {"makeCrowd",
         [](File file) { return makeCrowd(*osgSkin::loadCharacter(file).root); },
         "walker.skin",
         0.4,
         {Vec3d(9, -5, 1.6), Vec3d(11, 3, 0.95)},
         Floor::Own},
        {"makePedestrians",
         [](File file) { return makePedestrians(*osgSkin::loadCharacter(file).root); },
         "pedestrian.skin",
         0.4,
         {Vec3d(-6.5, -6.5, 2.4), Vec3d(0.4, 0.4, 0.7)},
         Floor::Plain,
         false,
         {},
         true},
        {"deformOnCard", deformOnCard, "walker.skin", 0.25, kFigure, Floor::Plain},
        {"ownShader", ownShader, "walker.skin", 0.25, {Vec3d(-1.3, -3.3, 1.5), Vec3d(0, 0, 0.98)}},
        {"shipAsOsgb", shipAsOsgb, "walker.skin", 0.75, kFigure},
        {"convertScene",
         convertScene,
         "rig.osgt",
         0.15,
         {Vec3d(-0.7, -3.5, 1.7), Vec3d(-0.2, 0, 1.55)}},
        {"largeWorld",
         largeWorld,
         "walker.skin",
         0.5,
         {Vec3d(-0.8, -4.6, 2.4), Vec3d(0, 0, 0.8)},
         Floor::Own,
         false,
         onEarth()},
    };
    return all;
}

Stage stageOf(const Recipe& recipe, const std::string& file, const std::string& samples) {
    const bool isOwn = file.empty();
    const osg::ref_ptr<osg::Node> scene = recipe.make(isOwn ? samples + "/" + recipe.sample : file);
    Stage stage{scene, isOwn ? ownView(recipe) : viewOfAll(recipe, *scene)};
    if (recipe.isWireframe)
        scene->getOrCreateStateSet()->setAttribute(
            new osg::PolygonMode(osg::PolygonMode::FRONT_AND_BACK, osg::PolygonMode::LINE));
    if (recipe.floor == Floor::Own) return stage;
    osg::ref_ptr<osg::Group> group = new osg::Group;
    if (recipe.floor == Floor::Shadowed)
        group = example::withShadow(scene);
    else
        group->addChild(scene);
    group->addChild(example::makeFloor(4.0f));
    stage.scene = group;
    return stage;
}

osg::ref_ptr<osg::Image> pictureOf(const Recipe& recipe, const std::string& file,
                                   const std::string& samples) {
    const Stage stage = stageOf(recipe, file, samples);
    example::Snapshots snapshots(stage.scene, stage.view, 320, 240);
    if (recipe.fromStart) snapshots.take(0.0);
    const osg::ref_ptr<osg::Image> picture = snapshots.take(recipe.time);
    // Fewer shades, for small files.
    for (unsigned int i = 0; i < picture->getTotalSizeInBytes(); ++i)
        picture->data()[i] = static_cast<unsigned char>(picture->data()[i] / 8 * 8 + 4);
    return picture;
}
