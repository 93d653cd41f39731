// SPDX-License-Identifier: MIT
// Members of VRM's extensions, in which errors are not worth refusing a file for.
#ifndef OSGSKINIMPORT_GLTF_GLTFMEMBERS_H
#define OSGSKINIMPORT_GLTF_GLTFMEMBERS_H

#include <nlohmann/json.hpp>

#include <cstddef>

namespace osgSkin {

/// A member that is an object or a list; an empty object if there is none.
inline const nlohmann::json& memberOf(const nlohmann::json& object, const char* name) {
    static const nlohmann::json none = nlohmann::json::object();
    const auto found = object.find(name);
    return found != object.end() && found->is_structured() ? *found : none;
}

/// An index; beyond all lists if there is none.
inline std::size_t indexOf(const nlohmann::json& value) {
    return value.is_number_unsigned() ? value.get<std::size_t>() : ~std::size_t(0);
}
inline std::size_t indexOf(const nlohmann::json& object, const char* name) {
    const auto found = object.find(name);
    return found != object.end() ? indexOf(*found) : ~std::size_t(0);
}

/// A number; `otherwise` if there is none.
inline double numberOf(const nlohmann::json& object, const char* name, double otherwise) {
    const auto found = object.find(name);
    return found != object.end() && found->is_number() ? found->get<double>() : otherwise;
}

} // namespace osgSkin

#endif
