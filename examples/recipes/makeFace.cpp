// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/FaceControls>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>

#include <cmath>
#include <iostream>
#include <stdexcept>

namespace {

/// Moves a face by ARKit's names, as a camera would, whatever the character calls its own targets.
struct Live : osg::NodeCallback {
    explicit Live(osg::Node& character) : face(character) {}
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        traverse(node, nv); // before: a clip may move the face, too
        const double time = nv->getFrameStamp()->getSimulationTime();
        const auto smile = float(0.5 - 0.5 * std::cos(2.0 * time));
        face.set("mouthSmileLeft", smile);
        face.set("mouthSmileRight", smile);
    }
    osgSkin::FaceControls face;
};

} // namespace

/// A face that smiles, a little surprised.
osg::ref_ptr<osg::Node> makeFace(const std::string& file) {
    osgSkin::Character character = osgSkin::loadCharacter(file);
    if (character.morphs().empty()) throw std::runtime_error(file + ": has no morph targets");
    for (const std::string& name : character.morphs()) std::cout << name << '\n';
    character.setMorph("surprise", 0.3f); // stays until it is set again
    const osg::ref_ptr<Live> live = new Live(*character.root);
    if (!live->face.set("mouthSmileLeft", 0.0f)) std::cout << "it cannot smile\n";
    character.root->addUpdateCallback(live);
    return character.root;
}
