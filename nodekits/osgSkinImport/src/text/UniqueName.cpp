// SPDX-License-Identifier: MIT
#include "text/UniqueName.h"

namespace osgSkin {

std::string uniqueName(const std::string& wanted, std::set<std::string>& taken) {
    std::string name = wanted;
    for (int copy = 1; !taken.insert(name).second; ++copy) {
        const std::string digits = std::to_string(copy);
        name = wanted + "." + std::string(digits.size() < 3 ? 3 - digits.size() : 0, '0') + digits;
    }
    return name;
}

} // namespace osgSkin
