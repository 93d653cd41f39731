// SPDX-License-Identifier: MIT
#pragma once

#include <Blending.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace quality {

/// A scanned surface, registered to a template that all scans share.
struct Scan {
    compare::Points points; ///< metres
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint32_t> vertexOf; ///< the vertex at each of the template's points
};

/// One person, scanned at rest and in other poses. The person is 1.75 m tall at rest.
struct CapturedPerson {
    std::string name;
    Scan rest;
    std::vector<Scan> poses;
};

/// Reads a person of FAUST (Bogo et al. 2014) as remeshed to 5,000 vertices by Ren et al. (2018):
/// scans `tr_reg_030.off` to `tr_reg_039.off` for subject 3, the first at rest, and their vertices
/// at the template's points, `corres/tr_reg_030.vts`.
/// \param folder of the scans, or the root of Ren's repository
/// \param subject 0 to 9
/// \throw osgSkin::Error if a file is missing, cannot be read or does not fit the others
CapturedPerson readPerson(const std::string& folder, std::size_t subject);

/// For each vertex at rest the mean of the scan's points that correspond to it; NaN without any.
compare::Points correspondingPoints(const Scan& rest, const Scan& scan);

} // namespace quality
