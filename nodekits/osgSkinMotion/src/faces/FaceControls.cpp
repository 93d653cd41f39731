// SPDX-License-Identifier: MIT
#include <osgSkinMotion/FaceControls>

#include <osgSkin/DeformableSkin>
#include <osgSkin/SetMorph>

#include <algorithm>
#include <cmath>

namespace osgSkin {

FaceControls::FaceControls(osg::Node& character, const std::vector<std::string>& names)
    : _matches(matchFace(names, morphNames(character))), _weights(names.size(), 0.0f) {
    for (DeformableSkin* skin : morphSkins(character)) {
        const MorphTargets& targets = *skin->getMorphTargets();
        Skin driven{skin, {}, 0};
        for (std::size_t n = 0; n < names.size(); ++n)
            for (const FaceMatch::Part& part : _matches[n].parts)
                for (const std::string& morph : part.morphs) {
                    const std::size_t target = targets.find(morph);
                    if (target == targets.targets().size()) continue;
                    driven.terms.push_back({target, n, part.weight});
                    driven.last = std::max(driven.last, target);
                    break;
                }
        if (!driven.terms.empty()) _skins.push_back(driven);
    }
}

FaceControls::~FaceControls() = default;

bool FaceControls::set(const std::vector<float>& weights) {
    if (weights.size() != _weights.size()) return false;
    for (std::size_t n = 0; n < weights.size(); ++n)
        if (std::isfinite(weights[n])) _weights[n] = std::clamp(weights[n], 0.0f, 1.0f);
    apply();
    return true;
}

bool FaceControls::set(const std::string& name, float weight) {
    if (!std::isfinite(weight)) return false;
    bool moves = false;
    for (std::size_t n = 0; n < _matches.size(); ++n) {
        if (_matches[n].name != name) continue;
        _weights[n] = std::clamp(weight, 0.0f, 1.0f);
        moves = moves || !_matches[n].parts.empty();
    }
    if (moves) apply();
    return moves;
}

void FaceControls::apply() {
    for (const Skin& driven : _skins) {
        DeformableSkin* const skin = driven.skin.get();
        if (!skin) continue;
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
