// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_UNIQUENAME_H
#define OSGSKINIMPORT_UNIQUENAME_H 1

#include <map>
#include <set>
#include <string>

namespace osgSkin {

/// A set of unique names.
class UniqueNames {
public:
    /// Takes `name`; false if it is already taken.
    bool take(const std::string& name) { return _taken.insert(name).second; }

    /// Takes and returns `wanted`, or `wanted` with a counter ("Torso.001") if it is already taken.
    /// Stays fast however many names collide.
    std::string unique(const std::string& wanted);

private:
    std::set<std::string> _taken;
    std::map<std::string, int> _copies; ///< last counter tried for each name
};

} // namespace osgSkin

#endif
