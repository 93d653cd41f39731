// SPDX-License-Identifier: GPL-3.0-or-later
#include "cache/ShapesCache.h"

#include "cache/Bytes.h"
#include "cache/Digest.h"

#include <osgSkin/Error>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <utility>

namespace osgSkin {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostBytes =
    8192; // of a vertex: eight joints correct it, by 400 bytes each
constexpr std::size_t kFixedVertices = 1000; // for whatever there is once

void add(const CorrectiveJoint& joint, ByteWriter& writer) {
    writer.add(joint.joint);
    writer.add(joint.basis);
    writer.add(joint.axis);
    writer.add(joint.low);
    writer.add(joint.high);
    writer.addAll(joint.knots);
    writer.add(static_cast<std::uint64_t>(joint.modes));
    writer.addAll(joint.coefficients);
    writer.addAll(joint.normalScales);
}

void take(ByteReader& reader, CorrectiveJoint& joint) {
    reader.take(joint.joint);
    reader.take(joint.basis);
    reader.take(joint.axis);
    reader.take(joint.low);
    reader.take(joint.high);
    reader.takeAll(joint.knots);
    std::uint64_t modes = 0;
    reader.take(modes);
    joint.modes = static_cast<std::size_t>(modes);
    reader.takeAll(joint.coefficients);
    reader.takeAll(joint.normalScales);
}

std::string toBytes(const MadeShapes& shapes) {
    ByteWriter writer;
    writer.add(static_cast<std::uint64_t>(shapes.notes.size()));
    for (const std::string& note : shapes.notes) writer.addText(note);
    const Correctives& correctives = shapes.correctives;
    writer.add(static_cast<std::uint64_t>(correctives.joints.size()));
    for (const CorrectiveJoint& joint : correctives.joints) add(joint, writer);
    writer.addAll(correctives.firstEntry);
    writer.addAll(correctives.entries);
    writer.addAll(correctives.shares);
    writer.addAll(correctives.normalShares);
    return writer.bytes();
}

bool fromBytes(const std::string& bytes, MadeShapes& shapes) {
    ByteReader reader(bytes);
    std::uint64_t notes = 0, joints = 0;
    for (reader.take(notes); notes > 0 && !reader.failed(); --notes)
        reader.takeText(shapes.notes.emplace_back());
    for (reader.take(joints); joints > 0 && !reader.failed(); --joints)
        take(reader, shapes.correctives.joints.emplace_back());
    reader.takeAll(shapes.correctives.firstEntry);
    reader.takeAll(shapes.correctives.entries);
    reader.takeAll(shapes.correctives.shares);
    reader.takeAll(shapes.correctives.normalShares);
    return reader.isComplete();
}

/// All of a file of shapes; nothing where it is a pipe, a device or a folder, or larger than shapes
/// of so many vertices are.
std::string bytesOf(const std::string& file, std::size_t vertices) {
    std::error_code failure;
    if (!fs::is_regular_file(file, failure)) return {};
    const std::uintmax_t size = fs::file_size(file, failure);
    if (failure || size / kMostBytes > vertices + kFixedVertices) return {};
    std::string all(static_cast<std::size_t>(size), '\0');
    std::ifstream in(file, std::ios::binary);
    in.read(all.data(), static_cast<std::streamsize>(size));
    return static_cast<std::uintmax_t>(in.gcount()) == size ? all : std::string();
}

} // namespace

/// The file: the digest of what shapes are made of, that of the rest, and the rest.
ShapesCache::ShapesCache(std::string folder, const std::string& digest)
    : _folder(std::move(folder)), _digest(digest) {
    if (!_folder.empty()) _file = (fs::path(_folder) / ("shapes-" + digest)).string();
}

std::optional<MadeShapes> ShapesCache::read(const Binding& binding,
                                            std::vector<std::string>& notes) const {
    if (_file.empty()) return std::nullopt;
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
                // is no use, as below
            }
    }
    notes.push_back(_file + ": not a whole file of shapes, they are made anew");
    return std::nullopt;
}

void ShapesCache::write(const MadeShapes& shapes, std::vector<std::string>& notes) const {
    if (_file.empty()) return;
    std::error_code failed;
    fs::create_directories(_folder, failed);
    const std::string bytes = toBytes(shapes);
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
    notes.push_back(_file + ": cannot be written, so shapes are made anew each time");
}

} // namespace osgSkin
