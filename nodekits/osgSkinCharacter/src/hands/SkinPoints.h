// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkin/GlmTypes>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// Some points of a skin, each moving with one joint. Rest space.
struct SkinPoints {
    std::vector<glm::dvec3> places;
    std::vector<glm::dvec3> normals; ///< unit, outward
    std::vector<std::uint32_t> joints;

    std::size_t size() const { return places.size(); }

    /// Adds a point.
    /// \param place where it is
    /// \param normal unit
    /// \param joint that it moves with
    void add(const glm::dvec3& place, const glm::dvec3& normal, std::uint32_t joint) {
        places.push_back(place);
        normals.push_back(normal);
        joints.push_back(joint);
    }

    /// At most `most` of the points, spread evenly: farthest point sampling, always with the same
    /// result.
    /// \param most 1 or more
    /// \return those points, as they are
    SkinPoints spread(std::size_t most) const;

    /// As spread(), each of the points in the middle of those around it that move alike, and
    /// normals likewise: without the skin's small features.
    ///
    /// \param most 1 or more
    /// \return those points
    SkinPoints averaged(std::size_t most) const;
};

} // namespace osgSkin
