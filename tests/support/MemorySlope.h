// SPDX-License-Identifier: MIT
#pragma once

#include <fstream>
#include <vector>

#include <malloc.h>
#include <unistd.h>

namespace test {

/// How a process grows: resident memory after each cycle, and a line through it by least squares.
class MemorySlope {
public:
    /// After a cycle. What the allocator merely keeps for later is given back first.
    void sample() {
        ::malloc_trim(0);
        m_kilobytes.push_back(residentKilobytes());
    }

    /// Kilobytes a cycle, over the later three quarters: the first ones fill caches.
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
