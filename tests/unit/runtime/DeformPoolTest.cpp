// SPDX-License-Identifier: MIT
#include "Tube.h"
#include "Turns.h"

#include <osgSkin/DeformPool>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>
#include <vector>

#ifdef __linux__
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>
#endif

using osgSkin::DeformJob;
using osgSkin::DeformPool;

namespace {

/// Some skins, each in its own pose.
struct Crowd {
    Crowd(std::size_t count, int rings) : model(test::Tube(rings).model()) {
        std::mt19937_64 random(1);
        skins.resize(count);
        for (Skin& skin : skins) {
            skin.pose = osgSkin::Pose(model->joints());
            const auto skinning = test::skinningFrom(
                model->joints(), {test::randomRotation(random), test::randomRotation(random),
                                  test::randomRotation(random)});
            skin.pose.set(skinning.data(), skinning.size());
            skin.positions.resize(model->vertexCount());
            skin.normals.resize(model->vertexCount());
            DeformJob job;
            job.model = model.get();
            job.pose = &skin.pose;
            job.positions = skin.positions.data();
            job.normals = skin.normals.data();
            job.positionCount = job.normalCount = model->vertexCount();
            jobs.push_back(job);
        }
    }
    std::vector<std::vector<glm::vec3>> results() const {
        std::vector<std::vector<glm::vec3>> all;
        for (const Skin& skin : skins) {
            all.push_back(skin.positions);
            all.push_back(skin.normals);
        }
        return all;
    }
    void clear() {
        for (Skin& skin : skins) {
            std::fill(skin.positions.begin(), skin.positions.end(), glm::vec3(0.0f));
            std::fill(skin.normals.begin(), skin.normals.end(), glm::vec3(0.0f));
        }
    }

    struct Skin {
        osgSkin::Pose pose;
        std::vector<glm::vec3> positions, normals;
    };
    osg::ref_ptr<const osgSkin::SkinModel> model;
    std::vector<Skin> skins;
    std::vector<DeformJob> jobs;
};

/// Largest number of threads in forEach() at the same time.
unsigned int mostAtOnce(const DeformPool& pool) {
    std::atomic<unsigned int> now{0}, most{0};
    pool.forEach(60, [&](std::size_t) {
        const unsigned int here = ++now;
        unsigned int known = most;
        while (here > known && !most.compare_exchange_weak(known, here)) {
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        --now;
    });
    return most;
}

} // namespace

TEST(DeformPool, NeverExceedsItsThreadCount) {
    for (const unsigned int threads : {1u, 2u, 3u}) {
        const osg::ref_ptr<DeformPool> pool = new DeformPool(threads);
        EXPECT_EQ(pool->getThreadCount(), DeformPool::hasThreads() ? threads : 1u);
        EXPECT_LE(mostAtOnce(*pool), threads);
    }
    EXPECT_GE(osg::ref_ptr<DeformPool>(new DeformPool)->getThreadCount(), 1u);
}

TEST(DeformPool, LimitsTheThreadCount) {
    const osg::ref_ptr<osgSkin::DeformPool> pool = new osgSkin::DeformPool(4000000000u);
    EXPECT_LE(pool->getThreadCount(), 1024u);
    std::atomic<std::size_t> calls{0};
    pool->forEach(100, [&](std::size_t) { ++calls; });
    EXPECT_EQ(calls, 100u);
}

#ifdef __linux__
/// A process whose main thread was pinned to one processor before oneTBB's first use, as by
/// osgViewer's realize(), ends with the number of threads of a pool made now.
[[noreturn]] void endWithThreadsOfAPinnedThread() {
    cpu_set_t first;
    CPU_ZERO(&first);
    sched_getaffinity(0, sizeof first, &first);
    std::size_t processor = 0;
    while (!CPU_ISSET(processor, &first)) ++processor;
    CPU_ZERO(&first);
    CPU_SET(processor, &first);
    sched_setaffinity(0, sizeof first, &first);
    const osg::ref_ptr<DeformPool> pool = new DeformPool(2);
    const unsigned int most = mostAtOnce(*pool);
    cpu_set_t after;
    sched_getaffinity(0, sizeof after, &after);
    std::_Exit(CPU_EQUAL(&first, &after) ? static_cast<int>(most) : 100);
}

TEST(DeformPool, UsesAllThreadsIfTheMainThreadIsPinned) {
    if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "needs two processors";
    if (!DeformPool::hasThreads()) GTEST_SKIP() << "built without threads";
    GTEST_FLAG_SET(death_test_style, "threadsafe"); // in a process of its own
    EXPECT_EXIT(endWithThreadsOfAPinnedThread(), testing::ExitedWithCode(2), "");
}

/// A process that may make no thread ends with 0 where a pool of eight calls all.
[[noreturn]] void endWithoutThreads() {
    if (getuid() == 0 && setuid(65534) != 0) std::_Exit(101); // root has no limit
    const rlimit none = {0, 0};
    setrlimit(RLIMIT_NPROC, &none);
    const osg::ref_ptr<DeformPool> pool = new DeformPool(8);
    std::size_t calls = 0; // from one thread
    pool->forEach(100, [&](std::size_t) { ++calls; });
    std::_Exit(calls == 100 && pool->getThreadCount() == 1 ? 0 : 102);
}

TEST(DeformPool, RunsAloneIfNoThreadCanBeCreated) {
    if (!DeformPool::hasThreads()) GTEST_SKIP() << "built without threads";
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(endWithoutThreads(), testing::ExitedWithCode(0), "makes no thread");
}
#endif

/// For example, a thread deforms a skin and holds its lock while the pool's threads are about to
/// deform it.
TEST(DeformPool, ConcurrentCallersDoNotBlockEachOther) {
    using Clock = std::chrono::steady_clock;
    const osg::ref_ptr<DeformPool> pool = new DeformPool(2);
    std::timed_mutex lock;
    std::atomic<bool> held{false};
    std::atomic<int> waiting{0}, let{0};
    std::thread other([&] {
        const std::lock_guard<std::timed_mutex> hold(lock);
        held = true;
        const auto end = Clock::now() + std::chrono::seconds(1);
        while (waiting < 2 && Clock::now() < end) std::this_thread::yield();
        pool->forEach(2, [](std::size_t) {});
    });
    while (!held) std::this_thread::yield();
    pool->forEach(2, [&](std::size_t) {
        ++waiting;
        if (!lock.try_lock_for(std::chrono::seconds(10))) return;
        ++let;
        lock.unlock();
    });
    other.join();
    EXPECT_EQ(let, 2);
}

TEST(DeformPool, CallsEachIndexOnce) {
    const osg::ref_ptr<DeformPool> pool = new DeformPool(2);
    for (const std::size_t count : {0u, 1u, 2u, 1000u}) {
        std::vector<std::atomic<int>> calls(count);
        pool->forEach(count, [&](std::size_t i) { ++calls[i]; });
        for (const std::atomic<int>& c : calls) EXPECT_EQ(c, 1);
    }
}

TEST(DeformPool, MatchesSingleThreadedResults) {
    for (const auto& [count, rings] : {std::pair<std::size_t, int>{1, 1500}, {40, 25}, {3, 900}}) {
        Crowd crowd(count, rings);
        for (const DeformJob& job : crowd.jobs) ASSERT_TRUE(job.run());
        const auto expected = crowd.results();
        for (const unsigned int threads : {1u, 2u, 3u})
            for (const std::size_t minimum : {std::size_t{0}, std::size_t{1000000}}) {
                const osg::ref_ptr<DeformPool> pool = new DeformPool(threads);
                pool->setMinimumVertices(minimum);
                crowd.clear();
                EXPECT_TRUE(pool->run(crowd.jobs.data(), crowd.jobs.size()));
                EXPECT_EQ(crowd.results(), expected) << count << " skins, " << threads;
            }
    }
}

TEST(DeformPool, RunsValidJobsBesideInvalidOnes) {
    Crowd crowd(3, 25);
    for (const DeformJob& job : crowd.jobs) ASSERT_TRUE(job.run());
    auto expected = crowd.results();
    std::fill(expected[2].begin(), expected[2].end(), glm::vec3(0.0f));
    std::fill(expected[3].begin(), expected[3].end(), glm::vec3(0.0f));
    crowd.jobs[1].pose = nullptr;
    const osg::ref_ptr<DeformPool> pool = new DeformPool(2);
    for (const std::size_t minimum : {0u, 1000000u}) {
        pool->setMinimumVertices(minimum);
        crowd.clear();
        EXPECT_FALSE(pool->run(crowd.jobs.data(), crowd.jobs.size()));
        EXPECT_EQ(crowd.results(), expected);
    }
}
