// SPDX-License-Identifier: MIT
#include "arms/SkinCuts.h"

#include <osgSkin/Deform>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <numeric>

namespace osgSkin {
namespace {

bool edgeCuts(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& a,
              const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    if (glm::dot(normal, from - a) * glm::dot(normal, to - a) >= 0.0) return false;
    const glm::dvec3 way = to - from;
    const double u = glm::dot(way, glm::cross(a - from, b - from));
    const double v = glm::dot(way, glm::cross(b - from, c - from));
    const double w = glm::dot(way, glm::cross(c - from, a - from));
    return (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
}

struct SkinBox {
    glm::vec3 low{std::numeric_limits<float>::infinity()}, high{-low};
    std::size_t triangle = 0;

    void add(const glm::vec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    bool meets(const SkinBox& other) const {
        return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y &&
               other.low.y <= high.y && low.z <= other.high.z && other.low.z <= high.z;
    }
};

/// The boxes of the triangles that meet a box, sorted by their lowest x.
template <typename Triangles>
std::vector<SkinBox> boxesIn(const SkinBox& room, const Triangles& triangles,
                             const std::vector<glm::vec3>& places) {
    std::vector<SkinBox> result;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        SkinBox box;
        box.triangle = i;
        for (const std::uint32_t v : triangles[i]) box.add(places[v]);
        if (box.meets(room)) result.push_back(box);
    }
    std::sort(result.begin(), result.end(),
              [](const SkinBox& a, const SkinBox& b) { return a.low.x < b.low.x; });
    return result;
}

} // namespace

SkinCuts::SkinCuts(const RestSkeleton& rest, const BodyPieces& pieces, const SkinMesh& mesh,
                   const Binding& binding) {
    std::vector<std::uint32_t> own(mesh.positions.size());
    std::iota(own.begin(), own.end(), 0u);
    const std::vector<glm::vec3> unused(own.size(), glm::vec3(0.0f, 1.0f, 0.0f));
    _model =
        SkinModel::create(binding, {mesh.positions.begin(), mesh.positions.end()}, unused, own);
    const std::vector<std::uint32_t> corners = mesh.triangles();
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        const BodyPiece piece = pieces.ofJoint[binding.regions[corners[i]]];
        const Triangle triangle{corners[i], corners[i + 1], corners[i + 2]};
        if (piece < BodyPiece::LeftArm) _body.push_back(triangle);
        if (piece == BodyPiece::LeftArm) _arms[0].push_back(triangle);
        if (piece == BodyPiece::RightArm) _arms[1].push_back(triangle);
    }
    pose(PosedJoints(rest));
    for (std::size_t arm = 0; arm < 2; ++arm) {
        const std::vector<Pair> found = pairs(arm, kAll);
        _atRest[arm].insert(found.begin(), found.end());
    }
}

void SkinCuts::pose(const PosedJoints& joints) {
    std::vector<glm::dmat4> skinning;
    for (std::size_t j = 0; j < joints.rest.size(); ++j)
        skinning.push_back(glm::translate(glm::dmat4(1.0), joints.centres[j]) *
                           glm::mat4_cast(joints.rotations[j]) *
                           glm::translate(glm::dmat4(1.0), -joints.rest[j]));
    _places = deform(*_model, skinning).positions;
}

std::vector<SkinCuts::Pair> SkinCuts::pairs(std::size_t arm, std::size_t most) const {
    SkinBox room, rest;
    for (const Triangle& triangle : _arms[arm])
        for (const std::uint32_t v : triangle) room.add(_places[v]);
    const std::vector<SkinBox> body = boxesIn(room, _body, _places);
    float widest = 0.0f;
    for (const SkinBox& box : body) {
        widest = std::max(widest, box.high.x - box.low.x);
        rest.add(box.low);
        rest.add(box.high);
    }
    std::vector<Pair> result;
    std::size_t first = 0;
    for (const SkinBox& a : boxesIn(rest, _arms[arm], _places)) {
        while (first < body.size() && body[first].low.x < a.low.x - widest) ++first;
        for (std::size_t b = first; b < body.size() && body[b].low.x <= a.high.x; ++b) {
            const Pair pair{a.triangle, body[b].triangle};
            if (result.size() >= most) return result;
            if (a.meets(body[b]) && cut(_arms[arm][pair.first], _body[pair.second]) &&
                _atRest[arm].count(pair) == 0)
                result.push_back(pair);
        }
    }
    return result;
}

bool SkinCuts::cut(const Triangle& a, const Triangle& b) const {
    for (const std::uint32_t v : a)
        if (std::find(b.begin(), b.end(), v) != b.end()) return false; // neighbours
    const auto cuts = [this](const Triangle& edges, const Triangle& face) {
        for (std::size_t k = 0; k < 3; ++k)
            if (edgeCuts(_places[edges[k]], _places[edges[(k + 1) % 3]], _places[face[0]],
                         _places[face[1]], _places[face[2]]))
                return true;
        return false;
    };
    return cuts(a, b) || cuts(b, a);
}

std::vector<glm::dvec3> SkinCuts::find(std::size_t arm, std::size_t most) const {
    std::vector<glm::dvec3> result;
    for (const Pair& pair : pairs(arm, most))
        result.emplace_back(_model->positions()[_arms[arm][pair.first].front()]);
    return result;
}

} // namespace osgSkin
