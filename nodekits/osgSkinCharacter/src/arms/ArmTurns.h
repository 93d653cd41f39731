// SPDX-License-Identifier: MIT
#ifndef OSGSKINCHARACTER_ARMS_ARMTURNS_H
#define OSGSKINCHARACTER_ARMS_ARMTURNS_H

#include "arms/BodyFields.h"

#include <osgSkin/GlmTypes>

#include <array>
#include <cstddef>
#include <vector>

namespace osgSkin {

/// A vector for the left arm and one for the right.
using ArmPair = std::array<glm::dvec3, 2>;

/// Both arms of a body in one sample of a clip, skeleton space.
struct ArmSample {
    /// A point of an arm that may meet a field of the body.
    struct Near {
        std::size_t field = 0, point = 0;
        glm::dvec3 place{0.0};
        double margin = 0.0; ///< the distance that it should have
    };
    struct Arm {
        glm::dvec3 shoulder{0.0}, palm{0.0};
        glm::dmat3 above{1.0}; ///< axes of the joint that carries the arm
        glm::dvec3 axis{0.0};  ///< unit, from shoulder to elbow, in these axes
        std::vector<Near> near;
        bool isFree = false; ///< whether it may be turned
    };
    std::vector<BodyFields::ToRest> maps; ///< of the body
    std::array<Arm, 2> arms;
    double touch = 0.0; ///< 1 where the hands touch, 0 where they are far from each other
};

/// Finds the rotations of both upper arms that keep them out of the body, for a whole clip at once.
///
/// Their rotation vectors, in the axes of the joints above, are uniform cubic B-splines with one
/// coefficient for each sample. Minimised are the squared depths of the arms' points below their
/// margins, the rotations, most of all about the arm's own axis, the ways of the hands, the ways of
/// touching hands against each other, and the splines' second derivatives: by damped Gauss-Newton
/// steps (Levenberg-Marquardt) with a banded matrix.
class ArmTurns {
public:
    /// \param fields of the body; must outlive this
    /// \param samples of the whole clip; must outlive this
    /// \param length of an arm
    /// \param interval seconds between samples
    ArmTurns(const BodyFields& fields, const std::vector<ArmSample>& samples, double length,
             double interval)
        : _fields(fields), _samples(samples), _length(length), _interval(interval),
          _coefficients(samples.size()) {}

    /// Finds the rotations, from those that were found before.
    void solve();

    /// The rotation vectors at a place between samples: 0 at the first, 1 at the next. Exactly 0
    /// two samples away from those in which the arm is free.
    ArmPair at(double place) const;

private:
    struct Energy;
    struct System;
    void solve(std::size_t first, std::size_t end);
    System assemble(std::size_t first, std::size_t end) const;
    Energy energyAt(std::size_t sample) const;
    std::size_t clamped(std::ptrdiff_t sample) const; ///< splines go on beyond the ends

    const BodyFields& _fields;
    const std::vector<ArmSample>& _samples;
    double _length, _interval;
    std::vector<ArmPair> _coefficients;
};

} // namespace osgSkin

#endif
