// SPDX-License-Identifier: MIT
#include "Samples.h"

#include <osgSkin/DeformableSkin>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportSkeleton>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include <osgAnimation/RigGeometry>
#include <osgAnimation/VertexInfluence>
#include <osgDB/FileUtils>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>
#include <osgUtil/Simplifier>
#include <osgUtil/SmoothingVisitor>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <stdexcept>

namespace {

using Rotations = std::map<std::string, glm::dquat>;

const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);
constexpr int kFrames = 60;
constexpr double kFramesPerSecond = 60.0;

glm::dquat turn(double degrees, const glm::dvec3& axis) {
    return glm::angleAxis(glm::radians(degrees), axis);
}

void write(const std::string& file, const std::string& text) {
    std::ofstream out(file, std::ios::binary);
    out << text;
    if (!out.flush()) throw std::runtime_error(file + ": cannot be written");
}

void write(const std::string& file, const osg::Node& node) {
    if (!osgDB::writeNodeFile(node, file)) throw std::runtime_error(file + ": cannot be written");
}

/// Arms that hang: at rest they point 40 degrees below the horizon.
void lowerArms(Rotations& pose, double leftSwing, double rightSwing, double bend) {
    pose["LeftArm"] = turn(leftSwing, kX) * turn(-42.0, kZ);
    pose["RightArm"] = turn(rightSwing, kX) * turn(42.0, kZ);
    pose["LeftForeArm"] = turn(bend, glm::normalize(glm::dvec3(-0.64, -0.77, 0.0)));
    pose["RightForeArm"] = turn(bend, glm::normalize(glm::dvec3(-0.64, 0.77, 0.0)));
}

/// A walk on the spot, and how far the hips are below their height at rest.
Rotations walk(double phase, double& drop) {
    Rotations pose;
    double longest = 0.0;
    for (const double half : {0.0, 0.5}) {
        const std::string side = half > 0.0 ? "Right" : "Left";
        const double angle = glm::two_pi<double>() * (phase + half);
        const double hip = 24.0 * std::cos(angle) + 5.0;
        const double knee = 9.0 + 50.0 * std::max(0.0, -std::sin(angle));
        pose[side + "UpLeg"] = turn(-hip, kX);
        pose[side + "Leg"] = turn(knee, kX);
        pose[side + "Foot"] = turn(0.75 * (hip - knee), kX);
        longest = std::max(longest, 0.417 * std::cos(glm::radians(hip)) +
                                        0.435 * std::cos(glm::radians(hip - knee)));
    }
    drop = 0.852 - longest;
    const double swing = std::cos(glm::two_pi<double>() * phase);
    lowerArms(pose, 24.0 * swing, -24.0 * swing, 22.0);
    pose["Hips"] = turn(5.0 * swing, kY);
    pose["Spine"] = turn(-9.0 * swing, kY) * turn(3.0, kX);
    pose["Neck"] = turn(4.0 * swing, kY);
    return pose;
}

/// A wave with the right hand.
Rotations wave(double phase, double& drop) {
    drop = 0.0;
    const double beat = std::sin(2.0 * glm::two_pi<double>() * phase);
    Rotations pose;
    lowerArms(pose, 0.0, 0.0, 12.0);
    pose["RightShoulder"] = turn(-12.0, kZ);
    pose["RightArm"] = turn(-68.0, kZ);
    pose["RightForeArm"] = turn(-58.0 + 22.0 * beat, kZ);
    pose["RightHand"] = turn(80.0, glm::normalize(glm::dvec3(-0.7, -0.62, 0.17)));
    pose["Spine"] = turn(3.0, kZ);
    pose["Neck"] = turn(-5.0, kZ);
    return pose;
}

/// Angles of the channels Zrotation, Yrotation and Xrotation, degrees.
glm::dvec3 channels(const glm::dquat& rotation) {
    const glm::dmat3 m = glm::mat3_cast(rotation);
    return glm::degrees(glm::dvec3(std::atan2(m[0][1], m[0][0]), -std::asin(m[0][2]),
                                   std::atan2(m[1][2], m[2][2])));
}

/// Writes a clip for the skeleton of the throw.
void writeClip(const std::string& throwFile, const std::string& file,
               const std::function<Rotations(double, double&)>& pose) {
    std::ifstream in(throwFile);
    std::ostringstream out;
    for (std::string line; std::getline(in, line) && line.rfind("MOTION", 0) != 0;)
        out << line << '\n';
    const osgSkin::RestSkeleton skeleton = osgSkin::importSkeleton(throwFile);
    out << "MOTION\nFrames: " << kFrames << "\nFrame Time: " << 1.0 / kFramesPerSecond << '\n';
    for (int frame = 0; frame < kFrames; ++frame) {
        double drop = 0.0;
        Rotations rotations = pose(double(frame) / kFrames, drop);
        out << "0 " << 0.97 - drop << " 0";
        for (const osgSkin::RestJoint& joint : skeleton.joints) {
            const auto found = rotations.find(joint.name);
            const glm::dvec3 angles =
                found == rotations.end() ? glm::dvec3(0.0) : channels(found->second);
            out << ' ' << angles.x << ' ' << angles.y << ' ' << angles.z;
        }
        out << '\n';
    }
    write(file, out.str());
}

std::string skinFile(const std::string& mesh, const std::string& skeleton) {
    return "{ \"osgskin\": 1, \"mesh\": \"" + mesh + "\", \"skeleton\": \"" + skeleton +
           "\",\n  \"motions\": [ { \"file\": \"walk.bvh\", \"name\": \"walk\" },\n"
           "               { \"file\": \"wave.bvh\", \"name\": \"wave\" } ] }\n";
}

/// The body with fewer triangles.
void writeCoarse(const std::string& mesh, const std::string& file) {
    const osg::ref_ptr<osg::Group> body = new osg::Group;
    for (const osgSkin::MeshPart& part : osgSkin::importMesh(mesh).parts)
        body->addChild(part.geometry);
    osgUtil::Simplifier simplifier(0.2);
    body->accept(simplifier);
    osgUtil::SmoothingVisitor smoothing;
    body->accept(smoothing);
    write(file, *body);
}

glm::vec3 asGlm(const osg::Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

/// 1 at the centre of an ellipsoid, 0 outside, smooth.
float bump(const osg::Vec3& at, const osg::Vec3& centre, const osg::Vec3& radii) {
    const osg::Vec3 d(at.x() - centre.x(), at.y() - centre.y(), at.z() - centre.z());
    const float r = osg::Vec3(d.x() / radii.x(), d.y() / radii.y(), d.z() / radii.z()).length2();
    return r < 1.0f ? (1.0f - r) * (1.0f - r) : 0.0f;
}

/// A morph target of offsets, with the normals of the moved surface.
osgSkin::MorphTarget makeMorph(const std::string& name, const osg::Geometry& rest,
                               const std::function<osg::Vec3(const osg::Vec3&)>& offset) {
    const auto& vertices = static_cast<const osg::Vec3Array&>(*rest.getVertexArray());
    const osg::ref_ptr<osg::Geometry> moved = osg::clone(&rest, osg::CopyOp::DEEP_COPY_ALL);
    auto& places = static_cast<osg::Vec3Array&>(*moved->getVertexArray());
    for (osg::Vec3& place : places) place += offset(place);
    osgUtil::SmoothingVisitor::smooth(*moved, osg::PI);
    const auto& normals = static_cast<const osg::Vec3Array&>(*rest.getNormalArray());
    const auto& turned = static_cast<const osg::Vec3Array&>(*moved->getNormalArray());
    osgSkin::MorphTarget result;
    result.name = name;
    for (unsigned int v = 0; v < vertices.size(); ++v) {
        if ((places[v] - vertices[v]).length() < 1e-5f) continue;
        result.vertices.push_back(v);
        result.positions.push_back(asGlm(places[v] - vertices[v]));
        result.normals.push_back(asGlm(turned[v] - normals[v]));
    }
    return result;
}

osg::Vec3 smile(const osg::Vec3& v) {
    osg::Vec3 result;
    for (const float side : {-1.0f, 1.0f}) {
        result += osg::Vec3(side * 0.010f, 0.014f, -0.004f) *
                  bump(v, {side * 0.030f, 1.607f, 0.085f}, {0.026f, 0.022f, 0.05f});
        result += osg::Vec3(side * 0.004f, 0.004f, 0.006f) *
                  bump(v, {side * 0.043f, 1.637f, 0.075f}, {0.025f, 0.022f, 0.05f});
    }
    return result;
}

osg::Vec3 surprise(const osg::Vec3& v) {
    osg::Vec3 result = osg::Vec3(0.0f, -0.030f, -0.006f) *
                       bump(v, {0.0f, 1.565f, 0.07f}, {0.065f, 0.046f, 0.075f});
    for (const float side : {-1.0f, 1.0f})
        result += osg::Vec3(0.0f, 0.014f, 0.004f) *
                  bump(v, {side * 0.034f, 1.695f, 0.085f}, {0.035f, 0.024f, 0.05f});
    return result;
}

/// The standing figure in one skin, with two morph targets.
void writeFace(const std::string& thrower, const std::string& file) {
    osgSkin::LoadOptions options;
    options.atRest = true;
    options.rigid.emplace(); // none: the head stays in the skin
    const osgSkin::Character character = osgSkin::loadCharacter(thrower, options);
    osgSkin::DeformableSkin& skin = *character.skin.skins.front().drawable;
    const osg::Geometry& rest = *skin.getRestGeometry();
    skin.setMorphTargets(osgSkin::MorphTargets::create(
        {makeMorph("smile", rest, smile), makeMorph("surprise", rest, surprise)},
        rest.getVertexArray()->getNumElements()));
    write(file, *character.root);
}

/// The character as osgAnimation skins it, with weights taken from our own bend ratios.
void writeRig(const std::string& walker, const std::string& file) {
    osgSkin::LoadOptions options;
    options.rigid.emplace();
    const osgSkin::Character character = osgSkin::loadCharacter(walker, options);
    const osg::ref_ptr<osgAnimation::VertexInfluenceMap> weights =
        new osgAnimation::VertexInfluenceMap;
    const osgSkin::Binding& binding = character.binding;
    const auto& skin = character.skin.skins.front();
    for (unsigned int v = 0; v < skin.part.sourceVertex.size(); ++v) {
        const std::size_t source = skin.part.sourceVertex[v];
        std::vector<double> own(binding.joints.size());
        for (auto i = binding.firstInfluence[source]; i < binding.firstInfluence[source + 1]; ++i) {
            const osgSkin::Influence& influence = binding.influences[i];
            own[influence.joint] += double(influence.bend);
            if (influence.joint > 0)
                own[std::size_t(binding.joints[influence.joint].parent)] -= double(influence.bend);
        }
        double sum = 0.0;
        for (double& weight : own) sum += weight = std::max(0.0, weight);
        for (std::size_t j = 0; j < own.size(); ++j) {
            if (own[j] < 0.01 * sum) continue;
            osgAnimation::VertexInfluence& influence = (*weights)[binding.joints[j].name];
            influence.setName(binding.joints[j].name);
            influence.emplace_back(v, float(own[j] / sum));
        }
    }
    const osg::ref_ptr<osgAnimation::RigGeometry> rig = new osgAnimation::RigGeometry;
    rig->setName("body");
    rig->setSourceGeometry(skin.part.geometry);
    rig->setInfluenceMap(weights);
    rig->setUpdateCallback(new osgAnimation::UpdateRigGeometry);
    character.skeleton->removeChild(skin.drawable);
    character.skeleton->addChild(rig);
    character.skeleton->setUpdateCallback(new osgAnimation::Skeleton::UpdateSkeleton);
    character.skeleton->setCullCallback(nullptr);
    character.skeleton->setComputeBoundingSphereCallback(nullptr);
    const osg::ref_ptr<osgAnimation::BasicAnimationManager> manager =
        new osgAnimation::BasicAnimationManager;
    for (const auto& clip : character.manager->getAnimationList()) manager->registerAnimation(clip);
    character.root->setUpdateCallback(manager);
    write(file, *character.root);
}

} // namespace

void writeSamples(const std::string& data, const std::string& folder) {
    const auto path = [](const std::string& in, const char* name) {
        return std::filesystem::absolute(in + "/" + name).generic_string();
    };
    // Without them OSG writes characters without their skins, and reports success.
    if (!osgDB::Registry::instance()->getObjectWrapperManager()->findWrapper(
            "osgSkin::DeformableSkin"))
        throw std::runtime_error("the serializers are missing: expected OSG_LIBRARY_PATH to name "
                                 "the folder of osgSkin's plug-ins");
    if (!osgDB::makeDirectory(folder)) throw std::runtime_error(folder + ": cannot be made");
    const std::string throwFile = path(data, "throw.bvh"), skeleton = path(data, "thrower.bvh");
    writeClip(throwFile, folder + "/walk.bvh", walk);
    writeClip(throwFile, folder + "/wave.bvh", wave);
    write(folder + "/walker.skin", skinFile(path(data, "thrower.obj"), skeleton));
    writeCoarse(path(data, "thrower.obj"), folder + "/coarse.obj");
    write(folder + "/coarse.skin", skinFile("coarse.obj", skeleton));
    writeFace(data + "/thrower.skin", folder + "/face.osgb");
    writeRig(folder + "/walker.skin", folder + "/rig.osgt");
    for (const auto& file : std::filesystem::directory_iterator(data))
        if (file.path().filename().string().rfind("pedestrian", 0) == 0)
            std::filesystem::copy(file, folder, std::filesystem::copy_options::overwrite_existing);
}

std::string coarserOf(const std::string& file) {
    namespace fs = std::filesystem;
    const fs::path beside = fs::path(file).parent_path() / "coarse.skin";
    if (fs::exists(beside)) return beside.generic_string();
    const fs::path folder = fs::temp_directory_path() / "osgskin-recipes";
    const std::string made = (folder / fs::path(file).stem()).generic_string() + ".coarse";
    osgDB::makeDirectory(folder.generic_string());
    writeCoarse(file, made + ".obj");
    write(made + ".skin", "{ \"osgskin\": 1, \"mesh\": \"" + made + ".obj\", \"skeleton\": \"" +
                              fs::absolute(file).generic_string() + "\" }\n");
    return made + ".skin";
}
