// SPDX-License-Identifier: MIT
#include <osgSkin/SkinHit>
#include <osgSkinCharacter/LoadCharacter>

#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>

#include <iostream>

namespace {

/// Aims along a line at a moving figure, and keeps a mark at the point that it hits.
struct Pick : osg::NodeCallback {
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        traverse(node, nv); // the figure is now posed for this frame
        const osg::Vec3d from(-0.1, -5, 1.25), to(-0.1, 5, 1.25);
        const osg::ref_ptr line = new osgUtil::LineSegmentIntersector(from, to);
        osgUtil::IntersectionVisitor visitor(line);
        node->accept(visitor);
        const auto at = line->getFirstIntersection();
        mark->setMatrix(osg::Matrix::translate(at.getWorldIntersectPoint()));
        if (const auto hit = osgSkin::skinHit(at))
            std::cout << hit->joint << ", at rest " << hit->rest.y() << " m above the floor\n";
    }
    osg::ref_ptr<osg::MatrixTransform> mark = new osg::MatrixTransform;
};

} // namespace

/// A figure that walks, and a mark where a line hits it.
osg::ref_ptr<osg::Node> pickPoint(const std::string& file) {
    const osgSkin::Character character = osgSkin::loadCharacter(file);
    const osg::ref_ptr<Pick> pick = new Pick;
    pick->mark->addChild(new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(), 0.06f)));
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    character.root->addUpdateCallback(pick);
    scene->addChild(character.root);
    scene->addChild(pick->mark);
    return scene;
}
