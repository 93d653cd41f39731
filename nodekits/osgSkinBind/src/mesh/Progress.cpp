// SPDX-License-Identifier: GPL-3.0-or-later
#include <osgSkinBind/Progress>

namespace osgSkin {

Progress subProgress(const Progress& whole, double begin, double end, const std::string& name) {
    if (!whole) return {};
    return [whole, begin, end, prefix = name.empty() ? name : name + ": "](const ProgressStep& s) {
        whole({prefix + s.what, begin + s.fraction * (end - begin)});
    };
}

} // namespace osgSkin
