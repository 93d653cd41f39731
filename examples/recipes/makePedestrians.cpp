// SPDX-License-Identifier: MIT
#include <osgSkin/CharacterGroup>
#include <osgSkinMotion/MakeWalker>

#include <osg/FrameStamp>
#include <osg/MatrixTransform>

/// Pedestrians of one character, loaded or saved, which has a clip that walks.
osg::ref_ptr<osg::Node> makePedestrians(osg::Node& of) {
    /// Moves their transforms, and nothing else: outwards and round, each at its own speed.
    struct Move : osg::NodeCallback {
        void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
            const double time = nv->getFrameStamp()->getSimulationTime();
            for (unsigned int i = 0; i < node->asGroup()->getNumChildren(); ++i) {
                const double radius = size * (1.3 + 0.35 * i), way = time * (0.5 + 0.15 * (i % 8));
                const double angle = 2.4 * i + way * speed / radius;
                static_cast<osg::MatrixTransform*>(node->asGroup()->getChild(i))
                    ->setMatrix(
                        osg::Matrix::rotate(angle + osg::PI_2, osg::Vec3d(0, 0, 1)) *
                        osg::Matrix::translate(radius * cos(angle), radius * sin(angle), 0));
            }
            traverse(node, nv);
        }
        double size = 1.0, speed = 1.0; ///< of a pedestrian
    };
    osgSkin::WalkerReport report;
    const osg::ref_ptr<osgSkin::Walker> walker = osgSkin::makeWalker(of, {}, &report);
    const osg::ref_ptr<osgSkin::CharacterGroup> street = new osgSkin::CharacterGroup;
    for (int i = 0; i < 20; ++i) {
        const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
        place->addChild(osg::clone(walker.get(), osg::CopyOp()));
        street->addChild(place);
    }
    const osg::ref_ptr<Move> move = new Move;
    move->size = double(of.getBound().radius());
    move->speed = report.walkSpeed;
    street->addUpdateCallback(move);
    return street;
}
