// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace test {

/// The scalar functions of one joint's correctives, computed from osgskinbake's output and the
/// formula: shares no code with the product.
class ReferenceShapes {
public:
    /// \param json one of the binding's "correctives"
    explicit ReferenceShapes(const nlohmann::json& json);

    /// Whether they follow the input of that name instead of the joint's bend.
    bool isInput() const { return _basis == "input"; }
    const std::string& joint() const { return _joint; }

    /// The factor of each mode's vectors in a bend by `psi` about `v`; w is the twist axis.
    std::vector<double> weights(const glm::dvec3& v, double psi, const glm::dvec3& w) const;
    std::vector<double> weights(double input) const;

private:
    std::vector<double> functions(double x, double y) const;
    std::vector<double> sums(const std::vector<double>& phi) const;

    std::string _basis, _joint;
    glm::dvec3 _axis{0.0};
    glm::dvec2 _low, _high;
    std::vector<double> _knots;
    std::vector<std::vector<double>> _coefficients;
};

} // namespace test
