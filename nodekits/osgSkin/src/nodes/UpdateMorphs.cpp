// SPDX-License-Identifier: MIT
#include <osgSkin/UpdateMorphs>

#include <osgSkin/DeformableSkin>
#include <osgSkin/SetMorph>

#include <osgAnimation/Channel>

#include <cmath>
#include <set>

namespace osgSkin {
namespace {

/// Collects the skins of a scene that have morph targets.
class MorphSkins : public osg::NodeVisitor {
public:
    MorphSkins() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {
        setNodeMaskOverride(~0u); // skins that are switched off may be switched on later
    }
    void apply(osg::Drawable& drawable) override {
        auto* skin = dynamic_cast<DeformableSkin*>(&drawable);
        if (skin && skin->getMorphTargets()) skins.push_back(skin);
    }

    std::vector<DeformableSkin*> skins;
};

} // namespace

std::vector<DeformableSkin*> morphSkins(const osg::Node& scene) {
    MorphSkins visitor;
    // Visitors take nodes that are not const; this one changes none.
    const_cast<osg::Node&>(scene).accept(visitor);
    return visitor.skins;
}

std::vector<std::string> morphNames(const osg::Node& scene) {
    std::vector<std::string> result;
    std::set<std::string> known;
    for (const DeformableSkin* skin : morphSkins(scene))
        for (const MorphTarget& target : skin->getMorphTargets()->targets())
            if (known.insert(target.name).second) result.push_back(target.name);
    return result;
}

bool setMorph(osg::Node& scene, const std::string& name, float weight) {
    bool any = false;
    for (DeformableSkin* skin : morphSkins(scene)) any = skin->setMorph(name, weight) || any;
    return any;
}

float getMorph(const osg::Node& scene, const std::string& name) {
    for (const DeformableSkin* skin : morphSkins(scene))
        if (skin->getMorphTargets()->find(name) < skin->getMorphWeights().size())
            return skin->getMorph(name);
    return 0.0f;
}

UpdateMorphs::UpdateMorphs(const std::string& name)
    : osgAnimation::AnimationUpdateCallback<osg::NodeCallback>(name) {}

UpdateMorphs::UpdateMorphs(const UpdateMorphs& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop),
      osgAnimation::AnimationUpdateCallback<osg::NodeCallback>(other, copyop) {}

bool UpdateMorphs::link(osgAnimation::Channel* channel) {
    osg::ref_ptr<Weight>& weight = _weights[channel->getName()];
    if (!weight) weight = new Weight;
    _isFound = false;
    return channel->setTarget(weight);
}

void UpdateMorphs::findSkins(osg::Node& node) {
    _driven.clear();
    for (DeformableSkin* skin : morphSkins(node))
        for (const auto& [name, weight] : _weights) {
            const std::size_t target = skin->getMorphTargets()->find(name);
            if (target < skin->getMorphWeights().size())
                _driven.push_back({skin, target, weight.get()});
        }
    _isFound = true;
}

void UpdateMorphs::operator()(osg::Node* node, osg::NodeVisitor* nv) {
    if (!_isFound) findSkins(*node);
    for (std::size_t i = 0; i < _driven.size();) {
        DeformableSkin* const skin = _driven[i].skin.get();
        if (skin) _next = skin->getMorphWeights();
        for (const DeformableSkin* const same = skin;
             i < _driven.size() && _driven[i].skin.get() == same; ++i) {
            if (_driven[i].weight->isDriven() && _driven[i].target < _next.size())
                _next[_driven[i].target] = _driven[i].weight->getValue();
        }
        if (skin) skin->setMorphWeights(_next);
    }
    traverse(node, nv);
}

} // namespace osgSkin
