// SPDX-License-Identifier: GPL-3.0-or-later
#include "correctives/ShapesCache.h"

#include "correctives/AddShapes.h"
#include "correctives/MakeShapes.h"

#include <osgSkin/Error>
#include <osgSkin/Version>

#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <type_traits>

namespace osgSkin {
namespace {

namespace fs = std::filesystem;

/// To be increased whenever the same input gives other shapes than before, or the format changes.
constexpr std::uint32_t kMakerVersion = 11;

/// Limits the size of a file: up to eight joints correct a vertex, with 400 bytes each. The data
/// that does not depend on the vertices counts as kFixedVertices more.
constexpr std::uintmax_t kMaxBytes = 8192;
constexpr std::size_t kFixedVertices = 1000;

/// Writes values in this machine's byte order.
class ByteWriter {
public:
    template <typename T>
    void value(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        _bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
    }

    /// Writes their number first. T must have no padding.
    template <typename T>
    void values(const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        value(static_cast<std::uint64_t>(values.size()));
        _bytes.append(reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size());
    }

    void text(const std::string& text) {
        value(static_cast<std::uint64_t>(text.size()));
        _bytes += text;
    }

    template <typename T, typename Write>
    void list(const std::vector<T>& items, const Write& write) {
        value(static_cast<std::uint64_t>(items.size()));
        for (const T& item : items) write(item);
    }

    const std::string& bytes() const { return _bytes; }

private:
    std::string _bytes;
};

/// Reads what a ByteWriter wrote, in the same order, by functions of the same names. From the first
/// value that does not fit on, values stay as they are.
class ByteReader {
public:
    explicit ByteReader(const std::string& bytes) : _bytes(bytes) {}

    template <typename T>
    void value(T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (has(1, sizeof(T))) copy(&value, sizeof(T));
    }

    template <typename T>
    void values(std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        std::uint64_t count = 0;
        value(count);
        if (!has(count, sizeof(T))) return;
        values.resize(static_cast<std::size_t>(count));
        copy(values.data(), sizeof(T) * values.size());
    }

    void text(std::string& text) {
        std::vector<char> letters;
        values(letters);
        text.assign(letters.begin(), letters.end());
    }

    template <typename T, typename Read>
    void list(std::vector<T>& items, const Read& read) {
        std::uint64_t count = 0;
        for (value(count); count > 0 && !_failed; --count) read(items.emplace_back());
    }

    /// True if all bytes were read, and none were missing.
    bool isComplete() const { return !_failed && _at == _bytes.size(); }

private:
    bool has(std::uint64_t count, std::size_t size) {
        if (_failed || count > (_bytes.size() - _at) / size) _failed = true;
        return !_failed;
    }

    void copy(void* to, std::size_t size) {
        if (size > 0) std::memcpy(to, _bytes.data() + _at, size);
        _at += size;
    }

    const std::string& _bytes;
    std::size_t _at = 0;
    bool _failed = false;
};

/// The digest of all input of elastic shapes: mesh, skeleton, roles of the joints, ratios, and the
/// version of the code.
std::string inputDigest(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                        const WeldedMesh& mesh, const Binding& binding) {
    ByteWriter writer;
    writer.text(OSGSKIN_VERSION);
    writer.value(kMakerVersion);
    for (const RestJoint& joint : skeleton.joints) {
        writer.text(joint.name);
        writer.value(joint.parent);
        writer.value(joint.centre);
        writer.value(joint.tip ? 1 : 0);
        if (joint.tip) writer.value(*joint.tip);
    }
    for (const PlannedJoint& joint : joints) {
        for (const glm::dvec3& vector : {joint.boneAxis, joint.comingFrom, joint.twistAxis})
            writer.value(vector);
        for (const double length : {joint.boneLength, joint.lengthAbove}) writer.value(length);
        for (const int number : {static_cast<int>(joint.part), joint.parent, joint.rigid})
            writer.value(number);
        for (const bool flag : {joint.isExtremity(), joint.isOfTrunk(), joint.holdsRegion()})
            writer.value(flag);
    }
    writer.values(mesh.positions);
    writer.values(mesh.weldedOf);
    writer.values(mesh.triangles);
    writer.values(binding.firstInfluence);
    writer.values(binding.influences);
    return digestOf(writer.bytes());
}

/// Writes shapes to a ByteWriter, or reads them from a ByteReader.
template <typename Stream, typename Shapes>
void passShapes(Stream& stream, Shapes& shapes) {
    stream.list(shapes.notes, [&](auto& note) { stream.text(note); });
    auto& correctives = shapes.correctives;
    stream.list(correctives.joints, [&](auto& joint) {
        stream.value(joint.joint);
        stream.value(joint.basis);
        stream.value(joint.axis);
        stream.value(joint.low);
        stream.value(joint.high);
        stream.values(joint.knots);
        stream.value(joint.modes);
        stream.values(joint.coefficients);
        stream.values(joint.normalScales);
    });
    stream.values(correctives.firstEntry);
    stream.values(correctives.entries);
    stream.values(correctives.shares);
    stream.values(correctives.normalShares);
}

bool fromBytes(const std::string& bytes, MadeShapes& shapes) {
    ByteReader reader(bytes);
    passShapes(reader, shapes);
    return reader.isComplete();
}

/// The content of a file of shapes; empty if it is a pipe, a device or a folder, or larger than
/// shapes of so many vertices can be.
std::string bytesOf(const std::string& file, std::size_t vertices) {
    std::error_code failure;
    if (!fs::is_regular_file(file, failure)) return {};
    const std::uintmax_t size = fs::file_size(file, failure);
    if (failure || size / kMaxBytes > vertices + kFixedVertices) return {};
    std::string all(static_cast<std::size_t>(size), '\0');
    std::ifstream in(file, std::ios::binary);
    in.read(all.data(), static_cast<std::streamsize>(size));
    return static_cast<std::uintmax_t>(in.gcount()) == size ? all : std::string();
}

} // namespace

std::string digestOf(const std::string& bytes) {
    const boost::uuids::name_generator_sha1 generate(boost::uuids::ns::oid());
    return boost::uuids::to_string(generate(bytes.data(), bytes.size()));
}

ShapesCache::ShapesCache(const std::string& folder, const std::string& digest)
    : _folder(folder), _file((fs::path(folder) / ("shapes-" + digest)).string()), _digest(digest) {}

std::optional<MadeShapes> ShapesCache::read(const Binding& binding,
                                            std::vector<std::string>& notes) const {
    std::error_code missing;
    if (!fs::exists(_file, missing)) return std::nullopt;
    const std::string all = bytesOf(_file, binding.vertexCount());
    const std::size_t digest = _digest.size();
    MadeShapes shapes;
    if (all.size() > 2 * digest && all.compare(0, digest, _digest) == 0) {
        const std::string bytes = all.substr(2 * digest);
        if (all.compare(digest, digest, digestOf(bytes)) == 0 && fromBytes(bytes, shapes)) try {
                shapes.correctives.validate(binding.joints, binding.vertexCount());
                return shapes;
            } catch (const Error&) {
                // noted below
            }
    }
    notes.push_back(_file + ": not a valid file of shapes, they are computed again");
    return std::nullopt;
}

void ShapesCache::write(const MadeShapes& shapes, std::vector<std::string>& notes) const {
    std::error_code failed;
    fs::create_directories(_folder, failed);
    ByteWriter writer;
    passShapes(writer, shapes);
    const std::string& bytes = writer.bytes();
    const std::string beside = _file + '.' + std::to_string(std::random_device{}());
    {
        std::ofstream out(beside, std::ios::binary);
        out << _digest << digestOf(bytes) << bytes;
        out.flush();
        if (!out) failed = std::make_error_code(std::errc::io_error);
    }
    if (!failed) fs::rename(beside, _file, failed);
    if (!failed) return;
    std::error_code ignored;
    fs::remove(beside, ignored);
    notes.push_back(_file + ": cannot be written, so shapes are computed again each time");
}

Correctives cachedElasticShapes(const RestSkeleton& skeleton,
                                const std::vector<PlannedJoint>& joints, const WeldedMesh& mesh,
                                const SkinLayers* layers, const BindOptions& options,
                                const Progress& progress, const Binding& binding,
                                std::vector<std::string>& notes) {
    std::optional<ShapesCache> cache;
    if (!options.cacheFolder.empty()) {
        cache.emplace(options.cacheFolder, inputDigest(skeleton, joints, mesh, binding));
        if (std::optional<MadeShapes> known = cache->read(binding, notes)) {
            notes.insert(notes.end(), known->notes.begin(), known->notes.end());
            return std::move(known->correctives);
        }
    }
    MadeShapes made;
    made.correctives =
        makeElasticShapes(skeleton, joints, mesh, layers, binding, progress, made.notes);
    notes.insert(notes.end(), made.notes.begin(), made.notes.end());
    if (cache) cache->write(made, notes);
    return made.correctives;
}

} // namespace osgSkin
