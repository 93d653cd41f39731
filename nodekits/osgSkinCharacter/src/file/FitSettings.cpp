// SPDX-License-Identifier: GPL-3.0-or-later
#include "file/FitSettings.h"

#include <algorithm>

namespace osgSkin {
namespace {

glm::dvec3 readVector(const JsonReader& reader) {
    const std::vector<JsonReader> items = reader.items();
    if (items.size() != 3) reader.failExpected("a list of three numbers");
    return {items[0].number(), items[1].number(), items[2].number()};
}

} // namespace

FitOptions readFit(const JsonReader& reader) {
    const JsonReader fit = reader.require("fit", "true");
    if (!fit.boolean()) fit.failWith("expected true, or a file name instead of the object");
    reader.warnUnknown({"fit", "facing", "landmarks"});
    FitOptions options;
    if (const auto facing = reader.find("facing")) {
        options.facing = readVector(*facing);
        if (*options.facing == glm::dvec3(0.0)) facing->failWith("expected a direction");
    }
    const std::vector<std::string>& names = fittedJointNames();
    if (const auto landmarks = reader.find("landmarks"))
        landmarks->forEachMember([&](const std::string& name, const JsonReader& value) {
            if (std::find(names.begin(), names.end(), name) == names.end())
                value.failWith("expected the name of a CMU joint, such as LeftHand or Head");
            options.landmarks[name] = readVector(value);
        });
    return options;
}

} // namespace osgSkin
