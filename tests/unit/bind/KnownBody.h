// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/SkinMesh>

#include <glm/gtc/quaternion.hpp>

#include <functional>
#include <map>
#include <string>

/// A body with known joints, for tests of fitSkeleton().
struct KnownBody {
    osgSkin::SkinMesh mesh;
    osgSkin::RestSkeleton truth; ///< with a fitted skeleton's joint names

    /// The project's own figure.
    static KnownBody thrower();

    /// A body and its rig from the shared data; empty if they are missing.
    static KnownBody shared(const std::string& mesh, const std::string& rig);

    /// Maps every point of mesh and skeleton.
    KnownBody mapped(const std::function<glm::dvec3(const glm::dvec3&)>& map) const;

    /// The skin posed by rotating joints about their centres, in rest-space axes.
    KnownBody posed(const std::map<std::string, glm::dquat>& turns) const;
};

/// Distances of a fitted skeleton from the truth, relative to the body's height (its extent in y,
/// or in z with `zUp`).
struct FitErrors {
    double mean = 0.0;
    double worst = 0.0;
    std::string worstJoint;
    std::size_t joints = 0;
    std::size_t inside = 0; ///< joints inside the skin
};

FitErrors fitErrors(const osgSkin::RestSkeleton& fitted, const KnownBody& body, bool zUp = false);
