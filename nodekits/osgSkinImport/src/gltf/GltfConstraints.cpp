// SPDX-License-Identifier: MIT
// Constraints of nodes in VRM 1 files: VRMC_node_constraint.
#include "gltf/GltfDocument.h"

#include "files/FileText.h"
#include "gltf/GltfMembers.h"

#include <osgSkinMotion/Constraints>

#include <algorithm>
#include <utility>

namespace osgSkin {
namespace {

using nlohmann::json;

/// "PositiveX", "NegativeZ", "Y"; 0 for another text.
glm::dvec3 axisOf(const json& object, const char* name) {
    const auto found = object.find(name);
    glm::dvec3 result(0.0);
    if (found == object.end() || !found->is_string()) return result;
    std::string text = found->get<std::string>();
    const bool isNegative = text.rfind("Negative", 0) == 0;
    if (isNegative || text.rfind("Positive", 0) == 0) text.erase(0, 8);
    if (text.size() == 1 && text[0] >= 'X' && text[0] <= 'Z')
        result[text[0] - 'X'] = isNegative ? -1.0 : 1.0;
    return result;
}

/// \return false where the file does not say what the kind needs
template <typename JointAt>
bool readConstraint(const json& from, const JointAt& jointAt, Constraint& constraint) {
    for (const auto& [kind, name] :
         {std::pair(Constraint::Kind::Roll, "roll"), std::pair(Constraint::Kind::Aim, "aim"),
          std::pair(Constraint::Kind::Rotation, "rotation")}) {
        const json& numbers = memberOf(from, name);
        if (numbers.empty()) continue;
        constraint.kind = kind;
        constraint.source = jointAt(osgSkin::indexOf(numbers, "source"));
        constraint.weight = numberOf(numbers, "weight", 1.0);
        if (kind != Constraint::Kind::Rotation)
            constraint.axis =
                axisOf(numbers, kind == Constraint::Kind::Roll ? "rollAxis" : "aimAxis");
        return !constraint.joint.name.empty() && !constraint.source.name.empty() &&
               constraint.weight >= 0.0 && constraint.weight <= 1.0 &&
               constraint.axis != glm::dvec3(0.0);
    }
    return false;
}

} // namespace

void readConstraints(GltfDocument& document, const std::vector<int>& indexOf, SourceScene& scene) {
    const json& nodes = memberOf(document.file.json, "nodes");
    // A frame looks at the nodes below constrained ones, and at those above an aim's.
    std::vector<std::size_t> above(scene.nodes.size(), 0), below(scene.nodes.size(), 1);
    const auto parentOf = [&](std::size_t n) {
        return static_cast<std::size_t>(scene.nodes[n].parent);
    };
    for (std::size_t n = 1; n < above.size(); ++n) above[n] = above[parentOf(n)] + 1;
    for (std::size_t n = below.size(); n-- > 1;) below[parentOf(n)] += below[n];
    const auto jointAt = [&](std::size_t index) -> Constraint::Joint {
        if (index >= indexOf.size() || indexOf[index] < 0) return {};
        const auto n = static_cast<std::size_t>(indexOf[index]);
        document.file.addEntries(above[n] + below[n]);
        return {scene.nodes[n].name, rotationOf(scene.nodes[n].matrix)};
    };
    std::size_t lost = 0;
    std::vector<Constraint> found;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const json& extension = memberOf(memberOf(nodes[n], "extensions"), "VRMC_node_constraint");
        if (extension.empty()) continue;
        Constraint constraint;
        constraint.joint = jointAt(n);
        document.file.checkEntries();
        if (readConstraint(memberOf(extension, "constraint"), jointAt, constraint))
            found.push_back(constraint);
        else
            ++lost;
    }
    if (lost > 0)
        warn(document.file.path, std::to_string(lost) +
                                     " constraints (VRMC_node_constraint) lack a source, an axis "
                                     "or a weight of 0 to 1; ignored");
    const std::vector<bool> isCircular = inCircles(found);
    for (std::size_t i = 0; i < found.size(); ++i)
        if (!isCircular[i]) scene.constraints.push_back(found[i]);
    const auto first = std::find(isCircular.begin(), isCircular.end(), true);
    if (first != isCircular.end())
        warn(document.file.path,
             std::to_string(found.size() - scene.constraints.size()) +
                 " nodes follow each other in a circle (VRMC_node_constraint), " +
                 inQuotes(found[std::size_t(first - isCircular.begin())].joint.name) +
                 " among them; ignored");
}

} // namespace osgSkin
