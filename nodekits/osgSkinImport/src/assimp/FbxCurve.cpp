// SPDX-License-Identifier: MIT
#include "assimp/FbxCurve.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

namespace osgSkin {
namespace {

// Of KeyAttrFlags.
constexpr unsigned kConstant = 0x2, kLinear = 0x4, kCubic = 0x8;
constexpr unsigned kNext = 0x100;   ///< with kConstant: the next key's value
constexpr unsigned kAuto = 0x100;   ///< with kCubic: tangents follow from the neighbours
constexpr unsigned kTcb = 0x200;    ///< the same, with tension, continuity and bias
constexpr unsigned kBroken = 0x800; ///< auto only on one side
constexpr unsigned kFlat = 0x4000;  ///< auto tangents do not overshoot
constexpr unsigned kWeighted = 0x1000000, kNextWeighted = 0x2000000;

/// The weights of a key's and the next key's tangents: two 16-bit numbers in one. Text files have
/// them as an integer, binary ones as the bits of a float.
std::pair<double, double> weightsOf(double stored) {
    auto bits = static_cast<std::uint32_t>(static_cast<std::int64_t>(stored));
    if (std::abs(stored) < 1.0) {
        const auto single = static_cast<float>(stored);
        std::memcpy(&bits, &single, sizeof bits);
    }
    constexpr double kWhole = 9999.0;
    return {double(bits & 0xffffu) / kWhole, double(bits >> 16u) / kWhole};
}

/// The slope at a key that follows from the keys around it.
double autoSlope(const std::vector<FbxCurve::Key>& keys, std::size_t k, bool isFlat) {
    const auto slope = [&](std::size_t from, std::size_t to) {
        const double duration = keys[to].time - keys[from].time;
        return duration > 0.0 ? (keys[to].value - keys[from].value) / duration : 0.0;
    };
    if (k == 0 || k + 1 == keys.size()) {
        if (isFlat || keys.size() < 2) return 0.0;
        return k == 0 ? slope(0, 1) : slope(k - 1, k);
    }
    const double before = slope(k - 1, k), after = slope(k, k + 1), both = slope(k - 1, k + 1);
    if (!isFlat) return both;
    if (before * after <= 0.0) return 0.0;
    const double most = 3.0 * std::min(std::abs(before), std::abs(after));
    return std::clamp(both, -most, most);
}

} // namespace

FbxCurve::FbxCurve(const FbxRecord& curve) {
    const std::vector<double>&times = curve.list("KeyTime"), &values = curve.list("KeyValueFloat");
    for (std::size_t k = 0; k < std::min(times.size(), values.size()); ++k) {
        const double time = times[k] / kFbxTicks;
        if (!std::isfinite(time) || !std::isfinite(values[k]) ||
            (!_keys.empty() && !(time > _keys.back().time)))
            continue;
        Key& key = _keys.emplace_back();
        key.time = time;
        key.value = values[k];
    }
    if (_keys.size() == times.size())
        setTangents(curve.list("KeyAttrFlags"), curve.list("KeyAttrDataFloat"),
                    curve.list("KeyAttrRefCount"));
}

void FbxCurve::setTangents(const std::vector<double>& flags, const std::vector<double>& data,
                           const std::vector<double>& counts) {
    std::vector<unsigned> own; // [key]
    std::vector<std::size_t> attributes;
    for (std::size_t a = 0; a < std::min(flags.size(), counts.size()); ++a)
        for (double c = 0.0; c < counts[a] && own.size() < _keys.size(); c += 1.0) {
            own.push_back(static_cast<unsigned>(static_cast<std::int64_t>(flags[a])));
            attributes.push_back(a);
        }
    own.resize(_keys.size(), kLinear);
    attributes.resize(_keys.size(), data.size());
    const auto dataOf = [&](std::size_t key, std::size_t which) {
        const std::size_t at = 4 * attributes[key] + which;
        return at < data.size() && std::isfinite(data[at]) ? data[at] : 0.0;
    };
    const auto isAuto = [&](std::size_t key) {
        return (own[key] & (kAuto | kTcb)) != 0 && (own[key] & kCubic) != 0;
    };
    for (std::size_t k = 0; k < _keys.size(); ++k) {
        Key& key = _keys[k];
        const unsigned flag = own[k];
        if ((flag & kConstant) != 0)
            key.kind = (flag & kNext) != 0 ? Key::Kind::ConstantNext : Key::Kind::Constant;
        if ((flag & kCubic) == 0 || k + 1 == _keys.size()) continue;
        key.kind = Key::Kind::Cubic;
        key.slope = isAuto(k) ? autoSlope(_keys, k, (flag & kFlat) != 0) : dataOf(k, 0);
        const bool isNextAuto = isAuto(k + 1) && (own[k + 1] & kBroken) == 0;
        key.nextSlope = isNextAuto  ? autoSlope(_keys, k + 1, (own[k + 1] & kFlat) != 0)
                        : isAuto(k) ? autoSlope(_keys, k + 1, (flag & kFlat) != 0)
                                    : dataOf(k, 1);
        const auto [weight, nextWeight] = weightsOf(dataOf(k, 2));
        if ((flag & kWeighted) != 0) key.weight = weight;
        if ((flag & kNextWeighted) != 0) key.nextWeight = nextWeight;
    }
}

bool FbxCurve::isCurved(std::size_t k) const {
    if (k + 1 >= _keys.size()) return false;
    const Key &key = _keys[k], &next = _keys[k + 1];
    const double slope = (next.value - key.value) / (next.time - key.time);
    const double tolerance = 1e-4 * (std::abs(slope) + 1e-6);
    return key.kind == Key::Kind::Cubic &&
           (std::abs(key.slope - slope) > tolerance || std::abs(key.nextSlope - slope) > tolerance);
}

double FbxCurve::at(double time) const {
    const auto next = std::upper_bound(_keys.begin(), _keys.end(), time,
                                       [](double t, const Key& key) { return t < key.time; });
    if (next == _keys.begin()) return _keys.front().value;
    const Key& key = *(next - 1);
    if (next == _keys.end()) return key.value;
    const double duration = next->time - key.time, share = (time - key.time) / duration;
    switch (key.kind) {
    case Key::Kind::Constant:
        return key.value;
    case Key::Kind::ConstantNext:
        return share > 0.0 ? next->value : key.value;
    case Key::Kind::Linear:
        return key.value + share * (next->value - key.value);
    case Key::Kind::Cubic:
        break;
    }
    // A Bezier curve over time, whose time is a cubic polynomial as well.
    const double w = key.weight, x = 1.0 - key.nextWeight;
    double low = 0.0, high = 1.0, t = share;
    for (int step = 0; step < 40; ++step) {
        t = step == 0 ? share : 0.5 * (low + high);
        const double s = 1.0 - t, at = t * (3.0 * s * (s * w + t * x) + t * t);
        if (std::abs(at - share) < 1e-12) break;
        (at < share ? low : high) = t;
    }
    const double s = 1.0 - t;
    const double first = key.value + key.slope * w * duration;
    const double second = next->value - key.nextSlope * key.nextWeight * duration;
    return s * s * s * key.value + 3.0 * s * t * (s * first + t * second) + t * t * t * next->value;
}

} // namespace osgSkin
