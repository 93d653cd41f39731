// SPDX-License-Identifier: MIT
#include "Keys.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace viewer {
namespace {

constexpr double kStep = 1.0 / 30.0; ///< seconds
constexpr double kJump = 0.5;

void toggle(bool& setting) {
    setting = !setting;
}

void show(Settings& settings, Colours colours) {
    settings.colours = settings.colours == colours ? Colours::Own : colours;
}

void scrub(Stage& stage, double seconds) {
    stage.clock.playing = false;
    stage.clock.seek(stage.clock.time() + seconds);
}

void changeSpeed(Clock& clock, double factor) {
    clock.speed =
        std::copysign(std::clamp(std::abs(clock.speed) * factor, 0.125, 8.0), clock.speed);
}

/// True if a key needs a character with its mesh and binding.
bool needsBody(int key) {
    return key > 0 && key < 128 && std::strchr("1234gbtjJn", key) != nullptr;
}

} // namespace

const char* keysHelp() {
    return "space  play, pause          m    next motion\n"
           ", .    a step back, on      0    to the start\n"
           "< >    half a second        r    reverse\n"
           "- +    slower, faster\n"
           "1 2 3  osgSkin, linear blending, dual quaternions\n"
           "4      osgSkin without shapes\n"
           "n      normals of the surface, or rotated with vertices\n"
           "u      tense all muscles\n"
           "f F    next morph target, last one\n"
           "[ ]    less, more of it     l    list of morph targets\n"
           "g      regions              b t  bend, twist ratios\n"
           "j J    next joint, last one\n"
           "k      skeleton             w    wireframe\n"
           "x      bounds               c    hit boxes\n"
           "i      this line below\n"
           "s      OSG's statistics     h    these keys";
}

bool press(Stage& stage, int key) {
    using figures::Method;
    Settings& settings = stage.settings;
    if (needsBody(key) && !stage.hasBody()) return true;
    switch (key) {
    case ' ':
        toggle(stage.clock.playing);
        return true;
    case ',':
        scrub(stage, -kStep);
        return true;
    case '.':
        scrub(stage, kStep);
        return true;
    case '<':
        scrub(stage, -kJump);
        return true;
    case '>':
        scrub(stage, kJump);
        return true;
    case '0':
        stage.clock.seek(0.0);
        return true;
    case 'r':
        stage.clock.speed = -stage.clock.speed;
        return true;
    case '-':
        changeSpeed(stage.clock, 0.5);
        return true;
    case '+':
    case '=':
        changeSpeed(stage.clock, 2.0);
        return true;
    case 'm':
        if (stage.motionCount() > 0) stage.setMotion(stage.motion() + 1);
        return true;
    case '1':
        settings.method = Method::Ours;
        return true;
    case '2':
        settings.method = Method::Linear;
        return true;
    case '3':
        settings.method = Method::DualQuaternion;
        return true;
    case '4':
        settings.method = Method::Plain;
        return true;
    case 'n':
        stage.turnNormals(!settings.turnedNormals);
        return true;
    case 'u':
        stage.tense(!settings.tensed);
        return true;
    case 'f':
        stage.changeMorph(1);
        return true;
    case 'F':
        stage.changeMorph(-1);
        return true;
    case '[':
        stage.weighMorph(-0.25f);
        return true;
    case ']':
        stage.weighMorph(0.25f);
        return true;
    case 'l':
        toggle(settings.morphs);
        return true;
    case 'g':
        show(settings, Colours::Regions);
        return true;
    case 'b':
        show(settings, Colours::Bend);
        return true;
    case 't':
        show(settings, Colours::Twist);
        return true;
    case 'j':
        stage.changeJoint(1);
        return true;
    case 'J':
        stage.changeJoint(-1);
        return true;
    case 'k':
        toggle(settings.skeleton);
        return true;
    case 'w':
        toggle(settings.wireframe);
        return true;
    case 'x':
        toggle(settings.bounds);
        return true;
    case 'c':
        stage.showHitBoxes(!settings.hitBoxes);
        return true;
    case 'i':
        toggle(settings.status);
        return true;
    case 'h':
        toggle(settings.help);
        return true;
    default:
        return false;
    }
}

bool Keys::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter&) {
    return event.getEventType() == osgGA::GUIEventAdapter::KEYDOWN && press(_stage, event.getKey());
}

} // namespace viewer
