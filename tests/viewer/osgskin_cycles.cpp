// SPDX-License-Identifier: MIT
// Loads, plays, saves and releases a character in a loop: for sanitizers, which find leaks and uses
// after free, and for long runs, whose memory must not grow. No display needed.
#include "FindNodes.h"
#include "MemorySlope.h"

#include <osgSkin/DeformableSkin>

#include <osg/observer_ptr>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>
#include <osgUtil/CullVisitor>
#include <osgUtil/UpdateVisitor>

#include <cstdlib>
#include <iostream>
#include <string>

namespace {

/// One frame's update and cull, with everything in view.
void frame(osg::Node& scene, unsigned int number) {
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setFrameNumber(number);
    stamp->setSimulationTime(number / 60.0);
    osgUtil::UpdateVisitor update;
    update.setFrameStamp(stamp);
    update.setTraversalNumber(number);
    scene.accept(update);
    const osg::ref_ptr<osgUtil::CullVisitor> cull = new osgUtil::CullVisitor;
    cull->setFrameStamp(stamp);
    cull->setTraversalNumber(number);
    cull->setStateGraph(new osgUtil::StateGraph);
    const osg::ref_ptr<osgUtil::RenderStage> stage = new osgUtil::RenderStage;
    cull->setRenderStage(stage);
    const osg::BoundingSphere all = scene.getBound();
    cull->pushViewport(new osg::Viewport(0, 0, 100, 100));
    cull->pushProjectionMatrix(
        new osg::RefMatrix(osg::Matrix::perspective(60, 1, 0.01, 100.0 * all.radius())));
    cull->pushModelViewMatrix(
        new osg::RefMatrix(osg::Matrix::lookAt(all.center() - osg::Vec3d(0, 4.0 * all.radius(), 0),
                                               all.center(), {0, 0, 1})),
        osg::Transform::ABSOLUTE_RF);
    scene.accept(*cull);
}

unsigned int posesOf(osg::Node& node) {
    unsigned int poses = 0;
    for (const auto& skin : test::findNodes<osgSkin::DeformableSkin>(node))
        poses += skin.node->getDeformCount();
    return poses;
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 5 && argc != 6) {
        std::cerr << "usage: osgskin_cycles CHARACTER SAVED.osgb FRAMES CYCLES [MOST_KB_A_CYCLE]"
                  << std::endl;
        return 2;
    }
    const auto frames = static_cast<unsigned int>(std::atoi(argv[3]));
    const auto cycles = static_cast<unsigned int>(std::atoi(argv[4]));
    std::string file = argv[1];
    test::MemorySlope memory;
    for (unsigned int cycle = 0; cycle < cycles; ++cycle) {
        osg::ref_ptr<osg::Node> character = osgDB::readRefNodeFile(file);
        if (!character) return 1;
        for (unsigned int i = 1; i <= frames; ++i) frame(*character, i);
        if (posesOf(*character) != frames) {
            std::cerr << "cycle " << cycle << ": " << posesOf(*character) << " poses in " << frames
                      << " frames" << std::endl;
            return 1;
        }
        if (!osgDB::writeNodeFile(*character, argv[2])) return 1;
        const osg::observer_ptr<osg::Node> seen = character;
        character = nullptr;
        if (seen.valid()) {
            std::cerr << "cycle " << cycle << ": the character was not freed" << std::endl;
            return 1;
        }
        // Both sources alternately: its files, and the saved scene.
        file = file == argv[1] ? argv[2] : argv[1];
        memory.sample();
    }
    std::cout << cycles << " times loaded, " << frames << " frames, saved and let go; "
              << memory.last() / 1024.0 << " MB in the end, " << memory.slope() << " kB a cycle"
              << std::endl;
    return argc == 6 && memory.slope() > std::atof(argv[5]) ? 1 : 0;
}
