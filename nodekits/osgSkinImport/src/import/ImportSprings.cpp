// SPDX-License-Identifier: MIT
#include <osgSkinImport/ImportSprings>

#include "files/FileFormat.h"
#include "import/ShareScenes.h"
#include "scene/SceneBind.h"
#include "scene/SceneSkeleton.h"

#include <osgSkinMotion/SpringBones>

#include <map>
#include <utility>

namespace osgSkin {

SpringSettings importSprings(const std::string& path, const osgDB::Options* options) {
    if (formatOf(path).reader != FileFormat::Gltf) return {};
    const std::shared_ptr<const SourceScene> scene = readSourceScene(path, options);
    if (scene->springs.chains.empty()) return {};
    const SceneSkeleton skeleton = findSceneSkeleton(*scene);
    const SceneBind bind(*scene);
    // From the nodes' pose to the bind pose, as a joint moves.
    std::map<const SourceNode*, glm::dmat4> toRest;
    for (std::size_t j = 0; j < skeleton.nodes.size(); ++j)
        toRest[skeleton.nodes[j]] = skeleton.bind[j] * glm::inverse(bind.posed(*skeleton.nodes[j]));
    /// The joint at or above a node; null where there is none.
    const auto jointAt = [&](const std::string& name) {
        const SourceNode* node = bind.find(name);
        while (node && toRest.count(node) == 0) node = bind.parent(*node);
        return node;
    };
    const auto move = [&](const SourceNode* joint, glm::dvec3& point) {
        point = toRest[joint] * glm::dvec4(point, 1.0);
    };
    SpringSettings result = scene->springs;
    for (SpringSettings::Collider& collider : result.colliders) {
        const SourceNode* const joint = jointAt(collider.joint);
        collider.joint = joint ? joint->name : "";
        if (!joint) continue;
        move(joint, collider.start);
        move(joint, collider.end);
    }
    for (SpringSettings::Chain& chain : result.chains) {
        if (const SourceNode* const centre = jointAt(chain.centre)) chain.centre = centre->name;
        for (SpringSettings::Joint& joint : std::exchange(chain.joints, {})) {
            const SourceNode* const node = jointAt(joint.name);
            if (!node || node->name != joint.name) continue; // it moves no skin
            move(node, joint.tip);
            chain.joints.push_back(joint);
        }
    }
    return result;
}

} // namespace osgSkin
