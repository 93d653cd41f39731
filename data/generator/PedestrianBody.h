// SPDX-License-Identifier: MIT
#pragma once

#include "DetailMap.h"
#include "ImplicitBody.h"

#include <functional>
#include <vector>

namespace mannequin {

/// A man in a jacket, trousers and shoes. Symmetric in x, but for the hair.
class PedestrianBody : public ImplicitBody {
public:
    PedestrianBody();

    double distance(const glm::dvec3& point) const override;
    glm::dvec3 lowerCorner() const override;
    glm::dvec3 upperCorner() const override;

private:
    Sculpture _jacket, _trousers, _head, _hair, _arm, _leg;
};

/// Short edges on face, hands and shoes and at joints.
DetailMap pedestrianDetail();

enum class Material { Hair, Skin, Eyes, Lips, Shirt, Jacket, Trousers, Shoe, Sole };
constexpr int kMaterialCount = 9;

/// The material of the skin at a point.
Material materialAt(const glm::dvec3& point);

/// A curve where the material changes.
struct MaterialEdge {
    std::function<double(const glm::dvec3&)> side; ///< metres from the curve, of either sign
    std::function<bool(const glm::dvec3&)>
        applies; ///< whether a point is on a part that it crosses
};

std::vector<MaterialEdge> materialEdges();

/// An edge of a material that stands off from the one below it.
struct Tuck {
    Material outer, inner;
    double depth; ///< metres
};

std::vector<Tuck> tucks();

} // namespace mannequin
