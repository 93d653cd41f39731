// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_SHAREDPROGRESS_H
#define OSGSKINBIND_ELASTIC_SHAREDPROGRESS_H

#include "elastic/SolveElastic.h"

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>

namespace osgSkin::elastic {

/// Thrown on the threads that go on working after another one was told to give up.
struct GivenUp {};

/// Counts what several threads do and tells one callback of it.
class SharedProgress {
public:
    SharedProgress(const ElasticProgress& tell, std::size_t whole) : _tell(tell), _whole(whole) {}

    /// One more of the whole is done. \throw what the callback throws, or GivenUp where it threw on
    /// another thread
    void done(const std::string& what);

    /// As done(), but nothing is finished: only asks whether to go on.
    void check() const {
        if (_givenUp) throw GivenUp();
    }

    /// Throws again what the callback threw: GivenUp may come home before it. \pre it did throw
    [[noreturn]] void rethrow() const { std::rethrow_exception(_thrown); }

private:
    const ElasticProgress& _tell;
    const std::size_t _whole;
    std::size_t _done = 0;
    std::mutex _mutex;
    std::exception_ptr _thrown;
    std::atomic<bool> _givenUp{false};
};

} // namespace osgSkin::elastic

#endif
