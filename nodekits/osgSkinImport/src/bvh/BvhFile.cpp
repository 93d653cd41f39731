// SPDX-License-Identifier: MIT
#include "bvh/BvhFile.h"

#include "files/FileText.h"

#include <osgSkin/GlmTypes>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>

namespace osgSkin {

namespace {

/// Splits the text of a BVH file into words, and counts lines. Words are separated by blanks, tabs,
/// line ends of any system, and braces. A byte order mark is skipped.
class BvhTokens {
public:
    /// \param path of the file, for errors; must outlive this object
    /// \param text of the file; must outlive this object
    BvhTokens(const std::string& path, std::string_view text);

    /// The next word; empty at the end of the file.
    std::string_view next();

    /// Reads the next word and throws unless it is `word`, in any case. A word of letters ends at
    /// the first other character ("Frames:2").
    void expect(std::string_view word);

    /// Reads a joint's name, up to a brace or the end of the line, with inner blanks.
    std::string_view jointName();

    /// Skips an optional name, which ends like a joint's.
    void skipName();

    /// Whether the last word is the last on its line.
    bool isAtLineEnd();

    /// Reads a finite number; `what` names it in the error.
    double number(const std::string& what);

    /// Reads an integer from 0 to `largest`; `what` names it in the error.
    std::size_t count(const std::string& what, std::size_t largest);

    /// Throws "PATH: line N: MESSAGE" for the last word read.
    [[noreturn]] void fail(const std::string& message) const;

    /// Line of the last word read, counted from 1.
    std::size_t line() const { return _line; }

private:
    void skipBlanks();
    std::string_view take(std::size_t length);

    const std::string& _path;
    std::string_view _rest;
    std::size_t _line = 1;
};

// <cctype> depends on the locale, which must not change how a file is read.
bool isBlank(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

bool isLetter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// The word in quotes, or "the end of the file" if it is empty.
std::string described(std::string_view word) {
    return word.empty() ? "the end of the file" : inQuotes(word);
}

/// Whether two words are equal, ignoring case.
bool isSameWord(std::string_view a, std::string_view b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(),
                                              [](char x, char y) { return lower(x) == lower(y); });
}

/// Parses a number in the range of single precision, which osgAnimation uses.
/// \param word to parse
/// \param[out] value the number
/// \return what was expected; null if the word is such a number
const char* parseFinite(std::string_view word, double& value) {
    if (!parseNumber(word, value) || !std::isfinite(value)) return "a finite number";
    return std::abs(value) <= kLargestCoordinate ? nullptr : "a number from -1e18 to 1e18";
}

BvhTokens::BvhTokens(const std::string& path, std::string_view text) : _path(path), _rest(text) {
    const std::string_view byteOrderMark = "\xef\xbb\xbf";
    if (_rest.substr(0, byteOrderMark.size()) == byteOrderMark)
        _rest.remove_prefix(byteOrderMark.size());
    // Old systems end a text with these characters.
    while (!_rest.empty() && (_rest.back() == '\0' || _rest.back() == '\x1a'))
        _rest.remove_suffix(1);
}

void BvhTokens::skipBlanks() {
    std::size_t start = 0;
    for (; start < _rest.size() && isBlank(_rest[start]); ++start) {
        const bool lonely = start + 1 == _rest.size() || _rest[start + 1] != '\n';
        if (_rest[start] == '\n' || (_rest[start] == '\r' && lonely)) ++_line;
    }
    _rest.remove_prefix(start);
}

std::string_view BvhTokens::take(std::size_t length) {
    const std::string_view result = _rest.substr(0, length);
    _rest.remove_prefix(length);
    return result;
}

std::string_view BvhTokens::next() {
    skipBlanks();
    if (_rest.empty()) return {};
    std::size_t length = 1;
    if (_rest[0] != '{' && _rest[0] != '}')
        while (length < _rest.size() && !isBlank(_rest[length]) && _rest[length] != '{' &&
               _rest[length] != '}')
            ++length;
    return take(length);
}

void BvhTokens::expect(std::string_view word) {
    skipBlanks();
    const std::size_t length = word.size();
    const bool ends = _rest.size() <= length || !isLetter(word.back()) || !isLetter(_rest[length]);
    if (ends && isSameWord(_rest.substr(0, length), word)) {
        take(length);
        return;
    }
    fail("found " + described(next()) + ", expected " + inQuotes(word));
}

std::string_view BvhTokens::jointName() {
    skipBlanks();
    std::size_t length = std::min(_rest.find_first_of("{\r\n"), _rest.size());
    while (length > 0 && isBlank(_rest[length - 1])) --length;
    if (length == 0 || _rest[0] == '}')
        fail("found " + described(next()) + ", expected a joint's name");
    return take(length);
}

void BvhTokens::skipName() {
    take(std::min(_rest.find_first_of("{}\r\n"), _rest.size()));
}

bool BvhTokens::isAtLineEnd() {
    const std::size_t before = _line;
    const std::string_view rest = _rest;
    skipBlanks();
    const bool result = _rest.empty() || _line != before;
    _line = before;
    _rest = rest;
    return result;
}

double BvhTokens::number(const std::string& what) {
    const std::string_view word = next();
    double value = 0.0;
    if (const char* expected = parseFinite(word, value))
        fail(what + " is " + described(word) + ", expected " + expected);
    return value;
}

std::size_t BvhTokens::count(const std::string& what, std::size_t largest) {
    const std::string_view word = next();
    double value = 0.0;
    if (!parseNumber(word, value) || !(value >= 0.0 && value <= static_cast<double>(largest)) ||
        value != std::floor(value))
        fail(what + " is " + described(word) + ", expected a whole number from 0 to " +
             std::to_string(largest));
    return static_cast<std::size_t>(value);
}

void BvhTokens::fail(const std::string& message) const {
    failLine(_path, _line, message);
}

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
            _words.fail("a second joint called " + inQuotes(joint.name) +
                        ", expected unique names");
        if (_open.size() >= _limits.depth) // scene graphs are traversed recursively
            _words.fail("joint " + inQuotes(joint.name) + " is nested more than " +
                        std::to_string(_limits.depth) + " deep (option maxDepth)");
        if (_file.joints.size() >= _limits.joints)
            _words.fail("joint " + inQuotes(joint.name) + " exceeds the limit of " +
                        std::to_string(_limits.joints) + " joints (option maxJoints)");
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
        _words.skipName(); // some programs give it one
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
            _words.fail(owner() + " has unsupported CHANNELS, expected up to three rotations, and "
                                  "each position at most once");
    }

    BvhTokens& _words;
    const ReadLimits& _limits;
    BvhFile& _file;
    std::vector<Open> _open;
    std::set<std::string> _names;
};

/// Reads the HIERARCHY into `file`, up to the closing brace of the ROOT: joints and channels.
/// \throw osgSkin::Error with the line
void readBvhHierarchy(BvhTokens& words, const ReadLimits& limits, BvhFile& file) {
    Reader(words, limits, file).run();
}

constexpr std::size_t kMaxFrames = 16'777'216; // more than a day at 120 a second
constexpr double kMinFrameTime = 1e-6;         // seconds: a million frames a second
constexpr double kOtherwise = 1.0 / 30.0;      // seconds
constexpr double kSlowFrame = 1.0;             // seconds; a longer time may be in milliseconds

/// A line of values.
struct Row {
    std::size_t line;
    std::size_t values;
};

/// Reads the frame time, which may be 0 if there is at most one frame.
/// \param words to read from
/// \param frames number of frames in the file
double readFrameTime(BvhTokens& words, std::size_t frames) {
    const std::string expected = ", expected a positive number of seconds";
    if (words.isAtLineEnd()) words.fail("the frame time is missing" + expected);
    const double result = words.number("the frame time");
    if (frames <= 1 && result == 0.0) return kOtherwise;
    if (!(result >= kMinFrameTime))
        words.fail("the frame time is " + std::to_string(result) + expected);
    return result;
}

/// The joint to which value `channel` of a frame belongs.
const BvhJoint& ownerOf(const BvhFile& file, std::size_t channel) {
    const BvhJoint* result = nullptr;
    for (const BvhJoint& joint : file.joints)
        if (!joint.channels.empty() && joint.firstChannel <= channel &&
            channel < joint.firstChannel + joint.channels.size())
            result = &joint;
    return *result;
}

std::vector<Row> readRows(BvhTokens& words, BvhFile& file) {
    std::vector<Row> result;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
        double value = 0.0;
        const std::size_t read = file.values.size();
        if (const char* expected = parseFinite(word, value))
            words.fail("frame " + std::to_string(read / file.channels) + ", joint " +
                       inQuotes(ownerOf(file, read % file.channels).name) + " has " +
                       described(word) + ", expected " + expected);
        if (result.empty() || result.back().line != words.line())
            result.push_back({words.line(), 0});
        ++result.back().values;
        file.values.push_back(value);
    }
    return result;
}

/// Throws unless the rows are the declared frames.
void checkRows(const std::vector<Row>& rows, const BvhTokens& words, const std::string& path,
               const BvhFile& file) {
    // A frame may be wrapped over several lines; then only the total must match.
    if (file.values.size() == file.frames * file.channels && rows.size() != file.frames) return;
    for (std::size_t r = 0; r < std::min(rows.size(), file.frames); ++r)
        if (rows[r].values != file.channels)
            failLine(path, rows[r].line,
                     "a frame of " + std::to_string(rows[r].values) + " values, expected " +
                         std::to_string(file.channels) + ", one for each channel");
    if (rows.size() < file.frames)
        words.fail("the motion ends after " + std::to_string(rows.size()) +
                   " frame(s), expected the declared " + std::to_string(file.frames));
    // Some recorders count frames from 0, and editors append lists of key frames.
    if (rows.size() > file.frames)
        warn(path, "line " + std::to_string(rows[file.frames].line) + ": " +
                       std::to_string(rows.size() - file.frames) + " line(s) beyond the declared " +
                       std::to_string(file.frames) + " frames ignored");
}

/// Reads the MOTION into `file`, whose joints are known, up to the end of the file: frame time,
/// number of frames and their values. Allocates for the values in the file, not for the declared
/// number.
/// \throw osgSkin::Error with the line
void readBvhFrames(BvhTokens& words, const std::string& path, BvhFile& file) {
    words.expect("MOTION");
    words.expect("Frames");
    words.expect(":");
    file.frames = words.count("the number of frames", kMaxFrames);
    words.expect("Frame");
    words.expect("Time");
    words.expect(":");
    file.frameTime = readFrameTime(words, file.frames);
    if (file.frameTime > kSlowFrame && file.frames > 1)
        warn(path, "a frame takes " + std::to_string(file.frameTime) +
                       " seconds; is its \"Frame Time\" in milliseconds?");
    checkRows(readRows(words, file), words, path, file);
    file.values.resize(file.frames * file.channels);
}

} // namespace

bool BvhJoint::hasPosition() const {
    return std::any_of(channels.begin(), channels.end(),
                       [](const BvhChannel& channel) { return !channel.isRotation; });
}

BvhFile readBvh(const std::string& path, const ReadLimits& limits) {
    const std::string text = readText(path, limits);
    BvhTokens words(path, text);
    BvhFile file;
    readBvhHierarchy(words, limits, file);
    readBvhFrames(words, path, file);
    // A joint without channels takes memory in every frame, but no bytes in the file.
    const std::size_t limit = limits.samplesOf(text.size());
    if (file.frames > limit / file.joints.size())
        failFile(path, std::to_string(file.frames) + " frames of " +
                           std::to_string(file.joints.size()) + " joints, expected at most " +
                           std::to_string(limit) + " rotations (option maxSamples)");
    return file;
}

} // namespace osgSkin
