// SPDX-License-Identifier: MIT
#include "model/SkinModelBlock.h"

#include "model/SkinModelAccess.h"

#include <osgSkin/Error>

#include <cmath>
#include <cstring>

namespace osgSkin {
namespace {

class WordWriter {
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

[[noreturn]] void fail(const std::string& what) {
    throw Error("skin model block: " + what);
}

/// Takes words one by one; never past the end, and never more memory than the words that are there.
class WordReader {
public:
    explicit WordReader(const std::vector<std::uint32_t>& words) : _words(words) {}

    std::uint32_t word() {
        if (_next == _words.size()) fail("it ends too early");
        return _words[_next++];
    }
    /// A count of things that take at least `size` words each.
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
        if (size > 4 * (_words.size() - _next)) fail("a joint's name has no room in it");
        std::string result;
        std::uint32_t bytes = 0;
        for (std::uint32_t i = 0; i < size; ++i, bytes >>= 8) {
            if (i % 4 == 0) bytes = word();
            result.push_back(static_cast<char>(bytes & 0xffu));
        }
        return result;
    }
    bool atEnd() const { return _next == _words.size(); }

private:
    const std::vector<std::uint32_t>& _words;
    std::size_t _next = 0;
};

std::vector<glm::vec3> readVectors(WordReader& in, std::uint32_t count, const char* what) {
    std::vector<glm::vec3> vectors(count);
    for (std::uint32_t v = 0; v < count; ++v)
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            vectors[v][axis] = in.real();
            if (!std::isfinite(vectors[v][axis]))
                fail("vertex " + std::to_string(v) + " has a " + what + " that is not finite");
        }
    return vectors;
}

BoundJoint readJoint(WordReader& in) {
    BoundJoint joint;
    joint.parent = static_cast<int>(in.word());
    joint.name = in.text();
    joint.centre = in.longVector();
    joint.boneAxis = in.longVector();
    joint.twistAxis = in.longVector();
    return joint;
}

} // namespace

Binding bindingOf(const SkinModel& model) {
    // Per vertex first: groups list their vertices in an order of their own.
    std::vector<std::vector<Influence>> influences(model.vertexCount());
    for (const SkinModel::Group& group : model.groups()) {
        const SkinModel::Ratio* ratio = model.ratios().data() + group.firstRatio;
        for (std::uint32_t i = 0; i < group.vertexCount; ++i) {
            std::vector<Influence>& list = influences[model.order()[group.firstVertex + i]];
            for (std::uint32_t k = 0; k < group.linkCount; ++k) {
                const SkinModel::Link& link = model.links()[group.firstLink + k];
                list.push_back({link.joint, link.partial ? ratio->bend : 1.0f,
                                link.partial ? ratio->twist : 1.0f});
                if (link.partial) ++ratio;
            }
        }
    }
    Binding binding;
    binding.joints = model.joints();
    binding.firstInfluence.push_back(0);
    for (const std::vector<Influence>& list : influences) {
        std::uint32_t region = 0;
        for (const Influence& influence : list)
            if (influence.bend >= 0.5f) region = influence.joint;
        binding.regions.push_back(region);
        binding.influences.insert(binding.influences.end(), list.begin(), list.end());
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
    }
    return binding;
}

std::vector<std::uint32_t> packSkinModel(const SkinModel& model) {
    const Binding binding = bindingOf(model);
    WordWriter out;
    out.put(kSkinModelBlockVersion);
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
    return out.words;
}

osg::ref_ptr<const SkinModel> unpackSkinModel(const std::vector<std::uint32_t>& words) {
    WordReader in(words);
    const std::uint32_t version = in.word();
    if (version != kSkinModelBlockVersion)
        fail("it has version " + std::to_string(version) + ", expected " +
             std::to_string(kSkinModelBlockVersion));
    Binding binding;
    const std::uint32_t joints = in.count("joints", 20);
    for (std::uint32_t j = 0; j < joints; ++j) binding.joints.push_back(readJoint(in));
    const std::uint32_t vertices = in.count("vertices", 10);
    if (vertices == 0) fail("it has no vertex");
    std::vector<glm::vec3> positions = readVectors(in, vertices, "position");
    std::vector<glm::vec3> normals = readVectors(in, vertices, "normal");
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
    if (!in.atEnd()) fail("there is more in it than a model");
    // Indices, ratios, axes and the tree of joints are checked there.
    return SkinModel::create(binding, std::move(positions), std::move(normals), source);
}

void unpackSkinModel(const std::vector<std::uint32_t>& words, SkinModel& empty) {
    if (empty.vertexCount() > 0) fail("the model to be filled is not empty");
    SkinModelAccess::fill(empty, *unpackSkinModel(words));
}

} // namespace osgSkin
