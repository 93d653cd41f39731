// SPDX-License-Identifier: MIT
#include "OlderBlock.h"

#include "model/BindingOf.h"
#include "serialize/BlockWords.h"

#include <osgSkin/Correctives>

#include <cstddef>

namespace test {
namespace {

using osgSkin::Binding;
using osgSkin::BlockWriter;
using osgSkin::CorrectiveJoint;
using osgSkin::Correctives;

void putList(const std::vector<double>& numbers, BlockWriter& out) {
    out.put(numbers.size());
    for (const double number : numbers) out.put(number);
}

void putCorrectives(const Correctives& correctives, BlockWriter& out) {
    out.put(std::uint32_t{(correctives.hasNormals() ? 1u : 0u) |
                          (correctives.inputs.empty() ? 0u : 2u)});
    if (!correctives.inputs.empty()) out.put(correctives.inputs.size());
    for (const std::string& input : correctives.inputs) out.put(input);
    out.put(correctives.joints.size());
    for (const CorrectiveJoint& joint : correctives.joints) {
        out.put(joint.joint);
        out.put(static_cast<std::uint32_t>(joint.basis));
        out.putVector(joint.axis);
        for (const glm::dvec2& range : {joint.low, joint.high}) {
            out.put(range.x);
            out.put(range.y);
        }
        putList(joint.knots, out);
        out.put(joint.modes);
        putList(joint.coefficients, out);
        putList(joint.normalScales, out);
    }
    for (std::size_t v = 0; v + 1 < correctives.firstEntry.size(); ++v) {
        const std::uint32_t first = correctives.firstEntry[v], end = correctives.firstEntry[v + 1];
        out.put(end - first);
        for (std::uint32_t i = first; i < end; ++i) {
            const Correctives::Entry& entry = correctives.entries[i];
            const std::size_t count = correctives.sharesOf(entry.joint);
            out.put(entry.joint);
            out.shorts(&correctives.shares[entry.firstShare], count);
            if (correctives.hasNormals())
                out.shorts(&correctives.normalShares[entry.firstShare], count);
        }
    }
}

void putGradients(const Binding& binding, BlockWriter& out) {
    for (std::size_t i = 0; i < binding.influences.size(); ++i) {
        if (!binding.influences[i].isPartial()) continue;
        out.putVector(binding.gradients[i].bend);
        out.putVector(binding.gradients[i].twist);
    }
}

} // namespace

std::vector<std::uint32_t> packOlderModel(const osgSkin::SkinModel& model) {
    const Binding binding = osgSkin::bindingOf(model);
    BlockWriter out;
    const bool corrected = !binding.correctives.empty();
    const bool sloped = !binding.gradients.empty();
    out.put(std::uint32_t{sloped ? 3u : corrected ? 2u : 1u});
    out.put(binding.joints.size());
    for (const osgSkin::BoundJoint& joint : binding.joints) {
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

} // namespace test
