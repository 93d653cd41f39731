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
#include <vector>

namespace viewer {

/// Where a motion stands: plays, pauses, runs at any speed either way, begins again at its end.
class Clock {
public:
    explicit Clock(double seconds = 0.0) : _length(seconds) {}

    void advance(double seconds); ///< of real time
    void seek(double seconds);    ///< to a place in the motion, wrapped into it
    double time() const { return _time; }
    double length() const { return _length; }

    bool playing = true;
    double speed = 1.0; ///< negative: backwards

private:
    double _length; ///< 0: nothing moves
    double _time = 0.0;
};

/// Lets a character's skins show the normals of their surface, or those that turn with vertices.
class NormalsSwitch {
public:
    /// \param character whose skins' parts and binding are known; else it can't be switched
    explicit NormalsSwitch(const osgSkin::Character& character);

    bool canSwitch() const { return !_skins.empty(); }
    /// The skins come to their rest pose; the next update traversal poses them.
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

/// What a person may turn on and off.
struct Settings {
    figures::Method method = figures::Method::Ours;
    Colours colours = Colours::Own;
    std::size_t joint = 0;      ///< whose ratios are shown
    bool tensed = false;        ///< all muscles
    bool turnedNormals = false; ///< instead of the surface's
    bool skeleton = false;
    bool wireframe = false;
    bool bounds = false;
    bool help = false;
    bool status = true;
};

/// The scene: a character as loaded, or in its place the same body deformed by a peer or coloured
/// by what binding found; its skeleton, its bounds, the floor under its feet, and a line that says
/// what is shown. One update traversal brings all of it to the simulation time that it is given.
class Stage {
public:
    /// \throw std::exception where a file cannot be used
    Stage(const std::string& character, const std::string& weights,
          const osgSkin::LoadOptions& options, int width, int height);

    Settings settings;
    Clock clock;

    osg::Group* root() const { return _root.get(); }
    example::View view() const; ///< that shows the figure in all of the motion

    std::size_t motionCount() const { return _figure.motionCount(); }
    std::size_t motion() const { return _motion; }
    void setMotion(std::size_t index);
    /// \throw std::runtime_error where there is none of that name
    void setMotion(const std::string& name);
    /// \throw std::runtime_error where there is none of that name
    void setJoint(const std::string& name);
    /// Whether regions, ratios and the peers can be shown: not of a scene whose skins were bound
    /// before.
    bool hasBody() const { return _figure.body != nullptr; }
    /// Lets normals turn with their vertices instead of following the surface, where the character
    /// has both.
    void turnNormals(bool on);
    /// Tenses all muscles, or lets them go.
    void tense(bool on);
    /// Goes on to the next joint that skin follows in part, or to the one before.
    void changeJoint(int step);

    /// What the viewer's frame() is to be given, so that the motion is where the clock says.
    double simulationTime() const { return _start + clock.time(); }
    /// The status line, without the times that differ from run to run.
    std::string summary() const;
    /// How long the last frame and its skin took, milliseconds.
    std::string times() const;

private:
    class Update;
    void update();
    void placeFloor();
    void updateFigure();
    void updateSkeleton();
    void updateBounds();
    osg::Vec4 colourOf(std::size_t vertex) const;

    std::string _file;
    Figure _figure;
    std::optional<osgSkin::BoneReader> _bones; ///< of the body
    std::optional<NormalsSwitch> _normals;     ///< of the body, once it was asked for
    std::size_t _motion = 0;
    double _start = 0.0;       ///< simulation time of the motion's beginning
    double _given = 0.0;       ///< the last simulation time that was given
    bool _productShown = true; ///< and not the body in its place
    double _skinTime = 0.0;    ///< milliseconds that this frame's skin took
    double _frameTime = 0.0;   ///< milliseconds from frame to frame, a mean of late
    std::chrono::steady_clock::time_point _lastFrame;

    osg::ref_ptr<osg::Group> _root, _study, _lines, _boxes;
    osg::ref_ptr<osg::MatrixTransform> _floor;
    PlayedExtent _extent;               ///< of the motion that is shown
    double _aspect;                     ///< the picture's width to its height
    osg::ref_ptr<osg::StateSet> _state; ///< of the figure
    osg::ref_ptr<osg::Node> _help;
    osg::ref_ptr<osgText::Text> _status;
};

} // namespace viewer

#endif
