// SPDX-License-Identifier: MIT
#include <osgSkin/SkinHit>
#include <osgSkinCharacter/LoadCharacter>

#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>

#include <iostream>

/// A figure that walks, and a mark where a line hits it.
osg::ref_ptr<osg::Node> pickPoint(const std::string& file) {
    /// Aims at a moving figure from the front, and keeps a mark at the point that the line hits.
    struct Pick : osg::NodeCallback {
        void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
            traverse(node, nv); // the figure is now posed for this frame
            const osg::Vec3d at = spine->getWorldMatrices().front().getTrans();
            const osg::ref_ptr line = new osgUtil::LineSegmentIntersector(at - away, at + away);
            osgUtil::IntersectionVisitor visitor(line);
            node->accept(visitor);
            if (!line->containsIntersections()) return;
            const auto first = line->getFirstIntersection();
            mark->setMatrix(osg::Matrix::translate(first.getWorldIntersectPoint()));
            if (const auto hit = osgSkin::skinHit(first)) std::cout << hit->joint << '\n';
        }
        osg::ref_ptr<osgAnimation::Bone> spine;
        osg::Vec3d away;
        osg::ref_ptr<osg::MatrixTransform> mark = new osg::MatrixTransform;
    };
    osgSkin::Character character = osgSkin::loadCharacter(file);
    const float size = character.root->getBound().radius();
    const osg::ref_ptr<Pick> pick = new Pick;
    pick->spine = character.boneByRole("Spine");
    pick->away = osg::Vec3d(0, 5 * size, 0);
    pick->mark->addChild(new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(), 0.04f * size)));
    character.root->addUpdateCallback(pick);
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(character.root);
    scene->addChild(pick->mark);
    return scene;
}
