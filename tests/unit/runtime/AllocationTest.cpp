// SPDX-License-Identifier: MIT
//
// Counts what a frame takes from the heap; a program of its own, because it replaces operator new.
#include <osgSkin/DeformJob>
#include <osgSkin/PoseBounds>

#include "Tube.h"
#include "Turns.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::size_t> allocations{0};

void* counted(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
} // namespace

void* operator new(std::size_t size) {
    return counted(size);
}
void* operator new[](std::size_t size) {
    return counted(size);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    ++allocations;
    const std::size_t step = static_cast<std::size_t>(alignment);
    if (void* memory = std::aligned_alloc(step, (size + step - 1) / step * step)) return memory;
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete[](void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    std::free(memory);
}

TEST(Allocation, CounterWorks) {
    const std::size_t before = allocations;
    const std::vector<int> some(100, 1);
    EXPECT_GT(allocations, before) << some.size();
}

TEST(Allocation, NoneInAThousandFrames) {
    const test::Tube tube;
    const auto model = tube.model();
    osgSkin::Pose pose(model->joints());
    std::vector<glm::vec3> positions(model->vertexCount()), normals(model->vertexCount());
    osgSkin::DeformJob job;
    job.model = model.get();
    job.pose = &pose;
    job.positions = positions.data();
    job.normals = normals.data();
    job.positionCount = job.normalCount = positions.size();
    std::mt19937_64 random(3);
    std::vector<std::vector<glm::dmat4>> frames(20);
    for (std::vector<glm::dmat4>& frame : frames)
        frame = test::skinningFrom(model->joints(),
                                   {test::randomRotation(random), test::randomRotation(random),
                                    test::randomRotation(random)});
    const std::size_t before = allocations;
    bool good = true;
    for (std::size_t frame = 0; frame < 1000; ++frame) {
        const auto& skinning = frames[frame % frames.size()];
        good = pose.set(skinning.data(), skinning.size()) && good;
        good = job.run() && good;
        const osgSkin::PoseBounds bounds = osgSkin::computePoseBounds(*model, pose);
        good = bounds.low.x <= bounds.high.x && good;
    }
    EXPECT_EQ(allocations, before);
    EXPECT_TRUE(good);
}
