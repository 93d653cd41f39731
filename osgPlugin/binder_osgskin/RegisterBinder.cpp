// SPDX-License-Identifier: GPL-3.0-or-later
#include "KitCheck.h"
#include "osgSkinBindBuild.h"
#include "osgSkinBuild.h"
#include "osgSkinRigBuild.h"

#include "bind/RegionBinder.h"

#include <memory>

namespace {

/// Registers the binder for as long as the plug-in is loaded.
class BinderProxy {
public:
    BinderProxy() { osgSkin::Binder::set(new osgSkin::RegionBinder); }
    ~BinderProxy() { osgSkin::Binder::set(nullptr); }
    BinderProxy(const BinderProxy&) = delete;
    BinderProxy& operator=(const BinderProxy&) = delete;
};

} // namespace

extern "C" void osgdb_binder_osgskin(void) {}
static const auto g_proxy = plugin::mayUse("osgdb_binder_osgskin", {OSGSKIN_KIT_BUILD(osgSkin),
                                                                    OSGSKIN_KIT_BUILD(osgSkinRig),
                                                                    OSGSKIN_KIT_BUILD(osgSkinBind)})
                                ? std::make_unique<BinderProxy>()
                                : nullptr;
