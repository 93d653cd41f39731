// SPDX-License-Identifier: MIT
#include "names/JointRoles.h"

#include <cctype>

namespace osgSkin {
namespace {

constexpr std::size_t kFewestRoles = 4;

/// The name as it is compared.
std::string plain(const std::string& name) {
    std::string result;
    for (const char c : name.substr(name.find_last_of(":|") + 1))
        if (std::isalnum(static_cast<unsigned char>(c)) != 0)
            result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return result;
}

JointRoles rolesBy(const JointNames& names, const RestSkeleton& skeleton) {
    std::map<std::string, std::string> roleOf;
    for (const auto& [role, members] : names.roles)
        for (const std::string& member : members) roleOf.emplace(plain(member), role);
    JointRoles result;
    result.family = names.name;
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        const auto found = roleOf.find(plain(skeleton.joints[j].name));
        result.roles.push_back(found == roleOf.end() ? std::string() : found->second);
        if (found != roleOf.end()) result.joints[found->second].push_back(static_cast<int>(j));
    }
    return result;
}

} // namespace

JointRoles findRoles(const RestSkeleton& skeleton, const std::vector<JointNames>& more) {
    JointRoles best;
    best.roles.resize(skeleton.joints.size());
    const auto consider = [&](const JointNames& names) {
        JointRoles roles = rolesBy(names, skeleton);
        if (roles.joints.size() < kFewestRoles) return;
        if (!best.known() || roles.joints.size() > best.joints.size()) best = std::move(roles);
    };
    for (auto names = more.rbegin(); names != more.rend(); ++names) consider(*names);
    for (const JointNames& names : knownJointNames()) consider(names);
    return best;
}

} // namespace osgSkin
