// SPDX-License-Identifier: MIT
#include "assimp/FbxDocument.h"

#include "files/FileText.h"

#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

namespace osgSkin {
namespace {

/// Thrown inside this file only.
struct Malformed {};

constexpr int kMaxDepth = 64;
constexpr std::size_t kMaxValues = 8; ///< that are kept of a record; a property has 4 to 8

[[noreturn]] void failDepth(const std::string& path) {
    failFile(path, "records are nested more than " + std::to_string(kMaxDepth) + " deep");
}

/// Whether an array's numbers are of use.
bool isReadArray(std::string_view name) {
    return name == "TransformLink" || name.rfind("Key", 0) == 0; // of a curve
}

/// Whether a record at a depth is of use.
bool isNeeded(std::string_view name, int depth, bool isObject) {
    static constexpr std::string_view kObjects[] = {
        "Model",          "Geometry",           "Deformer",      "AnimationStack",
        "AnimationLayer", "AnimationCurveNode", "AnimationCurve"};
    if (depth == 0) return name == "Objects" || name == "Connections";
    if (depth == 2) return name == "Properties70" || isReadArray(name);
    if (depth > 2 || !isObject) return true;
    return std::find(std::begin(kObjects), std::end(kObjects), name) != std::end(kObjects);
}

/// Whether a record's children are of use.
bool isWhole(std::string_view name, int depth) {
    return depth != 1 || name != "Geometry";
}

/// Reads a binary file, and refuses what Assimp would trust: arrays of any stated length, and any
/// depth.
class BinaryReader {
public:
    BinaryReader(std::string_view bytes, const std::string& path)
        : _path(path), _bytes(bytes), _at(std::min(kMagic, bytes.size())),
          _unpacked(kMinUnpacked + kRatio * bytes.size()) {}

    std::vector<FbxRecord> readAll() try {
        _isWide = number<std::uint32_t>() >= 7500; // 64-bit offsets
        std::vector<FbxRecord> result;
        while (readRecord(&result, 0, false, _bytes.size())) {
        }
        return result;
    } catch (const Malformed&) {
        failFile(_path, "malformed record at byte " + std::to_string(_at) + adviceFor(_bytes));
    }

private:
    static constexpr std::size_t kMagic = 23; ///< bytes before the version
    static constexpr std::size_t kMinUnpacked = std::size_t(1) << 24, kRatio = 64;
    static constexpr std::size_t kKept = 4; ///< of one byte in memory

    template <typename Number>
    Number number() {
        Number result;
        std::memcpy(&result, take(sizeof result).data(), sizeof result);
        return result;
    }

    std::string_view take(std::size_t size) {
        if (size > _bytes.size() - _at) throw Malformed();
        const std::string_view result = _bytes.substr(_at, size);
        _at += size;
        return result;
    }

    std::size_t offset() {
        return static_cast<std::size_t>(_isWide ? number<std::uint64_t>()
                                                : number<std::uint32_t>());
    }

    template <typename Number>
    static std::vector<double> numbers(std::string_view bytes) {
        std::vector<double> result(bytes.size() / sizeof(Number));
        for (std::size_t i = 0; i < result.size(); ++i) {
            Number value;
            std::memcpy(&value, bytes.data() + i * sizeof value, sizeof value);
            result[i] = static_cast<double>(value);
        }
        return result;
    }

    /// \param isKept otherwise only the lengths are checked
    std::vector<double> list(char type, bool isKept) {
        const std::size_t width = type == 'd' || type == 'l'   ? 8
                                  : type == 'f' || type == 'i' ? 4
                                  : type == 'b' || type == 'c' ? 1
                                                               : 0;
        const auto count = number<std::uint32_t>(), encoding = number<std::uint32_t>();
        std::string_view bytes = take(number<std::uint32_t>());
        const std::size_t size = count * width;
        if (width == 0 || encoding > 1 || (encoding == 0 && bytes.size() != size))
            throw Malformed();
        std::vector<unsigned char> unpacked;
        if (encoding == 1) {
            const std::size_t cost = isKept ? kKept * size : size;
            if (cost > _unpacked)
                failFile(_path, "its arrays state too many numbers for a file of " +
                                    std::to_string(_bytes.size()) + " bytes");
            _unpacked -= cost;
            if (!isKept) return {};
            unpacked.resize(size);
            auto written = static_cast<uLongf>(size);
            if (uncompress(unpacked.data(), &written,
                           reinterpret_cast<const unsigned char*>(bytes.data()),
                           static_cast<uLong>(bytes.size())) != Z_OK ||
                written != size)
                throw Malformed();
            bytes = {reinterpret_cast<const char*>(unpacked.data()), size};
        }
        if (!isKept) return {};
        switch (type) {
        case 'f':
            return numbers<float>(bytes);
        case 'd':
            return numbers<double>(bytes);
        case 'l':
            return numbers<std::int64_t>(bytes);
        case 'i':
            return numbers<std::int32_t>(bytes);
        default:
            return numbers<signed char>(bytes);
        }
    }

    FbxValue value(char type) {
        FbxValue result;
        const auto setInteger = [&result](std::int64_t integer) {
            result.integer = integer;
            result.number = static_cast<double>(integer);
        };
        switch (type) {
        case 'C':
        case 'B':
            setInteger(number<signed char>());
            break;
        case 'Y':
            setInteger(number<std::int16_t>());
            break;
        case 'I':
            setInteger(number<std::int32_t>());
            break;
        case 'L':
            setInteger(number<std::int64_t>());
            break;
        case 'F':
            result.number = double(number<float>());
            break;
        case 'D':
            result.number = number<double>();
            break;
        case 'S':
            result.text = take(number<std::uint32_t>());
            break;
        default: // 'R'
            take(number<std::uint32_t>());
        }
        return result;
    }

    /// \param to null: the record is only checked
    /// \param last where the record above ends
    /// \return false at the end of a list of records
    bool readRecord(std::vector<FbxRecord>* to, int depth, bool isObject, std::size_t last) {
        const std::size_t end = offset(), values = offset(), size = offset();
        const std::string_view name = take(number<unsigned char>());
        if (end == 0) return false;
        if (end > last || end < _at || size > end - _at) throw Malformed();
        if (depth > kMaxDepth) failDepth(_path);
        if (to != nullptr && !isNeeded(name, depth, isObject)) to = nullptr;
        const bool isObjects = depth == 0 && name == "Objects";
        FbxRecord unused;
        FbxRecord& record = to != nullptr ? to->emplace_back() : unused;
        record.name = name;
        const std::size_t children = _at + size;
        if (to != nullptr) record.values.reserve(std::min(values, kMaxValues));
        for (std::size_t v = 0; v < values && _at < children; ++v) {
            const char type = take(1)[0];
            if (std::string_view("CBYILFDSR").find(type) == std::string_view::npos) {
                record.numbers = list(type, to != nullptr && isReadArray(record.name));
                continue;
            }
            FbxValue next = value(type);
            if (to != nullptr && record.values.size() < kMaxValues)
                record.values.push_back(std::move(next));
        }
        _at = children;
        const bool keepsRecords = to != nullptr && isWhole(record.name, depth);
        while (_at < end &&
               readRecord(keepsRecords ? &record.records : nullptr, depth + 1, isObjects, end)) {
        }
        _at = end;
        return true;
    }

    const std::string& _path;
    const std::string_view _bytes;
    std::size_t _at = 0;
    std::size_t _unpacked; ///< how many more bytes compressed arrays may have
    bool _isWide = false;
};

/// Refuses what Assimp would trust in a text file, as BinaryReader does.
void checkText(std::string_view fbx, const std::string& path) {
    int depth = 0;
    for (std::size_t i = 0; i < fbx.size(); ++i) {
        const char c = fbx[i];
        if (c == '"' || c == ';') i = std::min(fbx.find(c == '"' ? c : '\n', i + 1), fbx.size());
        if (c == '{' && ++depth > kMaxDepth) failDepth(path);
        if (c == '}' && depth > 0) --depth;
        if (c != '*') continue;
        std::size_t count = 0; // of an array's numbers
        const auto [stop, status] =
            std::from_chars(fbx.data() + i + 1, fbx.data() + fbx.size(), count);
        if (count > fbx.size() || status == std::errc::result_out_of_range)
            failFile(path, "an array states more numbers than the file has characters");
    }
}

class TextReader {
public:
    explicit TextReader(const std::string& bytes) : _at(bytes.c_str()) {}

    std::vector<FbxRecord> readAll() {
        std::vector<FbxRecord> result;
        readRecords(result, 0, false, false);
        return result;
    }

private:
    /// Skips blanks and comments, and ends of lines too if wanted.
    void skip(bool lines) {
        for (;; ++_at) {
            if (*_at == ';')
                while (*_at != '\0' && *_at != '\n') ++_at;
            if (*_at == '\0' || (*_at == '\n' && !lines) ||
                std::isspace(static_cast<unsigned char>(*_at)) == 0)
                return;
        }
    }

    void readRecords(std::vector<FbxRecord>& to, int depth, bool isObject, bool keepsLists) {
        if (depth > kMaxDepth) throw Malformed();
        for (skip(true); *_at != '\0' && *_at != '}'; skip(true)) {
            const char* const begin = _at;
            while (*_at != ':' && *_at != '\0' && *_at != '\n') ++_at;
            if (*_at != ':') throw Malformed();
            std::string name(begin, _at++);
            if (isNeeded(name, depth, isObject)) {
                const bool isObjects = depth == 0 && name == "Objects";
                FbxRecord& record = to.emplace_back();
                record.name = std::move(name);
                readValues(record, keepsLists);
                if (*_at != '{') continue;
                if (!isWhole(record.name, depth)) {
                    skipRecord();
                    continue;
                }
                ++_at;
                readRecords(record.records, depth + 1, isObjects, isReadArray(record.name));
                if (*_at++ != '}') throw Malformed();
            } else {
                skipRecord();
            }
        }
    }

    /// Reads values up to the end of the line, or of the list behind a comma.
    void readValues(FbxRecord& record, bool keepsLists) {
        for (skip(false); *_at != '\0' && *_at != '\n' && *_at != '{' && *_at != '}'; skip(false)) {
            if (record.name == "a") { // the numbers of an array
                char* end = nullptr;
                const double number = std::strtod(_at, &end);
                if (keepsLists) record.numbers.push_back(number);
                if (end == _at) throw Malformed();
                _at = end;
            } else {
                FbxValue next = value();
                if (record.values.size() < kMaxValues) record.values.push_back(std::move(next));
            }
            skip(false);
            if (*_at != ',') continue;
            ++_at;
            skip(true);
        }
    }

    FbxValue value() {
        FbxValue result;
        if (*_at == '"') {
            const char* const begin = ++_at;
            while (*_at != '"' && *_at != '\0') ++_at;
            if (*_at == '\0') throw Malformed();
            result.text.assign(begin, _at++);
            return result;
        }
        const char* const begin = _at;
        while (*_at != '\0' && *_at != ',' && *_at != '{' && *_at != '}' &&
               std::isspace(static_cast<unsigned char>(*_at)) == 0)
            ++_at;
        const std::string word(begin, _at);
        if (word.empty()) throw Malformed();
        result.integer = std::strtoll(word.c_str(), nullptr, 10);
        result.number = std::strtod(word.c_str(), nullptr);
        return result;
    }

    void skipRecord() {
        int depth = 0;
        for (; *_at != '\0'; ++_at) {
            if (*_at == '"') {
                const char* const close = std::strchr(_at + 1, '"');
                if (close == nullptr) throw Malformed();
                _at = close;
            } else if (*_at == '{') {
                ++depth;
            } else if (*_at == '}' && --depth <= 0) {
                if (depth == 0) ++_at; // else the end of the record above
                return;
            } else if (*_at == '\n' && depth == 0) {
                return;
            }
        }
    }

    const char* _at;
};

} // namespace

const FbxRecord* FbxRecord::find(std::string_view wanted) const {
    const auto found = std::find_if(records.begin(), records.end(),
                                    [&](const FbxRecord& record) { return record.name == wanted; });
    return found == records.end() ? nullptr : &*found;
}

const std::vector<double>& FbxRecord::list(std::string_view wanted) const {
    static const std::vector<double> none;
    const FbxRecord* found = find(wanted);
    if (found == nullptr) return none;
    if (const FbxRecord* const text = found->find("a")) found = text;
    return found->numbers;
}

const FbxRecord* FbxRecord::property(std::string_view wanted) const {
    const FbxRecord* const properties = find("Properties70");
    if (properties == nullptr) return nullptr;
    for (const FbxRecord& record : properties->records)
        if (!record.values.empty() && record.values.front().text == wanted) return &record;
    return nullptr;
}

std::string adviceFor(std::string_view fbx) {
    return fbx.find("Open Asset Import Library") == std::string_view::npos
               ? std::string()
               : "; Assimp does not read binary FBX files that it wrote: export text (assimp "
                 "export -ffbxa), or glTF";
}

FbxDocument FbxDocument::read(const std::string& bytes, const std::string& path) try {
    const bool isBinary = bytes.rfind("Kaydara FBX Binary", 0) == 0;
    FbxDocument result;
    if (!isBinary) checkText(bytes, path);
    for (FbxRecord& record :
         isBinary ? BinaryReader(bytes, path).readAll() : TextReader(bytes).readAll()) {
        auto& to = record.name == "Objects" ? result.objects : result.connections;
        std::move(record.records.begin(), record.records.end(), std::back_inserter(to));
    }
    return result;
} catch (const Malformed&) {
    return {};
}

void renamePropertyConnections(std::string& fbx) {
    // In binary files: a record called "C", and a string of two bytes.
    static const std::string binary("\x01"
                                    "CS\x02\0\0\0PO",
                                    9);
    for (auto at = fbx.find(binary); at != std::string::npos; at = fbx.find(binary, at + 1))
        fbx[at + binary.size() - 1] = 'P';
    static const std::string text = "\"PO\"";
    for (auto at = fbx.find(text); at != std::string::npos; at = fbx.find(text, at + 1)) {
        std::size_t end = at; // of the record's name
        while (end > 0 && (fbx[end - 1] == ' ' || fbx[end - 1] == '\t')) --end;
        const bool isConnection =
            end > 1 && fbx.compare(end - 2, 2, "C:") == 0 &&
            (end == 2 || std::isspace(static_cast<unsigned char>(fbx[end - 3])) != 0);
        if (isConnection) fbx[at + 2] = 'P';
    }
}

} // namespace osgSkin
