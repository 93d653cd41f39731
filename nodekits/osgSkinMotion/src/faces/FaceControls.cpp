// SPDX-License-Identifier: MIT
#include <osgSkinMotion/FaceControls>

#include <osgSkin/DeformableSkin>
#include <osgSkin/SetMorph>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

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

FaceControls::FaceControls(const FaceControls& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), Attachment(other, copyop),
      _names(other._names), _given(other._given), _matches(other._matches),
      _weights(other._weights) {}

FaceControls::~FaceControls() = default;

osg::ref_ptr<FaceControls> FaceControls::create(osg::Node& root,
                                                const std::vector<std::string>& names) {
    const osg::ref_ptr<FaceControls> result = new FaceControls;
    result->_names = names;
    result->_given = names.size();
    result->_weights.assign(names.size(), std::numeric_limits<float>::quiet_NaN());
    result->findSkins(root);
    return result;
}

void FaceControls::findSkins(osg::Node& root) {
    if (_root == &root) return;
    _root = &root;
    _morphs = morphNames(root);
    _matches.clear();
    _skins.clear();
    for (DeformableSkin* skin : morphSkins(root)) _skins.push_back({skin, {}, 0});
    match(0);
}

/// Finds what the names from `first` on move.
void FaceControls::match(std::size_t first) {
    const std::vector<std::string> names(_names.begin() + std::ptrdiff_t(first), _names.end());
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
    }
}

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
        return std::size_t(std::find_if(_names.begin(), _names.end(), isThis) - _names.begin());
    };
    std::size_t n = find([&](const std::string& known) { return known == name; });
    if (n == _names.size()) n = find([&](const std::string& known) { return isSame(known, name); });
    if (n == _names.size()) {
        if (n >= kMaxNames) return false;
        _names.push_back(name);
        _weights.push_back(std::numeric_limits<float>::quiet_NaN());
        if (_root.valid()) match(n);
    }
    _weights[n] = std::clamp(weight, 0.0f, 1.0f);
    if (n >= _matches.size()) return true; // read from a file, before its first update
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
        const auto forEach = [&](const auto& change) {
            for (const Term& term : driven.terms)
                if (!std::isnan(_weights[term.name])) change(_next[term.target], term);
        };
        forEach([](float& weight, const Term&) { weight = 0.0f; });
        forEach(
            [&](float& weight, const Term& term) { weight += term.weight * _weights[term.name]; });
        forEach([](float& weight, const Term&) { weight = std::min(weight, 1.0f); });
        skin->setMorphWeights(_next);
    }
}

void FaceControls::operator()(osg::Node* node, osg::NodeVisitor* nv) {
    traverse(node, nv); // clips move the face before
    if (!node) return;
    findSkins(*node);
    apply();
}

} // namespace osgSkin
