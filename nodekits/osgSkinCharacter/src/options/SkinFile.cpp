// SPDX-License-Identifier: MIT
#include "options/SkinFile.h"

#include "options/JsonReader.h"
#include "options/OptionTable.h"

#include <osgSkin/ExpectedNames>
#include <osgSkinBind/BindOptions>
#include <osgSkinBind/FitSkeleton>

#include <osgDB/FileNameUtils>

#include <cstddef>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <vector>

namespace osgSkin {
namespace {

/// Counts how often a description names each file. A file is read again each time, so that a short
/// description of short files could take hours.
class FileUses {
public:
    /// \param max how often a file may be named (ReadLimits::uses)
    explicit FileUses(std::size_t max) : _max(max) {}

    /// Counts one use. Different paths to one file count together.
    ///
    /// \param file relative to the working directory
    /// \param place the member that names it, for the error
    /// \throw osgSkin::Error where that is once too often
    void add(const std::string& file, const JsonReader& place) {
        std::error_code failure;
        const std::string path = std::filesystem::weakly_canonical(file, failure).string();
        if (++_uses[failure ? file : path] > _max)
            place.failWith(file + " is used more than " + std::to_string(_max) +
                           " times (option maxUses)");
    }

private:
    std::size_t _max;
    std::map<std::string, std::size_t> _uses; ///< by path
};

/// Reads `"skeleton": { "fit": true, ... }`, without the up axis.
FitOptions readFit(const JsonReader& reader) {
    const JsonReader fit = reader.require("fit", "true");
    if (!fit.boolean()) fit.failWith("expected true, or a file name instead of the object");
    reader.warnUnknown({"fit", "facing", "landmarks"});
    FitOptions options;
    if (const auto facing = reader.find("facing")) {
        options.facing = facing->vector();
        if (*options.facing == glm::dvec3(0.0)) facing->failWith("expected a direction");
    }
    const auto landmarks = reader.find("landmarks");
    if (!landmarks) return options;
    std::vector<std::string> names;
    constexpr std::size_t most = 100; // a body has about 30 joints; names are read together
    landmarks->forEachMember([&](const std::string& name, const JsonReader& value) {
        if (names.size() == most)
            value.failWith("one of more than " + std::to_string(most) + " landmarks");
        names.push_back(name);
    });
    const std::map<std::string, std::string> known = fittedNamesOf(names);
    landmarks->forEachMember([&](const std::string& name, const JsonReader& value) {
        if (known.count(name) == 0)
            value.failWith("not a CMU joint" + expectedNames(name, fittedJointNames()));
        options.landmarks[name] = value.vector();
    });
    return options;
}

BindOptions::Muscle readMuscle(const JsonReader& reader) {
    reader.warnUnknown({"name", "joint", "side", "from", "to", "growth", "tension"});
    BindOptions::Muscle muscle;
    muscle.name = reader.require("name", "the muscle's name").string();
    muscle.joint = reader.require("joint", "the joint whose bend shortens it").string();
    const auto side = reader.find("side");
    if (side && side->isList()) {
        muscle.towards = side->vector();
    } else if (side) {
        const std::string name = side->string();
        if (name != "flexor" && name != "extensor")
            side->failWith("expected \"flexor\" or \"extensor\", found \"" + name + "\"");
        if (name == "extensor") muscle.side = BindOptions::Muscle::Side::Extensor;
    }
    if (const auto from = reader.find("from")) muscle.from = from->number();
    if (const auto to = reader.find("to")) muscle.to = to->number();
    if (const auto growth = reader.find("growth")) muscle.growth = growth->number();
    if (const auto tension = reader.find("tension")) muscle.tension = tension->number();
    return muscle;
}

void requireFew(const JsonReader& list, std::size_t most, const char* what) {
    if (list.size() > most)
        list.failWith(std::to_string(list.size()) + " " + what + ", expected at most " +
                      std::to_string(most));
}

/// Reads "muscles" as a list of the author's own, in which `true` stands for the automatic ones.
void readMuscles(const JsonReader& list, SkinFile& skin) {
    requireFew(list, 1000, "muscles"); // a body has 640; each is fitted to the skin separately
    list.forEachItem([&](const JsonReader& item) {
        if (item.isObject())
            skin.bind.ownMuscles.push_back(readMuscle(item));
        else if (item.boolean())
            skin.options.muscles = true;
        else
            skin.options.muscles.reset(); // false would leave out the author's own, too
    });
}

SkinFile::Spring readSpring(const JsonReader& reader, bool zIsUp) {
    reader.warnUnknown({"joints", "stiffness", "gravity", "drag", "radius", "centre", "colliders"});
    SkinFile::Spring spring;
    reader.require("joints", "a list of joints' names").forEachItem([&](const JsonReader& name) {
        spring.joints.push_back(name.string());
    });
    double gravity = 0.0;
    const auto read = [](const JsonReader& from, const char* key, double& value, double most) {
        const auto member = from.find(key);
        if (!member) return;
        value = member->number();
        if (value < 0.0 || value > most)
            member->failWith("expected 0 to " + std::to_string(int(most)));
    };
    read(reader, "stiffness", spring.like.stiffness, 1000.0);
    read(reader, "gravity", gravity, 1000.0);
    read(reader, "drag", spring.like.drag, 1.0);
    read(reader, "radius", spring.like.radius, 1000000.0);
    spring.like.gravity = {0.0, zIsUp ? 0.0 : -gravity, zIsUp ? -gravity : 0.0};
    if (const auto centre = reader.find("centre")) spring.centre = centre->string();
    if (const auto colliders = reader.find("colliders")) {
        requireFew(*colliders, 100, "colliders");
        colliders->forEachItem([&](const JsonReader& item) {
            item.warnUnknown({"joint", "from", "to", "radius"});
            SpringSettings::Collider collider;
            collider.joint = item.require("joint", "the joint that it moves with").string();
            if (const auto from = item.find("from")) collider.start = from->vector();
            collider.end = collider.start;
            if (const auto to = item.find("to")) collider.end = to->vector();
            item.require("radius", "a number");
            read(item, "radius", collider.radius, 1000000.0);
            spring.colliders.push_back(collider);
        });
    }
    return spring;
}

void readSprings(const JsonReader& list, SkinFile& skin) {
    requireFew(list, 1000, "springs");
    list.forEachItem([&](const JsonReader& item) {
        skin.springs.push_back(readSpring(item, skin.up == RetargetOptions::Up::Z));
    });
}

/// Reads a path relative to the description's folder.
std::string path(const JsonReader& reader, const std::string& folder) {
    const std::string name = reader.string();
    if (name.empty()) reader.failWith("expected a file name, found an empty string");
    constexpr std::size_t longest = 4096; // no file has a longer one (PATH_MAX)
    if (name.size() > longest)
        reader.failWith("a name of " + std::to_string(name.size()) + " bytes, expected at most " +
                        std::to_string(longest));
    if (name.find('\0') != std::string::npos)
        reader.failWith("the file's name contains a zero byte");
    return folder.empty() || osgDB::isAbsolutePath(name) ? name : osgDB::concatPaths(folder, name);
}

void checkVersion(const JsonReader& root) {
    const JsonReader version = root.require("osgskin", "the format's version, 1");
    const std::size_t number = version.count();
    if (number == 0 || number > SkinFile::kVersion)
        version.failWith("version " + std::to_string(number) + " is not supported, expected " +
                         std::to_string(SkinFile::kVersion));
}

RetargetOptions::Up readUp(const JsonReader& reader) {
    const std::string up = reader.string();
    if (up != "y" && up != "z") reader.failWith("expected \"y\" or \"z\", found \"" + up + "\"");
    return up == "y" ? RetargetOptions::Up::Y : RetargetOptions::Up::Z;
}

SkinFile::MotionEntry readMotion(const JsonReader& reader, const std::string& folder) {
    reader.warnUnknown({"file", "clip", "name", "skipFrames", "joints", "up"});
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
    if (const auto up = reader.find("up")) motion.up = readUp(*up);
    if (const auto joints = reader.find("joints"))
        joints->forEachMember([&](const std::string& joint, const JsonReader& value) {
            motion.joints[joint] = value.string();
        });
    return motion;
}

/// Families of names: role -> a joint's name, or a list of them.
class NamesReader {
public:
    /// \param max limit for the names of all families together: joints are looked up among them often
    explicit NamesReader(std::size_t max) : _max(max) {
        for (const JointNames& known : knownJointNames())
            for (const auto& [role, members] : known.roles) _roles.insert(role);
    }

    JointNames read(const std::string& family, const JsonReader& reader) {
        JointNames names{family, {}};
        reader.forEachMember([&](const std::string& role, const JsonReader& value) {
            if (_roles.count(role) == 0)
                value.failWith("no such part of a body" +
                               expectedNames(role, {_roles.begin(), _roles.end()}));
            const auto add = [&](const JsonReader& name) {
                if (++_count > _max)
                    name.failWith("one of more than " + std::to_string(_max) +
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
    const std::size_t _max;
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
    std::vector<std::string> names;
    for (const SkinFile::MotionEntry& known : skin.motions) {
        if (known.name == prop.motion) return prop;
        names.push_back(known.name);
    }
    motion.failWith("no motion is called \"" + prop.motion + '"' +
                    expectedNames(prop.motion, names));
}

/// Reads a region's two boundaries (paper, Fig. 3), in bone lengths from the joint.
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
                joint.twistAxis = JointBindOptions::Pole::Parent;
            else if (pole == "child")
                joint.twistAxis = JointBindOptions::Pole::Child;
            else
                along->failWith("expected \"parent\" or \"child\", found \"" + pole + "\"");
        }
    }
    return joint;
}

/// Reads "weights", the file for the method "weights".
void readWeightsFile(const JsonReader& root, const std::string& folder, SkinFile& skin) {
    const auto weights = root.find("weights");
    if (!weights) return;
    LoadOptions::Method& method = skin.options.method;
    if (method == LoadOptions::Method::Default) method = LoadOptions::Method::Weights;
    if (method != LoadOptions::Method::Weights)
        weights->failWith("expected \"bind\": \"weights\" beside it");
    skin.weights = path(*weights, folder);
}

/// Reads the members that are options, see optionTable().
void readOptions(const JsonReader& root, const ReadLimits& limits, SkinFile& skin) {
    for (const Option& option : optionTable()) {
        if (!option.isMember) continue;
        const auto member = root.find(option.word);
        if (!member) continue;
        if (option.word == "muscles" && member->isList())
            readMuscles(*member, skin);
        else if (option.word == "springs" && member->isList())
            readSprings(*member, skin);
        else
            readOption(option, *member, limits, skin.options);
    }
}

/// Members that are no options.
const char* const kParts[] = {"osgskin", "mesh",   "skeleton", "motions", "props",
                              "weights", "joints", "up",       "names"};

void warnUnknownMembers(const JsonReader& root) {
    std::vector<std::string> known(std::begin(kParts), std::end(kParts));
    for (const Option& option : optionTable())
        if (option.isMember) known.push_back(option.word);
    root.warnUnknown(known);
}

} // namespace

SkinFile SkinFile::read(const std::string& file, const ReadLimits& limits) {
    limits.checkFormat(file);
    const nlohmann::json json = JsonReader::parseFile(file, limits);
    const JsonReader root(json, file);
    const std::string folder = osgDB::getFilePath(file);
    checkVersion(root);
    warnUnknownMembers(root);

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
    if (const auto up = root.find("up")) skin.up = readUp(*up);
    if (skin.fit && skin.up == RetargetOptions::Up::Z) skin.fit->up = {0.0, 0.0, 1.0};
    for (const std::string& named : {skin.mesh, skin.skeleton}) limits.checkNamedFormat(named);
    for (const Prop& prop : skin.props) limits.checkNamedFormat(prop.mesh);
    readOptions(root, limits, skin);
    readWeightsFile(root, folder, skin);
    if (const auto joints = root.find("joints"))
        joints->forEachMember([&](const std::string& name, const JsonReader& value) {
            skin.bind.joints[name] = readJoint(value);
        });
    // Regions have boundaries, painted weights have none.
    if (skin.options.method == LoadOptions::Method::Default && !skin.bind.joints.empty())
        skin.options.method = LoadOptions::Method::Smooth;
    return skin;
}

} // namespace osgSkin
