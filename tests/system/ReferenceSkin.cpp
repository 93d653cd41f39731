// SPDX-License-Identifier: MIT
#include "ReferenceSkin.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace test {
namespace {

glm::dvec3 vector(const nlohmann::json& json) {
    return {json[0], json[1], json[2]};
}

/// Rodrigues' formula.
glm::dvec3 turned(const glm::dvec3& x, const glm::dvec3& axis, double angle) {
    return x * std::cos(angle) + glm::cross(axis, x) * std::sin(angle) +
           axis * glm::dot(axis, x) * (1.0 - std::cos(angle));
}

/// A joint's rotation in the pose, split by the paper's equations 2 to 4 with arc tangents.
struct Split {
    glm::dvec3 v{1, 0, 0};
    double psi = 0.0;
    double phi = 0.0;

    Split(glm::dquat q, const glm::dvec3& w) {
        const double along = glm::dot(glm::dvec3(q.x, q.y, q.z), w);
        phi = 2.0 * std::atan2(along, q.w);
        if (phi > M_PI) phi -= 2.0 * M_PI;
        if (phi < -M_PI) phi += 2.0 * M_PI;
        const glm::dquat untwist(std::cos(phi / 2), -std::sin(phi / 2) * w);
        glm::dquat bend = q * untwist;
        if (bend.w < 0) bend = -bend;
        const glm::dvec3 axis(bend.x, bend.y, bend.z);
        psi = 2.0 * std::atan2(glm::length(axis), bend.w);
        if (glm::length(axis) > 1e-14) v = glm::normalize(axis);
    }
};

} // namespace

std::vector<glm::dvec3> readObjVertices(const std::string& file) {
    std::ifstream in(file);
    std::vector<glm::dvec3> vertices;
    for (std::string line; std::getline(in, line);) {
        if (line.rfind("v ", 0) != 0) continue;
        std::istringstream numbers(line.substr(2));
        glm::dvec3 v;
        numbers >> v.x >> v.y >> v.z;
        vertices.push_back(v);
    }
    return vertices;
}

std::vector<std::vector<int>> readObjFaces(const std::string& file) {
    std::ifstream in(file);
    std::vector<std::vector<int>> faces;
    for (std::string line; std::getline(in, line);) {
        if (line.rfind("f ", 0) != 0) continue;
        std::istringstream corners(line.substr(2));
        faces.emplace_back();
        for (std::string corner; corners >> corner;) faces.back().push_back(std::stoi(corner));
    }
    return faces;
}

ReferenceSkin::ReferenceSkin(const nlohmann::json& binding, std::vector<glm::dvec3> rest)
    : _rest(std::move(rest)) {
    for (const nlohmann::json& joint : binding["joints"])
        _joints.push_back({joint["name"], joint["parent"].is_null(), vector(joint["centre"]),
                           vector(joint["twistAxis"])});
    for (const nlohmann::json& vertex : binding["vertices"]) {
        _shares.emplace_back();
        for (const nlohmann::json& ratio : vertex["ratios"])
            _shares.back()[ratio[0]] = {ratio[1], ratio[2]};
        _vectors.emplace_back();
        if (vertex.contains("correctives"))
            for (const nlohmann::json& entry : vertex["correctives"])
                for (const nlohmann::json& mode : entry[1])
                    _vectors.back()[entry[0].get<std::size_t>()].push_back(vector(mode));
    }
    if (binding.contains("correctives"))
        for (const nlohmann::json& joint : binding["correctives"]) _shapes.emplace_back(joint);
}

void ReferenceSkin::correct(const nlohmann::json& frame, std::vector<glm::dvec3>& vertices) const {
    const auto add = [&](std::size_t shapes, const std::vector<double>& weights) {
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const auto own = _vectors[i].find(shapes);
            for (std::size_t k = 0; own != _vectors[i].end() && k < weights.size(); ++k)
                vertices[i] += weights[k] * own->second.at(k);
        }
    };
    for (std::size_t s = 0; s < _shapes.size(); ++s) {
        const ReferenceShapes& shapes = _shapes[s];
        if (shapes.isInput()) {
            add(s, shapes.weights(frame["inputs"][shapes.joint()].get<double>()));
            continue;
        }
        for (const Joint& joint : _joints) {
            if (joint.name != shapes.joint()) continue;
            const nlohmann::json& r = frame["joints"][joint.name]["rotation"];
            const Split split(
                {r[0].get<double>(), r[1].get<double>(), r[2].get<double>(), r[3].get<double>()},
                joint.twistAxis);
            add(s, shapes.weights(split.v, split.psi, joint.twistAxis));
        }
    }
}

std::vector<glm::dvec3> ReferenceSkin::pose(const nlohmann::json& frame) const {
    std::vector<glm::dvec3> posed = _rest;
    correct(frame, posed);
    // x' = D_1(a_1) ... D_n(a_n) x: the last joint is applied first.
    for (auto joint = _joints.rbegin(); joint != _joints.rend(); ++joint) {
        const nlohmann::json& turn = frame["joints"][joint->name];
        const nlohmann::json& r = turn["rotation"];
        const glm::dquat q(r[0].get<double>(), r[1].get<double>(), r[2].get<double>(),
                           r[3].get<double>());
        const glm::dvec3 translation = vector(turn["translation"]);
        if (joint->root) {
            for (glm::dvec3& x : posed) x = q * x + translation;
            continue;
        }
        const Split split(q, joint->twistAxis);
        for (std::size_t i = 0; i < posed.size(); ++i) {
            const auto share = _shares[i].find(joint->name);
            if (share == _shares[i].end()) continue;
            glm::dvec3 x = posed[i] - joint->centre;
            x = turned(x, joint->twistAxis, share->second.twist * split.phi);
            x = turned(x, split.v, share->second.bend * split.psi);
            posed[i] = x + joint->centre + share->second.bend * translation;
        }
    }
    return posed;
}

double ReferenceSkin::height() const {
    const auto range =
        std::minmax_element(_rest.begin(), _rest.end(),
                            [](const glm::dvec3& a, const glm::dvec3& b) { return a.y < b.y; });
    return range.second->y - range.first->y;
}

} // namespace test
