// SPDX-License-Identifier: MIT
#include "Vrm.h"

#include <osgSkinMotion/SpringBones>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>

namespace bake {

namespace {

using nlohmann::json;
using osgSkin::SpringSettings;

constexpr double kPlaneRadius = 1e4; ///< metres; larger spheres stand for planes

json list(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

/// A member of an object; null where there is none.
const json& at(const json& object, const std::string& name) {
    static const json none;
    const auto found = object.is_object() ? object.find(name) : object.end();
    return object.is_object() && found != object.end() ? *found : none;
}

std::string textAt(const json& object, const std::string& name) {
    const json& text = at(object, name);
    return text.is_string() ? text.get<std::string>() : std::string();
}

/// The JSON of a glTF file; null where it cannot be read.
json jsonOf(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::string text(20, '\0');
    in.read(text.data(), 20);
    if (text.compare(0, 4, "glTF") == 0) {
        std::uint32_t size = 0;
        for (std::size_t i = 0; i < 4; ++i)
            size |= std::uint32_t(std::uint8_t(text[12 + i])) << (8 * i);
        text.clear();
        std::copy_n(std::istreambuf_iterator<char>(in), size, std::back_inserter(text));
    } else {
        text.append(std::istreambuf_iterator<char>(in), {});
    }
    const json result = json::parse(text, nullptr, false);
    return result.is_object() ? result : json();
}

/// Whether a VRM file has materials of its own kind of shading.
bool hasToonShading(const json& file) {
    for (const json& material : at(file, "materials"))
        if (!at(at(material, "extensions"), "VRMC_materials_mtoon").is_null()) return true;
    for (const json& material : at(at(at(file, "extensions"), "VRM"), "materialProperties"))
        if (textAt(material, "shader") == "VRM/MToon") return true;
    return false;
}

/// VRM 1's names of VRM 0's presets that have others.
std::string presetOfFirst(const std::string& name) {
    static const std::map<std::string, std::string> kNames{{"joy", "happy"},
                                                           {"sorrow", "sad"},
                                                           {"fun", "relaxed"},
                                                           {"a", "aa"},
                                                           {"i", "ih"},
                                                           {"u", "ou"},
                                                           {"e", "ee"},
                                                           {"o", "oh"},
                                                           {"blink_l", "blinkLeft"},
                                                           {"blink_r", "blinkRight"},
                                                           {"lookup", "lookUp"},
                                                           {"lookdown", "lookDown"},
                                                           {"lookleft", "lookLeft"},
                                                           {"lookright", "lookRight"}};
    const auto found = kNames.find(name);
    return found == kNames.end() ? name : found->second;
}

/// The licence of VRM 0 files as an address; empty where the file states none.
std::string licenceOfFirst(const json& meta) {
    static const std::map<std::string, std::string> kCreative{
        {"CC0", "publicdomain/zero/1.0/"},         {"CC_BY", "licenses/by/4.0/"},
        {"CC_BY_NC", "licenses/by-nc/4.0/"},       {"CC_BY_SA", "licenses/by-sa/4.0/"},
        {"CC_BY_NC_SA", "licenses/by-nc-sa/4.0/"}, {"CC_BY_ND", "licenses/by-nd/4.0/"},
        {"CC_BY_NC_ND", "licenses/by-nc-nd/4.0/"}};
    const auto found = kCreative.find(textAt(meta, "licenseName"));
    if (found != kCreative.end()) return "https://creativecommons.org/" + found->second;
    const std::string other = textAt(meta, "otherLicenseUrl");
    return other.empty() ? textAt(meta, "otherPermissionUrl") : other;
}

/// VRM 1's meta of a VRM 0 file. What that does not allow in so many words is not allowed.
json metaOfFirst(const json& from) {
    json meta{{"name", textAt(from, "title")}, {"licenseUrl", licenceOfFirst(from)}};
    if (const std::string author = textAt(from, "author"); !author.empty())
        meta["authors"] = {author};
    for (const auto& [before, now] :
         {std::pair("version", "version"), std::pair("contactInformation", "contactInformation"),
          std::pair("otherPermissionUrl", "otherLicenseUrl")})
        if (const std::string text = textAt(from, before); !text.empty()) meta[now] = text;
    if (const std::string text = textAt(from, "reference"); !text.empty())
        meta["references"] = {text};
    const std::string user = textAt(from, "allowedUserName");
    meta["avatarPermission"] = user == "Everyone"                   ? "everyone"
                               : user == "ExplicitlyLicensedPerson" ? "onlySeparatelyLicensedPerson"
                                                                    : "onlyAuthor";
    meta["allowExcessivelyViolentUsage"] = textAt(from, "violentUssageName") == "Allow"; // sic
    meta["allowExcessivelySexualUsage"] = textAt(from, "sexualUssageName") == "Allow";
    meta["commercialUsage"] =
        textAt(from, "commercialUssageName") == "Allow" ? "personalProfit" : "personalNonProfit";
    return meta;
}

/// VRM's joints and our roles, without those of the spine.
std::vector<std::pair<std::string, std::string>> namesOfBones() {
    std::vector<std::pair<std::string, std::string>> result{
        {"hips", "Hips"}, {"neck", "Neck"}, {"head", "Head"}};
    for (const auto& [side, role] : {std::pair<std::string, std::string>("left", "Left"),
                                     std::pair<std::string, std::string>("right", "Right")}) {
        for (const std::string part :
             {"UpperLeg", "LowerLeg", "Foot", "UpperArm", "LowerArm", "Hand"})
            result.emplace_back(side + part, role + part);
        result.emplace_back(side + "Shoulder", role + "Collar");
        result.emplace_back(side + "Toes", role + "Toe");
        for (const std::string finger : {"Thumb", "Index", "Middle", "Ring", "Little"}) {
            const bool isThumb = finger == "Thumb";
            const std::array<const char*, 3> parts{isThumb ? "Metacarpal" : "Proximal",
                                                   isThumb ? "Proximal" : "Intermediate", "Distal"};
            for (std::size_t i = 0; i < 3; ++i)
                result.emplace_back(side + finger + parts[i],
                                    role + finger + std::to_string(i + 1));
        }
    }
    return result;
}

/// Writes springs as chains of nodes.
class SpringWriter {
public:
    SpringWriter(const osgSkin::Character& character, const ToGltf& toGltf,
                 const SpringSettings& settings, json& root)
        : _rest(character.rest), _toGltf(toGltf), _settings(settings), _root(root) {}

    json run() {
        for (const SpringSettings::Collider& collider : _settings.colliders) addCollider(collider);
        for (const SpringSettings::Chain& chain : _settings.chains) addChain(chain);
        for (auto& [group, index] : _groups)
            _result["colliderGroups"][index] = {{"colliders", group}};
        _result["specVersion"] = "1.0";
        return _result;
    }
    bool hasExtended() const { return _hasExtended; }

private:
    int find(const std::string& joint) const { return joint.empty() ? -1 : _rest.find(joint); }
    const glm::dvec3& centre(std::size_t joint) const { return _rest.joints[joint].centre; }
    glm::dvec3 offset(std::size_t joint, const glm::dvec3& point) const {
        return _toGltf.vector(point - centre(joint));
    }

    void addCollider(const SpringSettings::Collider& from) {
        const int node = find(from.joint);
        if (node < 0) {
            _colliders.push_back(-1); // touches nothing
            return;
        }
        const auto joint = std::size_t(node);
        const glm::dvec3 start = offset(joint, from.start), end = offset(joint, from.end);
        const double radius = std::abs(from.radius) * _toGltf.scale();
        const bool isCapsule = from.start != from.end,
                   isPlane = !isCapsule && radius > kPlaneRadius && start != glm::dvec3(0.0);
        json round{{"offset", list(start)}, {"radius", radius}};
        if (isCapsule) round["tail"] = list(end);
        const char* const kind = isCapsule ? "capsule" : "sphere";
        json collider{{"node", joint}, {"shape", {{kind, round}}}};
        if (from.radius < 0.0 || isPlane) {
            // Programs that do not know the extension get a collider that touches nothing.
            collider["shape"] = {{"sphere", {{"offset", {0.0, -10000.0, 0.0}}, {"radius", 0.0}}}};
            const double distance = glm::length(start);
            round["inside"] = true;
            json shape{{kind, round}};
            if (isPlane)
                shape = {{"plane",
                          {{"offset", list(start * (1.0 - radius / distance))},
                           {"normal", list(-start / distance)}}}};
            collider["extensions"]["VRMC_springBone_extended_collider"] = {{"specVersion", "1.0"},
                                                                           {"shape", shape}};
            _hasExtended = true;
        }
        _colliders.push_back(int(_result["colliders"].size()));
        _result["colliders"].push_back(collider);
    }

    void addChain(const SpringSettings::Chain& chain) {
        std::map<std::size_t, const SpringSettings::Joint*> joints;
        for (const SpringSettings::Joint& joint : chain.joints)
            if (const int j = find(joint.name); j >= 0) joints.emplace(std::size_t(j), &joint);
        std::map<std::size_t, std::size_t> tails; // nodes
        std::set<std::size_t> reached;
        for (const auto& [j, joint] : joints) {
            tails[j] = tailOf(j, joint->tip);
            reached.insert(tails[j]);
        }
        json common = json::object();
        if (const int centre = find(chain.centre); centre >= 0) common["center"] = centre;
        std::vector<int> group;
        for (const std::size_t c : chain.colliders)
            if (c < _colliders.size() && _colliders[c] >= 0) group.push_back(_colliders[c]);
        if (!group.empty())
            common["colliderGroups"] = {_groups.emplace(group, _groups.size()).first->second};
        for (const auto& entry : joints) {
            if (reached.count(entry.first) > 0) continue; // goes on another's line
            json spring = common;
            std::size_t j = entry.first;
            for (auto next = joints.find(j); next != joints.end(); next = joints.find(j)) {
                spring["joints"].push_back(jointJson(j, *next->second));
                j = tails[j];
            }
            spring["joints"].push_back({{"node", j}});
            _result["springs"].push_back(spring);
        }
    }

    json jointJson(std::size_t node, const SpringSettings::Joint& from) const {
        const double power = glm::length(from.gravity);
        json result{{"node", node},
                    {"stiffness", from.stiffness},
                    {"dragForce", from.drag},
                    {"hitRadius", from.radius * _toGltf.scale()},
                    {"gravityPower", power}};
        if (power > 0.0) result["gravityDir"] = list(_toGltf.direction(from.gravity / power));
        return result;
    }

    /// The node at the end of a joint's bone: a joint below it, or a new one.
    std::size_t tailOf(std::size_t joint, const glm::dvec3& tip) {
        for (const int child : _rest.children(int(joint)))
            if (glm::length(centre(std::size_t(child)) - tip) <=
                1e-6 * glm::length(tip - centre(joint)))
                return std::size_t(child);
        const auto [known, isNew] = _ends.emplace(joint, _root["nodes"].size());
        if (isNew) {
            _root["nodes"].push_back({{"name", _rest.joints[joint].name + "_end"},
                                      {"translation", list(offset(joint, tip))}});
            _root["nodes"][joint]["children"].push_back(known->second);
        }
        return known->second;
    }

    const osgSkin::RestSkeleton& _rest;
    const ToGltf& _toGltf;
    const SpringSettings& _settings;
    json& _root;
    json _result = json::object();
    std::vector<int> _colliders; ///< of the settings', indices in the file; -1: none
    std::map<std::vector<int>, std::size_t> _groups;
    std::map<std::size_t, std::size_t> _ends; ///< new nodes, by joint
    bool _hasExtended = false;
};

} // namespace

Vrm::Vrm(const osgSkin::Character& character) : _character(character), _toGltf(character) {
    const auto& joints = character.rest.joints;
    if (std::none_of(joints.begin(), joints.end(),
                     [](const osgSkin::RestJoint& joint) { return !joint.role.empty(); }))
        return;
    const json file = jsonOf(character.meshFile);
    const json &first = at(at(file, "extensions"), "VRM"),
               &second = at(at(file, "extensions"), "VRMC_vrm");
    if (second.is_object())
        readSecond(second);
    else if (first.is_object())
        readFirst(first);
    std::vector<std::string> missing;
    json& meta = _human["meta"];
    if (textAt(meta, "name").empty()) missing.emplace_back("a name");
    const json& authors = at(meta, "authors");
    if (!authors.is_array() || authors.empty()) missing.emplace_back("an author");
    if (textAt(meta, "licenseUrl").empty()) missing.emplace_back("a licence's address");
    addBones(missing);
    addFaceBones(at(at(second.is_object() ? second : first, "humanoid"), "humanBones"),
                 at(file, "nodes"));
    if (!missing.empty()) {
        _note = "not written as VRM, as the file lacks ";
        for (const std::string& each : missing) _note += (&each == &missing[0] ? "" : ", ") + each;
        _human = nullptr;
        _expressions.clear();
        _leftOut.clear();
    }
    if (hasToonShading(file)) _leftOut.emplace_back("toon shading (MToon)");
}

void Vrm::readSecond(const json& vrm) {
    _human["meta"] = at(vrm, "meta");
    if (_human["meta"].is_object())
        for (const char* name : {"thumbnailImage", "extensions", "extras"})
            if (_human["meta"].erase(name) > 0) _leftOut.emplace_back(name);
    for (const bool isPreset : {true, false})
        for (const auto& [name, expression] :
             at(at(vrm, "expressions"), isPreset ? "preset" : "custom").items())
            addExpression(expression, name, {isPreset, name, json::object()});
    if (!at(vrm, "firstPerson").is_null()) _leftOut.emplace_back("firstPerson");
    json lookAt = at(vrm, "lookAt");
    const int head = _character.roles.joint("Head");
    if (!lookAt.is_object() || head < 0) return;
    json& offset = lookAt["offsetFromHeadBone"];
    glm::dvec3 v(0.0);
    for (std::size_t k = 0; k < 3 && offset.is_array() && offset.size() == 3; ++k)
        if (offset[k].is_number()) v[int(k)] = offset[k];
    // The head's node has no rotation at rest here.
    offset = list(_toGltf.direction(_character.rest.joints[std::size_t(head)].frame * v));
    _human["lookAt"] = lookAt;
}

void Vrm::readFirst(const json& vrm) {
    const json& meta = at(vrm, "meta");
    _human["meta"] = metaOfFirst(meta);
    _note = "VRM 0 is written as VRM 1: its permissions, the licence \"" +
            textAt(meta, "licenseName") + "\" as " + textAt(_human["meta"], "licenseUrl") +
            ", and the names of expressions";
    std::set<std::string> presets;
    for (const auto& [key, group] : at(at(vrm, "blendShapeMaster"), "blendShapeGroups").items()) {
        const std::string preset = textAt(group, "presetName");
        const bool isPreset =
            !preset.empty() && preset != "unknown" && presets.insert(preset).second;
        const std::string morph = isPreset ? preset : textAt(group, "name");
        addExpression(group, morph,
                      {isPreset, isPreset ? presetOfFirst(morph) : morph, json::object()});
    }
    if (!at(vrm, "firstPerson").is_null()) _leftOut.emplace_back("firstPerson and lookAt");
}

void Vrm::addExpression(const json& from, const std::string& morph, Expression expression) {
    if (at(from, "isBinary") == true) expression.rules["isBinary"] = true;
    for (const char* name : {"overrideBlink", "overrideLookAt", "overrideMouth"})
        if (const std::string how = textAt(from, name); how == "block" || how == "blend")
            expression.rules[name] = how;
    for (const char* name : {"materialColorBinds", "textureTransformBinds", "materialValues"})
        if (!at(from, name).empty())
            _leftOut.emplace_back("colours and textures of expression \"" + expression.name + '"');
    if (!morph.empty()) _expressions.emplace(morph, std::move(expression));
}

void Vrm::addBones(std::vector<std::string>& missing) {
    json bones = json::object();
    for (const auto& [name, role] : namesOfBones())
        if (const int joint = _character.roles.joint(role); joint >= 0)
            bones[name] = {{"node", joint}};
    const auto found = _character.roles.joints.find("Spine");
    const std::vector<int> spine =
        found == _character.roles.joints.end() ? std::vector<int>() : found->second;
    if (!spine.empty()) bones["spine"] = {{"node", spine.front()}};
    if (spine.size() > 1) bones["chest"] = {{"node", spine[1]}};
    if (spine.size() > 2) bones["upperChest"] = {{"node", spine.back()}};
    for (const char* name :
         {"hips", "spine", "head", "leftUpperLeg", "leftLowerLeg", "leftFoot", "rightUpperLeg",
          "rightLowerLeg", "rightFoot", "leftUpperArm", "leftLowerArm", "leftHand", "rightUpperArm",
          "rightLowerArm", "rightHand"})
        if (!bones.contains(name)) missing.emplace_back(name);
    _human["specVersion"] = "1.0";
    _human["humanoid"]["humanBones"] = bones;
}

void Vrm::addFaceBones(const json& bones, const json& nodes) {
    for (const auto& [key, bone] : bones.items()) {
        const std::string listed = textAt(bone, "bone"); // VRM 0's list
        const std::string name = listed.empty() ? key : listed;
        const json& node = at(bone, "node");
        if ((name != "leftEye" && name != "rightEye" && name != "jaw") ||
            !node.is_number_unsigned() || node.get<std::size_t>() >= nodes.size())
            continue;
        const int joint = _character.rest.find(textAt(nodes[node.get<std::size_t>()], "name"));
        if (joint >= 0) _human["humanoid"]["humanBones"][name] = {{"node", joint}};
    }
}

void Vrm::write(const std::vector<std::string>& morphs, std::size_t meshNode, json& root) const {
    const auto use = [&](const char* name) { root["extensionsUsed"].push_back(name); };
    const auto* springs = osgSkin::find<osgSkin::SpringBones>(*_character.root);
    if (springs && !springs->getSettings().chains.empty()) {
        SpringWriter writer(_character, _toGltf, springs->getSettings(), root);
        root["extensions"]["VRMC_springBone"] = writer.run();
        use("VRMC_springBone");
        if (writer.hasExtended()) use("VRMC_springBone_extended_collider");
    }
    if (!isHuman()) return;
    json human = _human;
    for (const auto& [morph, expression] : _expressions) {
        json& to = human["expressions"][expression.isPreset ? "preset" : "custom"][expression.name];
        to = expression.rules;
        const auto target = std::find(morphs.begin(), morphs.end(), morph);
        if (target != morphs.end()) // else it moves nothing, such as "neutral"
            to["morphTargetBinds"] = {
                {{"node", meshNode}, {"index", target - morphs.begin()}, {"weight", 1.0}}};
    }
    root["extensions"]["VRMC_vrm"] = human;
    use("VRMC_vrm");
}

} // namespace bake
