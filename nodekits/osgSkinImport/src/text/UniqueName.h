// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_UNIQUENAME_H
#define OSGSKINIMPORT_UNIQUENAME_H 1

#include <map>
#include <set>
#include <string>

namespace osgSkin {

/// Names of which no two are alike.
class UniqueNames {
public:
    /// Takes `name`; false where it is taken.
    bool take(const std::string& name) { return _taken.insert(name).second; }

    /// `wanted`, or with a counter behind it ("Torso.001") where that is taken; is taken from now
    /// on. However many want the same name, each is found at once.
    std::string unique(const std::string& wanted);

private:
    std::set<std::string> _taken;
    std::map<std::string, int> _copies; ///< of each name, the last counter that was tried
};

} // namespace osgSkin

#endif
