// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_SHAREDPROGRESS_H
#define OSGSKINBIND_ELASTIC_SHAREDPROGRESS_H

#include <osgSkinBind/Progress>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>

namespace osgSkin::elastic {

/// Thrown on the threads that work after the one that waits for them was told to give up.
struct GivenUp {};

/// Counts what several threads do, and lets the thread that waits for them tell of it: a Progress
/// is called from no other.
class SharedProgress {
public:
    explicit SharedProgress(std::size_t whole) : _whole(whole) {}

    /// Runs `work`, which may use any number of threads, and tells how far it has come.
    /// \throw what `tell` throws, once the work has given up, and what `work` throws
    void tellWhile(const Progress& tell, const std::function<void()>& work);

    /// By those who work: one more of the whole is done.
    /// \throw GivenUp
    void done(const std::string& what);

    /// By those who work, now and then.
    /// \throw GivenUp
    void check() const {
        if (_givenUp) throw GivenUp();
    }

private:
    void tellUntilOver(const Progress& tell);

    const std::size_t _whole;
    std::size_t _done = 0;
    std::string _what; ///< that was done last
    bool _over = false;
    std::mutex _mutex;
    std::condition_variable _news;
    std::atomic<bool> _givenUp{false};
};

} // namespace osgSkin::elastic

#endif
