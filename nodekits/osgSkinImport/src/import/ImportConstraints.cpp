// SPDX-License-Identifier: MIT
#include <osgSkinImport/ImportConstraints>

#include "files/FileFormat.h"
#include "files/FileText.h"
#include "import/ShareScenes.h"
#include "scene/SceneSkeleton.h"

#include <map>

namespace osgSkin {

std::vector<Constraint> importConstraints(const std::string& path, const osgDB::Options* options) {
    if (formatOf(path).reader != FileFormat::Gltf) return {};
    const std::shared_ptr<const SourceScene> scene = readSourceScene(path, options);
    if (scene->constraints.empty()) return {};
    const SceneSkeleton skeleton = findSceneSkeleton(*scene);
    const std::map<std::string, int> joints = skeleton.rest.byName();
    const auto isKnown = [&](Constraint::Joint& joint) {
        const auto found = joints.find(joint.name);
        if (found == joints.end()) return false;
        const auto index = static_cast<std::size_t>(found->second);
        const int parent = skeleton.rest.joints[index].parent;
        joint.axes = skeleton.worldRotations[index];
        joint.above = parent < 0 ? rotationOf(skeleton.aboveRoot)
                                 : skeleton.worldRotations[static_cast<std::size_t>(parent)];
        return true;
    };
    std::vector<Constraint> result;
    for (Constraint constraint : scene->constraints)
        if (isKnown(constraint.joint) && isKnown(constraint.source)) result.push_back(constraint);
    if (const std::size_t lost = scene->constraints.size() - result.size())
        warn(path, std::to_string(lost) + " constraints (VRMC_node_constraint) of nodes that move "
                                          "no skin, or follow such nodes; ignored");
    return result;
}

} // namespace osgSkin
