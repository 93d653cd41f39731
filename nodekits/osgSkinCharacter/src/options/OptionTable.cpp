// SPDX-License-Identifier: MIT
#include "options/OptionTable.h"

#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkinCharacter/OptionString>
#include <osgSkinCharacter/ProgressOption>

#include <osg/Notify>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <locale>
#include <optional>
#include <sstream>
#include <utility>

namespace osgSkin {
namespace {

using Method = LoadOptions::Method;
using Shapes = BindOptions::Shapes;

template <typename T>
bool isSet(const std::optional<T>& value) {
    return value.has_value();
}

bool isSet(Method method) {
    return method != Method::Default;
}

bool isSet(bool value) {
    return value;
}

template <typename Field>
auto completeBy(Field LoadOptions::*field) {
    return [field](LoadOptions& options, const LoadOptions& file) {
        if (!isSet(options.*field)) options.*field = file.*field;
    };
}

/// "a, b or c", each in quotes where asked for.
std::string oneOf(const std::vector<std::string>& values, const std::string& quote = "") {
    std::string text;
    for (std::size_t i = 0; i < values.size(); ++i)
        text += (i == 0 ? "" : i + 1 == values.size() ? " or " : ", ") + quote + values[i] + quote;
    return text;
}

/// Whether it is a member of `.skin` files.
enum class In { StringsOnly, Files };

/// Texts of an option, without its values.
struct Texts {
    const char* word;
    std::string defaultValue;
    const char* meaning;
};

Option textsOf(const Texts& texts, const std::string& values, In where) {
    Option option;
    option.word = texts.word;
    option.values = values;
    option.defaultValue = texts.defaultValue;
    option.meaning = texts.meaning;
    option.isMember = where == In::Files;
    return option;
}

/// An option with a fixed set of values.
template <typename Field, typename Value>
Option choice(const Texts& texts, Field LoadOptions::*field,
              const std::vector<std::pair<std::string, Value>>& values, In where = In::Files) {
    Option option = textsOf(texts, "", where);
    for (const auto& [name, value] : values) {
        option.values += (option.values.empty() ? "" : "|") + name;
        option.choices.push_back(name);
    }
    option.expected = oneOf(option.choices);
    option.set = [field, values](LoadOptions& options, const std::string& text) {
        for (const auto& [name, value] : values) {
            if (name != text) continue;
            options.*field = value;
            return true;
        }
        return false;
    };
    option.complete = completeBy(field);
    return option;
}

template <typename Field>
Option onOff(const Texts& texts, Field LoadOptions::*field, In where = In::Files) {
    return choice<Field, bool>(texts, field, {{"on", true}, {"off", false}}, where);
}

std::vector<std::string> listOf(const std::string& text) {
    std::vector<std::string> names;
    std::istringstream list(text);
    for (std::string name; std::getline(list, name, ',');)
        if (!name.empty()) names.push_back(name);
    return names;
}

Option rigidOption() {
    Option option = textsOf({"rigid",
                             "head, hands and feet, by name; not those with fingers, toes or other "
                             "joints that a motion moves",
                             "joints that move as rigid bodies with all joints below them; merged: "
                             "these joints, drawn with the skin instead of as nodes below "
                             "bones"},
                            "joint,joint|none|merged", In::Files);
    option.expected = "none, merged, or names of joints with commas between them";
    option.set = [](LoadOptions& options, const std::string& text) {
        options.mergeRigid = text == "merged";
        options.rigid.reset();
        if (!options.mergeRigid)
            options.rigid = text == "none" ? std::vector<std::string>() : listOf(text);
        return options.mergeRigid || text == "none" || !options.rigid->empty();
    };
    option.read = [](LoadOptions& options, const JsonReader& member, const ReadLimits& limits) {
        if (member.isString()) {
            if (member.string() != "merged")
                member.failWith("expected a list of joints' names, or \"merged\"");
            options.mergeRigid = true;
            return;
        }
        if (member.size() > limits.joints)
            member.failWith(std::to_string(member.size()) + " names, expected at most " +
                            std::to_string(limits.joints) + " (option maxJoints)");
        options.rigid.emplace();
        member.forEachItem(
            [&](const JsonReader& name) { options.rigid->push_back(name.string()); });
    };
    option.complete = [](LoadOptions& options, const LoadOptions& file) {
        if (options.rigid) return;
        options.rigid = file.rigid; // also names the joints of merged parts
        options.mergeRigid = options.mergeRigid || file.mergeRigid;
    };
    return option;
}

constexpr std::pair<const char*, double> kUnits[] = {
    {"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}};

bool isUnit(double metres) {
    return metres >= 1e-9 && metres <= 1e9; // also false for NaN
}

Option unitOption() {
    Option option = textsOf(
        {"unit", "as the mesh or the skeleton states it, else m",
         "the unit of files that do not state theirs, as FBX, Collada and glTF files do; a number, "
         "metres per unit, also replaces what a file states; the scene is in metres"},
        "", In::Files);
    for (const auto& [name, metres] : kUnits) option.values += std::string(name) + "|";
    option.values += "number";
    option.expected = "m, cm, mm, in, ft, or metres per unit (1e-9 to 1e9)";
    option.set = [](LoadOptions& options, const std::string& text) {
        for (const auto& [name, metres] : kUnits)
            if (text == name) {
                options.unit = FileUnit{metres, false};
                return true;
            }
        double metres = 0.0;
        std::istringstream in(text);
        in.imbue(std::locale::classic()); // a decimal point, whatever the user's language
        const bool isNumber = (in >> std::noskipws >> metres) && in.peek() == EOF;
        options.unit = FileUnit{metres, true};
        return isNumber && isUnit(metres);
    };
    const auto set = option.set;
    option.read = [set, expected = option.expected](LoadOptions& options, const JsonReader& member,
                                                    const ReadLimits&) {
        if (member.isNumber()) options.unit = FileUnit{member.number(), true};
        const bool isValid =
            member.isNumber() ? isUnit(options.unit->metres) : set(options, member.string());
        if (!isValid) member.failWith("expected " + expected);
    };
    option.complete = completeBy(&LoadOptions::unit);
    return option;
}

Option motionOption() {
    Option option = textsOf({"motion", "the first one",
                             "the motion to play by its name, or a motion file to retarget, or one "
                             "of the file's clips by name or number; names with blanks need double "
                             "quotes, as -O 'motion=\"Idle Loop\"'"},
                            "clip|file|file#clip|none", In::StringsOnly);
    option.expected = "a clip's name, a motion file, or none";
    option.set = [](LoadOptions& options, const std::string& text) {
        options.atRest = text == "none";
        if (!options.atRest) options.motion = text;
        return !text.empty();
    };
    return option;
}

/// An option that ReadLimits::of() reads.
Option readingOption(const Texts& texts, const char* values = "number") {
    return textsOf(texts, values, In::StringsOnly);
}

std::vector<Option> makeTable() {
    const ReadLimits limits;
    const auto number = [](std::size_t value) { return std::to_string(value); };
    return {
        choice<Method, Method>(
            {"bind", "weights where the mesh is painted throughout, else smooth",
             "how ratios are found: from regions of the skin, between two boundary planes a joint "
             "as the paper prints them, or from painted weights"},
            &LoadOptions::method,
            {{"smooth", Method::Smooth},
             {"paper", Method::Paper},
             {"weights", Method::Weights},
             {"default", Method::Default}}),
        choice<std::optional<Shapes>, Shapes>(
            {"shapes", "fast; none with paper and weights",
             "what keeps bent limbs from swelling and from going through themselves"},
            &LoadOptions::shapes, {{"none", Shapes::None}, {"fast", Shapes::Fast}}),
        onOff({"muscles", "off", "muscles of arms, legs, chest, shoulders and buttocks swell"},
              &LoadOptions::muscles),
        choice<std::optional<bool>, bool>(
            {"normals", "surface; rotated with paper and weights",
             "those of the deformed surface, or the rest skin's, rotated with their vertices: "
             "faster"},
            &LoadOptions::surfaceNormals, {{"surface", true}, {"rotated", false}}),
        rigidOption(),
        onOff({"avoidBody", "off", "motions from files keep arms out of trunk, thighs and head"},
              &LoadOptions::avoidBody),
        choice<std::optional<bool>, bool>(
            {"springs", "file", "file: hair and clothes swing where the file states springs"},
            &LoadOptions::springs, {{"file", true}, {"none", false}}),
        unitOption(),
        motionOption(),
        onOff({"gpu", "off",
               "skins are deformed on the graphics card where a context has OpenGL 4.3"},
              &LoadOptions::gpu, In::StringsOnly),
        choice<bool, bool>({"show", "skin", "regions: each joint's region in a colour of its own"},
                           &LoadOptions::showRegions, {{"skin", false}, {"regions", true}},
                           In::StringsOnly),
        readingOption(
            {"formats", "all but scenes named in .skin files",
             "file formats that may be read, as skin,obj,bvh,ply,gltf,glb, or all; all also "
             "allows a .skin file to name .osgb, .osgt, .osgx, .osg and .ive files"},
            "extension,extension"),
        readingOption({"colours", "material",
                       "merged: materials that differ in their colour alone become one skin whose "
                       "vertices have the colours, which is faster"},
                      "material|merged"),
        readingOption({"images", "none",
                       "more image formats, read by OpenSceneGraph; for trusted files, as ktx,dds"},
                      "extension,extension"),
        readingOption({"maxFileMB", number(limits.fileMegabytes), "megabytes of any file"}),
        readingOption({"maxTextMB", number(limits.textMegabytes),
                       "megabytes of a .skin file, or one of weights"}),
        readingOption({"maxJoints", number(limits.joints), "joints of a skeleton"}),
        readingOption({"maxDepth", number(limits.depth), "joints or nodes below each other"}),
        readingOption({"maxSamples", number(limits.samples),
                       "joints times frames of all motions, in addition to one for every two "
                       "bytes of their files"}),
        readingOption({"maxUses", number(limits.uses),
                       "how often motions and props of a .skin file name the same file"}),
        readingOption({"maxRatios", number(limits.ratios), "joints times vertices of a body"}),
        readingOption({"maxInfluences", number(limits.influences),
                       "joints that vertices follow, of all vertices together, in addition to 25 "
                       "for every vertex"}),
        readingOption({"maxPixels", number(limits.pixels),
                       "pixels of a model's images, in addition to sixteen for every byte of "
                       "their files"}),
    };
}

const Option* findOption(const std::string& word) {
    const std::vector<Option>& table = optionTable();
    const auto found = std::find_if(table.begin(), table.end(),
                                    [&](const Option& option) { return option.word == word; });
    return found == table.end() ? nullptr : &*found;
}

} // namespace

const std::vector<Option>& optionTable() {
    static const std::vector<Option> table = makeTable();
    return table;
}

const std::vector<CharacterOption>& characterOptions() {
    static const std::vector<CharacterOption> options(optionTable().begin(), optionTable().end());
    return options;
}

std::string CharacterOption::flag() const {
    std::string text = "--";
    for (const char c : word) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isupper(byte)) text += '-';
        text += static_cast<char>(std::tolower(byte));
    }
    return text;
}

bool setOption(LoadOptions& options, const std::string& word, const std::string& value) {
    const Option* option = findOption(word);
    if (option == nullptr || !option->set) return false;
    if (!option->set(options, value))
        throw Error("option " + word + "=" + value + ": expected " + option->expected);
    return true;
}

void readOption(const Option& option, const JsonReader& member, const ReadLimits& limits,
                LoadOptions& options) {
    if (option.read) {
        option.read(options, member, limits);
    } else if (option.values == "on|off") {
        option.set(options, member.boolean() ? "on" : "off");
    } else {
        const std::string value = member.string();
        std::vector<std::string> choices = option.choices; // leaving it out is a file's default
        choices.erase(std::remove(choices.begin(), choices.end(), "default"), choices.end());
        if (value == "default" || !option.set(options, value))
            member.failWith("expected " + oneOf(choices, "\"") + ", found \"" + value + "\"");
    }
}

void completeOptions(LoadOptions& options, const LoadOptions& file) {
    for (const Option& option : optionTable())
        if (option.complete) option.complete(options, file);
}

namespace {

/// Warns about an option that is probably misspelt. Other unknown words may be for other readers.
void warnMisspelt(const std::string& word) {
    std::vector<std::string> known;
    for (const Option& option : optionTable()) known.push_back(option.word);
    const std::string meant = nearestName(word, known);
    if (!meant.empty())
        OSG_WARN << onOneLine("unknown option \"" + word + "\" ignored; did you mean \"" + meant +
                              "\"?")
                 << std::endl;
}

} // namespace

LoadOptions toLoadOptions(const osgDB::Options* options) {
    LoadOptions result;
    if (options == nullptr) return result;
    result.readOptions = options;
    result.progress = getProgress(options);
    for (const auto& [word, value] : optionValues(options->getOptionString()))
        if (findOption(word) == nullptr)
            warnMisspelt(word);
        else
            setOption(result, word, value);
    return result;
}

std::optional<BindOptions::Shapes> shapesCalled(const std::string& word) {
    LoadOptions options;
    findOption("shapes")->set(options, word);
    return options.shapes;
}

const std::vector<std::pair<const char*, const char*>>& optionWords() {
    static const std::vector<std::pair<std::string, std::string>> texts = [] {
        std::vector<std::pair<std::string, std::string>> made;
        for (const CharacterOption& option : characterOptions())
            made.emplace_back(option.word + "=<" + option.values + ">",
                              option.meaning + " (default: " + option.defaultValue + ")");
        return made;
    }();
    static const std::vector<std::pair<const char*, const char*>> words = [] {
        std::vector<std::pair<const char*, const char*>> made;
        made.reserve(texts.size());
        for (const auto& [word, meaning] : texts) made.emplace_back(word.c_str(), meaning.c_str());
        return made;
    }();
    return words;
}

} // namespace osgSkin
