// SPDX-License-Identifier: MIT
#include "words/CorrectivesWords.h"

namespace osgSkin {
namespace {

// Flags of a block.
constexpr std::uint32_t kNormals = 1, kInputs = 2;

void putList(const std::vector<double>& numbers, WordWriter& out) {
    out.put(numbers.size());
    for (const double number : numbers) out.put(number);
}

std::vector<double> takeList(WordReader& in, const char* what) {
    std::vector<double> numbers(in.count(what, 2));
    for (double& number : numbers) number = in.longReal();
    return numbers;
}

/// Two a word, the first one lower.
void putShares(const std::int16_t* shares, std::size_t count, WordWriter& out) {
    for (std::size_t i = 0; i < count; i += 2) {
        std::uint32_t word = static_cast<std::uint16_t>(shares[i]);
        if (i + 1 < count) word |= std::uint32_t{static_cast<std::uint16_t>(shares[i + 1])} << 16;
        out.put(word);
    }
}

void takeShares(WordReader& in, std::size_t count, std::vector<std::int16_t>& shares) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < count; ++i) {
        word = i % 2 == 0 ? in.word() : word >> 16;
        shares.push_back(static_cast<std::int16_t>(static_cast<std::uint16_t>(word & 0xffffu)));
    }
}

CorrectiveJoint takeJoint(WordReader& in) {
    CorrectiveJoint joint;
    joint.joint = in.word();
    joint.basis = static_cast<CorrectiveJoint::Basis>(in.word());
    joint.axis = in.longVector();
    for (glm::dvec2* range : {&joint.low, &joint.high}) {
        range->x = in.longReal();
        range->y = in.longReal();
    }
    joint.knots = takeList(in, "knots");
    joint.modes = in.word();
    joint.coefficients = takeList(in, "coefficients");
    joint.normalScales = takeList(in, "scales of normals");
    if (joint.modes > CorrectiveJoint::kMostModes)
        WordReader::fail("correctives have " + std::to_string(joint.modes) + " modes, expected " +
                         std::to_string(CorrectiveJoint::kMostModes) + " at most");
    return joint;
}

} // namespace

void putCorrectives(const Correctives& correctives, WordWriter& out) {
    out.put(std::uint32_t{(correctives.hasNormals() ? kNormals : 0u) |
                          (correctives.inputs.empty() ? 0u : kInputs)});
    if (!correctives.inputs.empty()) out.put(correctives.inputs.size());
    for (const std::string& input : correctives.inputs) out.put(input);
    out.put(correctives.joints.size());
    for (const CorrectiveJoint& joint : correctives.joints) {
        out.put(joint.joint);
        out.put(static_cast<std::uint32_t>(joint.basis));
        out.putVector(joint.axis);
        for (const glm::dvec2& range : {joint.low, joint.high}) {
            out.put(range.x);
            out.put(range.y);
        }
        putList(joint.knots, out);
        out.put(joint.modes);
        putList(joint.coefficients, out);
        putList(joint.normalScales, out);
    }
    for (std::size_t v = 0; v + 1 < correctives.firstEntry.size(); ++v) {
        const std::uint32_t first = correctives.firstEntry[v], end = correctives.firstEntry[v + 1];
        out.put(end - first);
        for (std::uint32_t i = first; i < end; ++i) {
            const Correctives::Entry& entry = correctives.entries[i];
            const std::size_t count = correctives.sharesOf(entry.joint);
            out.put(entry.joint);
            putShares(&correctives.shares[entry.firstShare], count, out);
            if (correctives.hasNormals())
                putShares(&correctives.normalShares[entry.firstShare], count, out);
        }
    }
}

Correctives takeCorrectives(WordReader& in, std::uint32_t vertexCount) {
    Correctives result;
    const std::uint32_t flags = in.word();
    if (flags & ~(kNormals | kInputs))
        WordReader::fail("its correctives have a flag that is not known");
    const std::uint32_t inputs = flags & kInputs ? in.count("inputs", 1) : 0;
    for (std::uint32_t i = 0; i < inputs; ++i) result.inputs.push_back(in.text());
    const std::uint32_t joints = in.count("correctives' joints", 20);
    for (std::uint32_t j = 0; j < joints; ++j) result.joints.push_back(takeJoint(in));
    result.firstEntry.push_back(0);
    for (std::uint32_t v = 0; v < vertexCount; ++v) {
        const std::uint32_t entries = in.count("correctives", 2);
        for (std::uint32_t i = 0; i < entries; ++i) {
            const std::uint32_t joint = in.word();
            if (joint >= joints) WordReader::fail("correctives name no joint's modes");
            result.entries.push_back({joint, static_cast<std::uint32_t>(result.shares.size())});
            takeShares(in, result.sharesOf(joint), result.shares);
            if (flags & kNormals) takeShares(in, result.sharesOf(joint), result.normalShares);
        }
        result.firstEntry.push_back(static_cast<std::uint32_t>(result.entries.size()));
    }
    return result;
}

} // namespace osgSkin
