// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/HitBoxes>

#include "Bodies.h"

/// A figure that a physics engine moves: it falls on what is in the engine's world.
osg::ref_ptr<osg::Node> fallDown(const std::string& file, const std::shared_ptr<Bodies>& bodies) {
    struct Fall : osg::NodeCallback {
        void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
            traverse(node, nv); // bones are in the clip's pose
            bodies->stepTo(nv->getFrameStamp()->getSimulationTime());
            std::vector<osg::Matrixd> pose;
            for (std::size_t i = 0; i < hits->limbs().size(); ++i)
                pose.push_back(osg::Matrixd::inverse(hits->limbs()[i].shapes[0].frame) *
                               bodies->place(i));
            hits->takePose(pose);
        }
        osg::ref_ptr<osgSkin::HitBoxes> hits;
        std::shared_ptr<Bodies> bodies;
    };
    osgSkin::Character figure = osgSkin::loadCharacter(file);
    osgSkin::HitBoxes::Options simple;
    simple.maxShapes = 1;    // of a limb
    simple.smallest = 0.004; // no fingers
    const osg::ref_ptr<Fall> fall = new Fall;
    fall->hits = osgSkin::attach<osgSkin::HitBoxes>(*figure.root, simple);
    fall->bodies = bodies;
    for (const osgSkin::HitBoxes::Limb& limb : fall->hits->limbs()) {
        const auto& shape = limb.shapes[0];
        const btVector3 half(float(shape.half.x()), float(shape.half.y()), float(shape.half.z()));
        const bool isBox = shape.kind == osgSkin::HitBoxes::Shape::Kind::Box;
        bodies->add(isBox ? std::shared_ptr<btConvexShape>(new btBoxShape(half))
                          : std::make_shared<btCapsuleShapeZ>(half.x(), 2 * half.z()),
                    1000 * shape.volume(), limb, fall->hits->motion(bodies->count()));
    }
    figure.bone(fall->hits->limbs()[0].joint)->addUpdateCallback(fall);
    return figure.root;
}
