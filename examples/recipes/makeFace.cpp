// SPDX-License-Identifier: MIT
#include <osgSkin/SetMorph>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>
#include <osgDB/ReadFile>

#include <cmath>
#include <iostream>
#include <stdexcept>

namespace {

/// Lets a smile come and go.
struct Smile : osg::NodeCallback {
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        const double time = nv->getFrameStamp()->getSimulationTime();
        osgSkin::setMorph(*node, "smile", float(0.5 - 0.5 * std::cos(2.0 * time)));
        traverse(node, nv);
    }
};

} // namespace

/// A face that smiles.
///
/// \param file any character with morph targets, such as a .glb.skin or a saved one
osg::ref_ptr<osg::Node> makeFace(const std::string& file) {
    osg::ref_ptr<osg::Node> character = osgDB::readRefNodeFile(file);
    if (!character) throw std::runtime_error(file + ": cannot be read");
    for (const std::string& name : osgSkin::morphNames(*character)) std::cout << name << '\n';
    osgSkin::setMorph(*character, "surprise", 0.3f); // stays until it is set again
    character->addUpdateCallback(new Smile);
    return character;
}
