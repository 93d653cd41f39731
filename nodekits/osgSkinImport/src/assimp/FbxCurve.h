// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_ASSIMP_FBXCURVE_H
#define OSGSKINIMPORT_ASSIMP_FBXCURVE_H

#include "assimp/FbxDocument.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace osgSkin {

constexpr double kSampleStep = 1.0 / 30.0; ///< seconds between samples of curves
constexpr double kDenseKeys = 1.0 / 23.0;  ///< closer ones are nearly straight between

/// A curve of an FBX or Collada animation: one number over time, in seconds.
class FbxCurve {
public:
    struct Key {
        double time = 0.0, value = 0.0;
        enum class Kind {
            Constant,
            ConstantNext,
            Linear,
            Cubic
        } kind = Kind::Linear;                             ///< to the next
        double slope = 0.0, nextSlope = 0.0;               ///< per second: here, and at the next
        double weight = 1.0 / 3.0, nextWeight = 1.0 / 3.0; ///< of the tangents
    };

    FbxCurve() = default;
    explicit FbxCurve(const FbxRecord& curve);
    explicit FbxCurve(std::vector<Key> keys) : _keys(std::move(keys)) {}

    const std::vector<Key>& keys() const { return _keys; }

    /// The value; at a step, the new one.
    double at(double time) const;

    /// Whether the segment after a key is not a straight line.
    bool isCurved(std::size_t key) const;

private:
    void setTangents(const std::vector<double>& flags, const std::vector<double>& data,
                     const std::vector<double>& counts);

    std::vector<Key> _keys; ///< in increasing time
};

} // namespace osgSkin

#endif
