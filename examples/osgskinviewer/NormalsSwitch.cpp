// SPDX-License-Identifier: MIT
#include "NormalsSwitch.h"

#include <osg/Array>

namespace viewer {
namespace {

std::vector<glm::vec3> asVectors(const osg::Array& array) {
    std::vector<glm::vec3> result;
    for (const osg::Vec3& v : static_cast<const osg::Vec3Array&>(array))
        result.emplace_back(v.x(), v.y(), v.z());
    return result;
}

} // namespace

NormalsSwitch::NormalsSwitch(const osgSkin::Character& character) {
    if (character.binding.gradients.empty()) return;
    osgSkin::Binding turned = character.binding;
    turned.gradients.clear();
    turned.correctives.normalShares.clear();
    for (osgSkin::CorrectiveJoint& joint : turned.correctives.joints) joint.normalScales.clear();
    for (const osgSkin::SkinParts::Skin& skin : character.skin.skins) {
        osg::Geometry* rest = skin.part.geometry;
        if (!rest) continue;
        _skins.push_back({skin.drawable, rest, skin.drawable->getModel(),
                          osgSkin::SkinModel::create(turned, asVectors(*rest->getVertexArray()),
                                                     asVectors(*rest->getNormalArray()),
                                                     skin.part.sourceVertex)});
    }
}

void NormalsSwitch::showTurned(bool turned) {
    for (const Skin& skin : _skins)
        skin.drawable->setSkin(skin.rest, turned ? skin.turned : skin.surface);
}

} // namespace viewer
