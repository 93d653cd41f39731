// SPDX-License-Identifier: MIT
#include "names/NameWords.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <sstream>
#include <unordered_map>
#include <utility>

namespace osgSkin {
namespace {

/// Longer names are not parsed: nobody names a part of a body so, and parsing would take long.
constexpr std::size_t kLongestName = 1000;

bool isLetter(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

bool isDigit(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

bool isUpper(char c) {
    return std::isupper(static_cast<unsigned char>(c)) != 0;
}

bool isBeyondAscii(char c) {
    return static_cast<unsigned char>(c) >= 0x80;
}

char lower(char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

/// Text before a colon or bar is a namespace, not the joint's name.
std::string withoutNamespace(const std::string& name, const char* marks) {
    return name.substr(name.find_last_of(marks) + 1);
}

/// FBX exporters write "FBXASC" and three digits for signs that Maya does not allow.
std::string withoutCodes(std::string name) {
    const std::string code = "FBXASC";
    for (std::size_t at = name.find(code); at != std::string::npos; at = name.find(code, at + 1)) {
        const std::string digits = name.substr(at + code.size(), 3);
        if (digits.size() < 3 || !isNumber(digits) || std::stoi(digits) > 126) continue;
        name.replace(at, code.size() + 3, 1, static_cast<char>(std::stoi(digits)));
    }
    return name;
}

/// "NPC Head [Head]" is "NPC Head", but "Arm (L)" stays: a side says something.
std::string withoutNote(const std::string& name) {
    const std::size_t open = name.find_first_of("[(");
    const std::size_t close = name.find_last_of(")]");
    if (open == 0 || open == std::string::npos || close == std::string::npos || close < open + 3)
        return name;
    return name.substr(0, open) + name.substr(close + 1);
}

/// "LUArm", "RFArm": a side and the upper arm or forearm.
bool beginsShortArm(const std::string& name, std::size_t i) {
    if ((name[i] != 'U' && name[i] != 'F') || i == 0 || i + 2 >= name.size()) return false;
    const bool afterSide =
        (name[i - 1] == 'L' || name[i - 1] == 'R') && (i == 1 || !isUpper(name[i - 2]));
    return afterSide && isUpper(name[i + 1]) && isLetter(name[i + 2]) && !isUpper(name[i + 2]);
}

std::vector<std::string> wordsOf(const std::string& name) {
    std::vector<std::string> result;
    bool inWord = false;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        if (!isLetter(c)) {
            if (isDigit(c)) {
                if (i > 0 && isDigit(name[i - 1]))
                    result.back() += c;
                else
                    result.emplace_back(1, c);
            }
            inWord = false;
            continue;
        }
        const bool afterLower = i > 0 && isLetter(name[i - 1]) && !isUpper(name[i - 1]);
        const bool beforeLower =
            i + 1 < name.size() && isLetter(name[i + 1]) && !isUpper(name[i + 1]);
        if (!inWord || (isUpper(c) && (afterLower || beforeLower)) || beginsShortArm(name, i))
            result.emplace_back();
        result.back() += lower(c);
        inWord = true;
    }
    return result;
}

} // namespace

bool isNumber(const std::string& word) {
    for (const char c : word)
        if (!isDigit(c)) return false;
    return !word.empty();
}

bool isPivot(const std::string& name) {
    return name.find("$AssimpFbx$") != std::string::npos;
}

std::string plainName(const std::string& name) {
    std::string result;
    for (const char c : withoutNamespace(name, ":|"))
        if (isLetter(c) || isDigit(c) || isBeyondAscii(c)) result += lower(c);
    return result;
}

std::vector<std::string> nameWords(const std::string& name) {
    if (name.size() > kLongestName || isPivot(name)) return {};
    return wordsOf(withoutNote(withoutNamespace(withoutCodes(name), ":|/")));
}

std::string bareName(const std::string& name) {
    static const std::set<std::string> kSides = {"l", "r", "left", "right"};
    static const std::set<std::string> kPrefixes = {"bip", "mixamorig", "def", "org"};
    std::string bare;
    bool afterPrefix = false;
    for (const std::string& word : wordsOf(withoutNamespace(name, ":|"))) {
        if (bare.empty() && kPrefixes.count(word)) {
            afterPrefix = true;
            continue;
        }
        if (afterPrefix && isDigit(word[0]) && bare.empty()) continue; // Bip01
        if (!kSides.count(word)) bare += word;
    }
    for (const std::string side : {"left", "right"}) // all in lower case: "lefthand"
        if (bare.compare(0, side.size(), side) == 0) bare.erase(0, side.size());
    return bare;
}

bool nameContains(const std::string& name, const char* part) {
    std::string lowered = name;
    for (char& c : lowered) c = lower(c);
    return lowered.find(part) != std::string::npos;
}

namespace {

using Entry = std::pair<std::string, BodyWord>;

void addFingers(std::vector<Entry>& words) {
    const std::pair<const char*, BodyWord> kFingers[] = {
        {"thumb", BodyWord::Thumb},   {"index", BodyWord::Index},   {"pointer", BodyWord::Index},
        {"middle", BodyWord::Middle}, {"mid", BodyWord::Middle},    {"ring", BodyWord::Ring},
        {"pinky", BodyWord::Little},  {"pinkie", BodyWord::Little}, {"little", BodyWord::Little}};
    for (const auto& [name, word] : kFingers) {
        const std::string finger = name;
        for (const std::string before : {"", "hand", "finger", "f"})
            for (const std::string after : {"", "finger", "proximal", "intermediate", "distal"})
                words.emplace_back(before + finger + after, word);
    }
    words.emplace_back("thumbmetacarpal", BodyWord::Thumb); // VRM's first, which turns the thumb
}

std::vector<Entry> allWords() {
    const std::pair<BodyWord, std::vector<const char*>> kParts[] = {
        {BodyWord::Hips, {"hips", "hip"}},
        {BodyWord::Pelvis, {"pelvis"}},
        {BodyWord::Spine,
         {"spine",      "chest",      "upperchest",    "lowerchest",   "chestupper", "chestlower",
          "upperspine", "lowerspine", "middlespine",   "midspine",     "spineupper", "spinelower",
          "spinemid",   "spinebase",  "spineshoulder", "lowerback",    "upperback",  "midback",
          "abdomen",    "ab",         "abdomenlower",  "abdomenupper", "torso",      "uppertorso",
          "lowertorso", "upperbody",  "waist",         "stomach",      "thorax",     "ribcage",
          "ribs",       "lumbar"}},
        {BodyWord::Neck, {"neck", "upperneck", "lowerneck", "neckupper", "necklower", "necktwist"}},
        {BodyWord::Head, {"head", "skull"}},
        {BodyWord::HipJoint, {"hipjoint", "buttock"}},
        {BodyWord::Thigh,
         {"thigh", "upleg", "upperleg", "legupper", "legup", "femur", "uplegs", "upperlegs"}},
        {BodyWord::Leg, {"leg"}},
        {BodyWord::Shin,
         {"shin", "calf", "knee", "lowleg", "lowerleg", "leglower", "leglow", "loleg", "tibia",
          "shank"}},
        {BodyWord::Foot, {"foot", "ankle", "footankle", "talus"}},
        {BodyWord::Toe, {"toe", "toes", "toebase", "ball", "foottoe"}},
        {BodyWord::Collar, {"collar", "clavicle", "clavical", "clav", "collarbone", "scapula"}},
        {BodyWord::Shoulder, {"shoulder"}},
        {BodyWord::UpperArm,
         {"upperarm", "uparm", "uarm", "armupper", "armup", "shldr", "humerus"}},
        {BodyWord::Arm, {"arm"}},
        {BodyWord::ForeArm,
         {"forearm", "lowerarm", "lowarm", "armlower", "armlow", "loarm", "farm", "elbow", "radius",
          "ulna"}},
        {BodyWord::Hand, {"hand", "wrist", "handwrist"}},
        {BodyWord::FingerBase, {"fingerbase"}},
        {BodyWord::Fingers, {"fingers"}},
        {BodyWord::Finger, {"finger"}}};
    std::vector<Entry> words;
    for (const auto& [part, names] : kParts)
        for (const char* name : names) words.emplace_back(name, part);
    addFingers(words);
    std::stable_sort(words.begin(), words.end(), [](const Entry& a, const Entry& b) {
        return a.first.size() > b.first.size();
    });
    return words;
}

} // namespace

const std::vector<Entry>& bodyWords() {
    static const std::vector<Entry> words = allWords();
    return words;
}

std::optional<BodyWord> findBodyWord(const std::string& joined) {
    static const std::unordered_map<std::string, BodyWord> words(bodyWords().begin(),
                                                                 bodyWords().end());
    const auto found = words.find(joined);
    if (found == words.end()) return std::nullopt;
    return found->second;
}

bool hasSides(BodyWord word) {
    return word >= BodyWord::Hip;
}

bool isPositional(const std::string& before, BodyWord word) {
    const bool ofArm = word >= BodyWord::Collar;
    const bool ofLeg = word >= BodyWord::Hip && word <= BodyWord::Toe;
    const bool ofTrunk = word <= BodyWord::Spine;
    return ((before == "arm" || before == "shoulder") && ofArm) || (before == "leg" && ofLeg) ||
           (before == "spine" && ofTrunk) || (before == "neck" && word == BodyWord::Head);
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> result;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, separator);) result.push_back(part);
    return result;
}

bool isAccessory(const std::string& word) {
    static const std::set<std::string> words{
        // controls, helpers and what corrects a skin
        "ik", "fk", "ctrl", "ctl", "cntrl", "control", "con", "mch", "wgt", "pole", "target", "tgt",
        "aim", "helper", "hlp", "twist", "tweak", "roll", "corrective", "fix", "vb", "virtual",
        "driver", "drv", "offset", "gizmo", "spline", "null", "end", "nub", "tip", "muscle", "phys",
        "jiggle", "dyn", "spring", "sim", "collider", "hit", "hitbox", "hint", "ref", "goal",
        // what is attached or worn
        "attach", "attachment", "socket", "slot", "prop", "weapon", "sword", "gun", "shield",
        "item", "holder", "mount", "dummy", "locator", "loc", "marker", "camera", "light", "hair",
        "cloth", "skirt", "cape", "coat", "sleeve", "tail", "wing", "pad", "armor", "armour",
        // other animals' limbs
        "front", "fore", "rear", "back", "hind", "middle", "mid"};
    return words.count(word) != 0;
}

} // namespace osgSkin
