// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/FaceControls>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>

#include <cmath>
#include <iostream>
#include <stdexcept>

namespace {

/// Smiles by ARKit's names, as a camera would, whatever the character calls its own targets.
struct Smile : osg::NodeCallback {
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        const double time = nv->getFrameStamp()->getSimulationTime();
        const auto weight = float(0.5 - 0.5 * std::cos(2.0 * time));
        face->set("mouthSmileLeft", weight);
        face->set("mouthSmileRight", weight);
        traverse(node, nv);
    }
    osg::ref_ptr<osgSkin::FaceControls> face;
};

} // namespace

/// A face that smiles, a little surprised.
osg::ref_ptr<osg::Node> makeFace(const std::string& file) {
    osgSkin::Character character = osgSkin::loadCharacter(file);
    if (character.morphs().empty()) throw std::runtime_error(file + ": has no morph targets");
    for (const std::string& name : character.morphs()) std::cout << name << '\n';
    character.setMorph("surprise", 0.3f); // stays until it is set again
    const osg::ref_ptr<Smile> smile = new Smile;
    smile->face = osgSkin::attach<osgSkin::FaceControls>(*character.root);
    if (!smile->face->set("mouthSmileLeft", 0.0f)) std::cout << "it cannot smile\n";
    character.root->addUpdateCallback(smile);
    return character.root;
}
