// SPDX-License-Identifier: MIT
#include "gltf/GltfTracks.h"

#include "text/FileText.h"

#include <osgSkin/GlmTypes>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

using nlohmann::json;

constexpr double kLatest = 1e35;     ///< Assimp counts in milliseconds, and in floats
constexpr double kStep = 1.0 / 30.0; ///< seconds between samples of a spline, at most

/// Keys of one track: `width` numbers a key.
struct Keys {
    std::size_t width = 0;
    std::vector<double> times, values;

    void add(double time, const double* value) {
        times.push_back(time);
        values.insert(values.end(), value, value + width);
    }
};

/// A time as many floats earlier. Values change kChanges to kHolds before a key's own time, since
/// samples that are meant to stand there are off by a float or two, and would be half old.
constexpr int kHolds = 4, kChanges = 3;
double earlier(double time, int floats) {
    auto result = static_cast<float>(time);
    for (; floats > 0; --floats) result = std::nextafter(result, -HUGE_VALF);
    return double(result);
}

/// A value holds until the next key.
Keys fromSteps(const Keys& track) {
    Keys result{track.width, {}, {}};
    for (std::size_t k = 0; k < track.times.size(); ++k) {
        const double* value = &track.values[k * track.width];
        const double time = track.times[k];
        const bool hasRoom = k > 0 && earlier(time, kHolds) > track.times[k - 1];
        if (hasRoom) {
            result.add(earlier(time, kHolds), value - track.width);
            result.add(earlier(time, kChanges), value);
        }
        if (!hasRoom || k + 1 == track.times.size()) result.add(time, value);
    }
    return result;
}

/// Of keys that share a time, the first one is what comes before it, and the last one what follows.
Keys apart(const Keys& track) {
    Keys result{track.width, {}, {}};
    const std::vector<double>& times = track.times;
    for (std::size_t k = 0; k < times.size(); ++k) {
        const bool isFirst = k == 0 || times[k - 1] < times[k];
        const bool isLast = k + 1 == times.size() || times[k] < times[k + 1];
        double time = times[k];
        if (isFirst && !isLast) time = earlier(time, kHolds);
        if (isLast && !isFirst && !result.times.empty()) time = earlier(time, kChanges);
        const bool isNeeded = isFirst ? isLast || k > 0 : isLast;
        if (isNeeded && (result.times.empty() || time > result.times.back()))
            result.add(time, &track.values[k * track.width]);
    }
    return result;
}

/// Into how many pieces a spline is taken apart between two times, in whatever order.
double piecesOf(double from, double to) {
    return std::max(1.0, std::ceil((to - from) / kStep)); // 1 where there is no number
}

/// Cubic Hermite splines, as the specification's appendix C has them: of each key the tangent in,
/// the value, and the tangent out.
Keys fromSplines(const Keys& track, bool isRotation) {
    Keys result{track.width, {}, {}};
    const std::size_t width = track.width, last = track.times.size() - 1;
    const auto part = [&](std::size_t key, std::size_t which) {
        return &track.values[(3 * key + which) * width];
    };
    std::vector<double> value(width);
    for (std::size_t k = 0; k < last; ++k) {
        const double duration = track.times[k + 1] - track.times[k];
        const double pieces = piecesOf(track.times[k], track.times[k + 1]);
        for (double piece = 0.0; piece < pieces; piece += 1.0) {
            const double t = piece / pieces, t2 = t * t, t3 = t2 * t;
            double length = 0.0;
            for (std::size_t i = 0; i < width; ++i) {
                value[i] = (2.0 * t3 - 3.0 * t2 + 1.0) * part(k, 1)[i] +
                           duration * (t3 - 2.0 * t2 + t) * part(k, 2)[i] +
                           (3.0 * t2 - 2.0 * t3) * part(k + 1, 1)[i] +
                           duration * (t3 - t2) * part(k + 1, 0)[i];
                length += value[i] * value[i];
            }
            if (isRotation && length > 0.0)
                for (double& number : value) number /= std::sqrt(length);
            result.add(track.times[k] + t * duration, value.data());
        }
    }
    result.add(track.times[last], part(last, 1));
    return result;
}

/// Whether keys share a time, as exporters of steps write them.
bool hasTwins(const std::vector<double>& times) {
    return std::adjacent_find(times.begin(), times.end()) != times.end();
}

void checkTimes(const std::vector<double>& times, std::size_t accessor, const std::string& where) {
    for (std::size_t k = 0; k < times.size(); ++k)
        if (!(std::abs(times[k]) <= kLatest) || (k > 0 && times[k] < times[k - 1]))
            failFile(where, "accessors[" + std::to_string(accessor) + "]: key " +
                                std::to_string(k) + " is at " + std::to_string(times[k]) +
                                " seconds, expected times in order");
}

/// Tangents of splines are no less finite than the keys.
void checkKeys(const std::vector<double>& values, std::size_t width, std::size_t accessor,
               const std::string& where, bool isRotation, bool isSpline) {
    for (std::size_t k = 0; k * width < values.size(); ++k) {
        const std::string which =
            "accessors[" + std::to_string(accessor) + "]: element " + std::to_string(k);
        bool isZero = true;
        for (std::size_t i = k * width; i < (k + 1) * width; ++i) {
            if (!(std::abs(values[i]) <= kLargestCoordinate)) // nor NaN
                failFile(where,
                         which + " has " + std::to_string(values[i]) + ", expected -1e18 to 1e18");
            isZero = isZero && values[i] == 0.0;
        }
        const bool isTangent = isSpline && k % 3 != 1;
        if (isRotation && isZero && !isTangent)
            failFile(where, which + " is zero, expected a rotation");
    }
}

/// Takes a spline's pieces from those that all clips together may have.
void takePieces(const std::vector<double>& times, const std::string& where, double& left) {
    double pieces = 1.0;
    for (std::size_t k = 1; k < times.size(); ++k) pieces += piecesOf(times[k - 1], times[k]);
    if (!(pieces <= left))
        failFile(where, "a spline of " + std::to_string(times.back() - times.front()) +
                            " seconds, expected no more pieces than the file has room for "
                            "(option maxSamples)");
    left -= pieces;
}

/// Replaces a track's accessors where Assimp would read them wrongly.
void makeLinear(json& sampler, const std::string& path, const std::string& where,
                GltfAccessors& accessors, double& left) {
    const auto input = sampler.at("input").get<std::size_t>();
    const auto output = sampler.at("output").get<std::size_t>();
    const std::string interpolation = sampler.value("interpolation", "LINEAR");
    const bool isSpline = interpolation == "CUBICSPLINE", isStepped = interpolation == "STEP";
    const std::size_t keys = accessors.count(input), width = path == "rotation" ? 4 : 3;
    if (accessors.width(input) != 1 || accessors.width(output) != width ||
        accessors.count(output) != keys * (isSpline ? 3 : 1) || keys == 0)
        failFile(where, std::to_string(keys) + " keys and " +
                            std::to_string(accessors.count(output)) + " values, expected " +
                            std::to_string(width) + " numbers a key");
    const std::vector<double> times = accessors.values(input);
    checkTimes(times, input, where);
    Keys track{width, times, accessors.values(output)};
    checkKeys(track.values, width, output, where, width == 4, isSpline);
    const bool isPlain = accessors.isPlain(input) && accessors.isPlain(output);
    if (!isSpline && !isStepped && isPlain && !hasTwins(times)) return;
    if (isStepped) track = fromSteps(track);
    if (isSpline) takePieces(track.times, where, left);
    if (isSpline) track = fromSplines(track, path == "rotation");
    if (hasTwins(track.times)) track = apart(track);
    sampler["input"] = accessors.add("SCALAR", track.times);
    sampler["output"] = accessors.add(width == 4 ? "VEC4" : "VEC3", track.values);
    sampler["interpolation"] = "LINEAR";
}

bool movesANode(const json& channel) {
    const json& target = channel.at("target");
    const std::string path = target.at("path").get<std::string>();
    return target.contains("node") &&
           (path == "translation" || path == "rotation" || path == "scale");
}

} // namespace

void makeTracksLinear(GltfFile& file, GltfAccessors& accessors) {
    const auto animations = file.json.find("animations");
    if (animations == file.json.end()) return;
    bool morphs = false;
    // A track for each of many joints is usual.
    double left = 4.0 * double(file.limits.samplesOf(file.size));
    for (std::size_t a = 0; a < animations->size(); ++a) {
        json& animation = animations->at(a);
        json kept = json::array();
        std::map<std::size_t, bool>
            done; // samplers, which channels may share: whether of rotations
        for (const json& channel : animation.at("channels")) {
            morphs = morphs || channel.at("target").at("path") == "weights";
            if (!movesANode(channel)) continue;
            kept.push_back(channel);
            const auto sampler = channel.at("sampler").get<std::size_t>();
            const std::string name = animation.value("name", std::to_string(a));
            const std::string where = file.path + ": animation " + osgSkin::inQuotes(name) +
                                      ": sampler " + std::to_string(sampler);
            const std::string path = channel.at("target").at("path").get<std::string>();
            const auto [known, isNew] = done.emplace(sampler, path == "rotation");
            if (known->second != (path == "rotation"))
                failFile(where, "rotations and others, expected a sampler of one kind");
            if (isNew)
                makeLinear(animation.at("samplers").at(sampler), path, where, accessors, left);
        }
        animation["channels"] = kept;
    }
    if (morphs) tellOf(file.path, "morph targets are animated, which is not played");
    // The others stay, without a channel: clips are asked for by their numbers in the file, too.
    const auto movesNothing = [](const json& each) { return each.at("channels").empty(); };
    if (std::all_of(animations->begin(), animations->end(), movesNothing))
        file.json.erase("animations");
}

} // namespace osgSkin
