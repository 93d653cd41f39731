// SPDX-License-Identifier: MIT
#include <osgSkinBind/Progress>

namespace osgSkin {

Progress subProgress(const Progress& whole, double begin, double end, const std::string& name) {
    if (!whole) return {};
    return [whole, begin, end, prefix = name.empty() ? name : name + ": "](const ProgressStep& s) {
        // Exact at both ends, so that progress never seems to decrease.
        whole({prefix + s.what, (1.0 - s.fraction) * begin + s.fraction * end});
    };
}

} // namespace osgSkin
