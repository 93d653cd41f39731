// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <cmath>

namespace osgSkin {

/// x, y, z and a spare number, or one number of four things each, in one of the processor's
/// vectors: GCC and Clang know these without naming the processor.
struct Four {
    using Vector = float __attribute__((vector_size(16)));
    using Mask = int __attribute__((vector_size(16)));

    Vector v;

    float operator[](int lane) const noexcept { return v[lane]; }
    glm::vec3 xyz() const noexcept { return {v[0], v[1], v[2]}; }
};

inline Four four(float x, float y, float z, float w) noexcept {
    const Four::Vector v = {x, y, z, w};
    return {v};
}
inline Four four(const glm::vec3& v) noexcept {
    return four(v.x, v.y, v.z, 0.0f);
}
inline Four all(float x) noexcept {
    return four(x, x, x, x);
}
inline Four operator+(const Four& a, const Four& b) noexcept {
    return {a.v + b.v};
}
inline Four operator-(const Four& a, const Four& b) noexcept {
    return {a.v - b.v};
}
inline Four operator*(const Four& a, const Four& b) noexcept {
    return {a.v * b.v};
}
inline Four operator*(float a, const Four& b) noexcept {
    return {a * b.v};
}
inline Four min(const Four& a, const Four& b) noexcept {
    return {a.v < b.v ? a.v : b.v};
}
inline Four max(const Four& a, const Four& b) noexcept {
    return {a.v > b.v ? a.v : b.v};
}
inline Four abs(const Four& a) noexcept {
    return max(a, {-a.v});
}
inline Four sqrt(const Four& a) noexcept {
    return four(std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3]));
}

/// An affine map of points.
struct FourMap {
    Four column[4];

    /// Its linear part, for directions.
    Four turn(const Four& x) const noexcept {
        return x[0] * column[0] + x[1] * column[1] + x[2] * column[2];
    }
};

inline Four operator*(const FourMap& map, const Four& x) noexcept {
    return map.turn(x) + map.column[3];
}

/// First `b`, then `a`.
inline FourMap operator*(const FourMap& a, const FourMap& b) noexcept {
    return {{a.turn(b.column[0]), a.turn(b.column[1]), a.turn(b.column[2]), a * b.column[3]}};
}

/// The rotation of a unit quaternion s + x i + y j + z k, about the origin.
inline FourMap rotation(float s, float x, float y, float z) noexcept {
    const float x2 = x + x, y2 = y + y, z2 = z + z;
    const float xx = x * x2, yy = y * y2, zz = z * z2, xy = x * y2, xz = x * z2, yz = y * z2;
    const float sx = s * x2, sy = s * y2, sz = s * z2;
    return {{four(1.0f - yy - zz, xy + sz, xz - sy, 0.0f),
             four(xy - sz, 1.0f - xx - zz, yz + sx, 0.0f),
             four(xz + sy, yz - sx, 1.0f - xx - yy, 0.0f), all(0.0f)}};
}

} // namespace osgSkin
