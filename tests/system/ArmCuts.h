// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinCharacter/Character>

#include <osg/Vec3d>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace test {

/// Counts intersecting pairs of triangles, one of a forearm or hand, the other of trunk, thighs or
/// head.
class ArmCuts {
public:
    /// \param character must outlive this
    explicit ArmCuts(const osgSkin::Character& character);

    /// In the skin's current pose.
    std::size_t count();

private:
    using Triangle = std::array<std::uint32_t, 3>;
    bool cut(const Triangle& a, const Triangle& b) const;

    const osgSkin::Character& _character;
    std::vector<Triangle> _arms, _body;
    std::vector<osg::Vec3d> _places;
};

} // namespace test
