// SPDX-License-Identifier: MIT
#include "BlendCorrectives.h"

#include <cmath>
#include <map>

namespace bench {

osgSkin::Correctives blend(const osgSkin::Correctives& correctives,
                           const std::vector<Blend>& vertices) {
    osgSkin::Correctives result;
    if (correctives.empty()) return result;
    result.joints = correctives.joints;
    result.firstEntry.push_back(0);
    for (const Blend& vertex : vertices) {
        struct Sums {
            std::vector<double> shares, normalShares;
        };
        std::map<std::uint32_t, Sums> sums; // by joint
        for (std::size_t k = 0; k < 3; ++k) {
            if (vertex.share[k] == 0.0) continue;
            const std::uint32_t v = vertex.corner[k];
            for (std::uint32_t i = correctives.firstEntry[v]; i < correctives.firstEntry[v + 1];
                 ++i) {
                const osgSkin::Correctives::Entry& entry = correctives.entries[i];
                const auto add = [&](const std::vector<std::int16_t>& from,
                                     std::vector<double>& sum) {
                    if (from.empty()) return;
                    sum.resize(correctives.sharesOf(entry.joint), 0.0);
                    for (std::size_t s = 0; s < sum.size(); ++s)
                        sum[s] += vertex.share[k] * from[entry.firstShare + s];
                };
                add(correctives.shares, sums[entry.joint].shares);
                add(correctives.normalShares, sums[entry.joint].normalShares);
            }
        }
        for (const auto& [joint, sum] : sums) {
            result.entries.push_back({joint, static_cast<std::uint32_t>(result.shares.size())});
            for (const double share : sum.shares)
                result.shares.push_back(static_cast<std::int16_t>(std::lrint(share)));
            for (const double share : sum.normalShares)
                result.normalShares.push_back(static_cast<std::int16_t>(std::lrint(share)));
        }
        result.firstEntry.push_back(static_cast<std::uint32_t>(result.entries.size()));
    }
    return result;
}

} // namespace bench
