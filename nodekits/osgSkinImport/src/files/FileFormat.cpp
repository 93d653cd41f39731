// SPDX-License-Identifier: MIT
#include "files/FileFormat.h"

#include <assimp/Importer.hpp>
#include <osgDB/FileNameUtils>

namespace osgSkin {
namespace {

/// Assimp gets no mesh formats to look for a rig: its PLY reader reads out of bounds, and its OBJ
/// reader leaks memory. It gets no BVH files either: it trusts the declared number of frames.
constexpr struct {
    const char* extension;
    FileFormat::Reader reader;
    bool hasMesh, hasSkeleton;
} kFormats[] = {
    {"obj", FileFormat::Obj, true, false},  {"ply", FileFormat::Ply, true, false},
    {"off", FileFormat::Off, true, false},  {"stl", FileFormat::Assimp, true, false},
    {"bvh", FileFormat::Bvh, false, true},  {"glb", FileFormat::Gltf, true, true},
    {"gltf", FileFormat::Gltf, true, true}, {"vrm", FileFormat::Gltf, true, true},
    {"vrma", FileFormat::Gltf, true, true}, {"skin", FileFormat::Character, false, false},
};

} // namespace

FileFormat formatOf(const std::string& path) {
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    for (const auto& known : kFormats)
        if (extension == known.extension)
            return {extension, known.reader, known.hasMesh, known.hasSkeleton};
    const bool isAssimp =
        !extension.empty() && Assimp::Importer().IsExtensionSupported("." + extension);
    return {extension, isAssimp ? FileFormat::Assimp : FileFormat::Osg, true, true};
}

std::string adviceForCapture(const std::string& extension) {
    if (extension == "asf" || extension == "amc")
        return "; convert Acclaim's .asf and .amc to one .bvh file, as amc2bvh and Blender do";
    if (extension == "c3d" || extension == "trc")
        return "; it has markers, not joints: fit a skeleton to them, as motion capture programs "
               "and Blender do, and export .bvh or .fbx";
    return {};
}

} // namespace osgSkin
