// SPDX-License-Identifier: MIT
#pragma once

#include "ReferenceShapes.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <vector>

namespace test {

/// The vertices of an OBJ file, in file order.
std::vector<glm::dvec3> readObjVertices(const std::string& file);

/// The faces of an OBJ file: its `f` lines with 1-based vertex numbers only.
std::vector<std::vector<int>> readObjFaces(const std::string& file);

/// The deformation again, in double precision and only from osgskinbake's output: written from the
/// formula, it shares no code with the product.
class ReferenceSkin {
public:
    ReferenceSkin(const nlohmann::json& binding, std::vector<glm::dvec3> rest);

    /// The skin in one frame of a --pose file.
    std::vector<glm::dvec3> pose(const nlohmann::json& frame) const;

    /// Extent of the rest vertices along y.
    double height() const;

private:
    struct Joint {
        std::string name;
        bool root;
        glm::dvec3 centre;
        glm::dvec3 twistAxis;
    };
    struct Share {
        double bend = 0.0;
        double twist = 0.0;
    };
    /// Adds the correctives of a frame to the rest vertices.
    void correct(const nlohmann::json& frame, std::vector<glm::dvec3>& vertices) const;

    std::vector<Joint> _joints;
    std::vector<ReferenceShapes> _shapes;
    /// Per vertex: joint -> a vector for each of its modes.
    std::vector<std::map<std::size_t, std::vector<glm::dvec3>>> _vectors;
    std::vector<std::map<std::string, Share>> _shares; ///< per vertex
    std::vector<glm::dvec3> _rest;
};

} // namespace test
