// SPDX-License-Identifier: MIT
#include "text/PlyBody.h"

#include "text/FileText.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace osgSkin {
namespace {

/// A body of bytes.
class PlyBytes {
public:
    PlyBytes(std::string_view body, bool bigEndian) : _rest(body), _bigEndian(bigEndian) {}

    /// Null, or what is wrong.
    const char* read(const PlyHeader::Type& type, double& number) {
        if (_rest.size() < type.bytes) return "the file ends here";
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < type.bytes; ++i)
            bits = bits << 8 | std::uint8_t(_rest[_bigEndian ? i : type.bytes - 1 - i]);
        _rest.remove_prefix(type.bytes);
        number = numberOf(bits, type);
        return nullptr;
    }

    bool hasRoom(double entries, const PlyHeader::Type& type) const {
        return entries >= 0.0 && entries * double(type.bytes) <= double(_rest.size());
    }

    bool isAtEnd() const { return _rest.empty(); }

private:
    static double numberOf(std::uint64_t bits, const PlyHeader::Type& type) {
        if (type.kind == PlyHeader::Kind::Floating) {
            if (type.bytes == 8) return as<double>(bits);
            return double(as<float>(std::uint32_t(bits)));
        }
        const double range = std::ldexp(1.0, int(8 * type.bytes));
        const bool negative = type.kind == PlyHeader::Kind::Signed && double(bits) >= range / 2.0;
        return double(bits) - (negative ? range : 0.0);
    }

    template <typename Number, typename Bits>
    static Number as(Bits bits) {
        static_assert(sizeof(Number) == sizeof(Bits), "the same bytes");
        Number number;
        std::memcpy(&number, &bits, sizeof number);
        return number;
    }

    std::string_view _rest;
    bool _bigEndian;
};

/// A body of words; an entry takes two characters at least.
class PlyWords {
public:
    explicit PlyWords(std::string_view body) : _rest(body) {}

    const char* read(const PlyHeader::Type&, double& number) {
        const char* const blank = " \t\r\n";
        const std::size_t begin = _rest.find_first_not_of(blank);
        if (begin == std::string_view::npos) return "the file ends here";
        const std::size_t end = std::min(_rest.find_first_of(blank, begin), _rest.size());
        const bool isNumber = parseNumber(_rest.substr(begin, end - begin), number);
        _rest.remove_prefix(end);
        return isNumber ? nullptr : "a word that is no number";
    }

    bool hasRoom(double entries, const PlyHeader::Type&) const {
        return entries >= 0.0 && 2.0 * entries <= double(_rest.size()) + 1.0;
    }

    bool isAtEnd() const { // some systems end a text with Ctrl-Z
        return _rest.find_first_not_of(std::string_view(" \t\r\n\x1a\0", 6)) == std::string::npos;
    }

private:
    std::string_view _rest;
};

/// A list's length for a message: a whole number where it is one.
std::string lengthText(double length) {
    return std::abs(length) < 1e15 && length == std::floor(length)
               ? std::to_string(static_cast<std::int64_t>(length))
               : std::to_string(length);
}

/// Whether nothing is left of the body.
template <typename Body>
bool walk(const std::string& path, const PlyHeader& header, Body body, const TakePlyEntry& take) {
    PlyValues values;
    for (const PlyHeader::Element& element : header.elements)
        for (std::size_t i = 0; i < element.count && !element.properties.empty(); ++i) {
            const auto fail = [&](const std::string& what) {
                failFile(path,
                         "element \"" + element.name + "\" " + std::to_string(i) + ": " + what);
            };
            values.resize(element.properties.size());
            for (std::size_t p = 0; p < values.size(); ++p) {
                const PlyHeader::Property& property = element.properties[p];
                double entries = 1.0, number = 0.0;
                if (property.count) {
                    if (const char* wrong = body.read(*property.count, entries)) fail(wrong);
                    if (!body.hasRoom(entries, property.type) || entries != std::floor(entries))
                        fail("a list of " + lengthText(entries) +
                             " entries, expected no more than the file has room for");
                }
                values[p].clear();
                for (double k = 0.0; k < entries; k += 1.0) {
                    if (const char* wrong = body.read(property.type, number)) fail(wrong);
                    values[p].push_back(number);
                }
            }
            take(element, i, values);
        }
    return body.isAtEnd();
}

} // namespace

void readPlyBody(const std::string& path, const PlyHeader& header, std::string_view body,
                 const TakePlyEntry& take) {
    const bool isText = header.format == PlyHeader::Format::Text;
    const bool isWhole =
        isText ? walk(path, header, PlyWords(body), take)
               : walk(path, header, PlyBytes(body, header.format == PlyHeader::Format::BigEndian),
                      take);
    if (isWhole) return;
    // Rows that are longer than the header says have been read as if they were others.
    if (isText)
        failFile(path, "words behind the last element, expected as many as the header says");
    tellOf(path, "bytes behind the last element, passed over");
}

} // namespace osgSkin
