// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/RequireSurface.h"

#include <osgSkin/Error>

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace osgSkin {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// Triangles for each vertex (a closed surface has two), and a number of triangles that is always
/// accepted.
constexpr std::size_t kMaxTriangles = 12, kFewTriangles = 2000;

/// The work of factorising a surface of n vertices grows as n^1.5 log2 n multiplications. kMaxWork
/// limits the factor: bodies need 0.4 to 0.9, spheres and balls of 100 to 160,000 vertices 1.5 to
/// 2.8, random triangles hundreds. kLittleWork, the work for 200 vertices that are all joined, is
/// always accepted.
constexpr double kMaxWork = 6.0, kLittleWork = 2e6;

/// Computes how much work it would be to factorise a matrix, without doing so.
class Factors : public Eigen::SimplicialLDLT<Matrix> {
public:
    explicit Factors(const Matrix& matrix) { analyzePattern(matrix); }
    double work() const {
        const Eigen::Map<const Eigen::VectorXi> first(m_matrix.outerIndexPtr(), cols() + 1);
        return (first.tail(cols()) - first.head(cols())).cast<double>().squaredNorm();
    }
};

double solvingWork(const WeldedMesh& mesh) {
    const auto count = static_cast<Eigen::Index>(mesh.vertexCount());
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(mesh.vertexCount() + mesh.neighbours.size());
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
        entries.emplace_back(static_cast<int>(v), static_cast<int>(v), 1.0);
        for (std::uint32_t i = mesh.firstNeighbour[v]; i < mesh.firstNeighbour[v + 1]; ++i)
            entries.emplace_back(static_cast<int>(v), static_cast<int>(mesh.neighbours[i]), 1.0);
    }
    Matrix joined(count, count);
    joined.setFromTriplets(entries.begin(), entries.end());
    return Factors(joined).work();
}

double expectedWork(const WeldedMesh& mesh) {
    std::vector<double> sizes(mesh.shells, 0.0);
    for (const std::uint32_t shell : mesh.shellOf)
        if (shell != WeldedMesh::kNoShell) sizes[shell] += 1.0;
    double work = 0.0;
    for (const double size : sizes) work += size * std::sqrt(size) * std::log2(size);
    return work;
}

} // namespace

void requireSurface(const WeldedMesh& mesh) {
    const std::size_t vertices = mesh.vertexCount(), triangles = mesh.triangles.size();
    const std::string found = "mesh: " + std::to_string(triangles) + " triangles of " +
                              std::to_string(vertices) + " vertices";
    if (triangles > std::max(kFewTriangles, kMaxTriangles * vertices))
        throw Error(found + ", expected at most " + std::to_string(kMaxTriangles) +
                    " for each vertex");
    if (solvingWork(mesh) > kLittleWork + kMaxWork * expectedWork(mesh))
        throw Error(found + " join vertices all over the mesh, expected a surface, whose triangles "
                            "join neighbouring vertices");
}

} // namespace osgSkin
