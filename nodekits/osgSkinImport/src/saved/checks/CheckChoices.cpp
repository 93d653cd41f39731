// SPDX-License-Identifier: MIT
#include "saved/checks/CheckChoices.h"

#include <osgDB/ObjectWrapper>
#include <osgDB/Registry>

#include <algorithm>

namespace osgSkin {

CheckChoices::Choices CheckChoices::choicesOf(const osg::Object& object) {
    Choices result;
    osgDB::ObjectWrapperManager& wrappers = *osgDB::Registry::instance()->getObjectWrapperManager();
    const osgDB::ObjectWrapper* const wrapper = wrappers.findWrapper(object.getCompoundClassName());
    if (wrapper == nullptr) return result;
    for (const osgDB::ObjectWrapperAssociate& base : wrapper->getAssociates()) {
        osgDB::ObjectWrapper* const of = wrappers.findWrapper(base._name);
        if (of == nullptr) continue;
        for (const osg::ref_ptr<osgDB::BaseSerializer>& serializer : of->getSerializerList()) {
            osgDB::IntLookup* const lookup = serializer->getIntLookup();
            if (lookup == nullptr || lookup->getValueToString().empty()) continue;
            // As many bits as its enumerators need.
            const auto& known = lookup->getValueToString();
            const int last = std::max(known.rbegin()->first, -1 - known.begin()->first);
            int most = 1;
            while (most < last) most = 2 * most + 1;
            result.push_back(
                {serializer->getName(), &known, known.begin()->first < 0 ? -1 - most : 0, most});
        }
    }
    return result;
}

std::string CheckChoices::wrongIn(const osg::Object& object) {
    const auto [found, isNew] = _ofClass.try_emplace(object.getCompoundClassName());
    if (isNew) found->second = choicesOf(object);
    for (const Choice& choice : found->second) {
        int value = 0;
        if (!_properties.getProperty(&object, choice.property, value) ||
            (value >= choice.least && value <= choice.most))
            continue;
        std::string names;
        for (const auto& [number, name] : *choice.known)
            names += (names.empty() ? "" : ", ") + name;
        return choice.property + " " + std::to_string(value) + ", expected one of " + names;
    }
    return {};
}

} // namespace osgSkin
