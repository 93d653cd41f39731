// SPDX-License-Identifier: MIT
#include "scene/ClipNames.h"

#include "files/FileText.h"

#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>

#include <charconv>
#include <map>
#include <set>

namespace osgSkin {

std::vector<std::string> clipNames(const SourceScene& scene) {
    std::vector<std::string> result;
    std::set<std::string> taken;
    std::map<std::string, int> copies; // of each duplicate name
    for (std::size_t a = 0; a < scene.animations.size(); ++a) {
        const std::string& given = scene.animations[a]->name;
        std::string name = given.empty() ? "clip" + std::to_string(a) : given;
        while (!taken.insert(name).second) name = given + " " + std::to_string(1 + ++copies[given]);
        result.push_back(name);
    }
    return result;
}

std::size_t findClip(const std::vector<std::string>& names, const std::string& wanted,
                     const std::string& path) {
    const std::vector<std::size_t> found = clipsMeant(wanted, names);
    if (found.size() == 1) return found.front();
    std::size_t number = 0;
    const char* const end = wanted.data() + wanted.size();
    const auto [stop, status] = std::from_chars(wanted.data(), end, number);
    if (found.empty() && !wanted.empty() && stop == end && status == std::errc() &&
        number < names.size())
        return number;
    std::string known;
    for (std::size_t n = 0; n < names.size(); ++n)
        known += (n > 0 ? ", " : "") + std::to_string(n) + " \"" + names[n] + '"';
    const std::string nearest = nearestName(wanted, names);
    failFile(path, (found.empty() ? "no clip " : "several clips ") + inQuotes(wanted) +
                       ", expected one of " + known +
                       (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
}

} // namespace osgSkin
