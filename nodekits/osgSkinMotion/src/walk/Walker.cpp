// SPDX-License-Identifier: MIT
#include <osgSkinMotion/Walker>

#include "walk/WalkPlayer.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>

#include <osg/CopyOp>
#include <osg/FrameStamp>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/NodeVisitor>
#include <osg/Notify>

#include <algorithm>
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

/// The step that OSGSKIN_WALKER_STEP sets; 0: it is not set.
double stepOfEnvironment() {
    static const double step = [] {
        const char* text = std::getenv("OSGSKIN_WALKER_STEP");
        if (!text || !*text) return 0.0;
        char* end = nullptr;
        const double seconds = std::strtod(text, &end);
        if (end && *end == '\0' && seconds > 0.0 && std::isfinite(seconds)) return seconds;
        OSG_WARN << "osgSkin: OSGSKIN_WALKER_STEP is \"" << text
                 << "\", expected seconds above 0, such as 0.05" << std::endl;
        return 0.0;
    }();
    return step;
}

osg::Matrixd placeOf(const osg::NodeVisitor& nv) {
    return osg::computeLocalToWorld(nv.getNodePath());
}

} // namespace

/// The player, and what is known of the frames before.
struct Walker::Walking {
    explicit Walking(const osg::ref_ptr<const Gaits>& gaits) : player(new WalkPlayer(gaits)) {}

    const osg::ref_ptr<WalkPlayer> player;
    std::vector<osg::ref_ptr<DeformableSkin>> skins;
    osg::Matrixd place;
    unsigned int frame = std::numeric_limits<unsigned int>::max();
    unsigned int updateFrame = std::numeric_limits<unsigned int>::max(); ///< the last one
    double time = 0.0;
    osg::NodeVisitor::VisitorType visitor = osg::NodeVisitor::NODE_VISITOR;
    bool isFollowing = false; ///< `place`, `frame` and `time` are known
    bool isTold = false;      ///< by setMotion()
    bool isShared = false;    ///< by several transforms

    // Of frames without an update or event traversal; several threads may cull.
    std::mutex mutex;
    std::optional<osg::Matrixd> drawn; ///< where it was first
    bool isWarned = false;
};

Walker::Walker() {
    setNumChildrenRequiringEventTraversal(1);
    setNumChildrenRequiringUpdateTraversal(1);
}

Walker::Walker(const Walker& other, const osg::CopyOp& copyop)
    : osg::Group(other, OwnSkins(copyop)), _step(other._step) {
    setNumChildrenRequiringEventTraversal(getNumChildrenRequiringEventTraversal() + 1);
    setNumChildrenRequiringUpdateTraversal(getNumChildrenRequiringUpdateTraversal() + 1);
    if (other._gaits) setGaits(other._gaits);
}

Walker::~Walker() = default;

void Walker::setStep(double seconds) {
    if (seconds >= 0.0 && std::isfinite(seconds)) _step = seconds;
}

void Walker::findParts() {
    const Gaits::Set& set = _gaits->get();
    FindSkins find;
    accept(find);
    _walking->skins = find.skins;
    for (const osg::ref_ptr<DeformableSkin>& skin : find.skins) _walking->player->addSkin(skin);
    for (unsigned int i = 0; i < getNumChildren(); ++i) {
        osg::Transform* const transform = getChild(i)->asTransform();
        osg::MatrixTransform* const matrix = transform ? transform->asMatrixTransform() : nullptr;
        if (matrix && set.standing->find(matrix->getName()) >= 0)
            _walking->player->addRigid(matrix, matrix->getName(), set.toWalker);
    }
}

void Walker::setGaits(const osg::ref_ptr<const Gaits>& gaits) {
    _walking = nullptr;
    _gaits = gaits && gaits->get().standing ? gaits : nullptr;
    if (!_gaits) return;
    _walking = std::make_unique<Walking>(_gaits);
    findParts();
    stand();
}

/// Shows the standing figure, with bounds that fit it: programs measure a model by them.
void Walker::stand() {
    _walking->player->stand();
    if (!_walking->player->pose())
        throw Error("walker \"" + getName() + "\": the clips cannot pose its skins");
    for (const osg::ref_ptr<DeformableSkin>& skin : _walking->skins) {
        osg::BoundingBox box;
        const auto* vertices =
            dynamic_cast<const osg::Vec3Array*>(skin->getDeformedGeometry()->getVertexArray());
        if (!vertices) continue;
        for (const osg::Vec3& vertex : *vertices) box.expandBy(vertex);
        const Pose pose = skin->getPose();
        skin->setPose(pose, box);
    }
}

bool Walker::play(const std::string& clip, double fade) {
    if (!_gaits) return false;
    for (const osg::ref_ptr<const SampledClip>& other : _gaits->get().others)
        if (other->name() == clip) return _walking->player->playClip(*other, fade);
    return false;
}

void Walker::stop(double fade) {
    if (_walking) _walking->player->stopOn(fade);
}

double Walker::phase() const {
    return _walking ? _walking->player->phase() : 0.0;
}

double Walker::speed() const {
    return _walking ? _walking->player->speed() : 0.0;
}

void Walker::setMotion(const osg::Vec3d& position, double heading, double speed, double dt) {
    const double numbers = position.x() + position.y() + position.z() + heading + speed + dt;
    if (!_walking || !std::isfinite(numbers) || dt < 0.0) return;
    _walking->isTold = true;
    const osg::Matrixd place =
        osg::Matrixd::rotate(heading - _gaits->get().facing, osg::Vec3d(0, 0, 1)) *
        osg::Matrixd::translate(position);
    _walking->player->breathe(dt);
    _walking->player->move(toGlm(place), dt, &speed);
    _walking->player->pose();
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
    if (!place.valid() || !osg::Matrixd().invert(place)) return;
    const bool isAgain = walking.isFollowing && frame == walking.frame &&
                         nv.getVisitorType() == walking.visitor && place != walking.place;
    if (walking.isShared || isAgain) {
        const bool wasShared = std::exchange(walking.isShared, isShared(nv));
        if (walking.isShared && !wasShared) {
            OSG_WARN << "osgSkin: walker \"" << getName()
                     << "\" is below several transforms and cannot walk in all of these places, "
                        "expected a copy by osg::clone() for each"
                     << std::endl;
            walking.player->stand();
            walking.player->pose();
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
    walking.place = place;
    walking.frame = frame;
    walking.visitor = nv.getVisitorType();
    walking.time = time;
    walking.isFollowing = true;
    if (!isMoved && (dt == 0.0 || walking.player->isStill())) return;
    walking.player->move(toGlm(place), dt);
    walking.player->pose();
    dirtyBound();
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
    const bool isUpdate = nv.getVisitorType() == osg::NodeVisitor::UPDATE_VISITOR;
    if (_walking && nv.getVisitorType() == osg::NodeVisitor::CULL_VISITOR) checkDrawn(nv);
    if (_walking && (isUpdate || nv.getVisitorType() == osg::NodeVisitor::EVENT_VISITOR))
        follow(nv);
    osg::Group::traverse(nv);
}

} // namespace osgSkin
