// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "Bytes.h"

#include <osg/Vec2>
#include <osg/Vec4>

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace bake {

/// The binary buffer of a glTF file, with its views and accessors. Each add() returns the index of
/// an accessor, or of a view where it says so.
class GlbBuffer {
public:
    std::size_t addVectors(const std::vector<glm::dvec3>& vectors, bool withRange);
    std::size_t addTexCoords(const std::vector<osg::Vec2>& texCoords); ///< flipped for glTF
    std::size_t addColours(const std::vector<osg::Vec4>& linear);
    std::size_t addIndices(const std::vector<std::uint32_t>& indices);
    std::size_t addTimes(const std::vector<float>& ascending);
    std::size_t addNumbers(const std::vector<float>& numbers);
    std::size_t addFile(const std::string& data); ///< returns the view's index

    std::size_t size() const { return _bytes.data.size(); }

    /// Writes `root`, completed by the buffer's parts, and the buffer as a .glb file.
    /// \throw osgSkin::Error where the file cannot be written
    void write(const std::string& file, nlohmann::json root) const;

private:
    enum class Use { Vertices, Indices, Data };
    std::size_t addView(std::size_t begin, Use use);
    std::size_t addAccessor(std::size_t begin, std::size_t count, const char* type, int component,
                            Use use);

    Bytes _bytes;
    nlohmann::json _views = nlohmann::json::array();
    nlohmann::json _accessors = nlohmann::json::array();
};

} // namespace bake
