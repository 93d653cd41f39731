// SPDX-License-Identifier: MIT
#include "KitCheck.h"

#include <osg/Notify>

#include <string>

namespace plugin {

bool mayUse(const char* plugin, std::initializer_list<KitBuild> kits) {
    for (const KitBuild& kit : kits) {
        const std::string loaded = kit.loaded != nullptr ? kit.loaded() : "an older one";
        if (loaded == kit.compiled) continue;
        OSG_WARN << plugin << " is left out: it was built with " << kit.kit << " " << kit.compiled
                 << ", and " << loaded << " is loaded; expected plug-ins and libraries of one build"
                 << std::endl;
        return false;
    }
    return true;
}

} // namespace plugin
