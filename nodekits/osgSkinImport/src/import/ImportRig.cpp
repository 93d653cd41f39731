// SPDX-License-Identifier: MIT
#include <osgSkinImport/ImportRig>

#include "assimp/AssimpScene.h"
#include "assimp/SceneSkeleton.h"
#include "assimp/mesh/AssimpMesh.h"
#include "mesh/FinishMesh.h"
#include "rig/RigBones.h"
#include "rig/RigClips.h"
#include "text/FileText.h"

#include <osg/Math>
#include <osgDB/FileNameUtils>

#include <utility>

namespace osgSkin {
namespace {

bool isRigged(const aiScene& scene) {
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        if (scene.mMeshes[m]->mNumBones > 0) return true;
    return false;
}

/// OSG's world has Z up and a figure faces -Y. Assimp turns most formats to Y up; FBX files say
/// what they have and are left as they are, and so is SMD, which has Z up.
osg::Matrixd toWorld(const aiScene& scene, const std::string& path) {
    const osg::Matrixd fromY = osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0));
    bool backwards = false;
    if (scene.mMetaData != nullptr && scene.mMetaData->Get(kFacesBackwards, backwards) && backwards)
        return osg::Matrixd::rotate(osg::PI, osg::Vec3d(0, 1, 0)) * fromY;
    if (osgDB::getLowerCaseFileExtension(path) == "smd") return {};
    int up = 1;
    if (scene.mMetaData != nullptr && scene.mMetaData->Get("UpAxis", up) && up == 2) return {};
    return fromY;
}

double metresPerUnit(const aiScene& scene, const std::string& path) {
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    if (extension == "gltf" || extension == "glb" || extension == "vrm") return 1.0;
    double centimetres = 0.0;
    float single = 0.0f;
    if (scene.mMetaData == nullptr) return 0.0;
    if (scene.mMetaData->Get("UnitScaleFactor", centimetres)) return 0.01 * centimetres;
    if (scene.mMetaData->Get("UnitScaleFactor", single)) return 0.01 * double(single);
    return 0.0;
}

} // namespace

bool isReadByAssimp(const std::string& path) {
    return assimpReads(path);
}

ImportedRig importRig(const std::string& path, const osgDB::Options* options) {
    const ReadLimits limits = ReadLimits::of(options);
    limits.checkFormat(path);
    const std::size_t bytes = requireReadable(path, limits);
    const std::string none = "no mesh with bones, expected a rigged character";
    if (holdsMeshesOnly(path)) failFile(path, none);
    Assimp::Importer importer;
    const aiScene& scene = readAssimpScene(importer, path, limits);
    if (!isRigged(scene)) failFile(path, none);

    ImportedRig result;
    CornerMesh body = readSceneMesh(scene, path, options);
    checkMaterials(body, path, limits);
    result.body = finishMesh(std::move(body), path);
    const SceneSkeleton joints = readSceneSkeleton(scene, path, limits);
    result.rest = joints.rest;
    result.skeleton = makeBones(joints, movedJoints(scene, joints));
    result.animations = makeClips(scene, joints, limits.samplesOf(bytes), path);
    result.toWorld = toWorld(scene, path);
    result.metresPerUnit = metresPerUnit(scene, path);
    return result;
}

} // namespace osgSkin
