// SPDX-License-Identifier: GPL-3.0-or-later
#include "PointCache.h"

#include "Bytes.h"

#include <osgSkin/Error>

namespace bake {

PointCache::PointCache(const std::string& file, const FrameSeries& series)
    : _file(file), _out(file, std::ios::binary) {
    Bytes header;
    header.data = std::string("POINTCACHE2\0", 12);
    header.add(std::int32_t(1)); // version
    header.add(static_cast<std::int32_t>(series.character->body.mesh.positions.size()));
    header.add(static_cast<float>(series.first));
    header.add(1.0f); // frames from one sample to the next
    header.add(static_cast<std::int32_t>(series.count));
    write(header.data);
}

void PointCache::add(std::size_t, const PosedMesh& posed) {
    Bytes sample;
    for (const glm::dvec3& position : posed.positions) sample.add(position);
    write(sample.data);
}

void PointCache::finish() {
    _out.close();
    if (!_out) write({});
}

void PointCache::write(const std::string& data) {
    _out.write(data.data(), static_cast<std::streamsize>(data.size()));
    if (!_out) throw osgSkin::Error(_file + ": cannot be written, expected a writable file");
}

} // namespace bake
