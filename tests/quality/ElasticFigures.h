// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "Subject.h"

#include <elastic/ElasticJoint.h>

#include <string>
#include <vector>

namespace quality {

struct ElasticRun {
    std::vector<std::string> joints{"LeftForeArm", "LeftLeg", "LeftArm", "LeftUpLeg"};
    std::string folder;             ///< where OBJs go; empty: none
    std::size_t mostSamples = 1000; ///< of a joint; the main direction comes first
};

/// The joint as the elastic solver takes it: the limb's radius where its bend is halfway, hinges by
/// their names, samples over the anatomical range.
osgSkin::ElasticJoint elasticJointOf(const Subject& subject, const std::string& name);

/// Solves the joints and prints a line for each sample.
/// \throw osgSkin::Error or std::runtime_error where a joint is not there or a file cannot be
///        written
void measureElastic(const Subject& subject, const ElasticRun& run);

} // namespace quality
