// SPDX-License-Identifier: MIT
#include "GpuSubject.h"

#include "FindNodes.h"
#include "SomeCorrectives.h"
#include "SomeMorphs.h"
#include "TubeSkin.h"

#include <osgSkin/Deform>
#include <osgSkin/GlmOsg>

#include <osg/NodeVisitor>
#include <osgDB/ReadFile>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>

namespace test {
namespace {

/// Each time has its own pose, far from rest.
class TurnTube : public osg::DrawableUpdateCallback {
public:
    explicit TurnTube(double unit) : _unit(unit) {}
    void update(osg::NodeVisitor* nv, osg::Drawable* drawable) override {
        auto& skin = static_cast<osgSkin::DeformableSkin&>(*drawable);
        const double time = nv->getFrameStamp()->getSimulationTime();
        std::mt19937_64 random(static_cast<std::uint64_t>(1e4 * time));
        std::vector<glm::dquat> turns;
        for (std::size_t j = 0; j < skin.getModel()->joints().size(); ++j)
            turns.push_back(randomRotation(random));
        auto skinning =
            skinningFrom(skin.getModel()->joints(), turns, _unit * glm::dvec3(0.3, -0.2, 0.5));
        // One joint moves, the last one moves and grows.
        skinning[1] = glm::translate(skinning[1], _unit * glm::dvec3(0.005, 0.0, -0.01));
        skinning.back() = glm::translate(skinning.back(), _unit * glm::dvec3(0.1, 0.2, -0.1));
        skinning.back() = glm::scale(skinning.back(), glm::dvec3(1.2));
        skin.setPose(skinning.data(), skinning.size());
        skin.setActivation("breath", 0.6f);
        skin.setMorph("smile", static_cast<float>(std::sin(7.0 * time)));
        skin.setMorph("open", static_cast<float>(std::cos(5.0 * time)));
    }

private:
    double _unit;
};

/// \param unit the tube's radius
osg::ref_ptr<osgSkin::DeformableSkin> movingTube(double unit) {
    Tube tube;
    for (glm::vec3& position : tube.positions) position *= static_cast<float>(unit);
    for (osgSkin::BoundJoint& joint : tube.binding.joints) joint.centre *= unit;
    tube.binding.correctives = someCorrectives(tube.binding, 0.05 * unit, 7);
    const osg::ref_ptr<osg::Geometry> geometry = makeGeometry(tube);
    const osg::ref_ptr<osg::Vec4Array> tangents = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX);
    for (std::size_t v = 0; v < tube.positions.size(); ++v)
        tangents->push_back(osg::Vec4(0, 1, 0, v % 2 == 0 ? 1.0f : -1.0f));
    geometry->setVertexAttribArray(6, tangents);
    osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    skin->setTangentAttribute(6);
    skin->setSkin(geometry, tube.model());
    skin->setUpdateCallback(new TurnTube(unit));
    return skin;
}

/// A body in a recorded climb.
///
/// \param name of the file to write
/// \param body its mesh and skeleton files
/// \param reason set if a file is missing
osg::ref_ptr<osg::Node> readClimber(const std::string& name,
                                    const std::pair<std::string, std::string>& body,
                                    std::string& reason) {
    const std::string motion = std::string(OSGSKIN_SHARED_DATA) + "/cmu/mb/01_01.bvh";
    for (const std::string& needed : {body.first, body.second, motion})
        if (!std::filesystem::exists(needed)) {
            reason = "third-party data is not here: " + needed;
            return nullptr;
        }
    const std::string file = std::string(OSGSKIN_TEST_OUTPUT) + "/" + name + ".skin";
    std::ofstream(file) << "{ \"osgskin\": 1, \"shapes\": \"fast\", \"mesh\": \"" << body.first
                        << "\", \"skeleton\": \"" << body.second
                        << "\", \"motions\": [ { \"file\": \"" << motion
                        << "\", \"name\": \"climb\", \"skipFrames\": 1 } ] }";
    return osgDB::readRefNodeFile(file);
}

osg::ref_ptr<osg::Node> readPainted(std::string& reason) {
    const std::string file = std::string(OSGSKIN_SHARED_DATA) + "/characters/Knight.glb";
    if (!std::filesystem::exists(file)) {
        reason = "third-party data is not here: " + file;
        return nullptr;
    }
    return osgDB::readRefNodeFile(file + ".skin");
}

double angle(const osg::Vec3d& a, const osg::Vec3d& b) {
    return std::atan2((a ^ b).length(), a * b);
}

} // namespace

GpuSubject::GpuSubject(const std::string& name) {
    osg::ref_ptr<osg::Node> node;
    if (name == "tube") node = movingTube(1.0);
    if (name == "small") node = movingTube(1e-4);
    if (name == "large") node = movingTube(1e4);
    if (name == "morphs") {
        const osg::ref_ptr<osgSkin::DeformableSkin> skin = movingTube(1.0);
        const std::size_t vertices = skin->getModel()->vertexCount();
        skin->setMorphTargets(osgSkin::MorphTargets::create(someMorphs(vertices, 0.1), vertices));
        node = skin;
    }
    if (name == "thrower")
        node = osgDB::readRefNodeFile(std::string(OSGSKIN_DATA) + "/thrower.skin");
    const std::string data = OSGSKIN_DATA, human = std::string(OSGSKIN_SHARED_DATA) + "/makehuman";
    if (name == "climber")
        node = readClimber(name, {data + "/thrower.obj", data + "/thrower.bvh"}, reason);
    if (name == "body")
        node = readClimber(
            name, {human + "/body/body4k_neutral.obj", human + "/rig/cmu_mb_neutral.bvh"}, reason);
    if (name == "climber" || name == "body") seconds = 22.0;
    if (name == "painted") node = readPainted(reason);
    if (std::filesystem::exists(name)) node = osgDB::readRefNodeFile(name);
    if (!node) {
        if (reason.empty()) reason = name + " cannot be read";
        return;
    }
    if (const char* named = std::getenv("OSGSKIN_GPU_POSES")) poses = std::atoi(named);
    if (const char* named = std::getenv("OSGSKIN_GPU_SECONDS")) seconds = std::atof(named);
    scene->addChild(node);
    skins = skinsIn(*node);
}

std::vector<osg::ref_ptr<osgSkin::DeformableSkin>> skinsIn(osg::Node& scene) {
    std::vector<osg::ref_ptr<osgSkin::DeformableSkin>> skins;
    for (const auto& found : findNodes<osgSkin::DeformableSkin>(scene))
        skins.emplace_back(found.node);
    return skins;
}

void Difference::take(const Difference& other) {
    positions = std::max(positions, other.positions);
    normals = std::max(normals, other.normals);
    tangents = std::max(tangents, other.tangents);
    computedError = std::max(computedError, other.computedError);
    deformedError = std::max(deformedError, other.deformedError);
}

/// In double precision, by the scalar reference on the CPU.
std::vector<glm::vec3> referenceNormals(const osgSkin::DeformableSkin& skin) {
    osgSkin::DeformOptions options;
    options.normals = options.reference = true;
    std::optional<osgSkin::MorphedRest> morphed;
    if (skin.isMorphed()) {
        morphed.emplace(skin.getModel(), skin.getMorphTargets());
        morphed->set(skin.getMorphWeights());
        options.morphed = &*morphed;
    }
    return osgSkin::deform(*skin.getModel(), skin.getPose(), options).normals;
}

Difference difference(const osgSkin::DeformableSkin& skin, const GpuStage::Posed& computed) {
    const osg::Geometry& expected = *skin.getDeformedGeometry();
    const auto& positions = static_cast<const osg::Vec3Array&>(*expected.getVertexArray());
    const auto& normals = static_cast<const osg::Vec3Array&>(*expected.getNormalArray());
    osg::BoundingBox box;
    for (const osg::Vec3& p : positions) box.expandBy(p);
    const double extent = 2.0 * static_cast<double>(box.radius());
    Difference most;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const osg::Vec3d apart = osg::Vec3d(computed.positions[v]) - osg::Vec3d(positions[v]);
        most.take({apart.length() / extent, angle(computed.normals[v], normals[v]), 0.0});
    }
    const std::vector<glm::vec3> reference = referenceNormals(skin);
    for (std::size_t v = 0; v < normals.size(); ++v) {
        const osg::Vec3d exact = osgSkin::toOsg(glm::dvec3(reference[v]));
        most.take({0.0, 0.0, 0.0, angle(computed.normals[v], exact), angle(normals[v], exact)});
    }
    if (computed.tangents.empty()) return most;
    const auto& tangents = static_cast<const osg::Vec4Array&>(
        *expected.getVertexAttribArray(static_cast<unsigned int>(skin.getTangentAttribute())));
    const auto direction = [](const osg::Vec4& t) { return osg::Vec3d(t.x(), t.y(), t.z()); };
    for (std::size_t v = 0; v < tangents.size(); ++v) {
        const double hand = std::abs(double(computed.tangents[v].w()) - double(tangents[v].w()));
        most.take(
            {0.0, 0.0, angle(direction(computed.tangents[v]), direction(tangents[v])) + hand});
    }
    return most;
}

} // namespace test
