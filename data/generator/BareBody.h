// SPDX-License-Identifier: MIT
#pragma once

#include "ImplicitBody.h"

namespace mannequin {

/// The body of the thrower, bare and muscular. Symmetric in x.
class BareBody : public ImplicitBody {
public:
    BareBody();

    double distance(const glm::dvec3& point) const override;
    glm::dvec3 lowerCorner() const override;
    glm::dvec3 upperCorner() const override;

private:
    Sculpture _trunk, _head, _arm, _leg;
};

} // namespace mannequin
