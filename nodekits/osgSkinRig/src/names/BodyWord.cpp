// SPDX-License-Identifier: MIT
#include "names/BodyWord.h"

#include <algorithm>
#include <set>
#include <unordered_map>
#include <utility>

namespace osgSkin {
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

bool saysWhere(const std::string& before, BodyWord word) {
    const bool ofArm = word >= BodyWord::Collar;
    const bool ofLeg = word >= BodyWord::Hip && word <= BodyWord::Toe;
    const bool ofTrunk = word <= BodyWord::Spine;
    return ((before == "arm" || before == "shoulder") && ofArm) || (before == "leg" && ofLeg) ||
           (before == "spine" && ofTrunk) || (before == "neck" && word == BodyWord::Head);
}

bool isForeign(const std::string& word) {
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
