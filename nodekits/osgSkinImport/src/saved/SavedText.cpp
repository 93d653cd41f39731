// SPDX-License-Identifier: MIT
#include "saved/SavedText.h"

#include "text/FileText.h"

#include <osg/Math>
#include <osgDB/ObjectWrapper>
#include <osgDB/Registry>

#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace osgSkin {
namespace {

/// In base 10, 16 or 8, as OSG reads them; beyond 2^63 it is the largest. False where a word is
/// none as a whole.
bool wholeNumber(const std::string& word, long& value) {
    const std::size_t first = word.find_first_of("+-") == 0 ? 1 : 0;
    if (first >= word.size() || word[first] < '0' || word[first] > '9') return false;
    char* end = nullptr;
    value = word[0] == '-' ? std::strtol(word.c_str(), &end, 0)
                           : long(std::strtoul(word.c_str(), &end, 0));
    return end == word.c_str() + word.size();
}

/// OSG reads as 0 what is none, infinite ones among them.
bool isNumber(const std::string& word) {
    double ignored = 0.0;
    long hexadecimal = 0;
    if (word.compare(0, 2, "0x") == 0) return wholeNumber(word, hexadecimal);
    return word.find_first_of("0123456789") != std::string::npos && parseNumber(word, ignored);
}

} // namespace

void SavedText::refuseWord(const std::string& word, const char* expected) const {
    const auto end = _content.begin() + static_cast<std::ptrdiff_t>(_at);
    refuse("line " + std::to_string(1 + std::count(_content.begin(), end, '\n')) + ": " +
           inQuotes(word) + ", expected " + expected);
}

/// As OSG writes values of a table that have no name there: as numbers.
int SavedText::valueOf(const std::string& table) {
    const std::string word = nextWord();
    osgDB::ObjectWrapperManager& all = *osgDB::Registry::instance()->getObjectWrapperManager();
    const auto found = all.getLookupMap().find(table);
    osgDB::IntLookup& names =
        found != all.getLookupMap().end() ? found->second : all.getLookupMap()["GL"];
    long ignored = 0;
    if (names.getStringToValue().count(word) == 0 && !wholeNumber(word, ignored))
        refuseWord(word, "a name that OpenSceneGraph knows here");
    return names.getValue(word.c_str());
}

bool SavedText::truth() {
    const std::string word = nextWord();
    if (word != "TRUE" && word != "FALSE") refuseWord(word, "TRUE or FALSE");
    return word == "TRUE";
}

long SavedText::number() {
    const std::string word = nextWord();
    long value = 0;
    if (!wholeNumber(word, value)) refuseWord(word, "a whole number");
    return value;
}

void SavedText::readFloat(float& value) {
    double number = 0.0;
    readDouble(number);
    value = static_cast<float>(number);
}

void SavedText::readDouble(double& value) {
    const std::string word = nextWord();
    if (!isNumber(word)) refuseWord(word, "a number");
    value = osg::asciiToDouble(word.c_str());
}

void SavedText::readGLenum(osgDB::ObjectGLenum& value) {
    value.set(static_cast<GLenum>(valueOf("GL")));
}

void SavedText::readProperty(osgDB::ObjectProperty& property) {
    if (property._mapProperty)
        return property.set(tookMapped(property._name, valueOf(property._name)));
    const std::string name = nextName(property._name);
    if (name != property._name) refuse(inQuotes(name) + ", expected " + inQuotes(property._name));
    tookProperty(property._name);
    property.set(0);
}

void SavedText::readCharArray(char* bytes, unsigned size) {
    std::fill_n(bytes, size, '\0'); // no text has one
}

} // namespace osgSkin
