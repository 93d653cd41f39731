// SPDX-License-Identifier: MIT
//
// A person of boxes as a VRM 1 file: human bones, eyes and expressions.
#pragma once

#include "GltfBuilder.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

namespace test {

/// 1.8 m tall, in a T-pose, facing +z. Each bone has a box of weight 1. The targets "smile", "lids"
/// and "mouth" move the head's box along x, y and z, by 0.01, 0.02 and 0.03 m.
struct VrmFigure : GltfBuilder {
    std::map<std::string, std::size_t> bones; ///< node of each, by VRM's name
    std::size_t meshNode = 0;
    std::vector<double> places; ///< of the mesh's vertices

    VrmFigure() {
        bone("hips", "", {0, 1, 0});
        bone("spine", "hips", {0, 1.12, 0});
        bone("chest", "spine", {0, 1.28, 0});
        bone("neck", "chest", {0, 1.48, 0});
        bone("head", "neck", {0, 1.58, 0});
        for (const std::string side : {"left", "right"}) {
            const double x = side == "left" ? 1.0 : -1.0;
            bone(side + "Eye", "head", {0.03 * x, 1.66, 0.08});
            bone(side + "Shoulder", "chest", {0.04 * x, 1.43, 0});
            bone(side + "UpperArm", side + "Shoulder", {0.18 * x, 1.43, 0});
            bone(side + "LowerArm", side + "UpperArm", {0.46 * x, 1.43, 0});
            bone(side + "Hand", side + "LowerArm", {0.72 * x, 1.43, 0});
            bone(side + "UpperLeg", "hips", {0.1 * x, 0.94, 0});
            bone(side + "LowerLeg", side + "UpperLeg", {0.1 * x, 0.52, 0});
            bone(side + "Foot", side + "LowerLeg", {0.1 * x, 0.09, 0});
            bone(side + "Toes", side + "Foot", {0.1 * x, 0.03, 0.13});
        }
        nlohmann::json& human = vrm()["humanoid"]["humanBones"];
        for (const auto& [name, node] : bones) human[name] = {{"node", node}};
        vrm()["specVersion"] = "1.0";
        vrm()["meta"] = {{"name", "figure"},
                         {"authors", {"a test"}},
                         {"licenseUrl", "https://vrm.dev/licenses/1.0/"}};
        addMesh();
        json["extensionsUsed"] = {"VRMC_vrm"};
        json["scenes"][0]["nodes"] = {bones["hips"], meshNode};
    }

    nlohmann::json& vrm() { return json["extensions"]["VRMC_vrm"]; }

    /// "happy" moves "smile" and is binary; it blocks blinking. "blink" moves "lids", and "aa"
    /// moves "mouth". "smirk" is an own expression of half of "smile", and dims the mouth.
    void addExpressions() {
        const auto binds = [&](std::size_t target, double weight) {
            return nlohmann::json::array(
                {{{"node", meshNode}, {"index", target}, {"weight", weight}}});
        };
        vrm()["expressions"] = {
            {"preset",
             {{"happy",
               {{"morphTargetBinds", binds(0, 1)}, {"isBinary", true}, {"overrideBlink", "block"}}},
              {"blink", {{"morphTargetBinds", binds(1, 1)}}},
              {"aa", {{"morphTargetBinds", binds(2, 1)}}}}},
            {"custom",
             {{"smirk", {{"morphTargetBinds", binds(0, 0.5)}, {"overrideMouth", "blend"}}}}}};
    }

private:
    void bone(const std::string& name, const std::string& parent, std::array<double, 3> place) {
        std::array<double, 3> offset = place;
        for (std::size_t k = 0; !parent.empty() && k < 3; ++k)
            offset[k] -= _centres[bones[parent]][k];
        bones[name] = node({{"name", name}, {"translation", offset}});
        if (!parent.empty()) json["nodes"][bones[parent]]["children"].push_back(bones[name]);
        _centres.push_back(place);
    }

    void addMesh() {
        std::vector<double> corners, weights, indices, matrices;
        nlohmann::json joints = nlohmann::json::array();
        for (std::size_t j = 0; j < _centres.size(); ++j) {
            for (int c = 0; c < 8; ++c) {
                for (std::size_t k = 0; k < 3; ++k)
                    places.push_back(_centres[j][k] + (c >> k & 1 ? 0.04 : -0.04));
                corners.insert(corners.end(), {double(j), 0, 0, 0});
                weights.insert(weights.end(), {1, 0, 0, 0});
            }
            for (const int corner : {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                     2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5})
                indices.push_back(double(8 * j) + corner);
            for (std::size_t k = 0; k < 16; ++k)
                matrices.push_back(k >= 12 && k < 15 ? -_centres[j][k - 12]
                                   : k % 5 == 0      ? 1.0
                                                     : 0.0);
            joints.push_back(j);
        }
        nlohmann::json targets = nlohmann::json::array();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::vector<double> moves(places.size(), 0.0);
            for (std::size_t v = 8 * bones["head"]; v < 8 * bones["head"] + 8; ++v)
                moves[3 * v + axis] = 0.01 * double(axis + 1);
            targets.push_back({{"POSITION", ranged(moves)}});
        }
        const std::size_t positions = ranged(places);
        json["meshes"] = {{{"name", "boxes"},
                           {"primitives",
                            {{{"attributes",
                               {{"POSITION", positions},
                                {"JOINTS_0", accessor("VEC4", corners, 5121)},
                                {"WEIGHTS_0", accessor("VEC4", weights)}}},
                              {"indices", accessor("SCALAR", indices, 5123)},
                              {"targets", targets}}}},
                           {"extras", {{"targetNames", {"smile", "lids", "mouth"}}}}}};
        json["skins"] = {{{"joints", joints}, {"inverseBindMatrices", accessor("MAT4", matrices)}}};
        meshNode = node({{"name", "body"}, {"mesh", 0}, {"skin", 0}});
    }

    /// Positions, with the bounds that glTF demands of them.
    std::size_t ranged(const std::vector<double>& numbers) {
        const std::size_t result = accessor("VEC3", numbers);
        for (std::size_t k = 0; k < 3; ++k) {
            float low = float(numbers[k]), high = low;
            for (std::size_t i = k; i < numbers.size(); i += 3) {
                low = std::min(low, float(numbers[i]));
                high = std::max(high, float(numbers[i]));
            }
            json["accessors"][result]["min"].push_back(low);
            json["accessors"][result]["max"].push_back(high);
        }
        return result;
    }

    std::vector<std::array<double, 3>> _centres; ///< of the bones' nodes
};

} // namespace test
