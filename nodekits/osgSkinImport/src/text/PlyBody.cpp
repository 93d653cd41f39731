// SPDX-License-Identifier: MIT
#include "text/PlyBody.h"

#include "text/FileText.h"

#include <cstdint>

namespace osgSkin {
namespace {

[[noreturn]] void failList(const std::string& path, const PlyHeader::Element& element, double index,
                           double length) {
    failFile(path, "element \"" + element.name + "\" " + std::to_string(std::uint64_t(index)) +
                       ": a list of " + std::to_string(std::int64_t(length)) +
                       " entries, expected no more than the file has room for");
}

/// A body of bytes; leaves at its end.
class BinaryBody {
public:
    BinaryBody(std::string_view body, bool bigEndian) : _rest(body), _bigEndian(bigEndian) {}

    bool skip(double bytes) {
        if (!(bytes >= 0.0 && bytes <= double(_rest.size()))) return false;
        _rest.remove_prefix(std::size_t(bytes));
        return true;
    }

    bool readCount(const PlyHeader::Property& list, double& count) {
        if (_rest.size() < list.countBytes) return false;
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < list.countBytes; ++i) {
            const std::size_t at = _bigEndian ? i : list.countBytes - 1 - i;
            value = value << 8 | std::uint8_t(_rest[at]);
        }
        _rest.remove_prefix(list.countBytes);
        count = double(value);
        const double range = double(std::uint64_t(1) << (8 * list.countBytes));
        if (list.countIsSigned && count >= range / 2.0) count -= range;
        return true;
    }

    bool hasRoom(double entries, std::size_t bytes) const {
        return entries >= 0.0 && entries * double(bytes) <= double(_rest.size());
    }

private:
    std::string_view _rest;
    bool _bigEndian;
};

/// A body of words; an entry takes two characters at least.
class TextBody {
public:
    explicit TextBody(std::string_view body) : _rest(body) {}

    bool skip(double words) {
        std::string_view word;
        for (; words > 0.0; words -= 1.0)
            if (!next(word)) return false;
        return true;
    }

    bool readCount(const PlyHeader::Property&, double& count) {
        std::string_view word;
        return next(word) && parseNumber(word, count);
    }

    bool hasRoom(double entries, std::size_t) const {
        return entries >= 0.0 && 2.0 * entries <= double(_rest.size()) + 1.0;
    }

private:
    bool next(std::string_view& word) {
        const char* const blank = " \t\r\n";
        const std::size_t begin = _rest.find_first_not_of(blank);
        if (begin == std::string_view::npos) return false;
        const std::size_t end = std::min(_rest.find_first_of(blank, begin), _rest.size());
        word = _rest.substr(begin, end - begin);
        _rest.remove_prefix(end);
        return true;
    }

    std::string_view _rest;
};

template <typename Body>
void walk(const std::string& path, const PlyHeader& header, Body body, bool binary) {
    for (const PlyHeader::Element& element : header.elements)
        for (double i = 0.0; i < element.count; i += 1.0)
            for (const PlyHeader::Property& property : element.properties) {
                double entries = 1.0;
                if (property.countBytes > 0) {
                    if (!body.readCount(property, entries)) return;
                    if (!body.hasRoom(entries, property.bytes)) failList(path, element, i, entries);
                }
                if (!body.skip(binary ? entries * double(property.bytes) : entries)) return;
            }
}

} // namespace

void checkPlyLists(const std::string& path, const PlyHeader& header, std::string_view body) {
    if (header.format == PlyHeader::Format::Text)
        walk(path, header, TextBody(body), false);
    else
        walk(path, header, BinaryBody(body, header.format == PlyHeader::Format::BigEndian), true);
}

} // namespace osgSkin
