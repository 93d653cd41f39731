// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_MERGECORRECTIVES_H
#define OSGSKINBIND_MERGECORRECTIVES_H

#include <osgSkin/Correctives>

namespace osgSkin {

/// Both correctives, of the same vertices, as one: what they add is summed.
/// \pre neither has normal correctives
Correctives mergeCorrectives(const Correctives& a, const Correctives& b);

} // namespace osgSkin

#endif
