// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinBind/Progress>

#include <string>

namespace osgSkin {

/// Tells how far a load has come that consists of stages, one after the other.
class LoadStages {
public:
    /// About what each stage takes of the time, measured on bodies of 4,000 to 14,000 vertices with
    /// 31 joints: only the proportions count.
    static constexpr double kMesh = 10.0;
    static constexpr double kSkeleton = 1.0;
    static constexpr double kFit = 100.0;
    static constexpr double kModel = 15.0; ///< a rigged model: mesh, skeleton and clips
    static constexpr double kBinding = 40.0;
    static constexpr double kMotion = 10.0; ///< each motion file
    static constexpr double kScene = 10.0;

    /// \param progress told; may be empty
    explicit LoadStages(Progress progress);

    /// Before the first stage: the sum of the sizes of all that are to come.
    void plan(double total);

    /// The next stage begins.
    ///
    /// \param what its name
    /// \param size one of those above
    /// \return for the stage to tell how far it has come itself
    Progress begin(const std::string& what, double size);

    /// All is done.
    void finish();

private:
    Progress _progress;
    double _total = 1.0;
    double _begun = 0.0; ///< sum of the stages before the present one
    double _size = 0.0;  ///< of the present one
};

} // namespace osgSkin
