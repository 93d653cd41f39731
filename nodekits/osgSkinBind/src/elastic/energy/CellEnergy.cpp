// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/energy/CellEnergy.h"

#include <algorithm>
#include <cmath>
#include <limits>

// One body for every x86 processor, the widest registers it has chosen at load time. Sanitizers
// cannot run before they are set up, which is when the choice is made.
#if defined(__x86_64__) && defined(__ELF__) && defined(__GNUC__) && !defined(__clang__) &&         \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define OSGSKIN_WIDEST                                                                             \
    __attribute__((target_clones("arch=skylake-avx512", "arch=haswell", "default")))
#else
#define OSGSKIN_WIDEST
#endif

namespace osgSkin::elastic {
namespace {

constexpr std::size_t kLanes = CellShape::kPoints;

/// Newton steps to the sum of singular values; from above it converges in three or four.
constexpr int kMostSteps = 12;
constexpr double kExact = 1e-10; ///< of the last step but one: the next would be far below rounding

using Lanes = double[kLanes];

} // namespace

OSGSKIN_WIDEST double cellEnergy(const CellShape& shape, const Flesh& flesh, CellState& cell,
                                 double& leastJacobian) {
    // F = sum of corners x slopes.
    Lanes f[3][3];
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            Lanes sum = {};
            for (std::size_t c = 0; c < 8; ++c)
                for (std::size_t g = 0; g < kLanes; ++g)
                    sum[g] += cell.corner[i][c] * shape.slope[k][c][g];
            for (std::size_t g = 0; g < kLanes; ++g) f[i][k][g] = sum[g];
        }

    Lanes cofactor[3][3], jacobian;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3,
                              k2 = (k + 2) % 3;
            for (std::size_t g = 0; g < kLanes; ++g)
                cofactor[i][k][g] = f[i1][k1][g] * f[i2][k2][g] - f[i1][k2][g] * f[i2][k1][g];
        }
    for (std::size_t g = 0; g < kLanes; ++g)
        jacobian[g] = f[0][0][g] * cofactor[0][0][g] + f[0][1][g] * cofactor[0][1][g] +
                      f[0][2][g] * cofactor[0][2][g];
    leastJacobian = *std::min_element(jacobian, jacobian + kLanes);
    if (!(leastJacobian > 0.0)) return std::numeric_limits<double>::infinity();

    // C = F^T F.
    Lanes metric[3][3];
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b)
            for (std::size_t g = 0; g < kLanes; ++g)
                metric[a][b][g] =
                    f[0][a][g] * f[0][b][g] + f[1][a][g] * f[1][b][g] + f[2][a][g] * f[2][b][g];
    Lanes first, second, trace;
    for (std::size_t g = 0; g < kLanes; ++g) {
        const double xx = metric[0][0][g], yy = metric[1][1][g], zz = metric[2][2][g];
        const double xy = metric[0][1][g], yz = metric[1][2][g], zx = metric[2][0][g];
        first[g] = xx + yy + zz;
        second[g] = xx * yy + yy * zz + zz * xx - xy * xy - yz * yz - zx * zx;
        trace[g] = std::sqrt(3.0 * first[g]);
    }
    // The sum of singular values, t = tr S of F = R S, is the largest root of (t^2 - I1)^2 - 8 J t
    // - 4 I2, and R is its derivative by F (Lin, Chitalu & Komura 2022): no decomposition, and no
    // branch that a lane could take alone.
    for (int step = 0; step < kMostSteps; ++step) {
        double most = 0.0;
        for (std::size_t g = 0; g < kLanes; ++g) {
            const double rest = trace[g] * trace[g] - first[g];
            const double value = rest * rest - 8.0 * jacobian[g] * trace[g] - 4.0 * second[g];
            const double change = value / (4.0 * trace[g] * rest - 8.0 * jacobian[g]);
            trace[g] -= change;
            most = std::max(most, std::abs(change) - kExact * trace[g]);
        }
        if (!(most > 0.0)) break;
    }

    double meanJacobian = 0.0;
    for (const double j : jacobian) meanJacobian += j / kLanes;
    const double change = meanJacobian - 1.0;
    double energy = 0.5 * flesh.bulk * kLanes * change * change;
    for (std::size_t g = 0; g < kLanes; ++g) energy += first[g] - 2.0 * trace[g] + 3.0;

    Lanes byJacobian;
    for (double& by : byJacobian) by = flesh.bulk * change;
    if (leastJacobian < flesh.barrierBegins)
        for (std::size_t g = 0; g < kLanes; ++g) {
            const double below = jacobian[g] - flesh.barrierBegins;
            if (below >= 0.0) continue;
            const double ratio = std::log(jacobian[g] / flesh.barrierBegins);
            energy -= flesh.barrier * below * below * ratio;
            byJacobian[g] -= flesh.barrier * (2.0 * below * ratio + below * below / jacobian[g]);
        }

    // dE/dF = 2 (F - R) + dE/dJ cof F, with R = a F + b F C + c cof F.
    Lanes a, b, c;
    for (std::size_t g = 0; g < kLanes; ++g) {
        const double square = trace[g] * trace[g];
        const double slope = 4.0 * trace[g] * (square - first[g]) - 8.0 * jacobian[g];
        a[g] = 2.0 * (1.0 - 4.0 * (square + first[g]) / slope);
        b[g] = 16.0 / slope;
        c[g] = byJacobian[g] - 16.0 * trace[g] / slope;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        Lanes stress[3];
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t g = 0; g < kLanes; ++g)
                stress[k][g] = a[g] * f[i][k][g] + c[g] * cofactor[i][k][g] +
                               b[g] * (f[i][0][g] * metric[0][k][g] + f[i][1][g] * metric[1][k][g] +
                                       f[i][2][g] * metric[2][k][g]);
        for (std::size_t corner = 0; corner < 8; ++corner) {
            double sum = 0.0;
            for (std::size_t g = 0; g < kLanes; ++g)
                sum += stress[0][g] * shape.slope[0][corner][g] +
                       stress[1][g] * shape.slope[1][corner][g] +
                       stress[2][g] * shape.slope[2][corner][g];
            cell.gradient[i][corner] = cell.volume * sum;
        }
    }
    return cell.volume * energy;
}

} // namespace osgSkin::elastic
