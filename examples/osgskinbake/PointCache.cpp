// SPDX-License-Identifier: GPL-3.0-or-later
#include "PointCache.h"

#include "Bytes.h"

#include <osgSkin/Error>

#include <cstdint>
#include <limits>

namespace bake {

PointCache::PointCache(const std::string& file, const FrameSeries& series) : _out(file) {
    if (series.count > std::size_t(std::numeric_limits<std::int32_t>::max()))
        throw osgSkin::Error(file + ": too many frames for a point cache");
    Bytes header;
    header.data = std::string("POINTCACHE2\0", 12);
    header.add(std::int32_t(1)); // version
    header.add(static_cast<std::int32_t>(series.character->body.mesh.positions.size()));
    header.add(static_cast<float>(series.first));
    header.add(1.0f); // frames from one sample to the next
    header.add(static_cast<std::int32_t>(series.count));
    _out.write(header.data);
}

void PointCache::add(std::size_t, const PosedMesh& posed) {
    Bytes sample;
    for (const glm::dvec3& position : posed.positions) sample.add(position);
    _out.write(sample.data);
}

void PointCache::finish() {
    _out.finish();
}

} // namespace bake
