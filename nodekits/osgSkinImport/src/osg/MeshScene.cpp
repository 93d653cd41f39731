// SPDX-License-Identifier: MIT
#include "osg/MeshScene.h"

#include "mesh/FinishMesh.h"
#include "mesh/ObjMesh.h"
#include "mesh/PlyMesh.h"
#include "text/FileText.h"

#include <osg/MatrixTransform>
#include <osgDB/FileNameUtils>

#include <algorithm>
#include <iterator>
#include <utility>

namespace osgSkin {
namespace {

bool isTurned(const osgDB::Options* options) {
    if (options == nullptr) return true;
    const auto words = optionValues(options->getOptionString());
    return std::none_of(words.begin(), words.end(),
                        [](const auto& word) { return word.first == "noRotation"; });
}

} // namespace

bool isOurFormat(const std::string& path) {
    static const char* const ours[] = {"bvh", "glb", "gltf", "obj", "off", "ply", "vrm"};
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    return std::find(std::begin(ours), std::end(ours), extension) != std::end(ours);
}

osg::ref_ptr<osg::Node> readMeshScene(const std::string& path, const osgDB::Options* options) {
    const bool isObj = osgDB::equalCaseInsensitive(osgDB::getFileExtension(path), "obj");
    if (!isObj && !osgDB::equalCaseInsensitive(osgDB::getFileExtension(path), "ply"))
        failFile(path, "a model that no scene is read from, expected .osgt, .osgb, .osgx, .obj, "
                       ".ply or .skin");
    CornerMesh read = isObj ? readObjMesh(path, options) : readPlyMesh(path, options);
    checkMaterials(read, path, ReadLimits::of(options));
    const ImportedMesh mesh = finishMesh(std::move(read), path);
    const osg::ref_ptr<osg::MatrixTransform> scene = new osg::MatrixTransform;
    if (isObj && isTurned(options))
        scene->setMatrix(osg::Matrix(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1));
    for (const MeshPart& part : mesh.parts) scene->addChild(part.geometry);
    return scene;
}

} // namespace osgSkin
