// SPDX-License-Identifier: MIT
#include "scene/SceneMorphs.h"

#include "files/FileText.h"

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

using Lists = std::vector<glm::vec3> MorphTarget::*;

/// Exporters compute offsets from coordinates in single precision.
constexpr float kRounding = 2.5e-7f; ///< relative to the largest coordinate
constexpr float kTurned = 1e-4f;     ///< a change of a normal or a tangent that counts

/// Adds the vertices that are moved farther than `min`, in increasing order.
void addMoved(const VertexOffsets& from, float min, std::vector<std::uint32_t>& vertices) {
    const std::size_t before = vertices.size();
    for (std::size_t i = 0; i < from.vertices.size(); ++i) {
        const glm::vec3& offset = from.offsets[i];
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(offset[axis]) <= min)) { // also NaN, which is refused later
                vertices.push_back(from.vertices[i]);
                break;
            }
    }
    if (before == 0) return;
    std::inplace_merge(vertices.begin(), vertices.begin() + std::ptrdiff_t(before), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
}

/// The offsets of `vertices`, zero where there is none; none at all if there are none.
std::vector<glm::vec3> offsetsOf(const VertexOffsets& from,
                                 const std::vector<std::uint32_t>& vertices) {
    std::vector<glm::vec3> result;
    if (from.vertices.empty()) return result;
    result.reserve(vertices.size());
    std::size_t at = 0;
    for (const std::uint32_t vertex : vertices) {
        while (at < from.vertices.size() && from.vertices[at] < vertex) ++at;
        const bool isMoved = at < from.vertices.size() && from.vertices[at] == vertex;
        result.push_back(isMoved ? from.offsets[at] : glm::vec3(0.0f));
    }
    return result;
}

} // namespace

MorphNames::MorphNames(const std::vector<std::string>& taken) {
    for (const std::string& name : taken) _taken.take(name);
}

std::vector<std::string> MorphNames::of(const std::vector<std::string>& wanted,
                                        const std::vector<float>& initial) {
    std::vector<std::string> result;
    std::map<std::string, std::size_t> copies; // in this mesh
    for (std::size_t t = 0; t < wanted.size(); ++t) {
        std::string& name = _known[{wanted[t], copies[wanted[t]]++, initial[t]}];
        if (name.empty()) {
            name = _taken.unique(wanted[t]);
            if (name != wanted[t] && _renamed++ == 0) _first = name;
        }
        result.push_back(name);
    }
    return result;
}

void MorphNames::warnRenamed(const std::string& path) const {
    if (_renamed > 0)
        warn(path, "morph targets or expressions share names; " + std::to_string(_renamed) +
                       " were renamed, the first to " + inQuotes(_first));
}

MorphFiller::MorphFiller(const SourceMesh& mesh) {
    for (const glm::vec3& p : mesh.positions)
        for (int axis = 0; axis < 3; ++axis)
            _rounding = std::max(_rounding, kRounding * std::abs(p[axis]));
}

void MorphFiller::fill(const VertexOffsets& positions, const VertexOffsets& normals,
                       const VertexOffsets& tangents, MorphTarget& target) const {
    target.vertices.clear();
    addMoved(positions, _rounding, target.vertices);
    addMoved(normals, kTurned, target.vertices);
    addMoved(tangents, kTurned, target.vertices);
    target.vertices.shrink_to_fit();
    target.positions = offsetsOf(positions, target.vertices);
    target.positions.resize(target.vertices.size());
    target.normals = offsetsOf(normals, target.vertices);
    target.tangents = offsetsOf(tangents, target.vertices);
}

MorphTarget sumOf(const std::vector<std::pair<const MorphTarget*, double>>& parts) {
    MorphTarget result;
    std::vector<std::uint32_t>& all = result.vertices;
    for (const auto& [part, weight] : parts)
        all.insert(all.end(), part->vertices.begin(), part->vertices.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (const Lists lists :
         {&MorphTarget::positions, &MorphTarget::normals, &MorphTarget::tangents}) {
        std::vector<glm::dvec3> sums;
        for (const auto& [part, weight] : parts) {
            const std::vector<glm::vec3>& offsets = part->*lists;
            if (offsets.empty()) continue;
            sums.resize(all.size(), glm::dvec3(0.0));
            auto at = all.begin();
            for (std::size_t i = 0; i < offsets.size(); ++i) {
                at = std::lower_bound(at, all.end(), part->vertices[i]);
                sums[std::size_t(at - all.begin())] += weight * glm::dvec3(offsets[i]);
            }
        }
        (result.*lists).assign(sums.begin(), sums.end());
    }
    return result;
}

} // namespace osgSkin
