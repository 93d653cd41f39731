// SPDX-License-Identifier: MIT
#pragma once

#include <fstream>
#include <vector>

#include <malloc.h>
#include <unistd.h>

namespace test {

/// A process's growth: resident memory after each cycle, and its slope by least squares.
class MemorySlope {
public:
    /// Call after a cycle. First returns the memory that the allocator merely caches.
    void sample() {
        ::malloc_trim(0);
        m_kilobytes.push_back(residentKilobytes());
    }

    /// Kilobytes per cycle, over the last three quarters: the first cycles fill caches.
    double slope() const {
        const std::size_t from = m_kilobytes.size() / 4;
        const auto count = static_cast<double>(m_kilobytes.size() - from);
        double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
        for (std::size_t i = from; i < m_kilobytes.size(); ++i) {
            const auto place = static_cast<double>(i - from);
            x += place;
            y += m_kilobytes[i];
            xx += place * place;
            xy += place * m_kilobytes[i];
        }
        const double spread = count * xx - x * x;
        return spread > 0.0 ? (count * xy - x * y) / spread : 0.0;
    }

    double last() const { return m_kilobytes.empty() ? 0.0 : m_kilobytes.back(); }

private:
    std::vector<double> m_kilobytes;

    static double residentKilobytes() {
        double all = 0.0, resident = 0.0;
        std::ifstream("/proc/self/statm") >> all >> resident;
        return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1024.0;
    }
};

} // namespace test
