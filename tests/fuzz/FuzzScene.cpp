// SPDX-License-Identifier: MIT
// Any bytes as a saved scene, played after its rigs became skins, as a viewer would. Errors are
// osgSkin::Error; anything else that is thrown ends the run.
#include "Attempt.h"
#include "FuzzFormat.h"
#include "InputFile.h"

#include <osgSkinBind/ConvertRigs>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ReadScene>

#include <osg/FrameStamp>
#include <osg/Notify>
#include <osg/TriangleIndexFunctor>
#include <osgUtil/UpdateVisitor>

#include <algorithm>

namespace {

struct Corners {
    unsigned last = 0;
    void operator()(unsigned a, unsigned b, unsigned c) { last = std::max({last, a, b, c}); }
};

/// Asks for what drawing asks for, without a graphics card.
class Draw : public osg::NodeVisitor {
public:
    Draw() : NodeVisitor(TRAVERSE_ACTIVE_CHILDREN) {}
    void apply(osg::Drawable& drawable) override {
        drawable.getBoundingBox();
        osg::TriangleIndexFunctor<Corners> corners;
        drawable.accept(corners);
    }
};

void play(osg::Node& scene) {
    osgUtil::UpdateVisitor update;
    const osg::ref_ptr<osg::FrameStamp> frame = new osg::FrameStamp;
    update.setFrameStamp(frame);
    for (const double time : {0.0, 0.4, 7.0}) {
        frame->setFrameNumber(frame->getFrameNumber() + 1);
        frame->setReferenceTime(time);
        frame->setSimulationTime(time);
        update.setTraversalNumber(frame->getFrameNumber());
        scene.accept(update);
        scene.getBound();
        Draw draw;
        scene.accept(draw);
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    osg::setNotifyLevel(osg::ALWAYS);
    const std::string path = fuzz::save(std::string("input.") + fuzzExtension(), data, size);
    fuzz::attempt([&] { osgSkin::importMesh(path); });
    fuzz::attempt([&] {
        const osg::ref_ptr<osg::Node> scene = osgSkin::readScene(path, nullptr);
        play(*scene);
        fuzz::attempt([&] { osgSkin::convertRigs(*scene); });
        play(*scene);
    });
    return 0;
}
