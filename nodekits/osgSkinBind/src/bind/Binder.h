// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Binding>
#include <osgSkinBind/BindOptions>
#include <osgSkinBind/BindReport>
#include <osgSkinBind/Export>
#include <osgSkinBind/FitOptions>
#include <osgSkinBind/FitReport>
#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/SkinMesh>

#include <osg/Referenced>
#include <osg/ref_ptr>

#include <string>
#include <vector>

namespace osgSkin {

/// Binds without painted weights, shapes bent joints and fits skeletons. A plug-in does it,
/// osgdb_binder_osgskin, since it needs CGAL and so is under the GPL. Methods are thread-safe.
class OSGSKINBIND_EXPORT Binder : public osg::Referenced {
public:
    /// See osgSkin::bind().
    virtual Binding bind(const SkinMesh& mesh, const RestSkeleton& skeleton,
                         const BindOptions& options, BindReport* report) const = 0;

    /// Adds shapes, muscles and surface normals to a binding by painted weights.
    ///
    /// \param options with shapes and normals decided()
    /// \param binding of `mesh`; changed
    /// \param notes gets a line for each request that could not be met
    virtual void completeWeights(const SkinMesh& mesh, const RestSkeleton& skeleton,
                                 const BindOptions& options, Binding& binding,
                                 std::vector<std::string>& notes) const = 0;

    /// See osgSkin::fitSkeleton().
    virtual RestSkeleton fit(const SkinMesh& mesh, const FitOptions& options,
                             FitReport* report) const = 0;

    /// The registered binder. Loads the plug-in if there is none: from its folder beside this
    /// library, else from osgDB's library path.
    ///
    /// \param task which needs it, for the error
    /// \return never null
    /// \throw osgSkin::Error if the plug-in is missing, or of another build
    static osg::ref_ptr<const Binder> find(const std::string& task);

    /// Registers a binder, in place of an earlier one. The plug-in calls it as it is loaded, and
    /// with null as it is unloaded.
    static void set(const Binder* binder);

protected:
    ~Binder() override;
};

} // namespace osgSkin
