// SPDX-License-Identifier: MIT
#include "Tube.h"
#include "Turns.h"

#include <osgSkin/DeformJob>
#include <osgSkin/DeformPool>
#include <osgSkin/Error>

#include <gtest/gtest.h>
#include <osg/ref_ptr>

#include <atomic>
#include <cfenv>
#include <chrono>
#include <functional>
#include <limits>
#include <mutex>
#include <thread>

#ifdef __linux__
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>
#endif

using osgSkin::DeformJob;
using osgSkin::Pose;

namespace {

/// The deformation in double precision, vertex by vertex and joint by joint, by DESIGN's formula:
/// no groups, no folding.
glm::dvec3 reference(const osgSkin::Binding& binding, std::uint32_t vertex, glm::dvec3 x,
                     const std::vector<glm::dmat4>& skinning) {
    for (std::uint32_t i = binding.firstInfluence[vertex + 1];
         i-- > binding.firstInfluence[vertex];) {
        const osgSkin::Influence& influence = binding.influences[i];
        const osgSkin::BoundJoint& joint = binding.joints[influence.joint];
        if (joint.parent < 0) return glm::dvec3(skinning[0] * glm::dvec4(x, 1.0));
        const glm::dmat4 local = glm::inverse(skinning[static_cast<std::size_t>(joint.parent)]) *
                                 skinning[influence.joint];
        const osgSkin::BendTwist split =
            osgSkin::splitBendTwist(glm::quat_cast(glm::dmat3(local)), joint.twistAxis);
        x = joint.centre + osgSkin::partialRotation(split, joint.twistAxis, double(influence.bend),
                                                    double(influence.twist)) *
                               (x - joint.centre);
    }
    return x;
}

struct Deformed {
    explicit Deformed(const test::Tube& tube)
        : model(tube.model()), pose(model->joints()), positions(tube.positions.size()),
          normals(tube.positions.size()) {
        job.model = model.get();
        job.pose = &pose;
        job.positions = positions.data();
        job.positionCount = positions.size();
        job.normals = normals.data();
        job.normalCount = normals.size();
    }
    Deformed(const Deformed&) = delete;

    osg::ref_ptr<const osgSkin::SkinModel> model;
    Pose pose;
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec4> tangents;
    osg::ref_ptr<const osgSkin::SkinTangents> restTangents;
    DeformJob job;

    /// Adds tangents along the tube, of both handednesses.
    void addTangents() {
        for (std::size_t v = 0; v < positions.size(); ++v)
            tangents.emplace_back(0, 1, 0, v % 2 == 0 ? 1 : -1);
        restTangents = osgSkin::SkinTangents::create(model, tangents);
        job.restTangents = restTangents.get();
        job.tangents = tangents.data();
        job.tangentCount = tangents.size();
    }
};

/// The message of the error that validate() throws; empty if none.
std::string reasonAgainst(const DeformJob& job) {
    try {
        job.validate();
        return "";
    } catch (const osgSkin::Error& error) {
        return error.what();
    }
}

} // namespace

TEST(DeformJob, DefaultIsInvalid) {
    const DeformJob job;
    EXPECT_EQ(reasonAgainst(job), "deform job: no model");
    EXPECT_FALSE(job.isValid());
    EXPECT_FALSE(job.run());
    EXPECT_FALSE(job.runPart(0));
}

TEST(DeformJob, ModelWithoutVerticesGivesNone) {
    const osg::ref_ptr<const osgSkin::SkinModel> model = new osgSkin::SkinModel;
    const Pose pose(model->joints());
    glm::vec3 nothing(7.0f);
    DeformJob job;
    job.model = model;
    job.pose = &pose;
    job.positions = &nothing;
    EXPECT_TRUE(job.isValid());
    EXPECT_TRUE(job.run());
    EXPECT_EQ(job.partCount(), 0u);
    EXPECT_EQ(nothing, glm::vec3(7.0f));
}

TEST(DeformJob, SaysWhatIsMissing) {
    const test::Tube tube;
    Deformed good(tube);
    good.addTangents();
    Deformed other(tube);
    other.addTangents();
    ASSERT_EQ(reasonAgainst(good.job), "");
    ASSERT_TRUE(good.job.isValid());
    const Pose foreign;
    struct Case {
        const char* name;
        std::function<void(DeformJob&)> spoil;
    };
    const Case cases[] = {
        {"no pose", [](DeformJob& job) { job.pose = nullptr; }},
        {"foreign pose", [&](DeformJob& job) { job.pose = &foreign; }},
        {"no positions", [](DeformJob& job) { job.positions = nullptr; }},
        {"too few positions", [](DeformJob& job) { --job.positionCount; }},
        {"too few normals", [](DeformJob& job) { --job.normalCount; }},
        {"tangents alone", [](DeformJob& job) { job.normals = nullptr; }},
        {"no rest tangents", [](DeformJob& job) { job.restTangents = nullptr; }},
        {"rest tangents of another model",
         [&](DeformJob& job) { job.restTangents = other.restTangents.get(); }},
        {"too few tangents", [](DeformJob& job) { --job.tangentCount; }},
    };
    for (const Case& c : cases) {
        DeformJob job = good.job;
        c.spoil(job);
        EXPECT_NE(reasonAgainst(job), "") << c.name;
        EXPECT_FALSE(job.isValid()) << c.name;
        EXPECT_FALSE(job.run()) << c.name;
        EXPECT_FALSE(job.runReference()) << c.name;
    }
}

TEST(DeformJob, TangentsTurnAndKeepTheirHandedness) {
    const test::Tube tube;
    Deformed deformed(tube);
    deformed.addTangents();
    const auto turn = glm::angleAxis(1.0, glm::dvec3(0, 0, 1));
    const auto skinning = test::skinningFrom(
        tube.binding.joints, {turn, glm::dquat(1, 0, 0, 0), glm::dquat(1, 0, 0, 0)});
    ASSERT_TRUE(deformed.pose.set(skinning.data(), skinning.size()));
    ASSERT_TRUE(deformed.job.run());
    const glm::dvec3 expected = turn * glm::dvec3(0, 1, 0);
    for (std::size_t v = 0; v < deformed.tangents.size(); ++v) {
        EXPECT_LE(glm::distance(glm::dvec3(deformed.tangents[v]), expected), 1e-6);
        EXPECT_EQ(deformed.tangents[v].w, v % 2 == 0 ? 1.0f : -1.0f);
    }
}

TEST(DeformJob, RestPoseIsTheRestSkin) {
    const test::Tube tube;
    Deformed deformed(tube);
    ASSERT_TRUE(deformed.job.run());
    EXPECT_EQ(deformed.positions, tube.positions);
    EXPECT_EQ(deformed.normals, tube.normals);
}

TEST(DeformJob, AgreesWithTheReferenceInDoublePrecision) {
    const test::Tube tube;
    Deformed deformed(tube);
    std::mt19937_64 random(5);
    for (int i = 0; i < 200; ++i) {
        const std::vector<glm::dquat> turns = {test::randomRotation(random),
                                               test::randomRotation(random),
                                               test::randomRotation(random)};
        const auto skinning =
            test::skinningFrom(deformed.model->joints(), turns, test::randomUnit(random));
        ASSERT_TRUE(deformed.pose.set(skinning.data(), skinning.size()));
        ASSERT_TRUE(deformed.job.run());
        for (std::uint32_t v = 0; v < tube.positions.size(); ++v) {
            const glm::dvec3 at = glm::dvec3(tube.positions[v]);
            const glm::dvec3 expected = reference(tube.binding, v, at, skinning);
            ASSERT_LE(glm::distance(glm::dvec3(deformed.positions[v]), expected), 6.0 * 1e-6);
            const glm::dvec3 tip =
                reference(tube.binding, v, at + glm::dvec3(tube.normals[v]), skinning);
            ASSERT_LE(glm::distance(glm::dvec3(deformed.normals[v]), tip - expected), 1e-5);
        }
    }
}

// Motions are full of joints that move only by rounding errors: the powers of such angles are
// denormal numbers, which are many times slower on CPUs.
TEST(DeformJob, TinyAnglesMakeNoDenormalNumbers) {
    const test::Tube tube;
    Deformed f(tube);
    const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, 3));
    for (const double angle : {1e-10, 1e-13, 1e-16, 1e-17, 1e-19}) {
        const auto skinning = test::skinningFrom(
            f.model->joints(), {glm::angleAxis(angle, axis), glm::angleAxis(2.0 * angle, axis),
                                glm::angleAxis(-angle, axis)});
        ASSERT_TRUE(f.pose.set(skinning.data(), skinning.size()));
        std::feclearexcept(FE_UNDERFLOW);
        ASSERT_TRUE(f.job.run());
        EXPECT_FALSE(std::fetestexcept(FE_UNDERFLOW)) << angle;
    }
}

TEST(DeformJob, NormalsAreOptional) {
    const test::Tube tube;
    Deformed deformed(tube);
    deformed.job.normals = nullptr;
    deformed.job.normalCount = 0;
    EXPECT_TRUE(deformed.job.run());
    EXPECT_EQ(deformed.positions, tube.positions);
}

TEST(Pose, RefusesWhatCannotBeUsedAndKeepsThePose) {
    const test::Tube tube(3, 3);
    Pose pose(tube.binding.joints);
    std::vector<glm::dmat4> skinning(3, glm::dmat4(1.0));
    skinning[1] = glm::mat4_cast(glm::angleAxis(0.5, glm::dvec3(1, 0, 0)));
    ASSERT_TRUE(pose.set(skinning.data(), 3));
    const glm::dquat before = pose.transform(1).rotation;

    EXPECT_FALSE(pose.set(skinning.data(), 2));
    auto spoilt = skinning;
    spoilt[1][3][0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(pose.set(spoilt.data(), 3));
    spoilt = skinning;
    spoilt[2] = glm::dmat4(0.0);
    EXPECT_FALSE(pose.set(spoilt.data(), 3));
    EXPECT_EQ(pose.transform(1).rotation, before);
}

TEST(Pose, TakesEvenScaleApart) {
    const test::Tube tube(3, 3);
    Pose pose(tube.binding.joints);
    const glm::dquat turn = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3)));
    std::vector<glm::dmat4> skinning(3, glm::mat4_cast(turn) *
                                            glm::scale(glm::dmat4(1.0), glm::dvec3(2.0)));
    skinning[2] = skinning[1] * glm::scale(glm::dmat4(1.0), glm::dvec3(1.5));
    ASSERT_TRUE(pose.set(skinning.data(), 3));
    EXPECT_NEAR(std::abs(glm::dot(pose.transform(0).rotation, turn)), 1.0, 1e-12);
    EXPECT_NEAR(std::abs(pose.transform(1).rotation.w), 1.0, 1e-12);
    EXPECT_NEAR(pose.transform(0).scale, 2.0, 1e-12);
    EXPECT_EQ(pose.transform(1).scale, 1.0) << "exactly: it costs nothing then";
    EXPECT_NEAR(pose.transform(2).scale, 1.5, 1e-12);
}

TEST(Pose, LeavesUnevenScaleAndMirroringOut) {
    const test::Tube tube(3, 3);
    Pose pose(tube.binding.joints);
    for (const glm::dvec3& scale : {glm::dvec3(2.0, 0.5, 1.0), glm::dvec3(-1.0, 1.0, 1.0)}) {
        std::vector<glm::dmat4> skinning(3, glm::dmat4(1.0));
        skinning[1] = glm::scale(glm::dmat4(1.0), scale);
        ASSERT_TRUE(pose.set(skinning.data(), 3));
        EXPECT_EQ(pose.transform(1).scale, 1.0);
        const glm::dvec3 centre = tube.binding.joints[1].centre;
        EXPECT_LT(glm::distance(pose.transform(1).translation,
                                glm::dvec3(skinning[1] * glm::dvec4(centre, 1.0)) - centre),
                  1e-12)
            << "the joint itself goes where the bone puts it";
    }
}

TEST(Pose, GivesTheMatricesBackThatItWasMadeFrom) {
    const test::Tube tube(3, 3);
    Pose pose(tube.binding.joints);
    std::mt19937_64 random(17);
    std::vector<glm::dmat4> skinning;
    for (int j = 0; j < 3; ++j) {
        const glm::dmat4 own = glm::translate(glm::dmat4(1.0), test::randomUnit(random)) *
                               glm::mat4_cast(test::randomRotation(random)) *
                               glm::scale(glm::dmat4(1.0), glm::dvec3(0.5 + j));
        skinning.push_back(j == 0 ? own : skinning.back() * own);
    }
    ASSERT_TRUE(pose.set(skinning.data(), 3));
    const std::vector<glm::dmat4> back = pose.skinning();
    ASSERT_EQ(back.size(), 3u);
    for (std::size_t j = 0; j < 3; ++j)
        for (int column = 0; column < 4; ++column)
            EXPECT_LT(glm::distance(back[j][column], skinning[j][column]), 1e-12) << j << column;
    EXPECT_TRUE(Pose().skinning().empty());
}

/// Skin that follows the joints fully is transformed by their matrices, as in linear blending.
TEST(DeformJob, ScaledJointsTakeFullFollowersAlong) {
    const test::Tube tube;
    Deformed deformed(tube);
    std::mt19937_64 random(16);
    std::uniform_real_distribution<double> growth(0.25, 4.0);
    for (int i = 0; i < 50; ++i) {
        std::vector<glm::dmat4> skinning;
        double size = 1.0;
        for (std::size_t j = 0; j < 3; ++j) {
            const glm::dvec3 c = deformed.model->joints()[j].centre;
            const double s = growth(random);
            size = std::max(size, s * size);
            const glm::dmat4 own = glm::translate(glm::dmat4(1.0), c + test::randomUnit(random)) *
                                   glm::mat4_cast(test::randomRotation(random)) *
                                   glm::scale(glm::dmat4(1.0), glm::dvec3(s)) *
                                   glm::translate(glm::dmat4(1.0), -c);
            skinning.push_back(j == 0 ? own : skinning.back() * own);
        }
        ASSERT_TRUE(deformed.pose.set(skinning.data(), skinning.size()));
        ASSERT_TRUE(deformed.job.run());
        std::size_t full = 0;
        for (std::uint32_t v = 0; v < tube.positions.size(); ++v) {
            const std::uint32_t first = tube.binding.firstInfluence[v];
            const std::uint32_t end = tube.binding.firstInfluence[v + 1];
            bool fully = true;
            for (std::uint32_t k = first; k < end; ++k)
                fully = fully && tube.binding.influences[k].bend == 1.0f &&
                        tube.binding.influences[k].twist == 1.0f;
            EXPECT_NEAR(double(glm::length(deformed.normals[v])), 1.0, 1e-5);
            if (!fully) continue;
            ++full;
            const glm::dmat4& g = skinning[tube.binding.influences[end - 1].joint];
            ASSERT_LE(glm::distance(glm::dvec3(deformed.positions[v]),
                                    glm::dvec3(g * glm::dvec4(glm::dvec3(tube.positions[v]), 1.0))),
                      6.0 * 2e-6 * size);
        }
        EXPECT_GT(full, 0u);
    }
}

TEST(SkinModel, RefusesWhatDoesNotFit) {
    const test::Tube tube(3, 3);
    using osgSkin::SkinModel;
    auto shortNormals = tube.normals;
    shortNormals.pop_back();
    EXPECT_THROW(SkinModel::create(tube.binding, tube.positions, shortNormals, tube.source),
                 osgSkin::Error);
    auto badSource = tube.source;
    badSource[0] = 1000;
    EXPECT_THROW(SkinModel::create(tube.binding, tube.positions, tube.normals, badSource),
                 osgSkin::Error);
    osgSkin::Binding badRatio = tube.binding;
    badRatio.influences.back().bend = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(SkinModel::create(badRatio, tube.positions, tube.normals, tube.source),
                 osgSkin::Error);
}

TEST(SkinModel, HoldsEveryVertexOnce) {
    const test::Tube tube;
    const auto model = tube.model();
    std::vector<int> seen(tube.positions.size(), 0);
    for (const std::uint32_t v : model->order()) ++seen[v];
    EXPECT_EQ(seen, std::vector<int>(tube.positions.size(), 1));
    std::size_t vertices = 0;
    for (const auto& group : model->groups()) vertices += group.vertexCount;
    EXPECT_EQ(vertices, tube.positions.size());
}

TEST(SkinTangents, RefuseWhatDoesNotFit) {
    const test::Tube tube(3, 3);
    const auto model = tube.model();
    const std::vector<glm::vec4> good(tube.positions.size(), glm::vec4(0, 1, 0, 1));
    EXPECT_EQ(osgSkin::SkinTangents::create(model, good)->tangents(), good);
    EXPECT_THROW(osgSkin::SkinTangents::create(nullptr, good), osgSkin::Error);
    EXPECT_THROW(osgSkin::SkinTangents::create(model, {}), osgSkin::Error);
    std::vector<glm::vec4> spoilt = good;
    spoilt.back().y = std::numeric_limits<float>::infinity();
    EXPECT_THROW(osgSkin::SkinTangents::create(model, spoilt), osgSkin::Error);
}

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

TEST(DeformPool, HasItsThreadsWhereTheMainThreadIsPinned) {
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

TEST(DeformPool, WorksAloneWhereNoThreadCanBeMade) {
    if (!DeformPool::hasThreads()) GTEST_SKIP() << "built without threads";
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(endWithoutThreads(), testing::ExitedWithCode(0), "makes no thread");
}
#endif

/// For example, a thread deforms a skin and holds its lock while the pool's threads are about to
/// deform it.
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
