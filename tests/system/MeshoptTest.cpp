// SPDX-License-Identifier: MIT
// Files with buffer views compressed by meshopt, written by us as gltfpack does, valid and hostile.
#include "DrawnSkin.h"
#include "ExpectContains.h"
#include "WhyRefused.h"

#include "../support/GltfBuilder.h"

#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <functional>

namespace {

void encodeExponents(char* to, std::size_t count, std::size_t stride, const float* from) {
#if MESHOPTIMIZER_VERSION >= 200
    meshopt_encodeFilterExp(to, count, stride, 23, from, meshopt_EncodeExpSharedVector);
#else
    meshopt_encodeFilterExp(to, count, stride, 23, from);
#endif
}

using nlohmann::json;
using test::GltfColumn;

std::string inBase64(const std::string& bytes) {
    static const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text, padded = bytes + std::string((3 - bytes.size() % 3) % 3, '\0');
    for (std::size_t i = 0; i < padded.size(); i += 3) {
        const unsigned bits = unsigned(std::uint8_t(padded[i])) << 16 |
                              unsigned(std::uint8_t(padded[i + 1])) << 8 |
                              unsigned(std::uint8_t(padded[i + 2]));
        for (int k = 18; k >= 0; k -= 6) text.push_back(letters[bits >> k & 63u]);
    }
    for (std::size_t k = 0; k < padded.size() - bytes.size(); ++k) text[text.size() - 1 - k] = '=';
    return text;
}

/// A column whose views are all compressed, into a buffer in the text; the uncompressed buffer is
/// omitted.
struct PackedColumn : GltfColumn {
    std::string packed;

    /// \param extension name of the compression extension
    /// \param sequence whether indices are packed as a sequence instead of triangles
    void pack(const std::string& extension, bool sequence) {
        const std::size_t faces = json["meshes"][0]["primitives"][0]["indices"];
        for (std::size_t a = 0; a < json["accessors"].size(); ++a) {
            nlohmann::json& accessor = json["accessors"][a];
            nlohmann::json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
            const std::size_t count = accessor["count"];
            const std::size_t bytes = view["byteLength"];
            const char* const from = this->bytes().data() + view["byteOffset"].get<std::size_t>();
            nlohmann::json how{{"buffer", 0}, {"byteOffset", packed.size()}, {"count", count}};
            how["byteStride"] = bytes / count;
            std::string content;
            if (a == faces) {
                std::vector<unsigned int> indices(count);
                for (std::size_t i = 0; i < count; ++i) {
                    std::uint16_t index;
                    std::memcpy(&index, from + 2 * i, 2);
                    indices[i] = index;
                }
                content = packedIndices(indices, sequence);
                how["mode"] = sequence ? "INDICES" : "TRIANGLES";
            } else {
                content = packedVertices(accessor, from, count, bytes / count, how);
                how["mode"] = "ATTRIBUTES";
            }
            how["byteLength"] = content.size();
            packed += content;
            view["buffer"] = 1;
            view["extensions"][extension] = how;
        }
        json["extensionsUsed"] = json["extensionsRequired"] = {extension};
        place(extension);
    }

    /// Writes `packed` into the file.
    void place(const std::string& extension) {
        json["buffers"] = {
            {{"byteLength", packed.size()},
             {"uri", "data:application/octet-stream;base64," + inBase64(packed)}},
            {{"byteLength", bytes().size()}, {"extensions", {{extension, {{"fallback", true}}}}}}};
    }

    nlohmann::json& how(std::size_t accessor, const std::string& extension) {
        const std::size_t view = json["accessors"][accessor]["bufferView"];
        return json["bufferViews"][view]["extensions"][extension];
    }

private:
    static std::string packedIndices(const std::vector<unsigned int>& indices, bool sequence) {
        std::string result(200 + 12 * indices.size(), '\0');
        auto* const to = reinterpret_cast<unsigned char*>(result.data());
        // The triangle codec may rotate a triangle's corners; the sequence codec keeps their order.
        result.resize(
            sequence
                ? meshopt_encodeIndexSequence(to, result.size(), indices.data(), indices.size())
                : meshopt_encodeIndexBuffer(to, result.size(), indices.data(), indices.size()));
        return result;
    }

    /// Floats of matrices and positions use the exponential filter, rotations the quaternion
    /// filter.
    static std::string packedVertices(nlohmann::json& accessor, const char* from, std::size_t count,
                                      std::size_t stride, nlohmann::json& how) {
        std::string source(from, count * stride);
        std::vector<float> numbers(count * stride / 4);
        std::memcpy(numbers.data(), from, count * stride);
        if (accessor["type"] == "VEC3") {
            how["filter"] = "EXPONENTIAL";
            encodeExponents(source.data(), count, stride, numbers.data());
        } else if (accessor["type"] == "VEC4" && accessor["componentType"] == 5126 &&
                   accessor.contains("turns")) {
            how["filter"] = "QUATERNION";
            how["byteStride"] = stride = 8;
            source.resize(8 * count);
            meshopt_encodeFilterQuat(source.data(), count, 8, 16, numbers.data());
            accessor["componentType"] = 5122;
            accessor["normalized"] = true;
        }
        accessor.erase("turns");
        std::string result(meshopt_encodeVertexBufferBound(count, stride), '\0');
        result.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(result.data()),
                                                 result.size(), source.data(), count, stride));
        return result;
    }
};

constexpr char kExt[] = "EXT_meshopt_compression";

/// A bending column, compressed.
PackedColumn bent(const std::string& extension = kExt, bool sequence = false) {
    PackedColumn column;
    column.bend();
    for (json& animation : column.json["animations"])
        for (json& sampler : animation["samplers"])
            column.json["accessors"][sampler["output"].get<std::size_t>()]["turns"] = true;
    column.pack(extension, sequence);
    return column;
}

/// All vertices halfway through the motion.
std::vector<osg::Vec3d> drawn(const std::string& file) {
    osgSkin::Character character = osgSkin::loadCharacter(file);
    character.poseAt(character.motions.at(0), 0.4);
    return test::drawnVertices(character);
}

} // namespace

TEST(Meshopt, DecompressesVerticesAndIndices) {
    GltfColumn plain;
    plain.bend();
    const std::vector<osg::Vec3d> known = drawn(plain.save("meshopt_plain.gltf"));
    for (const char* extension : {kExt, "KHR_meshopt_compression"})
        for (const bool sequence : {false, true}) {
            PackedColumn column = bent(extension, sequence);
            EXPECT_LT(column.packed.size(), column.bytes().size());
            const std::vector<osg::Vec3d> found = drawn(column.save("meshopt_packed.gltf"));
            ASSERT_EQ(found.size(), known.size());
            for (std::size_t v = 0; v < known.size(); ++v)
                EXPECT_LT((found[v] - known[v]).length(), 1e-3); // rotations of 16 bits
        }
}

TEST(Meshopt, RejectsHostileFiles) {
    using Change = std::function<void(PackedColumn&)>;
    const auto set = [](const char* key, const json& value) -> Change {
        return [=](PackedColumn& column) { column.how(column.positions, kExt)[key] = value; };
    };
    const std::pair<const char*, Change> cases[] = {
        {"count that lies", set("count", 100000000)},
        {"count a little too large", set("count", 4000)},
        {"count beyond all", set("count", ~std::uint64_t(0))},
        {"negative count", set("count", -1)},
        {"stride of nothing", set("byteStride", 0)},
        {"stride of three", set("byteStride", 3)},
        {"large stride", set("byteStride", 1024)},
        {"bytes beyond the buffer", set("byteLength", 1000000)},
        {"offset beyond the buffer", set("byteOffset", ~std::uint64_t(0))},
        {"no such buffer", set("buffer", 7)},
        {"empty", set("byteLength", 0)},
        {"truncated", set("byteLength", 40)},
        {"mode of our own", set("mode", "ZIP")},
        {"indices as vertices", set("mode", "TRIANGLES")},
        {"filter of our own", set("filter", "COLOURED")},
        {"filter of another stride", set("filter", "QUATERNION")},
        {"unpacked from itself", set("buffer", 1)},
        {"noise", [](PackedColumn& column) {
             for (std::size_t i = 1; i < column.packed.size(); i += 3) column.packed[i] ^= 0x5a;
             column.place(kExt);
         }}};
    for (const auto& [name, change] : cases) {
        PackedColumn column = bent();
        change(column);
        const std::string why = test::whyRefused(column.save("meshopt_hostile.gltf"));
        test::expectContains(why, "meshopt_hostile.gltf", name);
    }
}

/// Zeros compress well, and many views decompress them again.
TEST(Meshopt, LimitsDecompressedBytesByFileSize) {
    constexpr std::size_t count = 100'000, stride = 64, bytes = count * stride;
    const std::string zeros(bytes, '\0');
    std::string packed(meshopt_encodeVertexBufferBound(count, stride), '\0');
    packed.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(packed.data()),
                                             packed.size(), zeros.data(), count, stride));
    const auto save = [&](int views) {
        PackedColumn column = bent();
        const json how = {{"buffer", 0},          {"byteOffset", column.packed.size()},
                          {"count", count},       {"byteLength", packed.size()},
                          {"byteStride", stride}, {"mode", "ATTRIBUTES"}};
        for (int i = 0; i < views; ++i)
            column.json["bufferViews"].push_back(
                {{"buffer", 1}, {"byteLength", bytes}, {"extensions", {{kExt, how}}}});
        column.packed += packed;
        column.place(kExt);
        return column.save("meshopt_shared.gltf");
    };
    EXPECT_EQ(test::whyRefused(save(1)), "read");
    const std::string many = save(20);
    test::expectContains(test::whyRefused(many),
                         "expected no more unpacked in all than the file has room "
                         "for (option maxSamples)");
    EXPECT_EQ(test::whyRefused(many, "maxSamples=10000000"), "read");
}
