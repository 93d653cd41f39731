// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <cmath>

namespace osgSkin {

/// x, y, z and a spare number, laid out so that a compiler uses vectors of four.
struct alignas(16) Four {
    float lane[4];

    glm::vec3 xyz() const noexcept { return {lane[0], lane[1], lane[2]}; }
    Four& operator+=(float b) noexcept {
        for (float& x : lane) x += b;
        return *this;
    }
};

inline Four four(const glm::vec3& v) noexcept {
    return {{v.x, v.y, v.z, 0.0f}};
}
inline Four all(float x) noexcept {
    return {{x, x, x, x}};
}
inline Four operator+(Four a, const Four& b) noexcept {
    for (int i = 0; i < 4; ++i) a.lane[i] += b.lane[i];
    return a;
}
inline Four operator-(Four a, const Four& b) noexcept {
    for (int i = 0; i < 4; ++i) a.lane[i] -= b.lane[i];
    return a;
}
inline Four operator*(Four a, const Four& b) noexcept {
    for (int i = 0; i < 4; ++i) a.lane[i] *= b.lane[i];
    return a;
}
inline Four operator*(float a, Four b) noexcept {
    for (float& x : b.lane) x *= a;
    return b;
}
inline Four abs(Four a) noexcept {
    for (float& x : a.lane) x = std::fabs(x);
    return a;
}
inline Four sqrt(Four a) noexcept {
    for (float& x : a.lane) x = std::sqrt(x);
    return a;
}
inline Four min(Four a, const Four& b) noexcept {
    for (int i = 0; i < 4; ++i) a.lane[i] = b.lane[i] < a.lane[i] ? b.lane[i] : a.lane[i];
    return a;
}
inline Four max(Four a, const Four& b) noexcept {
    for (int i = 0; i < 4; ++i) a.lane[i] = b.lane[i] > a.lane[i] ? b.lane[i] : a.lane[i];
    return a;
}

/// An affine map of points.
struct FourMap {
    Four column[4];

    /// Its linear part, for directions.
    Four turn(const Four& x) const noexcept {
        return x.lane[0] * column[0] + x.lane[1] * column[1] + x.lane[2] * column[2];
    }
};

inline Four operator*(const FourMap& map, const Four& x) noexcept {
    return map.turn(x) + map.column[3];
}

} // namespace osgSkin
