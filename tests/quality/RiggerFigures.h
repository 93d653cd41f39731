// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "Subject.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace quality {

/// A deformation method that is compared with others.
struct MeasuredSkin {
    std::string name; ///< "LBS heat", "fast", ...
    Subject subject;  ///< with this skin's binding or weights
    Method method;
};

/// LBS and DQS with painted weights and with heat weights; ours without shapes (the paper's
/// deformation) and with them. The weights of `files` are the painted ones.
/// \param heat a file of heat weights; empty or missing: none
/// \throw osgSkin::Error if a file cannot be read or does not fit the others
std::vector<MeasuredSkin> makeSkins(const SubjectFiles& files, const std::string& heat);

/// The figures of one skin that a rigger checks first. Unset if the rig lacks the joints.
struct RiggerFigures {
    std::string skin;

    /// Share of the head's vertices that follow the head joint fully (ratio above .999). A joint's
    /// vertices are those with painted weights above .99 for the joint and its descendants.
    std::optional<double> headWhole;
    /// Percentage of all vertices that belong to a joint and follow it by less than .9.
    double inside = 0.0;
    /// Percentage of all vertices with a painted weight below .01 for a joint that follow it by
    /// more than .1.
    double outside = 0.0;
    std::string worstJoint; ///< with the most vertices of `inside`
    std::size_t worstCount = 0;

    /// Least area of a cross-section of shin or forearm, at 15, 25 and 40 % of the bone, over that
    /// at rest, with the joint bent to 60, 90, 120 and 140 degrees.
    std::optional<double> shinArea, forearmArea;

    /// Most intersecting pairs of triangles near the joint, beyond those at rest, with the joint
    /// bent by 120, 132 and 140 degrees and its axis rotated by -20 to 20 degrees.
    std::optional<std::size_t> kneeFolds, elbowFolds;

    /// Change of the volume when both clavicles are raised by 30 degrees, per cent.
    std::optional<double> clavicleVolume;

    /// RMS distance of a finger's last link from its rigid motion in a fist, in hand lengths, of
    /// the worst finger of the left hand.
    std::optional<double> fist;

    /// Displacement of the trunk's skin when the hips bend by 90 degrees, per cent of the height:
    /// RMS and 99th percentile.
    std::optional<double> sitRms, sit99;

    /// Pairs of triangles beyond those at rest, mean over the poses of the clips.
    double clipPairs = 0.0;
};

/// \param skins of one body; the first with painted weights
/// \param clips poses of the same rig
std::vector<RiggerFigures> measureRigger(const std::vector<MeasuredSkin>& skins,
                                         const std::vector<NamedPose>& clips);

/// Only the fist, for a rig with finger joints (`index_01_l`).
std::optional<double> measureFist(const MeasuredSkin& skin);

/// Prints a column for each skin.
void printTable(const std::string& body, const std::vector<RiggerFigures>& skins,
                std::ostream& out);
nlohmann::ordered_json toJson(const RiggerFigures& figures);

} // namespace quality
