// SPDX-License-Identifier: GPL-3.0-or-later
#include "Arguments.h"
#include "FrameWriter.h"
#include "ObjWriter.h"
#include "PosedMesh.h"
#include "ProgressLine.h"
#include "SampledMotion.h"
#include "WholeFile.h"
#include "Writers.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/RigidPart>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinCharacter/OptionString>

#include <osg/NodeVisitor>

#include <algorithm>
#include <exception>
#include <iostream>
#include <memory>

namespace {

using bake::Arguments;
using bake::SampledMotion;
using bake::UsageError;
using osgSkin::Character;

SampledMotion chooseMotion(Character& character, const Arguments& arguments) {
    const std::vector<SampledMotion> motions =
        bake::sampledMotions(character, arguments.rate.value_or(30.0));
    const bool hasOwn =
        std::any_of(character.motions.begin(), character.motions.end(),
                    [](const osgSkin::CharacterMotion& motion) { return !motion.isSampled(); });
    if (arguments.rate && !hasOwn)
        throw UsageError{"--rate: " + arguments.character + " has no clips of its own; a motion " +
                         "file's own samples are baked"};
    if (motions.empty())
        throw UsageError{arguments.character + " has no motion, so there are no frames"};
    if (arguments.motion.empty()) return motions.front();
    std::string known;
    for (const SampledMotion& motion : motions) {
        if (motion.name == arguments.motion) return motion;
        known += (known.empty() ? "\"" : ", \"") + motion.name + "\"";
    }
    throw UsageError{"--motion: expected one of " + known + ", found \"" + arguments.motion + "\""};
}

bake::FrameRange chooseFrames(const Arguments& arguments, const SampledMotion& motion) {
    if (!arguments.frames) return {0, motion.frames - 1, 1};
    if (arguments.frames->last >= motion.frames)
        throw UsageError{"--frames: motion \"" + motion.name + "\" has frames 0 to " +
                         std::to_string(motion.frames - 1) + ", found " +
                         std::to_string(arguments.frames->last)};
    return *arguments.frames;
}

void bakeFrames(const Arguments& arguments, Character& character) {
    const SampledMotion motion = chooseMotion(character, arguments);
    const bake::FrameRange range = chooseFrames(arguments, motion);
    const std::size_t total = (range.last - range.first) / range.step + 1;
    if (total > 1 && !arguments.out.empty() && bake::FrameWriter::isSequence(arguments.out) &&
        !bake::hasNumber(arguments.out))
        throw UsageError{"--out: " + std::to_string(total) +
                         " frames need a %d in the name, found \"" + arguments.out + "\""};
    const bake::FrameSeries series{&character, motion.name, range.first, total,
                                   motion.frameTime * static_cast<double>(range.step)};
    std::unique_ptr<bake::FrameWriter> writer;
    if (!arguments.out.empty()) writer = bake::FrameWriter::make(arguments.out, series);
    example::ProgressLine line("frames", arguments.quiet);
    nlohmann::json poses = nlohmann::json::array();
    double seamGap = 0.0;
    for (std::size_t done = 0; done < total; ++done) {
        const std::size_t frame = range.first + done * range.step;
        line.show({std::to_string(done) + " of " + std::to_string(total),
                   static_cast<double>(done) / static_cast<double>(total)});
        motion.pose(frame);
        const bake::PosedMesh posed = bake::PosedMesh::read(character);
        seamGap = std::max(seamGap, posed.seamGap);
        if (writer) writer->add(frame, posed);
        if (!arguments.pose.empty())
            poses.push_back(bake::poseJson(frame, character.binding, bake::currentPose(character)));
    }
    if (writer) writer->finish();
    if (!arguments.pose.empty()) bake::writeJson(arguments.pose, poses);
    if (!arguments.quiet)
        std::cerr << total << " frames of \"" << osgSkin::onOneLine(motion.name)
                  << "\", largest seam gap " << seamGap / character.body.mesh.size()
                  << " of the body's size\n"
                  << motion.notes << std::flush;
}

/// Finds what a character's scene shows beside its body: props, scenery, things that no rig moves.
class OtherThings : public osg::NodeVisitor {
public:
    std::size_t count = 0;
    std::string first; ///< name

    OtherThings() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Drawable& drawable) override {
        if (dynamic_cast<osgSkin::DeformableSkin*>(&drawable) != nullptr) return;
        std::string name = drawable.getName();
        for (const osg::Node* node : getNodePath()) {
            if (dynamic_cast<const osgSkin::RigidPart*>(node) != nullptr) return;
            if (drawable.getName().empty() && !node->getName().empty()) name = node->getName();
        }
        if (count++ == 0) first = name;
    }
};

void tellOtherThings(const Character& character) {
    OtherThings others;
    character.root->accept(others);
    if (others.count > 0)
        std::cerr << osgSkin::onOneLine(character.file) << ": " << others.count
                  << (others.count == 1 ? " geometry" : " geometries")
                  << " beside the body left out: \"" << osgSkin::onOneLine(others.first)
                  << (others.count == 1 ? "\"\n" : "\", ...\n") << std::flush;
}

/// Reads a `.skin` file, or a rigged model, with or without `.skin` after its name.
Character load(const Arguments& arguments) {
    const std::string& file = arguments.character;
    example::ProgressLine line(file, arguments.quiet);
    osgSkin::LoadOptions options;
    options.shapes = osgSkin::shapesCalled(arguments.shapes);
    if (!arguments.muscles.empty()) options.muscles = arguments.muscles == "on";
    if (!arguments.clearHands.empty()) options.clearHands = arguments.clearHands == "on";
    options.progress = line.progress();
    if (!arguments.formats.empty())
        options.readOptions = new osgDB::Options("formats=" + arguments.formats);
    Character character = osgSkin::loadCharacter(file, options);
    if (!character.hasBody())
        throw osgSkin::Error(file + ": expected a .skin file, or a rigged model that Assimp reads");
    return character;
}

void tense(Character& character, const Arguments& arguments) {
    for (const auto& [name, activation] : arguments.activations) {
        bool known = false;
        for (const osgSkin::AttachedSkin::Skin& skin : character.skin.skins)
            known = skin.drawable->setActivation(name, activation) || known;
        if (!known)
            throw UsageError{"--tense: " + arguments.character + " has no muscle \"" + name + "\""};
    }
}

int run(const Arguments& arguments) {
    Character character = load(arguments);
    bake::keepFiles(character.files);
    tense(character, arguments);
    if (!arguments.motion.empty()) chooseMotion(character, arguments); // before anything is written
    if (!arguments.binding.empty())
        bake::writeJson(arguments.binding, bake::bindingJson(character.binding));
    if (!arguments.rest.empty())
        bake::ObjWriter(character, arguments.rest)
            .write(arguments.rest, bake::PosedMesh::rest(character));
    if (!arguments.out.empty() || !arguments.pose.empty()) bakeFrames(arguments, character);
    if (!arguments.quiet) tellOtherThings(character);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    try {
        const auto arguments = bake::parseArguments(argc, argv);
        bake::removeUnfinishedOnSignals();
        return arguments ? run(*arguments) : 0;
    } catch (const UsageError& error) {
        std::cerr << "osgskinbake: " << osgSkin::onOneLine(error.message)
                  << "\nTry osgskinbake --help." << std::endl;
        return 2;
    } catch (const std::exception& error) {
        std::cerr << "osgskinbake: " << error.what() << std::endl;
        return 1;
    }
}
