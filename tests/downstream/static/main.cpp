// SPDX-License-Identifier: MIT
// play FILE...: reads characters by osgDB, carries them along while half a second passes, and
// prints the vertices of their skins and a picture of them exactly. The same source is built
// against static and shared osgSkin. Needs a display.
#include <osgSkin/DeformableSkin>
#include <osgSkin/StaticPlugins>

#include <osg/Image>
#include <osg/MatrixTransform>
#include <osg/NodeVisitor>
#include <osgDB/ReadFile>
#include <osgViewer/Viewer>

#include <cstdio>
#include <set>

USE_OSGSKIN()

namespace {

constexpr int kSize = 256; ///< of the picture

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

/// Prints a picture's pixels, and returns how many colours it has.
std::size_t print(const osg::Image& picture) {
    std::set<unsigned int> colours;
    for (int y = 0; y < picture.t(); ++y, std::printf("\n"))
        for (int x = 0; x < picture.s(); ++x) {
            const unsigned char* const pixel = picture.data(unsigned(x), unsigned(y));
            const unsigned int colour = pixel[0] << 16U | pixel[1] << 8U | pixel[2];
            std::printf("%06x", colour);
            colours.insert(colour);
        }
    return colours.size();
}

bool play(const char* file) {
    const osg::ref_ptr<osg::Node> character = osgDB::readRefNodeFile(file);
    if (!character) return false;
    const osg::ref_ptr<osg::MatrixTransform> scene = new osg::MatrixTransform;
    scene->addChild(character);
    const osg::ref_ptr<osg::Image> picture = new osg::Image;
    osgViewer::Viewer viewer;
    viewer.setThreadingModel(osgViewer::Viewer::SingleThreaded);
    viewer.setUpViewInWindow(0, 0, kSize, kSize);
    viewer.setSceneData(scene);
    const osg::BoundingSphere bound = character->getBound();
    const osg::Vec3 middle = bound.center() + osg::Vec3(0.4f * bound.radius(), 0, 0); // of the way
    viewer.getCamera()->setViewMatrixAsLookAt(
        middle + osg::Vec3(4.0f, -4.0f, 1.5f) * bound.radius(), middle, osg::Vec3(0, 0, 1));
    viewer.getCamera()->attach(osg::Camera::COLOR_BUFFER, picture);
    viewer.realize();
    for (int frame = 0; frame <= 25; ++frame) { // at 1.5 times its height a second
        scene->setMatrix(
            osg::Matrix::translate(osg::Vec3(0.03f * float(frame) * bound.radius(), 0, 0)));
        viewer.frame(0.02 * frame);
    }
    PrintSkins skins;
    scene->accept(skins);
    const bool isDrawn = picture->s() == kSize && print(*picture) > 50;
    if (!isDrawn) std::fprintf(stderr, "%s: nothing is drawn\n", file);
    return isDrawn && skins.skins > 0;
}

} // namespace

int main(int argc, char** argv) {
    for (int i = 1; i < argc; ++i)
        if (!play(argv[i])) return 1;
    return 0;
}
