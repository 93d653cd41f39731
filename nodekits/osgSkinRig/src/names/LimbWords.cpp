// SPDX-License-Identifier: MIT
#include "names/LimbWords.h"

#include <array>
#include <map>
#include <set>

namespace osgSkin {
namespace {

using Readings = std::vector<std::optional<NameReading>>;

/// One side of a body: which words its names have, and what the ambiguous ones mean there.
class Limbs {
public:
    Limbs(const RestSkeleton& skeleton, const Readings& readings, Side side)
        : _skeleton(skeleton), _readings(readings), _side(side) {
        for (const auto& reading : readings)
            if (reading && reading->side == side) ++_count[reading->word];
    }

    std::string role(std::size_t joint) const {
        switch (_readings[joint]->word) {
        case BodyWord::Hip:
            return hip();
        case BodyWord::HipJoint:
            return "HipJoint";
        case BodyWord::Thigh:
            return "UpperLeg";
        case BodyWord::Leg:
            return leg(joint);
        case BodyWord::Shin:
            return "LowerLeg";
        case BodyWord::Foot:
            return "Foot";
        case BodyWord::Toe:
            return "Toe";
        case BodyWord::Collar:
            return "Collar";
        case BodyWord::Shoulder:
            return shoulder();
        case BodyWord::UpperArm:
            return "UpperArm";
        case BodyWord::Arm:
            return arm(joint);
        case BodyWord::ForeArm:
            return "LowerArm";
        case BodyWord::Hand:
            return "Hand";
        case BodyWord::FingerBase:
            return "FingerBase";
        case BodyWord::Fingers:
            return "Fingers";
        default:
            return finger(joint);
        }
    }

private:
    bool has(BodyWord word) const { return count(word) > 0; }
    int count(BodyWord word) const {
        const auto found = _count.find(word);
        return found == _count.end() ? 0 : found->second;
    }

    /// Which of the joints of the same word in a row this is, from 0.
    std::size_t place(std::size_t joint) const {
        std::size_t result = 0;
        for (int j = _skeleton.joints[joint].parent; j >= 0;
             j = _skeleton.joints[static_cast<std::size_t>(j)].parent) {
            const auto& above = _readings[static_cast<std::size_t>(j)];
            if (above && above->side == _side && above->word == _readings[joint]->word &&
                fingerOf(static_cast<std::size_t>(j)) == fingerOf(joint))
                ++result;
        }
        return result;
    }

    /// "Hip" is the thigh's joint unless a thigh has a name of its own.
    std::string hip() const {
        const bool thigh = has(BodyWord::Thigh) || (has(BodyWord::Leg) && has(BodyWord::Shin)) ||
                           count(BodyWord::Leg) > 1;
        return thigh ? "HipJoint" : "UpperLeg";
    }

    /// Where all names end with "Joint", "HipJoint" is the thigh's.
    std::string hipJoint() const {
        const bool thigh = has(BodyWord::Thigh) || has(BodyWord::Leg) || has(BodyWord::Hip);
        return thigh || !has(BodyWord::Shin) ? "HipJoint" : "UpperLeg";
    }

    std::string leg(std::size_t joint) const {
        if (has(BodyWord::Thigh)) return has(BodyWord::Shin) ? "" : "LowerLeg";
        if (has(BodyWord::Shin)) return "UpperLeg";
        if (has(BodyWord::Hip) && count(BodyWord::Leg) == 1) return "LowerLeg";
        static const char* const kChain[] = {"UpperLeg", "LowerLeg", "Foot", "Toe"};
        const std::size_t at = place(joint);
        if (at > 1 && has(BodyWord::Foot)) return "";
        return at < 4 ? kChain[at] : "";
    }

    /// "Shoulder" is the collar bone where an upper arm hangs on it.
    std::string shoulder() const {
        if (has(BodyWord::UpperArm)) return "Collar";
        if (!has(BodyWord::Arm)) return has(BodyWord::ForeArm) ? "UpperArm" : "";
        const bool armIsLower =
            !has(BodyWord::ForeArm) && count(BodyWord::Arm) == 1 && has(BodyWord::Collar);
        return armIsLower ? "UpperArm" : "Collar";
    }

    std::string arm(std::size_t joint) const {
        if (has(BodyWord::UpperArm)) return has(BodyWord::ForeArm) ? "" : "LowerArm";
        if (has(BodyWord::ForeArm)) return "UpperArm";
        if (shoulder() == "UpperArm" && has(BodyWord::Shoulder)) return "LowerArm";
        static const char* const kChain[] = {"UpperArm", "LowerArm", "Hand"};
        const std::size_t at = place(joint);
        if (at > 1 && has(BodyWord::Hand)) return "";
        return at < 3 ? kChain[at] : "";
    }

    /// 3ds Max's Biped counts the thumb as finger 0 ("Finger01" is its second joint), MakeHuman as
    /// finger 1 ("finger1-2" is its second joint).
    int fingerOf(std::size_t joint) const {
        const NameReading& reading = *_readings[joint];
        if (reading.word != BodyWord::Finger || reading.numbers.empty()) return -1;
        const int first = reading.numbers[0][0] - '0';
        return reading.numbers.size() > 1 ? first - 1 : first;
    }

    std::string finger(std::size_t joint) const {
        static const std::map<BodyWord, std::string> names{{BodyWord::Thumb, "Thumb"},
                                                           {BodyWord::Index, "Index"},
                                                           {BodyWord::Middle, "Middle"},
                                                           {BodyWord::Ring, "Ring"},
                                                           {BodyWord::Little, "Little"}};
        static const std::array<const char*, 5> kCounted{"Thumb", "Index", "Middle", "Ring",
                                                         "Little"};
        const std::size_t at = place(joint);
        if (at > 2) return "";
        const std::string number = std::to_string(at + 1);
        const BodyWord word = _readings[joint]->word;
        if (names.count(word) != 0) return names.at(word) + number;
        const int counted = fingerOf(joint);
        if (counted < 0 || counted > 4) return "";
        // "Finger2" on "Finger1": the joints are counted, of a hand that has one finger for all.
        if (isOneForAll(joint)) return hangsOnFinger(joint) ? "" : "Fingers";
        return kCounted[static_cast<std::size_t>(counted)] + number;
    }

    bool hangsOnFinger(std::size_t joint) const {
        const int parent = _skeleton.joints[joint].parent;
        if (parent < 0) return false;
        const auto& above = _readings[static_cast<std::size_t>(parent)];
        return above && above->word == BodyWord::Finger && above->side == _side;
    }

    bool isOneForAll(std::size_t joint) const {
        for (std::size_t j = 0; j < _readings.size(); ++j) {
            if (!_readings[j] || _readings[j]->word != BodyWord::Finger || !hangsOnFinger(j))
                continue;
            const auto parent = static_cast<std::size_t>(_skeleton.joints[j].parent);
            if ((j == joint || parent == joint) && fingerOf(j) != fingerOf(parent)) return true;
        }
        return false;
    }

    const RestSkeleton& _skeleton;
    const Readings& _readings;
    Side _side;
    std::map<BodyWord, int> _count;
};

std::string trunkRole(BodyWord word) {
    switch (word) {
    case BodyWord::Hips:
    case BodyWord::Pelvis:
        return "Hips";
    case BodyWord::Spine:
        return "Spine";
    case BodyWord::Neck:
        return "Neck";
    default:
        return "Head";
    }
}

} // namespace

std::vector<std::string> limbRoles(const RestSkeleton& skeleton, const Readings& readings) {
    const Limbs left(skeleton, readings, Side::Left), right(skeleton, readings, Side::Right);
    std::vector<std::string> result(readings.size());
    for (std::size_t j = 0; j < readings.size(); ++j) {
        if (!readings[j]) continue;
        if (readings[j]->side == Side::None) {
            result[j] = trunkRole(readings[j]->word);
            continue;
        }
        const bool isLeft = readings[j]->side == Side::Left;
        const std::string role = isLeft ? left.role(j) : right.role(j);
        if (!role.empty()) result[j] = (isLeft ? "Left" : "Right") + role;
    }
    return result;
}

} // namespace osgSkin
