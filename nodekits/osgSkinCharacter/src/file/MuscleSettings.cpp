// SPDX-License-Identifier: GPL-3.0-or-later
#include "file/MuscleSettings.h"

namespace osgSkin {
namespace {

BindOptions::Muscle readMuscle(const JsonReader& reader) {
    reader.warnUnknown({"name", "joint", "side", "from", "to", "growth", "tension"});
    BindOptions::Muscle muscle;
    muscle.name = reader.require("name", "the muscle's name").string();
    muscle.joint = reader.require("joint", "the joint whose bend shortens it").string();
    const auto side = reader.find("side");
    if (side && side->isList()) {
        muscle.towards = side->vector();
    } else if (side) {
        const std::string name = side->string();
        if (name != "flexor" && name != "extensor")
            side->failWith("expected \"flexor\" or \"extensor\", found \"" + name + "\"");
        if (name == "extensor") muscle.side = BindOptions::Muscle::Side::Extensor;
    }
    if (const auto from = reader.find("from")) muscle.from = from->number();
    if (const auto to = reader.find("to")) muscle.to = to->number();
    if (const auto growth = reader.find("growth")) muscle.growth = growth->number();
    if (const auto tension = reader.find("tension")) muscle.tension = tension->number();
    return muscle;
}

} // namespace

void readMuscles(const JsonReader& reader, BindOptions& bind) {
    if (!reader.isList()) {
        bind.muscles = reader.boolean();
        return;
    }
    constexpr std::size_t most = 1000; // a body has 640; each is laid on the skin by itself
    if (reader.size() > most)
        reader.failWith(std::to_string(reader.size()) + " muscles, expected at most " +
                        std::to_string(most));
    reader.forEachItem([&](const JsonReader& item) {
        if (item.isObject())
            bind.ownMuscles.push_back(readMuscle(item));
        else
            bind.muscles = item.boolean();
    });
}

} // namespace osgSkin
