// SPDX-License-Identifier: MIT
#include "bvh/BvhHierarchy.h"

#include "text/FileText.h"

#include <set>
#include <string>

namespace osgSkin {
namespace {

class Reader {
public:
    Reader(BvhTokens& words, const ReadLimits& limits, BvhFile& file)
        : _words(words), _limits(limits), _file(file) {}

    void run() {
        _words.expect("HIERARCHY");
        const std::string_view root = _words.next();
        if (!isSameWord(root, "ROOT"))
            _words.fail("found " + described(root) + ", expected a ROOT");
        openJoint();
        while (!_open.empty()) readMember();
        if (_file.channels == 0) _words.fail("no joint has CHANNELS, expected at least one");
    }

private:
    struct Open {
        int joint = 0;
        bool hasOffset = false;
        bool hasChannels = false;
    };

    BvhJoint& joint() { return _file.joints[static_cast<std::size_t>(_open.back().joint)]; }
    std::string owner() { return "joint " + inQuotes(joint().name); }

    void readMember() {
        const std::string_view word = _words.next();
        if (isSameWord(word, "OFFSET")) {
            if (_open.back().hasOffset) _words.fail(owner() + " has OFFSET twice");
            _open.back().hasOffset = true;
            joint().offset = offset(owner());
        } else if (isSameWord(word, "CHANNELS")) {
            readChannels();
        } else if (isSameWord(word, "JOINT")) {
            openJoint();
        } else if (isSameWord(word, "End")) {
            readEndSite();
        } else if (word == "}") {
            if (!_open.back().hasOffset) _words.fail(owner() + " has no OFFSET");
            _open.pop_back();
        } else {
            _words.fail("found " + described(word) + " in " + owner() +
                        ", expected OFFSET, CHANNELS, JOINT, End Site or }");
        }
    }

    void openJoint() {
        BvhJoint joint;
        joint.name = std::string(_words.jointName());
        joint.parent = _open.empty() ? -1 : _open.back().joint;
        if (!_names.insert(joint.name).second)
            _words.fail("second joint called " + inQuotes(joint.name) + ", expected unique names");
        if (_open.size() >= _limits.depth) // scene graphs are traversed by recursion
            _words.fail("joint " + inQuotes(joint.name) + " is nested more than " +
                        std::to_string(_limits.depth) + " deep (option maxDepth)");
        if (_file.joints.size() >= _limits.joints)
            _words.fail("joint " + inQuotes(joint.name) + " is one of more than " +
                        std::to_string(_limits.joints) + " (option maxJoints)");
        _words.expect("{");
        _open.push_back({static_cast<int>(_file.joints.size())});
        _file.joints.push_back(std::move(joint));
    }

    glm::dvec3 offset(const std::string& what) {
        glm::dvec3 result;
        const char* const axes[] = {"x", "y", "z"};
        for (int k = 0; k < 3; ++k) result[k] = _words.number(what + "'s OFFSET " + axes[k]);
        return result;
    }

    void readEndSite() {
        _words.expect("Site");
        _words.skipName(); // that some give to it
        _words.expect("{");
        _words.expect("OFFSET");
        const glm::dvec3 end = offset("the End Site of " + owner());
        if (!joint().endSite) joint().endSite = end;
        _words.expect("}");
    }

    BvhChannel readChannel() {
        const std::string_view name = _words.next();
        for (const char* const kind : {"position", "rotation"})
            for (int axis = 0; axis < 3; ++axis)
                if (isSameWord(name, std::string(1, "XYZ"[axis]) + kind))
                    return {kind[0] == 'r', axis};
        _words.fail(owner() + " has the channel " + described(name) +
                    ", expected X, Y or Z with position or rotation");
    }

    void readChannels() {
        if (_open.back().hasChannels) _words.fail(owner() + " has CHANNELS twice");
        _open.back().hasChannels = true;
        const std::size_t count = _words.count(owner() + "'s number of CHANNELS", 6);
        joint().firstChannel = _file.channels;
        _file.channels += count;
        std::set<int> positions;
        std::size_t rotations = 0;
        for (std::size_t c = 0; c < count; ++c) {
            const BvhChannel channel = readChannel();
            if (channel.isRotation)
                ++rotations;
            else
                positions.insert(channel.axis);
            joint().channels.push_back(channel);
        }
        if (rotations > 3 || positions.size() + rotations != count)
            _words.fail(owner() + " has CHANNELS of another kind than supported, expected up to "
                                  "three rotations, and each position once at most");
    }

    BvhTokens& _words;
    const ReadLimits& _limits;
    BvhFile& _file;
    std::vector<Open> _open;
    std::set<std::string> _names;
};

} // namespace

void readBvhHierarchy(BvhTokens& words, const ReadLimits& limits, BvhFile& file) {
    Reader(words, limits, file).run();
}

} // namespace osgSkin
