// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_SAMPLETREE_H
#define OSGSKINBIND_ELASTIC_SAMPLETREE_H

#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace osgSkin::elastic {

/// In which order a joint's samples are solved: each one from the nearest that turns less, so that
/// a bend grows in small steps and no way is gone twice.
struct SampleTree {
    static constexpr std::size_t kRest = static_cast<std::size_t>(-1);

    /// \param rotations unit
    explicit SampleTree(const std::vector<Eigen::Quaterniond>& rotations);

    /// Those that start from a sample, or from the rest pose (kRest).
    const std::vector<std::size_t>& startingFrom(std::size_t sample) const;

private:
    std::vector<std::vector<std::size_t>> _following; ///< the rest pose comes last
};

} // namespace osgSkin::elastic

#endif
