// SPDX-License-Identifier: MIT
#pragma once

#include "CapturedPeople.h"
#include "ScanPoses.h"
#include "Subject.h"

#include <ostream>
#include <string>
#include <vector>

namespace quality {

/// Deforms a person's mesh into a pose.
struct PersonSkin {
    std::string name;
    Subject subject;
    Method method;
};

/// The distance of a deformed skin from a scan, at one bent joint.
struct JointDistance {
    std::string joint;     ///< "elbow", ...; both sides have one name
    double distance = 0.0; ///< mm, skin to scan and scan to skin, weighted by visibility
    double normals = 0.0;  ///< degrees
};

/// The distances of a person's skin from a scan, within a limb's radius of each joint that is bent
/// far enough. Other vertices than those of the joint's own limbs do not count.
/// \param skins of the same mesh and rig; one result for each
std::vector<std::vector<JointDistance>> measureDistances(const CapturedPerson& person,
                                                         const std::vector<PersonSkin>& skins,
                                                         const Scan& scan,
                                                         const RigidParts::Pose& pose);

/// All distances of one person, of each skin.
struct PersonFigures {
    std::vector<std::string> skins;
    std::vector<std::vector<JointDistance>> distances;
};

enum class Joints {
    Solved, ///< where the rigid parts of the scans turn about
    Fitted  ///< where fitSkeleton() puts them
};

/// Ours, without shapes, and linear and dual quaternion blending by the same bend ratios.
PersonFigures measurePerson(const CapturedPerson& person, Ratios ratios, Joints joints);

/// Prints medians over people, and geometric means of the ratios to the other skins.
void printTable(const std::vector<PersonFigures>& people, std::ostream& out);

} // namespace quality
