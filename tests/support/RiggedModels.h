// SPDX-License-Identifier: MIT
// The rigged models among Assimp's test models (Debian: assimp-testmodels).
#pragma once

#include <cstddef>

namespace test {

constexpr char kModels[] = "/usr/share/assimp/models/";

/// A rigged model and the expected contents.
struct Rigged {
    const char* file;
    std::size_t joints, vertices, clips;
};

constexpr Rigged kRigged[] = {
    {"Collada/box_nested_animation.dae", 1, 24, 1},
    {"FBX/animation_with_skeleton.fbx", 15, 4220, 1},
    {"FBX/huesitos.fbx", 10, 128, 1},
    {"MD5/SimpleCube.md5mesh", 2, 24, 0},
    {"MDL/MDL (HL1)/alpha_test.mdl", 1, 24, 1},
    {"MDL/MDL (HL1)/blend_additive.mdl", 1, 6, 1},
    {"MDL/MDL (HL1)/chrome_sphere.mdl", 1, 242, 1},
    {"MDL/MDL (HL1)/duplicate_bodyparts.mdl", 1, 27, 1},
    {"MDL/MDL (HL1)/duplicate_sequence_groups/duplicate_sequence_groups.mdl", 1, 3, 9},
    {"MDL/MDL (HL1)/duplicate_sequences.mdl", 1, 3, 9},
    {"MDL/MDL (HL1)/duplicate_submodels.mdl", 1, 18, 1},
    {"MDL/MDL (HL1)/man.mdl", 8, 239, 6},
    {"MDL/MDL (HL1)/sequence_transitions.mdl", 1, 3, 7},
    {"MDL/MDL (HL1)/unnamed_bodyparts.mdl", 1, 27, 1},
    {"MDL/MDL (HL1)/unnamed_bones.mdl", 9, 192, 1},
    {"MDL/MDL (HL1)/unnamed_sequence_groups/unnamed_sequence_groups.mdl", 1, 3, 9},
    {"MDL/MDL (HL1)/unnamed_sequences.mdl", 1, 3, 9},
    {"SMD/WusonSMD.smd", 1, 2117, 1},
    {"SMD/holy_grailref.smd", 1, 511, 1},
    {"SMD/triangle.smd", 1, 3, 1},
    {"X/BCN_Epileptic.X", 54, 3014, 1},
    {"X/Testwuson.X", 38, 3205, 3},
    {"X/anim_test.x", 4, 485, 1},
    {"X/test_cube_binary.x", 1, 24, 0},
    {"X/test_cube_compressed.x", 1, 24, 0},
    {"X/test_cube_text.x", 1, 24, 0},
    {"glTF2/glTF-Sample-Models/AnimatedMorphCube-glTF/AnimatedMorphCube.gltf", 1, 24, 1},
    {"glTF2/simple_skin/simple_skin.gltf", 2, 10, 1},
};

} // namespace test
