// SPDX-License-Identifier: MIT
#pragma once

#include "model/SkinBlocks.h"

#include <osgSkin/SkinModel>
#include <osgSkin/SkinTangents>

#include <utility>

namespace osgSkin {

/// What the deformation reads of a model and its tangents, and no application needs.
struct SkinModelAccess {
    /// The vertices as DeformJob's fast path reads them.
    static const SkinBlocks& blocks(const SkinModel& model) { return *model._blocks; }

    /// What computePoseBounds() poses; null for a skin without vertices.
    static const BoundsProxy* boundsProxy(const SkinModel& model) {
        return model._boundsProxy.get();
    }

    /// The correctives as DeformJob reads them; null where there are none.
    static const CorrectiveBlocks* correctives(const SkinModel& model) {
        return model._correctives.get();
    }

    /// The ratios' gradients as DeformJob reads them; null where there are none.
    static const GradientBlocks* gradients(const SkinModel& model) {
        return model._gradients.get();
    }

    /// The tangents, SkinBlocks::kTangentRows rows for each of the model's blocks.
    static const BlockRow* blocks(const SkinTangents& tangents) { return tangents._rows.data(); }

    /// A model without a bounds proxy, as the proxy itself is one.
    static osg::ref_ptr<SkinModel> arrange(const VertexGroups& vertices,
                                           std::vector<glm::vec3> positions,
                                           std::vector<glm::vec3> normals) {
        return SkinModel::arrange(vertices, std::move(positions), std::move(normals));
    }

    /// Gives `empty`, which a reader of files had to make first, all that `model` holds.
    static void fill(SkinModel& empty, const SkinModel& model) {
        empty._joints = model._joints;
        empty._positions = model._positions;
        empty._normals = model._normals;
        empty._order = model._order;
        empty._groups = model._groups;
        empty._links = model._links;
        empty._ratios = model._ratios;
        empty._blocks = model._blocks;
        empty._boundsProxy = model._boundsProxy;
        empty._correctives = model._correctives;
        empty._gradients = model._gradients;
    }
};

} // namespace osgSkin
