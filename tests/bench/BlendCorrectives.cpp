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
        std::map<std::uint32_t, std::vector<double>> sums; // joint -> shares
        for (std::size_t k = 0; k < 3; ++k) {
            if (vertex.share[k] == 0.0) continue;
            const std::uint32_t v = vertex.corner[k];
            for (std::uint32_t i = correctives.firstEntry[v]; i < correctives.firstEntry[v + 1];
                 ++i) {
                const osgSkin::Correctives::Entry& entry = correctives.entries[i];
                std::vector<double>& sum = sums[entry.joint];
                sum.resize(correctives.sharesOf(entry.joint), 0.0);
                for (std::size_t s = 0; s < sum.size(); ++s)
                    sum[s] += vertex.share[k] * correctives.shares[entry.firstShare + s];
            }
        }
        for (const auto& [joint, sum] : sums) {
            result.entries.push_back({joint, static_cast<std::uint32_t>(result.shares.size())});
            for (const double share : sum)
                result.shares.push_back(static_cast<std::int16_t>(std::lrint(share)));
        }
        result.firstEntry.push_back(static_cast<std::uint32_t>(result.entries.size()));
    }
    return result;
}

} // namespace bench
