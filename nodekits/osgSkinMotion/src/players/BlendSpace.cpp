// SPDX-License-Identifier: MIT
#include <osgSkinMotion/BlendSpace>

#include <osgSkin/Error>

#include <algorithm>
#include <cmath>
#include <string>

namespace osgSkin {

osg::ref_ptr<const BlendSpace> BlendSpace::create(const std::vector<Entry>& entries) {
    const auto fail = [](std::size_t i, const std::string& what) {
        throw Error("blend space: entry " + std::to_string(i) + " " + what);
    };
    if (entries.empty()) throw Error("blend space: no entry, expected at least one");
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (!entries[i].clip) fail(i, "has no clip");
        if (!std::isfinite(entries[i].place.length2())) fail(i, "has a place that is not finite");
        for (std::size_t j = 0; j < i; ++j)
            if (entries[i].place == entries[j].place)
                fail(i, "has the place of entry " + std::to_string(j));
    }
    const osg::ref_ptr<BlendSpace> result = new BlendSpace;
    result->_entries = entries;
    return result;
}

std::vector<double> BlendSpace::weights(const osg::Vec2d& place) const {
    const osg::Vec2d at = std::isfinite(place.length2()) ? place : _entries.front().place;
    std::vector<double> result;
    double sum = 0.0;
    for (const Entry& entry : _entries) {
        double weight = 1.0;
        for (const Entry& other : _entries) {
            const osg::Vec2d band = other.place - entry.place;
            if (&other != &entry)
                weight = std::min(weight, 1.0 - (at - entry.place) * band / band.length2());
        }
        result.push_back(std::max(0.0, weight));
        sum += result.back();
    }
    for (double& weight : result) weight /= sum;
    return result;
}

void BlendSpace::play(ClipPlayer& player, const osg::Vec2d& place, std::size_t firstLayer) const {
    const std::vector<double> shares = weights(place);
    double below = 0.0; // of the layers so far: each is blended over these
    for (std::size_t i = 0; i < _entries.size(); ++i) {
        const std::size_t index = firstLayer + i;
        if (player.getLayer(index).clip != _entries[i].clip) {
            ClipPlayer::Layer layer{_entries[i].clip};
            layer.inStep = true;
            player.setLayer(index, layer);
        }
        below += shares[i];
        player.fade(index, below > 0.0 ? shares[i] / below : 0.0, 0.0);
    }
}

} // namespace osgSkin
