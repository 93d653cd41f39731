// SPDX-License-Identifier: MIT
#include <osgSkinRig/FaceNames>

#include "names/NameWords.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace osgSkin {
namespace {

/// A sum of ARKit's blend shapes: the index of each, and its weight.
using Sum = std::map<std::size_t, float>;

const std::vector<std::string> kArKit =
    split("eyeBlinkLeft eyeLookDownLeft eyeLookInLeft eyeLookOutLeft eyeLookUpLeft eyeSquintLeft "
          "eyeWideLeft eyeBlinkRight eyeLookDownRight eyeLookInRight eyeLookOutRight "
          "eyeLookUpRight eyeSquintRight eyeWideRight jawForward jawLeft jawRight jawOpen "
          "mouthClose mouthFunnel mouthPucker mouthLeft mouthRight mouthSmileLeft mouthSmileRight "
          "mouthFrownLeft mouthFrownRight mouthDimpleLeft mouthDimpleRight mouthStretchLeft "
          "mouthStretchRight mouthRollLower mouthRollUpper mouthShrugLower mouthShrugUpper "
          "mouthPressLeft mouthPressRight mouthLowerDownLeft mouthLowerDownRight mouthUpperUpLeft "
          "mouthUpperUpRight browDownLeft browDownRight browInnerUp browOuterUpLeft "
          "browOuterUpRight cheekPuff cheekSquintLeft cheekSquintRight noseSneerLeft "
          "noseSneerRight tongueOut");
const std::vector<std::string> kVisemes =
    split("viseme_sil viseme_PP viseme_FF viseme_TH viseme_DD viseme_kk viseme_CH viseme_SS "
          "viseme_nn viseme_RR viseme_aa viseme_E viseme_I viseme_O viseme_U");
const std::vector<std::string> kVrm =
    split("happy angry sad relaxed surprised aa ih ou ee oh blink blinkLeft blinkRight lookUp "
          "lookDown lookLeft lookRight neutral");

/// Names that mean the same, and their sum: "name*" is the left and the right one, and a weight in
/// percent follows where it is not 100. A row serves both sides and, by its part, each of them.
/// Words of names are joined, and sides are at the end.
const struct {
    const char *names, *sum;
} kRows[] = {
    // Vowels: VRM 0, VRM 1, VRoid; visemes.
    {"a,aa,ah,fclmtha", "jawOpen 70"},
    {"i,ih,fclmthi", "jawOpen 15 mouthStretch* 50 mouthSmile* 20"},
    {"u,ou,fclmthu", "jawOpen 15 mouthPucker 80"},
    {"e,ee,fclmthe", "jawOpen 30 mouthStretch* 40"},
    {"o,oh,fclmtho", "jawOpen 40 mouthFunnel 70"},
    {"pp", "mouthPress* 60 mouthRollLower 40 mouthRollUpper 40 mouthClose 30"},
    {"ff", "mouthRollLower 60 mouthUpperUp* 30"},
    {"th", "jawOpen 20 tongueOut 40"},
    {"dd", "jawOpen 20 mouthLowerDown* 20"},
    {"kk", "jawOpen 25 mouthStretch* 20"},
    {"ch", "jawOpen 10 mouthFunnel 50"},
    {"ss", "jawOpen 5 mouthStretch* 40 mouthLowerDown* 20"},
    {"nn", "jawOpen 15 mouthLowerDown* 20"},
    {"rr", "jawOpen 15 mouthPucker 40"},
    {"sil,neutral,fclallneutral,fclmthneutral,fcleyenatural", ""},
    // Expressions: VRM 0, VRM 1, VRoid.
    {"joy,happy,fclalljoy", "mouthSmile* 80 cheekSquint* 40"},
    {"angry,fclallangry", "browDown* mouthFrown* 40 noseSneer* 40"},
    {"sorrow,sad,fclallsorrow", "browInnerUp 80 mouthFrown* 60"},
    {"fun,relaxed,fclallfun", "mouthSmile* 50 eyeSquint* 30"},
    {"surprised,surprise,fclallsurprised", "browInnerUp 80 browOuterUp* 80 eyeWide* 80 jawOpen 40"},
    {"blink,fcleyeclose,eyesclosed,upperlidclosed", "eyeBlink*"},
    {"lookup,eyeslookup,eyeup", "eyeLookUp*"},
    {"lookdown,eyeslookdown,eyedown", "eyeLookDown*"},
    {"look left,eyeslook left", "eyeLookOutLeft eyeLookInRight"},
    {"look right,eyeslook right", "eyeLookInLeft eyeLookOutRight"},
    {"smile,fclmthfun,mouthpullup", "mouthSmile*"},
    {"fclmthjoy", "mouthSmile* 80 jawOpen 40"},
    {"frown,fclmthangry,fclmthsorrow,mouthpulldown", "mouthFrown*"},
    {"fclmthsurprised", "jawOpen 60 mouthFunnel 30"},
    {"fclmthclose", "mouthPress*"},
    {"fclmthsmall", "mouthPucker"},
    {"fclbrwangry", "browDown*"},
    {"fclbrwsorrow,innerbrowup", "browInnerUp"},
    {"fclbrwsurprised", "browInnerUp browOuterUp*"},
    {"fcleyesurprised,fcleyespread,upperlidopen", "eyeWide*"},
    {"fcleyeangry,lowerlidup", "eyeSquint*"},
    // Ready Player Me and MakeHuman.
    {"mouthopen,jawdrop,jawdropstretched", "jawOpen"},
    {"outerbrowup", "browOuterUp*"},
    {"eyeturn left left", "eyeLookOutLeft"},
    {"eyeturn left right", "eyeLookInLeft"},
    {"eyeturn right left", "eyeLookInRight"},
    {"eyeturn right right", "eyeLookOutRight"},
    {"nosewrinkler", "noseSneer*"},
    {"cheekup", "cheekSquint*"},
    {"cheekspump", "cheekPuff"},
    {"chin left", "jawLeft"},
    {"chin right", "jawRight"},
    {"chinforward", "jawForward"},
    {"mouthmove left", "mouthLeft"},
    {"mouthmove right", "mouthRight"},
    {"mouthpullside,mouthplatysma", "mouthStretch*"},
    {"lipskiss", "mouthPucker"},
    {"lowerlipup", "mouthShrugLower"},
    {"lowerlipdown", "mouthLowerDown*"},
    {"upperlipup", "mouthUpperUp*"},
    {"lowerlipbackward", "mouthRollLower"},
    {"upperlipbackward", "mouthRollUpper"},
    {"lowerlipforward,upperlipforward", "mouthFunnel 50"},
};

constexpr float kShare = 0.25f;  ///< of a target's square that a name must ask for
constexpr float kGain = 0.1f;    ///< of a name's square that such a target must add
constexpr float kLittle = 1e-3f; ///< a weight that does not count

bool endsWith(const std::string& text, const std::string& end) {
    return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// A name as words and sides: "eye blink" and " left" for "Face.EyeBlink_L".
struct Spelling {
    explicit Spelling(const std::string& name) {
        // A mesh's name may come first.
        for (std::size_t dot = name.rfind('.'); dot < name.size() && words.empty();
             dot = dot > 0 ? name.rfind('.', dot - 1) : std::string::npos)
            read(name.substr(dot + 1));
        if (words.empty()) read(name);
    }

    /// The words from one on, and the sides.
    std::string key(std::size_t first = 0) const {
        std::string result;
        for (std::size_t i = first; i < words.size(); ++i) result += words[i];
        return result + sides;
    }

    std::vector<std::string> words;
    std::string sides; ///< a space before each

private:
    void read(const std::string& name) {
        sides.clear();
        for (std::string word : nameWords(name)) {
            for (const std::string side : {"left", "right"}) {
                const bool isGlued = endsWith(word, side);
                if (isGlued) word.resize(word.size() - side.size());
                if (isGlued || word == side || word == side.substr(0, 1)) sides += ' ' + side;
                if (!isGlued && (word == side || word == side.substr(0, 1))) word.clear();
            }
            if (!word.empty() && !isNumber(word)) words.push_back(word);
        }
    }
};

Sum parseSum(const std::string& text) {
    Sum sum;
    std::vector<std::size_t> last;
    for (std::string word : split(text)) {
        if (isNumber(word)) {
            for (const std::size_t shape : last) sum[shape] = 0.01f * float(std::stoi(word));
            continue;
        }
        last.clear();
        const bool isBoth = word.back() == '*';
        if (isBoth) word.pop_back();
        for (std::size_t s = 0; s < kArKit.size(); ++s)
            if (kArKit[s] == word ||
                (isBoth && (kArKit[s] == word + "Left" || kArKit[s] == word + "Right")))
                last.push_back(s);
        for (const std::size_t shape : last) sum[shape] = 1.0f;
    }
    return sum;
}

/// All known names as sums.
std::map<std::string, Sum> makeTable() {
    std::map<std::string, Sum> table;
    for (std::size_t s = 0; s < kArKit.size(); ++s) {
        Spelling spelling(kArKit[s]);
        table[spelling.key()] = {{s, 1.0f}};
        const bool isDirection = spelling.words.back() == "jaw" || spelling.words.back() == "mouth";
        if (!std::exchange(spelling.sides, "").empty() && !isDirection)
            table[spelling.key()][s] = 1.0f;
    }
    for (const auto& row : kRows)
        for (const std::string& name : split(row.names, ',')) table[name] = parseSum(row.sum);
    const std::map<std::string, Sum> known = table;
    for (const auto& [name, sum] : known) {
        if (name.find(' ') != std::string::npos) continue;
        // "blink left" by "blink": the shapes of that side, and half of those in the middle.
        Sum left, right;
        for (const auto& [shape, weight] : sum) {
            const bool isLeft = endsWith(kArKit[shape], "Left");
            const bool isRight = endsWith(kArKit[shape], "Right");
            if (!isRight) left[shape] = isLeft ? weight : 0.5f * weight;
            if (!isLeft) right[shape] = isRight ? weight : 0.5f * weight;
        }
        table.emplace(name + " left", left);
        table.emplace(name + " right", right);
    }
    return table;
}

/// The sum of a name; null where it is not known.
const Sum* findSum(const std::string& key) {
    static const std::map<std::string, Sum> table = makeTable();
    const auto found = table.find(key);
    return found == table.end() ? nullptr : &found->second;
}

/// The meaning of a name, in any spelling.
struct Meaning {
    explicit Meaning(const std::string& name) : key(name) {
        if (std::any_of(name.begin(), name.end(), [](char c) { return (c & 0x80) != 0; }))
            return; // its ASCII letters are not all of it
        const Spelling spelling(name);
        if (!spelling.words.empty()) key = spelling.key();
        for (std::size_t i = 0; i < spelling.words.size() && !sum; ++i) {
            // One word behind others says little: "Fcl_BRW_Joy" is not "joy".
            const bool isLast = i > 0 && i + 1 == spelling.words.size();
            if (isLast && spelling.words[i - 1] != "viseme" && spelling.words[i - 1] != "v") break;
            sum = findSum(spelling.key(i));
            if (sum) key = spelling.key(i);
        }
    }

    std::string key;
    const Sum* sum = nullptr; ///< null where the table has none
};

float dot(const Sum& a, const Sum& b) {
    float result = 0.0f;
    for (const auto& [shape, weight] : a)
        if (const auto found = b.find(shape); found != b.end()) result += weight * found->second;
    return result;
}

/// A target of the character.
struct Target {
    std::vector<std::string> morphs; ///< its names, in the scene's order
    const Sum* sum;
};

/// The part of a sum's square whose shapes another has, too.
float shareIn(const Sum& wanted, const Sum& sum) {
    float inside = 0.0f;
    for (const auto& [shape, weight] : sum)
        if (wanted.count(shape) != 0) inside += weight * weight;
    return inside / dot(sum, sum);
}

/// Fits a sum by targets: in each step by the one that leaves the least (matching pursuit).
std::vector<FaceMatch::Part> fit(const Sum& wanted, const std::vector<Target>& targets) {
    std::vector<FaceMatch::Part> parts;
    std::vector<bool> isUsed(targets.size(), false);
    for (Sum rest = wanted;;) {
        const Target* best = nullptr;
        float bestGain = 0.0f, bestWeight = 0.0f;
        for (std::size_t t = 0; t < targets.size(); ++t) {
            const Sum* const sum = targets[t].sum;
            if (isUsed[t] || !sum || sum->empty()) continue;
            const float along = dot(rest, *sum), square = dot(*sum, *sum);
            const float share = shareIn(wanted, *sum);
            const float weight = std::min(1.0f, along / square);
            const float gain = weight * (2.0f * along - weight * square); // of rest's square
            const bool isPure = share > 1.0f - kLittle;
            if (weight < kLittle || gain <= bestGain || share < kShare) continue;
            if (!isPure && gain < kGain * dot(wanted, wanted)) continue;
            best = &targets[t];
            bestGain = gain;
            bestWeight = weight;
        }
        if (!best) return parts;
        isUsed[std::size_t(best - targets.data())] = true;
        parts.push_back({best->morphs, bestWeight});
        for (const auto& [shape, weight] : *best->sum) rest[shape] -= bestWeight * weight;
    }
}

} // namespace

const std::vector<std::string>& faceNames(FaceVocabulary vocabulary) {
    if (vocabulary == FaceVocabulary::Visemes) return kVisemes;
    return vocabulary == FaceVocabulary::Vrm ? kVrm : kArKit;
}

std::vector<FaceMatch> matchFace(const std::vector<std::string>& names,
                                 const std::vector<std::string>& morphs) {
    std::vector<Target> targets;
    std::map<std::string, std::size_t> known; // by key
    for (const std::string& morph : morphs) {
        const Meaning meaning(morph);
        const auto [at, isNew] = known.emplace(meaning.key, targets.size());
        if (isNew) targets.push_back({{}, meaning.sum});
        // The shortest first: of a VRM's own, expressions keep theirs.
        std::vector<std::string>& same = targets[at->second].morphs;
        const auto longer = std::find_if(same.begin(), same.end(), [&](const std::string& other) {
            return other.size() > morph.size();
        });
        same.insert(longer, morph);
    }
    std::vector<FaceMatch> result;
    for (const std::string& name : names) {
        FaceMatch match{name, FaceMatch::Kind::Own, {}};
        const Meaning meaning(name);
        if (const auto own = known.find(meaning.key); own != known.end()) {
            match.parts.push_back({targets[own->second].morphs, 1.0f});
            std::vector<std::string>& same = match.parts.back().morphs;
            if (const auto exact = std::find(same.begin(), same.end(), name); exact != same.end())
                std::rotate(same.begin(), exact, std::next(exact));
        } else if (meaning.sum) {
            match.parts = fit(*meaning.sum, targets);
            match.kind = meaning.sum->empty()  ? FaceMatch::Kind::Rest
                         : match.parts.empty() ? FaceMatch::Kind::None
                                               : FaceMatch::Kind::Table;
        } else {
            match.kind = FaceMatch::Kind::None;
        }
        result.push_back(std::move(match));
    }
    return result;
}

} // namespace osgSkin
