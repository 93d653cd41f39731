// SPDX-License-Identifier: GPL-3.0-or-later
#include "source/MeshWeights.h"

#include <osgSkin/Error>

#include <map>

namespace osgSkin {

VertexWeights meshWeights(const std::string& file, const ImportedMesh& body,
                          const RestSkeleton& skeleton) {
    if (body.weights.empty())
        throw Error(file + ": the mesh carries no weights, expected bones with weights in it, or "
                           "a file of weights named by \"weights\"");
    VertexWeights result(body.mesh.positions.size());
    const std::map<std::string, int> jointOf = skeleton.byName();
    for (const BoneWeights& bone : body.weights) {
        const auto joint = jointOf.find(bone.bone);
        if (joint == jointOf.end())
            throw Error(file + ": bone \"" + bone.bone +
                        "\" has weights, expected the name of a joint of the skeleton");
        for (const BoneWeights::Entry& entry : bone.entries)
            result[entry.vertex].push_back(
                {static_cast<std::uint32_t>(joint->second), entry.weight});
    }
    return result;
}

} // namespace osgSkin
