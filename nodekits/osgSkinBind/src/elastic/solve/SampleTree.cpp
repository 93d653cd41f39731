// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/solve/SampleTree.h"

#include <algorithm>
#include <numeric>

namespace osgSkin::elastic {

SampleTree::SampleTree(const std::vector<Eigen::Quaterniond>& rotations)
    : _following(rotations.size() + 1) {
    const Eigen::Quaterniond rest = Eigen::Quaterniond::Identity();
    std::vector<double> angles;
    angles.reserve(rotations.size());
    for (const Eigen::Quaterniond& rotation : rotations)
        angles.push_back(rest.angularDistance(rotation));
    std::vector<std::size_t> order(rotations.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&angles](std::size_t a, std::size_t b) { return angles[a] < angles[b]; });
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::size_t sample = order[i];
        std::size_t from = rotations.size();
        double nearest = angles[sample];
        for (std::size_t k = 0; k < i; ++k) {
            const double away = rotations[order[k]].angularDistance(rotations[sample]);
            if (away >= nearest) continue;
            nearest = away;
            from = order[k];
        }
        _following[from].push_back(sample);
    }
}

const std::vector<std::size_t>& SampleTree::startingFrom(std::size_t sample) const {
    return sample == kRest ? _following.back() : _following[sample];
}

} // namespace osgSkin::elastic
