// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/SpringBones>
#include <osgSkinRig/ReadSkeleton>

#include <osg/ShapeDrawable>
#include <osgUtil/LineSegmentIntersector>

/// A figure with a pony tail that swings: bones below the head, and springs for them.
osg::ref_ptr<osg::Node> swingHair(const std::string& file) {
    osgSkin::Character character = osgSkin::loadCharacter(file);
    osg::ref_ptr<osgAnimation::Bone> above = character.boneByRole("Head");
    const osg::Matrixd toRest = osg::Matrixd::inverse(character.toWorld);
    const osg::Matrixd posed = toRest * above->getInvBindMatrixInSkeletonSpace() *
                               above->getMatrixInSkeletonSpace() * character.toWorld;
    osg::Vec3d joint = character.restPosition("Head"); // Z up
    const double size = joint.z() / 1.6;
    const osg::Vec3d step = osg::Vec3d(0, 0.05, -0.02) * size, back(0, size, size);
    const osg::ref_ptr line =
        new osgUtil::LineSegmentIntersector(joint * posed, (joint + back) * posed);
    character.root->accept(*osg::ref_ptr(new osgUtil::IntersectionVisitor(line)));
    for (const auto& hit : line->getIntersections()) // the last one: where the head ends
        joint = hit.getWorldIntersectPoint() * osg::Matrixd::inverse(posed);
    for (const char* name : {"hair1", "hair2", "hair3", "hair4", "hair5", "hair6", "hair7"}) {
        const osg::Matrixd place = osg::Matrixd::translate(joint) * toRest;
        const osg::ref_ptr bone = new osgAnimation::Bone(name);
        bone->setMatrix(place * osg::Matrixd(above->getInvBindMatrixInSkeletonSpace()));
        bone->setInvBindMatrixInSkeletonSpace(osg::Matrixd::inverse(place));
        bone->addChild(new osg::ShapeDrawable(new osg::Sphere(step / 2, 0.045f * float(size))));
        above->insertChild(0, bone); // osgAnimation wants bones before other children
        above = bone;
        joint += step;
    }
    osgSkin::SpringSettings::Joint hair{{}, {}, 0.25 * size};
    (character.isZUp() ? hair.gravity.z : hair.gravity.y) = -0.5 * size;
    const osgSkin::RestSkeleton rest = osgSkin::readSkeleton(*character.skeleton);
    const osgSkin::SpringSettings springs{{osgSkin::springsBelow(rest, {"hair1"}, hair)}, {}};
    osgSkin::attach<osgSkin::SpringBones>(*character.root, springs);
    return character.root;
}
