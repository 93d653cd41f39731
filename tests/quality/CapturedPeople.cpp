// SPDX-License-Identifier: MIT
#include "CapturedPeople.h"

#include <osgSkin/Error>
#include <osgSkinImport/ImportMesh>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>

namespace quality {
namespace {

namespace fs = std::filesystem;

constexpr double kHeight = 1.75;
constexpr std::size_t kScans = 10; ///< of a subject

fs::path scansIn(const std::string& folder) {
    const fs::path inRepository = fs::path(folder) / "Dataset" / "FAUST" / "vtx_5k";
    return fs::is_directory(inRepository) ? inRepository : fs::path(folder);
}

std::vector<std::uint32_t> readCorrespondence(const std::string& path, std::size_t vertices) {
    std::ifstream in(path);
    if (!in) throw osgSkin::Error(path + ": missing, expected a vertex for each template point");
    std::vector<std::uint32_t> vertexOf;
    for (double number = 0.0; in >> number;) {
        if (!(number >= 1.0 && number <= double(vertices)))
            throw osgSkin::Error(path + ": line " + std::to_string(vertexOf.size() + 1) +
                                 ": expected a vertex from 1 to " + std::to_string(vertices));
        vertexOf.push_back(static_cast<std::uint32_t>(number) - 1);
    }
    if (!in.eof() || vertexOf.empty())
        throw osgSkin::Error(path + ": line " + std::to_string(vertexOf.size() + 1) +
                             ": expected a number");
    return vertexOf;
}

Scan readScan(const fs::path& folder, std::size_t number) {
    const std::string digits = std::to_string(number);
    const std::string name = "tr_reg_" + std::string(3 - digits.size(), '0') + digits;
    const fs::path mesh = folder / (name + ".off");
    if (!fs::exists(mesh))
        throw osgSkin::Error(mesh.string() +
                             ": missing, expected FAUST's scans with 5,000 vertices, "
                             "tr_reg_000.off to tr_reg_099.off");
    const osgSkin::SkinMesh read = osgSkin::importMesh(mesh.string()).mesh;
    const fs::path correspondence = folder / "corres" / (name + ".vts");
    return {read.positions, read.triangles(),
            readCorrespondence(correspondence.string(), read.positions.size())};
}

double heightOf(const compare::Points& points) {
    const auto [low, high] = std::minmax_element(
        points.begin(), points.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
    return high->y - low->y;
}

} // namespace

CapturedPerson readPerson(const std::string& folder, std::size_t subject) {
    const fs::path scans = scansIn(folder);
    CapturedPerson person;
    person.name = "subject " + std::to_string(subject);
    person.rest = readScan(scans, kScans * subject);
    const double scale = kHeight / heightOf(person.rest.points);
    for (std::size_t k = 1; k < kScans; ++k) {
        person.poses.push_back(readScan(scans, kScans * subject + k));
        if (person.poses.back().vertexOf.size() != person.rest.vertexOf.size())
            throw osgSkin::Error(scans.string() + ": scan " + std::to_string(kScans * subject + k) +
                                 ": expected as many template points as the subject's first scan");
        for (glm::dvec3& point : person.poses.back().points) point *= scale;
    }
    for (glm::dvec3& point : person.rest.points) point *= scale;
    return person;
}

compare::Points correspondingPoints(const Scan& rest, const Scan& scan) {
    compare::Points points(rest.points.size(), glm::dvec3(0.0));
    std::vector<double> counts(points.size(), 0.0);
    for (std::size_t p = 0; p < rest.vertexOf.size(); ++p) {
        points[rest.vertexOf[p]] += scan.points[scan.vertexOf[p]];
        counts[rest.vertexOf[p]] += 1.0;
    }
    for (std::size_t v = 0; v < points.size(); ++v)
        points[v] = counts[v] > 0.0 ? points[v] / counts[v]
                                    : glm::dvec3(std::numeric_limits<double>::quiet_NaN());
    return points;
}

} // namespace quality
