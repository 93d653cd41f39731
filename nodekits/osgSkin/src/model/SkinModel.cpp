// SPDX-License-Identifier: MIT
#include <osgSkin/SkinModel>

#include "model/BoundsProxy.h"
#include "model/CorrectiveBlocks.h"
#include "model/GradientBlocks.h"
#include "model/SkinBlocks.h"
#include "model/VertexGroups.h"

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>

#include <glm/geometric.hpp>

namespace osgSkin {
namespace {

/// The ratios of a group's vertices, those of partial joints only.
void addRatios(const VertexGroups& vertices, const VertexGroups::Group& group,
               std::vector<SkinModel::Ratio>& ratios) {
    const Binding& binding = vertices.binding();
    for (std::uint32_t k = 0; k < group.vertexCount; ++k) {
        const std::uint32_t s = vertices.source()[vertices.order()[group.firstVertex + k]];
        for (const VertexGroups::Joint& joint : group.joints) {
            if (!joint.partial) continue;
            const Influence* own = influenceOf(binding, s, joint.index);
            ratios.push_back(own ? SkinModel::Ratio{own->bend, own->twist}
                                 : SkinModel::Ratio{0.0f, 0.0f});
        }
    }
}

/// Products of longer normals leave single precision.
constexpr float kLongestNormal = 10.0f;

/// Written so that NaN is refused.
void checkVertices(const std::vector<glm::vec3>& positions, const std::vector<glm::vec3>& normals,
                   const std::vector<std::uint32_t>& source) {
    if (positions.size() != source.size() || normals.size() != source.size())
        throw Error("skin model: expected one position, one normal and one source per vertex");
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const bool isPlace = isInRange(positions[v]);
        if (isPlace && glm::length(normals[v]) <= kLongestNormal) continue;
        throw Error("skin model: vertex " + std::to_string(v) +
                    (isPlace ? " has a normal that is not finite, or longer than 10"
                             : " has a position that is not finite, or beyond -1e18 to 1e18"));
    }
}

std::vector<glm::vec3> gather(const std::vector<glm::vec3>& vectors,
                              const std::vector<std::uint32_t>& order) {
    std::vector<glm::vec3> result;
    result.reserve(order.size());
    for (const std::uint32_t v : order) result.push_back(vectors[v]);
    return result;
}

} // namespace

std::vector<std::uint32_t> SkinModel::bestOrder(const Binding& binding,
                                                const std::vector<std::uint32_t>& source) {
    return VertexGroups(binding, source).order();
}

SkinModel::SkinModel() : _blocks(std::make_shared<SkinBlocks>(*this)) {}

// What the two share of it never changes.
SkinModel::SkinModel(const SkinModel& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), _joints(other._joints), _positions(other._positions),
      _normals(other._normals), _order(other._order), _groups(other._groups), _links(other._links),
      _ratios(other._ratios), _blocks(other._blocks), _boundsProxy(other._boundsProxy),
      _correctives(other._correctives), _gradients(other._gradients) {}

SkinModel::~SkinModel() = default;

const std::vector<std::string>& SkinModel::inputs() const {
    static const std::vector<std::string> none;
    return _correctives ? _correctives->inputs : none;
}

Correctives SkinModel::correctives() const {
    return correctivesOf(*this);
}

osg::ref_ptr<const SkinModel> SkinModel::create(const Binding& binding,
                                                std::vector<glm::vec3> positions,
                                                std::vector<glm::vec3> normals,
                                                const std::vector<std::uint32_t>& source) {
    checkVertices(positions, normals, source);
    const osg::ref_ptr<SkinModel> model =
        arrange(VertexGroups(binding, source), std::move(positions), std::move(normals));
    model->_boundsProxy = makeBoundsProxy(*model);
    return model;
}

osg::ref_ptr<const SkinModel> SkinModel::create(const Binding& binding,
                                                const osg::Vec3Array* positions,
                                                const osg::Vec3Array* normals,
                                                const std::vector<std::uint32_t>& source) {
    if (!positions || !normals)
        throw Error("skin model: expected an array of positions and one of normals");
    const glm::vec3* p = asGlm(positions->asVector().data());
    const glm::vec3* n = asGlm(normals->asVector().data());
    return create(binding, {p, p + positions->size()}, {n, n + normals->size()}, source);
}

SkinModel::Ordered SkinModel::createInBestOrder(const Binding& binding,
                                                const std::vector<glm::vec3>& positions,
                                                const std::vector<glm::vec3>& normals,
                                                const std::vector<std::uint32_t>& source) {
    checkVertices(positions, normals, source);
    VertexGroups vertices(binding, source);
    const std::vector<std::uint32_t> order = vertices.order();
    vertices.reorder();
    const osg::ref_ptr<SkinModel> model =
        arrange(vertices, gather(positions, order), gather(normals, order));
    model->_boundsProxy = makeBoundsProxy(*model);
    return {model, order};
}

osg::ref_ptr<SkinModel> SkinModel::arrange(const VertexGroups& vertices,
                                           std::vector<glm::vec3> positions,
                                           std::vector<glm::vec3> normals) {
    osg::ref_ptr<SkinModel> model = new SkinModel;
    model->_joints = vertices.binding().joints;
    model->_positions = std::move(positions);
    model->_normals = std::move(normals);
    model->_order = vertices.order();
    for (const VertexGroups::Group& grouped : vertices.groups()) {
        Group group{};
        group.firstVertex = grouped.firstVertex;
        group.vertexCount = grouped.vertexCount;
        group.firstLink = static_cast<std::uint32_t>(model->_links.size());
        group.linkCount = static_cast<std::uint32_t>(grouped.joints.size());
        group.firstRatio = static_cast<std::uint32_t>(model->_ratios.size());
        for (const VertexGroups::Joint& joint : grouped.joints) {
            model->_links.push_back({joint.index, joint.partial});
            group.partialCount += joint.partial ? 1u : 0u;
        }
        model->_groups.push_back(group);
        addRatios(vertices, grouped, model->_ratios);
    }
    model->_blocks = std::make_shared<SkinBlocks>(*model);
    if (!vertices.binding().gradients.empty())
        model->_gradients =
            std::make_shared<GradientBlocks>(*model, vertices.binding(), vertices.source());
    if (!vertices.binding().correctives.empty()) // which look at the gradients
        model->_correctives =
            std::make_shared<CorrectiveBlocks>(*model, vertices.binding(), vertices.source());
    return model;
}

} // namespace osgSkin
