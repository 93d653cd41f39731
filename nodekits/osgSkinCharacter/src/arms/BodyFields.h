// SPDX-License-Identifier: MIT
#ifndef OSGSKINCHARACTER_ARMS_BODYFIELDS_H
#define OSGSKINCHARACTER_ARMS_BODYFIELDS_H

#include "arms/BodyPieces.h"

#include <osgSkin/GlmTypes>

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace osgSkin {

/// A regular grid of voxels.
struct VoxelGrid {
    glm::dvec3 first{0.0}; ///< the first voxel's centre
    double size = 1.0;     ///< a voxel's edge
    glm::ivec3 count{0};

    std::size_t stride(int axis) const { ///< of the voxels' memory; of axis 3: their number
        std::size_t result = 1;
        for (int a = 0; a < axis; ++a) result *= static_cast<std::size_t>(count[a]);
        return result;
    }
    std::size_t index(const glm::ivec3& at) const {
        return std::size_t(at.x) + std::size_t(at.y) * stride(1) + std::size_t(at.z) * stride(2);
    }
};

/// The signed distance to a closed piece of a body.
struct FieldSample {
    double distance = std::numeric_limits<double>::infinity(); ///< positive outside
    glm::dvec3 outward{0.0};                                   ///< its gradient
};

/// Signed distances on voxels, exact to about half a voxel, blurred over one, up to kReach voxels.
class DistanceField {
public:
    static constexpr int kReach = 18;

    DistanceField() = default;
    /// \param grid of the voxels
    /// \param inside [voxel], whether it is in the piece
    DistanceField(const VoxelGrid& grid, const std::vector<char>& inside);

    /// Infinite distance where the piece is empty.
    FieldSample at(const glm::dvec3& place) const;

private:
    VoxelGrid _grid;
    std::vector<float> _distances;
};

/// Distance fields of trunk, head and thighs at rest, for poses.
///
/// A posed point is taken back to rest by the joint of head or thigh; for the trunk by the joints
/// of hips and spine, blended about each of them.
class BodyFields {
public:
    static constexpr std::size_t kFields = 4; ///< by BodyPiece

    /// From a pose to rest.
    struct ToRest {
        glm::dmat3 turn{1.0};
        glm::dvec3 posed{0.0}, rest{0.0}; ///< one point in both
    };

    /// \param rest valid
    /// \param roles of its joints
    /// \param pieces of the body, with arms
    /// \param mesh in rest space
    /// \param binding of `mesh` to `rest`
    BodyFields(const RestSkeleton& rest, const JointRoles& roles, const BodyPieces& pieces,
               const SkinMesh& mesh, const Binding& binding);

    /// The maps of a pose, for at().
    std::vector<ToRest> maps(const PosedJoints& pose) const;

    /// The distance of a posed point.
    /// \param field less than kFields
    /// \param maps of the pose
    /// \param place in skeleton space
    FieldSample at(std::size_t field, const std::vector<ToRest>& maps,
                   const glm::dvec3& place) const;

private:
    glm::dvec3 _up{0.0};
    double _blend = 1.0;              ///< length over which two of the trunk's joints blend
    std::vector<std::size_t> _joints; ///< of head and thighs, then the trunk's upwards
    std::vector<double> _heights;     ///< of the trunk's joints
    std::array<DistanceField, kFields> _fields;
};

} // namespace osgSkin

#endif
