// SPDX-License-Identifier: MIT
#include <osgSkinMotion/FaceControls>

#include <osgSkin/DeformableSkin>
#include <osgSkin/SetMorph>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace osgSkin {

namespace {

/// A stream's names, at most: an unknown program may send others without end.
constexpr std::size_t kMaxNames = 1024;

bool isSame(const std::string& a, const std::string& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
        return std::tolower(x) == std::tolower(y);
    });
}

} // namespace

FaceControls::FaceControls(osg::Node& character, const std::vector<std::string>& names)
    : _morphs(morphNames(character)), _given(names.size()) {
    for (DeformableSkin* skin : morphSkins(character)) _skins.push_back({skin, {}, 0});
    add(names);
}

void FaceControls::add(const std::vector<std::string>& names) {
    for (const FaceMatch& match : matchFace(names, _morphs)) {
        for (Skin& driven : _skins) {
            if (!driven.skin) continue;
            const MorphTargets& targets = *driven.skin->getMorphTargets();
            for (const FaceMatch::Part& part : match.parts)
                for (const std::string& morph : part.morphs) {
                    const std::size_t target = targets.find(morph);
                    if (target == targets.targets().size()) continue;
                    driven.terms.push_back({target, _matches.size(), part.weight});
                    driven.last = std::max(driven.last, target);
                    break;
                }
        }
        _matches.push_back(match);
        _weights.push_back(0.0f);
    }
}

FaceControls::~FaceControls() = default;

bool FaceControls::set(const std::vector<float>& weights) {
    if (weights.size() != _given) return false;
    for (std::size_t n = 0; n < weights.size(); ++n)
        if (std::isfinite(weights[n])) _weights[n] = std::clamp(weights[n], 0.0f, 1.0f);
    apply();
    return true;
}

bool FaceControls::set(const std::string& name, float weight) {
    if (!std::isfinite(weight)) return false;
    const auto find = [&](const auto& isThis) {
        return std::size_t(std::find_if(_matches.begin(), _matches.end(),
                                        [&](const FaceMatch& m) { return isThis(m.name); }) -
                           _matches.begin());
    };
    std::size_t n = find([&](const std::string& known) { return known == name; });
    if (n == _matches.size())
        n = find([&](const std::string& known) { return isSame(known, name); });
    if (n == _matches.size()) {
        if (n >= kMaxNames) return false;
        add({name});
    }
    _weights[n] = std::clamp(weight, 0.0f, 1.0f);
    if (_matches[n].parts.empty()) return false;
    apply();
    return true;
}

void FaceControls::apply() {
    for (const Skin& driven : _skins) {
        DeformableSkin* const skin = driven.skin.get();
        if (!skin || driven.terms.empty()) continue;
        _next = skin->getMorphWeights();
        if (_next.size() <= driven.last) continue; // it has other targets now
        for (const Term& term : driven.terms) _next[term.target] = 0.0f;
        for (const Term& term : driven.terms)
            _next[term.target] += term.weight * _weights[term.name];
        for (const Term& term : driven.terms)
            _next[term.target] = std::min(_next[term.target], 1.0f);
        skin->setMorphWeights(_next);
    }
}

} // namespace osgSkin
