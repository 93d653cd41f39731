// SPDX-License-Identifier: MIT
#include "feet/FootTrack.h"

#include "clips/JointMaps.h"
#include "feet/Legs.h"
#include "retarget/PlantedFoot.h"

#include <algorithm>
#include <cmath>

namespace osgSkin {

FootTrack findTrack(const SampledClip& clip, const TrackedFeet& feet) {
    FootTrack result;
    std::vector<JointMap> whole;
    const auto placeOf = [&](std::size_t joint, const glm::dvec3& point) {
        return transformPoint(feet.toLevel, apply(whole[joint], point));
    };
    const std::size_t root = clip.rootJoint();
    for (std::size_t i = 0; i < clip.sampleCount(); ++i) {
        localToModel(clip.joints(), clip.sample(i), whole);
        result.root.push_back(placeOf(root, clip.joints()[root].centre));
        for (std::size_t side = 0; side < feet.ankles.size(); ++side)
            result.ball[side].push_back(placeOf(feet.ankles[side], feet.balls[side]));
    }
    return result;
}

std::vector<double> leftAhead(const FootTrack& track, const glm::dvec3& forward) {
    std::vector<double> ahead;
    for (std::size_t i = 0; i < track.root.size(); ++i)
        ahead.push_back(glm::dot(track.ball[0][i] - track.ball[1][i], forward));
    return ahead;
}

double poseDistance(const SampledClip& clip, const JointSample* a, const JointSample* b) {
    double most = 0.0;
    for (std::size_t j = 0; j < clip.joints().size(); ++j) {
        const double cosine = std::abs(glm::dot(a[j].rotation, b[j].rotation));
        most = std::max(most, 2.0 * std::acos(std::min(1.0, cosine)));
    }
    return most;
}

bool isLoop(const SampledClip& clip) {
    const std::size_t count = clip.sampleCount();
    if (count < 4) return false;
    // Against nine steps of ten: a file may begin with a pose of its own, far from the others.
    std::vector<double> steps;
    for (std::size_t i = 0; i + 1 < count; ++i)
        steps.push_back(poseDistance(clip, clip.sample(i), clip.sample(i + 1)));
    const auto most = steps.begin() + static_cast<std::ptrdiff_t>(9 * steps.size() / 10);
    std::nth_element(steps.begin(), most, steps.end());
    return poseDistance(clip, clip.sample(count - 1), clip.sample(0)) <= 1.2 * *most + 0.02;
}

std::size_t findPeriod(const std::vector<double>& ahead, bool isLoop) {
    const std::size_t count = ahead.size();
    const double most = *std::max_element(ahead.begin(), ahead.end());
    const double least = *std::min_element(ahead.begin(), ahead.end());
    if (!(most > 0.0) || !(least < 0.0)) return 0;
    // The sample of each foot's largest lead, the feet in turn.
    std::vector<std::size_t> leads;
    int side = 0; // 1: the left foot is in front
    for (std::size_t i = 0; i < count; ++i) {
        const int now = ahead[i] > 0.5 * most ? 1 : ahead[i] < 0.5 * least ? -1 : side;
        if (now != side) leads.push_back(i);
        side = now;
        if (now != 0 && now * ahead[i] > now * ahead[leads.back()]) leads.back() = i;
    }
    if (isLoop) {
        // The last lead may be the first one's beginning.
        const std::size_t turns = leads.size() - leads.size() % 2;
        return turns > 0 ? count / (turns / 2) : 0;
    }
    // The clip may begin and end within one.
    if (!leads.empty() && leads.front() == 0) leads.erase(leads.begin());
    if (!leads.empty() && leads.back() + 1 == count) leads.pop_back();
    if (leads.size() < 2) return 0;
    const double step = double(leads.back() - leads.front()) / double(leads.size() - 1);
    return static_cast<std::size_t>(std::lround(2.0 * step));
}

double speedOfFeet(const FootTrack& track, const TrackedFeet& feet, double step, bool isLoop) {
    const std::size_t count = track.root.size();
    std::vector<double> heights;
    for (std::size_t i = 0; i < count; ++i)
        heights.push_back(std::min(track.ball[0][i].z, track.ball[1][i].z));
    const double floor = floorBelow(heights);
    std::vector<double> speeds;
    for (const auto& ball : track.ball)
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t next = (i + 1) % count;
            if ((next == 0 && !isLoop) || ball[i].z > floor + kSpeedContact.height * feet.leg)
                continue;
            const double back =
                glm::dot((ball[i] - track.root[i]) - (ball[next] - track.root[next]), feet.forward);
            if (back > 0.0) speeds.push_back(back / step);
        }
    if (speeds.empty()) return 0.0;
    const auto middle = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2);
    std::nth_element(speeds.begin(), middle, speeds.end());
    return *middle;
}

} // namespace osgSkin
