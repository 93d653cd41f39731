// SPDX-License-Identifier: MIT
// The README's example as a program, and a character from a single call, against an installed
// osgSkin: the skin must follow the motion.
#include <osgSkin/AutoPlayManager>
#include <osgSkin/DeformableSkin>
#include <osgSkinBind/AttachSkin>
#include <osgSkinBind/Bind>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinMotion/MakeAnimation>
#include <osgSkinRig/MakeSkeleton>
#include <osgSkinRig/Retarget>

#include <osg/MatrixTransform>
#include <osgUtil/UpdateVisitor>

#include <iostream>
#include <string>

namespace {

osg::Vec3 lastVertexAt(double time, osg::Node& scene, const osgSkin::DeformableSkin& skin) {
    osgUtil::UpdateVisitor visitor;
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(time);
    visitor.setFrameStamp(stamp);
    scene.accept(visitor);
    return static_cast<const osg::Vec3Array&>(*skin.getDeformedGeometry()->getVertexArray()).back();
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const std::string folder = argv[1];
#include "readme.inc"

    const osgSkin::Character character = osgSkin::loadCharacter(folder + "/thrower.skin");
    const osgSkin::DeformableSkin& loaded = *character.skin.skins.front().drawable;
    if (lastVertexAt(0.5, *character.root, loaded) == lastVertexAt(1.0, *character.root, loaded))
        return 1;

    for (unsigned int i = 0; i < skeleton->getNumChildren(); ++i)
        if (const auto* skin = dynamic_cast<osgSkin::DeformableSkin*>(skeleton->getChild(i))) {
            const osg::Vec3 moved =
                lastVertexAt(1.0, *scene, *skin) - lastVertexAt(0.5, *scene, *skin);
            std::cout << "A vertex of the skin moved by " << moved.length() << std::endl;
            return moved.length() > 0.01f ? 0 : 1;
        }
    return 1;
}
