// SPDX-License-Identifier: MIT
#include <osgSkin/Version>

namespace osgSkin {

const char* libraryVersion() {
    return OSGSKIN_VERSION;
}

} // namespace osgSkin
