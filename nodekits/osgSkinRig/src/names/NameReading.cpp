// SPDX-License-Identifier: MIT
#include "names/NameReading.h"

#include "names/NameWords.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>

namespace osgSkin {
namespace {

using Words = std::vector<std::string>;

/// What is "nearly all" of a skeleton's names: exporters add a root or a mesh's node of their own.
constexpr double kNearlyAll = 0.8;

Side sideOf(const std::string& word) {
    static const std::map<std::string, Side> sides{
        {"l", Side::Left},      {"left", Side::Left}, {"lft", Side::Left},
        {"lf", Side::Left},     {"lt", Side::Left},   {"r", Side::Right},
        {"right", Side::Right}, {"rgt", Side::Right}, {"rt", Side::Right}};
    const auto found = sides.find(word);
    return found == sides.end() ? Side::None : found->second;
}

/// Marks of joints that have no side, where others have theirs: "Root_M", "spine.x", "J_Bip_C_".
bool isCentre(const std::string& word, bool atEnd) {
    static const std::set<std::string> words{"c", "cn", "ctr", "center", "centre"};
    return words.count(word) != 0 || (atEnd && (word == "m" || word == "x"));
}

/// What tools and authors add to say that a joint is one.
bool isSuffix(const std::string& word) {
    static const std::set<std::string> words{"bone", "joint",   "jnt",  "jt",  "jn",    "bn",
                                             "def",  "deform",  "bind", "bnd", "skin",  "sjnt",
                                             "bend", "stretch", "skl",  "env", "export"};
    return words.count(word) != 0;
}

/// The letters of the longest part. Several words are one with sides at both its ends at most.
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
        // Letters without a boundary, in the last word, or in several ("lefthand",
        // "leftUpper_arm"): the longest part that they end with ("ForeArmleft").
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
                // A part of several words begins where one does: no "farm" in "DEF-Armleft".
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

    /// "Bendleft": a side that runs on from what tools add.
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

    /// A part of one or more whole words; the side may stand between them ("Arm_L_Upper").
    bool readWhole() {
        constexpr std::size_t kMostWords = 5;
        for (std::size_t count = std::min(_end, kMostWords); count > 0; --count) {
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

    /// Reads letters that end with a part, and that with `side` ("handl").
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
            // A single letter is too little to go by where other letters lead up to the part.
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

    void dropWhatLeadsHere() {
        if (!_rest.empty()) return;
        bool centred = false;
        for (; _end > 0; --_end) {
            const bool centre = !centred && _result.side == Side::None && isCentre(last(), false);
            centred = centred || centre;
            if (!centre && !isNumber(last()) && !takeSide(last()) &&
                !saysWhere(last(), _result.word))
                return;
        }
    }

    /// With the prefix; nothing where the side does not go with the part.
    std::optional<NameReading> finished() {
        dropWhatLeadsHere();
        for (std::size_t w = 0; w < _end; ++w) {
            // A number there counts the joints ("01_Hips"), or the copies of a figure. A side that
            // stands further off is one still.
            if (isNumber(_words[w]) || (hasSides(_result.word) && takeSide(_words[w]))) continue;
            _result.prefix += _words[w];
            _result.foreign = _result.foreign || isForeign(_words[w]);
        }
        _result.prefix += _rest;
        _result.foreign = _result.foreign || isForeign(_rest);
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
    // "Hips.001", "Spine.001": a number that all have tells joints from nothing either.
    counted = isMost(numbered) && (2 * numbers.size() > numbered || numbers.size() == 1);
}

std::optional<NameReading> readName(const Words& words, const NameHabits& habits) {
    return Reader(words, habits).read();
}

} // namespace osgSkin
