// SPDX-License-Identifier: MIT
#include <osgSkin/CharacterGroup>
#include <osgSkinMotion/MakeWalker>

#include <osg/FrameStamp>
#include <osg/MatrixTransform>
#include <osg/NodeCallback>

namespace {

/// Moves the pedestrians' transforms, and nothing else: outwards and round, each at its own speed.
struct MovePedestrians : osg::NodeCallback {
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        const double time = nv->getFrameStamp()->getSimulationTime();
        for (unsigned int i = 0; i < node->asGroup()->getNumChildren(); ++i) {
            const double radius = 1.5 + 0.4 * i, speed = 0.6 + 0.2 * (i % 8);
            const double angle = 2.4 * i + time * speed / radius;
            static_cast<osg::MatrixTransform*>(node->asGroup()->getChild(i))
                ->setMatrix(osg::Matrix::rotate(angle + osg::PI_2, osg::Vec3d(0, 0, 1)) *
                            osg::Matrix::translate(radius * cos(angle), radius * sin(angle), 0));
        }
        traverse(node, nv);
    }
};

} // namespace

/// Pedestrians of one character, loaded or saved, which has a clip that walks.
osg::ref_ptr<osg::Node> makePedestrians(osg::Node& of) {
    const osg::ref_ptr<osgSkin::Walker> walker = osgSkin::makeWalker(of);
    const osg::ref_ptr<osgSkin::CharacterGroup> street = new osgSkin::CharacterGroup;
    for (int i = 0; i < 20; ++i) {
        const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
        place->addChild(osg::clone(walker.get(), osg::CopyOp()));
        street->addChild(place);
    }
    street->addUpdateCallback(new MovePedestrians);
    return street;
}
