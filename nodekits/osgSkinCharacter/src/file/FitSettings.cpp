// SPDX-License-Identifier: GPL-3.0-or-later
#include "file/FitSettings.h"

#include <map>
#include <string>
#include <vector>

namespace osgSkin {

FitOptions readFit(const JsonReader& reader) {
    const JsonReader fit = reader.require("fit", "true");
    if (!fit.boolean()) fit.failWith("expected true, or a file name instead of the object");
    reader.warnUnknown({"fit", "facing", "landmarks"});
    FitOptions options;
    if (const auto facing = reader.find("facing")) {
        options.facing = facing->vector();
        if (*options.facing == glm::dvec3(0.0)) facing->failWith("expected a direction");
    }
    const auto landmarks = reader.find("landmarks");
    if (!landmarks) return options;
    std::vector<std::string> names;
    constexpr std::size_t most = 100; // a body has about 30 joints; names are read together
    landmarks->forEachMember([&](const std::string& name, const JsonReader& value) {
        if (names.size() == most)
            value.failWith("one of more than " + std::to_string(most) + " landmarks");
        names.push_back(name);
    });
    const std::map<std::string, std::string> known = fittedNamesOf(names);
    landmarks->forEachMember([&](const std::string& name, const JsonReader& value) {
        if (known.count(name) == 0)
            value.failWith("expected the name of a CMU joint, such as LeftHand or Head");
        options.landmarks[name] = value.vector();
    });
    return options;
}

} // namespace osgSkin
