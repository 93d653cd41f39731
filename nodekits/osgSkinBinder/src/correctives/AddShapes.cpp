// SPDX-License-Identifier: GPL-3.0-or-later
#include "correctives/AddShapes.h"

#include "correctives/MakeShapes.h"
#include "correctives/Muscles.h"
#include "correctives/ShapeFit.h"
#include "ratios/JointRatios.h"

namespace osgSkin {

void addShapes(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
               const WeldedMesh& mesh, const SkinLayers* layers, const BindOptions& options,
               const Progress& progress, Binding& binding, std::vector<std::string>& notes) {
    if (options.shapes != BindOptions::Shapes::None) {
        if (progress) progress({"shapes", 0.0});
        binding.correctives = makeFastShapes(skeleton, recogniseJoints(skeleton, options.names),
                                             joints, mesh, layers, binding);
        if (progress) progress({"shapes", 1.0});
    }
    if (options.muscles || !options.ownMuscles.empty())
        binding.correctives = mergeCorrectives(
            binding.correctives, makeMuscles(skeleton, joints, mesh, binding, options, notes));
    if (!*options.surfaceNormals) return;
    binding.gradients = ratioGradients(mesh, binding);
    if (!binding.correctives.empty()) addNormalCorrectives(mesh, binding);
}

} // namespace osgSkin
