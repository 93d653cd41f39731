// SPDX-License-Identifier: MIT
#include "serialize/SkinModelBlock.h"

#include "model/CorrectiveBlocks.h"
#include "model/GradientBlocks.h"
#include "model/SkinBlocks.h"

#include <osgSkin/Correctives>
#include <osgSkin/Error>

#include <glm/vec3.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

/// Reads words, never past the end, and never allocates more than the words need.
class BlockReader {
public:
    explicit BlockReader(const std::vector<std::uint32_t>& words) : _words(words) {}

    std::uint32_t word() {
        if (_next == _words.size()) fail("it ends too early");
        return _words[_next++];
    }
    /// A count of items of at least `size` words each.
    std::uint32_t count(const char* what, std::size_t size) {
        const std::uint32_t number = word();
        if (number > (_words.size() - _next) / size)
            fail(std::to_string(number) + " " + what + " have no room in it");
        return number;
    }
    float real() {
        const std::uint32_t bits = word();
        float value;
        std::memcpy(&value, &bits, sizeof value);
        return value;
    }
    double longReal() {
        const std::uint64_t low = word();
        const std::uint64_t bits = low | (std::uint64_t{word()} << 32);
        double value;
        std::memcpy(&value, &bits, sizeof value);
        return value;
    }
    glm::dvec3 longVector() {
        const double x = longReal();
        const double y = longReal();
        return {x, y, longReal()};
    }
    std::string text() {
        const std::uint32_t size = word();
        if (size > 4 * (_words.size() - _next)) fail("a name has no room in it");
        std::string result;
        std::uint32_t bytes = 0;
        for (std::uint32_t i = 0; i < size; ++i, bytes >>= 8) {
            if (i % 4 == 0) bytes = word();
            result.push_back(static_cast<char>(bytes & 0xffu));
        }
        return result;
    }
    [[noreturn]] static void fail(const std::string& what) {
        throw Error("skin model block: " + what);
    }
    bool atEnd() const { return _next == _words.size(); }

private:
    const std::vector<std::uint32_t>& _words;
    std::size_t _next = 0;
};

/// Writes numbers and text as 32-bit words, without loss.
class BlockWriter {
public:
    std::vector<std::uint32_t> words;

    void put(std::uint32_t word) { words.push_back(word); }
    void put(std::size_t count) { words.push_back(static_cast<std::uint32_t>(count)); }
    void put(float value) {
        std::uint32_t word;
        std::memcpy(&word, &value, sizeof word);
        words.push_back(word);
    }
    void put(double value) {
        std::uint64_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        words.push_back(static_cast<std::uint32_t>(bits));
        words.push_back(static_cast<std::uint32_t>(bits >> 32));
    }
    template <typename Vector>
    void putVector(const Vector& v) {
        put(v.x);
        put(v.y);
        put(v.z);
    }
    void put(const std::string& text) {
        put(text.size());
        for (std::size_t i = 0; i < text.size(); ++i) {
            if (i % 4 == 0) words.push_back(0);
            words.back() |= std::uint32_t{static_cast<unsigned char>(text[i])} << (8 * (i % 4));
        }
    }
};

// Flags of correctives.
constexpr std::uint32_t kNormals = 1, kInputs = 2;

void putList(const std::vector<double>& numbers, BlockWriter& out) {
    out.put(numbers.size());
    for (const double number : numbers) out.put(number);
}

std::vector<double> takeList(BlockReader& in, const char* what) {
    std::vector<double> numbers(in.count(what, 2));
    for (double& number : numbers) number = in.longReal();
    return numbers;
}

/// Two per word, the lower half first.
void putShares(const std::int16_t* shares, std::size_t count, BlockWriter& out) {
    for (std::size_t i = 0; i < count; i += 2) {
        std::uint32_t word = static_cast<std::uint16_t>(shares[i]);
        if (i + 1 < count) word |= std::uint32_t{static_cast<std::uint16_t>(shares[i + 1])} << 16;
        out.put(word);
    }
}

void takeShares(BlockReader& in, std::size_t count, std::vector<std::int16_t>& shares) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < count; ++i) {
        word = i % 2 == 0 ? in.word() : word >> 16;
        shares.push_back(static_cast<std::int16_t>(static_cast<std::uint16_t>(word & 0xffffu)));
    }
}

CorrectiveJoint takeJoint(BlockReader& in) {
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
    if (joint.modes > CorrectiveJoint::kMaxModes)
        BlockReader::fail("correctives have " + std::to_string(joint.modes) + " modes, expected " +
                          std::to_string(CorrectiveJoint::kMaxModes) + " at most");
    return joint;
}

void putCorrectives(const Correctives& correctives, BlockWriter& out) {
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

/// \throw osgSkin::Error where there are too few words; Correctives::validate() checks the numbers
Correctives takeCorrectives(BlockReader& in, std::uint32_t vertexCount) {
    Correctives result;
    const std::uint32_t flags = in.word();
    if (flags & ~(kNormals | kInputs))
        BlockReader::fail("its correctives have a flag that is not known");
    const std::uint32_t inputs = flags & kInputs ? in.count("inputs", 1) : 0;
    for (std::uint32_t i = 0; i < inputs; ++i) result.inputs.push_back(in.text());
    const std::uint32_t joints = in.count("correctives' joints", 20);
    for (std::uint32_t j = 0; j < joints; ++j) result.joints.push_back(takeJoint(in));
    result.firstEntry.push_back(0);
    for (std::uint32_t v = 0; v < vertexCount; ++v) {
        const std::uint32_t entries = in.count("correctives", 2);
        for (std::uint32_t i = 0; i < entries; ++i) {
            const std::uint32_t joint = in.word();
            if (joint >= joints) BlockReader::fail("correctives name no joint's modes");
            result.entries.push_back({joint, static_cast<std::uint32_t>(result.shares.size())});
            takeShares(in, result.sharesOf(joint), result.shares);
            if (flags & kNormals) takeShares(in, result.sharesOf(joint), result.normalShares);
        }
        result.firstEntry.push_back(static_cast<std::uint32_t>(result.entries.size()));
    }
    return result;
}

std::vector<glm::vec3> readVectors(BlockReader& in, std::uint32_t count) {
    std::vector<glm::vec3> vectors(count);
    for (glm::vec3& vector : vectors)
        for (glm::length_t axis = 0; axis < 3; ++axis) vector[axis] = in.real();
    return vectors;
}

BoundJoint readJoint(BlockReader& in) {
    BoundJoint joint;
    joint.parent = static_cast<int>(in.word());
    joint.name = in.text();
    joint.centre = in.longVector();
    joint.boneAxis = in.longVector();
    joint.twistAxis = in.longVector();
    return joint;
}

void putGradients(const Binding& binding, BlockWriter& out) {
    for (std::size_t i = 0; i < binding.influences.size(); ++i) {
        if (!binding.influences[i].isPartial()) continue;
        out.putVector(binding.gradients[i].bend);
        out.putVector(binding.gradients[i].twist);
    }
}

std::vector<RatioGradient> takeGradients(BlockReader& in,
                                         const std::vector<Influence>& influences) {
    std::vector<RatioGradient> gradients(influences.size());
    for (std::size_t i = 0; i < influences.size(); ++i) {
        if (!influences[i].isPartial()) continue;
        for (glm::vec3* vector : {&gradients[i].bend, &gradients[i].twist})
            for (glm::length_t axis = 0; axis < 3; ++axis) (*vector)[axis] = in.real();
    }
    return gradients;
}

} // namespace

Binding bindingOf(const SkinModel& model) {
    // By vertex first: groups have their own order of vertices, and of joints (productOrder()).
    std::vector<std::vector<std::pair<Influence, RatioGradient>>> influences(model.vertexCount());
    const std::vector<RatioGradient> grouped = gradientsOf(model);
    auto gradient = grouped.begin();
    for (const SkinModel::Group& group : model.groups()) {
        const SkinModel::Ratio* ratio = model.ratios().data() + group.firstRatio;
        for (std::uint32_t i = 0; i < group.vertexCount; ++i) {
            auto& list = influences[model.order()[group.firstVertex + i]];
            for (std::uint32_t k = 0; k < group.linkCount; ++k) {
                const SkinModel::Link& link = model.links()[group.firstLink + k];
                const SkinModel::Ratio own = link.partial ? *ratio++ : SkinModel::Ratio{1.0f, 1.0f};
                const RatioGradient slope = grouped.empty() ? RatioGradient{} : *gradient++;
                if (own.bend == 0.0f && own.twist == 0.0f) continue; // an influence of others
                list.push_back({{link.joint, own.bend, own.twist}, slope});
            }
            std::sort(list.begin(), list.end(),
                      [](const auto& a, const auto& b) { return a.first.joint < b.first.joint; });
        }
    }
    Binding binding;
    binding.joints = model.joints();
    binding.firstInfluence.push_back(0);
    for (const auto& list : influences) {
        std::uint32_t region = 0;
        for (const auto& [influence, slope] : list) {
            if (influence.bend >= 0.5f) region = influence.joint;
            binding.influences.push_back(influence);
            if (!grouped.empty()) binding.gradients.push_back(slope);
        }
        binding.regions.push_back(region);
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
    }
    binding.correctives = correctivesOf(model);
    return binding;
}

std::vector<std::uint32_t> packSkinModel(const SkinModel& model) {
    const Binding binding = bindingOf(model);
    BlockWriter out;
    // The earliest version that suffices, for older programs.
    const bool corrected = !binding.correctives.empty();
    const bool sloped = !binding.gradients.empty();
    out.put(sloped ? kSkinModelBlockVersion : std::uint32_t{corrected ? 2u : 1u});
    out.put(binding.joints.size());
    for (const BoundJoint& joint : binding.joints) {
        out.put(static_cast<std::uint32_t>(joint.parent));
        out.put(joint.name);
        out.putVector(joint.centre);
        out.putVector(joint.boneAxis);
        out.putVector(joint.twistAxis);
    }
    out.put(model.vertexCount());
    for (const glm::vec3& position : model.positions()) out.putVector(position);
    for (const glm::vec3& normal : model.normals()) out.putVector(normal);
    for (std::size_t v = 0; v < model.vertexCount(); ++v) {
        const std::uint32_t first = binding.firstInfluence[v];
        const std::uint32_t end = binding.firstInfluence[v + 1];
        out.put(end - first);
        for (std::uint32_t i = first; i < end; ++i) {
            out.put(binding.influences[i].joint);
            out.put(binding.influences[i].bend);
            out.put(binding.influences[i].twist);
        }
    }
    if (sloped) {
        putGradients(binding, out);
        out.put(std::uint32_t{corrected ? 1u : 0u});
    }
    if (corrected) putCorrectives(binding.correctives, out);
    return out.words;
}

osg::ref_ptr<const SkinModel> unpackSkinModel(const std::vector<std::uint32_t>& words) {
    BlockReader in(words);
    const std::uint32_t version = in.word();
    if (version < 1 || version > kSkinModelBlockVersion)
        in.fail("it has version " + std::to_string(version) + ", expected 1 to " +
                std::to_string(kSkinModelBlockVersion));
    Binding binding;
    const std::uint32_t joints = in.count("joints", 20);
    for (std::uint32_t j = 0; j < joints; ++j) binding.joints.push_back(readJoint(in));
    const std::uint32_t vertices = in.count("vertices", 10);
    if (vertices == 0) in.fail("it has no vertex");
    std::vector<glm::vec3> positions = readVectors(in, vertices);
    std::vector<glm::vec3> normals = readVectors(in, vertices);
    std::vector<std::uint32_t> source;
    binding.firstInfluence.push_back(0);
    for (std::uint32_t v = 0; v < vertices; ++v) {
        const std::uint32_t influences = in.count("influences", 3);
        for (std::uint32_t i = 0; i < influences; ++i) {
            Influence influence;
            influence.joint = in.word();
            influence.bend = in.real();
            influence.twist = in.real();
            binding.influences.push_back(influence);
        }
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
        binding.regions.push_back(0);
        source.push_back(v);
    }
    if (version >= 3) {
        binding.gradients = takeGradients(in, binding.influences);
        const std::uint32_t corrected = in.word();
        if (corrected > 1) in.fail("it has neither correctives nor none");
        if (corrected == 1) binding.correctives = takeCorrectives(in, vertices);
    }
    if (version == 2) binding.correctives = takeCorrectives(in, vertices);
    if (!in.atEnd()) in.fail("there is more in it than a model");
    // create() checks numbers, indices, ratios, axes and the joints' hierarchy.
    return SkinModel::create(binding, std::move(positions), std::move(normals), source);
}

void unpackSkinModel(const std::vector<std::uint32_t>& words, SkinModel& empty) {
    if (empty.vertexCount() > 0) BlockReader::fail("the model to be filled is not empty");
    SkinModelAccess::fill(empty, *unpackSkinModel(words));
}

} // namespace osgSkin
