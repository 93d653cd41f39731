// SPDX-License-Identifier: MIT
#include "gltf/plain/GltfMoves.h"

#include "text/FileText.h"

#include <cstdint>
#include <set>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

using nlohmann::json;

/// Channels times nodes, for each sample that a file may ask for.
constexpr double kChannelSteps = 150.0;

} // namespace

GltfMoves::GltfMoves(GltfParts& parts, const std::string& path) : _parts(parts), _path(path) {}

void GltfMoves::check(json& result) {
    _parts.forEach("animations", [&](const json& from, const std::string& where) {
        json animation = {{"channels", json::array()}, {"samplers", json::array()}};
        _parts.copyName(from, animation);
        std::vector<std::size_t> keys;
        for (const json& sampler : from.at("samplers")) {
            const std::size_t input =
                _parts.accessor(sampler.at("input"), where + ".samplers.input");
            const std::size_t output =
                _parts.accessor(sampler.at("output"), where + ".samplers.output");
            _parts.requireType(input, {"SCALAR"}, where + ".samplers.input");
            keys.push_back(_parts.count(input) + _parts.count(output));
            const std::string way = sampler.value("interpolation", "LINEAR");
            if (way != "LINEAR" && way != "STEP" && way != "CUBICSPLINE")
                _parts.fail(where + ".samplers.interpolation",
                            "LINEAR, STEP or CUBICSPLINE, found " + inQuotes(way));
            animation["samplers"].push_back(
                {{"input", input}, {"output", output}, {"interpolation", way}});
        }
        std::set<std::pair<std::size_t, std::string>> moved;
        for (const json& channel : from.at("channels")) {
            const std::size_t sampler =
                _parts.index(channel.at("sampler"), keys.size(), where + ".channels.sampler");
            const json& target = channel.at("target");
            const auto path = target.at("path").get<std::string>();
            if (path != "translation" && path != "rotation" && path != "scale" &&
                path != "weights") {
                if (_otherPath.empty()) _otherPath = path.substr(0, 100);
                continue;
            }
            json kept = {{"path", path}};
            if (target.contains("node")) {
                kept["node"] = _parts.indexOf(target.at("node"), "nodes", where + ".channels");
                if (!moved.emplace(kept["node"].get<std::size_t>(), path).second) ++_movedTwice;
            }
            // Samplers may be shared: each channel's keys take memory.
            _parts.take(keys[sampler], where + ".channels");
            animation["channels"].push_back({{"sampler", sampler}, {"target", kept}});
        }
        _channels += animation["channels"].size();
        _parts.addEntries(animation["channels"].size());
        result["animations"].push_back(animation);
    });
    checkChannels();
    tell();
}

/// Assimp looks for each channel's node by its name, one by one.
void GltfMoves::checkChannels() const {
    const std::size_t nodes = _parts.size("nodes");
    const double steps = double(_channels) * double(nodes);
    const double most = kChannelSteps * double(_parts.limits().samplesOf(_parts.bytes()));
    if (steps > most)
        failFile(_path, std::to_string(_channels) + " animation channels of " +
                            std::to_string(nodes) + " nodes, expected at most " +
                            std::to_string(static_cast<std::uint64_t>(most / double(nodes))) +
                            " (option maxSamples)");
}

void GltfMoves::tell() const {
    if (_movedTwice > 0)
        tellOf(_path, "of animation channels that move the same of a node in one animation the "
                      "last counts; left out are " +
                          std::to_string(_movedTwice));
    if (!_otherPath.empty())
        tellOf(_path, "animation channels are left out whose path is none of translation, "
                      "rotation, scale and weights, the first " +
                          inQuotes(_otherPath));
}

} // namespace osgSkin
