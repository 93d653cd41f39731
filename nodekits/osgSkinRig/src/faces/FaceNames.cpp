// SPDX-License-Identifier: MIT
#include <osgSkinRig/FaceNames>

#include "names/NameWords.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <sstream>
#include <utility>

namespace osgSkin {
namespace {

/// A sum of ARKit's blend shapes: the index of each, and its weight.
using Sum = std::map<std::size_t, float>;

std::vector<std::string> split(const std::string& text, char separator = ' ') {
    std::vector<std::string> result;
    std::istringstream in(text);
    for (std::string word; std::getline(in, word, separator);) result.push_back(word);
    return result;
}

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

/// Names that mean the same, and their sum: "name*" is the left and the right one, and a weight
/// follows where it is not 1. A row serves both sides and, by its part, each of them. Words of
/// names are joined, and sides are at the end.
const struct {
    const char *names, *sum;
} kRows[] = {
    // Vowels: VRM 0, VRM 1, VRoid; visemes.
    {"a,aa,ah,fclmtha", "jawOpen .7"},
    {"i,ih,fclmthi", "jawOpen .15 mouthStretch* .5 mouthSmile* .2"},
    {"u,ou,fclmthu", "jawOpen .15 mouthPucker .8"},
    {"e,ee,fclmthe", "jawOpen .3 mouthStretch* .4"},
    {"o,oh,fclmtho", "jawOpen .4 mouthFunnel .7"},
    {"pp", "mouthPress* .6 mouthRollLower .4 mouthRollUpper .4 mouthClose .3"},
    {"ff", "mouthRollLower .6 mouthUpperUp* .3"},
    {"th", "jawOpen .2 tongueOut .4"},
    {"dd", "jawOpen .2 mouthLowerDown* .2"},
    {"kk", "jawOpen .25 mouthStretch* .2"},
    {"ch", "jawOpen .1 mouthFunnel .5"},
    {"ss", "jawOpen .05 mouthStretch* .4 mouthLowerDown* .2"},
    {"nn", "jawOpen .15 mouthLowerDown* .2"},
    {"rr", "jawOpen .15 mouthPucker .4"},
    {"sil,neutral,fclallneutral,fclmthneutral,fcleyenatural", ""},
    // Expressions: VRM 0, VRM 1, VRoid.
    {"joy,happy,fclalljoy", "mouthSmile* .8 cheekSquint* .4"},
    {"angry,fclallangry", "browDown* mouthFrown* .4 noseSneer* .4"},
    {"sorrow,sad,fclallsorrow", "browInnerUp .8 mouthFrown* .6"},
    {"fun,relaxed,fclallfun", "mouthSmile* .5 eyeSquint* .3"},
    {"surprised,surprise,fclallsurprised", "browInnerUp .8 browOuterUp* .8 eyeWide* .8 jawOpen .4"},
    {"blink,fcleyeclose,eyesclosed,upperlidclosed", "eyeBlink*"},
    {"lookup,eyeslookup,eyeup", "eyeLookUp*"},
    {"lookdown,eyeslookdown,eyedown", "eyeLookDown*"},
    {"look left,eyeslook left", "eyeLookOutLeft eyeLookInRight"},
    {"look right,eyeslook right", "eyeLookInLeft eyeLookOutRight"},
    {"smile,fclmthfun,mouthpullup", "mouthSmile*"},
    {"fclmthjoy", "mouthSmile* .8 jawOpen .4"},
    {"frown,fclmthangry,fclmthsorrow,mouthpulldown", "mouthFrown*"},
    {"fclmthsurprised", "jawOpen .6 mouthFunnel .3"},
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
    {"lowerlipforward,upperlipforward", "mouthFunnel .5"},
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

/// All known names as sums.
class Table {
public:
    static const Table& get() {
        static const Table table;
        return table;
    }

    /// The sum of a name; null where it is not known.
    const Sum* find(const std::string& key) const {
        const auto found = _sums.find(key);
        return found == _sums.end() ? nullptr : &found->second;
    }

private:
    Table() {
        for (std::size_t s = 0; s < kArKit.size(); ++s) {
            const Spelling spelling(kArKit[s]);
            _sums[spelling.key()] = {{s, 1.0f}};
            const bool isDirection =
                spelling.words.back() == "jaw" || spelling.words.back() == "mouth";
            if (!spelling.sides.empty() && !isDirection) {
                const std::string key = spelling.key();
                _sums[key.substr(0, key.size() - spelling.sides.size())][s] = 1.0f;
            }
        }
        for (const auto& row : kRows)
            for (const std::string& name : split(row.names, ',')) _sums[name] = parse(row.sum);
        const std::map<std::string, Sum> known = _sums;
        for (const auto& [name, sum] : known)
            if (name.find(' ') == std::string::npos)
                for (const char* side : {"Left", "Right"}) addSide(name, sum, side);
    }

    static Sum parse(const std::string& text) {
        Sum sum;
        std::size_t last[2] = {};
        for (std::string word : split(text)) {
            const bool isBoth = word.back() == '*';
            if (isBoth) word.pop_back();
            if (word[0] == '.') {
                for (const std::size_t shape : last) sum[shape] = std::stof(word);
                continue;
            }
            for (int i = 0; i < 2; ++i) {
                const std::string name = isBoth ? word + (i == 0 ? "Left" : "Right") : word;
                last[i] =
                    std::size_t(std::find(kArKit.begin(), kArKit.end(), name) - kArKit.begin());
                sum[last[i]] = 1.0f;
            }
        }
        return sum;
    }

    /// "blink left" by "blink": the shapes of that side, and half of those in the middle.
    void addSide(const std::string& name, const Sum& sum, const std::string& side) {
        Sum part;
        for (const auto& [shape, weight] : sum)
            if (!endsWith(kArKit[shape], side == "Left" ? "Right" : "Left"))
                part[shape] = endsWith(kArKit[shape], side) ? weight : 0.5f * weight;
        _sums.emplace(name + (side == "Left" ? " left" : " right"), part);
    }

    std::map<std::string, Sum> _sums;
};

/// What a name means, however it is spelt.
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
            sum = Table::get().find(spelling.key(i));
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
