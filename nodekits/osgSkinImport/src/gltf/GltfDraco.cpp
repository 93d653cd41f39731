// SPDX-License-Identifier: MIT
// KHR_draco_mesh_compression by Google's library, which does not validate its input: for trusted
// files.
#include "gltf/GltfDocument.h"

#include "files/FileText.h"

#ifdef OSGSKIN_HAS_DRACO
#include <draco/compression/decode.h>
#endif

#include <algorithm>
#include <memory>
#include <set>
#include <string>

namespace osgSkin {

using nlohmann::json;

void countDraco(GltfFile& file) {
    constexpr std::size_t kRatio = 32;
    static const json::json_pointer place("/extensions/KHR_draco_mesh_compression/bufferView");
    const json none = json::array();
    const json views = file.json.value("bufferViews", none);
    std::set<std::size_t> packed;
    for (const json& mesh : file.json.value("meshes", none))
        for (const json& primitive : mesh.value("primitives", none))
            if (primitive.contains(place) && primitive.at(place).is_number_unsigned())
                packed.insert(primitive.at(place).get<std::size_t>());
    std::size_t bytes = 0;
    for (const std::size_t view : packed)
        if (view < views.size())
            bytes += std::min(views[view].value("byteLength", std::size_t(0)), file.allBytes());
    file.ownBytes += (kRatio - 1) * std::min(bytes, file.allBytes());
}

#ifdef OSGSKIN_HAS_DRACO

namespace {

/// All values of an attribute, vertex by vertex.
template <typename Value>
std::vector<Value> valuesOf(const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                            std::size_t width) {
    std::vector<Value> result(mesh.num_points() * width);
    for (draco::PointIndex p(0); p < mesh.num_points(); ++p)
        attribute.ConvertValue<Value>(attribute.mapped_index(p), static_cast<std::int8_t>(width),
                                      result.data() + p.value() * width);
    return result;
}

} // namespace

DracoMesh unpackDraco(const GltfDocument& document, const GltfPrimitive& primitive,
                      const std::string& where) {
    const auto fail = [&](const std::string& why) {
        failFile(document.file.path, "malformed Draco compression: " + where + ": " + why);
    };
    const std::string_view bytes = document.accessors.bytesOf(primitive.draco->view);
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    auto status = decoder.DecodeMeshFromBuffer(&buffer);
    if (!status.ok()) fail(status.status().error_msg_string());
    const std::unique_ptr<draco::Mesh> mesh = std::move(status).value();

    DracoMesh result;
    result.vertices = mesh->num_points();
    if (result.vertices != document.accessors[primitive.positions].count)
        fail(std::to_string(result.vertices) + " vertices, expected as many as the accessor of "
                                               "its positions has");
    const std::size_t corners = std::size_t{3} * mesh->num_faces();
    if (!primitive.indices || corners != document.accessors[*primitive.indices].count)
        fail(std::to_string(corners) + " corners, expected as many as the accessor of its "
                                       "indices has");
    result.corners.reserve(corners);
    for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f)
        for (const draco::PointIndex& p : mesh->face(f)) {
            if (p.value() >= result.vertices) fail("expected corners of its vertices");
            result.corners.push_back(p.value());
        }
    for (const auto& [name, id] : primitive.draco->ids) {
        const draco::PointAttribute* const attribute =
            mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
        if (attribute == nullptr) fail("expected an attribute for " + name);
        const auto width = static_cast<std::size_t>(attribute->num_components());
        if (name.rfind("JOINTS_", 0) == 0)
            result.joints[name] = valuesOf<std::uint32_t>(*mesh, *attribute, width);
        else
            result.floats[name] = valuesOf<float>(*mesh, *attribute, width);
    }
    return result;
}

#else

DracoMesh unpackDraco(const GltfDocument& document, const GltfPrimitive&,
                      const std::string& where) {
    failFile(document.file.path, "Draco compression (" + where +
                                     ") is not read by this build; save the file without it");
}

#endif

} // namespace osgSkin
