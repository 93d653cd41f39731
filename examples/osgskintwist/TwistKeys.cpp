// SPDX-License-Identifier: MIT
#include "TwistKeys.h"

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace twist {
namespace {

constexpr double kStep = 5.0; ///< degrees a key press
constexpr double kMostBend = 150.0;
constexpr double kMostTwist = 330.0;
constexpr double kSwing = 170.0;     ///< of the twist's animation: short of the half turn's jump
constexpr double kBendSeconds = 5.0; ///< there and back
constexpr double kTwistSeconds = 7.0;

const char kHelp[] = "left, right   bend\n"
                     "up, down      twist\n"
                     "b, t          animate bend, twist\n"
                     "space         pause\n"
                     "r             reset\n"
                     "1, 2, 3       show or hide a copy\n"
                     "w             wireframe\n"
                     "h             hide this help\n"
                     "Escape        leave";
const char kHint[] = "h  help";

} // namespace

TwistKeys::TwistKeys(TwistScene& scene) : _scene(scene) {
    _scene.setHelp(kHint);
}

bool TwistKeys::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) {
    if (event.getHandled()) return false;
    if (event.getEventType() == osgGA::GUIEventAdapter::FRAME) {
        if (_lastFrame >= 0.0) advance(event.getTime() - _lastFrame);
        _lastFrame = event.getTime();
        return false; // others want to see the frame too
    }
    if (event.getEventType() != osgGA::GUIEventAdapter::KEYDOWN || !press(event.getKey()))
        return false;
    action.requestRedraw();
    return true; // so that b, t and space do not also mean what they mean to OSG's own handlers
}

bool TwistKeys::press(int key) {
    switch (key) {
    case osgGA::GUIEventAdapter::KEY_Left:
        turn(-kStep, 0.0);
        return true;
    case osgGA::GUIEventAdapter::KEY_Right:
        turn(kStep, 0.0);
        return true;
    case osgGA::GUIEventAdapter::KEY_Up:
        turn(0.0, kStep);
        return true;
    case osgGA::GUIEventAdapter::KEY_Down:
        turn(0.0, -kStep);
        return true;
    case 'b':
        _bending = !_bending;
        return true;
    case 't':
        _twisting = !_twisting;
        return true;
    case ' ':
        _paused = !_paused;
        return true;
    case 'r':
        _bending = _twisting = _paused = false;
        _bendTime = _twistTime = 0.0;
        _scene.setPose({});
        return true;
    case 'h':
        _help = !_help;
        _scene.setHelp(_help ? kHelp : kHint);
        return true;
    case '1':
    case '2':
    case '3':
        _scene.toggle(static_cast<std::size_t>(key - '1'));
        return true;
    default:
        return false;
    }
}

void TwistKeys::advance(double seconds) {
    if (_paused || !(_bending || _twisting)) return;
    TwistPose pose = _scene.pose();
    if (_bending) {
        _bendTime += seconds;
        pose.bend = 0.5 * kMostBend * (1.0 - std::cos(2.0 * osg::PI * _bendTime / kBendSeconds));
    }
    if (_twisting) {
        _twistTime += seconds;
        pose.twist = kSwing * std::sin(2.0 * osg::PI * _twistTime / kTwistSeconds);
    }
    _scene.setPose(pose);
}

void TwistKeys::turn(double bend, double twist) {
    const TwistPose& pose = _scene.pose();
    _scene.setPose({std::clamp(pose.bend + bend, -kMostBend, kMostBend),
                    std::clamp(pose.twist + twist, -kMostTwist, kMostTwist)});
}

} // namespace twist
