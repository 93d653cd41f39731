// SPDX-License-Identifier: MIT
#include <osgSkin/SkinModelBlock>

#include "WordReader.h"
#include "correctives/CorrectivesWords.h"

#include <cmath>

namespace osgSkin {
namespace {

std::vector<glm::vec3> readVectors(WordReader& in, std::uint32_t count, const char* what) {
    std::vector<glm::vec3> vectors(count);
    for (std::uint32_t v = 0; v < count; ++v)
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            vectors[v][axis] = in.real();
            if (!std::isfinite(vectors[v][axis]))
                in.fail("vertex " + std::to_string(v) + " has a " + what + " that is not finite");
        }
    return vectors;
}

BoundJoint readJoint(WordReader& in) {
    BoundJoint joint;
    joint.parent = static_cast<int>(in.word());
    joint.name = in.text();
    joint.centre = in.longVector();
    joint.boneAxis = in.longVector();
    joint.twistAxis = in.longVector();
    return joint;
}

} // namespace

std::shared_ptr<const SkinModel> unpackSkinModel(const std::vector<std::uint32_t>& words) {
    WordReader in(words);
    const std::uint32_t version = in.word();
    if (version < 1 || version > kSkinModelBlockVersion)
        in.fail("it has version " + std::to_string(version) + ", expected 1 to " +
                std::to_string(kSkinModelBlockVersion));
    Binding binding;
    const std::uint32_t joints = in.count("joints", 20);
    for (std::uint32_t j = 0; j < joints; ++j) binding.joints.push_back(readJoint(in));
    const std::uint32_t vertices = in.count("vertices", 10);
    if (vertices == 0) in.fail("it has no vertex");
    std::vector<glm::vec3> positions = readVectors(in, vertices, "position");
    std::vector<glm::vec3> normals = readVectors(in, vertices, "normal");
    std::vector<std::uint32_t> source;
    binding.firstInfluence.push_back(0);
    for (std::uint32_t v = 0; v < vertices; ++v) {
        const std::uint32_t influences = in.count("influences", 3);
        for (std::uint32_t i = 0; i < influences; ++i) {
            Influence influence;
            influence.joint = in.word();
            influence.bend = in.real();
            influence.twist = in.real();
            binding.influences.push_back(influence);
        }
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
        binding.regions.push_back(0);
        source.push_back(v);
    }
    if (version >= 2) binding.correctives = takeCorrectives(in, vertices);
    if (!in.atEnd()) in.fail("there is more in it than a model");
    // Indices, ratios, axes and the tree of joints are checked there.
    return SkinModel::create(binding, std::move(positions), std::move(normals), source);
}

} // namespace osgSkin
