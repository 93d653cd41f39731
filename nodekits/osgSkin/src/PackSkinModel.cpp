// SPDX-License-Identifier: MIT
#include <osgSkin/SkinModelBlock>

#include "WordWriter.h"
#include "correctives/CorrectiveBlocks.h"
#include "correctives/CorrectivesWords.h"

namespace osgSkin {

Binding bindingOf(const SkinModel& model) {
    // Per vertex first: groups list their vertices in an order of their own.
    std::vector<std::vector<Influence>> influences(model.vertexCount());
    for (const SkinModel::Group& group : model.groups()) {
        const SkinModel::Ratio* ratio = model.ratios().data() + group.firstRatio;
        for (std::uint32_t i = 0; i < group.vertexCount; ++i) {
            std::vector<Influence>& list = influences[model.order()[group.firstVertex + i]];
            for (std::uint32_t k = 0; k < group.linkCount; ++k) {
                const SkinModel::Link& link = model.links()[group.firstLink + k];
                list.push_back({link.joint, link.partial ? ratio->bend : 1.0f,
                                link.partial ? ratio->twist : 1.0f});
                if (link.partial) ++ratio;
            }
        }
    }
    Binding binding;
    binding.joints = model.joints();
    binding.firstInfluence.push_back(0);
    for (const std::vector<Influence>& list : influences) {
        std::uint32_t region = 0;
        for (const Influence& influence : list)
            if (influence.bend >= 0.5f) region = influence.joint;
        binding.regions.push_back(region);
        binding.influences.insert(binding.influences.end(), list.begin(), list.end());
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
    }
    binding.correctives = correctivesOf(model);
    return binding;
}

std::vector<std::uint32_t> packSkinModel(const SkinModel& model) {
    const Binding binding = bindingOf(model);
    WordWriter out;
    const bool plain = binding.correctives.empty(); // then older programs read it, too
    out.put(plain ? std::uint32_t{1} : kSkinModelBlockVersion);
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
    if (!plain) putCorrectives(binding.correctives, out);
    return out.words;
}

} // namespace osgSkin
