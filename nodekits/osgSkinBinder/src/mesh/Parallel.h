// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_MESH_PARALLEL_H
#define OSGSKINBINDER_MESH_PARALLEL_H

#include <osgSkinBind/Progress>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#ifdef OSGSKIN_HAS_TBB
#include <tbb/parallel_for.h>
#endif

namespace osgSkin {

/// Calls work(0) to work(count - 1), on all processors if oneTBB is built in. Exceptions propagate.
/// May be nested.
template <typename Work>
void parallelFor(std::size_t count, const Work& work) {
#ifdef OSGSKIN_HAS_TBB
    tbb::parallel_for(std::size_t(0), count, work);
#else
    for (std::size_t i = 0; i < count; ++i) work(i);
#endif
}

/// Thrown on working threads after the waiting thread's progress callback has thrown.
struct GivenUp {};

/// Counts the steps that several threads finish. Only the thread that waits for them calls the
/// Progress.
class SharedProgress {
public:
    explicit SharedProgress(std::size_t whole) : _whole(whole) {}

    /// Runs `work`, which may use any number of threads, and reports its progress to `tell`.
    /// \throw exceptions of `work`, and those of `tell` once the work has stopped
    void tellWhile(const Progress& tell, const std::function<void()>& work);

    /// Called by working threads when a step is finished.
    /// \throw GivenUp
    void done(const std::string& what);

    /// Called by working threads from time to time.
    /// \throw GivenUp
    void check() const {
        if (_givenUp) throw GivenUp();
    }

private:
    void tellUntilOver(const Progress& tell);

    const std::size_t _whole;
    std::vector<std::string> _done; ///< the finished steps
    bool _over = false;
    std::mutex _mutex;
    std::condition_variable _news;
    std::atomic<bool> _givenUp{false};
};

} // namespace osgSkin

#endif
