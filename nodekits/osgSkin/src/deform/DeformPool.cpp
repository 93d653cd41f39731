// SPDX-License-Identifier: MIT
#include <osgSkin/DeformPool>

#include <OpenThreads/Thread>
#include <osg/Notify>

#include <algorithm>
#include <atomic>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

#ifdef OSGSKIN_HAS_TBB
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

#ifdef __linux__
#include <sched.h>
#endif

namespace osgSkin {

#ifdef OSGSKIN_HAS_TBB

/// An arena allocates for all of its threads.
constexpr unsigned int kMaxThreads = 1024;

namespace {

#ifdef __linux__
cpu_set_t processorsOfThisThread() {
    cpu_set_t result;
    CPU_ZERO(&result);
    sched_getaffinity(0, sizeof result, &result);
    return result;
}

/// When this library was loaded.
const cpu_set_t kProcessors = processorsOfThisThread();

/// Lets the calling thread run, while this exists, where the process could run when it began.
/// osgViewer's realize() pins the main thread to one processor; oneTBB takes the number of threads
/// and where they run from the thread that uses it first.
class Unpinned {
public:
    Unpinned() { sched_setaffinity(0, sizeof kProcessors, &kProcessors); }
    ~Unpinned() { sched_setaffinity(0, sizeof _before, &_before); }
    Unpinned(const Unpinned&) = delete;
    Unpinned& operator=(const Unpinned&) = delete;

private:
    const cpu_set_t _before = processorsOfThisThread();
};
#else
struct Unpinned {};
#endif

/// Whether the process may make a thread; oneTBB ends it otherwise.
bool canMakeThreads() {
    try {
        std::thread([] {}).join();
        return true;
    } catch (const std::system_error&) {
        return false;
    }
}

/// The threads that oneTBB would use.
unsigned int defaultThreads() {
    [[maybe_unused]] const Unpinned unpinned;
    return static_cast<unsigned int>(std::max(1, tbb::info::default_concurrency()));
}

} // namespace

/// Limits the number of threads, including the caller's.
struct DeformPool::Arena {
    explicit Arena(unsigned int count) : threads(count), arena(static_cast<int>(count)) {
        if (count < 2) return;
        // Only to have more: the least of a process's limits counts.
        if (count > defaultThreads())
            more.emplace(tbb::global_control::max_allowed_parallelism, count);
        arena.initialize();
    }

    /// Calls function(0) to function(count - 1) and waits for them.
    template <typename Function>
    void share(std::size_t count, const Function& function) {
#ifdef OSGSKIN_SANITIZE_THREADS
        // The sanitizer sees only what orders threads here, as oneTBB is not built with it.
        // Relaxed: taking a number must not order tasks that nothing else orders.
        std::atomic<std::size_t> next{0};
        const auto work = [&] {
            for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;)
                function(i);
        };
        [[maybe_unused]] const Unpinned unpinned;
        std::vector<std::thread> others(std::min<std::size_t>(threads, count) - 1);
        for (std::thread& other : others) other = std::thread(work);
        work();
        for (std::thread& other : others) other.join();
#else
        // Isolated: a thread waiting for the rest of a skin must not start another one, whose lock
        // may be held by a waiting thread.
        arena.execute([&] {
            tbb::this_task_arena::isolate(
                [&] { tbb::parallel_for(std::size_t{0}, count, function); });
        });
#endif
    }

    unsigned int threads;
    std::optional<tbb::global_control> more;
    tbb::task_arena arena;
    std::atomic<bool> taken{false}; ///< by a thread outside the pool
};

namespace {

/// Marks, while it exists, the pool that this thread works for.
class AtWork {
public:
    explicit AtWork(const void* arena) : _before(current()) { current() = arena; }
    ~AtWork() { current() = _before; }
    AtWork(const AtWork&) = delete;
    AtWork& operator=(const AtWork&) = delete;

    static const void*& current() {
        static thread_local const void* arena = nullptr;
        return arena;
    }

private:
    const void* _before;
};

} // namespace

bool DeformPool::hasThreads() noexcept {
    return true;
}

void DeformPool::setThreadCount(unsigned int threads) {
    const int processors = OpenThreads::GetNumberOfProcessors();
    if (threads == 0) threads = static_cast<unsigned int>(std::max(1, processors));
    threads = std::min(threads, kMaxThreads);
    if (threads > 1 && !canMakeThreads()) {
        OSG_WARN << "osgSkin: DeformPool: the system makes no thread; the calling one works alone"
                 << std::endl;
        threads = 1;
    }
    if (!_arena || _arena->threads != threads) _arena = std::make_unique<Arena>(threads);
}

void DeformPool::callEach(std::size_t count, Call call, const void* function) const noexcept {
    Arena* const own = _arena.get();
    const bool within = AtWork::current() == own;
    // A caller never waits for threads: it may hold a skin's lock that they wait for.
    if (own->threads == 1 || count < 2 || (!within && own->taken.exchange(true))) {
        for (std::size_t i = 0; i < count; ++i) call(function, i);
        return;
    }
    own->share(count, [&](std::size_t i) {
        const AtWork here(own);
        call(function, i);
    });
    if (!within) own->taken = false;
}

#else

struct DeformPool::Arena {
    unsigned int threads = 1;
};

bool DeformPool::hasThreads() noexcept {
    return false;
}

void DeformPool::setThreadCount(unsigned int) {
    if (!_arena) _arena = std::make_unique<Arena>();
}

void DeformPool::callEach(std::size_t count, Call call, const void* function) const noexcept {
    for (std::size_t i = 0; i < count; ++i) call(function, i);
}

#endif

DeformPool::DeformPool(unsigned int threads) {
    setThreadCount(threads);
}

DeformPool::~DeformPool() = default;

unsigned int DeformPool::getThreadCount() const noexcept {
    return _arena->threads;
}

bool DeformPool::run(const DeformJob* jobs, std::size_t count) const noexcept {
    bool good = true;
    std::size_t vertices = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const bool valid = jobs[i].isValid();
        good = good && valid;
        if (valid) vertices += jobs[i].positionCount;
    }
    if (getThreadCount() == 1 || vertices < _minimumVertices) {
        for (std::size_t i = 0; i < count; ++i) jobs[i].run();
        return good;
    }
    forEach(count, [&](std::size_t i) {
        const DeformJob& job = jobs[i];
        if (job.positionCount < _minimumVertices)
            job.run();
        else
            forEach(job.partCount(), [&job](std::size_t part) { job.runPart(part); });
    });
    return good;
}

} // namespace osgSkin
