// SPDX-License-Identifier: MIT
// The fast path with every instruction set of this machine, and the scalar reference, compared with
// the formula in double precision.
#include "EachTarget.h"
#include "Tube.h"
#include "Turns.h"

#include <osgSkin/DeformJob>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace {

constexpr float kHeight = 10.0f;
constexpr float kGuard = 12345.0f;

/// Vertices in a ball that all follow the joints 1.. of a chain in the same way.
struct Manner {
    const char* name;
    std::vector<char> joints; ///< f: fully, p: partly, b: bend only, t: twist only, -: not at all
};

const std::vector<Manner>& manners() {
    static const std::vector<Manner> all = {
        {"root alone", {}},
        {"one full", {'f'}},
        {"one partial", {'p'}},
        {"full, partial", {'f', 'f', 'p'}},
        {"partial, full", {'p', 'f', 'f'}},
        {"partial, full, partial", {'p', 'f', 'p'}},
        {"two branches", {'f', 'p', '-', 'p'}},
        {"twist only", {'f', 't'}},
        {"bend only", {'b', 'p'}},
        {"mixed, full", {'t', 'b', 'f'}},
        {"four", {'p', 'p', 'p', 'p'}},
        {"eight", {'p', 't', 'p', 'b', 'p', 'p', 'p', 'p', '-'}},
        {"long", std::vector<char>(60, 'f')},
    };
    return all;
}

osgSkin::Binding chainOf(std::size_t joints, std::mt19937_64& random) {
    osgSkin::Binding binding;
    std::uniform_real_distribution<double> place(-2.0, 2.0);
    for (std::size_t j = 0; j < joints; ++j)
        binding.joints.push_back({"joint" + std::to_string(j),
                                  static_cast<int>(j) - 1,
                                  {place(random), place(random), place(random)},
                                  test::randomUnit(random),
                                  test::randomUnit(random)});
    binding.firstInfluence.push_back(0);
    return binding;
}

/// `count` consecutive vertices of each kind: groups of that size.
struct Skin {
    osgSkin::Binding binding;
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec4> tangents;
    std::vector<std::uint32_t> source;

    Skin(std::size_t joints, const std::vector<Manner>& manner, std::size_t count,
         std::uint64_t seed) {
        std::mt19937_64 random(seed);
        binding = chainOf(joints, random);
        std::uniform_real_distribution<float> ratio(0.01f, 0.99f);
        for (const Manner& m : manner)
            for (std::size_t v = 0; v < count; ++v) {
                add(m, ratio, random);
                positions.push_back(glm::vec3(test::randomUnit(random)) * 0.5f * kHeight);
                normals.push_back(glm::vec3(test::randomUnit(random)));
                tangents.emplace_back(test::randomUnit(random), v % 3 == 0 ? -1.0 : 1.0);
                source.push_back(static_cast<std::uint32_t>(source.size()));
            }
    }

private:
    void add(const Manner& m, std::uniform_real_distribution<float>& ratio,
             std::mt19937_64& random) {
        binding.influences.push_back({0, 1.0f, 1.0f});
        for (std::uint32_t j = 0; j < m.joints.size(); ++j) {
            const float some = ratio(random);
            switch (m.joints[j]) {
            case 'f':
                binding.influences.push_back({j + 1, 1.0f, 1.0f});
                break;
            case 'p':
                binding.influences.push_back({j + 1, some, ratio(random)});
                break;
            case 'b':
                binding.influences.push_back({j + 1, some, 1.0f});
                break;
            case 't':
                binding.influences.push_back({j + 1, 0.0f, some});
                break;
            default:
                break;
            }
        }
        binding.regions.push_back(0);
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
    }
};

/// The same skin sorted so that the deformation writes its results in order.
Skin inBestOrder(Skin skin) {
    const auto order = osgSkin::SkinModel::bestOrder(skin.binding, skin.source);
    const Skin old = skin;
    for (std::size_t i = 0; i < order.size(); ++i) {
        skin.positions[i] = old.positions[order[i]];
        skin.normals[i] = old.normals[order[i]];
        skin.tangents[i] = old.tangents[order[i]];
        skin.source[i] = old.source[order[i]];
    }
    return skin;
}

/// One vertex with its directions, joint by joint, in double precision.
void reference(const osgSkin::Binding& binding, const osgSkin::Pose& pose, std::uint32_t vertex,
               glm::dvec3& x, glm::dvec3& n, glm::dvec3& t) {
    for (std::uint32_t i = binding.firstInfluence[vertex + 1];
         i-- > binding.firstInfluence[vertex];) {
        const osgSkin::Influence& influence = binding.influences[i];
        const osgSkin::BoundJoint& joint = binding.joints[influence.joint];
        const osgSkin::JointTransform& turn = pose.transform(influence.joint);
        const auto bend = static_cast<double>(influence.bend);
        const glm::dquat q = osgSkin::partialRotation(turn.split, joint.twistAxis, bend,
                                                      static_cast<double>(influence.twist));
        n = q * n;
        t = q * t;
        const double scale = 1.0 + bend * (turn.scale - 1.0);
        x = joint.parent < 0
                ? turn.offset + scale * (q * x)
                : joint.centre + bend * turn.translation + scale * (q * (x - joint.centre));
    }
}

using Model = osg::ref_ptr<const osgSkin::SkinModel>;

Model modelOf(const Skin& skin) {
    return osgSkin::SkinModel::create(skin.binding, skin.positions, skin.normals, skin.source);
}

/// The requested outputs besides positions.
enum class Streams { None, Normals, NormalsAndTangents };

class Kernel : public test::EachTarget {
protected:
    void deform(const Skin& skin, const osgSkin::Pose& pose, const Model& model,
                Streams streams) const;
};

void Kernel::deform(const Skin& skin, const osgSkin::Pose& pose, const Model& model,
                    Streams streams) const {
    const bool withNormals = streams != Streams::None;
    const bool withTangents = streams == Streams::NormalsAndTangents;
    const std::size_t count = skin.positions.size();
    // One vertex before and several after them, which must not change.
    std::vector<glm::vec3> positions(count + 20, glm::vec3(kGuard)), normals = positions;
    std::vector<glm::vec4> tangents(count + 20, glm::vec4(kGuard));
    const auto restTangents = osgSkin::SkinTangents::create(model, skin.tangents);
    osgSkin::DeformJob job;
    job.model = model.get();
    job.pose = &pose;
    job.positions = positions.data() + 1;
    job.positionCount = count;
    job.normals = withNormals ? normals.data() + 1 : nullptr;
    job.normalCount = count;
    job.restTangents = restTangents.get();
    job.tangents = withTangents ? tangents.data() + 1 : nullptr;
    job.tangentCount = count;
    ASSERT_TRUE(isReference() ? job.runReference() : job.run());
    for (std::uint32_t v = 0; v < count; ++v) {
        glm::dvec3 x(skin.positions[v]), n(skin.normals[v]), t(skin.tangents[v]);
        reference(skin.binding, pose, skin.source[v], x, n, t);
        // Written so that NaN fails.
        ASSERT_TRUE(glm::distance(glm::dvec3(positions[v + 1]), x) <= 1e-6 * double(kHeight))
            << "vertex " << v << ", off by " << glm::distance(glm::dvec3(positions[v + 1]), x);
        if (!withNormals) continue;
        ASSERT_TRUE(glm::distance(glm::dvec3(normals[v + 1]), n) <= 1e-5) << "vertex " << v;
        if (!withTangents) continue;
        ASSERT_TRUE(glm::distance(glm::dvec3(tangents[v + 1]), t) <= 1e-5) << "vertex " << v;
        ASSERT_EQ(tangents[v + 1].w, skin.tangents[v].w) << "vertex " << v;
    }
    for (std::size_t i = 0; i < positions.size(); i = i == 0 ? count + 1 : i + 1) {
        ASSERT_EQ(positions[i], glm::vec3(kGuard)) << "written outside, at " << i;
        ASSERT_EQ(normals[i], glm::vec3(kGuard)) << "written outside, at " << i;
        ASSERT_EQ(tangents[i], glm::vec4(kGuard)) << "written outside, at " << i;
    }
}

/// Poses that stay within the body's height: rotations about joints inside the body. Each joint
/// scales uniformly by a factor of up to `grows` up or down. The angles are random, or `angle`
/// each.
osgSkin::Pose randomPose(const osgSkin::Binding& binding, double moves, std::mt19937_64& random,
                         double grows = 0.0, double angle = 0.0) {
    std::uniform_real_distribution<double> growth(1.0 - grows, 1.0 + grows);
    std::vector<glm::dmat4> skinning;
    for (std::size_t j = 0; j < binding.joints.size(); ++j) {
        const glm::dvec3 c = binding.joints[j].centre;
        const glm::dmat4 turn =
            glm::translate(glm::dmat4(1.0), c + moves * test::randomUnit(random)) *
            glm::mat4_cast(angle > 0.0 ? glm::angleAxis(angle, test::randomUnit(random))
                                       : test::randomRotation(random)) *
            glm::scale(glm::dmat4(1.0), glm::dvec3(grows > 0.0 ? growth(random) : 1.0)) *
            glm::translate(glm::dmat4(1.0), -c);
        skinning.push_back(j == 0 ? turn : skinning.back() * turn);
    }
    osgSkin::Pose pose(binding.joints);
    EXPECT_TRUE(pose.set(skinning.data(), skinning.size()));
    return pose;
}

} // namespace

TEST_P(Kernel, MatchesDoublePrecisionForEveryGroupSize) {
    std::mt19937_64 random(11);
    // A long limb has five joints; more rotations, each about a distant centre, leave the body.
    const std::vector<Manner> upToFour(manners().begin(), manners().begin() + 11);
    for (std::size_t size = 1; size <= 33; ++size) {
        SCOPED_TRACE("groups of " + std::to_string(size));
        const Skin skin(5, upToFour, size, size);
        const Model model = modelOf(skin);
        for (const double moves : {0.0, 0.5})
            for (const Streams streams :
                 {Streams::None, Streams::Normals, Streams::NormalsAndTangents})
                deform(skin, randomPose(skin.binding, moves, random), model, streams);
    }
}

TEST_P(Kernel, FollowsUniformScale) {
    std::mt19937_64 random(15);
    const std::vector<Manner> upToFour(manners().begin(), manners().begin() + 11);
    for (const std::size_t size : {1u, 7u, 33u}) {
        const Skin skin(5, upToFour, size, size);
        const Model model = modelOf(skin);
        for (const double moves : {0.0, 0.5}) {
            const osgSkin::Pose pose = randomPose(skin.binding, moves, random, 0.2);
            EXPECT_GT(std::abs(pose.transform(2).scale - 1.0), 1e-3);
            deform(skin, pose, model, Streams::NormalsAndTangents);
        }
    }
}

TEST_P(Kernel, MatchesDoublePrecisionInBestOrder) {
    std::mt19937_64 random(12);
    const std::vector<Manner> upToFour(manners().begin(), manners().begin() + 11);
    for (std::size_t size = 1; size <= 33; ++size) {
        SCOPED_TRACE("groups of " + std::to_string(size));
        const Skin skin = inBestOrder(Skin(5, upToFour, size, size));
        const Model model = modelOf(skin);
        for (std::uint32_t i = 0; i < model->order().size(); ++i) ASSERT_EQ(model->order()[i], i);
        for (const Streams streams : {Streams::Normals, Streams::NormalsAndTangents})
            deform(skin, randomPose(skin.binding, 0.0, random), model, streams);
    }
}

TEST_P(Kernel, HandlesLongChainsAndManyPartialJoints) {
    std::mt19937_64 random(13);
    const Skin skin(61, {manners().begin() + 11, manners().end()}, 5, 3);
    const Model model = modelOf(skin);
    osgSkin::Pose pose(skin.binding.joints);
    deform(skin, pose, model, Streams::NormalsAndTangents);
    // Small rotations, so that sixty of them stay within the body.
    std::vector<glm::dmat4> skinning;
    std::vector<glm::dquat> turns;
    for (std::size_t j = 0; j < skin.binding.joints.size(); ++j)
        turns.push_back(glm::angleAxis(0.02, test::randomUnit(random)));
    skinning = test::skinningFrom(skin.binding.joints, turns);
    ASSERT_TRUE(pose.set(skinning.data(), skinning.size()));
    deform(skin, pose, model, Streams::NormalsAndTangents);
}

/// Some hundred joints, and chains with more full joints between the partial ones than are
/// processed at once.
TEST_P(Kernel, HandlesMoreJointsThanFitInOneSection) {
    std::mt19937_64 random(17);
    constexpr std::size_t kJoints = 300;
    std::vector<Manner> manner = {{"all full", std::vector<char>(kJoints, 'f')}};
    for (const std::size_t partial : {0u, 120u, 299u}) {
        manner.push_back(manner.front());
        manner.back().joints[partial] = 'p';
    }
    std::uniform_int_distribution<std::size_t> place(0, kJoints - 1);
    for (int i = 0; i < 40; ++i) { // some joints here and there
        manner.push_back({"few", std::vector<char>(kJoints, '-')});
        for (int j = 0; j < 12; ++j) manner.back().joints[place(random)] = j < 4 ? 'p' : 'f';
    }
    const Skin skin = inBestOrder(Skin(kJoints + 1, manner, 130, 4));
    const Model model = modelOf(skin);
    std::vector<glm::dquat> turns;
    for (std::size_t j = 0; j <= kJoints; ++j)
        turns.push_back(glm::angleAxis(0.003, test::randomUnit(random)));
    const auto skinning = test::skinningFrom(skin.binding.joints, turns);
    osgSkin::Pose pose(skin.binding.joints);
    ASSERT_TRUE(pose.set(skinning.data(), skinning.size()));
    deform(skin, pose, model, Streams::NormalsAndTangents);
    deform(skin, randomPose(skin.binding, 0.0, random, 1e-3, 0.003), model, Streams::Normals);
    if (isReference()) return; // it is not divided into parts
    EXPECT_EQ(test::deformInParts(*model, pose).positions, osgSkin::deform(*model, pose).positions);
}

TEST_P(Kernel, RotatesByHalfATurnAndBack) {
    const Skin skin(4, {manners().begin() + 2, manners().begin() + 4}, 17, 7);
    const Model model = modelOf(skin);
    osgSkin::Pose pose(skin.binding.joints);
    const glm::dvec3 w = skin.binding.joints[1].twistAxis;
    const glm::dvec3 v = glm::normalize(glm::cross(w, glm::dvec3(0.3, 0.5, 0.7)));
    for (const double angle : {3.14159265358979, -3.14159265358979, 3.1, 1e-9, 0.0})
        for (const glm::dvec3& axis : {v, w}) {
            const std::vector<glm::dquat> turns = {
                glm::dquat(1, 0, 0, 0), glm::angleAxis(angle, axis), glm::angleAxis(-angle, axis),
                glm::angleAxis(angle, axis)};
            const auto skinning = test::skinningFrom(skin.binding.joints, turns);
            ASSERT_TRUE(pose.set(skinning.data(), skinning.size()));
            deform(skin, pose, model, Streams::NormalsAndTangents);
        }
}

TEST_P(Kernel, PartsMatchTheWhole) {
    if (isReference()) return; // it is not divided into parts
    std::mt19937_64 random(14);
    const std::vector<Manner> upToFour(manners().begin(), manners().begin() + 11);
    for (const Skin& skin : {Skin(5, upToFour, 1201, 9), inBestOrder(Skin(5, upToFour, 1201, 9))}) {
        const Model model = modelOf(skin);
        const osgSkin::Pose pose = randomPose(skin.binding, 0.5, random);
        osgSkin::DeformOptions options;
        options.normals = true;
        const auto whole = osgSkin::deform(*model, pose, options);
        const auto parts = test::deformInParts(*model, pose, options);
        EXPECT_EQ(parts.positions, whole.positions);
        EXPECT_EQ(parts.normals, whole.normals);
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, Kernel, testing::ValuesIn(test::allTargets()),
                         [](const auto& tested) { return tested.param.name; });
