// SPDX-License-Identifier: MIT
#include <osgSkinBind/Bind>

#include "bind/Binder.h"

namespace osgSkin {

Binding bind(const SkinMesh& mesh, const RestSkeleton& skeleton, const BindOptions& options,
             BindReport* report) {
    return Binder::find("bind: a skin without painted weights")
        ->bind(mesh, skeleton, options, report);
}

} // namespace osgSkin
