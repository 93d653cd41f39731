// SPDX-License-Identifier: MIT
#ifndef OSGSKINMOTION_PLAYERS_CLIPLAYERS_H
#define OSGSKINMOTION_PLAYERS_CLIPLAYERS_H

#include <osgSkinMotion/ClipPlayer>
#include <osgSkinMotion/SampledClip>

#include <osg/Vec3d>
#include <osg/ref_ptr>

#include <cstddef>
#include <deque>
#include <memory>
#include <vector>

namespace osgSkin {

/// The layers of a ClipPlayer, their fades and events, and the movement of the root. Indices,
/// numbers and clips are as the player's functions take them.
class ClipLayers {
public:
    using Layer = ClipPlayer::Layer;
    using Easing = ClipPlayer::Easing;
    using Root = ClipPlayer::Root;

    /// Rotates about `up` at a pivot on the ground, then moves along the ground.
    struct GroundMove {
        double angle = 0.0;
        osg::Vec3d shift;
    };

    void set(std::size_t index, const Layer& layer);
    const Layer& get(std::size_t index) const;
    void seek(std::size_t index, double time);
    void setPhase(double phase);
    void setSpeed(std::size_t index, double speed);
    void fade(std::size_t index, double weight, double seconds, Easing easing);
    /// \param posed see sample()
    void play(const Layer& layer, double seconds, Easing easing, const JointSample* posed);
    void playOn(const Layer& layer, double seconds, Easing easing);
    void stopOn(double seconds, Easing easing);

    void addEvent(const SampledClip* clip, double time, const std::string& name,
                  const ClipPlayer::Event& event);
    void onEvent(const std::string& name, const ClipPlayer::Event& event);
    void removeEvents(const SampledClip* clip);

    /// Advances times, fades and the root, and finds the events for callEvents().
    void advance(double seconds);
    void callEvents(ClipPlayer& player);

    void setRoot(Root root, const osg::Vec3d& up);
    Root root() const { return _root; }
    const osg::Vec3d& up() const { return _up; }
    GroundMove takeMotion();

    void setInterpolated(bool interpolated) { _interpolated = interpolated; }
    bool isInterpolated() const { return _interpolated; }

    /// Finds out which layers are seen, for the functions below.
    /// \return the clip whose joints are posed; null where nothing plays
    const SampledClip* prepare();

    /// The joints of prepare()'s clip.
    /// \param joints resized to these
    /// \param posed transforms of layer 0's joints in place of its clip's; may be null
    void sample(std::vector<JointSample>& joints, const JointSample* posed) const {
        sampleBelow(_slots.size(), joints, posed);
    }

    /// The layer that hides those below and has none above; null where layers are blended.
    const Layer* alone() const;

    /// Whether what is seen has changed continuously since markPosed().
    bool isContinued() const;
    void markPosed();

private:
    friend struct AttachmentFile; // the serializers'

    /// A joint of prepare()'s clip that a layer moves.
    struct Match {
        std::size_t joint;
        int own;      ///< in the layer's clip; -1: it is at rest there
        double share; ///< of the layer's weight
    };

    struct Slot {
        Layer layer;
        Easing easing = Easing::Linear;
        double fadeFrom = 0.0, fadeTo = 0.0, fadeSeconds = 0.0, faded = 0.0; ///< seconds: 0 if none
        bool ends = false;         ///< is empty after its fade
        bool starts = true;        ///< its time has not passed yet
        bool jumps = false;        ///< is seen, and its clip was replaced since markPosed()
        bool wasActive = false;    ///< at prepare()
        bool movesRoot = false;    ///< the clip's root is not masked
        double before = 0.0;       ///< the time before advance()
        double posedTime = 0.0;    ///< at markPosed()
        std::vector<Match> joints; ///< that it moves
        const FootContacts* steps = nullptr; ///< of its clip, if it plays in step
        std::vector<JointSample> reference;  ///< of these, if it is additive

        bool isActive() const { return layer.clip && layer.weight > 0.0; }
        bool isFull() const {
            return layer.clip && layer.weight >= 1.0 && layer.joints.empty() && !layer.additive;
        }
    };

    struct Event {
        osg::ref_ptr<const SampledClip> clip;
        double time;
        std::string name;
        ClipPlayer::Event call;
    };

    /// An event that advance() has found.
    struct Reached {
        double share; ///< of the step
        std::size_t layer, order;
        std::shared_ptr<const Event> event;
    };

    void assign(Slot& slot, const Layer& layer);
    void replace(std::size_t index, const Layer& layer);
    void moveDown();
    void startFade(Slot& slot, double weight, double seconds, Easing easing);
    void advanceTimes(double seconds);
    void advanceFade(Slot& slot, double seconds);
    bool playBack(const Layer& layer, double seconds, Easing easing);
    void findReached(std::size_t index);
    std::size_t firstSeen(std::size_t end) const;
    void matchJoints(Slot& slot) const;
    void blend(const Slot& slot, const JointSample* posed, std::vector<JointSample>& joints) const;
    void sampleBelow(std::size_t end, std::vector<JointSample>& joints,
                     const JointSample* posed) const;
    osg::ref_ptr<const SampledClip> frozen(const JointSample* posed);

    // RootMotion.cpp
    bool extracts() const { return _root != Root::Moving && _root != Root::InPlace; }
    GroundMove then(const GroundMove& first, const GroundMove& next) const;
    GroundMove reversed(const GroundMove& move) const;
    GroundMove power(GroundMove move, double times) const;
    osg::Vec3d alongGround(const osg::Vec3d& v) const { return v - _up * (v * _up); }
    double headingOf(const JointSample& root) const;
    GroundMove rootMove(const SampledClip& clip, const JointSample& root) const;
    GroundMove rootAt(const Layer& layer, double time, double& loops) const;
    bool areAlike(const SampledClip& clip, std::size_t a, std::size_t b) const;
    GroundMove seamStep(const SampledClip& clip) const;
    GroundMove rootStep(const Slot& slot) const;
    void advanceRoot();
    void keepInPlace(const SampledClip& clip, JointSample& root) const;

    std::deque<Slot> _slots; ///< growth keeps references to layers
    bool _crosses = false;   ///< play() fades from layer 0 to layer 1
    bool _interpolated = true;
    Root _root = Root::Moving;
    osg::Vec3d _up{0.0, 1.0, 0.0};
    GroundMove _motion; ///< not taken yet; about rest space's origin

    std::vector<std::shared_ptr<const Event>> _events;
    std::vector<Reached> _reached;

    bool _known = true;                 ///< what follows was found for the present clips
    std::size_t _first = 0;             ///< firstSeen() of all
    const SampledClip* _base = nullptr; ///< whose joints are posed: a slot's
};

} // namespace osgSkin

#endif
