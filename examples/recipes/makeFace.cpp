// SPDX-License-Identifier: MIT
#include <osgSkin/SetMorph>
#include <osgSkinCharacter/LoadCharacter>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <stdexcept>

namespace {

/// Lets an expression come and go.
struct Express : osg::NodeCallback {
    explicit Express(const std::string& morph) : name(morph) {}
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        const double time = nv->getFrameStamp()->getSimulationTime();
        osgSkin::setMorph(*node, name, float(0.5 - 0.5 * std::cos(2.0 * time)));
        traverse(node, nv);
    }
    std::string name;
};

} // namespace

/// A face that smiles, or else shows its first expression.
osg::ref_ptr<osg::Node> makeFace(const std::string& file) {
    osgSkin::Character character = osgSkin::loadCharacter(file);
    const std::vector<std::string> names = character.morphs();
    if (names.empty()) throw std::runtime_error(file + ": has no morph targets");
    for (const std::string& name : names) std::cout << name << '\n';
    character.setMorph("surprise", 0.3f); // stays until it is set again
    const bool smiles = std::find(names.begin(), names.end(), "smile") != names.end();
    character.root->addUpdateCallback(new Express(smiles ? "smile" : names.front()));
    return character.root;
}
