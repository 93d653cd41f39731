// SPDX-License-Identifier: GPL-3.0-or-later
#include "Arguments.h"
#include "FrameWriter.h"
#include "ObjWriter.h"
#include "PosedMesh.h"
#include "Progress.h"
#include "Take.h"
#include "Writers.h"
#include "load/Character.h"

#include <osgSkin/Error>

#include <exception>
#include <iostream>
#include <memory>

namespace {

using bake::Arguments;
using bake::Take;
using bake::UsageError;
using osgSkin::Character;

Take chooseTake(Character& character, const Arguments& arguments) {
    const std::vector<Take> takes = bake::takesOf(character, arguments.rate.value_or(30.0));
    if (arguments.rate && character.clips.empty())
        throw UsageError{"--rate: " + arguments.character + " has no clips of its own; a motion " +
                         "file's own samples are baked"};
    if (takes.empty())
        throw UsageError{arguments.character + " has no motion, so there are no frames"};
    if (arguments.motion.empty()) return takes.front();
    std::string known;
    for (const Take& take : takes) {
        if (take.name == arguments.motion) return take;
        known += (known.empty() ? "\"" : ", \"") + take.name + "\"";
    }
    throw UsageError{"--motion: expected one of " + known + ", found \"" + arguments.motion + "\""};
}

bake::FrameRange chooseFrames(const Arguments& arguments, const Take& take) {
    if (!arguments.frames) return {0, take.frames - 1, 1};
    if (arguments.frames->last >= take.frames)
        throw UsageError{"--frames: motion \"" + take.name + "\" has frames 0 to " +
                         std::to_string(take.frames - 1) + ", found " +
                         std::to_string(arguments.frames->last)};
    return *arguments.frames;
}

void bakeFrames(const Arguments& arguments, Character& character) {
    const Take take = chooseTake(character, arguments);
    const bake::FrameRange range = chooseFrames(arguments, take);
    const std::size_t total = (range.last - range.first) / range.step + 1;
    if (total > 1 && !arguments.out.empty() && bake::FrameWriter::isSequence(arguments.out) &&
        !bake::hasNumber(arguments.out))
        throw UsageError{"--out: " + std::to_string(total) +
                         " frames need a %d in the name, found \"" + arguments.out + "\""};
    const bake::FrameSeries series{&character, take.name, range.first, total,
                                   take.frameTime * static_cast<double>(range.step)};
    std::unique_ptr<bake::FrameWriter> writer;
    if (!arguments.out.empty()) writer = bake::FrameWriter::make(arguments.out, series);
    bake::Progress progress("frame", total, arguments.quiet);
    nlohmann::json poses = nlohmann::json::array();
    double seamGap = 0.0;
    for (std::size_t frame = range.first; frame <= range.last; frame += range.step) {
        take.pose(frame);
        const bake::PosedMesh posed = bake::PosedMesh::read(character);
        seamGap = std::max(seamGap, posed.seamGap);
        if (writer) writer->add(frame, posed);
        if (!arguments.pose.empty())
            poses.push_back(bake::poseJson(frame, character.binding, bake::currentPose(character)));
        progress.step();
    }
    if (writer) writer->finish();
    if (!arguments.pose.empty()) bake::writeJson(arguments.pose, poses);
    if (!arguments.quiet)
        std::cerr << total << " frames of \"" << take.name << "\", largest seam gap "
                  << seamGap / character.body.mesh.size() << " of the body's size\n"
                  << take.notes << std::flush;
}

int run(const Arguments& arguments) {
    Character character =
        bake::loadCharacter(arguments.character, arguments.shapes, arguments.quiet);
    if (!arguments.binding.empty())
        bake::writeJson(arguments.binding, bake::bindingJson(character.binding));
    if (!arguments.rest.empty())
        bake::ObjWriter(character, arguments.rest)
            .write(arguments.rest, bake::PosedMesh::rest(character));
    if (!arguments.out.empty() || !arguments.pose.empty()) bakeFrames(arguments, character);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    try {
        const auto arguments = bake::parseArguments(argc, argv);
        return arguments ? run(*arguments) : 0;
    } catch (const UsageError& error) {
        std::cerr << "osgskinbake: " << error.message << "\nTry osgskinbake --help." << std::endl;
        return 2;
    } catch (const std::exception& error) {
        std::cerr << "osgskinbake: " << error.what() << std::endl;
        return 1;
    }
}
