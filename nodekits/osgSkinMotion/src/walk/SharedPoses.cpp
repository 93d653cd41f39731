// SPDX-License-Identifier: MIT
#include "walk/SharedPoses.h"

#include <osgSkin/Error>

#include <algorithm>
#include <cmath>
#include <map>

namespace osgSkin {
namespace {

/// Leg lengths by which planted feet and blends may leave the bounds of the clips' poses.
constexpr double kRoom = 0.15;

constexpr std::size_t kSteps = 48;    ///< in which a cycle is walked
constexpr double kStepSeconds = 0.02; ///< s

constexpr std::size_t kBoundSamples = 8; ///< of a clip

std::size_t nearestOf(double share, std::size_t count, std::size_t step) {
    const double place = (share - std::floor(share)) * double(count) / double(step);
    return static_cast<std::size_t>(std::lround(place)) * step % count;
}

} // namespace

osg::ref_ptr<const SharedPoses> SharedPoses::of(const osg::ref_ptr<const Gaits>& gaits,
                                                const Skins& skins) {
    static std::mutex mutex;
    // By the clip: gaits of equal files have the same ones.
    static auto* const known = new std::map<const SampledClip*, osg::observer_ptr<SharedPoses>>;
    const std::lock_guard<std::mutex> lock(mutex);
    osg::ref_ptr<SharedPoses> poses;
    const SampledClip* const clip = gaits->get().walking.clip;
    const auto found = known->find(clip);
    if (found != known->end() && found->second.lock(poses) && poses->has(gaits->get(), skins))
        return poses;
    poses = new SharedPoses(gaits, skins);
    for (auto it = known->begin(); it != known->end();)
        it = it->second.valid() ? std::next(it) : known->erase(it);
    (*known)[clip] = poses;
    return poses;
}

SharedPoses::SharedPoses(const osg::ref_ptr<const Gaits>& gaits, const Skins& skins)
    : _gaits(gaits), _player(new WalkPlayer(*gaits)), _rows(1 + 2 * kRows),
      _shown(kStanding + 2 * kRows * kPhases) {
    for (const osg::ref_ptr<DeformableSkin>& skin : skins) {
        _skins.push_back(osg::clone(skin.get(), osg::CopyOp(osg::CopyOp::SHALLOW_COPY)));
        _skins.back()->setDrawBackend(nullptr);
        _player->addSkin(_skins.back());
    }
    if (!_player->pose()) throw Error("the clips cannot pose its skins");
    osg::BoundingBox whole;
    for (const osg::ref_ptr<DeformableSkin>& skin : _skins) {
        osg::BoundingBox box;
        for (const osg::Vec3& vertex :
             static_cast<const osg::Vec3Array&>(*skin->getDeformedGeometry()->getVertexArray()))
            box.expandBy(vertex);
        _standing.push_back(box);
        for (unsigned int i = 0; i < 8; ++i)
            whole.expandBy(osg::Vec3d(box.corner(i)) * gaits->get().toWalker);
    }
    _height = whole.valid() ? static_cast<double>(whole.zMax() - whole.zMin()) : 1.0;
}

SharedPoses::~SharedPoses() {
    for (const std::atomic<const Shown*>& shown : _shown) delete shown.load();
}

/// Whether these skins look and go like those that pose.
bool SharedPoses::has(const Gaits::Set& set, const Skins& skins) const {
    const Gaits::Set& own = _gaits->get();
    if (set.standing != own.standing || set.running.clip != own.running.clip ||
        set.others != own.others || set.walking.stride != own.walking.stride ||
        set.running.stride != own.running.stride || set.toWalker != own.toWalker ||
        set.facing != own.facing)
        return false;
    return std::equal(skins.begin(), skins.end(), _skins.begin(), _skins.end(),
                      [](const auto& a, const auto& b) {
                          const osg::Geometry& x = *a->getRestGeometry();
                          const osg::Geometry& y = *b->getRestGeometry();
                          if (a->getModel() != b->getModel() ||
                              a->getTangentAttribute() != b->getTangentAttribute() ||
                              x.getPrimitiveSetList() != y.getPrimitiveSetList())
                              return false;
                          osg::Geometry::ArrayList arrays, others;
                          x.getArrayList(arrays);
                          y.getArrayList(others);
                          return arrays == others;
                      });
}

std::size_t SharedPoses::nearest(const GaitState& gait, unsigned int coarseness) const {
    const Gaits::Set& set = _gaits->get();
    const std::size_t step = std::size_t{1} << std::min(coarseness, 3u);
    auto row = static_cast<std::size_t>(std::lround(gait.effort()));
    if (!set.running.clip) row = std::min(row, GaitState::kLevels);
    if (row == 0) return nearestOf(gait.standingTime() / set.standing->duration(), kStanding, 1);
    if (gait.goesBack()) row += kRows;
    return kStanding + (row - 1) * kPhases + nearestOf(gait.phase(), kPhases, step);
}

/// Goes through a cycle, and through one before: its feet are then where walkers have them.
SharedPoses::Row SharedPoses::walkThrough(std::size_t row, double direction) const {
    const Gaits::Set& set = _gaits->get();
    const double effort = double(row) / double(GaitState::kLevels);
    const double walking = std::min(effort, 1.0), running = std::max(effort - 1.0, 0.0);
    const double walk = set.walking.clip->duration();
    const double run = set.running.clip ? set.running.clip->duration() : walk;
    constexpr double kStep = 1.0 / double(kPhases);
    GaitState gait(*_gaits, hipsHeight());
    Row result(kPhases);
    for (std::size_t i = 0; i < 2 * kPhases; ++i) {
        const std::size_t phase = direction > 0.0 ? i % kPhases : (2 * kPhases - i) % kPhases;
        gait.show(walking, running, double(phase) * kStep, direction * kStep);
        _player->follow(gait, kStep * (walk + running * (run - walk)));
        if (i >= kPhases) result[phase] = _player->stance();
    }
    return result;
}

const WalkPlayer::Stance& SharedPoses::stance(std::size_t pose) const {
    if (pose >= kStanding) {
        const std::size_t cycle = (pose - kStanding) / kPhases;
        Row& row = _rows[1 + cycle];
        if (row.empty()) row = walkThrough(1 + cycle % kRows, cycle < kRows ? 1.0 : -1.0);
        return row[(pose - kStanding) % kPhases];
    }
    GaitState gait(*_gaits, hipsHeight());
    for (std::size_t i = _rows[0].size(); i < kStanding; ++i) {
        gait.show(double(i) / double(kStanding) * _gaits->get().standing->duration());
        _player->follow(gait, 1.0); // long enough for the feet to be on the floor
        _rows[0].push_back(_player->stance());
    }
    return _rows[0][pose];
}

WalkPlayer::Feet SharedPoses::feet(std::size_t pose) const {
    const std::lock_guard<std::mutex> lock(_mutex);
    return stance(pose).feet;
}

const SharedPoses::Shown& SharedPoses::shown(std::size_t pose) const {
    if (const Shown* const known = _shown[pose].load(std::memory_order_acquire)) return *known;
    all();
    const std::lock_guard<std::mutex> lock(_mutex);
    if (const Shown* const known = _shown[pose].load(std::memory_order_acquire)) return *known;
    _player->show(stance(pose).joints);
    _player->pose();
    auto* const made = new Shown;
    for (std::size_t i = 0; i < _skins.size(); ++i) made->skins.push_back(still(*_skins[i], i));
    for (std::size_t j = 0; j < _gaits->get().standing->joints().size(); ++j)
        made->joints.push_back(_player->matrixOf(j));
    _shown[pose].store(made, std::memory_order_release);
    return *made;
}

/// A copy of the deformed skin in memory that does not change.
osg::ref_ptr<osg::Geometry> SharedPoses::still(const DeformableSkin& skin,
                                               std::size_t index) const {
    const osg::Geometry& deformed = *skin.getDeformedGeometry();
    const osg::ref_ptr<osg::Geometry> result =
        new osg::Geometry(deformed, osg::CopyOp::SHALLOW_COPY);
    const osg::ref_ptr<osg::VertexBufferObject> buffer = new osg::VertexBufferObject;
    const auto copy = [&](const osg::Array* array) {
        const osg::ref_ptr<osg::Array> own = osg::clone(array, osg::CopyOp::DEEP_COPY_ALL);
        own->setVertexBufferObject(buffer);
        return own;
    };
    result->setVertexArray(copy(deformed.getVertexArray()));
    result->setNormalArray(copy(deformed.getNormalArray()));
    if (skin.getTangentAttribute() >= 0) {
        const auto attribute = static_cast<unsigned int>(skin.getTangentAttribute());
        result->setVertexAttribArray(attribute, copy(deformed.getVertexAttribArray(attribute)));
    }
    result->setInitialBound(_all[index]);
    result->getBound(); // now: several cull threads may ask for it at once
    return result;
}

const std::vector<osg::BoundingBox>& SharedPoses::all() const {
    std::call_once(_hasAll, [this] { makeAll(); });
    return _all;
}

/// Finds the bounds of the clips' poses, and room for blends.
void SharedPoses::makeAll() const {
    const std::lock_guard<std::mutex> lock(_mutex);
    const Gaits::Set& set = _gaits->get();
    std::vector<osg::ref_ptr<const SampledClip>> clips = set.others;
    clips.insert(clips.end(), {set.standing, set.walking.clip, set.running.clip});
    _all = _standing;
    std::vector<JointSample> joints(set.standing->joints().size());
    for (const osg::ref_ptr<const SampledClip>& clip : clips)
        for (std::size_t i = 0; clip && i < kBoundSamples; ++i) {
            clip->evaluate(double(i) / double(kBoundSamples) * clip->duration(), true,
                           joints.data());
            _player->show(joints);
            _player->pose();
            for (std::size_t k = 0; k < _skins.size(); ++k)
                _all[k].expandBy(_skins[k]->getBoundingBox());
        }
    const auto room = static_cast<float>(kRoom * _player->meanLeg() / _player->unit());
    for (osg::BoundingBox& box : _all) {
        if (!box.valid()) continue;
        box._min -= osg::Vec3(room, room, room);
        box._max += osg::Vec3(room, room, room);
    }
    _player->setBounds(&_all);
}

void SharedPoses::resizeGLObjectBuffers(unsigned int maxSize) const {
    for (const std::atomic<const Shown*>& shown : _shown)
        if (const Shown* const made = shown.load(std::memory_order_acquire))
            for (const osg::ref_ptr<osg::Geometry>& skin : made->skins)
                skin->resizeGLObjectBuffers(maxSize);
}

void SharedPoses::releaseGLObjects(osg::State* state) const {
    for (const std::atomic<const Shown*>& shown : _shown)
        if (const Shown* const made = shown.load(std::memory_order_acquire))
            for (const osg::ref_ptr<osg::Geometry>& skin : made->skins)
                skin->releaseGLObjects(state);
}

} // namespace osgSkin
