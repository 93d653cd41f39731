// SPDX-License-Identifier: MIT
#include "words/SkinModelBlock.h"

#include "model/CorrectiveBlocks.h"
#include "model/GradientBlocks.h"
#include "model/SkinModelAccess.h"
#include "words/CorrectivesWords.h"

#include <algorithm>
#include <utility>

namespace osgSkin {
namespace {

std::vector<glm::vec3> readVectors(WordReader& in, std::uint32_t count) {
    std::vector<glm::vec3> vectors(count);
    for (glm::vec3& vector : vectors)
        for (glm::length_t axis = 0; axis < 3; ++axis) vector[axis] = in.real();
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

void putGradients(const Binding& binding, WordWriter& out) {
    for (std::size_t i = 0; i < binding.influences.size(); ++i) {
        if (!binding.influences[i].isPartial()) continue;
        out.putVector(binding.gradients[i].bend);
        out.putVector(binding.gradients[i].twist);
    }
}

std::vector<RatioGradient> takeGradients(WordReader& in, const std::vector<Influence>& influences) {
    std::vector<RatioGradient> gradients(influences.size());
    for (std::size_t i = 0; i < influences.size(); ++i) {
        if (!influences[i].isPartial()) continue;
        for (glm::vec3* vector : {&gradients[i].bend, &gradients[i].twist})
            for (glm::length_t axis = 0; axis < 3; ++axis) (*vector)[axis] = in.real();
    }
    return gradients;
}

} // namespace

Binding bindingOf(const SkinModel& model) {
    // Per vertex first: groups list their vertices in an order of their own, and their joints in
    // the product's.
    std::vector<std::vector<std::pair<Influence, RatioGradient>>> influences(model.vertexCount());
    const std::vector<RatioGradient> grouped = gradientsOf(model);
    auto gradient = grouped.begin();
    for (const SkinModel::Group& group : model.groups()) {
        const SkinModel::Ratio* ratio = model.ratios().data() + group.firstRatio;
        for (std::uint32_t i = 0; i < group.vertexCount; ++i) {
            auto& list = influences[model.order()[group.firstVertex + i]];
            for (std::uint32_t k = 0; k < group.linkCount; ++k) {
                const SkinModel::Link& link = model.links()[group.firstLink + k];
                const SkinModel::Ratio own = link.partial ? *ratio++ : SkinModel::Ratio{1.0f, 1.0f};
                const RatioGradient slope = grouped.empty() ? RatioGradient{} : *gradient++;
                if (own.bend == 0.0f && own.twist == 0.0f) continue; // others of the group have it
                list.push_back({{link.joint, own.bend, own.twist}, slope});
            }
            std::sort(list.begin(), list.end(),
                      [](const auto& a, const auto& b) { return a.first.joint < b.first.joint; });
        }
    }
    Binding binding;
    binding.joints = model.joints();
    binding.firstInfluence.push_back(0);
    for (const auto& list : influences) {
        std::uint32_t region = 0;
        for (const auto& [influence, slope] : list) {
            if (influence.bend >= 0.5f) region = influence.joint;
            binding.influences.push_back(influence);
            if (!grouped.empty()) binding.gradients.push_back(slope);
        }
        binding.regions.push_back(region);
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
    }
    binding.correctives = correctivesOf(model);
    return binding;
}

std::vector<std::uint32_t> packSkinModel(const SkinModel& model) {
    const Binding binding = bindingOf(model);
    WordWriter out;
    // As early a version as will do: older programs read it, too.
    const bool corrected = !binding.correctives.empty();
    const bool sloped = !binding.gradients.empty();
    out.put(sloped ? kSkinModelBlockVersion : std::uint32_t{corrected ? 2u : 1u});
    out.put(binding.joints.size());
    for (const BoundJoint& joint : binding.joints) {
        out.put(static_cast<std::uint32_t>(joint.parent));
        out.put(joint.name);
        out.putVector(joint.centre);
        out.putVector(joint.boneAxis);
        out.putVector(joint.twistAxis);
    }
    out.put(model.vertexCount());
    for (const glm::vec3& position : model.positions()) out.putVector(position);
    for (const glm::vec3& normal : model.normals()) out.putVector(normal);
    for (std::size_t v = 0; v < model.vertexCount(); ++v) {
        const std::uint32_t first = binding.firstInfluence[v];
        const std::uint32_t end = binding.firstInfluence[v + 1];
        out.put(end - first);
        for (std::uint32_t i = first; i < end; ++i) {
            out.put(binding.influences[i].joint);
            out.put(binding.influences[i].bend);
            out.put(binding.influences[i].twist);
        }
    }
    if (sloped) {
        putGradients(binding, out);
        out.put(std::uint32_t{corrected ? 1u : 0u});
    }
    if (corrected) putCorrectives(binding.correctives, out);
    return out.words;
}

osg::ref_ptr<const SkinModel> unpackSkinModel(const std::vector<std::uint32_t>& words) {
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
    std::vector<glm::vec3> positions = readVectors(in, vertices);
    std::vector<glm::vec3> normals = readVectors(in, vertices);
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
    if (version >= 3) {
        binding.gradients = takeGradients(in, binding.influences);
        const std::uint32_t corrected = in.word();
        if (corrected > 1) in.fail("it has neither correctives nor none");
        if (corrected == 1) binding.correctives = takeCorrectives(in, vertices);
    }
    if (version == 2) binding.correctives = takeCorrectives(in, vertices);
    if (!in.atEnd()) in.fail("there is more in it than a model");
    // Numbers, indices, ratios, axes and the tree of joints are checked there.
    return SkinModel::create(binding, std::move(positions), std::move(normals), source);
}

void unpackSkinModel(const std::vector<std::uint32_t>& words, SkinModel& empty) {
    if (empty.vertexCount() > 0) WordReader::fail("the model to be filled is not empty");
    SkinModelAccess::fill(empty, *unpackSkinModel(words));
}

} // namespace osgSkin
