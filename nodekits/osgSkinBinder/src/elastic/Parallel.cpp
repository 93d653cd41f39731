// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/Parallel.h"

#include <exception>
#include <future>

namespace osgSkin::elastic {

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
        _news.wait(lock, [&] { return _over || _done > told; });
        if (_done == told) return;
        told = _done;
        const ProgressStep step{_what, static_cast<double>(told) / static_cast<double>(_whole)};
        lock.unlock();
        tell(step);
        lock.lock();
    }
}

void SharedProgress::done(const std::string& what) {
    check();
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        ++_done;
        _what = what;
    }
    _news.notify_one();
}

} // namespace osgSkin::elastic
