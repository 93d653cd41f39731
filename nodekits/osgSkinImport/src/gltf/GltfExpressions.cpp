// SPDX-License-Identifier: MIT
// Facial expressions of VRM files: BlendShapeProxy of VRM 0, expressions of VRM 1, and the nodes
// that animate them in a VRM animation.
#include "gltf/GltfDocument.h"

#include "files/FileText.h"
#include "files/UniqueName.h"
#include "gltf/GltfMembers.h"

#include <cmath>

namespace osgSkin {
namespace {

using nlohmann::json;

ExpressionRules::Override overrideOf(const json& expression, const char* name) {
    const auto found = expression.find(name);
    if (found == expression.end()) return ExpressionRules::Override::None;
    return *found == "block"   ? ExpressionRules::Override::Block
           : *found == "blend" ? ExpressionRules::Override::Blend
                               : ExpressionRules::Override::None;
}

bool isBinary(const json& expression) {
    const auto found = expression.find("isBinary");
    return found != expression.end() && *found == true;
}

/// The part of the face that a preset of VRM moves.
ExpressionRules::Part partOf(const std::string& preset) {
    for (const char* name : {"blink", "blinkLeft", "blinkRight"})
        if (preset == name) return ExpressionRules::Part::Blink;
    for (const char* name : {"lookUp", "lookDown", "lookLeft", "lookRight"})
        if (preset == name) return ExpressionRules::Part::LookAt;
    for (const char* name : {"aa", "ih", "ou", "ee", "oh"})
        if (preset == name) return ExpressionRules::Part::Mouth;
    return ExpressionRules::Part::None;
}

class ExpressionReader {
public:
    explicit ExpressionReader(GltfDocument& document) : _document(document) {}

    void run() {
        const json& extensions = memberOf(_document.file.json, "extensions");
        for (const json& group : memberOf(memberOf(memberOf(extensions, "VRM"), "blendShapeMaster"),
                                          "blendShapeGroups"))
            readFirst(group);
        const json& second = memberOf(memberOf(extensions, "VRMC_vrm"), "expressions");
        for (const char* kind : {"preset", "custom"})
            for (const auto& [name, expression] : memberOf(second, kind).items())
                readSecond(name, expression, kind == std::string("preset"));
        const std::string& path = _document.file.path;
        if (_coloured > 0)
            warn(path, std::to_string(_coloured) +
                           " expressions change colours or textures, which is not supported");
        if (_lost > 0)
            warn(path,
                 std::to_string(_lost) + " parts of expressions name no morph target; ignored");
    }

private:
    /// VRM 0: weights up to 100, of meshes. Presets have the same names in all files, others are
    /// "unknown".
    void readFirst(const json& group) {
        const auto preset = group.find("presetName");
        std::string name = preset != group.end() ? nameOf({{"name", *preset}}) : "";
        if (name.empty() || name == "unknown") name = nameOf(group);
        begin(name);
        _rules.isBinary = isBinary(group);
        for (const json& bind : memberOf(group, "binds"))
            addPart(indexOf(bind, "mesh"), bind, 0.01);
        _coloured += !memberOf(group, "materialValues").empty();
    }

    /// VRM 1: weights up to 1, of nodes.
    void readSecond(const std::string& name, const json& expression, bool isPreset) {
        begin(nameOf({{"name", name}}));
        if (isPreset) _rules.part = partOf(name);
        _rules.isBinary = isBinary(expression);
        _rules.blink = overrideOf(expression, "overrideBlink");
        _rules.lookAt = overrideOf(expression, "overrideLookAt");
        _rules.mouth = overrideOf(expression, "overrideMouth");
        for (const json& bind : memberOf(expression, "morphTargetBinds")) {
            const std::size_t node = indexOf(bind, "node");
            const bool hasMesh = node < _document.nodes.size() && _document.nodes[node].mesh;
            addPart(hasMesh ? *_document.nodes[node].mesh : _document.meshes.size(), bind, 1.0);
        }
        _coloured += !memberOf(expression, "materialColorBinds").empty() ||
                     !memberOf(expression, "textureTransformBinds").empty();
    }

    void begin(const std::string& name) {
        _name = _names.unique(
            name.empty() ? "expression-" + std::to_string(_document.expressions.size()) : name);
        _rules = {};
        _document.expressions.push_back(_name);
        _document.file.addEntries(1);
    }

    void addPart(std::size_t mesh, const json& bind, double scale) {
        const std::size_t target = indexOf(bind, "index");
        const auto weight = bind.find("weight");
        if (mesh >= _document.meshes.size() || weight == bind.end() || !weight->is_number() ||
            target >= _document.meshes[mesh].targetNames.size()) {
            ++_lost;
            return;
        }
        const double share = scale * weight->get<double>();
        if (share == 0.0 || !std::isfinite(share)) return;
        std::vector<GltfMesh::Expression>& known = _document.meshes[mesh].expressions;
        if (known.empty() || known.back().name != _name) known.push_back({_name, {}, _rules});
        known.back().parts.emplace_back(target, share);
        _document.file.addEntries(_document.meshes[mesh].primitives.size());
    }

    GltfDocument& _document;
    UniqueNames _names;
    std::string _name;         ///< of the present expression
    ExpressionRules _rules;    ///< its own
    std::size_t _coloured = 0; ///< expressions that also change materials
    std::size_t _lost = 0;
};

} // namespace

void readExpressions(GltfDocument& document) {
    ExpressionReader(document).run();
}

VrmAnimationNodes vrmAnimationNodes(const GltfDocument& document) {
    VrmAnimationNodes result;
    const json& animation =
        memberOf(memberOf(document.file.json, "extensions"), "VRMC_vrm_animation");
    for (const char* kind : {"preset", "custom"})
        for (const auto& [name, expression] :
             memberOf(memberOf(animation, "expressions"), kind).items())
            result.expressions.emplace(indexOf(expression, "node"), name);
    const std::size_t gaze = indexOf(memberOf(animation, "lookAt"), "node");
    if (gaze < document.nodes.size()) result.gaze = gaze;
    return result;
}

} // namespace osgSkin
