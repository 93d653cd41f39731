// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bind/Binder.h"

namespace osgSkin {

/// The binder that the plug-in registers: binds by regions of the skin.
class RegionBinder : public Binder {
public:
    Binding bind(const SkinMesh& mesh, const RestSkeleton& skeleton, const BindOptions& options,
                 BindReport* report) const override;
    void completeWeights(const SkinMesh& mesh, const RestSkeleton& skeleton,
                         const BindOptions& options, Binding& binding,
                         std::vector<std::string>& notes) const override;
    RestSkeleton fit(const SkinMesh& mesh, const FitOptions& options,
                     FitReport* report) const override;
};

} // namespace osgSkin
