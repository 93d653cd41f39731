// SPDX-License-Identifier: MIT
#include "bvh/BvhFrames.h"

#include "text/FileText.h"

namespace osgSkin {
namespace {

constexpr std::size_t mostFrames = 16'777'216; // more than a day at 120 a second
constexpr double shortestFrame = 1e-6;         // seconds: a million frames a second
constexpr double kOtherwise = 1.0 / 30.0;      // seconds
constexpr double kSlowFrame = 1.0;             // seconds: what is longer may be milliseconds

/// A line that holds values.
struct Row {
    std::size_t line;
    std::size_t values;
};

/// \param frames of which one or none needs no time: it may be 0
double readFrameTime(BvhTokens& words, std::size_t frames) {
    const std::string expected = ", expected a positive number of seconds";
    if (words.isAtLineEnd()) words.fail("the frame time is missing" + expected);
    const double result = words.number("the frame time");
    if (frames <= 1 && result == 0.0) return kOtherwise;
    if (!(result >= shortestFrame))
        words.fail("the frame time is " + std::to_string(result) + expected);
    return result;
}

/// The joint that a frame's value number `channel` belongs to.
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

/// Throws unless the rows are the frames that the file declares.
void checkRows(const std::vector<Row>& rows, const BvhTokens& words, const std::string& path,
               const BvhFile& file) {
    // A frame may be wrapped over several lines, so only the sum must fit then.
    if (file.values.size() == file.frames * file.channels && rows.size() != file.frames) return;
    for (const Row& row : rows)
        if (row.values != file.channels)
            failLine(path, row.line,
                     "a frame of " + std::to_string(row.values) + " values, expected " +
                         std::to_string(file.channels) + ", one for each channel");
    if (rows.size() < file.frames)
        words.fail("the motion ends after " + std::to_string(rows.size()) +
                   " frame(s), expected the declared " + std::to_string(file.frames));
    // Some recorders count from 0 here: what is declared can be read.
    if (rows.size() > file.frames)
        tellOf(path, "line " + std::to_string(rows[file.frames].line) + ": " +
                         std::to_string(rows.size() - file.frames) +
                         " frame(s) beyond the declared " + std::to_string(file.frames) +
                         ", passed over");
}

} // namespace

void readBvhFrames(BvhTokens& words, const std::string& path, BvhFile& file) {
    words.expect("MOTION");
    words.expect("Frames");
    words.expect(":");
    file.frames = words.count("the number of frames", mostFrames);
    words.expect("Frame");
    words.expect("Time");
    words.expect(":");
    file.frameTime = readFrameTime(words, file.frames);
    if (file.frameTime > kSlowFrame && file.frames > 1)
        tellOf(path, "a frame takes " + std::to_string(file.frameTime) +
                         " seconds; is its \"Frame Time\" in milliseconds?");
    checkRows(readRows(words, file), words, path, file);
    file.values.resize(file.frames * file.channels);
}

} // namespace osgSkin
