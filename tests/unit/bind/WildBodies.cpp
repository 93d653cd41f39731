// SPDX-License-Identifier: GPL-3.0-or-later
#include "WildBodies.h"

#include "Shapes.h"
#include "mesh/WeldedMesh.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

using namespace osgSkin;

namespace wild {
namespace {

constexpr double kPi = 3.141592653589793;

glm::dvec3 at(const KnownBody& body, const std::string& joint) {
    return body.truth.joints.at(static_cast<std::size_t>(body.truth.find(joint))).centre;
}

double heightOf(const KnownBody& body) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const glm::dvec3& p : body.mesh.positions) {
        low = std::min(low, p.y);
        high = std::max(high, p.y);
    }
    return high - low;
}

using Faces = std::vector<std::vector<std::uint32_t>>;

Faces facesOf(const SkinMesh& mesh) {
    Faces faces;
    std::size_t corner = 0;
    for (const std::uint32_t size : mesh.faceSizes) {
        faces.emplace_back(mesh.faceVertices.begin() + static_cast<std::ptrdiff_t>(corner),
                           mesh.faceVertices.begin() + static_cast<std::ptrdiff_t>(corner + size));
        corner += size;
    }
    return faces;
}

glm::dvec3 middleOf(const SkinMesh& mesh, const std::vector<std::uint32_t>& face) {
    glm::dvec3 sum(0.0);
    for (const std::uint32_t v : face) sum += mesh.positions[v];
    return sum / static_cast<double>(face.size());
}

/// Adds faces with their own, moved vertices.
template <typename Move>
void append(SkinMesh& mesh, const Faces& faces, const Move& move) {
    std::map<std::uint32_t, std::uint32_t> copy;
    for (const auto& face : faces) {
        mesh.faceSizes.push_back(static_cast<std::uint32_t>(face.size()));
        for (const std::uint32_t v : face) {
            const auto [known, isNew] =
                copy.emplace(v, static_cast<std::uint32_t>(mesh.positions.size()));
            if (isNew) mesh.positions.push_back(move(v));
            mesh.faceVertices.push_back(known->second);
        }
    }
}

/// The faces whose centre `keep` accepts.
template <typename Keep>
Faces chosen(const SkinMesh& mesh, const Keep& keep) {
    Faces result;
    for (const auto& face : facesOf(mesh))
        if (keep(middleOf(mesh, face))) result.push_back(face);
    return result;
}

/// A surface of revolution about a segment: rings of given radii at `along`, closed at both ends.
SkinMesh lathe(const glm::dvec3& from, const glm::dvec3& to,
               const std::vector<std::array<double, 2>>& rings, bool closed = true) {
    constexpr std::uint32_t kSides = 16;
    const glm::dvec3 axis = glm::normalize(to - from), u = anyPerpendicular(axis);
    const glm::dvec3 v = glm::cross(axis, u);
    SkinMesh mesh;
    for (const auto& [along, radius] : rings)
        for (std::uint32_t s = 0; s < kSides; ++s) {
            const double angle = 2.0 * kPi * s / kSides;
            mesh.positions.push_back(glm::mix(from, to, along) +
                                     radius * (std::cos(angle) * u + std::sin(angle) * v));
        }
    const auto count = static_cast<std::uint32_t>(rings.size());
    for (std::uint32_t r = 0; r + 1 < count; ++r)
        for (std::uint32_t s = 0; s < kSides; ++s) {
            const std::uint32_t n = (s + 1) % kSides;
            mesh.faceSizes.push_back(4);
            for (const std::uint32_t c :
                 {r * kSides + s, r * kSides + n, (r + 1) * kSides + n, (r + 1) * kSides + s})
                mesh.faceVertices.push_back(c);
        }
    if (!closed) return mesh;
    mesh.faceSizes.push_back(kSides);
    for (std::uint32_t s = kSides; s-- > 0;) mesh.faceVertices.push_back(s);
    mesh.faceSizes.push_back(kSides);
    for (std::uint32_t s = 0; s < kSides; ++s)
        mesh.faceVertices.push_back((count - 1) * kSides + s);
    return mesh;
}

/// A capsule of two radii; a ball if both ends coincide except for `end`.
SkinMesh capsule(const glm::dvec3& a, const glm::dvec3& b, double ra, double rb) {
    const double length = glm::distance(a, b);
    std::vector<std::array<double, 2>> rings;
    for (const double angle : {-80.0, -55.0, -30.0, 0.0}) {
        const double r = angle * kPi / 180.0;
        rings.push_back({ra * std::sin(r) / length, ra * std::cos(r)});
    }
    for (const double angle : {0.0, 30.0, 55.0, 80.0}) {
        const double r = angle * kPi / 180.0;
        rings.push_back({1.0 + rb * std::sin(r) / length, rb * std::cos(r)});
    }
    return lathe(a, b, rings);
}

void add(SkinMesh& mesh, const SkinMesh& other) {
    mesh = shapes::joined(mesh, other);
}

/// Positions of clothes, by the heights of the hips, the neck and the joints.
struct Wardrobe {
    explicit Wardrobe(const KnownBody& body)
        : height(heightOf(body)), neck(at(body, "Neck")), hip(at(body, "LeftUpLeg")),
          elbow(at(body, "LeftForeArm")), ankle(at(body, "LeftFoot")), head(at(body, "Head")) {}

    bool jacket(const glm::dvec3& p) const {
        const bool sleeve = std::abs(p.x) < 0.97 * std::abs(elbow.x);
        return p.y > hip.y + 0.03 * height && p.y < neck.y && sleeve && !isHand(p);
    }
    bool skirt(const glm::dvec3& p) const {
        return p.y <= hip.y + 0.05 * height && p.y > hip.y - 0.17 * height && !isArm(p);
    }
    bool shoe(const glm::dvec3& p) const { return p.y < ankle.y + 0.01 * height; }
    bool hair(const glm::dvec3& p) const { return p.y > head.y && p.z < head.z + 0.04 * height; }
    bool isArm(const glm::dvec3& p) const { return std::abs(p.x) > 0.8 * std::abs(elbow.x); }
    bool isHand(const glm::dvec3& p) const { return std::abs(p.x) > std::abs(elbow.x); }

    double height;
    glm::dvec3 neck, hip, elbow, ankle, head;
};

void dress(const KnownBody& body, SkinMesh& mesh) {
    const Wardrobe w(body);
    const WeldedMesh welded(body.mesh);
    const auto offset = [&](double by) {
        return [&, by](std::uint32_t v) {
            return body.mesh.positions[v] + by * w.height * welded.normals[welded.weldedOf[v]];
        };
    };
    const SkinMesh& skin = body.mesh;
    append(mesh, chosen(skin, [&](const glm::dvec3& p) { return w.jacket(p); }), offset(0.012));
    append(mesh, chosen(skin, [&](const glm::dvec3& p) { return w.shoe(p); }), offset(0.007));
    append(mesh, chosen(skin, [&](const glm::dvec3& p) { return w.hair(p); }), offset(0.02));
    const glm::dvec3 waist(0.0, w.hip.y + 0.07 * w.height, w.hip.z);
    const glm::dvec3 hem(0.0, w.hip.y - 0.17 * w.height, w.hip.z);
    add(mesh,
        lathe(waist, hem, {{0.0, 0.09 * w.height}, {0.4, 0.12 * w.height}, {1.0, 0.15 * w.height}},
              false));
    for (const double x : {-0.02, 0.02}) {
        const glm::dvec3 eye = w.head + w.height * glm::dvec3(x, 0.03, 0.03);
        add(mesh, capsule(eye, eye + glm::dvec3(0, 0, 1e-3), 0.007 * w.height, 0.007 * w.height));
    }
    const glm::dvec3 teeth = w.head + w.height * glm::dvec3(0.0, -0.01, 0.03);
    add(mesh, capsule(teeth, teeth + glm::dvec3(0, 0, 1e-3), 0.01 * w.height, 0.01 * w.height));
}

glm::dvec3 nearestOn(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& p) {
    const double t = glm::dot(p - a, b - a) / glm::dot(b - a, b - a);
    return glm::mix(a, b, std::clamp(t, 0.0, 1.0));
}

struct Limb {
    std::string from, to;
    double radius; ///< of a mannequin's limb, relative to the height
};

std::vector<Limb> limbs() {
    std::vector<Limb> result{{"Head", "", 0.0},
                             {"Hips", "Spine", 0.075},
                             {"Spine", "Neck", 0.085},
                             {"Neck", "Head", 0.035}};
    for (const std::string side : {"Left", "Right"}) {
        result.push_back({side + "Arm", side + "ForeArm", 0.026});
        result.push_back({side + "ForeArm", side + "Hand", 0.021});
        result.push_back({side + "Hand", side + "HandIndex1", 0.0});
        result.push_back({side + "UpLeg", side + "Leg", 0.044});
        result.push_back({side + "Leg", side + "Foot", 0.032});
        result.push_back({side + "Foot", side + "ToeBase", 0.0});
    }
    return result;
}

} // namespace

KnownBody clothed(const KnownBody& body) {
    KnownBody result = body;
    dress(body, result.mesh);
    return result;
}

KnownBody hollowClothed(const KnownBody& body) {
    const Wardrobe w(body);
    KnownBody result{{}, body.truth};
    append(result.mesh,
           chosen(body.mesh,
                  [&](const glm::dvec3& p) { return !w.jacket(p) && !w.skirt(p) && !w.shoe(p); }),
           [&](std::uint32_t v) { return body.mesh.positions[v]; });
    dress(body, result.mesh);
    return result;
}

KnownBody segmented(const KnownBody& body, double shrunk, bool lids) {
    const std::vector<Limb> parts = limbs();
    std::vector<Faces> cut(parts.size());
    for (const auto& face : facesOf(body.mesh)) {
        const glm::dvec3 p = middleOf(body.mesh, face);
        std::size_t best = 0;
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const glm::dvec3 a = at(body, parts[i].from);
            const glm::dvec3 b = parts[i].to.empty()
                                     ? a + glm::dvec3(0.0, 0.08 * heightOf(body), 0.0)
                                     : at(body, parts[i].to);
            const double away = glm::distance(p, nearestOn(a, b, p));
            if (away >= nearest) continue;
            nearest = away;
            best = i;
        }
        cut[best].push_back(face);
    }
    KnownBody result{{}, body.truth};
    for (const Faces& piece : cut) {
        if (piece.empty()) continue;
        glm::dvec3 middle(0.0);
        for (const auto& face : piece)
            middle += middleOf(body.mesh, face) / static_cast<double>(piece.size());
        SkinMesh mesh;
        append(mesh, piece,
               [&](std::uint32_t v) { return glm::mix(body.mesh.positions[v], middle, shrunk); });
        if (lids) {
            // A fan over each edge that has only one face.
            std::map<std::array<std::uint32_t, 2>, int> edges;
            std::size_t corner = 0;
            for (const std::uint32_t size : mesh.faceSizes) {
                for (std::size_t i = 0; i < size; ++i) {
                    const std::uint32_t a = mesh.faceVertices[corner + i];
                    const std::uint32_t b = mesh.faceVertices[corner + (i + 1) % size];
                    const auto other = edges.find({b, a});
                    if (other != edges.end())
                        edges.erase(other);
                    else
                        edges[{a, b}] = 1;
                }
                corner += size;
            }
            const auto tip = static_cast<std::uint32_t>(mesh.positions.size());
            glm::dvec3 centre(0.0);
            for (const auto& [edge, one] : edges) centre += mesh.positions[edge[0]];
            if (!edges.empty())
                mesh.positions.push_back(centre / static_cast<double>(edges.size()));
            for (const auto& [edge, one] : edges) {
                mesh.faceSizes.push_back(3);
                for (const std::uint32_t v : {edge[1], edge[0], tip})
                    mesh.faceVertices.push_back(v);
            }
        }
        add(result.mesh, mesh);
    }
    return result;
}

KnownBody mannequin(const KnownBody& body) {
    const double height = heightOf(body);
    KnownBody result{{}, body.truth};
    const auto tipOf = [&](const std::string& joint, const glm::dvec3& way, double length) {
        return at(body, joint) + length * height * glm::normalize(way);
    };
    for (const Limb& limb : limbs()) {
        const glm::dvec3 a = at(body, limb.from);
        if (limb.from == "Head") {
            add(result.mesh, capsule(a + glm::dvec3(0, 0.01 * height, 0.02 * height),
                                     a + glm::dvec3(0, 0.04 * height, 0.02 * height),
                                     0.045 * height, 0.05 * height));
        } else if (limb.radius > 0.0) {
            add(result.mesh, capsule(a, at(body, limb.to), limb.radius * height,
                                     limb.radius * height * (limb.from == "Spine" ? 1.0 : 0.85)));
        } else if (limb.from.find("Hand") != std::string::npos) {
            const glm::dvec3 way = at(body, limb.to) - a;
            add(result.mesh, capsule(tipOf(limb.from, way, 0.02), tipOf(limb.from, way, 0.08),
                                     0.024 * height, 0.015 * height));
        } else {
            add(result.mesh,
                capsule(a - glm::dvec3(0, 0.01 * height, 0.01 * height),
                        at(body, limb.to) + glm::dvec3(0, 0.01 * height, 0.02 * height),
                        0.025 * height, 0.018 * height));
        }
    }
    // Shoulders, and a pelvis as wide as the hips.
    add(result.mesh,
        capsule(at(body, "LeftArm"), at(body, "RightArm"), 0.032 * height, 0.032 * height));
    add(result.mesh,
        capsule(at(body, "LeftUpLeg"), at(body, "RightUpLeg"), 0.048 * height, 0.048 * height));
    return result;
}

KnownBody cartoon(const KnownBody& body, double head, double legs) {
    const glm::dvec3 neck = at(body, "Neck1"), top = at(body, "Head");
    const double hip = at(body, "LeftUpLeg").y;
    return body.mapped([=](const glm::dvec3& p) {
        const double share = std::clamp((p.y - neck.y) / (top.y - neck.y), 0.0, 1.0);
        const double factor = 1.0 + (head - 1.0) * share;
        glm::dvec3 q = p.y > neck.y ? neck + factor * (p - neck) : p;
        q.y = q.y < hip ? legs * q.y : q.y - (1.0 - legs) * hip;
        return q;
    });
}

KnownBody thinArms(const KnownBody& body, double arms, double hands) {
    KnownBody result = body;
    for (glm::dvec3& p : result.mesh.positions) {
        const std::string side = p.x > 0.0 ? "Left" : "Right";
        const glm::dvec3 shoulder = at(body, side + "Arm"), elbow = at(body, side + "ForeArm");
        const glm::dvec3 wrist = at(body, side + "Hand");
        const double along =
            glm::dot(p - shoulder, elbow - shoulder) / glm::dot(elbow - shoulder, elbow - shoulder);
        if (along < 0.2 || std::abs(p.x) < std::abs(shoulder.x)) continue;
        const glm::dvec3 tip = wrist + 0.6 * (wrist - elbow);
        glm::dvec3 q = nearestOn(shoulder, elbow, p);
        double factor = arms;
        for (const auto& [a, b] : {std::array{elbow, wrist}, std::array{wrist, tip}}) {
            const glm::dvec3 other = nearestOn(a, b, p);
            if (glm::distance(p, other) >= glm::distance(p, q)) continue;
            q = other;
            if (a == wrist) {
                const double out = glm::distance(q, wrist) / glm::distance(elbow, wrist);
                factor = glm::mix(arms, hands, std::min(1.0, 6.0 * out));
            }
        }
        const double share = std::min(1.0, (along - 0.2) / 0.3);
        p = q + (1.0 + (factor - 1.0) * share) * (p - q);
    }
    return result;
}

KnownBody flawed(const KnownBody& body) {
    KnownBody result{{body.mesh.positions, {}, {}}, body.truth};
    SkinMesh& mesh = result.mesh;
    for (std::vector<std::uint32_t> face : facesOf(body.mesh)) {
        if (middleOf(body.mesh, face).x > 0.0) std::reverse(face.begin(), face.end());
        for (int copy = 0; copy < 2; ++copy) {
            mesh.faceSizes.push_back(static_cast<std::uint32_t>(face.size()));
            mesh.faceVertices.insert(mesh.faceVertices.end(), face.begin(), face.end());
        }
    }
    return result;
}

} // namespace wild
