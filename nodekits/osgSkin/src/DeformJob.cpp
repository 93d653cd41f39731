// SPDX-License-Identifier: MIT
#include <osgSkin/DeformJob>

#include "Chain.h"
#include "DeformKernel.h"
#include "KernelChain.h"

namespace osgSkin {

const char* DeformJob::validate() const noexcept {
    if (!model) return "no model";
    if (!pose) return "no pose";
    if (pose->size() != model->joints().size()) return "the pose is not one of the model's joints";
    if (!positions) return "no output for positions";
    if (positionCount != model->vertexCount()) return "as many positions as vertices are needed";
    if (normals && normalCount != model->vertexCount())
        return "as many normals as vertices are needed";
    if (!tangents) return nullptr;
    if (!normals) return "tangents are turned beside normals only";
    if (!restTangents) return "no rest tangents";
    if (restTangents->model().get() != model) return "the rest tangents are another model's";
    if (tangentCount != model->vertexCount()) return "as many tangents as vertices are needed";
    return nullptr;
}

bool DeformJob::run() const noexcept {
    if (validate()) return false;
    const SkinBlocks& blocks = model->blocks();
    KernelChain chain(*model, *pose);
    KernelCall call;
    for (std::size_t g = 0; g < model->groups().size(); ++g) {
        const SkinModel::Group& group = model->groups()[g];
        chain.prepare(group, call);
        const std::size_t first = blocks.inOrder ? group.firstVertex : 0;
        call.rows = blocks.rows.data() + blocks.firstRow[g];
        call.vertexCount = group.vertexCount;
        call.room = model->vertexCount() - group.firstVertex;
        call.scatter = blocks.inOrder ? nullptr : model->order().data() + group.firstVertex;
        call.positions = &positions[first].x;
        call.normals = normals ? &normals[first].x : nullptr;
        call.tangents = tangents ? &tangents[first].x : nullptr;
        call.tangentRows = tangents ? restTangents->blocks(g) : nullptr;
        runKernel(call);
    }
    return true;
}

bool DeformJob::runReference() const noexcept {
    if (validate()) return false;
    for (const SkinModel::Group& group : model->groups()) {
        const Chain chain(*model, group, *pose);
        const SkinModel::Ratio* ratios = model->ratios().data() + group.firstRatio;
        const std::uint32_t* order = model->order().data() + group.firstVertex;
        for (std::uint32_t i = 0; i < group.vertexCount; ++i, ratios += group.partialCount) {
            const std::uint32_t v = order[i];
            glm::vec3 position = model->positions()[v];
            glm::vec3 normal = model->normals()[v];
            const glm::vec4 rest = tangents ? restTangents->tangents()[v] : glm::vec4(0.0f);
            glm::vec3 tangent(rest);
            chain.apply(ratios, position, normals ? &normal : nullptr,
                        tangents ? &tangent : nullptr);
            positions[v] = position;
            if (normals) normals[v] = normal;
            if (tangents) tangents[v] = glm::vec4(tangent, rest.w);
        }
    }
    return true;
}

} // namespace osgSkin
