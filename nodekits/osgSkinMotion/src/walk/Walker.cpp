// SPDX-License-Identifier: MIT
#include <osgSkinMotion/Walker>

#include "walk/SharedPoses.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>

#include <osg/Camera>
#include <osg/CopyOp>
#include <osg/FrameStamp>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osgUtil/CullVisitor>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

/// Copies nodes and skins, whatever else it copies: two walkers must not share a pose.
class OwnSkins : public osg::CopyOp {
public:
    explicit OwnSkins(const osg::CopyOp& other)
        : osg::CopyOp(other.getCopyFlags() | osg::CopyOp::DEEP_COPY_NODES) {}

    using osg::CopyOp::operator();
    osg::Drawable* operator()(const osg::Drawable* drawable) const override {
        if (const auto* skin = dynamic_cast<const DeformableSkin*>(drawable))
            return static_cast<osg::Drawable*>(skin->clone(*this));
        return osg::CopyOp::operator()(drawable);
    }
};

class FindSkins : public osg::NodeVisitor {
public:
    FindSkins() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }
    void apply(osg::Drawable& drawable) override {
        auto* skin = dynamic_cast<DeformableSkin*>(&drawable);
        if (skin && skin->getModel()) skins.emplace_back(skin);
    }
    std::vector<osg::ref_ptr<DeformableSkin>> skins;
};

/// A number above 0 that an environment variable sets; `unset` where it does not.
double numberOfEnvironment(const char* name, const char* expected, double least, double unset) {
    const char* text = std::getenv(name);
    if (!text || !*text) return unset;
    char* end = nullptr;
    const double number = std::strtod(text, &end);
    if (end && *end == '\0' && number >= least && std::isfinite(number)) return number;
    OSG_WARN << "osgSkin: " << name << " is \"" << text << "\", expected " << expected << std::endl;
    return unset;
}

/// The step that OSGSKIN_WALKER_STEP sets; 0: it is not set.
double stepOfEnvironment() {
    static const double step =
        numberOfEnvironment("OSGSKIN_WALKER_STEP", "seconds above 0, such as 0.05",
                            std::numeric_limits<double>::min(), 0.0);
    return step;
}

/// The size that OSGSKIN_WALKER_OWN_POSE sets.
double ownPoseSizeOfEnvironment() {
    static const double size = numberOfEnvironment("OSGSKIN_WALKER_OWN_POSE",
                                                   "pixels of at least 0, such as 90", 0.0, 90.0);
    return size;
}

/// Whether a camera draws pictures, and not depths alone, as for shadows.
bool drawsColours(const osg::Camera& camera) {
    const osg::Camera::BufferAttachmentMap& all = camera.getBufferAttachmentMap();
    return all.empty() || all.rbegin()->first >= osg::Camera::COLOR_BUFFER;
}

osg::Matrixd placeOf(const osg::NodeVisitor& nv) {
    return osg::computeLocalToWorld(nv.getNodePath());
}

/// Draws a shared pose in place of a skin's own.
class StandIn : public DeformableSkin::DrawBackend {
public:
    osg::ref_ptr<DrawBackend> clone() const override { return nullptr; }
    void skinChanged(const DeformableSkin&) override {}
    void poseChanged(const DeformableSkin&) override {}
    osg::Geometry* cull(const DeformableSkin&, osgUtil::CullVisitor&) override {
        return geometry.get();
    }
    void compileGLObjects(osg::RenderInfo& renderInfo) const override {
        geometry->compileGLObjects(renderInfo);
    }
    // The shared poses do this, see Walker.
    void resizeGLObjectBuffers(unsigned int) override {}
    void releaseGLObjects(osg::State*) const override {}

    osg::ref_ptr<osg::Geometry> geometry;
};

} // namespace

/// How it goes, and what is known of the frames before.
struct Walker::Walking {
    static constexpr float kStaysOwn = 0.85f; ///< share of the size below which it shares again
    static constexpr float kNearly = 1.25f;   ///< and below which it prepares for that
    static constexpr float kBetween =
        0.5f; ///< the same, with strides that are between those of all
    static constexpr double kSettles = 0.5;     ///< seconds for which it still counts so afterwards
    static constexpr unsigned int kUnseen = 30; ///< updates without a cull, after which it does
    static constexpr std::size_t kNoPose = ~std::size_t{0};

    struct Rigid {
        osg::ref_ptr<osg::MatrixTransform> transform;
        std::size_t joint;
    };

    Walking(const Gaits& gaits, const osg::ref_ptr<const SharedPoses>& poses)
        : gait(gaits, poses->hipsHeight()), shared(poses) {}

    const std::vector<osg::BoundingBox>& bounds() const {
        return hasMoved ? shared->all() : shared->standing();
    }

    bool needsOwn() const;
    bool chooseOwn(double from, double dt);
    void leaveShared();
    void showOwn(const Gaits& gaits, double dt);
    void showShared();

    GaitState gait;
    const osg::ref_ptr<const SharedPoses> shared;
    osg::ref_ptr<WalkPlayer> player; ///< of the own pose; null while it shows a shared one
    SharedPoses::Skins skins;
    std::vector<osg::ref_ptr<StandIn>> standIns; ///< of the skins
    std::vector<Rigid> rigids;
    std::mutex posing; ///< of the own pose, where several threads ask for it
    std::atomic<float> size{
        -1.0f}; ///< pixels, the largest since the last update; below 0: not seen
    std::atomic<bool> isAsked{false}; ///< for the own pose, since the last update
    std::atomic<bool> isOld{true};    ///< whether the skins lack the present pose
    float lastSize = 0.0f;
    double unsettled = 0.0;     ///< seconds until strides count as settled
    unsigned int unseen = 0;    ///< updates
    std::size_t pose = kNoPose; ///< the shared one that it shows
    osg::Matrixd place;
    unsigned int frame = std::numeric_limits<unsigned int>::max();
    unsigned int updateFrame = std::numeric_limits<unsigned int>::max(); ///< the last one
    double time = 0.0;
    osg::NodeVisitor::VisitorType visitor = osg::NodeVisitor::NODE_VISITOR;
    bool isFollowing = false; ///< `place`, `frame` and `time` are known
    bool isTold = false;      ///< by setMotion()
    bool isShared = false;    ///< by several transforms
    bool hasMoved = false;
    bool hasBoundsOfAll = false; ///< its skins have those of all poses

    // Of frames without an update or event traversal; several threads may cull.
    std::mutex mutex;
    std::optional<osg::Matrixd> drawn; ///< where it was first
    bool isWarned = false;
};

/// Whether the shared poses are not what it has to show.
bool Walker::Walking::needsOwn() const {
    if (player && player->isPlaying()) return true;
    for (std::size_t i = 0; i < skins.size(); ++i) {
        const DeformableSkin& skin = *skins[i];
        if (skin.isMorphed() || skin.getEager() || skin.getDrawCallback() ||
            (skin.getDrawBackend() && skin.getDrawBackend() != standIns[i]))
            return true;
    }
    return false;
}

/// Whether it has a pose of its own in the next frame.
/// \param from pixels of its height
/// \param dt seconds since the last call
bool Walker::Walking::chooseOwn(double from, double dt) {
    const float seen = size.exchange(-1.0f);
    const bool asked = isAsked.exchange(false);
    unseen = seen < 0.0f ? unseen + 1 : 0;
    if (seen >= 0.0f) lastSize = seen;
    if (unseen > kUnseen) lastSize = 0.0f;
    const auto least = static_cast<float>(from);
    gait.keepLevels(!asked && lastSize > 0.0f && lastSize < kNearly * least);
    if (asked || needsOwn()) return true;
    // A start or a stop passes all levels: it would change at each.
    const bool isBetween = gait.isBetween() || (player && player->isStepping());
    unsettled = isBetween ? kSettles : unsettled - dt;
    const float share = unsettled > 0.0 ? kBetween : player ? kStaysOwn : 1.0f;
    return lastSize >= share * least && lastSize > 0.0f;
}

/// Poses the skins.
void Walker::Walking::showOwn(const Gaits& gaits, double dt) {
    WalkPlayer::Feet feet;
    const bool isNew = !player;
    if (isNew) {
        feet = shared->feet(shared->nearest(gait, 0));
        player = new WalkPlayer(gaits);
        for (const osg::ref_ptr<DeformableSkin>& skin : skins) player->addSkin(skin);
    }
    player->setBounds(&bounds());
    player->follow(gait, dt, isNew ? &feet : nullptr);
    player->pose();
    isOld.store(false, std::memory_order_release);
}

void Walker::Walking::leaveShared() {
    for (std::size_t i = 0; i < skins.size() && pose != kNoPose; ++i)
        if (skins[i]->getDrawBackend() == standIns[i]) skins[i]->setDrawBackend(nullptr);
    pose = kNoPose;
}

/// Lets the skins draw the nearest shared pose.
void Walker::Walking::showShared() {
    constexpr float kFinest = 90.0f; // pixels, up to half of which every second pose will do
    const auto coarseness = static_cast<unsigned int>(
        std::clamp(std::log2(kFinest / std::max(lastSize, 1.0f)), 0.0f, 3.0f));
    const std::size_t nearest = shared->nearest(gait, coarseness);
    isOld.store(true, std::memory_order_relaxed);
    if (nearest == pose) return;
    pose = nearest;
    const SharedPoses::Shown& shown = shared->shown(pose);
    const bool hadBounds = std::exchange(hasBoundsOfAll, hasMoved);
    for (std::size_t i = 0; i < skins.size(); ++i) {
        standIns[i]->geometry = shown.skins[i];
        if (skins[i]->getDrawBackend() == standIns[i] && hadBounds == hasMoved) continue;
        skins[i]->setDrawBackend(standIns[i]);
        skins[i]->setPose(skins[i]->getPose(), bounds()[i]);
    }
    for (const Rigid& rigid : rigids) rigid.transform->setMatrix(shown.joints[rigid.joint]);
}

Walker::Walker() {
    setNumChildrenRequiringEventTraversal(1);
    setNumChildrenRequiringUpdateTraversal(1);
}

Walker::Walker(const Walker& other, const osg::CopyOp& copyop)
    : osg::Group(other, OwnSkins(copyop)), _step(other._step), _ownPoseSize(other._ownPoseSize),
      _isVaried(other._isVaried) {
    setNumChildrenRequiringEventTraversal(getNumChildrenRequiringEventTraversal() + 1);
    setNumChildrenRequiringUpdateTraversal(getNumChildrenRequiringUpdateTraversal() + 1);
    if (other._gaits) setGaits(other._gaits);
}

Walker::~Walker() = default;

void Walker::setStep(double seconds) {
    if (seconds >= 0.0 && std::isfinite(seconds)) _step = seconds;
}

void Walker::setOwnPoseSize(double pixels) {
    if (pixels >= 0.0 && std::isfinite(pixels)) _ownPoseSize = pixels;
}

double Walker::getOwnPoseSize() const {
    return _ownPoseSize < 0.0 ? ownPoseSizeOfEnvironment() : _ownPoseSize;
}

void Walker::setVaried(bool varied) {
    if (varied == _isVaried) return;
    _isVaried = varied;
    if (_walking) _walking->gait.vary(varied ? _number : 0);
}

void Walker::setGaits(const osg::ref_ptr<const Gaits>& gaits) {
    _walking = nullptr;
    _gaits = gaits && gaits->get().standing ? gaits : nullptr;
    if (!_gaits) return;
    FindSkins find;
    osg::Group::traverse(find);
    osg::ref_ptr<const SharedPoses> poses;
    try {
        poses = SharedPoses::of(_gaits, find.skins);
    } catch (const Error& error) {
        throw Error("walker \"" + getName() + "\": " + error.what());
    }
    _walking = std::make_unique<Walking>(*_gaits, poses);
    _walking->skins = find.skins;
    for (std::size_t i = 0; i < find.skins.size(); ++i)
        _walking->standIns.emplace_back(new StandIn);
    for (unsigned int i = 0; i < getNumChildren(); ++i) {
        osg::Transform* const transform = getChild(i)->asTransform();
        osg::MatrixTransform* const matrix = transform ? transform->asMatrixTransform() : nullptr;
        const int joint = matrix ? _gaits->get().standing->find(matrix->getName()) : -1;
        if (joint >= 0) _walking->rigids.push_back({matrix, static_cast<std::size_t>(joint)});
    }
    _number = poses->number();
    if (_isVaried) _walking->gait.vary(_number);
    _walking->showShared();
}

/// Shows the present state of the gait.
/// \param moves whether it has changed
void Walker::show(bool moves, double dt) {
    Walking& walking = *_walking;
    walking.hasMoved = walking.hasMoved || !walking.gait.isStill();
    const double from = getOwnPoseSize();
    if (from > 0.0 && !walking.chooseOwn(from, dt)) {
        walking.player = nullptr;
        walking.showShared();
        return;
    }
    walking.leaveShared();
    if (!moves && !walking.isOld) return;
    walking.showOwn(*_gaits, dt);
    for (const Walking::Rigid& rigid : walking.rigids)
        rigid.transform->setMatrix(walking.player->matrixOf(rigid.joint));
}

/// Poses the skins for a visitor that looks at them.
void Walker::poseNow() {
    Walking& walking = *_walking;
    walking.isAsked.store(true, std::memory_order_relaxed);
    if (!walking.isOld.load(std::memory_order_acquire)) return;
    const std::lock_guard<std::mutex> lock(walking.posing);
    if (walking.isOld.load(std::memory_order_acquire)) walking.showOwn(*_gaits, 0.0);
}

bool Walker::play(const std::string& clip, double fade) {
    if (!_gaits) return false;
    for (const osg::ref_ptr<const SampledClip>& other : _gaits->get().others)
        if (other->name() == clip) {
            if (!_walking->player) _walking->showOwn(*_gaits, 0.0);
            return _walking->player->playClip(*other, fade);
        }
    return false;
}

void Walker::stop(double fade) {
    if (_walking && _walking->player) _walking->player->stopOn(fade);
}

double Walker::phase() const {
    return _walking ? _walking->gait.phase() : 0.0;
}

double Walker::speed() const {
    return _walking ? _walking->gait.speed() : 0.0;
}

void Walker::setMotion(const osg::Vec3d& position, double heading, double speed, double dt) {
    const double numbers = position.x() + position.y() + position.z() + heading + speed + dt;
    if (!_walking || !std::isfinite(numbers) || dt < 0.0) return;
    _walking->isTold = true;
    const osg::Matrixd place =
        osg::Matrixd::rotate(heading - _gaits->get().facing, osg::Vec3d(0, 0, 1)) *
        osg::Matrixd::translate(position);
    _walking->gait.breathe(dt);
    _walking->gait.move(toGlm(place), toGlm(osg::Matrixd::inverse(place)), dt, &speed);
    show(true, dt);
}

/// Whether a traversal comes here by several transforms. It may begin below a viewer's camera.
bool Walker::isShared(const osg::NodeVisitor& nv) {
    osg::Node* const top = nv.getNodePath().front();
    const osg::Matrixd here = placeOf(nv);
    for (const osg::NodePath& path : getParentalNodePaths()) {
        const auto begin = std::find(path.begin(), path.end(), top);
        if (begin != path.end() && osg::computeLocalToWorld({begin, path.end()}) != here)
            return true;
    }
    return false;
}

void Walker::follow(const osg::NodeVisitor& nv) {
    Walking& walking = *_walking;
    const osg::FrameStamp* const stamp = nv.getFrameStamp();
    if (!stamp || walking.isTold) return;
    const unsigned int frame = stamp->getFrameNumber();
    const bool isUpdate = nv.getVisitorType() == osg::NodeVisitor::UPDATE_VISITOR;
    // Where updates come, the program moves transforms until then.
    if (!isUpdate && walking.updateFrame + 1 == frame) return;
    if (isUpdate) walking.updateFrame = frame;
    const osg::Matrixd place = placeOf(nv);
    osg::Matrixd toWalker;
    if (!place.valid() || !toWalker.invert(place)) return;
    const bool isAgain = walking.isFollowing && frame == walking.frame &&
                         nv.getVisitorType() == walking.visitor && place != walking.place;
    if (walking.isShared || isAgain) {
        const bool wasShared = std::exchange(walking.isShared, isShared(nv));
        if (walking.isShared && !wasShared) {
            OSG_WARN << "osgSkin: walker \"" << getName()
                     << "\" is below several transforms and cannot walk in all of these places, "
                        "expected a copy by osg::clone() for each"
                     << std::endl;
            walking.gait.stand();
            walking.player = nullptr;
            show(true, 0.0);
        }
        if (walking.isShared) return;
    }
    const double time = stamp->getSimulationTime();
    double dt = 0.0;
    if (walking.isFollowing && frame != walking.frame) {
        const double own = stepOfEnvironment() > 0.0 ? stepOfEnvironment() : _step;
        dt = own > 0.0 ? own * (frame - walking.frame) : std::abs(time - walking.time);
    }
    const bool isMoved = !walking.isFollowing || place != walking.place;
    const bool isSame = walking.isFollowing && frame == walking.frame;
    walking.place = place;
    walking.frame = frame;
    walking.visitor = nv.getVisitorType();
    walking.time = time;
    walking.isFollowing = true;
    if (isSame && !isMoved) return;
    const bool isActive =
        walking.player && (walking.player->isStepping() || walking.player->isPlaying());
    const bool moves = isMoved || (dt != 0.0 && (isActive || !walking.gait.isStill()));
    if (moves) walking.gait.move(toGlm(place), toGlm(toWalker), dt);
    show(moves, dt);
}

/// Warns where transforms carry the figure along and only draws come here.
void Walker::checkDrawn(const osg::NodeVisitor& nv) {
    Walking& walking = *_walking;
    if (walking.isFollowing || walking.isTold || !nv.getFrameStamp()) return;
    const osg::Matrixd place = placeOf(nv);
    const std::lock_guard<std::mutex> lock(walking.mutex);
    if (!walking.drawn) walking.drawn = place;
    if (place == *walking.drawn || std::exchange(walking.isWarned, true)) return;
    OSG_WARN << "osgSkin: walker \"" << getName()
             << "\" is moved and drawn, but does not walk without update or event traversals: "
                "expected osgViewer's frame() or updateTraversal(), or setMotion()"
             << std::endl;
}

void Walker::traverse(osg::NodeVisitor& nv) {
    const osg::NodeVisitor::VisitorType type = nv.getVisitorType();
    if (_walking &&
        (type == osg::NodeVisitor::UPDATE_VISITOR || type == osg::NodeVisitor::EVENT_VISITOR))
        follow(nv);
    else if (_walking && type == osg::NodeVisitor::CULL_VISITOR) {
        checkDrawn(nv);
        measure(nv);
    } else if (_walking && type != osg::NodeVisitor::COLLECT_OCCLUDER_VISITOR)
        poseNow();
    // One is its own. Updates of far crowds are as long as the memory that they touch.
    if (type == osg::NodeVisitor::UPDATE_VISITOR && getNumChildrenRequiringUpdateTraversal() < 2)
        return;
    if (type == osg::NodeVisitor::EVENT_VISITOR && getNumChildrenRequiringEventTraversal() < 2)
        return;
    osg::Group::traverse(nv);
}

/// Notes how large a camera sees the figure.
void Walker::measure(osg::NodeVisitor& nv) {
    osgUtil::CullVisitor* const cv = nv.asCullVisitor();
    if (!cv || (cv->getCurrentCamera() && !drawsColours(*cv->getCurrentCamera()))) return;
    const float size = std::abs(
        cv->pixelSize(getBound().center(), static_cast<float>(0.5 * _walking->shared->height())));
    float before = _walking->size.load(std::memory_order_relaxed);
    while (before < size &&
           !_walking->size.compare_exchange_weak(before, size, std::memory_order_relaxed)) {
    }
}

void Walker::resizeGLObjectBuffers(unsigned int maxSize) {
    osg::Group::resizeGLObjectBuffers(maxSize);
    if (_walking) _walking->shared->resizeGLObjectBuffers(maxSize);
}

void Walker::releaseGLObjects(osg::State* state) const {
    osg::Group::releaseGLObjects(state);
    if (_walking) _walking->shared->releaseGLObjects(state);
}

} // namespace osgSkin
