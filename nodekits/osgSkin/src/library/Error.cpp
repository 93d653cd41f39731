// SPDX-License-Identifier: MIT
#include <osgSkin/Error>

namespace osgSkin {

// Out of line, so that the type has one home and can be caught across shared libraries.
Error::~Error() = default;

} // namespace osgSkin
