// SPDX-License-Identifier: MIT
#pragma once

#include "PaintedBody.h"

#include <SkinMeasures.h>
#include <SkinWeights.h>
#include <osgSkin/Binding>
#include <osgSkin/SkinModel>
#include <osgSkinBind/BindOptions>
#include <osgSkinBind/BindReport>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace quality {

/// Where our ratios come from.
enum class Ratios {
    Smooth,    ///< regions, made continuous: the default
    AsPrinted, ///< between boundary planes
    Painted    ///< the painted weights
};

struct SubjectFiles {
    std::string body, rig, weights;
    Ratios ratios = Ratios::Smooth;
};

/// A body to measure: bound by us, and with its painted weights for the peers.
struct Subject {
    std::string name;
    osgSkin::SkinMesh mesh;
    osgSkin::RestSkeleton rig;
    osgSkin::Binding binding;
    osgSkin::BindReport report;
    std::optional<osgSkin::BindOptions> options; ///< unset where bound by weights
    compare::SkinWeights weights;                ///< over the rig's joints

    compare::Points rest;
    compare::Points normals; ///< at rest; zero where the measured skin has no triangle
    /// The skin that is measured: corners name the first of the vertices that share a position.
    std::vector<std::uint32_t> triangles;
    std::vector<compare::Edge> edges;
    osg::ref_ptr<const osgSkin::SkinModel> model; ///< one vertex for each of the mesh

    /// Index of the joint of that name in any of the usual rigs ("LeftForeArm" is "lowerarm_l"
    /// elsewhere), -1 where there is none.
    int joint(const std::string& name) const;

    /// The joint of the largest painted weight.
    std::uint32_t dominantJoint(std::size_t vertex) const;
};

/// \throw osgSkin::Error where a file cannot be read or does not fit the others
Subject loadSubject(const SubjectFiles& files);

/// Binds a body.
/// \throw osgSkin::Error where its parts do not fit each other
Subject makeSubject(PaintedBody body, Ratios ratios = Ratios::Smooth);

/// The model of the subject's binding.
osg::ref_ptr<const osgSkin::SkinModel> modelOf(const Subject& subject);

/// A posed skin with the normals that its method gives.
struct PosedSkin {
    compare::Points points, normals;
};

/// Area-weighted normals, unit; zero at vertices without triangles.
compare::Points skinNormals(const compare::Points& points,
                            const std::vector<std::uint32_t>& triangles);

} // namespace quality
