// SPDX-License-Identifier: MIT
#include "Arguments.h"
#include "Bytes.h"
#include "FrameWriter.h"
#include "ObjWriter.h"
#include "OsgRig.h"
#include "PosedMesh.h"
#include "ProgressLine.h"
#include "RiggedGlb.h"
#include "SceneFile.h"
#include "WalkerFile.h"

#include <osgSkin/Binding>
#include <osgSkin/BoneReader>
#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkin/Pose>
#include <osgSkin/RigidPart>
#include <osgSkin/SetMorph>
#include <osgSkinCharacter/Character>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/Constraints>
#include <osgSkinMotion/SpringBones>
#include <osgSkinRig/FaceNames>

#include <nlohmann/json.hpp>
#include <osg/NodeVisitor>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <functional>
#include <iomanip>
#include <iostream>
#include <memory>
#include <random>
#include <string>
#include <system_error>
#include <vector>

namespace bake {

namespace {

/// A motion that a character can be posed in, frame by frame.
struct SampledMotion {
    std::string name;
    std::size_t frames = 0;
    double frameTime = 0.0;                ///< seconds per frame
    std::string notes;                     ///< about its feet, lines of text; may be empty
    std::function<void(std::size_t)> pose; ///< sets bones and skins to exactly that frame
};

/// The character's motions. Motion files have their own samples; a rigged model's animations are
/// sampled `rate` times per second. The result refers to `character`.
std::vector<SampledMotion> sampledMotions(osgSkin::Character& character, double rate);

constexpr double kMaxSamples = 1e9;

using osgSkin::Character;
using osgSkin::CharacterMotion;

SampledMotion ownSamples(Character& character, const CharacterMotion& motion) {
    return {motion.name(), motion.clip.frames, motion.clip.frameTime, motion.report.feetText(),
            [&character, &motion](std::size_t frame) { character.pose(motion, frame); }};
}

SampledMotion samplesAt(Character& character, const CharacterMotion& motion, double rate) {
    // Files store times as rounded floats.
    const double frames = motion.animation->getDuration() * rate;
    const double last = std::floor(frames + std::min(0.01, 1e-6 * (1.0 + frames)));
    if (!(last < kMaxSamples))
        throw osgSkin::Error(character.file + ": motion \"" + motion.name() + "\" has " +
                             std::to_string(last) + " frames, expected less than 1e9");
    return {motion.name(),
            static_cast<std::size_t>(last) + 1,
            1.0 / rate,
            {},
            [&character, &motion, rate](std::size_t frame) {
                character.poseAt(motion, static_cast<double>(frame) / rate);
            }};
}

std::vector<SampledMotion> sampledMotions(Character& character, double rate) {
    std::vector<SampledMotion> result;
    for (const CharacterMotion& motion : character.motions)
        result.push_back(motion.isSampled() ? ownSamples(character, motion)
                                            : samplesAt(character, motion, rate));
    return result;
}

nlohmann::json array(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

const char* nameOf(osgSkin::CorrectiveJoint::Basis basis) {
    switch (basis) {
    case osgSkin::CorrectiveJoint::Basis::Hinge:
        return "hinge";
    case osgSkin::CorrectiveJoint::Basis::TurnedHinge:
        return "turned_hinge";
    case osgSkin::CorrectiveJoint::Basis::Ball:
        return "ball";
    case osgSkin::CorrectiveJoint::Basis::Round:
        return "round";
    case osgSkin::CorrectiveJoint::Basis::Input:
        break;
    }
    return "input";
}

/// The scalar functions of each joint that has correctives.
nlohmann::json functionsJson(const osgSkin::Binding& binding) {
    nlohmann::json list = nlohmann::json::array();
    for (const osgSkin::CorrectiveJoint& joint : binding.correctives.joints) {
        const std::size_t count = joint.functionCount();
        nlohmann::json rows = nlohmann::json::array();
        for (std::size_t k = 0; k < joint.modes; ++k) {
            const auto row = joint.coefficients.begin() + std::ptrdiff_t(k * count);
            rows.push_back(std::vector<double>(row, row + std::ptrdiff_t(count)));
        }
        nlohmann::json functions{{"basis", nameOf(joint.basis)},
                                 {"low", {joint.low.x, joint.low.y}},
                                 {"high", {joint.high.x, joint.high.y}},
                                 {"coefficients", std::move(rows)}};
        if (joint.basis == osgSkin::CorrectiveJoint::Basis::Input) {
            functions["input"] = binding.correctives.inputs[joint.joint];
        } else {
            functions["joint"] = binding.joints[joint.joint].name;
            functions["axis"] = array(joint.axis);
            functions["knots"] = joint.knots;
        }
        list.push_back(std::move(functions));
    }
    return list;
}

/// A vertex's corrective vectors, one per mode of each joint that corrects it.
nlohmann::json vectorsJson(const osgSkin::Binding& binding, std::size_t vertex) {
    const osgSkin::Correctives& from = binding.correctives;
    nlohmann::json list = nlohmann::json::array();
    for (std::uint32_t i = from.firstEntry[vertex]; i < from.firstEntry[vertex + 1]; ++i) {
        const osgSkin::CorrectiveJoint& joint = from.joints[from.entries[i].joint];
        const std::int16_t* share = &from.shares[from.entries[i].firstShare];
        nlohmann::json vectors = nlohmann::json::array();
        for (std::size_t k = 0; k < joint.modes; ++k, share += 3)
            vectors.push_back(array(glm::dvec3(share[0], share[1], share[2]) /
                                    double(osgSkin::Correctives::kUnit)));
        list.push_back({from.entries[i].joint, std::move(vectors)});
    }
    return list;
}

/// The joints in the order of the product of transforms, and each vertex's region and ratios.
nlohmann::json bindingJson(const osgSkin::Binding& binding) {
    nlohmann::json joints = nlohmann::json::array();
    const std::vector<std::uint32_t> order = osgSkin::productOrder(binding.joints);
    const std::vector<std::uint32_t> places = osgSkin::productPlaces(order);
    for (const std::uint32_t j : order) {
        const osgSkin::BoundJoint& joint = binding.joints[j];
        const nlohmann::json parent =
            joint.parent < 0
                ? nlohmann::json()
                : nlohmann::json(binding.joints[static_cast<std::size_t>(joint.parent)].name);
        joints.push_back({{"name", joint.name},
                          {"parent", parent},
                          {"centre", array(joint.centre)},
                          {"boneAxis", array(joint.boneAxis)},
                          {"twistAxis", array(joint.twistAxis)}});
    }
    nlohmann::json vertices = nlohmann::json::array();
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        nlohmann::json ratios = nlohmann::json::array();
        std::vector<osgSkin::Influence> influences(
            binding.influences.begin() + binding.firstInfluence[v],
            binding.influences.begin() + binding.firstInfluence[v + 1]);
        std::sort(influences.begin(), influences.end(),
                  [&](const auto& a, const auto& b) { return places[a.joint] < places[b.joint]; });
        for (const osgSkin::Influence& influence : influences) {
            ratios.push_back({binding.joints[influence.joint].name,
                              static_cast<double>(influence.bend),
                              static_cast<double>(influence.twist)});
        }
        vertices.push_back(
            {{"region", binding.joints[binding.regions[v]].name}, {"ratios", std::move(ratios)}});
        if (!binding.correctives.empty()) vertices.back()["correctives"] = vectorsJson(binding, v);
    }
    nlohmann::json result = {{"joints", std::move(joints)}, {"vertices", std::move(vertices)}};
    if (!binding.correctives.empty()) result["correctives"] = functionsJson(binding);
    return result;
}

/// The joints' transforms D_j of one frame.
nlohmann::json poseJson(std::size_t frame, const osgSkin::Binding& binding,
                        const osgSkin::Pose& pose) {
    nlohmann::json joints = nlohmann::json::object();
    for (std::size_t j = 0; j < binding.joints.size(); ++j) {
        const osgSkin::JointTransform& transform = pose.transform(j);
        const glm::dquat& q = transform.rotation;
        joints[binding.joints[j].name] = {{"rotation", {q.w, q.x, q.y, q.z}},
                                          {"translation", array(transform.translation)}};
        if (transform.scale != 1.0) joints[binding.joints[j].name]["scale"] = transform.scale;
    }
    nlohmann::json result{{"frame", frame}, {"joints", std::move(joints)}};
    const std::vector<std::string>& inputs = binding.correctives.inputs;
    for (std::size_t i = 0; i < inputs.size(); ++i)
        result["inputs"][inputs[i]] = double(pose.input(i));
    return result;
}

/// \throw osgSkin::Error if it cannot be written
void writeJson(const std::string& file, const nlohmann::json& json) {
    // Joint names may be invalid UTF-8, which JSON does not allow.
    writeBytes(file, json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n');
}

} // namespace

} // namespace bake

namespace {

using bake::Arguments;
using bake::SampledMotion;
using bake::UsageError;
using osgSkin::Character;

const char kFooter[] =
    "Frames are the motion file's own samples, counted from 0 after `skipFrames`; the last one of "
    "a\n"
    "range is included. A pose is that sample, not a blend. Meshes have the input mesh's own\n"
    "vertices and faces, in its order, rigid parts included.\n"
    "--rigged writes a skeleton, four weights a vertex and all clips, for engines that blend\n"
    "linearly; helper joints carry parts of the joints' bends and twists in every clip.\n"
    "Without --out, --rest, --binding, --pose and --rigged, nothing is written. `--rest` without a "
    "file "
    "writes\n"
    "the bind pose to --out in place of the frames.";

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
    std::vector<std::string> known;
    for (const SampledMotion& motion : motions) known.push_back(motion.name);
    const std::vector<std::size_t> meant = osgSkin::clipsMeant(arguments.motion, known);
    if (meant.size() == 1) return motions[meant.front()];
    throw UsageError{"--motion: found \"" + arguments.motion + '"' +
                     osgSkin::expectedNames(arguments.motion, known)};
}

example::FrameRange chooseFrames(const Arguments& arguments, const SampledMotion& motion) {
    if (!arguments.frames) return {0, motion.frames - 1, 1};
    if (arguments.frames->last >= motion.frames)
        throw UsageError{"--frames: motion \"" + motion.name + "\" has frames 0 to " +
                         std::to_string(motion.frames - 1) + ", found " +
                         std::to_string(arguments.frames->last)};
    return *arguments.frames;
}

/// Sets the weights of --morph, after a clip may have set others.
void morph(Character& character, const Arguments& arguments) {
    for (const auto& [name, weight] : arguments.morphs)
        if (!osgSkin::setMorph(*character.root, name, weight))
            throw UsageError{"--morph: " + arguments.character + " has no morph target \"" + name +
                             "\"" + osgSkin::expectedNames(name, character.morphs())};
}

/// Adds the character's morph targets to a file of one frame.
void addMorphs(Character& character, bake::FrameWriter& writer) {
    osg::Group& root = *character.root;
    for (const std::string& name : osgSkin::morphNames(root)) {
        const float before = osgSkin::getMorph(root, name);
        osgSkin::setMorph(root, name, 1.0f);
        writer.addMorph(name, bake::PosedMesh::read(character));
        osgSkin::setMorph(root, name, before);
    }
}

void bakeFrames(const Arguments& arguments, Character& character) {
    const SampledMotion motion = chooseMotion(character, arguments);
    const example::FrameRange range = chooseFrames(arguments, motion);
    const std::size_t total = range.count();
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
        morph(character, arguments);
        const bake::PosedMesh posed = bake::PosedMesh::read(character);
        seamGap = std::max(seamGap, posed.seamGap);
        if (writer) writer->add(frame, posed);
        if (!arguments.pose.empty())
            poses.push_back(bake::poseJson(frame, character.binding, bake::currentPose(character)));
    }
    if (writer && total == 1) addMorphs(character, *writer);
    if (writer) writer->finish();
    if (!arguments.pose.empty()) bake::writeJson(arguments.pose, poses);
    if (!arguments.quiet)
        std::cerr << total << " frames of \"" << osgSkin::onOneLine(motion.name)
                  << "\", largest seam gap " << seamGap / character.body.mesh.size()
                  << " of the body's size\n"
                  << motion.notes << std::flush;
}

/// Samples the chosen clip, or all of them, for a rigged file.
std::vector<bake::RiggedClip> riggedClips(const Arguments& arguments, Character& character) {
    std::vector<SampledMotion> motions;
    if (character.motions.empty()) return {};
    if (!arguments.motion.empty() || arguments.frames || arguments.rate)
        motions.push_back(chooseMotion(character, arguments)); // checks the arguments
    if (arguments.motion.empty() && !arguments.frames)
        motions = bake::sampledMotions(character, arguments.rate.value_or(30.0));
    example::ProgressLine line("clips", arguments.quiet);
    const std::vector<std::string> morphs = character.morphs();
    const osgSkin::BoneReader reader(character.binding.joints, *character.skeleton);
    std::vector<bake::RiggedClip> clips;
    for (const SampledMotion& motion : motions) {
        const example::FrameRange range = chooseFrames(arguments, motion);
        bake::RiggedClip clip;
        clip.name = motion.name;
        clip.seconds = motion.frameTime * static_cast<double>(range.step);
        osgSkin::Pose pose(character.binding.joints, character.binding.correctives.inputs.size());
        line.show({motion.name, double(clips.size()) / double(motions.size())});
        for (std::size_t done = 0; done < range.count(); ++done) {
            motion.pose(range.first + done * range.step);
            morph(character, arguments);
            bake::readPose(character, reader, pose);
            clip.poses.push_back(pose);
            clip.morphs.emplace_back();
            for (const std::string& name : morphs)
                clip.morphs.back().push_back(osgSkin::getMorph(*character.root, name));
        }
        clips.push_back(std::move(clip));
    }
    return clips;
}

/// The name of a file that is not there, and is removed at the end of the scope.
struct TemporaryFile {
    const std::string file = (std::filesystem::temp_directory_path() /
                              ("osgskinbake-" + std::to_string(std::random_device()()) + ".glb"))
                                 .string();
    ~TemporaryFile() {
        std::error_code ignored;
        std::filesystem::remove(file, ignored);
    }
};

/// Tells what a rigged file does not hold.
void reportLeftOut(const Character& character, const bake::RiggedReport& report, bool isScene) {
    std::string leftOut;
    const auto add = [&](bool isThere, const std::string& what) {
        if (isThere) leftOut += (leftOut.empty() ? "" : ", ") + what;
    };
    const std::vector<osgSkin::RestJoint>& joints = character.rest.joints;
    const bool isVrm =
        std::any_of(joints.begin(), joints.end(),
                    [](const osgSkin::RestJoint& joint) { return !joint.role.empty(); });
    const bool isLost = isVrm && (isScene || !report.isHuman);
    add(isScene && osgSkin::find<osgSkin::SpringBones>(*character.root) != nullptr, "spring bones");
    add(osgSkin::find<osgSkin::Constraints>(*character.root) != nullptr, "constraints");
    add(isLost, "which joint is which part of the body");
    add(isLost && !character.morphs().empty(), "which morph targets are expressions");
    for (const std::string& what : report.leftOut) add(!isScene, what);
    for (const std::string& line :
         {leftOut.empty() ? "" : "left out: " + leftOut, isScene ? std::string() : report.vrmNote})
        if (!line.empty())
            std::cerr << osgSkin::onOneLine(character.file) << ": " << osgSkin::onOneLine(line)
                      << '\n'
                      << std::flush;
}

void bakeRigged(const Arguments& arguments, Character& character) {
    const std::vector<bake::RiggedClip> clips = riggedClips(arguments, character);
    const bool isScene = bake::isSceneFile(arguments.rigged);
    const TemporaryFile temporary;
    const std::string& glb = isScene ? temporary.file : arguments.rigged;
    const bake::RiggedReport report =
        bake::writeRigged(glb, character, clips, {arguments.weights, arguments.helpers});
    if (isScene) bake::writeOsgRig(glb, arguments.rigged);
    if (arguments.quiet) return;
    std::cerr << arguments.rigged << ": " << report.joints << " joints, " << report.helpers
              << " helper joints, " << clips.size() + report.hasRanges << " clips, "
              << report.morphs << " morph targets and " << report.correctives
              << " of correctives; skin is at most " << report.worst << " of a limb's radius off "
              << (clips.empty() ? "where joints bend and twist through their range\n"
                                : "in the poses of the fit\n");
    if (report.hasRanges)
        std::cerr << arguments.rigged << ": clip \"" << bake::kRangesClip
                  << "\" alone moves helper joints: programs that pose joints must pose these, "
                     "too (\"extras\" of their nodes), or take --helpers 0\n";
    std::cerr << std::flush;
    reportLeftOut(character, report, isScene);
}

/// Finds nodes of a character's scene that are not its body: props, scenery, objects without a rig.
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

void reportMaps(const Character& character) {
    const std::vector<osgSkin::MeshPart>& parts = character.body.parts;
    if (std::any_of(parts.begin(), parts.end(), [](const osgSkin::MeshPart& part) {
            return part.geometry->getStateSet()->getAttribute(osg::StateAttribute::PROGRAM);
        }))
        std::cerr << osgSkin::onOneLine(character.file)
                  << ": normal, occlusion and emission maps left out\n"
                  << std::flush;
}

void reportOtherThings(const Character& character) {
    OtherThings others;
    character.root->accept(others);
    if (others.count > 0)
        std::cerr << osgSkin::onOneLine(character.file) << ": " << others.count
                  << (others.count == 1 ? " geometry" : " geometries")
                  << " beside the body left out: \"" << osgSkin::onOneLine(others.first)
                  << (others.count == 1 ? "\"\n" : "\", ...\n") << std::flush;
}

bool writesMeshes(const Arguments& arguments) {
    return !arguments.out.empty() || !arguments.rest.empty() || !arguments.binding.empty() ||
           !arguments.pose.empty() || !arguments.rigged.empty();
}

/// Loads the motion files among a walker's clips, and names the clips that they become.
void addMotionFiles(Arguments& arguments, osgSkin::LoadOptions& options) {
    osgSkin::WalkerOptions& gaits = arguments.walkerOptions;
    std::vector<std::string*> clips = {&gaits.walking, &gaits.running, &gaits.standing};
    for (std::string& gesture : gaits.others) clips.push_back(&gesture);
    for (std::string* clip : clips) {
        const std::size_t mark = clip->rfind('#');
        const std::string file = clip->substr(0, mark);
        if (file.empty() || !osgDB::fileExists(file)) continue;
        options.moreMotions.push_back(*clip);
        *clip = mark == std::string::npos ? osgDB::getStrippedName(file) : clip->substr(mark + 1);
    }
}

Character load(Arguments& arguments) {
    const std::string& file = arguments.character;
    example::ProgressLine line(file, arguments.quiet);
    osgSkin::LoadOptions options = arguments.options;
    options.progress = line.progress();
    addMotionFiles(arguments, options);
    std::string words;
    if (!arguments.formats.empty()) words = "formats=" + arguments.formats;
    // A walker is one of many: fewer skins are faster. Meshes keep their materials.
    if (!writesMeshes(arguments)) words += " colours=merged";
    if (!words.empty()) options.readOptions = new osgDB::Options(words);
    Character character = osgSkin::loadCharacter(file, options);
    if (!character.hasBody() && !arguments.list && arguments.walker.empty())
        throw osgSkin::Error(file + ": a saved character or several; the mesh is not known. Bake "
                                    "the .skin file or the model that it was made of");
    return character;
}

/// Prints how many names of other tools move the face.
void listFace(const std::vector<std::string>& morphs) {
    std::cout << "face: names of other tools that move it\n";
    for (const auto& [title, vocabulary] : {std::pair("ARKit", osgSkin::FaceVocabulary::ArKit),
                                            std::pair("visemes", osgSkin::FaceVocabulary::Visemes),
                                            std::pair("VRM", osgSkin::FaceVocabulary::Vrm)}) {
        const auto matches = osgSkin::matchFace(osgSkin::faceNames(vocabulary), morphs);
        std::size_t found = 0;
        std::string missing;
        for (const osgSkin::FaceMatch& match : matches) {
            const bool moves = match.kind != osgSkin::FaceMatch::Kind::None;
            found += moves;
            if (!moves) missing += (missing.empty() ? ", not " : ", ") + match.name;
        }
        std::cout << "  " << std::setw(18) << title << ' ' << found << " of " << matches.size()
                  << (2 * found < matches.size() ? "" : missing) << '\n';
    }
}

/// Prints what a character can be told to do: its joints and their roles, its clips, morph targets
/// and muscles.
void list(const Character& character) {
    std::cout << "joints: role, name\n";
    for (std::size_t j = 0; j < character.rest.joints.size(); ++j) {
        const std::string& role = character.roles.roles[j];
        std::cout << "  " << std::left << std::setw(18) << (role.empty() ? "-" : role) << ' '
                  << osgSkin::onOneLine(character.rest.joints[j].name) << '\n';
    }
    std::cout << "clips: seconds, name\n" << std::fixed << std::setprecision(2);
    for (const osgSkin::CharacterMotion& motion : character.motions)
        std::cout << "  " << std::setw(18) << motion.duration() << ' '
                  << osgSkin::onOneLine(motion.name()) << '\n';
    std::cout << "morph targets\n";
    for (const std::string& name : character.morphs())
        std::cout << "  " << osgSkin::onOneLine(name) << '\n';
    if (!character.morphs().empty()) listFace(character.morphs());
    std::cout << "muscles\n";
    for (const std::string& name : character.binding.correctives.inputs)
        std::cout << "  " << osgSkin::onOneLine(name) << '\n';
}

void tense(Character& character, const Arguments& arguments) {
    for (const auto& [name, activation] : arguments.activations) {
        bool known = false;
        for (const osgSkin::AttachedSkin::Skin& skin : character.skin.skins)
            known = skin.drawable->setActivation(name, activation) || known;
        if (!known)
            throw UsageError{"--tense: " + arguments.character + " has no muscle \"" + name + '"' +
                             osgSkin::expectedNames(name, character.binding.correctives.inputs)};
    }
}

/// Bad usage where nothing was asked for: says how many frames there are.
UsageError nothingToWrite(Character& character, const Arguments& arguments) {
    const SampledMotion motion = chooseMotion(character, arguments);
    return UsageError(
        "nothing to write: expected --out, --rest, --binding, --pose, --rigged or --walker; \"" +
        motion.name + "\" has " + std::to_string(chooseFrames(arguments, motion).count()) +
        " frames, for example for --out frame_%04d.obj or --out frames.glb");
}

int run(Arguments arguments) {
    Character character = load(arguments);
    if (arguments.list) {
        list(character);
        return 0;
    }
    if (!writesMeshes(arguments) && arguments.walker.empty())
        throw nothingToWrite(character, arguments);
    bake::keepFiles(character.files);
    if (!arguments.walker.empty()) bake::writeWalker(character, arguments);
    if (!writesMeshes(arguments)) return 0;
    tense(character, arguments);
    morph(character, arguments);
    if (!arguments.motion.empty()) chooseMotion(character, arguments); // before writing any file
    if (!arguments.binding.empty())
        bake::writeJson(arguments.binding, bake::bindingJson(character.binding));
    if (!arguments.rest.empty())
        bake::ObjWriter(character, arguments.rest)
            .write(arguments.rest, bake::PosedMesh::rest(character));
    if (!arguments.out.empty() || !arguments.pose.empty()) bakeFrames(arguments, character);
    if (!arguments.rigged.empty()) bakeRigged(arguments, character);
    if (arguments.quiet) return 0;
    std::cerr << "bound by "
              << (character.bindReport.boundaries.empty() ? "painted weights"
                                                          : "regions of the skin")
              << std::endl;
    reportOtherThings(character);
    reportMaps(character);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    example::CommandLine line(
        "osgskinbake", "Writes a character's skin, posed by its motion, as meshes.", kFooter);
    return line.run(argc, argv, [&] {
        const Arguments arguments = bake::parseArguments(line, argc, argv);
        bake::removeUnfinishedOnSignals();
        return run(arguments);
    });
}
