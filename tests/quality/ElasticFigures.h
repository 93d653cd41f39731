// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef QUALITY_ELASTICFIGURES_H
#define QUALITY_ELASTICFIGURES_H

#include "Subject.h"

#include <elastic/SolveElastic.h>

#include <string>
#include <vector>

namespace quality {

struct ElasticRun {
    std::vector<std::string> joints{"LeftForeArm", "LeftLeg", "LeftArm", "LeftUpLeg"};
    std::string folder; ///< for OBJ files; empty: writes none
};

/// A joint as input for the elastic solver, as a reference for the fitted shapes.
struct ReferenceJoint {
    osgSkin::ElasticJoint joint;
    std::size_t fitted = 0; ///< of its samples; the first ones are those that the shapes were
                            ///< fitted to
};

/// \param shaped bound with elastic shapes
/// \param name of a joint that has shapes
ReferenceJoint referenceJointOf(const Subject& shaped, const std::string& name);

/// Binds the body with elastic shapes, also solves the joints directly, and prints a line for each
/// bend: the distances of linear blending, dual quaternions, the skin without shapes and the shaped
/// skin from the elastic solid.
/// \throw osgSkin::Error or std::runtime_error if a joint does not exist or a file cannot be
/// written
void measureElastic(const Subject& subject, const ElasticRun& run);

} // namespace quality

#endif
