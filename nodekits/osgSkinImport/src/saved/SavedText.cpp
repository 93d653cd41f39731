// SPDX-License-Identifier: MIT
#include "saved/SavedText.h"

#include "text/FileText.h"

#include <osg/Math>
#include <osgDB/ObjectWrapper>
#include <osgDB/Registry>

#include <algorithm>
#include <cstdlib>

namespace osgSkin {
namespace {

int valueOf(const std::string& table, const std::string& name) {
    return osgDB::Registry::instance()->getObjectWrapperManager()->getValue(table, name);
}

} // namespace

long SavedText::number() {
    const std::string word = nextWord();
    // In base 10, 16 or 8, as OSG reads them; beyond 2^63 it is the largest.
    return word.compare(0, 1, "-") == 0 ? std::strtol(word.c_str(), nullptr, 0)
                                        : long(std::strtoul(word.c_str(), nullptr, 0));
}

void SavedText::readFloat(float& value) {
    double number = 0.0;
    readDouble(number);
    value = static_cast<float>(number);
}

void SavedText::readDouble(double& value) {
    value = osg::asciiToDouble(nextWord().c_str());
}

void SavedText::readGLenum(osgDB::ObjectGLenum& value) {
    value.set(static_cast<GLenum>(valueOf("GL", nextWord())));
}

void SavedText::readProperty(osgDB::ObjectProperty& property) {
    if (property._mapProperty) return property.set(valueOf(property._name, nextWord()));
    const std::string name = nextName(property._name);
    if (name != property._name) refuse(inQuotes(name) + ", expected " + inQuotes(property._name));
    tookProperty(property._name);
    property.set(0);
}

void SavedText::readCharArray(char* bytes, unsigned size) {
    std::fill_n(bytes, size, '\0'); // no text has one
}

} // namespace osgSkin
