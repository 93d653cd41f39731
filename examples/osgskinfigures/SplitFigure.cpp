// SPDX-License-Identifier: MIT
#include "SplitFigure.h"

#include "Drawing.h"

#include <osg/Math>
#include <osg/Matrix>
#include <osg/PositionAttitudeTransform>
#include <osg/ShapeDrawable>

namespace figures {
namespace {

constexpr int kWidth = 900;
constexpr int kHeight = 700;
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

/// `from` carried about `axis` through `degrees`, around `centre`, with a head at its end.
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
    const osg::Vec3 besideBall(0.06f, 0.0f, 0.0f); // where an axis points at the camera too
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
    // Axes and arcs run inside the limbs too.
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
                    kWidth, kHeight));
    return photograph(scene, {{1.7, -5.9, 1.5}, {0.65, 0, 0.3}}, kWidth, kHeight);
}

} // namespace figures
