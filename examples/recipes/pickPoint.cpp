// SPDX-License-Identifier: MIT
#include <osgSkin/SkinHit>
#include <osgSkinCharacter/LoadCharacter>

#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>

#include <iostream>

namespace {

/// Aims at a moving figure from the front, and keeps a mark at the point that the line hits.
struct Pick : osg::NodeCallback {
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        traverse(node, nv); // the figure is now posed for this frame
        const osg::Vec3d chest = node->getBound().center() + osg::Vec3(0, 0, 0.3f), away(0, 50, 0);
        const osg::ref_ptr line = new osgUtil::LineSegmentIntersector(chest - away, chest + away);
        osgUtil::IntersectionVisitor visitor(line);
        node->accept(visitor);
        const auto at = line->getFirstIntersection();
        mark->setMatrix(osg::Matrix::translate(at.getWorldIntersectPoint()));
        if (const auto hit = osgSkin::skinHit(at)) std::cout << hit->joint << '\n';
    }
    osg::ref_ptr<osg::MatrixTransform> mark = new osg::MatrixTransform;
};

} // namespace

/// A figure that walks, and a mark where a line hits it.
osg::ref_ptr<osg::Node> pickPoint(const std::string& file) {
    const osgSkin::Character character = osgSkin::loadCharacter(file);
    const osg::ref_ptr<Pick> pick = new Pick;
    pick->mark->addChild(new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(), 0.06f)));
    character.root->addUpdateCallback(pick);
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(character.root);
    scene->addChild(pick->mark);
    return scene;
}
