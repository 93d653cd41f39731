// SPDX-License-Identifier: MIT
#include "saved/SavedInput.h"

#include "text/FileText.h"
#include "text/KnownClasses.h"

#include <osgSkin/Error>

#include <osg/Image>
#include <osg/PrimitiveSet>
#include <osgDB/ObjectWrapper>
#include <osgDB/Registry>

#include <algorithm>

namespace osgSkin {
namespace {

/// Whole numbers that are no lengths (modes, hints) stand before brackets, too; they are small.
constexpr std::uint64_t kSlack = 65536;

} // namespace

SavedInput::SavedInput(std::string content, const ReadLimits& limits, SharedPictures* pictures)
    : _content(std::move(content)), _image(limits, pictures), _limits(limits) {
    setStream(&_none);
}

SavedStream& SavedInput::stream() const {
    return *static_cast<SavedStream*>(_inputStream);
}

void SavedInput::refuse(const std::string& reason) {
    throw Error(reason);
}

void SavedInput::begin() {
    _numberIsLast = false;
    if (!_refusal.empty()) refuse(_refusal);
    if (_inputStream != nullptr && _inputStream->getException() != nullptr)
        refuse(_inputStream->getException()->getError());
}

void SavedInput::dropClosed() {
    const std::size_t depth = stream().fields().size();
    while (!_open.empty() && _open.back().depth >= depth) _open.pop_back();
}

void SavedInput::claim(std::uint64_t elements) {
    _numberIsLast = false;
    _claimed += elements;
    if (elements > remaining() + kSlack || _claimed > _content.size() + 16 * kSlack)
        refuse(std::to_string(elements) + " elements, expected no more than the file has room for");
}

SavedInput::Lists SavedInput::listsOf(const std::string& className) {
    const auto known = _lists.find(className);
    if (known != _lists.end()) return known->second;
    Lists result = Lists::None;
    osgDB::ObjectWrapper* wrapper =
        osgDB::Registry::instance()->getObjectWrapperManager()->findWrapper(className);
    if (wrapper != nullptr)
        for (std::size_t i = 0; i < wrapper->getTypeList().size(); ++i) {
            using Type = osgDB::BaseSerializer;
            const Type::Type type = wrapper->getTypeList()[i];
            if (type != Type::RW_VECTOR && type != Type::RW_LIST && type != Type::RW_MAP) continue;
            const bool itself = wrapper->getSerializerList()[i]->getName() == "vector";
            result = itself ? Lists::Itself : Lists::Some;
        }
    _lists.emplace(className, result);
    return result;
}

int SavedInput::took(int number) {
    // An array's binding: OSG makes an enumerator of any number.
    const std::vector<std::string>& fields = stream().fields();
    if (!fields.empty() && fields.back() == "osg::Array" && (number < -1 || number > 4))
        refuse("an array with a binding of " + std::to_string(number) + ", expected -1 to 4");
    _number = number;
    _numberIsLast = true;
    return static_cast<int>(_image.tookNumber(number, rest(), *this));
}

unsigned SavedInput::took(unsigned number) {
    if (_property == "UniqueID") {
        tookIdentifier(number);
        return number;
    }
    if (_image.isOpen()) {
        _image.tookNumber(number, rest(), *this);
        return number;
    }
    _number = number;
    _numberIsLast = true;
    dropClosed();
    if (stream().fields().empty()) return number;
    const std::string& className = stream().fields().back();
    // OSG makes room for as many values as it says, of 64 bytes at most.
    if (className == "osg::Uniform") claim(number);
    const Lists lists = listsOf(className);
    const bool isLength =
        lists == Lists::Some || (lists == Lists::Itself && !_open.empty() && !_open.back().sized);
    if (!isLength || _open.empty()) return number;
    claim(number);
    const bool areSets = isBinary() ? !_open.back().sized : _property == "PrimitiveSetList";
    if (className == "osg::Geometry" && areSets) _open.back().sets = number;
    _open.back().sized = true;
    return number;
}

int SavedInput::tookMapped(const std::string& table, int value) const {
    if (table != "ArrayType") return value;
    osgDB::ObjectWrapperManager& all = *osgDB::Registry::instance()->getObjectWrapperManager();
    if (all.getLookupMap()[table].getValueToString().count(value) == 0)
        refuse("an array of the kind " + std::to_string(value) +
               ", expected one that OpenSceneGraph knows");
    return value;
}

void SavedInput::tookProperty(const std::string& name) {
    _property = name;
    _numberIsLast = false;
    _image.tookProperty(name);
}

void SavedInput::tookBegin() {
    if (_numberIsLast && _number > 0) claim(static_cast<std::uint64_t>(_number));
}

std::string SavedInput::took(std::string word) {
    _numberIsLast = false;
    if (_property == "ClassName" && word != "osg::Image")
        refuse("a picture of class " + inQuotes(word) + ", expected osg::Image");
    if (_property == "Binding" && stream().fields().back() == "osg::Array" &&
        word.compare(0, 5, "BIND_") != 0)
        refuse("an array with a binding of " + inQuotes(word) + ", expected one by its name");
    _word = word;
    dropClosed();
    _isSet = !_open.empty() && _open.back().sets > 0 && stream().fields().back() == "osg::Geometry";
    if (!_isSet) return word;
    --_open.back().sets;
    if (word == "NULL") checkSet(nullptr);
    return word;
}

std::string SavedInput::tookWrapped(std::string text) {
    _numberIsLast = false;
    _image.tookText(text, *this);
    return text;
}

void SavedInput::checkClass() {
    if (!isKnownClass(_word, _limits))
        refuse("an object of class " + inQuotes(_word) +
               ", expected one that characters are made of (option classes)");
    // OSG would go on without the object.
    if (osgDB::Registry::instance()->getObjectWrapperManager()->findWrapper(_word) == nullptr)
        refuse("an object of class " + inQuotes(_word) +
               ", expected one that OpenSceneGraph or a library of its name reads");
}

void SavedInput::tookIdentifier(unsigned id) {
    // A picture's identifier follows its class by name, an object's the bracket.
    const bool isPicture = _image.isNamed();
    _property.clear();
    if (!isPicture) checkClass();
    dropClosed();
    for (const Open& open : _open)
        if (open.id == id) refuse("object " + std::to_string(id) + " is a part of itself");
    const auto known = stream().objects().find(id);
    if (_isSet) checkSet(known != stream().objects().end() ? known->second.get() : nullptr);
    _isSet = false;
    if (known != stream().objects().end()) {
        // OSG casts it to a picture without asking.
        if (isPicture && dynamic_cast<osg::Image*>(known->second.get()) == nullptr && known->second)
            refuse("object " + std::to_string(id) + " is no picture, expected one");
        return;
    }
    if (_open.size() >= _limits.depth)
        refuse("objects in each other, expected at most " + std::to_string(_limits.depth) +
               " deep (option maxDepth)");
    _open.push_back({stream().fields().size(), id});
}

/// OSG gives a geometry's primitive sets buffers, without looking whether they are there.
void SavedInput::checkSet(const osg::Object* known) {
    const bool isSet = known != nullptr
                           ? dynamic_cast<const osg::PrimitiveSet*>(known) != nullptr
                           : _word.compare(0, 9, "osg::Draw") == 0 && _word != "osg::Drawable";
    if (!isSet) refuse(inQuotes(_word) + ", expected a primitive set");
}

} // namespace osgSkin
