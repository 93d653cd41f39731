// SPDX-License-Identifier: MIT
#include "files/UniqueName.h"

namespace osgSkin {

std::string UniqueNames::unique(const std::string& wanted) {
    if (take(wanted)) return wanted;
    for (int& copy = _copies[wanted];;) {
        const std::string digits = std::to_string(++copy);
        const std::string padding(digits.size() < 3 ? 3 - digits.size() : 0, '0');
        std::string name = wanted;
        name += '.' + padding + digits;
        if (take(name)) return name;
    }
}

} // namespace osgSkin
