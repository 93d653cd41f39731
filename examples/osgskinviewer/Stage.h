// SPDX-License-Identifier: MIT
#ifndef OSGSKINVIEWER_STAGE_H
#define OSGSKINVIEWER_STAGE_H

#include "Body.h"
#include "Figure.h"
#include "Snapshots.h"

#include <osgSkin/BoneReader>
#include <osgSkin/DeformableSkin>
#include <osgSkin/SkinModel>
#include <osgSkinCharacter/Character>

#include <osg/Group>
#include <osg/MatrixTransform>
#include <osg/ref_ptr>
#include <osgText/Text>

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace viewer {

/// The time of a looping motion; can pause, and run at any speed forwards or backwards.
class Clock {
public:
    explicit Clock(double seconds = 0.0) : _length(seconds) {}

    void advance(double seconds); ///< by real time
    void seek(double seconds);    ///< wraps to the length of the motion
    double time() const { return _time; }
    double length() const { return _length; }

    bool playing = true;
    double speed = 1.0; ///< negative: backwards

private:
    double _length; ///< 0 without a motion
    double _time = 0.0;
};

/// Switches a character's skins between surface normals and normals rotated with the vertices.
class NormalsSwitch {
public:
    /// \param character needs its skins' parts and its binding; otherwise canSwitch() is false
    explicit NormalsSwitch(const osgSkin::Character& character);

    bool canSwitch() const { return !_skins.empty(); }
    /// Resets the skins to the rest pose; the next update traversal poses them.
    void showTurned(bool turned);

private:
    struct Skin {
        osg::ref_ptr<osgSkin::DeformableSkin> drawable;
        osg::ref_ptr<osg::Geometry> rest;
        osg::ref_ptr<const osgSkin::SkinModel> surface, turned;
    };
    std::vector<Skin> _skins;
};

enum class Colours { Own, Regions, Bend, Twist };

/// Settings that the user can change.
struct Settings {
    figures::Method method = figures::Method::Ours;
    Colours colours = Colours::Own;
    std::size_t joint = 0;      ///< the joint for Bend and Twist
    bool tensed = false;        ///< all muscles
    bool turnedNormals = false; ///< instead of surface normals
    bool skeleton = false;
    bool wireframe = false;
    bool bounds = false;
    bool hitBoxes = false;
    bool help = false;
    bool morphs = false; ///< the list of morph targets
    bool status = true;
};

/// The scene: the loaded character, or the same body deformed by another method or coloured by its
/// binding. Also skeleton, bounds, floor and status line. An update traversal sets all of it to the
/// given simulation time.
class Stage {
public:
    /// \throw std::exception if a file cannot be used
    Stage(const std::string& character, const std::string& weights,
          const osgSkin::LoadOptions& options, int width, int height);

    Settings settings;
    Clock clock;

    osg::Group* root() const { return _root.get(); }
    example::View view() const; ///< shows the figure during the whole motion

    std::size_t motionCount() const { return _figure.motionCount(); }
    std::size_t motion() const { return _motion; }
    void setMotion(std::size_t index);
    /// \throw std::runtime_error if there is no motion of that name
    void setMotion(const std::string& name);
    /// \throw std::runtime_error if there is no joint of that name, or the file is a scene
    void setJoint(const std::string& name);
    /// True if regions, ratios and other methods can be shown. False for a scene, whose skins are
    /// already bound.
    bool hasBody() const { return _figure.body != nullptr; }
    /// Rotates normals with their vertices instead of using surface normals, if the character has
    /// both.
    void turnNormals(bool on);
    /// Shows the figure's HitBoxes, which are fitted when they are first shown.
    void showHitBoxes(bool on);
    /// Tenses or relaxes all muscles.
    void tense(bool on);
    /// Selects the next (+1) or previous (-1) joint that has partial ratios.
    void changeJoint(int step);

    /// Selects the next (+1) or previous (-1) morph target.
    void changeMorph(int step);
    /// Adds to the weight of the selected morph target, within 0 and 1.
    void weighMorph(float more);

    /// The argument for the viewer's frame() at the clock's current time.
    double simulationTime() const { return _start + clock.time(); }
    /// The status line without times, which differ between runs.
    std::string summary() const;
    /// The frame time and the time to deform the skin, in milliseconds, as text.
    std::string times() const;

private:
    class Update;
    void update();
    void placeFloor();
    std::string morphList() const;
    void updateFigure();
    void updateSkeleton();
    void updateBounds();
    osg::Vec4 colourOf(std::size_t vertex) const;

    std::string _file;
    Figure _figure;
    std::optional<osgSkin::BoneReader> _bones; ///< of the body
    std::optional<NormalsSwitch> _normals;     ///< created on first use
    std::size_t _motion = 0;
    std::vector<std::pair<std::string, float>> _morphs; ///< morph targets and their weights
    std::size_t _morph = 0;                             ///< the selected one
    double _start = 0.0;                                ///< simulation time of the motion's start
    double _given = 0.0;                                ///< simulation time of the last update
    bool _productShown = true;                          ///< the character itself, not a substitute
    double _skinTime = 0.0;  ///< milliseconds to deform the skin in this frame
    double _frameTime = 0.0; ///< milliseconds per frame, a running mean
    std::chrono::steady_clock::time_point _lastFrame;

    osg::ref_ptr<osg::Group> _root, _study, _lines, _boxes;
    osg::ref_ptr<osg::MatrixTransform> _floor;
    PlayedExtent _extent;               ///< of the current motion
    double _aspect;                     ///< width / height of the picture
    osg::ref_ptr<osg::StateSet> _state; ///< of the figure
    osg::ref_ptr<osg::Node> _hitBoxes;  ///< null: not fitted yet
    osg::ref_ptr<osg::Node> _help;
    osg::ref_ptr<osgText::Text> _status, _morphList;
};

} // namespace viewer

#endif
