// SPDX-License-Identifier: MIT
// play FILE...: reads characters by osgDB, plays them to .5 seconds, and prints the vertices of
// their skins exactly. The same source is built against static and shared osgSkin.
#include <osgSkin/DeformableSkin>
#include <osgSkin/StaticPlugins>

#include <osg/NodeVisitor>
#include <osgDB/ReadFile>
#include <osgUtil/UpdateVisitor>

#include <cstdio>

USE_OSGSKIN()

namespace {

class PrintSkins : public osg::NodeVisitor {
public:
    PrintSkins() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Drawable& drawable) override {
        const auto* skin = dynamic_cast<osgSkin::DeformableSkin*>(&drawable);
        if (skin == nullptr) return;
        const osg::Array& vertices = *skin->getDeformedGeometry()->getVertexArray();
        for (const osg::Vec3& v : static_cast<const osg::Vec3Array&>(vertices))
            std::printf("%a %a %a\n", double(v.x()), double(v.y()), double(v.z()));
        ++skins;
    }
    int skins = 0;
};

} // namespace

int main(int argc, char** argv) {
    for (int i = 1; i < argc; ++i) {
        const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(argv[i]);
        if (!scene) return 1;
        osgUtil::UpdateVisitor update;
        const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        update.setFrameStamp(stamp);
        for (const double seconds : {0.0, 0.5}) {
            stamp->setSimulationTime(seconds);
            scene->accept(update);
        }
        PrintSkins skins;
        scene->accept(skins);
        if (skins.skins == 0) return 1;
    }
    return 0;
}
