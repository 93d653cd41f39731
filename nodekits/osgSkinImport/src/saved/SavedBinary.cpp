// SPDX-License-Identifier: MIT
#include "saved/SavedBinary.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace osgSkin {
namespace {

constexpr std::uint64_t kHeader = 0x1afb45456c910ea1; ///< bytes of the other order are swapped
constexpr unsigned kBrackets = 0x4;                   ///< the one attribute that is read
constexpr int kWideBlocks = 148;                      ///< later versions have 64-bit blocks

std::uint64_t swapped(std::uint64_t value) {
    auto* bytes = reinterpret_cast<char*>(&value);
    // Two words, each in the other order.
    std::reverse(bytes, bytes + 4);
    std::reverse(bytes + 4, bytes + 8);
    return value;
}

std::uint64_t beginning(const std::string& content) {
    std::uint64_t value = 0;
    if (content.size() >= sizeof value) std::memcpy(&value, content.data(), sizeof value);
    return value;
}

} // namespace

bool SavedBinary::begins(const std::string& content) {
    const std::uint64_t value = beginning(content);
    return value == kHeader || value == swapped(kHeader);
}

void SavedBinary::skipBeginning() {
    setByteSwap(beginning(_content) == kHeader ? 0 : 1);
    if (_content.size() < 16) refuse("it ends too early");
    _at = sizeof kHeader;
    if (take<unsigned>() > osgDB::InputStream::READ_OBJECT) // OSG makes an enumerator of any number
        refuse("no scene, expected one");
    take<unsigned>(); // the version, which OSG reads again, as all of this
    const unsigned attributes = take<unsigned>();
    if ((attributes & ~kBrackets) != 0)
        refuse("a file with layouts or versions of its own classes, expected a plain one");
    else if (takeText() != "0")
        refuse("a compressed file, expected one that was saved without a compressor");
    _at = sizeof kHeader;
}

void SavedBinary::takeBytes(char* bytes, std::size_t size, bool swapped) {
    begin();
    if (size > remaining()) refuse("it ends too early");
    std::memcpy(bytes, _content.data() + _at, size);
    if (swapped) std::reverse(bytes, bytes + size);
    _at += size;
}

std::string SavedBinary::takeText() {
    const int size = take<int>();
    if (size < 0 || std::size_t(size) > remaining())
        refuse("a text of " + std::to_string(size) + " bytes, expected no more than the file has");
    std::string text = _content.substr(_at, std::size_t(size));
    _at += std::size_t(size);
    return text;
}

void SavedBinary::readProperty(osgDB::ObjectProperty& property) {
    property.set(property._mapProperty ? tookMapped(property._name, take<int>()) : 0);
    if (!property._mapProperty) tookProperty(property._name);
}

void SavedBinary::readCharArray(char* bytes, unsigned size) {
    std::fill_n(bytes, size, '\0');
    takeBytes(bytes, size, false);
}

void SavedBinary::readMark(osgDB::ObjectMark& mark) {
    if (mark._name == "{") {
        tookBegin();
        if (!_supportBinaryBrackets) return;
        const std::size_t begin = _at;
        const bool wide = _inputStream->getFileVersion() > kWideBlocks;
        const std::uint64_t size =
            wide ? take<std::uint64_t>() : static_cast<std::uint64_t>(take<int>());
        if (size > _content.size() - begin)
            refuse("a block of " + std::to_string(size) +
                   " bytes, expected no more than the file has");
        _ends.push_back(begin + size);
    } else if (mark._name == "}" && !_ends.empty()) {
        _ends.pop_back();
    }
}

void SavedBinary::advanceToCurrentEndBracket() {
    begin();
    if (!_supportBinaryBrackets || _ends.empty()) return;
    // Never back: what was read once would be read for ever.
    if (_ends.back() < _at) refuse("a block that is longer than it says");
    _at = _ends.back();
    _ends.pop_back();
}

} // namespace osgSkin
