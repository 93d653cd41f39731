// SPDX-License-Identifier: MIT
#include "text/BvhCheck.h"

#include "text/BvhTokens.h"
#include "text/FileText.h"

#include <osg/Notify>

#include <cmath>
#include <set>
#include <vector>

namespace osgSkin {
namespace {

constexpr std::size_t deepest = 1000;          // Assimp recurses once a level
constexpr std::size_t mostFrames = 16'777'216; // Assimp reads the number as a float
constexpr std::size_t longestName = 1000;      // Assimp drops longer ones

struct Joint {
    std::string name;
    bool hasOffset = false;
    bool hasChannels = false;
};

class Checker {
public:
    Checker(const std::string& path, const std::string& text) : _path(path), _words(path, text) {}

    BvhSummary run() {
        _words.expect("HIERARCHY");
        const std::string_view root = _words.next();
        if (root != "ROOT") _words.fail("found " + described(root) + ", expected a ROOT");
        hierarchy();
        _words.expect("MOTION");
        _words.expect("Frames:");
        BvhSummary summary;
        summary.frames = _words.count("the number of frames", mostFrames);
        _words.expect("Frame");
        _words.expect("Time:");
        summary.frameTime = _words.number("the frame time");
        // Assimp keeps it as a float, where less than this is zero.
        if (!(summary.frameTime > 1e-30))
            _words.fail("the frame time is " + std::to_string(summary.frameTime) +
                        ", expected a positive number of seconds");
        rows(summary.frames);
        return summary;
    }

private:
    void openJoint() {
        const std::string name(_words.next());
        if (name.empty() || name == "{" || name == "}")
            _words.fail("found " + described(name) + ", expected a joint's name");
        if (name.size() > longestName)
            _words.fail("joint " + quoted(name) + " has a name of " + std::to_string(name.size()) +
                        " characters, expected at most " + std::to_string(longestName));
        if (!_names.insert(name).second)
            _words.fail("second joint called " + quoted(name) + ", expected unique names");
        if (_open.size() >= deepest)
            _words.fail("joint " + quoted(name) + " is nested more than " +
                        std::to_string(deepest) + " deep");
        _words.expect("{");
        _open.push_back({name});
    }

    void offset(const std::string& owner) {
        for (const char* axis : {"x", "y", "z"}) _words.number(owner + "'s OFFSET " + axis);
    }

    void channels(Joint& joint) {
        const std::string owner = "joint " + quoted(joint.name);
        if (joint.hasChannels) _words.fail(owner + " has CHANNELS twice");
        joint.hasChannels = true;
        const std::size_t count = _words.count(owner + "'s number of CHANNELS", 6);
        std::set<std::string, std::less<>> positions;
        for (std::size_t c = 0; c < count; ++c) {
            const std::string_view name = _words.next();
            const bool known = name.size() == 9 && name[0] >= 'X' && name[0] <= 'Z' &&
                               (name.substr(1) == "position" || name.substr(1) == "rotation");
            if (!known)
                _words.fail(owner + " has the channel " + described(name) +
                            ", expected X, Y or Z with position or rotation");
            if (name.substr(1) == "position") positions.emplace(name);
            _channelOwners.push_back(joint.name);
        }
        const bool fits = positions.empty() ? count <= 3 : positions.size() == 3 && count == 6;
        if (!fits)
            _words.fail(owner + " has CHANNELS of another kind than supported, expected up to "
                                "three rotations, or three positions and three rotations");
    }

    void endSite(const Joint& joint) {
        _words.expect("Site");
        _words.expect("{");
        _words.expect("OFFSET");
        offset("the End Site of joint " + quoted(joint.name));
        _words.expect("}");
    }

    void hierarchy() {
        openJoint();
        while (!_open.empty()) {
            Joint& joint = _open.back();
            const std::string_view word = _words.next();
            if (word == "OFFSET") {
                joint.hasOffset = true;
                offset("joint " + quoted(joint.name));
            } else if (word == "CHANNELS") {
                channels(joint);
            } else if (word == "JOINT") {
                openJoint();
            } else if (word == "End") {
                endSite(joint);
            } else if (word == "}") {
                if (!joint.hasOffset) _words.fail("joint " + quoted(joint.name) + " has no OFFSET");
                _open.pop_back();
            } else {
                _words.fail("found " + described(word) + " in joint " + quoted(joint.name) +
                            ", expected OFFSET, CHANNELS, JOINT, End Site or }");
            }
        }
        if (_channelOwners.empty()) _words.fail("no joint has CHANNELS, expected at least one");
    }

    struct Row {
        std::size_t line;
        std::size_t values;
    };

    std::vector<Row> readRows() {
        std::vector<Row> result;
        for (std::size_t read = 0;; ++read) {
            const std::string_view word = _words.next();
            if (word.empty()) return result;
            double value = 0.0;
            if (!parseNumber(word, value) || !std::isfinite(value))
                _words.fail("frame " + std::to_string(read / _channelOwners.size()) + ", joint " +
                            quoted(_channelOwners[read % _channelOwners.size()]) + " has " +
                            described(word) + ", expected a finite number");
            if (result.empty() || result.back().line != _words.line())
                result.push_back({_words.line(), 0});
            ++result.back().values;
        }
    }

    void rows(std::size_t frames) {
        const std::size_t expected = _channelOwners.size();
        const std::vector<Row> found = readRows();
        std::size_t total = 0;
        for (const Row& row : found) total += row.values;
        // A frame may be wrapped over several lines, so only the sum must fit then.
        if (total == frames * expected && found.size() != frames) return;
        for (const Row& row : found)
            if (row.values != expected)
                failLine(_path, row.line,
                         "a frame of " + std::to_string(row.values) + " values, expected " +
                             std::to_string(expected) + ", one for each channel");
        if (found.size() < frames)
            failLine(_path, _words.line(),
                     "the motion ends after " + std::to_string(found.size()) +
                         " frame(s), expected the declared " + std::to_string(frames));
        // Some recorders count from 0 here: what is declared can be read.
        if (found.size() > frames)
            OSG_NOTICE << _path << ": line " << found[frames].line << ": " << found.size() - frames
                       << " frame(s) beyond the declared " << frames << ", passed over"
                       << std::endl;
    }

    const std::string& _path;
    BvhTokens _words;
    std::vector<Joint> _open;
    std::set<std::string> _names;
    std::vector<std::string> _channelOwners;
};

} // namespace

BvhSummary checkBvh(const std::string& path, const std::string& text) {
    return Checker(path, text).run();
}

} // namespace osgSkin
