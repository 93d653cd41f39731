// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_CHECKOPTIONS_H
#define OSGSKINBIND_CHECKOPTIONS_H

#include <osgSkinBind/BindOptions>
#include <osgSkinRig/RestSkeleton>

namespace osgSkin {

/// \throw osgSkin::Error where an option names a joint that is not there or a value out of range
void checkOptions(const RestSkeleton& skeleton, const BindOptions& options);

} // namespace osgSkin

#endif
