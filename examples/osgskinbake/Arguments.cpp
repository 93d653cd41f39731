// SPDX-License-Identifier: MIT
#include "Arguments.h"

#include "CharacterOptions.h"
#include "CommandLine.h"
#include "SceneFile.h"
#include "Surface.h"

#include <osgDB/FileNameUtils>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <regex>
#include <set>
#include <sstream>

namespace bake {
namespace {

/// Matches the placeholder of the frame number. A pattern is never passed to printf itself.
const std::regex& numberPattern() {
    static const std::regex pattern("%(0?)([0-9]?)d");
    return pattern;
}

/// The file name in a path. Folder names may contain a %.
std::string fileNameOf(const std::string& path) {
    return path.substr(path.rfind('/') + 1); // without a slash, the whole path
}

/// A frame pattern, split at its placeholder.
struct NumberedName {
    std::string before, after;
    std::size_t width = 0;
    char fill = ' ';

    static std::optional<NumberedName> of(const std::string& pattern) {
        const std::string name = fileNameOf(pattern);
        std::smatch match;
        if (!std::regex_search(name, match, numberPattern())) return std::nullopt;
        NumberedName result;
        result.before = pattern.substr(0, pattern.size() - name.size()) + match.prefix().str();
        result.after = match.suffix();
        if (match[2].length()) result.width = static_cast<std::size_t>(match.str(2)[0] - '0');
        if (match[1].length()) result.fill = '0';
        return result;
    }
};

void checkPattern(const std::string& out) {
    const std::string name = fileNameOf(out);
    const std::string rest = std::regex_replace(name, numberPattern(), "");
    const auto numbers = std::distance(
        std::sregex_iterator(name.begin(), name.end(), numberPattern()), std::sregex_iterator());
    if (numbers > 1 || rest.find('%') != std::string::npos)
        throw UsageError{"--out: expected one %d (or %04d) at most, found \"" + out + "\""};
}

/// Reads NAME=NUMBER.
std::pair<std::string, float> parseNamed(const std::string& option, const std::string& word) {
    const std::size_t sign = word.rfind('=');
    const std::string number = sign == std::string::npos ? "" : word.substr(sign + 1);
    std::istringstream in(number);
    float value = 0.0f;
    if (sign == 0 || !(in >> value) || !in.eof() || !std::isfinite(value))
        throw UsageError{option + ": expected NAME=A with a number, found \"" + word + "\""};
    return {word.substr(0, sign), value};
}

/// Handles `--rest` without a file, which writes the bind pose to --out instead of the frames. The
/// word after it may also be the character.
void settleRest(Arguments& arguments) {
    if (arguments.character.empty()) std::swap(arguments.character, arguments.rest);
    if (!arguments.rest.empty()) return;
    arguments.rest = arguments.out.empty() ? "rest.obj" : arguments.out;
    if (hasNumber(arguments.rest)) {
        arguments.rest = arguments.frames
                             ? std::regex_replace(arguments.rest, numberPattern(), "rest")
                             : frameName(arguments.rest, 0);
    }
    if (!arguments.frames) arguments.out.clear();
}

std::string extensionOf(const std::string& file) {
    return osgDB::getLowerCaseFileExtension(file);
}

/// The material library written next to an OBJ file or sequence.
std::string libraryOf(const std::string& file) {
    if (extensionOf(file) != "obj") return {};
    const std::string folder = osgDB::getFilePath(file), name = libraryName(file);
    return folder.empty() ? name : osgDB::concatPaths(folder, name);
}

/// True if a frame of the sequence `pattern` could have the name `file`.
bool isFrameOf(const std::string& pattern, const std::string& file) {
    const std::optional<NumberedName> numbered = NumberedName::of(pattern);
    if (!numbered) return false;
    const std::string &before = numbered->before, &after = numbered->after;
    if (file.size() <= before.size() + after.size() || file.compare(0, before.size(), before) != 0)
        return false;
    const std::string number =
        file.substr(before.size(), file.size() - before.size() - after.size());
    return file.compare(file.size() - after.size(), after.size(), after) == 0 &&
           number.find_first_not_of("0123456789 ") == std::string::npos;
}

/// Two outputs with the same file name would overwrite each other.
void requireDifferentFiles(const Arguments& arguments) {
    std::set<std::filesystem::path> files;
    const std::string& out = arguments.out;
    // The rest pose and the frames may share a library: its contents are the same.
    const std::string ofOut = libraryOf(out), ofRest = libraryOf(arguments.rest);
    for (const std::string& file :
         {out, arguments.rest, arguments.binding, arguments.pose, arguments.rigged,
          arguments.walker, ofOut, ofRest == ofOut ? std::string() : ofRest}) {
        if (file.empty()) continue;
        const bool isFrame = file != out && isFrameOf(out, file);
        if (isFrame || !files.insert(std::filesystem::absolute(file).lexically_normal()).second)
            throw UsageError{
                "expected a file of its own for each of --out, --rest, --binding, "
                "--pose, --rigged and --walker, and for the materials of the first two, found \"" +
                file + "\" twice"};
    }
}

} // namespace

bool hasNumber(const std::string& pattern) {
    return NumberedName::of(pattern).has_value();
}

std::string frameName(const std::string& pattern, std::size_t frame) {
    const std::optional<NumberedName> numbered = NumberedName::of(pattern);
    if (!numbered) return pattern;
    std::string number = std::to_string(frame);
    if (number.size() < numbered->width)
        number.insert(0, numbered->width - number.size(), numbered->fill);
    return numbered->before + number + numbered->after;
}

Arguments parseArguments(example::CommandLine& line, int argc, const char* const* argv) {
    Arguments arguments;
    std::string frames;
    std::vector<std::string> tensed, morphs;
    int helpers = int(arguments.helpers);
    std::string weights = "4";
    line.add("CHARACTER", arguments.character, example::kCharacterHelp);
    line.add("--list", arguments.list,
             "list joints with their roles, clips, morph targets and muscles; write nothing");
    line.add("--motion", arguments.motion, "a motion's name; the first one by default");
    line.add("--frames", frames, "A, A:B or A:B:STEP; all by default");
    line.add("--rate", arguments.rate, "frames a second of a rigged model's clips; 30")
        .range(1e-3, 1e6);
    example::addCharacterOptions(line, arguments.options);
    line.add("--tense", tensed, "NAME=A: tenses a muscle by A, 0 to 1, in all frames");
    line.add("--morph", morphs, "NAME=W: gives a morph target the weight W in all frames");
    line.add("--out", arguments.out,
             "the frames' files, like frame_%04d.obj or .ply; or one for all: .pc2, .glb");
    const auto rest = line.add("--rest", arguments.rest, "write the bind pose").valueOptional();
    line.add("--binding", arguments.binding, "write joints, regions and ratios (JSON)");
    line.add("--pose", arguments.pose, "write the joints' transforms of the frames (JSON)");
    const auto rigged = line.add(
        "--rigged", arguments.rigged,
        "write a skeleton, weights and clips for other engines (.glb, .vrm) or osgAnimation alone "
        "(.osgb); all clips without --motion");
    line.add("--helpers", helpers,
             "helper joints of --rigged for each joint that bends skin, in the mean at most; 8")
        .range(0, 64)
        .needs(rigged);
    line.add("--weights", weights, "weights a vertex of --rigged: 4 (the default) or 8")
        .oneOf({"4", "8"})
        .needs(rigged);
    const auto walker =
        line.add("--walker", arguments.walker,
                 "write a pedestrian that walks by itself (.osgb), see osgSkin::Walker");
    osgSkin::WalkerOptions& gaits = arguments.walkerOptions;
    const char* const clip = "a clip of the character, or a motion file (FILE, FILE#CLIP)";
    line.add("--walk", gaits.walking, std::string("the walker's walk: ") + clip).needs(walker);
    line.add("--run", gaits.running, "its run").needs(walker);
    line.add("--idle", gaits.standing, "how it stands").needs(walker);
    line.add("--gesture", gaits.others, "a clip of its upper body, as waving; repeatable")
        .needs(walker);
    std::string faces = "x";
    line.add("--faces", faces, "where the walker looks: x, as in traffic simulators, or -y")
        .oneOf({"x", "-y"})
        .needs(walker);
    line.add("--formats", arguments.formats,
             "what may be read, as skin,obj,osgb, or all; by default no .osgb, .osgt, .osgx, .osg "
             "or .ive file that a .skin file names");
    line.add("--quiet", arguments.quiet, "no progress and no summary");
    line.parse(argc, argv);
    arguments.helpers = std::size_t(helpers);
    arguments.weights = weights == "8" ? 8 : 4;
    if (rigged.isGiven() && extensionOf(arguments.rigged) != "glb" &&
        extensionOf(arguments.rigged) != "vrm" && !isSceneFile(arguments.rigged))
        throw UsageError{
            "--rigged: expected a file whose name ends in .glb, .vrm or .osgb, found \"" +
            arguments.rigged + "\""};
    if (faces == "-y") gaits.forward = osgSkin::WalkerOptions::Forward::MinusY;
    if (walker.isGiven() && !isSceneFile(arguments.walker))
        throw UsageError{"--walker: expected a file whose name ends in .osgb, found \"" +
                         arguments.walker + "\""};
    if (!frames.empty()) arguments.frames = example::FrameRange::parse(frames);
    for (const std::string& word : tensed)
        arguments.activations.push_back(parseNamed("--tense", word));
    for (const std::string& word : morphs) arguments.morphs.push_back(parseNamed("--morph", word));
    checkPattern(arguments.out);
    if (rest.isGiven()) settleRest(arguments);
    if (arguments.character.empty())
        throw UsageError{std::string("expected a CHARACTER: ") + example::kCharacterHelp};
    const std::string kind = extensionOf(arguments.rest);
    if (kind == "ply" || kind == "glb" || kind == "gltf" || kind == "pc2" || kind == "mtl")
        throw UsageError{"--rest: expected a file whose name ends in .obj, found \"" +
                         arguments.rest + "\""};
    requireDifferentFiles(arguments);
    return arguments;
}

} // namespace bake
