// SPDX-License-Identifier: MIT
#include "source/CharacterSource.h"

#include "options/SkinFile.h"
#include "source/ApplyOptions.h"
#include "source/LoadReport.h"

#include <osgSkin/ExpectedNames>
#include <osgSkin/GlmOsg>
#include <osgSkinImport/ImportConstraints>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinImport/ImportSprings>
#include <osgSkinImport/ShareImages>
#include <osgSkinMotion/SpringBones>

#include <glm/gtc/quaternion.hpp>
#include <osg/BoundingBox>
#include <osg/Math>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace osgSkin {
namespace {

/// OSG's world has Z up; most characters' files have Y up and face +Z, so they come to face -Y,
/// towards osgviewer's camera.
osg::Matrixd toWorldOf(const SkinFile& file) {
    return file.up == RetargetOptions::Up::Z ? osg::Matrixd()
                                             : osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0));
}

void fitRest(CharacterSource& source, FitOptions fit, const Progress& progress) {
    fit.progress = progress;
    source.rest = withFileContext(
        source.meshFile, [&] { return fitSkeleton(source.body.mesh, fit, &source.fitReport); });
    OSG_INFO << source.file << ":\n" << source.fitReport.text();
    for (const std::string& note : source.fitReport.notes)
        warn(source.notes, source.file + ": fitted skeleton: " + note);
}

/// Reads the skeleton that a `.skin` file names, or the mesh file's own.
RestSkeleton namedSkeleton(const SkinFile& skin, const osgDB::Options* options) {
    try {
        return importSkeleton(skin.skeleton, options);
    } catch (const Error& error) {
        if (skin.skeleton != skin.mesh) throw;
        throw Error(std::string(error.what()) +
                    "; set \"skeleton\" to a file, or to { \"fit\": true } to fit one to the body");
    }
}

/// The skeleton after quarter turns about x.
RestSkeleton turned(const RestSkeleton& rest, int quarters) {
    const glm::dquat turn = glm::angleAxis(quarters * osg::PI_2, glm::dvec3(1.0, 0.0, 0.0));
    RestSkeleton result = rest;
    for (RestJoint& joint : result.joints) {
        joint.centre = turn * joint.centre;
        if (joint.tip) joint.tip = turn * *joint.tip;
        joint.frame = glm::normalize(turn * joint.frame);
    }
    return result;
}

/// Tools write meshes with Y up and motions with Z up, or the reverse. Where most joints are
/// outside the body, but nearly all are inside after one quarter turn about x, this turns the
/// skeleton and says so.
void turnIntoBody(CharacterSource& source, const std::string& file) {
    constexpr double kRoom = 0.05, kFew = 0.5, kNearlyAll = 0.9;
    osg::BoundingBoxd box;
    for (const glm::dvec3& p : source.body.mesh.positions) box.expandBy(toOsg(p));
    if (!box.valid() || source.rest.joints.size() < 3) return;
    const double room = kRoom * 2.0 * box.radius();
    box.expandBy(box._min - osg::Vec3d(room, room, room));
    box.expandBy(box._max + osg::Vec3d(room, room, room));
    const auto isInside = [&box](const RestSkeleton& rest, double share) {
        const auto inside =
            std::count_if(rest.joints.begin(), rest.joints.end(), [&box](const RestJoint& joint) {
                return box.contains(toOsg(joint.centre));
            });
        return double(inside) >= share * double(rest.joints.size());
    };
    if (isInside(source.rest, kFew)) return;
    const RestSkeleton ahead = turned(source.rest, 1), back = turned(source.rest, -1);
    const bool fitsAhead = isInside(ahead, kNearlyAll), fitsBack = isInside(back, kNearlyAll);
    if (fitsAhead == fitsBack) return; // neither, or a body around the origin
    source.rest = fitsAhead ? ahead : back;
    warn(source.notes, source.file + ": " + file +
                           " has another axis up than the body: the skeleton is rotated by a "
                           "quarter turn about x, and its joints lie inside");
}

/// Adds the springs of a `.skin` file to those of its skeleton's.
void addSprings(const SkinFile& skin, CharacterSource& source) {
    const std::map<std::string, int> joints = source.rest.byName();
    const auto centreOf = [&](const std::string& name) {
        const auto found = joints.find(name);
        if (found == joints.end())
            throw Error("springs: no joint is called \"" + name + '"' +
                        expectedNames(name, joints));
        return source.rest.joints[static_cast<std::size_t>(found->second)].centre;
    };
    SpringSettings& all = source.springs;
    std::size_t swinging = 0;
    for (const SkinFile::Spring& spring : skin.springs) {
        SpringSettings::Chain chain = springsBelow(source.rest, spring.joints, spring.like);
        chain.centre = spring.centre;
        if (!chain.centre.empty()) centreOf(chain.centre);
        for (SpringSettings::Collider collider : spring.colliders) {
            collider.start += centreOf(collider.joint);
            collider.end += centreOf(collider.joint);
            chain.colliders.push_back(all.colliders.size());
            all.colliders.push_back(collider);
        }
        swinging += chain.joints.size();
        all.chains.push_back(chain);
        if (swinging > source.limits.joints)
            throw Error("springs: more than " + std::to_string(source.limits.joints) +
                        " joints, counted in each spring (option maxJoints)");
    }
}

std::vector<std::string> filesOf(const SkinFile& skin, const CharacterSource& source) {
    std::vector<std::string> files{skin.file, skin.mesh};
    for (const std::string& file : {skin.skeleton, source.weightsFile})
        if (!file.empty()) files.push_back(file);
    for (const SkinFile::MotionEntry& motion : source.motions) files.push_back(motion.file);
    for (const SkinFile::Prop& prop : source.props)
        files.insert(files.end(), {prop.mesh, prop.file});
    return files;
}

} // namespace

CharacterSource readSkinFile(const std::string& file, const LoadOptions& options,
                             LoadStages& stages) {
    const ReadLimits limits = ReadLimits::of(options.readOptions.get());
    const SkinFile skin = SkinFile::read(file, limits);
    CharacterSource source;
    source.limits = limits;
    source.file = file;
    source.meshFile = skin.mesh;
    source.toWorld = toWorldOf(skin);
    source.bind = skin.bind;
    source.options = skin.options;
    source.weightsFile = skin.weights;
    source.motions = skin.motions;
    source.yIsUp = skin.up == RetargetOptions::Up::Y;
    source.props = skin.props;
    source.meshOptions = shareImages(options.readOptions.get());
    applyOptions(source, options);
    source.files = filesOf(skin, source);

    stages.begin("mesh", LoadStages::kMesh);
    source.body =
        withFileContext(file, [&] { return importMesh(skin.mesh, source.meshOptions.get()); });
    if (source.painted == CharacterSource::Painted::WhereGood && source.body.weights.empty())
        source.painted = CharacterSource::Painted::No;
    stages.plan(LoadStages::kMesh + (skin.fit ? LoadStages::kFit : LoadStages::kSkeleton) +
                source.laterSize());
    if (skin.fit) {
        fitRest(source, *skin.fit, stages.begin("skeleton", LoadStages::kFit));
    } else {
        stages.begin("skeleton", LoadStages::kSkeleton);
        source.rest =
            withFileContext(file, [&] { return namedSkeleton(skin, options.readOptions.get()); });
        if (skin.skeleton != skin.mesh) turnIntoBody(source, skin.skeleton);
    }
    const osgDB::Options* read = options.readOptions.get();
    if (skin.skeleton == skin.mesh) {
        source.springs = importSprings(skin.mesh, read);
        source.constraints = importConstraints(skin.mesh, read);
    }
    withFileContext(file, [&] { addSprings(skin, source); });
    source.statedUnit = importUnit(skin.mesh, read);
    if (source.statedUnit == 0.0 && !skin.fit) source.statedUnit = importUnit(skin.skeleton, read);
    return source;
}

} // namespace osgSkin
