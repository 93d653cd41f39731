// SPDX-License-Identifier: MIT
#include "Variations.h"

#include "../Format.h"
#include "Reshape.h"

namespace quality {
namespace {

/// A millimetre in the bodies' unit.
constexpr double kMillimetre = 0.01;

using Change = std::function<PaintedBody(const PaintedBody&)>;
using Bones = std::map<std::string, BoneScale>;
using Turns = std::map<std::string, glm::dvec3>;

struct Named {
    std::string name;
    Change change;
};

void addGirths(std::vector<Named>& all) {
    for (const int mm : {-10, -8, -6, -5, -4, -2, 4, 8, 10, 14})
        all.push_back({format("%+d mm", mm), [mm](const PaintedBody& body) {
                           return thickened(body, mm * kMillimetre);
                       }});
    for (const double girth : {0.7, 0.85, 1.2, 1.4})
        all.push_back({format("limbs %.2f thick", girth), [girth](const PaintedBody& body) {
                           Bones bones;
                           for (const char* name : {"Arm", "ForeArm", "UpLeg", "Leg"})
                               bones[name] = {1.0, girth};
                           return proportioned(body, bones);
                       }});
    for (const double girth : {0.85, 1.15, 1.3})
        all.push_back({format("trunk %.2f thick", girth), [girth](const PaintedBody& body) {
                           Bones bones;
                           for (const char* name : {"LowerBack", "Spine", "Spine1"})
                               bones[name] = {1.0, girth};
                           return proportioned(body, bones);
                       }});
}

void addLengths(std::vector<Named>& all) {
    const auto add = [&all](const char* what, const std::vector<const char*>& joints,
                            double length) {
        all.push_back(
            {format("%s %.2f long", what, length), [joints, length](const PaintedBody& body) {
                 Bones bones;
                 for (const char* joint : joints) bones[joint] = {length, 1.0};
                 return proportioned(body, bones);
             }});
    };
    for (const double length : {0.75, 0.85, 0.9, 1.15, 1.3}) add("forearms", {"ForeArm"}, length);
    for (const double length : {0.85, 1.2}) add("upper arms", {"Arm"}, length);
    for (const double length : {0.8, 1.25}) add("arms", {"Arm", "ForeArm"}, length);
    for (const double length : {0.8, 0.9, 1.15, 1.3}) add("legs", {"UpLeg", "Leg"}, length);
    for (const double length : {0.85, 1.15}) add("collar bones", {"Shoulder"}, length);
    for (const double length : {0.85, 1.2}) add("trunk", {"LowerBack", "Spine", "Spine1"}, length);
}

void addRestPoses(std::vector<Named>& all) {
    const auto add = [&all](const std::string& name, const Turns& turns) {
        all.push_back({name, [turns](const PaintedBody& body) { return standing(body, turns); }});
    };
    for (const double raise : {-25.0, -15.0, 15.0, 30.0, 48.0, 60.0})
        add(format("arms %+.0f degrees", raise), {{"Arm", {0, 0, raise}}});
    add("T with collar bones",
        {{"Shoulder", {0, 0, 10}}, {"Arm", {0, 0, 38}}, {"ForeArm", {0, 40, 0}}});
    add("arms straight", {{"ForeArm", {0, 40, 0}}});
    for (const double apart : {-4.0, 8.0, 15.0})
        add(format("legs %+.0f degrees apart", apart), {{"UpLeg", {0, 0, apart}}});
    for (const double bent : {10.0, 20.0})
        add(format("spine bent by %.0f", bent), {{"LowerBack", {bent / 2, 0, 0}},
                                                 {"Spine", {bent / 2, 0, 0}},
                                                 {"Spine1", {bent, 0, 0}},
                                                 {"Neck", {-bent, 0, 0}},
                                                 {"Head", {-bent, 0, 0}}});
}

/// Thin limbs, hollows, a bent spine.
PaintedBody aged(const PaintedBody& body, double years) {
    const double girth = 1.0 - 0.25 * years;
    PaintedBody old = proportioned(body, {{"Arm", {1.0, girth}},
                                          {"ForeArm", {1.0, girth}},
                                          {"UpLeg", {1.0, girth}},
                                          {"Leg", {1.0, girth}},
                                          {"Neck", {1.0, girth}},
                                          {"Spine", {0.95, girth}}});
    old = uneven(thickened(old, -4.0 * years * kMillimetre), 10.0 * years * kMillimetre, 2.0);
    return standing(old, {{"LowerBack", {8 * years, 0, 0}},
                          {"Spine", {8 * years, 0, 0}},
                          {"Spine1", {12 * years, 0, 0}},
                          {"Neck", {-12 * years, 0, 0}},
                          {"Head", {-12 * years, 0, 0}}});
}

void addOthers(std::vector<Named>& all) {
    for (const double years : {0.5, 0.75, 1.0, 1.25})
        all.push_back({format("old and thin %.2f", years),
                       [years](const PaintedBody& body) { return aged(body, years); }});
    for (const double length : {0.8, 1.2, 2.0, 3.5})
        all.push_back({format("uneven by %.1f", length), [length](const PaintedBody& body) {
                           return uneven(body, 8.0 * kMillimetre, length);
                       }});
    all.push_back({"-6 mm, arms +30", [](const PaintedBody& body) {
                       return standing(thickened(body, -6.0 * kMillimetre), {{"Arm", {0, 0, 30}}});
                   }});
    all.push_back({"-6 mm, arms -15", [](const PaintedBody& body) {
                       return standing(thickened(body, -6.0 * kMillimetre), {{"Arm", {0, 0, -15}}});
                   }});
    all.push_back({"subdivided", subdivided});
}

} // namespace

std::vector<Variation> variations(const PaintedBody& neutral, const PaintedBody& male) {
    std::vector<Variation> result;
    const auto add = [&result](const std::string& name, std::function<PaintedBody()> make) {
        result.push_back({name, result.size() % 2 == 1, std::move(make)});
    };
    for (const double t : {-1.0, -0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5})
        add(format("neutral to male %.2f", t),
            [&neutral, &male, t] { return blended(neutral, male, t); });
    std::vector<Named> changes;
    addGirths(changes);
    addLengths(changes);
    addRestPoses(changes);
    addOthers(changes);
    for (const PaintedBody* body : {&neutral, &male})
        for (std::size_t i = 0; i < changes.size(); ++i) {
            const Change& change = changes[i].change;
            result.push_back({(body == &male ? "male, " : "neutral, ") + changes[i].name,
                              i % 2 == 1, [body, change] { return change(*body); }});
        }
    return result;
}

} // namespace quality
