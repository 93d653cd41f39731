// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <cmath>

namespace osgSkin {

#ifdef __GNUC__
/// A vector register, by an extension of GCC and Clang.
using FourFloats = float __attribute__((vector_size(16)));
#else
/// The same in plain C++, for other compilers.
struct FourFloats {
    float lane[4];

    float operator[](int i) const noexcept { return lane[i]; }
    float& operator[](int i) noexcept { return lane[i]; }
};
template <class F>
FourFloats eachLane(F f) noexcept {
    return {{f(0), f(1), f(2), f(3)}};
}
inline FourFloats operator+(const FourFloats& a, const FourFloats& b) noexcept {
    return eachLane([&](int i) { return a[i] + b[i]; });
}
inline FourFloats operator-(const FourFloats& a, const FourFloats& b) noexcept {
    return eachLane([&](int i) { return a[i] - b[i]; });
}
inline FourFloats operator-(const FourFloats& a) noexcept {
    return eachLane([&](int i) { return -a[i]; });
}
inline FourFloats operator*(const FourFloats& a, const FourFloats& b) noexcept {
    return eachLane([&](int i) { return a[i] * b[i]; });
}
inline FourFloats operator*(float a, const FourFloats& b) noexcept {
    return eachLane([&](int i) { return a * b[i]; });
}
#endif

/// x, y, z and a spare number, or four numbers.
struct Four {
    FourFloats v;

    float operator[](int lane) const noexcept { return v[lane]; }
    glm::vec3 xyz() const noexcept { return {v[0], v[1], v[2]}; }
};

inline Four four(float x, float y, float z, float w) noexcept {
    const FourFloats v = {x, y, z, w};
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
#ifdef __GNUC__
    return {a.v < b.v ? a.v : b.v};
#else
    return {eachLane([&](int i) { return a[i] < b[i] ? a[i] : b[i]; })};
#endif
}
inline Four max(const Four& a, const Four& b) noexcept {
#ifdef __GNUC__
    return {a.v > b.v ? a.v : b.v};
#else
    return {eachLane([&](int i) { return a[i] > b[i] ? a[i] : b[i]; })};
#endif
}
inline Four abs(const Four& a) noexcept {
    return max(a, {-a.v});
}
inline Four sqrt(const Four& a) noexcept {
    return four(std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3]));
}

/// An affine map.
struct FourMap {
    Four column[4];

    /// Applies the linear part.
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

/// The rotation of a unit quaternion q[3] + q[0] i + q[1] j + q[2] k, about the origin.
inline FourMap rotation(const Four& q) noexcept {
    // 2 q_i q + 2 q_w (q_w e_i + q x e_i) - e_i; the spare number is 0.
    const Four x = four(q[0], q[1], q[2], 0.0f);
    const Four twice = x + x, w = all(q[3] + q[3]);
    return {{twice[0] * x + w * four(q[3], q[2], -q[1], 0.0f) - four(1.0f, 0.0f, 0.0f, 0.0f),
             twice[1] * x + w * four(-q[2], q[3], q[0], 0.0f) - four(0.0f, 1.0f, 0.0f, 0.0f),
             twice[2] * x + w * four(q[1], -q[0], q[3], 0.0f) - four(0.0f, 0.0f, 1.0f, 0.0f),
             all(0.0f)}};
}

/// Sines and cosines of two angles up to pi: (sin a, sin b, cos a, cos b), within 1e-7.
inline Four sinesAndCosines(float a, float b) noexcept {
    constexpr float pi = 3.14159265f;
    // cos x = sin(pi / 2 - x); from a quarter turn on, sin x = sin(pi - x).
    const Four x = four(a, b, 0.5f * pi - a, 0.5f * pi - b);
    const Four h = max(min(x, all(pi) - x), all(-pi) - x);
    const Four t = h * h;
    // Minimax for sin(h) / h up to pi / 2.
    constexpr float c[] = {9.9999997659e-01f, -1.6666647633e-01f, 8.3328997978e-03f,
                           -1.9800896183e-04f, 2.5904852963e-06f};
    Four sum = all(c[4]);
    for (int i = 3; i >= 0; --i) sum = sum * t + all(c[i]);
    return h * sum;
}

} // namespace osgSkin
