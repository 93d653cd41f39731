// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_CHECKCHOICES_H
#define OSGSKINIMPORT_CHECKCHOICES_H 1

#include <osgDB/ClassInterface>

#include <map>
#include <string>
#include <vector>

namespace osgSkin {

/// Looks whether what objects of a file have chosen is there to choose: OSG takes any number for an
/// enumerator, and a program may do anything with one that its enumeration cannot hold.
class CheckChoices {
public:
    /// \return what is wrong; empty: nothing
    std::string wrongIn(const osg::Object& object);

private:
    struct Choice {
        std::string property;
        const osgDB::IntLookup::ValueToString* known; ///< OSG's own
        int least, most;                              ///< that the enumeration can hold
    };
    using Choices = std::vector<Choice>;

    static Choices choicesOf(const osg::Object& object);

    osgDB::ClassInterface _properties;
    std::map<std::string, Choices> _ofClass;
};

} // namespace osgSkin

#endif
