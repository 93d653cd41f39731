// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_MIDDLETHIRD_H
#define OSGSKINBIND_MIDDLETHIRD_H

#include "limbs/BinaryField.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// The skin around the middle third of a limb's bone: what should move as if it were rigid.
class MiddleThird {
public:
    /// Without skin.
    MiddleThird() = default;

    MiddleThird(const BinaryField& binary, std::size_t joint);

    bool empty() const { return _vertices.empty(); }

    /// Welded vertices.
    const std::vector<std::uint32_t>& vertices() const { return _vertices; }

    /// Mean of a field over that skin.
    ///
    /// \pre not empty()
    double mean(const std::vector<double>& field) const;

private:
    std::vector<std::uint32_t> _vertices;
};

} // namespace osgSkin

#endif
