// SPDX-License-Identifier: MIT
#include "arms/BodyFields.h"

#include <osgSkinRig/BodyDirections>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vector_relational.hpp>

#include <cmath>
#include <cstdint>
#include <queue>

namespace osgSkin {
namespace {

constexpr double kVoxels = 64.0; ///< along an arm
constexpr std::size_t kMaxVoxels = 4000000;
constexpr int kPad = 8;             ///< voxels around a piece
constexpr double kSpineBlend = 0.2; ///< of the arm's length

/// Calls visit(to, from) for all values of a grid that have a neighbour `offset` voxels away along
/// an axis.
template <typename Visit>
void forShifted(const VoxelGrid& grid, int axis, int offset, const Visit& visit) {
    const std::size_t stride = grid.stride(axis), row = grid.stride(axis + 1);
    const std::size_t shift = std::size_t(std::abs(offset)) * stride;
    for (std::size_t block = 0; block < grid.stride(3); block += row)
        for (std::size_t i = shift; i < row; ++i) // contiguous, so compilers vectorise it
            visit(block + i - (offset < 0 ? 0 : shift), block + i - (offset < 0 ? shift : 0));
}

/// The distance, in voxels, to the nearest voxel that is `wanted`, up to kReach.
std::vector<float> distancesTo(bool wanted, const VoxelGrid& grid,
                               const std::vector<char>& inside) {
    constexpr float kFar = float(DistanceField::kReach * DistanceField::kReach);
    std::vector<float> result(inside.size());
    for (std::size_t i = 0; i < inside.size(); ++i)
        result[i] = (inside[i] != 0) == wanted ? 0.0f : kFar;
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<float> before = result;
        for (int offset = -DistanceField::kReach; offset <= DistanceField::kReach; ++offset)
            forShifted(grid, axis, offset, [&](std::size_t to, std::size_t from) {
                result[to] = std::min(result[to], before[from] + float(offset * offset));
            });
    }
    for (float& square : result) square = std::sqrt(square);
    return result;
}

/// One pass of weights 1/4, 1/2, 1/4 along each axis.
void blur(const VoxelGrid& grid, std::vector<float>& values) {
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<float> before = values;
        for (const int offset : {-1, 1})
            forShifted(grid, axis, offset, [&](std::size_t to, std::size_t from) {
                values[to] += 0.25f * (before[from] - before[to]);
            });
    }
}

template <typename Visit>
void forEachVoxel(const glm::ivec3& low, const glm::ivec3& high, const Visit& visit) {
    glm::ivec3 at;
    for (at.z = low.z; at.z <= high.z; ++at.z)
        for (at.y = low.y; at.y <= high.y; ++at.y)
            for (at.x = low.x; at.x <= high.x; ++at.x) visit(at);
}

} // namespace

DistanceField::DistanceField(const VoxelGrid& grid, const std::vector<char>& inside) {
    glm::ivec3 low = grid.count, high(-1);
    forEachVoxel(glm::ivec3(0), grid.count - 1, [&](const glm::ivec3& at) {
        if (inside[grid.index(at)] == 0) return;
        low = glm::min(low, at);
        high = glm::max(high, at);
    });
    if (high.x < 0) return;
    low = glm::max(low - kPad, glm::ivec3(0));
    high = glm::min(high + kPad, grid.count - 1);
    _grid = {grid.first + grid.size * glm::dvec3(low), grid.size, high - low + 1};
    std::vector<char> own;
    forEachVoxel(low, high, [&](const glm::ivec3& at) { own.push_back(inside[grid.index(at)]); });
    const std::vector<float> out = distancesTo(true, _grid, own);
    const std::vector<float> in = distancesTo(false, _grid, own);
    for (std::size_t i = 0; i < own.size(); ++i) // the surface is between voxels
        _distances.push_back(float(_grid.size) * (own[i] != 0 ? 0.5f - in[i] : out[i] - 0.5f));
    blur(_grid, _distances);
    blur(_grid, _distances);
}

FieldSample DistanceField::at(const glm::dvec3& place) const {
    if (_distances.empty()) return {};
    const glm::dvec3 wanted = (place - _grid.first) / _grid.size;
    const glm::dvec3 in = glm::clamp(wanted, glm::dvec3(0.0), glm::dvec3(_grid.count) - 1.001);
    const glm::ivec3 cell(in);
    const glm::dvec3 t = in - glm::dvec3(cell);
    const std::size_t y = _grid.stride(1), z = _grid.stride(2);
    const float* const d = &_distances[_grid.index(cell)];
    // Trilinear, with its derivatives.
    const auto x00 = glm::mix<double>(d[0], d[1], t.x), x10 = glm::mix<double>(d[y], d[y + 1], t.x);
    const auto x01 = glm::mix<double>(d[z], d[z + 1], t.x);
    const auto x11 = glm::mix<double>(d[z + y], d[z + y + 1], t.x);
    const double dx0 = glm::mix<double>(d[1] - d[0], d[y + 1] - d[y], t.y);
    const double dx1 = glm::mix<double>(d[z + 1] - d[z], d[z + y + 1] - d[z + y], t.y);
    const double y0 = glm::mix(x00, x10, t.y), y1 = glm::mix(x01, x11, t.y);
    return {glm::mix(y0, y1, t.z) + glm::distance(wanted, in) * _grid.size,
            glm::dvec3(glm::mix(dx0, dx1, t.z), glm::mix(x10 - x00, x11 - x01, t.z), y1 - y0) /
                _grid.size};
}

namespace {

/// The voxels of trunk, head and thighs.
class BodyVoxels {
public:
    BodyVoxels(const SkinMesh& mesh, const std::vector<BodyPiece>& ofVertex, double size);

    /// [voxel], whether it is in a piece.
    std::vector<char> only(BodyPiece piece) const {
        std::vector<char> result(_pieces.size());
        for (std::size_t i = 0; i < result.size(); ++i)
            result[i] = _votes[i] >= 2 && _pieces[i] == piece ? 1 : 0;
        return result;
    }

    VoxelGrid grid;

private:
    void scan(const glm::dvec3 (&corners)[3], int axis, std::vector<int>& windings) const;
    void spread(const SkinMesh& mesh, const std::vector<BodyPiece>& ofVertex);

    std::vector<char> _votes; ///< of the three axes, whether a voxel is inside the body
    std::vector<BodyPiece> _pieces;
};

BodyVoxels::BodyVoxels(const SkinMesh& mesh, const std::vector<BodyPiece>& ofVertex, double size) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (std::size_t v = 0; v < ofVertex.size(); ++v)
        if (ofVertex[v] < BodyPiece::LeftArm) {
            low = glm::min(low, mesh.positions[v]);
            high = glm::max(high, mesh.positions[v]);
        }
    if (!(low.x <= high.x)) return;
    for (grid.size = size;; grid.size *= 1.2) {
        const glm::dvec3 count = glm::ceil((high - low) / grid.size) + 2.0 * kPad + 2.0;
        if (count.x * count.y * count.z > double(kMaxVoxels)) continue;
        grid.count = glm::ivec3(count);
        break;
    }
    grid.first = low - (kPad + 0.137) * grid.size; // no row of voxels passes through round numbers
    _votes.assign(grid.stride(3), 0);
    const std::vector<std::uint32_t> corners = mesh.triangles();
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<int> windings(_votes.size(), 0);
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
            glm::dvec3 triangle[3];
            for (std::size_t k = 0; k < 3; ++k)
                triangle[k] = (mesh.positions[corners[i + k]] - grid.first) / grid.size;
            scan(triangle, axis, windings);
        }
        // How often the surface is entered on the way to each voxel along the axis.
        forShifted(grid, axis, -1,
                   [&](std::size_t to, std::size_t from) { windings[to] += windings[from]; });
        for (std::size_t i = 0; i < _votes.size(); ++i)
            _votes[i] = char(_votes[i] + (windings[i] != 0));
    }
    spread(mesh, ofVertex);
}

/// Counts where lines along an axis, through voxels' centres, cross a triangle.
void BodyVoxels::scan(const glm::dvec3 (&p)[3], int axis, std::vector<int>& windings) const {
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    const auto area = [&](const glm::dvec3& q, const glm::dvec3& r, const glm::dvec3& s) {
        return (r[b] - q[b]) * (s[c] - q[c]) - (r[c] - q[c]) * (s[b] - q[b]);
    };
    const double whole = area(p[0], p[1], p[2]);
    if (whole == 0.0) return;
    const glm::dvec3 end(grid.count);
    const glm::ivec3 low(
        glm::clamp(glm::ceil(glm::min(p[0], glm::min(p[1], p[2]))), glm::dvec3(0.0), end));
    const glm::ivec3 high(
        glm::clamp(glm::floor(glm::max(p[0], glm::max(p[1], p[2]))), glm::dvec3(-1.0), end - 1.0));
    glm::ivec3 at;
    for (at[b] = low[b]; at[b] <= high[b]; ++at[b])
        for (at[c] = low[c]; at[c] <= high[c]; ++at[c]) {
            const glm::dvec3 q(at);
            const double u = area(q, p[1], p[2]) / whole, v = area(p[0], q, p[2]) / whole;
            if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
            const double crossing = u * p[0][axis] + v * p[1][axis] + (1.0 - u - v) * p[2][axis];
            if (crossing > end[axis] - 1.0) continue;
            at[axis] = int(std::ceil(std::max(0.0, crossing)));
            windings[grid.index(at)] += whole < 0.0 ? 1 : -1;
        }
}

/// Gives each voxel inside the piece of the vertex from which the way within is shortest.
void BodyVoxels::spread(const SkinMesh& mesh, const std::vector<BodyPiece>& ofVertex) {
    std::vector<char> known(_votes.size(), 0);
    _pieces.assign(_votes.size(), BodyPiece::Other);
    std::queue<glm::ivec3> reached;
    const auto reach = [&](const glm::ivec3& at, BodyPiece piece) {
        const std::size_t i = grid.index(at);
        if (known[i] != 0) return;
        known[i] = 1;
        _pieces[i] = piece;
        reached.push(at);
    };
    for (std::size_t v = 0; v < ofVertex.size(); ++v) {
        const glm::dvec3 at = glm::round((mesh.positions[v] - grid.first) / grid.size);
        if (glm::all(glm::greaterThanEqual(at, glm::dvec3(0.0))) &&
            glm::all(glm::lessThan(at, glm::dvec3(grid.count))))
            reach(glm::ivec3(at), ofVertex[v]);
    }
    for (; !reached.empty(); reached.pop())
        for (int axis = 0; axis < 3; ++axis)
            for (const int step : {-1, 1}) {
                glm::ivec3 at = reached.front();
                at[axis] += step;
                if (at[axis] >= 0 && at[axis] < grid.count[axis] && _votes[grid.index(at)] >= 2)
                    reach(at, _pieces[grid.index(reached.front())]);
            }
}

} // namespace

BodyFields::BodyFields(const RestSkeleton& rest, const JointRoles& roles, const BodyPieces& pieces,
                       const SkinMesh& mesh, const Binding& binding)
    : _up(BodyDirections(roles, PosedJoints(rest).centres).between("Hips", "Head")),
      _blend(kSpineBlend * pieces.armLength()) {
    for (const char* role : {"Head", "LeftUpperLeg", "RightUpperLeg"})
        _joints.push_back(static_cast<std::size_t>(std::max(0, roles.joint(role))));
    for (const char* role : {"Hips", "Spine"}) {
        const auto found = roles.joints.find(role);
        if (found == roles.joints.end()) continue;
        for (const int joint : found->second) {
            _joints.push_back(static_cast<std::size_t>(joint));
            _heights.push_back(glm::dot(_up, rest.joints[_joints.back()].centre));
        }
    }
    std::vector<BodyPiece> ofVertex;
    for (const std::uint32_t region : binding.regions) ofVertex.push_back(pieces.ofJoint[region]);
    const BodyVoxels voxels(mesh, ofVertex, pieces.armLength() / kVoxels);
    for (std::size_t field = 0; field < kFields; ++field)
        _fields[field] = DistanceField(voxels.grid, voxels.only(static_cast<BodyPiece>(field)));
}

std::vector<BodyFields::ToRest> BodyFields::maps(const PosedJoints& pose) const {
    std::vector<ToRest> result;
    for (const std::size_t j : _joints)
        result.push_back(
            {glm::mat3_cast(glm::conjugate(pose.rotations[j])), pose.centres[j], pose.rest[j]});
    return result;
}

FieldSample BodyFields::at(std::size_t field, const std::vector<ToRest>& maps,
                           const glm::dvec3& place) const {
    FieldSample sum{0.0};
    double weights = 0.0;
    const std::size_t spine = maps.size() - _heights.size();
    const auto share = [&](const glm::dvec3& at, std::size_t joint) { // of the joint and above
        return glm::smoothstep(-0.5, 0.5, (glm::dot(_up, at) - _heights[joint]) / _blend);
    };
    for (std::size_t k = field > 0 ? field - 1 : spine; k < (field > 0 ? field : maps.size());
         ++k) {
        const glm::dvec3 at = maps[k].turn * (place - maps[k].posed) + maps[k].rest;
        double weight = 1.0;
        if (k > spine) weight *= share(at, k - spine);
        if (k >= spine && k + 1 < maps.size()) weight *= 1.0 - share(at, k + 1 - spine);
        if (!(weight > 0.0)) continue;
        const FieldSample found = _fields[field].at(at);
        sum.distance += weight * found.distance;
        sum.outward += weight * (found.outward * maps[k].turn); // back to the pose
        weights += weight;
    }
    if (!(weights > 0.0)) return {};
    return {sum.distance / weights, sum.outward / weights};
}

} // namespace osgSkin
