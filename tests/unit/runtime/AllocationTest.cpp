// SPDX-License-Identifier: MIT
//
// Counts a frame's heap allocations; a separate program, because it replaces operator new.
#include <osgSkin/DeformPool>
#include <osgSkin/PoseBounds>
#include <osgSkin/UpdateDeformableSkin>
#include <osgSkinMotion/ClipPlayer>

#include "Tube.h"
#include "Turns.h"

#include <osg/Geometry>
#include <osgAnimation/Bone>

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <malloc.h>
#include <new>
#include <thread>

namespace {
std::atomic<std::size_t> allocations{0};
std::atomic<std::size_t> bytesInUse{0};

/// Before each block, with its size: what malloc() rounds sizes up to depends on earlier calls.
constexpr std::size_t kHeader = alignof(std::max_align_t);

void* take(std::size_t size) {
    void* const block = std::malloc(kHeader + size);
    if (!block) return nullptr;
    ++allocations;
    bytesInUse += size;
    std::memcpy(block, &size, sizeof size);
    return static_cast<char*>(block) + kHeader;
}

void release(void* memory) {
    if (!memory) return;
    void* const block = static_cast<char*>(memory) - kHeader;
    std::size_t size = 0;
    std::memcpy(&size, block, sizeof size);
    bytesInUse -= size;
    std::free(block);
}

void releaseAligned(void* memory) {
    if (memory) bytesInUse -= malloc_usable_size(memory);
    std::free(memory);
}
} // namespace

void* operator new(std::size_t size) {
    if (void* const memory = take(size)) return memory;
    throw std::bad_alloc();
}
void* operator new[](std::size_t size) {
    return operator new(size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { // used by std::stable_sort
    return take(size);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return take(size);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    const std::size_t step = static_cast<std::size_t>(alignment);
    void* const memory = std::aligned_alloc(step, (size + step - 1) / step * step);
    if (!memory) throw std::bad_alloc();
    ++allocations;
    bytesInUse += malloc_usable_size(memory);
    return memory;
}
void operator delete(void* memory) noexcept {
    release(memory);
}
void operator delete[](void* memory) noexcept {
    release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    release(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    release(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    releaseAligned(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    releaseAligned(memory);
}

TEST(Allocation, CounterWorks) {
    const std::size_t before = allocations;
    const std::vector<int> some(100, 1);
    EXPECT_GT(allocations, before) << some.size();
}

namespace {

/// Skins that cycle through some poses, frame after frame.
struct Frames {
    explicit Frames(std::size_t count, int rings) : model(test::Tube(rings).model()) {
        for (std::size_t i = 0; i < count; ++i) {
            poses.emplace_back(model->joints());
            outputs.emplace_back(2 * model->vertexCount());
        }
        for (std::size_t i = 0; i < count; ++i) {
            osgSkin::DeformJob job;
            job.model = model.get();
            job.pose = &poses[i];
            job.positions = outputs[i].data();
            job.normals = outputs[i].data() + model->vertexCount();
            job.positionCount = job.normalCount = model->vertexCount();
            jobs.push_back(job);
        }
        std::mt19937_64 random(3);
        for (std::vector<glm::dmat4>& matrices : skinning)
            matrices = test::skinningFrom(model->joints(), {test::randomRotation(random),
                                                            test::randomRotation(random),
                                                            test::randomRotation(random)});
    }
    bool setPose(std::size_t skin, std::size_t frame) {
        const auto& matrices = skinning[(frame + skin) % skinning.size()];
        return poses[skin].set(matrices.data(), matrices.size());
    }

    osg::ref_ptr<const osgSkin::SkinModel> model;
    std::vector<osgSkin::Pose> poses;
    std::vector<std::vector<glm::vec3>> outputs;
    std::vector<osgSkin::DeformJob> jobs;
    std::array<std::vector<glm::dmat4>, 20> skinning;
};

} // namespace

TEST(Allocation, NoneInAThousandFrames) {
    Frames frames(1, 25);
    bool good = frames.setPose(0, 0); // allocates this thread's memory
    const std::size_t before = allocations;
    for (std::size_t frame = 0; frame < 1000; ++frame) {
        good = frames.setPose(0, frame) && good;
        good = frames.jobs[0].run() && good;
        const osgSkin::PoseBounds bounds =
            osgSkin::computePoseBounds(*frames.model, frames.poses[0]);
        good = bounds.low.x <= bounds.high.x && good;
    }
    EXPECT_EQ(allocations, before);
    EXPECT_TRUE(good);
}

TEST(Allocation, NoneInAThousandFramesOfAPool) {
    Frames frames(4, 900);
    const osg::ref_ptr<osgSkin::DeformPool> pool = new osgSkin::DeformPool(2);
    pool->setMinimumVertices(10000); // so that each skin is also divided among threads
    std::atomic<bool> good{true};
    const auto run = [&](std::size_t frame) {
        pool->forEach(frames.poses.size(), [&](std::size_t i) {
            if (!frames.setPose(i, frame)) good = false;
        });
        if (!pool->run(frames.jobs.data(), frames.jobs.size())) good = false;
    };
    // Both threads allocate their own memory: each has to wait for the other to begin.
    pool->forEach(50, [&](std::size_t) {
        osgSkin::Pose pose = frames.poses[0];
        pose.set(frames.skinning[0].data(), frames.skinning[0].size());
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    });
    for (std::size_t frame = 0; frame < 20; ++frame) run(frame);
    const std::size_t before = allocations;
    for (std::size_t frame = 0; frame < 1000; ++frame) run(frame);
    EXPECT_EQ(allocations, before);
    EXPECT_TRUE(good);
}

TEST(Allocation, NoneInAThousandFramesOfClipLayers) {
    const std::vector<osgSkin::SampledClip::Joint> joints{
        {"root", -1, {0, 0, 0}}, {"middle", 0, {0, 2, 0}}, {"end", 1, {0, 4, 0}}};
    std::vector<osgSkin::JointSample> samples(30);
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i].rotation = glm::angleAxis(0.1 * double(i), glm::dvec3(1, 0, 0));
    const auto clip = osgSkin::SampledClip::create("clip", joints, samples, 0.1);
    const test::Tube tube;
    const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    const auto vertices = static_cast<unsigned int>(tube.positions.size());
    geometry->setVertexArray(new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, vertices));
    geometry->setNormalArray(new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, vertices));
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    skin->setSkin(geometry, tube.model());
    const osg::ref_ptr<osgSkin::ClipPlayer> player = new osgSkin::ClipPlayer;
    player->addSkin(skin);
    player->setRoot(osgSkin::ClipPlayer::Root::ExtractedWithTurn);
    for (std::size_t i = 0; i < 4; ++i)
        player->setLayer(i, {clip, 0.1 * double(i), 1.0, true, 0.5, {"middle", "end"}, i % 2 == 1});
    std::size_t calls = 0;
    player->addEvent(clip, 0.5, "half", [&calls](osgSkin::ClipPlayer&, std::size_t) { ++calls; });
    const auto run = [&](int frames) {
        for (int i = 0; i < frames; ++i) {
            player->fade(1, i % 50 < 25 ? 1.0 : 0.0, 0.3);
            player->setLayer(0, player->getLayer(0));
            player->advance(0.017);
            if (!player->pose()) return false;
        }
        return true;
    };
    EXPECT_TRUE(run(200));
    const std::size_t before = allocations;
    const bool good = run(1000);
    EXPECT_EQ(allocations, before);
    EXPECT_TRUE(good);
    EXPECT_GT(calls, 50u);
}

namespace {

constexpr unsigned int kVertices = 4000;
constexpr unsigned int kJoints = 31;

osg::ref_ptr<osg::Geometry> makeGeometry() {
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, kVertices));
    geometry->setNormalArray(new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, kVertices));
    return geometry;
}

/// A skin with as many vertices and joints as a character.
osg::ref_ptr<osgSkin::DeformableSkin> makeCharacter() {
    osgSkin::Binding binding;
    const glm::dvec3 axis(0, 1, 0);
    for (unsigned int j = 0; j < kJoints; ++j)
        binding.joints.push_back(
            {"joint" + std::to_string(j), static_cast<int>(j) - 1, {0, j, 0}, axis, axis});
    binding.firstInfluence.push_back(0);
    std::vector<std::uint32_t> source;
    for (unsigned int v = 0; v < kVertices; ++v) {
        binding.influences.push_back({0, 1.0f, 1.0f});
        binding.regions.push_back(0);
        binding.firstInfluence.push_back(v + 1);
        source.push_back(v);
    }
    const std::vector<glm::vec3> vectors(kVertices, glm::vec3(0, 1, 0));
    osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    skin->setSkin(makeGeometry(), osgSkin::SkinModel::create(binding, vectors, vectors, source));
    return skin;
}

osg::ref_ptr<osgAnimation::Skeleton> makeBones() {
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    osg::Group* parent = skeleton;
    for (unsigned int j = 0; j < kJoints; ++j) {
        const osg::ref_ptr<osgAnimation::Bone> bone =
            new osgAnimation::Bone("joint" + std::to_string(j));
        bone->setMatrixInSkeletonSpace(osg::Matrix::rotate(0.1 * j, osg::Vec3(1, 0, 0)));
        parent->addChild(bone);
        parent = bone;
    }
    return skeleton;
}

} // namespace

TEST(Memory, EachFurtherCharacterTakesTwoBuffersAnd4KiB) {
    const osg::ref_ptr<osgSkin::DeformableSkin> first = makeCharacter();
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = makeBones();
    osg::ref_ptr<osgSkin::UpdateDeformableSkin> update = new osgSkin::UpdateDeformableSkin;
    ASSERT_TRUE(update->pose(*first, *skeleton));
    first->getDeformedGeometry();

    // The memory that OSG uses for two geometries with their own vertices and normals in a buffer
    // object.
    std::size_t before = bytesInUse;
    std::vector<osg::ref_ptr<osg::Geometry>> buffers;
    buffers.reserve(2);
    for (int i = 0; i < 2; ++i) {
        buffers.push_back(makeGeometry());
        const osg::ref_ptr<osg::VertexBufferObject> vbo = new osg::VertexBufferObject;
        buffers.back()->getVertexArray()->setVertexBufferObject(vbo);
        buffers.back()->getNormalArray()->setVertexBufferObject(vbo);
        buffers.back()->setUseVertexBufferObjects(true);
        buffers.back()->getBound();
    }
    const std::size_t twoBuffers = bytesInUse - before;
    EXPECT_GE(twoBuffers, 4 * std::size_t(kVertices) * sizeof(osg::Vec3));

    before = bytesInUse;
    const osg::ref_ptr<osgSkin::DeformableSkin> further =
        osg::clone(first.get(), osg::CopyOp::SHALLOW_COPY);
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> furtherUpdate =
        osg::clone(update.get(), osg::CopyOp::SHALLOW_COPY);
    ASSERT_TRUE(furtherUpdate->pose(*further, *skeleton));
    further->getDeformedGeometry();
    const std::size_t character = bytesInUse - before;
    EXPECT_GE(character, twoBuffers);
    EXPECT_LE(character, twoBuffers + 4096)
        << character - twoBuffers << " bytes beside the buffers";
    RecordProperty("bytesBesideBuffers", static_cast<int>(character - twoBuffers));
}
