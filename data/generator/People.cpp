// SPDX-License-Identifier: MIT
#include "People.h"

#include "BvhWriter.h"
#include "MannequinSkeleton.h"
#include "ThrowPose.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace mannequin {
namespace {

using glm::dvec3;

/// A number from 0 to 1 for a person and a question about it. The same with all compilers.
class Draws {
public:
    explicit Draws(unsigned int seed) : _state(0x9e3779b97f4a7c15u * (seed + 1u)) {}
    double operator()() {
        _state += 0x9e3779b97f4a7c15u;
        std::uint64_t z = _state;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return double((z ^ (z >> 31)) >> 11) / 9007199254740992.0;
    }
    double operator()(double least, double most) { return least + (most - least) * (*this)(); }
    bool chance(double share) { return (*this)() < share; }
    template <std::size_t N>
    const dvec3& of(const dvec3 (&colours)[N]) {
        return colours[std::min(N - 1, static_cast<std::size_t>((*this)() * double(N)))];
    }

private:
    std::uint64_t _state;
};

const dvec3 kSkins[] = {{0.86, 0.67, 0.57}, {0.80, 0.60, 0.49}, {0.74, 0.53, 0.40},
                        {0.60, 0.41, 0.29}, {0.43, 0.28, 0.20}, {0.30, 0.19, 0.14}};
const dvec3 kHairs[] = {{0.07, 0.06, 0.06}, {0.16, 0.11, 0.08}, {0.27, 0.17, 0.10},
                        {0.45, 0.30, 0.16}, {0.66, 0.50, 0.28}, {0.42, 0.16, 0.08}};
const dvec3 kGreys[] = {{0.48, 0.47, 0.46}, {0.70, 0.69, 0.67}, {0.82, 0.81, 0.79}};
const dvec3 kCoats[] = {{0.22, 0.31, 0.42}, {0.12, 0.13, 0.16}, {0.36, 0.37, 0.38},
                        {0.44, 0.33, 0.22}, {0.40, 0.13, 0.13}, {0.20, 0.30, 0.20},
                        {0.55, 0.47, 0.36}, {0.16, 0.28, 0.32}};
const dvec3 kBright[] = {{0.75, 0.22, 0.18}, {0.85, 0.62, 0.18}, {0.25, 0.48, 0.68},
                         {0.82, 0.80, 0.76}, {0.35, 0.56, 0.38}, {0.70, 0.42, 0.52},
                         {0.45, 0.35, 0.58}, {0.90, 0.88, 0.84}};
const dvec3 kTrousers[] = {{0.36, 0.34, 0.31}, {0.16, 0.20, 0.30}, {0.10, 0.10, 0.12},
                           {0.48, 0.43, 0.34}, {0.27, 0.33, 0.42}, {0.25, 0.22, 0.20}};
const dvec3 kShoes[] = {{0.24, 0.15, 0.10},
                        {0.08, 0.08, 0.09},
                        {0.75, 0.74, 0.72},
                        {0.30, 0.32, 0.36},
                        {0.50, 0.12, 0.12}};

enum class Below { Trousers, Shorts, Skirt, Coat };
enum class Hair { Short, Long, Bun, Cap };

/// How a person differs from the pedestrian. Lengths are those of a figure of 1.80 m, before it is
/// scaled.
struct Person {
    double height = 1.80;
    double head = 1.0, legs = 1.0, arms = 1.0;       ///< lengths
    double shoulders = 1.0, waist = 1.0, hips = 1.0; ///< breadths
    double limbs = 1.0;                              ///< girths
    double belly = 0.0, bust = 0.0, stoop = 0.0;     ///< m
    Below below = Below::Trousers;
    double hem = 0.45; ///< height of the lower edge of a skirt, coat or shorts
    bool hasShortSleeves = false, hasBackpack = false;
    Hair hair = Hair::Short;
    std::map<std::string, dvec3> colours;
};

/// Chooses clothes, hair and a bag.
void dress(Person& person, Draws& draw, bool isWoman, bool isChild, bool isOld) {
    const dvec3 skin = draw.of(kSkins), hair = isOld ? draw.of(kGreys) : draw.of(kHairs);
    const dvec3 cloth = isChild             ? draw.of(kBright)
                        : draw.chance(0.35) ? draw.of(kBright)
                                            : draw.of(kCoats);
    const dvec3 legs = draw.of(kTrousers), shirt = draw.of(kBright), shoes = draw.of(kShoes);
    const dvec3 bag = draw.of(kCoats), cap = draw.of(kBright), skirt = draw.of(kCoats);
    person.hasShortSleeves = draw.chance(isOld ? 0.1 : 0.35);
    const double below = draw();
    if (isWoman && below < 0.4) {
        person.below = Below::Skirt;
        person.hem = draw(0.36, 0.58);
    } else if (isChild && below < 0.7) {
        person.below = Below::Shorts;
        person.hem = draw(0.54, 0.60);
    } else if (!isChild && below > (person.hasShortSleeves ? 0.85 : 0.6)) {
        person.below = person.hasShortSleeves ? Below::Shorts : Below::Coat;
        person.hem = person.hasShortSleeves ? 0.55 : draw(0.40, 0.62);
    }
    const double head = draw();
    if (isWoman) person.hair = head < 0.55 ? Hair::Long : head < 0.8 ? Hair::Bun : Hair::Short;
    if (!isWoman && head < 0.2) person.hair = Hair::Cap;
    person.hasBackpack = draw.chance(isChild ? 0.5 : isOld ? 0.1 : 0.3);
    const bool isBareLegged = person.below == Below::Shorts || draw.chance(0.5);
    person.colours = {{"hair", person.hair == Hair::Cap ? cap : hair},
                      {"skin", skin},
                      {"eyes", {0.12, 0.09, 0.08}},
                      {"lips", glm::mix(skin, dvec3(0.62, 0.26, 0.24), isWoman ? 0.55 : 0.35)},
                      {"shirt", shirt},
                      {"jacket", cloth},
                      {"trousers", legs},
                      {"skirt", person.below == Below::Coat     ? cloth
                                : person.below == Below::Shorts ? legs
                                                                : skirt},
                      {"legs", isBareLegged ? skin : dvec3(0.16, 0.14, 0.14)},
                      {"shoes", shoes},
                      {"soles", glm::mix(shoes, dvec3(0.7), 0.6)},
                      {"bag", bag}};
    if (person.below == Below::Coat) person.colours["legs"] = legs;
    if (person.hasShortSleeves) person.colours["shirt"] = cloth;
}

Person personOf(unsigned int seed) {
    Draws draw(seed);
    Person person;
    const bool isWoman = seed % 2 == 1;
    const double age = draw();
    const bool isChild = seed % 6 == 4 || seed % 12 == 9, isOld = !isChild && age > 0.72;
    const double weight = draw(-1.0, 1.0) + draw(-1.0, 1.0); // of -2 to 2
    if (isChild) {
        const double grown = draw(0.0, 1.0); // from 6 to 12 years
        person.height = 1.14 + 0.36 * grown;
        person.head = 1.34 - 0.16 * grown;
        person.legs = 0.93 + 0.05 * grown;
        person.arms = 0.95;
        person.shoulders = 0.94;
        person.limbs = 1.02 - 0.06 * grown + 0.04 * weight;
        person.belly = 0.012 - 0.008 * grown + 0.008 * std::max(0.0, weight);
    } else if (isWoman) {
        person.height = 1.66 + draw(-0.09, 0.09);
        person.head = 1.03;
        person.legs = 1.01;
        person.arms = 0.97;
        person.shoulders = 0.90 + 0.02 * weight;
        person.waist = 0.86 + 0.05 * weight;
        person.hips = 1.02 + 0.04 * weight;
        person.limbs = 0.92 + 0.07 * weight;
        person.bust = 0.032 + 0.008 * weight;
        person.belly = 0.012 * std::max(0.0, weight);
    } else {
        person.height = 1.79 + draw(-0.11, 0.11);
        person.shoulders = 1.0 + 0.03 * weight;
        person.waist = 1.0 + 0.05 * weight;
        person.hips = 1.0 + 0.03 * weight;
        person.limbs = 1.0 + 0.07 * weight;
        person.belly = 0.030 * std::max(0.0, weight);
    }
    if (isOld) {
        person.height -= 0.04;
        person.stoop = draw(0.03, 0.06);
        person.belly += 0.012;
        person.waist += 0.04;
    }
    dress(person, draw, isWoman, isChild, isOld);
    return person;
}

double ramp(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

double bump(double x, double middle, double width) {
    return std::exp(-(x - middle) * (x - middle) / (width * width));
}

/// Carries points and joints of the pedestrian to a person's body.
class Shape {
public:
    explicit Shape(const Person& person) : _person(person) {
        for (const RestJoint& joint : restSkeleton()) _joints[joint.name] = joint.centre;
        _scale = 1.0;
        _scale = person.height / whole({0.0, 1.80, 0.005}, false).y;
    }

    /// \param onArm whether the point is on an arm
    /// \param isSkin whether it belongs to the body below trousers and sleeves, where these are short
    dvec3 at(const dvec3& point, bool isSkin) const { return _scale * whole(point, isSkin); }

private:
    dvec3 whole(const dvec3& p, bool isSkin) const {
        const double side = p.x < 0.0 ? -1.0 : 1.0;
        const dvec3 left(std::abs(p.x), p.y, p.z);
        const double arm = p.y > 0.86 ? ramp(0.175, 0.235, left.x) : 0.0;
        dvec3 result = trunk(left, isSkin);
        if (arm > 0.0) result = glm::mix(result, armed(left, isSkin), arm);
        result.x *= side;
        if (left.x < 1e-9) result.x = 0.0;
        // An old back is bent from the waist up.
        const double bent = ramp(1.05, 1.65, p.y);
        return result +
               dvec3(0.0, -0.25 * _person.stoop * bent, _person.stoop * bent * (1.0 + bent));
    }

    /// The height of what lies at a height in the pedestrian.
    double raised(double y) const {
        return y < 0.93 ? y * _person.legs : y + 0.93 * (_person.legs - 1.0);
    }

    dvec3 trunk(const dvec3& p, bool isSkin) const {
        if (p.y > 1.50) { // head and neck
            const dvec3 neck(0.0, 1.50, -0.035), to(0.0, raised(1.50), -0.035);
            const double scale = 1.0 + (_person.head - 1.0) * ramp(1.50, 1.58, p.y);
            return to + scale * (p - neck);
        }
        const double hips = 1.0 + (_person.hips - 1.0) * ramp(0.30, 0.88, p.y);
        double breadth = hips + (_person.waist - hips) * ramp(0.95, 1.08, p.y);
        breadth += (_person.shoulders - breadth) * ramp(1.16, 1.38, p.y);
        const double depth = 1.0 + 0.6 * (breadth - 1.0);
        dvec3 q(p.x * breadth, raised(p.y), -0.01 + (p.z + 0.01) * depth);
        if (p.y < 0.86) { // a leg's girth
            const dvec3 axis = axisAt(p.y);
            const double thin =
                isSkin ? 1.0 - 0.30 * ramp(0.55, 0.35, p.y) - 0.12 * ramp(0.30, 0.14, p.y) : 1.0;
            const double girth =
                (1.0 + (_person.limbs - 1.0) * ramp(0.86, 0.72, p.y) * ramp(0.05, 0.14, p.y)) *
                thin;
            const double applied =
                p.y > 0.115 ? girth : 1.0 + (girth - 1.0) * ramp(0.09, 0.115, p.y);
            q.x = axis.x * breadth + (p.x - axis.x) * applied;
            q.z = axis.z + (p.z - axis.z) * applied;
        }
        const double front = ramp(-0.01, 0.05, p.z);
        q.z += front * (_person.belly * bump(p.y, 1.04, 0.15) * bump(p.x, 0.0, 0.16) +
                        _person.bust * bump(p.y, 1.300, 0.065) * bump(p.x, 0.078, 0.062));
        q.x += 0.5 * _person.belly * bump(p.y, 1.04, 0.13) * ramp(0.05, 0.16, p.x);
        return q;
    }

    /// The middle of the left leg.
    dvec3 axisAt(double y) const {
        const dvec3 hip = _joints.at("LeftUpLeg"), knee = _joints.at("LeftLeg"),
                    ankle = _joints.at("LeftFoot");
        return y > knee.y ? glm::mix(knee, hip, (y - knee.y) / (hip.y - knee.y))
                          : glm::mix(ankle, knee, (y - ankle.y) / (knee.y - ankle.y));
    }

    dvec3 armed(const dvec3& p, bool isSkin) const {
        const dvec3 shoulder = _joints.at("LeftArm"), elbow = _joints.at("LeftForeArm"),
                    wrist = _joints.at("LeftHand");
        const dvec3 along = glm::normalize(wrist - shoulder);
        const double way = glm::dot(p - shoulder, along), hand = glm::dot(wrist - shoulder, along);
        const dvec3 axis =
            way < glm::dot(elbow - shoulder, along)
                ? glm::mix(shoulder, elbow, way / glm::dot(elbow - shoulder, along))
                : elbow + (wrist - elbow) * ((way - glm::dot(elbow - shoulder, along)) /
                                             glm::dot(wrist - elbow, along));
        const double size = 0.5 * (_person.arms + _person.limbs);
        double girth = way > hand ? _person.arms : size;
        if (isSkin)
            girth *= 1.0 - 0.22 * ramp(0.10, 0.22, way) * ramp(hand + 0.02, hand - 0.04, way);
        const dvec3 on = shoulder + _person.arms * (axis - shoulder) + girth * (p - axis);
        return on + trunk(shoulder, false) - shoulder;
    }

    const Person& _person;
    std::map<std::string, dvec3> _joints;
    double _scale = 1.0;
};

struct Mesh {
    std::vector<dvec3> points;
    std::vector<std::array<std::size_t, 3>> faces;
    std::vector<std::string> materials; ///< of the faces
};

Mesh readMesh(const std::string& file) {
    std::ifstream in(file);
    if (!in)
        throw std::runtime_error("cannot read " + file +
                                 ", which osgskin_generate_pedestrian makes");
    Mesh mesh;
    std::string line, material;
    while (std::getline(in, line)) {
        std::istringstream words(line);
        std::string kind;
        words >> kind;
        dvec3 p(0.0);
        std::array<std::size_t, 3> face{};
        if (kind == "v" && words >> p.x >> p.y >> p.z) mesh.points.push_back(p);
        if (kind == "usemtl") words >> material;
        if (kind == "f" && words >> face[0] >> face[1] >> face[2]) {
            for (std::size_t& corner : face) --corner;
            mesh.faces.push_back(face);
            mesh.materials.push_back(material);
        }
    }
    return mesh;
}

bool isArm(const dvec3& p) {
    return std::abs(p.x) > 0.22 && p.y > 0.86;
}

/// Metres along an arm from the shoulder to the hand.
double alongArm(const dvec3& p) {
    return glm::dot(dvec3(std::abs(p.x), p.y, p.z) - dvec3(0.183, 1.435, -0.030),
                    glm::normalize(dvec3(0.435, -0.3653, 0.0415)));
}

constexpr double kSleeve = 0.17; ///< m, of short sleeves
constexpr double kCrotch = 0.845;

/// Lets edges lie at the ends of short sleeves and of what is worn below, and paints faces by them.
void cut(Mesh& mesh, const Person& person) {
    const bool isCut = person.below != Below::Trousers;
    for (dvec3& p : mesh.points) {
        if (isCut && !isArm(p) && std::abs(p.y - person.hem) < 0.026) p.y = person.hem;
        if (person.hasShortSleeves && isArm(p)) {
            const double off = alongArm(p) - kSleeve;
            if (std::abs(off) < 0.022)
                p -= off * glm::normalize(dvec3(std::copysign(0.435, p.x), -0.3653, 0.0415));
        }
    }
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        dvec3 middle(0.0);
        for (const std::size_t v : mesh.faces[f]) middle += mesh.points[v] / 3.0;
        std::string& material = mesh.materials[f];
        if (isCut && material == "trousers") material = middle.y < person.hem ? "legs" : "skirt";
        if (person.hasShortSleeves && material == "jacket" && isArm(middle) &&
            alongArm(middle) > kSleeve)
            material = "skin";
    }
}

/// Widens both legs' cloth to the halves of a skirt, down to its hem.
void widen(Mesh& mesh, const Person& person, const std::vector<bool>& isSkin) {
    if (person.below != Below::Skirt && person.below != Below::Coat) return;
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        dvec3& p = mesh.points[v];
        if (isSkin[v] || isArm(p) || p.y > kCrotch + 0.02 || p.y < person.hem - 1e-6) continue;
        const double down = ramp(kCrotch + 0.02, kCrotch - 0.07, p.y);
        const double flare = 1.0 + 0.35 * (kCrotch - p.y);
        const double side = p.x < 0.0 ? -1.0 : 1.0, x = std::abs(p.x) - 0.100;
        const double length = std::max(1e-6, std::hypot(x, p.z + 0.005));
        const double c = x / length, s = (p.z + 0.005) / length;
        // Each half reaches a little into the other one, below its surface, so that no cleft is
        // seen.
        const double inner = std::clamp(c, -0.3, 0.0);
        const dvec3 wide(0.190 * flare * std::max(c, -0.3), p.y,
                         -0.008 + 0.125 * flare * s * (1.0 + 0.4 * inner));
        p = glm::mix(dvec3(std::abs(p.x), p.y, p.z), wide, down);
        p.x *= side;
    }
}

/// Hair that is longer, or gathered at the back, or below a cap.
void comb(Mesh& mesh, const Person& person) {
    std::vector<bool> isHair(mesh.points.size(), false);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        if (mesh.materials[f] == "hair")
            for (const std::size_t v : mesh.faces[f]) isHair[v] = true;
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        dvec3& p = mesh.points[v];
        if (!isHair[v]) continue;
        const double back = ramp(0.03, -0.03, p.z);
        if (person.hair == Hair::Long) {
            const double low = back * ramp(1.70, 1.57, p.y);
            p.y -= 0.13 * low;
            p.z -= 0.030 * low;
            p.x *= 1.0 + 0.25 * low;
        }
        if (person.hair == Hair::Bun)
            p += dvec3(0.0, 0.012, -0.055) *
                 bump(glm::length(p - dvec3(0.0, 1.715, -0.10)), 0.0, 0.04);
        if (person.hair == Hair::Cap) {
            const dvec3 out = glm::normalize(p - dvec3(0.0, 1.68, 0.0));
            p += 0.008 * ramp(1.62, 1.70, p.y) * out;
            // Its peak.
            if (p.z > 0.05)
                p += dvec3(0.0, -0.012, 0.055) * ramp(0.05, 0.085, p.z) * ramp(1.79, 1.74, p.y);
        }
    }
}

/// A rounded box on the back.
void carry(Mesh& mesh) {
    constexpr int kAround = 12, kRings = 7;
    const dvec3 middle(0.0, 1.27, -0.195), half(0.145, 0.19, 0.085);
    const std::size_t first = mesh.points.size();
    const auto round = [](double x) { return std::copysign(std::pow(std::abs(x), 0.45), x); };
    for (int ring = 0; ring <= kRings; ++ring)
        for (int i = 0; i < (ring == 0 || ring == kRings ? 1 : kAround); ++i) {
            const double down = glm::radians(180.0 * ring / kRings - 90.0);
            const double turn = glm::radians(360.0 * i / kAround);
            mesh.points.push_back(middle +
                                  half * dvec3(round(std::cos(down)) * round(std::cos(turn)),
                                               round(std::sin(down)),
                                               round(std::cos(down)) * round(std::sin(turn))));
        }
    const auto at = [&](int ring, int i) {
        return ring == 0 ? first
                         : first + 1 + std::size_t(ring - 1) * kAround + std::size_t(i % kAround);
    };
    const std::size_t last = mesh.points.size() - 1;
    const auto face = [&](std::size_t a, std::size_t b, std::size_t c) {
        mesh.faces.push_back({a, b, c});
        mesh.materials.emplace_back("bag");
    };
    for (int i = 0; i < kAround; ++i) {
        face(first, at(1, i), at(1, i + 1));
        face(last, at(kRings - 1, i + 1), at(kRings - 1, i));
        for (int ring = 1; ring + 1 < kRings; ++ring) {
            face(at(ring, i), at(ring + 1, i), at(ring, i + 1));
            face(at(ring, i + 1), at(ring + 1, i), at(ring + 1, i + 1));
        }
    }
}

/// The vertices of what lies below short clothes.
std::vector<bool> bareVertices(const Mesh& mesh, const Person& person) {
    std::vector<bool> bare(mesh.points.size(), false), clothed(mesh.points.size(), false);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const bool isBare = (mesh.materials[f] == "legs" && person.below != Below::Coat) ||
                            (mesh.materials[f] == "skin" && person.hasShortSleeves);
        for (const std::size_t v : mesh.faces[f]) (isBare ? bare : clothed)[v] = true;
    }
    for (std::size_t v = 0; v < bare.size(); ++v) bare[v] = bare[v] && !clothed[v];
    return bare;
}

void write(const std::string& path, const std::string& text) {
    std::ofstream out(path, std::ios::binary);
    out << text;
    out.close();
    if (!out) throw std::runtime_error("cannot write " + path);
}

constexpr const char* kMade = "# Generated by osgskin_generate_pedestrian --seed of the osgSkin "
                              "project; CC0 1.0\n";

std::string objText(const Mesh& mesh, const Person& person, const std::string& name) {
    std::string text = kMade + ("mtllib " + name + ".mtl\no " + name + "\n");
    char line[100];
    for (const dvec3& p : mesh.points) {
        const auto number = [](double x) { return std::abs(x) < 5e-6 ? 0.0 : x; };
        std::snprintf(line, sizeof line, "v %.5f %.5f %.5f\n", number(p.x), number(p.y),
                      number(p.z));
        text += line;
    }
    for (const auto& [material, colour] : person.colours) {
        bool isFirst = true;
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            if (mesh.materials[f] != material) continue;
            if (isFirst) text += "usemtl " + material + "\n";
            isFirst = false;
            std::snprintf(line, sizeof line, "f %zu %zu %zu\n", mesh.faces[f][0] + 1,
                          mesh.faces[f][1] + 1, mesh.faces[f][2] + 1);
            text += line;
        }
    }
    return text;
}

std::string mtlText(const Person& person) {
    std::string text = kMade;
    char line[120];
    for (const auto& [material, colour] : person.colours) {
        std::snprintf(line, sizeof line, "newmtl %s\nKd %.3f %.3f %.3f\nKs 0.04 0.04 0.04\nNs 8\n",
                      material.c_str(), colour.x, colour.y, colour.z);
        text += line;
    }
    return text;
}

} // namespace

void writePerson(const std::string& folder, unsigned int seed) {
    const Person person = personOf(seed);
    Mesh mesh = readMesh(folder + "/pedestrian.obj");
    cut(mesh, person);
    const std::vector<bool> bare = bareVertices(mesh, person);
    widen(mesh, person, bare);
    comb(mesh, person);
    if (person.hasBackpack) carry(mesh);
    const Shape shape(person);
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
        mesh.points[v] = shape.at(mesh.points[v], v < bare.size() && bare[v]);
    char number[8];
    std::snprintf(number, sizeof number, "%02u", seed);
    const std::string name = std::string("person_") + number;
    std::filesystem::create_directories(folder + "/people");
    const std::string path = folder + "/people/" + name;
    write(path + ".obj", objText(mesh, person, name));
    write(path + ".mtl", mtlText(person));
    std::vector<RestJoint> joints = restSkeleton();
    for (RestJoint& joint : joints) {
        joint.centre = shape.at(joint.centre, false);
        joint.endSite = shape.at(joint.endSite, false);
    }
    std::ostringstream rig;
    writeRig(rig, Skeleton(joints));
    write(path + ".bvh", rig.str());
    std::string skin = "{\n  \"osgskin\": 1,\n  \"mesh\": \"" + name +
                       ".obj\",\n  \"skeleton\": \"" + name + ".bvh\",\n  \"motions\": [\n";
    for (const std::string motion : {"idle", "walk", "run", "wave"})
        skin += "    { \"file\": \"../pedestrian_" + motion + ".bvh\", \"name\": \"" + motion +
                "\" }" + (motion == "wave" ? "\n" : ",\n");
    write(path + ".skin", skin + "  ]\n}\n");
}

} // namespace mannequin
