// SPDX-License-Identifier: MIT
// Facial expressions of VRM files: BlendShapeProxy of VRM 0, expressions of VRM 1.
#include "gltf/GltfDocument.h"

#include "files/FileText.h"
#include "files/UniqueName.h"
#include "gltf/GltfMembers.h"

#include <cmath>

namespace osgSkin {
namespace {

using nlohmann::json;

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
                readSecond(name, expression);
        const std::string& path = _document.file.path;
        if (_coloured > 0)
            warn(path, std::to_string(_coloured) +
                           " expressions change colours or textures, which is not supported");
        if (_ruled > 0)
            warn(path, std::to_string(_ruled) +
                           " expressions are binary or override blinking, looking or the mouth, "
                           "which is not supported: they are blended");
        noteAnimation();
        if (_lost > 0)
            warn(path,
                 std::to_string(_lost) + " parts of expressions name no morph target; ignored");
    }

private:
    /// Says what a VRM animation moves beside joints.
    void noteAnimation() const {
        const json& animation =
            memberOf(memberOf(_document.file.json, "extensions"), "VRMC_vrm_animation");
        const json& expressions = memberOf(animation, "expressions");
        const std::size_t count =
            memberOf(expressions, "preset").size() + memberOf(expressions, "custom").size();
        const bool looks = !memberOf(animation, "lookAt").empty();
        if (count == 0 && !looks) return;
        warn(_document.file.path, "a VRM animation of " + std::to_string(count) + " expressions" +
                                      (looks ? " and of where the eyes look" : "") +
                                      ", which are not supported: it moves joints alone");
    }

    /// Whether an expression acts with others in a way of its own.
    static bool isRuled(const json& expression) {
        for (const char* name : {"overrideBlink", "overrideLookAt", "overrideMouth"})
            if (const auto found = expression.find(name);
                found != expression.end() && *found != "none")
                return true;
        const auto binary = expression.find("isBinary");
        return binary != expression.end() && *binary == true;
    }

    /// VRM 0: weights up to 100, of meshes. Presets have the same names in all files, others are
    /// "unknown".
    void readFirst(const json& group) {
        const auto preset = group.find("presetName");
        std::string name = preset != group.end() ? nameOf({{"name", *preset}}) : "";
        if (name.empty() || name == "unknown") name = nameOf(group);
        begin(name);
        for (const json& bind : memberOf(group, "binds"))
            addPart(indexOf(bind, "mesh"), bind, 0.01);
        _coloured += !memberOf(group, "materialValues").empty();
        _ruled += isRuled(group);
    }

    /// VRM 1: weights up to 1, of nodes.
    void readSecond(const std::string& name, const json& expression) {
        begin(nameOf({{"name", name}}));
        for (const json& bind : memberOf(expression, "morphTargetBinds")) {
            const std::size_t node = indexOf(bind, "node");
            const bool hasMesh = node < _document.nodes.size() && _document.nodes[node].mesh;
            addPart(hasMesh ? *_document.nodes[node].mesh : _document.meshes.size(), bind, 1.0);
        }
        _coloured += !memberOf(expression, "materialColorBinds").empty() ||
                     !memberOf(expression, "textureTransformBinds").empty();
        _ruled += isRuled(expression);
    }

    void begin(const std::string& name) {
        _name = _names.unique(
            name.empty() ? "expression-" + std::to_string(_document.expressions.size()) : name);
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
        if (known.empty() || known.back().name != _name) known.push_back({_name, {}});
        known.back().parts.emplace_back(target, share);
        _document.file.addEntries(_document.meshes[mesh].primitives.size());
    }

    GltfDocument& _document;
    UniqueNames _names;
    std::string _name;         ///< of the present expression
    std::size_t _coloured = 0; ///< expressions that also change materials
    std::size_t _ruled = 0;    ///< expressions that are binary, or override others
    std::size_t _lost = 0;
};

} // namespace

void readExpressions(GltfDocument& document) {
    ExpressionReader(document).run();
}

} // namespace osgSkin
