// SPDX-License-Identifier: MIT
#include "ThrowScene.h"

#include <osgSkin/AutoPlayManager>
#include <osgSkinBind/AttachSkin>
#include <osgSkinBind/Bind>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinMotion/MakeAnimation>
#include <osgSkinMotion/Prop>
#include <osgSkinRig/Clip>
#include <osgSkinRig/MakeSkeleton>
#include <osgSkinRig/Motion>
#include <osgSkinRig/Retarget>

#include <osg/MatrixTransform>

osg::ref_ptr<osg::Group> makeThrowScene(const std::string& folder, ThrowFacts* facts) {
    // [readme] A body, a skeleton, and the skin that follows it.
    const osgSkin::ImportedMesh body = osgSkin::importMesh(folder + "/thrower.obj");
    const osgSkin::RestSkeleton rig = osgSkin::importSkeleton(folder + "/thrower.bvh");
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(rig);
    osgSkin::attachSkin(*skeleton, body.mesh, body.parts, osgSkin::bind(body.mesh, rig));

    // A motion for this skeleton. The manager plays it by itself, also when saved and read again.
    const osgSkin::Motion motion = osgSkin::importMotion(folder + "/throw.bvh");
    osgSkin::RetargetReport report;
    const osgSkin::Clip clip = osgSkin::retarget(motion, rig, {}, &report);
    const osg::ref_ptr<osgAnimation::Animation> animation = osgSkin::makeAnimation(clip, rig);
    const osg::ref_ptr<osgSkin::AutoPlayManager> manager = new osgSkin::AutoPlayManager;
    manager->registerAnimation(animation);

    // The files are in metres, have Y up and face +Z; OSG's world has Z up.
    const osg::ref_ptr<osg::MatrixTransform> upright =
        new osg::MatrixTransform(osg::Matrix::rotate(osg::PI_2, osg::Vec3(1, 0, 0)));
    upright->setDataVariance(osg::Object::DYNAMIC);
    upright->addChild(skeleton);
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->setUpdateCallback(manager);
    scene->addChild(upright); // a standing figure that throws towards +X
    // [readme]

    upright->addChild(osgSkin::makeProp("ball", osgSkin::importMesh(folder + "/ball.obj").parts,
                                        osgSkin::importMotion(folder + "/ball.bvh"), report,
                                        *animation));
    if (facts) {
        facts->frames = clip.frames;
        facts->frameTime = clip.frameTime;
        facts->feet = report.feetText();
    }
    return scene;
}
