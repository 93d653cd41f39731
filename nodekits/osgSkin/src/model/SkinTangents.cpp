// SPDX-License-Identifier: MIT
#include <osgSkin/SkinTangents>

#include <osgSkin/Error>

#include "model/SkinBlocks.h"

#include <cmath>

namespace osgSkin {

osg::ref_ptr<const SkinTangents> SkinTangents::create(const osg::ref_ptr<const SkinModel>& model,
                                                      std::vector<glm::vec4> tangents) {
    if (!model) throw Error("skin tangents: expected a model");
    if (tangents.size() != model->vertexCount())
        throw Error("skin tangents: expected " + std::to_string(model->vertexCount()) +
                    " tangents, one per vertex of the model; there are " +
                    std::to_string(tangents.size()));
    for (std::size_t v = 0; v < tangents.size(); ++v)
        for (int axis = 0; axis < 4; ++axis)
            if (!std::isfinite(tangents[v][axis]))
                throw Error("skin tangents: vertex " + std::to_string(v) +
                            " has a tangent that is not finite");
    return new SkinTangents(model, std::move(tangents));
}

SkinTangents::SkinTangents(const osg::ref_ptr<const SkinModel>& model,
                           std::vector<glm::vec4> tangents)
    : _model(model), _tangents(std::move(tangents)) {
    for (const SkinModel::Group& group : _model->groups()) {
        const glm::dmat3 frame = restFrame(*_model, group);
        const std::size_t first = _rows.size();
        const std::size_t blocks = (group.vertexCount + kBlock - 1) / kBlock;
        _rows.resize(first + blocks * SkinBlocks::kTangentRows, BlockRow{});
        for (std::uint32_t row = 0; row < group.vertexCount; ++row) {
            const glm::vec4& t = _tangents[_model->order()[group.firstVertex + row]];
            const glm::vec4 turned(glm::vec3(glm::dvec3(t) * frame), t.w); // transposed
            for (int axis = 0; axis < 4; ++axis)
                _rows[first + row / kBlock * SkinBlocks::kTangentRows + std::size_t(axis)]
                    .lane[row % kBlock] = turned[axis];
        }
    }
}

SkinTangents::~SkinTangents() = default;

} // namespace osgSkin
