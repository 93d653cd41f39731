// SPDX-License-Identifier: MIT
#include "BlockRows.h"
#include "FileVersion.h"
#include "RegisterWrapper.h"
#include "serialize/BlockWords.h"
#include "serialize/SharedObjects.h"

#include <osgSkinMotion/Gaits>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>
#include <vector>

namespace osgSkinMotion {
using osgSkin::Gaits; // osgDB knows classes by their libraries
} // namespace osgSkinMotion

namespace {

using osgSkin::BlockReader;
using osgSkin::BlockWriter;
using osgSkin::Gaits;
using osgSkin::JointSample;
using osgSkin::SampledClip;

constexpr double kUnit = 32767.0; ///< of rotations' components

/// A clip: its name, step, number of samples; for each sample and joint four components of the
/// rotation (numbers of 16 bits, two a word); then joints that move or scale: their number, and of
/// each: joint, and of each sample translation and scale (floats).
void packClip(BlockWriter& out, const SampledClip& clip) {
    const std::size_t joints = clip.joints().size(), count = clip.sampleCount();
    out.put(clip.name());
    out.put(clip.step());
    out.put(count);
    std::vector<std::int16_t> rotations;
    rotations.reserve(4 * joints * count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < joints; ++j) {
            const glm::dquat& q = clip.sample(i)[j].rotation;
            for (const double number : {q.w, q.x, q.y, q.z})
                rotations.push_back(static_cast<std::int16_t>(std::lround(number * kUnit)));
        }
    out.shorts(rotations.data(), rotations.size());
    std::vector<std::uint32_t> moving;
    for (std::size_t j = 0; j < joints; ++j) {
        bool moves = false;
        for (std::size_t i = 0; i < count; ++i) {
            const JointSample& sample = clip.sample(i)[j];
            moves = moves || sample.scale != 1.0 || sample.translation != glm::dvec3(0.0);
        }
        if (moves) moving.push_back(static_cast<std::uint32_t>(j));
    }
    out.put(moving.size());
    for (const std::uint32_t j : moving) {
        out.put(j);
        for (std::size_t i = 0; i < count; ++i) {
            const JointSample& sample = clip.sample(i)[j];
            out.putVector(glm::vec3(sample.translation));
            out.put(static_cast<float>(sample.scale));
        }
    }
}

glm::dvec3 readVector(BlockReader& in) {
    const float x = in.real();
    const float y = in.real();
    return {x, y, in.real()};
}

osg::ref_ptr<const SampledClip> unpackClip(BlockReader& in,
                                           const std::vector<SampledClip::Joint>& joints) {
    const std::string name = in.text();
    const double step = in.longReal();
    const std::size_t count = in.count("samples", 2 * joints.size());
    std::vector<std::int16_t> rotations(4 * joints.size() * count);
    in.shorts(rotations.data(), rotations.size());
    std::vector<JointSample> samples(joints.size() * count);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const std::int16_t* const q = &rotations[4 * i];
        samples[i].rotation = glm::dquat(q[0] / kUnit, q[1] / kUnit, q[2] / kUnit, q[3] / kUnit);
    }
    const std::size_t moving = in.count("moving joints", 1 + 4 * count);
    for (std::size_t k = 0; k < moving; ++k) {
        const std::size_t j = in.word();
        if (j >= joints.size()) in.fail("it moves a joint that is not there");
        for (std::size_t i = 0; i < count; ++i) {
            JointSample& sample = samples[i * joints.size() + j];
            sample.translation = readVector(in);
            sample.scale = in.real();
        }
    }
    return SampledClip::create(name, joints, samples, step);
}

void packGait(BlockWriter& out, const Gaits::Gait& gait) {
    out.put(std::uint32_t{gait.clip ? 1u : 0u});
    if (!gait.clip) return;
    packClip(out, *gait.clip);
    out.put(gait.stride);
    for (const Gaits::Contact& contact : gait.contacts) {
        out.put(contact.begin);
        out.put(contact.end);
    }
}

Gaits::Gait unpackGait(BlockReader& in, const std::vector<SampledClip::Joint>& joints) {
    Gaits::Gait gait;
    if (in.word() == 0) return gait;
    gait.clip = unpackClip(in, joints);
    gait.stride = in.longReal();
    for (Gaits::Contact& contact : gait.contacts) {
        contact.begin = in.longReal();
        contact.end = in.longReal();
    }
    return gait;
}

bool checkSet(const Gaits& gaits) {
    return gaits.get().standing != nullptr;
}

/// Number of joints, and of each: parent, name, centre (doubles); the clips and gaits; of each leg
/// its joints and sole; the lowest joint of the upper body; the matrix; the direction.
bool writeSet(osgDB::OutputStream& os, const Gaits& gaits) {
    const Gaits::Set& set = gaits.get();
    BlockWriter out;
    out.put(set.standing->joints().size());
    for (const SampledClip::Joint& joint : set.standing->joints()) {
        out.put(static_cast<std::uint32_t>(joint.parent));
        out.put(joint.name);
        out.putVector(joint.centre);
    }
    packClip(out, *set.standing);
    packGait(out, set.walking);
    packGait(out, set.running);
    out.put(set.others.size());
    for (const auto& other : set.others) packClip(out, *other);
    for (const Gaits::Leg& leg : set.legs) {
        out.put(leg.hip);
        out.put(leg.knee);
        out.put(leg.ankle);
        out.put(leg.toe);
        for (const glm::dvec3& point : {leg.heel, leg.ball, leg.tip}) out.putVector(point);
    }
    out.put(set.upperBody);
    for (int i = 0; i < 16; ++i) out.put(set.toWalker.ptr()[i]);
    out.put(set.facing);
    writeWords(os, out.words);
    return true;
}

Gaits::Set unpackSet(const std::vector<std::uint32_t>& words) {
    BlockReader in(words, "gaits");
    Gaits::Set set;
    std::vector<SampledClip::Joint> joints(in.count("joints", 8));
    for (SampledClip::Joint& joint : joints) {
        joint.parent = static_cast<int>(in.word());
        joint.name = in.text();
        joint.centre = in.longVector();
    }
    if (joints.empty()) in.fail("no joint");
    set.standing = unpackClip(in, joints);
    set.walking = unpackGait(in, joints);
    set.running = unpackGait(in, joints);
    set.others.resize(in.count("clips", 4));
    for (auto& other : set.others) other = unpackClip(in, joints);
    for (Gaits::Leg& leg : set.legs) {
        leg.hip = in.word();
        leg.knee = in.word();
        leg.ankle = in.word();
        leg.toe = in.word();
        for (glm::dvec3* point : {&leg.heel, &leg.ball, &leg.tip}) *point = in.longVector();
    }
    set.upperBody = in.word();
    for (int i = 0; i < 16; ++i) set.toWalker.ptr()[i] = in.longReal();
    set.facing = in.longReal();
    if (!in.atEnd()) in.fail("it goes on after its end");
    return set;
}

bool readSet(osgDB::InputStream& is, Gaits& gaits) {
    std::vector<std::uint32_t> words;
    if (!readWords(is, words)) return false;
    // Files of one figure, as a simulator has one for each person, share its clips.
    using Known = osgSkin::SharedObjects<Gaits>;
    osgSkin::ContentHash content;
    content.add(words.data(), words.size() * sizeof words[0]);
    try {
        const osg::ref_ptr<Gaits> same = Known::instance().find(content);
        gaits.set(same ? same->get() : unpackSet(words));
        Known::instance().add(content, &gaits, [](const Gaits&) { return true; });
    } catch (const std::exception& error) {
        is.throwException(std::string("osgSkin: ") + error.what()); // refuses the whole file
        return false;
    }
    return true;
}

} // namespace

REGISTER_OSGSKIN_WRAPPER(osgSkinMotion_Gaits, new osgSkin::Gaits, osgSkinMotion::Gaits,
                         "osg::Object osgSkinMotion::Gaits") {
    addFileVersion(*wrapper);
    ADD_USER_SERIALIZER(Set);
}
