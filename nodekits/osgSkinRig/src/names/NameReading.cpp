// SPDX-License-Identifier: MIT
#include "names/NameReading.h"

#include "names/NameWords.h"
#include "names/RoleTree.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <set>

namespace osgSkin {
namespace {

using Words = std::vector<std::string>;

/// Share of a skeleton's names that counts as nearly all: exporters add a root or a mesh's node.
constexpr double kNearlyAll = 0.8;

Side sideOf(const std::string& word) {
    static const std::map<std::string, Side> sides{
        {"l", Side::Left},      {"left", Side::Left}, {"lft", Side::Left},
        {"lf", Side::Left},     {"lt", Side::Left},   {"r", Side::Right},
        {"right", Side::Right}, {"rgt", Side::Right}, {"rt", Side::Right}};
    const auto found = sides.find(word);
    return found == sides.end() ? Side::None : found->second;
}

/// Marks of central joints: "Root_M", "spine.x", "J_Bip_C_".
bool isCentre(const std::string& word, bool atEnd) {
    static const std::set<std::string> words{"c", "cn", "ctr", "center", "centre"};
    return words.count(word) != 0 || (atEnd && (word == "m" || word == "x"));
}

/// Suffixes that only say that this is a joint.
bool isSuffix(const std::string& word) {
    static const std::set<std::string> words{"bone", "joint",   "jnt",  "jt",  "jn",    "bn",
                                             "def",  "deform",  "bind", "bnd", "skin",  "sjnt",
                                             "bend", "stretch", "skl",  "env", "export"};
    return words.count(word) != 0;
}

/// The number of letters of the longest part's name. Words that are joined have this and a side at
/// either end at most.
std::size_t longestPart() {
    static const std::size_t longest = [] {
        std::size_t most = 0;
        for (const auto& [text, word] : bodyWords()) most = std::max(most, text.size());
        return most;
    }();
    return longest;
}

constexpr std::size_t kTwoSides = 10;

/// A name while it is being read: the words up to `end` are still unread.
class Reader {
public:
    Reader(const Words& words, const NameHabits& habits)
        : _words(words), _habits(habits), _end(words.size()) {}

    std::optional<NameReading> read() {
        dropEnding();
        const NameReading ended = _result;
        const std::size_t end = _end;
        if (end > 0 && readWhole())
            if (auto result = finished()) return result;
        // Letters without a word boundary, in the last word or in several ("lefthand",
        // "leftUpper_arm", "ForeArmleft"): finds the longest part that they end with.
        std::optional<NameReading> best;
        std::size_t longest = 0;
        std::string run;
        for (std::size_t first = end; first > 0 && !isNumber(_words[first - 1]); --first) {
            run.insert(0, _words[first - 1]);
            if (first < end && run.size() > longestPart() + kTwoSides) break;
            for (const char* side : {"", "left", "right", "l", "r"}) {
                _result = ended;
                _rest.clear();
                _end = first - 1;
                if (!readRun(run, side)) continue;
                // A part of several words starts at a word boundary: "DEF-Armleft" is no "farm".
                if (first < end && !_rest.empty()) continue;
                const auto result = finished();
                if (!result || _partSize <= longest) continue;
                best = result;
                longest = _partSize;
            }
        }
        return best;
    }

private:
    const std::string& last() const { return _words[_end - 1]; }

    bool takeSide(const std::string& word) {
        if (_result.side != Side::None || sideOf(word) == Side::None) return false;
        _result.side = sideOf(word);
        return true;
    }

    /// "Bendleft": a side directly behind a tool's suffix.
    bool takeSideOfSuffix(const std::string& word) {
        for (const std::string side : {"left", "right", "l", "r"}) {
            const std::size_t before = word.size() - std::min(word.size(), side.size());
            if (word.compare(before, side.size(), side) == 0 && isSuffix(word.substr(0, before)))
                return takeSide(side);
        }
        return false;
    }

    void dropEnding() {
        if (_habits.counted && _end > 1 && isNumber(last())) --_end;
        for (; _end > 0; --_end) {
            const std::string& word = last();
            if (isNumber(word)) {
                _result.numbers.insert(_result.numbers.begin(), word);
                continue;
            }
            const bool ofPart = _end > 1 && findBodyWord(_words[_end - 2] + word); // "HipJoint"
            if (ofPart) break;
            const bool added = isSuffix(word) || word == _habits.suffix ||
                               (_result.side == Side::None && isCentre(word, true));
            if (!(added || takeSide(word) || takeSideOfSuffix(word)) || _end == 1) break;
        }
    }

    /// A part of one or more whole words, perhaps with the side between them ("Arm_L_Upper").
    bool readWhole() {
        constexpr std::size_t kMaxWords = 5;
        for (std::size_t count = std::min(_end, kMaxWords); count > 0; --count) {
            const std::size_t first = _end - count;
            std::string joined;
            Side between = Side::None;
            for (std::size_t w = first; w < _end; ++w) {
                const Side side = sideOf(_words[w]);
                if (side != Side::None && w > first && between == Side::None &&
                    _result.side == Side::None)
                    between = side;
                else
                    joined += _words[w];
            }
            const std::optional<BodyWord> word = findBodyWord(joined);
            if (!word) continue;
            _result.word = *word;
            if (between != Side::None) _result.side = between;
            _end = first;
            return true;
        }
        return false;
    }

    /// Reads letters that end with a part followed by `side` ("handl").
    bool readRun(const std::string& run, const std::string& side) {
        if (!side.empty() && !takeSide(side)) return false;
        if (run.size() <= side.size() ||
            run.compare(run.size() - side.size(), side.size(), side) != 0)
            return false;
        const std::size_t end = run.size() - side.size();
        for (const auto& [text, word] : bodyWords()) {
            if (end < text.size() || run[end - 1] != text.back() ||
                run.compare(end - text.size(), text.size(), text) != 0)
                continue;
            _result.word = word;
            _partSize = text.size();
            _rest = run.substr(0, end - text.size());
            takeSideBefore();
            // A single letter is no reliable side where other letters precede the part.
            return side.size() != 1 || _rest.empty();
        }
        return false;
    }

    /// "neoleft" before "arm".
    void takeSideBefore() {
        if (_result.side != Side::None) return;
        for (const std::string side : {"left", "right"}) {
            const std::size_t before = _rest.size() - std::min(_rest.size(), side.size());
            if (_rest.compare(before, side.size(), side) != 0) continue;
            takeSide(side);
            _rest.erase(before);
            return;
        }
        if (takeSide(_rest)) _rest.clear();
    }

    void dropPositionalWords() {
        if (!_rest.empty()) return;
        bool centred = false;
        for (; _end > 0; --_end) {
            const bool centre = !centred && _result.side == Side::None && isCentre(last(), false);
            centred = centred || centre;
            if (!centre && !isNumber(last()) && !takeSide(last()) &&
                !isPositional(last(), _result.word))
                return;
        }
    }

    /// The result with its prefix; nothing where the part has no sides.
    std::optional<NameReading> finished() {
        dropPositionalWords();
        for (std::size_t w = 0; w < _end; ++w) {
            // A number in the prefix counts joints ("01_Hips") or copies of a figure. A side
            // further ahead still counts.
            if (isNumber(_words[w]) || (hasSides(_result.word) && takeSide(_words[w]))) continue;
            _result.prefix += _words[w];
            _result.foreign = _result.foreign || isAccessory(_words[w]);
        }
        _result.prefix += _rest;
        _result.foreign = _result.foreign || isAccessory(_rest);
        const bool sided = _result.side != Side::None;
        if (sided && _result.word == BodyWord::Hips) _result.word = BodyWord::Hip;
        if (sided && _result.word == BodyWord::Pelvis) _result.word = BodyWord::HipJoint;
        if (hasSides(_result.word) != sided) return std::nullopt;
        return _result;
    }

    const Words& _words;
    const NameHabits& _habits;
    std::size_t _end;
    std::string _rest;         ///< letters before the part, of the same word
    std::size_t _partSize = 0; ///< letters of the part, of a run
    NameReading _result;
};

} // namespace

NameHabits::NameHabits(const std::vector<Words>& names) {
    std::map<std::string, std::size_t> endings;
    std::set<std::string> numbers;
    std::size_t numbered = 0;
    for (const Words& words : names) {
        if (words.size() > 1 && isNumber(words.back())) {
            ++numbered;
            numbers.insert(words.back());
        }
        for (std::size_t w = words.size(); w > 1; --w)
            if (!isNumber(words[w - 1]) && sideOf(words[w - 1]) == Side::None) {
                ++endings[words[w - 1]];
                break;
            }
    }
    const double all = kNearlyAll * static_cast<double>(names.size());
    const auto isMost = [&](std::size_t count) {
        return count > 3 && static_cast<double>(count) >= all;
    };
    for (const auto& [word, count] : endings)
        if (isMost(count)) suffix = word;
    // "Hips.001", "Spine.001": a number that all names have distinguishes nothing.
    counted = isMost(numbered) && (2 * numbers.size() > numbered || numbers.size() == 1);
}

std::optional<NameReading> readName(const Words& words, const NameHabits& habits) {
    return Reader(words, habits).read();
}

namespace {

using Readings = std::vector<std::optional<NameReading>>;

/// One side of a body: the words in its names, and what ambiguous ones mean there.
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

    /// Index of a joint in its chain of joints with the same word, from 0.
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

    /// "Hip" is the thigh's joint unless another name says thigh.
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

    /// "Shoulder" is the collar bone where its child is an upper arm.
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
        // "Finger2" below "Finger1": the number counts the joints of a hand's only finger.
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

namespace {

using Readings = std::vector<std::optional<NameReading>>;

/// A prefix that a skeleton shares has at least so many joints.
constexpr std::size_t kMinShared = 4;

/// A foreign word is a valid prefix where nearly all joints have it: a figure may be called Wing.
constexpr double kMaxJoints = 0.8;

/// How many prefixes are tried: each visits all joints, and figures have few.
constexpr std::size_t kMaxPrefixes = 100;

std::set<std::string> distinct(const std::vector<std::string>& roles) {
    std::set<std::string> result(roles.begin(), roles.end());
    result.erase("");
    return result;
}

bool beginsWith(const std::vector<std::string>& words, const std::string& prefix) {
    std::string joined;
    for (const std::string& word : words) {
        if (!isNumber(word)) joined += word;
        if (joined.size() >= prefix.size()) break;
    }
    return joined.compare(0, prefix.size(), prefix) == 0;
}

/// The joints under one prefix, each with its role.
std::vector<std::string> rolesUnder(const RestSkeleton& skeleton, Readings readings,
                                    const std::string& prefix) {
    for (auto& reading : readings)
        if (reading && reading->prefix != prefix) reading.reset();
    std::vector<std::string> roles = limbRoles(skeleton, readings);
    settleRoles(skeleton, roles);
    return roles;
}

} // namespace

WordRoles wordRoles(const RestSkeleton& skeleton) {
    std::vector<std::vector<std::string>> names;
    for (const RestJoint& joint : skeleton.joints) names.push_back(nameWords(joint.name));
    const NameHabits habits(names);

    WordRoles result;
    result.roles.resize(names.size());
    std::map<std::string, std::size_t> prefixes;
    std::set<std::string> foreign;
    for (const auto& words : names) {
        result.readings.push_back(readName(words, habits));
        if (const auto& reading = result.readings.back()) {
            ++prefixes[reading->prefix];
            if (reading->foreign) foreign.insert(reading->prefix);
        }
    }
    std::size_t most = 0, tried = 0;
    for (const auto& [prefix, count] : prefixes) {
        if (count < kMinShared || count < most || ++tried > kMaxPrefixes) continue;
        if (foreign.count(prefix) != 0) {
            const auto sharing =
                std::count_if(names.begin(), names.end(),
                              [p = prefix](const auto& words) { return beginsWith(words, p); });
            if (static_cast<double>(sharing) < kMaxJoints * static_cast<double>(names.size()))
                continue;
        }
        std::vector<std::string> roles = rolesUnder(skeleton, result.readings, prefix);
        const std::size_t filled = distinct(roles).size();
        // Rigify has each bone twice: "DEF-" deforms the skin, "ORG-" only controls the former.
        const bool preferred = filled == most && prefix == "def";
        if (filled < kMinShared || (filled <= most && !preferred)) continue;
        most = filled;
        result.roles = std::move(roles);
    }
    return result;
}

} // namespace osgSkin
