// SPDX-License-Identifier: MIT
#include "names/WordRoles.h"

#include "names/LimbWords.h"
#include "names/NameWords.h"
#include "names/RoleTree.h"

#include <algorithm>
#include <map>
#include <set>

namespace osgSkin {
namespace {

using Readings = std::vector<std::optional<NameReading>>;

/// Fewer joints than these do not make a prefix that a skeleton shares.
constexpr std::size_t kFewestShared = 4;

/// A prefix of foreign words is one nevertheless where nearly all joints have it: a figure may be
/// called Wing.
constexpr double kMostJoints = 0.8;

/// A figure's joints have a few prefixes; each that is tried takes a look at all joints.
constexpr std::size_t kMostPrefixes = 100;

std::set<std::string> distinct(const std::vector<std::string>& roles) {
    std::set<std::string> result(roles.begin(), roles.end());
    result.erase("");
    return result;
}

bool beginsWith(const std::vector<std::string>& words, const std::string& prefix) {
    std::string joined;
    for (const std::string& word : words) {
        if (!isNumber(word)) joined += word;
        if (joined.size() >= prefix.size()) break;
    }
    return joined.compare(0, prefix.size(), prefix) == 0;
}

/// The joints under one prefix, each with its role.
std::vector<std::string> rolesUnder(const RestSkeleton& skeleton, Readings readings,
                                    const std::string& prefix) {
    for (auto& reading : readings)
        if (reading && reading->prefix != prefix) reading.reset();
    std::vector<std::string> roles = limbRoles(skeleton, readings);
    settleRoles(skeleton, roles);
    return roles;
}

} // namespace

WordRoles wordRoles(const RestSkeleton& skeleton) {
    std::vector<std::vector<std::string>> names;
    for (const RestJoint& joint : skeleton.joints) names.push_back(nameWords(joint.name));
    const NameHabits habits(names);

    WordRoles result;
    result.roles.resize(names.size());
    std::map<std::string, std::size_t> prefixes;
    std::set<std::string> foreign;
    for (const auto& words : names) {
        result.readings.push_back(readName(words, habits));
        if (const auto& reading = result.readings.back()) {
            ++prefixes[reading->prefix];
            if (reading->foreign) foreign.insert(reading->prefix);
        }
    }
    std::size_t most = 0, tried = 0;
    for (const auto& [prefix, count] : prefixes) {
        if (count < kFewestShared || count < most || ++tried > kMostPrefixes) continue;
        if (foreign.count(prefix) != 0) {
            const auto sharing =
                std::count_if(names.begin(), names.end(),
                              [p = prefix](const auto& words) { return beginsWith(words, p); });
            if (static_cast<double>(sharing) < kMostJoints * static_cast<double>(names.size()))
                continue;
        }
        std::vector<std::string> roles = rolesUnder(skeleton, result.readings, prefix);
        const std::size_t filled = distinct(roles).size();
        // Rigify has each bone twice: "DEF-" moves the skin, "ORG-" only leads it.
        const bool preferred = filled == most && prefix == "def";
        if (filled < kFewestShared || (filled <= most && !preferred)) continue;
        most = filled;
        result.roles = std::move(roles);
    }
    return result;
}

} // namespace osgSkin
