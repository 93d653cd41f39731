// SPDX-License-Identifier: GPL-3.0-or-later
#include "Arguments.h"
#include "Character.h"
#include "FrameWriter.h"
#include "PosedMesh.h"
#include "Progress.h"
#include "Writers.h"

#include <osgSkin/Error>

#include <exception>
#include <iostream>
#include <memory>

namespace {

using bake::Arguments;
using bake::UsageError;
using osgSkin::Character;

const Character::Motion& chooseMotion(const Character& character, const Arguments& arguments) {
    if (character.motions.empty())
        throw UsageError{arguments.character + " has no motion, so there are no frames"};
    if (arguments.motion.empty()) return character.motions.front();
    std::string known;
    for (const Character::Motion& motion : character.motions) {
        if (motion.clip.name == arguments.motion) return motion;
        known += (known.empty() ? "\"" : ", \"") + motion.clip.name + "\"";
    }
    throw UsageError{"--motion: expected one of " + known + ", found \"" + arguments.motion + "\""};
}

bake::FrameRange chooseFrames(const Arguments& arguments, const osgSkin::Clip& clip) {
    if (!arguments.frames) return {0, clip.frames - 1, 1};
    if (arguments.frames->last >= clip.frames)
        throw UsageError{"--frames: motion \"" + clip.name + "\" has frames 0 to " +
                         std::to_string(clip.frames - 1) + ", found " +
                         std::to_string(arguments.frames->last)};
    return *arguments.frames;
}

void bakeFrames(const Arguments& arguments, Character& character) {
    const Character::Motion& motion = chooseMotion(character, arguments);
    const osgSkin::Clip& clip = motion.clip;
    const bake::FrameRange range = chooseFrames(arguments, clip);
    const std::size_t total = (range.last - range.first) / range.step + 1;
    if (total > 1 && !arguments.out.empty() && bake::FrameWriter::isSequence(arguments.out) &&
        !bake::hasNumber(arguments.out))
        throw UsageError{"--out: " + std::to_string(total) +
                         " frames need a %d in the name, found \"" + arguments.out + "\""};
    bake::FrameSeries series{&character.body.mesh, range.first, total,
                             clip.frameTime * static_cast<double>(range.step), character.file.zUp};
    std::unique_ptr<bake::FrameWriter> writer;
    if (!arguments.out.empty()) writer = bake::FrameWriter::make(arguments.out, series);
    bake::Progress progress("frame", total, arguments.quiet);
    nlohmann::json poses = nlohmann::json::array();
    double seamGap = 0.0;
    for (std::size_t frame = range.first; frame <= range.last; frame += range.step) {
        character.pose(motion, frame);
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
        std::cerr << total << " frames of \"" << clip.name << "\", largest seam gap "
                  << seamGap / character.body.mesh.size() << " of the body's size\n"
                  << motion.report.feetText() << std::flush;
}

int run(const Arguments& arguments) {
    Character character = Character::load(arguments.character);
    if (!arguments.binding.empty())
        bake::writeJson(arguments.binding, bake::bindingJson(character.binding));
    if (!arguments.rest.empty())
        bake::writeObj(arguments.rest, character.body.mesh, bake::PosedMesh::read(character));
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
