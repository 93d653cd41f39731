// SPDX-License-Identifier: GPL-3.0-or-later
#include <osgSkinCharacter/OptionString>

#include <osgSkin/Error>
#include <osgSkinCharacter/ProgressOption>
#include <osgSkinImport/ReadLimits>

#include <sstream>

namespace osgSkin {
namespace {

[[noreturn]] void fail(const std::string& key, const std::string& value, const char* expected) {
    throw Error("option " + key + "=" + value + ": expected " + expected);
}

LoadOptions::Method methodOf(const std::string& value) {
    if (value == "smooth") return LoadOptions::Method::Smooth;
    if (value == "paper") return LoadOptions::Method::Paper;
    if (value == "weights") return LoadOptions::Method::Weights;
    if (value == "default") return LoadOptions::Method::Default;
    fail("bind", value, "smooth, paper, weights or default");
}

BindOptions::Shapes shapesOf(const std::string& value) {
    if (const auto shapes = shapesCalled(value)) return *shapes;
    fail("shapes", value, "none, fast or elastic");
}

bool switchOf(const std::string& key, const std::string& value) {
    if (value == "on") return true;
    if (value == "off") return false;
    fail(key, value, "on or off");
}

bool surfaceNormalsOf(const std::string& value) {
    if (value != "surface" && value != "turned") fail("normals", value, "surface or turned");
    return value == "surface";
}

std::vector<std::string> namesOf(const std::string& value) {
    std::vector<std::string> names;
    if (value == "none") return names;
    std::istringstream list(value);
    for (std::string name; std::getline(list, name, ',');)
        if (!name.empty()) names.push_back(name);
    if (names.empty()) fail("rigid", value, "none, or names of joints with commas between them");
    return names;
}

} // namespace

LoadOptions toLoadOptions(const osgDB::Options* options) {
    LoadOptions result;
    if (options == nullptr) return result;
    result.readOptions = options;
    result.progress = getProgress(options);
    for (const auto& [key, value] : optionValues(options->getOptionString())) {
        if (key == "bind") result.method = methodOf(value);
        if (key == "shapes") result.shapes = shapesOf(value);
        if (key == "muscles") result.muscles = switchOf(key, value);
        if (key == "clearHands") result.clearHands = switchOf(key, value);
        if (key == "normals") result.surfaceNormals = surfaceNormalsOf(value);
        if (key == "rigid") result.rigid = namesOf(value);
        if (key == "gpu") result.gpu = switchOf(key, value);
        if (key == "motion") {
            if (value.empty()) fail(key, value, "a clip's name, a motion file, or none");
            result.atRest = value == "none";
            if (!result.atRest) result.motion = value;
        }
        if (key == "show") {
            if (value != "regions" && value != "skin") fail(key, value, "skin or regions");
            result.showRegions = value == "regions";
        }
    }
    return result;
}

std::optional<BindOptions::Shapes> shapesCalled(const std::string& word) {
    if (word == "none") return BindOptions::Shapes::None;
    if (word == "fast") return BindOptions::Shapes::Fast;
    if (word == "elastic") return BindOptions::Shapes::Elastic;
    return std::nullopt;
}

const std::vector<std::pair<const char*, const char*>>& optionWords() {
    static const std::vector<std::pair<const char*, const char*>> words{
        {"bind=<smooth|paper|weights>",
         "how ratios are found; a rig's own weights by default, where it is painted throughout"},
        {"motion=<clip|file|file#clip|none>", "the motion to play by its name, or a motion file to "
                                              "retarget, or one of the file's clips by "
                                              "name or number"},
        {"normals=<surface|turned>",
         "those of the deformed surface, or the rest skin's as their vertices turn them: faster"},
        {"rigid=<joint,joint|none>",
         "joints that move as rigid bodies; head, hands, feet by default"},
        {"shapes=<none|fast|elastic>",
         "what keeps bent limbs from swelling and from going through themselves; elastic takes "
         "a minute or more, and is kept in the cache folder"},
        {"muscles=<on|off>",
         "biceps, triceps, quadriceps, hamstrings and calves that swell; off by default"},
        {"clearHands=<on|off>",
         "on: motions that are carried over keep forearms and hands out of trunk, thighs and head; "
         "off by default"},
        {"gpu=<on|off>", "on: skins are deformed on the graphics card where it has OpenGL 4.3"},
        {"formats=<extension,extension>",
         "what may be read at all, as skin,obj,bvh,ply,gltf,glb, or all; by default everything but "
         ".osgb, .osgt, .osgx, .osg and .ive files that a .skin file names"},
        {"pictures=<extension,extension>", "images that OpenSceneGraph reads, from trusted files, "
                                           "beside those of formats, as ktx,dds"},
        {"maxFileMB=, maxTextMB=, maxJoints=, maxDepth=, maxSamples=, maxUses=, maxRatios=, "
         "maxInfluences=, maxPixels=<number>",
         "raises a limit of what files may ask for; errors say which"},
        {"show=<skin|regions>", "regions: each joint's region in a colour of its own"},
    };
    return words;
}

} // namespace osgSkin
