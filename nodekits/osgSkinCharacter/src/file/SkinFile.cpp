// SPDX-License-Identifier: GPL-3.0-or-later
#include "file/SkinFile.h"

#include "file/FileUses.h"
#include "file/FitSettings.h"
#include "file/JsonReader.h"
#include "file/MuscleSettings.h"

#include <osgSkinCharacter/OptionString>

#include <osgDB/FileNameUtils>

#include <set>

namespace osgSkin {
namespace {

/// Paths in the description are relative to its folder.
std::string path(const JsonReader& reader, const std::string& folder) {
    const std::string name = reader.string();
    if (name.empty()) reader.failWith("expected a file name, found an empty string");
    constexpr std::size_t longest = 4096; // no file has a longer one (PATH_MAX)
    if (name.size() > longest)
        reader.failWith("a name of " + std::to_string(name.size()) + " bytes, expected at most " +
                        std::to_string(longest));
    if (name.find('\0') != std::string::npos)
        reader.failWith("a name with a byte 0 in it, expected none");
    return folder.empty() || osgDB::isAbsolutePath(name) ? name : osgDB::concatPaths(folder, name);
}

void checkVersion(const JsonReader& root) {
    const JsonReader version = root.require("osgskin", "the format's version, 1");
    const std::size_t number = version.count();
    if (number == 0 || number > SkinFile::kVersion)
        version.failWith("version " + std::to_string(number) + " is not supported, expected " +
                         std::to_string(SkinFile::kVersion));
}

SkinFile::MotionEntry readMotion(const JsonReader& reader, const std::string& folder) {
    reader.warnUnknown({"file", "clip", "name", "skipFrames", "joints"});
    SkinFile::MotionEntry motion;
    motion.file = path(reader.require("file", "a motion file's name"), folder);
    motion.name = osgDB::getStrippedName(motion.file);
    if (const auto clip = reader.find("clip")) {
        motion.clip = clip->isNumber() ? std::to_string(clip->count()) : clip->string();
        if (motion.clip.empty()) clip->failExpected("a clip's name or number");
        motion.name = clip->isNumber() ? motion.name + " " + motion.clip : motion.clip;
    }
    if (const auto name = reader.find("name")) motion.name = name->string();
    if (const auto skip = reader.find("skipFrames")) motion.skipFrames = skip->count();
    if (const auto joints = reader.find("joints"))
        joints->forEachMember([&](const std::string& joint, const JsonReader& value) {
            motion.joints[joint] = value.string();
        });
    return motion;
}

/// Families of names: role -> a joint's name, or a list of them.
class NamesReader {
public:
    /// \param most names of all families together: each joint is looked up among them, often
    explicit NamesReader(std::size_t most) : _most(most) {
        for (const JointNames& known : knownJointNames())
            for (const auto& [role, members] : known.roles) _roles.insert(role);
    }

    JointNames read(const std::string& family, const JsonReader& reader) {
        JointNames names{family, {}};
        reader.forEachMember([&](const std::string& role, const JsonReader& value) {
            if (_roles.count(role) == 0)
                value.failWith("no such part of a body, expected Hips, Spine, LeftUpperArm, ...");
            const auto add = [&](const JsonReader& name) {
                if (++_count > _most)
                    name.failWith("one of more than " + std::to_string(_most) +
                                  " names (option maxJoints)");
                names.roles[role].push_back(name.string());
            };
            if (value.isList())
                value.forEachItem(add);
            else
                add(value);
        });
        return names;
    }

private:
    const std::size_t _most;
    std::size_t _count = 0;
    std::set<std::string> _roles;
};

SkinFile::Prop readProp(const JsonReader& reader, const SkinFile& skin, const std::string& folder) {
    reader.warnUnknown({"mesh", "motion", "file"});
    SkinFile::Prop prop;
    prop.mesh = path(reader.require("mesh", "a mesh file's name"), folder);
    const JsonReader motion = reader.require("motion", "the name of one of the motions");
    prop.motion = motion.string();
    prop.file = path(reader.require("file", "a motion file's name"), folder);
    for (const SkinFile::MotionEntry& known : skin.motions)
        if (known.name == prop.motion) return prop;
    motion.failWith("expected the name of one of the motions, found \"" + prop.motion + "\"");
}

/// A region's two boundaries (paper, Fig. 3), in bone lengths from the joint.
void readBoundaries(const JsonReader& reader, std::optional<double>& upper,
                    std::optional<double>& lower) {
    if (const auto value = reader.find("upper")) upper = value->number();
    if (const auto value = reader.find("lower")) lower = value->number();
    if (upper && lower && *upper >= *lower)
        reader.failWith("expected \"upper\" to be less than \"lower\"");
}

JointBindOptions readJoint(const JsonReader& reader) {
    reader.warnUnknown({"skip", "bend", "twist"});
    JointBindOptions joint;
    if (const auto skip = reader.find("skip")) joint.skip = skip->boolean();
    if (const auto bend = reader.find("bend")) {
        bend->warnUnknown({"upper", "lower"});
        readBoundaries(*bend, joint.bendUpper, joint.bendLower);
    }
    if (const auto twist = reader.find("twist")) {
        twist->warnUnknown({"upper", "lower", "along"});
        readBoundaries(*twist, joint.twistUpper, joint.twistLower);
        if (const auto along = twist->find("along")) {
            const std::string pole = along->string();
            if (pole == "parent")
                joint.twistPole = JointBindOptions::Pole::Parent;
            else if (pole == "child")
                joint.twistPole = JointBindOptions::Pole::Child;
            else
                along->failWith("expected \"parent\" or \"child\", found \"" + pole + "\"");
        }
    }
    return joint;
}

/// "bind", and the file that the method "weights" may name.
void readMethod(const JsonReader& root, const std::string& folder, SkinFile& skin) {
    const auto method = root.find("bind");
    const std::string name = method ? method->string() : "smooth";
    if (name != "smooth" && name != "paper" && name != "weights")
        method->failWith("expected \"smooth\", \"paper\" or \"weights\", found \"" + name + "\"");
    if (name == "paper") skin.bind.method = BindOptions::Method::Paper;
    const auto weights = root.find("weights");
    skin.paintedWeights = name == "weights";
    if (skin.paintedWeights && weights)
        skin.weights = path(*weights, folder);
    else if (weights)
        weights->failWith("expected \"bind\": \"weights\" beside it");
}

BindOptions::Shapes readShapes(const JsonReader& reader) {
    const std::string name = reader.string();
    if (const auto shapes = shapesCalled(name)) return *shapes;
    reader.failWith("expected \"none\", \"fast\" or \"elastic\", found \"" + name + "\"");
}

bool readSurfaceNormals(const JsonReader& reader) {
    const std::string name = reader.string();
    if (name != "surface" && name != "turned")
        reader.failWith("expected \"surface\" or \"turned\", found \"" + name + "\"");
    return name == "surface";
}

void readBinding(const JsonReader& root, const ReadLimits& limits, BindOptions& bind) {
    if (const auto shapes = root.find("shapes")) bind.shapes = readShapes(*shapes);
    if (const auto muscles = root.find("muscles")) readMuscles(*muscles, bind);
    if (const auto normals = root.find("normals"))
        bind.surfaceNormals = readSurfaceNormals(*normals);
    if (const auto rigid = root.find("rigid")) {
        if (rigid->size() > limits.joints)
            rigid->failWith(std::to_string(rigid->size()) + " names, expected at most " +
                            std::to_string(limits.joints) + " (option maxJoints)");
        bind.rigid.emplace();
        rigid->forEachItem([&](const JsonReader& name) { bind.rigid->push_back(name.string()); });
    }
    if (const auto joints = root.find("joints"))
        joints->forEachMember([&](const std::string& name, const JsonReader& value) {
            bind.joints[name] = readJoint(value);
        });
}

} // namespace

SkinFile SkinFile::read(const std::string& file, const ReadLimits& limits) {
    limits.checkFormat(file);
    const nlohmann::json json = JsonReader::parseFile(file, limits);
    const JsonReader root(json, file);
    const std::string folder = osgDB::getFilePath(file);
    checkVersion(root);
    root.warnUnknown({"osgskin", "mesh", "skeleton", "motions", "props", "rigid", "bind", "weights",
                      "joints", "up", "names", "shapes", "muscles", "normals", "clearHands"});

    SkinFile skin;
    skin.file = file;
    skin.mesh = path(root.require("mesh", "a mesh file's name"), folder);
    const auto skeleton = root.find("skeleton");
    if (skeleton && skeleton->isObject())
        skin.fit = readFit(*skeleton);
    else
        skin.skeleton = skeleton ? path(*skeleton, folder) : skin.mesh;
    FileUses uses(limits.uses);
    if (const auto motions = root.find("motions")) {
        std::set<std::string> names;
        motions->forEachItem([&](const JsonReader& reader) {
            skin.motions.push_back(readMotion(reader, folder));
            uses.add(skin.motions.back().file, reader);
            if (!names.insert(skin.motions.back().name).second)
                reader.failWith("the name \"" + skin.motions.back().name +
                                "\" is taken, expected a \"name\" of its own");
        });
    }
    if (const auto names = root.find("names")) {
        NamesReader reader(limits.joints);
        names->forEachMember([&](const std::string& family, const JsonReader& value) {
            JointNames read = reader.read(family, value);
            if (!read.roles.empty()) skin.bind.names.push_back(std::move(read));
        });
    }
    if (const auto props = root.find("props"))
        props->forEachItem([&](const JsonReader& reader) {
            skin.props.push_back(readProp(reader, skin, folder));
            uses.add(skin.props.back().mesh, reader);
            uses.add(skin.props.back().file, reader);
        });
    if (const auto up = root.find("up")) {
        if (up->string() != "y" && up->string() != "z")
            up->failWith("expected \"y\" or \"z\", found \"" + up->string() + "\"");
        skin.zUp = up->string() == "z";
    }
    if (skin.fit && skin.zUp) skin.fit->up = {0.0, 0.0, 1.0};
    if (const auto clear = root.find("clearHands")) skin.clearHands = clear->boolean();
    for (const std::string& named : {skin.mesh, skin.skeleton}) limits.checkNamedFormat(named);
    for (const Prop& prop : skin.props) limits.checkNamedFormat(prop.mesh);
    readMethod(root, folder, skin);
    readBinding(root, limits, skin.bind);
    return skin;
}

} // namespace osgSkin
