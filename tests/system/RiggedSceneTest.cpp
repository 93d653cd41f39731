// SPDX-License-Identifier: MIT
// Rigged scenes of osgskinbake, played by osgAnimation alone beside the skin's own vertices.
#include "Command.h"
#include "ExpectContains.h"
#include "FindNodes.h"
#include "GlbFile.h"
#include "GltfBuilder.h"
#include "ReferenceSkin.h"
#include "TextFile.h"
#include "UpdateAt.h"

#include <osg/MatrixTransform>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/RigGeometry>
#include <osgDB/ReadFile>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace {

using test::runBake;

/// All vertices of a scene's rigs as the files of --out have them: Y up, facing +Z.
std::vector<glm::dvec3> verticesOf(osg::Node& scene, bool atRest = false) {
    std::vector<glm::dvec3> result;
    const auto array = [](osg::Geometry& of) {
        return static_cast<osg::Vec3Array*>(of.getVertexArray());
    };
    for (const auto& [rig, toWorld] : test::findNodes<osgAnimation::RigGeometry>(scene)) {
        osg::Geometry& source = *rig->getSourceGeometry();
        std::vector<osg::Vec3> vertices = array(atRest ? source : *rig)->asVector();
        auto* morph = dynamic_cast<osgAnimation::MorphGeometry*>(&source);
        for (std::size_t i = 0; atRest && morph && i < morph->getMorphTargetList().size(); ++i) {
            auto& target = morph->getMorphTargetList()[i]; // its offsets, with the rest's weight
            for (std::size_t v = 0; v < vertices.size(); ++v)
                vertices[v] += (*array(*target.getGeometry()))[v] * target.getWeight();
        }
        for (const osg::Vec3& at : vertices) {
            const osg::Vec3d x = osg::Vec3d(at) * toWorld;
            result.emplace_back(x.x(), x.z(), -x.y());
        }
    }
    return result;
}

/// A scene in a file, whose clip `name` plays.
class PlayedScene {
public:
    PlayedScene(const std::string& file, const std::string& name) {
        _scene = osgDB::readRefNodeFile(file);
        auto* manager =
            _scene ? dynamic_cast<osgAnimation::BasicAnimationManager*>(_scene->getUpdateCallback())
                   : nullptr;
        if (!manager) return;
        test::updateAt(*_scene, 0.0);
        for (const auto& animation : manager->getAnimationList())
            if (animation->getName() == name) {
                animation->setPlayMode(osgAnimation::Animation::ONCE); // its last sample, too
                manager->playAnimation(animation);
                isPlaying = true;
            }
    }

    std::vector<glm::dvec3> verticesAt(double time) const {
        test::updateAt(*_scene, time);
        return verticesOf(*_scene);
    }

    bool isPlaying = false;

private:
    osg::ref_ptr<osg::Node> _scene;
};

/// The largest distance of a vertex from the nearest of those in the OBJ frames that were at the
/// same place at rest.
double compareScene(const PlayedScene& scene, const std::string& folder, double rate,
                    const std::vector<glm::dvec3>& atRest) {
    const auto rest = test::readObjVertices(folder + "/rest.obj");
    std::vector<std::vector<std::size_t>> sources;
    for (const glm::dvec3& x : atRest) {
        sources.emplace_back();
        for (std::size_t v = 0; v < rest.size(); ++v)
            if (glm::distance(rest[v], x) < 2e-6) sources.back().push_back(v);
        EXPECT_FALSE(sources.back().empty());
    }
    double result = 0.0;
    std::size_t poses = 0;
    for (int frame = 0; frame < 1000; ++frame) {
        const std::string file = folder + "/frame_" + std::to_string(frame) + ".obj";
        if (!std::filesystem::exists(file)) continue;
        const auto expected = test::readObjVertices(file);
        const auto found = scene.verticesAt(frame / rate);
        EXPECT_EQ(found.size(), sources.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            double error = INFINITY;
            for (const std::size_t v : sources[i])
                error = std::min(error, glm::distance(found[i], expected[v]));
            result = std::max(result, error);
        }
        ++poses;
    }
    EXPECT_GT(poses, 3u);
    return result;
}

/// The vertices of a scene without a clip.
std::vector<glm::dvec3> restOf(const std::string& character, const std::string& folder) {
    const auto baked = runBake(
        character + "--quiet --frames 0 --helpers 0 --shapes none --rigged rest.osgb", folder);
    EXPECT_EQ(baked.status, 0) << baked.err;
    const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(folder + "/rest.osgb");
    return scene ? verticesOf(*scene, true) : std::vector<glm::dvec3>();
}

} // namespace

TEST(RiggedScene, FollowsTheSkin) {
    const std::string folder = test::makeTestFolder();
    const std::string thrower = "'" OSGSKIN_DATA "/thrower.skin' ";
    const auto baked = runBake(thrower + "--quiet --frames 0:324:9 --rest rest.obj --out "
                                         "frame_%d.obj",
                               folder);
    ASSERT_EQ(baked.status, 0) << baked.err;
    const auto rigged = runBake(thrower + "--rigged thrower.osgb", folder);
    ASSERT_EQ(rigged.status, 0) << rigged.err;
    test::expectContains(rigged.err, "thrower.osgb: 31 joints, ");
    const PlayedScene scene(folder + "/thrower.osgb", "throw");
    ASSERT_TRUE(scene.isPlaying);
    const double error = compareScene(scene, folder, 120.0, restOf(thrower, folder));
    std::cout << "thrower: " << 1e3 * error << " mm\n";
    EXPECT_LE(error, 0.0015); // .012 of a thigh's radius
}

TEST(RiggedScene, KeepsMorphTargets) {
    const std::string folder = test::makeTestFolder();
    test::GltfColumn column;
    std::vector<double> wide(column.places.size(), 0.0);
    for (std::size_t v = 8; v < column.places.size() / 3; ++v) wide[3 * v] = 0.01 * double(v);
    nlohmann::json& mesh = column.json["meshes"][0];
    mesh["primitives"][0]["targets"] = {{{"POSITION", column.accessor("VEC3", wide)}}};
    mesh["extras"]["targetNames"] = {"wide"};
    mesh["weights"] = {0.25};
    column.bend();
    column.animate("bend", column.meshNode, "weights", {0.0, 1.0}, {0.0, 1.0});
    const std::string file = "'" + column.save("wide.gltf") + "' ";
    const auto baked = runBake(
        file + "--quiet --rest rest.obj --out frame_%d.obj --helpers 0 --rigged wide.osgb", folder);
    ASSERT_EQ(baked.status, 0) << baked.err;
    const PlayedScene scene(folder + "/wide.osgb", "bend");
    ASSERT_TRUE(scene.isPlaying);
    EXPECT_LE(compareScene(scene, folder, 30.0, restOf(file, folder)), 2e-5);
}

TEST(RiggedScene, NeedsNoOsgSkin) {
    const std::string folder = test::makeTestFolder();
    const auto baked = runBake("'" OSGSKIN_DATA "/pedestrian.skin' --quiet --motion walk --frames "
                               "0:30:5 --rigged pedestrian.osgt",
                               folder);
    ASSERT_EQ(baked.status, 0) << baked.err;
    const std::string text = test::readBytes(folder + "/pedestrian.osgt");
    test::expectContains(text, "osgAnimation::RigGeometry");
    EXPECT_EQ(text.find("osgSkin"), std::string::npos);
}
