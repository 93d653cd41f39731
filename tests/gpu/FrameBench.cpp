// SPDX-License-Identifier: MIT
#include "FrameBench.h"

#include "EglWindow.h"
#include "FindNodes.h"
#include "SomeMorphs.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/MorphTargets>
#include <osgSkin/SkinModel>
#include <osgSkinGpu/GpuCrowd>
#include <osgSkinGpu/GpuSkin>

#include <osg/GLExtensions>
#include <osg/MatrixTransform>
#include <osg/Texture2D>
#include <osgDB/ReadFile>
#include <osgUtil/GLObjectsVisitor>
#include <osgViewer/Viewer>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <stdexcept>

namespace {

constexpr int kWidth = 1920, kHeight = 1080;

struct Finish : osg::Camera::DrawCallback {
    void operator()(osg::RenderInfo&) const override { glFinish(); }
};

/// The place of one of many characters, in rows around the origin.
osg::Vec3d placeOf(std::size_t i, std::size_t count, double spacing) {
    const double side = std::ceil(std::sqrt(double(count)));
    return osg::Vec3d(std::fmod(double(i), side) - 0.5 * side,
                      std::floor(double(i) / side) - 0.5 * side, 0.0) *
           spacing;
}

double spacingOf(const osg::BoundingSphere& member) {
    return 0.7 * double(member.radius());
}

/// A viewer without a display that shows a scene of some extent.
class Stage {
public:
    Stage(osg::Node& scene, double extent) {
        viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
        if (!_window->valid()) throw std::runtime_error("EGL gives no context");
        osg::Camera& camera = *viewer.getCamera();
        camera.setGraphicsContext(_window);
        camera.setViewport(0, 0, kWidth, kHeight);
        camera.setDrawBuffer(GL_BACK);
        camera.setReadBuffer(GL_BACK);
        camera.setProjectionMatrixAsPerspective(30.0, double(kWidth) / kHeight, 0.1, 1e5);
        camera.setFinalDrawCallback(new Finish);
        viewer.setSceneData(&scene);
        viewer.realize();
        camera.setViewMatrixAsLookAt({0.15 * extent, -1.5 * extent - 4.0, 0.45 * extent + 1.5},
                                     {0.0, -0.15 * extent, 0.5}, {0.0, 0.0, 1.0});
    }
    ~Stage() {
        if (_window->makeCurrent()) viewer.getSceneData()->releaseGLObjects(_window->getState());
        _window->releaseContext();
    }

    /// Milliseconds of a frame, by the clock, until the card has finished.
    double draw(double seconds, const std::function<void(double)>& update = {}) {
        const auto start = std::chrono::steady_clock::now();
        if (update) update(seconds);
        viewer.frame(seconds);
        const std::chrono::duration<double, std::milli> took =
            std::chrono::steady_clock::now() - start;
        return took.count();
    }

    void compile(osg::Node& scene) {
        if (!_window->makeCurrent()) throw std::runtime_error("EGL gives no context");
        osg::RenderInfo info(_window->getState(), &viewer);
        osgUtil::GLObjectsVisitor visitor;
        visitor.setRenderInfo(info);
        scene.accept(visitor);
        glFinish();
        _window->releaseContext();
    }

    osgViewer::Viewer viewer;

private:
    const osg::ref_ptr<test::EglWindow> _window = new test::EglWindow(kWidth, kHeight);
};

double median(std::vector<double> times) {
    std::nth_element(times.begin(), times.begin() + std::ptrdiff_t(times.size() / 2), times.end());
    return times[times.size() / 2];
}

/// A scene that other cameras with the same view draw first, as shadow maps do.
osg::ref_ptr<osg::Group> inPasses(osg::Node& scene, int passes) {
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    for (int i = 1; i < passes; ++i) {
        const osg::ref_ptr<osg::Texture2D> depth = new osg::Texture2D;
        depth->setTextureSize(1024, 1024);
        depth->setInternalFormat(GL_DEPTH_COMPONENT);
        const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setReferenceFrame(osg::Transform::RELATIVE_RF);
        camera->setViewport(0, 0, 1024, 1024);
        camera->setClearMask(GL_DEPTH_BUFFER_BIT);
        camera->setRenderOrder(osg::Camera::PRE_RENDER);
        camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
        camera->attach(osg::Camera::DEPTH_BUFFER, depth);
        camera->addChild(&scene);
        root->addChild(camera);
    }
    root->addChild(&scene);
    return root;
}

/// The median of 30 frames, or of as many as five seconds allow.
double timeFrames(osg::Node& scene, double extent, const std::function<void(double)>& update) {
    Stage stage(scene, extent);
    std::vector<double> times;
    double all = 0.0;
    constexpr int kFirst = 4; // these compile and upload
    for (int i = 0; i < kFirst + 30 && (i < kFirst + 5 || all < 5000.0); ++i) {
        const double took = stage.draw(i / 60.0, update);
        if (i < kFirst) continue;
        times.push_back(took);
        all += took;
    }
    return median(times);
}

osg::ref_ptr<osg::Node> load(const std::string& file, const std::string& options = {}) {
    osg::ref_ptr<osg::Node> scene =
        osgDB::readRefNodeFile(file, osg::ref_ptr<osgDB::Options>(new osgDB::Options(options)));
    if (!scene) throw std::runtime_error(file + ": expected a character");
    return scene;
}

/// The first frame of a scene that comes to a viewer in which the character, deformed by the
/// processor, is drawn already; and later ones.
/// \param make the scene; each time a new one, since what is shared keeps its programs
void benchFirstFrame(const char* name, const std::string& file,
                     const std::function<osg::ref_ptr<osg::Node>()>& make) {
    double first[2], later = 0.0;
    for (const bool isCompiled : {false, true}) {
        const osg::ref_ptr<osg::Group> root = new osg::Group;
        root->addChild(load(file));
        const osg::ref_ptr<osg::Node> scene = make();
        Stage stage(*root, scene->getBound().radius());
        for (int i = 0; i < 3; ++i) stage.draw(i / 60.0);
        if (isCompiled) stage.compile(*scene);
        root->addChild(scene);
        first[isCompiled ? 1 : 0] = stage.draw(0.1);
        stage.draw(0.12); // the skins' second buffers
        std::vector<double> times;
        for (int i = 0; i < 11; ++i) times.push_back(stage.draw(0.2 + i / 60.0));
        later = median(times);
    }
    std::printf("first frame of %s %9.2f ms, compiled before %9.2f ms, later ones %9.2f ms\n", name,
                first[0], first[1], later);
}

void benchCrowd(osgSkin::CrowdCharacter& character, const char* what, std::size_t count, int passes,
                std::size_t maxTriangles = 0) {
    const osg::BoundingSphere sphere(character.bounds());
    const double spacing = spacingOf(sphere);
    std::vector<osgSkin::CrowdInstance> members(count);
    for (std::size_t i = 0; i < count; ++i) {
        members[i].position = placeOf(i, count, spacing);
        members[i].clip = static_cast<unsigned int>(i % character.clipCount());
        members[i].phase = 0.037 * double(i);
    }
    const osg::ref_ptr<osgSkin::GpuCrowd> crowd = new osgSkin::GpuCrowd(&character);
    crowd->setInstances(members);
    crowd->setMaxTriangles(maxTriangles);
    const double extent = 0.5 * spacing * std::sqrt(double(count));
    const double took = timeFrames(*inPasses(*crowd, passes), extent,
                                   [&](double seconds) { crowd->setTime(seconds); });
    std::printf("crowd of %7zu, %s, %d %s %9.2f ms  %8.4f us a member\n", count, what, passes,
                passes == 1 ? "pass  " : "passes", took, 1000.0 * took / double(count));
    std::fflush(stdout);
}

/// The largest skin of each child.
std::vector<osgSkin::DeformableSkin*> largestSkins(osg::Group& scene) {
    std::vector<osgSkin::DeformableSkin*> result;
    for (unsigned int i = 0; i < scene.getNumChildren(); ++i) {
        const auto skins = test::findNodes<osgSkin::DeformableSkin>(*scene.getChild(i));
        const auto largest =
            std::max_element(skins.begin(), skins.end(), [](const auto& a, const auto& b) {
                return a.node->getModel()->vertexCount() < b.node->getModel()->vertexCount();
            });
        if (largest != skins.end()) result.push_back(largest->node);
    }
    return result;
}

void benchSingles(const std::string& file, std::size_t count) {
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    double spacing = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const osg::ref_ptr<osg::Node> one = load(file);
        if (i == 0) spacing = spacingOf(one->getBound());
        const osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrixd::translate(placeOf(i, count, spacing)));
        place->addChild(one);
        scene->addChild(place);
    }
    const auto time = [&](const char* what, const std::function<void(double)>& update) {
        for (const std::string by : {"card", "processor"}) {
            osgSkin::setGpu(*scene, by == "card");
            const double took =
                timeFrames(*scene, 0.5 * spacing * std::sqrt(double(count)), update);
            std::printf("%5zu characters, %-10s%-18s %9.2f ms  %8.4f us a character\n", count,
                        by.c_str(), what, took, 1000.0 * took / double(count));
        }
    };
    time("", {});
    constexpr std::size_t kTargets = 52; // as many as ARKit's
    osg::ref_ptr<const osgSkin::MorphTargets> targets;
    const std::vector<osgSkin::DeformableSkin*> skins = largestSkins(*scene);
    for (osgSkin::DeformableSkin* skin : skins) {
        const std::size_t vertices = skin->getModel()->vertexCount();
        if (!targets || targets->vertexCount() != vertices)
            targets = test::faceTargets(vertices, kTargets);
        skin->setMorphTargets(targets);
    }
    std::vector<float> weights(kTargets);
    time(", 52 morph targets", [&](double seconds) {
        for (std::size_t i = 0; i < kTargets; ++i)
            weights[i] = static_cast<float>(0.5 + 0.5 * std::sin(9.0 * seconds + double(i)));
        for (osgSkin::DeformableSkin* skin : skins) skin->setMorphWeights(weights);
    });
}

} // namespace

void benchFrames(const std::string& file, const std::vector<std::size_t>& crowds,
                 std::size_t maxTriangles, std::size_t singles) {
    {
        const osg::ref_ptr<test::EglWindow> window = new test::EglWindow(16, 16);
        if (!window->valid() || !window->realize() || !window->makeCurrent())
            throw std::runtime_error("EGL gives no context");
        std::printf(
            "%s, OpenGL %s\nwhole frames of %d x %d pixels, update to the end of the draw\n",
            reinterpret_cast<const char*>(glGetString(GL_RENDERER)),
            reinterpret_cast<const char*>(glGetString(GL_VERSION)), kWidth, kHeight);
        window->releaseContext();
    }
    const osg::ref_ptr<osg::Node> loaded = load(file);
    const osg::ref_ptr<osg::Node> plain = load(file, "shapes=none normals=rotated");
    for (const std::size_t count : crowds) {
        const auto character = osgSkin::CrowdCharacter::create(*loaded);
        const auto without = osgSkin::CrowdCharacter::create(*plain);
        if (count == crowds.front()) {
            std::printf("triangles of a member:");
            for (std::size_t level = 0; level < character->levelCount(); ++level)
                std::printf(" %zu", character->triangleCount(level));
            std::printf("\n");
        }
        for (const int passes : {1, 4}) {
            benchCrowd(*character, "with correctives", count, passes);
            benchCrowd(*without, "without         ", count, passes);
        }
        if (maxTriangles > 0) benchCrowd(*character, "limited         ", count, 1, maxTriangles);
    }
    if (singles > 0) benchSingles(file, singles);
    benchFirstFrame("a character", file, [&] {
        const osg::ref_ptr<osg::Node> one = load(file);
        osgSkin::setGpu(*one, true);
        return one;
    });
    benchFirstFrame("a crowd", file, [&]() -> osg::ref_ptr<osg::Node> {
        const osg::ref_ptr<osgSkin::GpuCrowd> crowd =
            new osgSkin::GpuCrowd(osgSkin::CrowdCharacter::create(*load(file)));
        crowd->setInstances(std::vector<osgSkin::CrowdInstance>(1));
        return crowd;
    });
}
