// SPDX-License-Identifier: MIT
#include <osgSkin/DeformPool>

#include "Tube.h"
#include "Turns.h"

#include <osg/ref_ptr>

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

using osgSkin::DeformJob;
using osgSkin::DeformPool;

namespace {

/// Some skins, each in a pose of its own.
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

/// Most threads that were in forEach() at the same time.
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

TEST(DeformPool, HasTheThreadsAskedForAndNeverMore) {
    for (const unsigned int threads : {1u, 2u, 3u}) {
        const osg::ref_ptr<DeformPool> pool = new DeformPool(threads);
        EXPECT_EQ(pool->getThreadCount(), DeformPool::hasThreads() ? threads : 1u);
        EXPECT_LE(mostAtOnce(*pool), threads);
    }
    EXPECT_GE(osg::ref_ptr<DeformPool>(new DeformPool)->getThreadCount(), 1u);
}

TEST(DeformPool, OfAnyNumberOfThreadsTakesRoomForAThousand) {
    const osg::ref_ptr<osgSkin::DeformPool> pool = new osgSkin::DeformPool(4000000000u);
    EXPECT_LE(pool->getThreadCount(), 1024u);
    std::atomic<std::size_t> calls{0};
    pool->forEach(100, [&](std::size_t) { ++calls; });
    EXPECT_EQ(calls, 100u);
}

/// As where one deforms a skin, whose lock it holds, that the pool's threads come to deform.
TEST(DeformPool, ThreadsThatCallAtOnceDoNotWaitForEachOther) {
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

TEST(DeformPool, CallsEachOnce) {
    const osg::ref_ptr<DeformPool> pool = new DeformPool(2);
    for (const std::size_t count : {0u, 1u, 2u, 1000u}) {
        std::vector<std::atomic<int>> calls(count);
        pool->forEach(count, [&](std::size_t i) { ++calls[i]; });
        for (const std::atomic<int>& c : calls) EXPECT_EQ(c, 1);
    }
}

TEST(DeformPool, DeformsAsOneThreadDoes) {
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

TEST(DeformPool, RunsWhatCanBeRun) {
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
