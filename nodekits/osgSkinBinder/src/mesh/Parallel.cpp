// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/Parallel.h"

#include <exception>
#include <future>

namespace osgSkin {

void SharedProgress::tellWhile(const Progress& tell, const std::function<void()>& work) {
    if (!tell) return work();
    std::future<void> working = std::async(std::launch::async, [&] {
        std::exception_ptr thrown;
        try {
            work();
        } catch (...) {
            thrown = std::current_exception();
        }
        {
            const std::lock_guard<std::mutex> lock(_mutex);
            _over = true;
        }
        _news.notify_one();
        if (thrown) std::rethrow_exception(thrown);
    });
    try {
        tellUntilOver(tell);
    } catch (...) {
        _givenUp = true;
        working.wait();
        throw;
    }
    working.get();
}

void SharedProgress::tellUntilOver(const Progress& tell) {
    std::size_t told = 0;
    std::unique_lock<std::mutex> lock(_mutex);
    while (true) {
        _news.wait(lock, [&] { return _over || _done.size() > told; });
        if (_done.size() == told) return;
        const ProgressStep step{_done[told], double(told + 1) / double(_whole)};
        ++told;
        lock.unlock();
        tell(step);
        lock.lock();
    }
}

void SharedProgress::done(const std::string& what) {
    check();
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _done.push_back(what);
    }
    _news.notify_one();
}

} // namespace osgSkin
