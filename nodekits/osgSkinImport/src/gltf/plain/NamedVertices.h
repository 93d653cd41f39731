// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_NAMEDVERTICES_H
#define OSGSKINIMPORT_NAMEDVERTICES_H 1

#include "gltf/plain/GltfParts.h"

#include <cstddef>
#include <map>
#include <utility>

namespace osgSkin {

/// How many vertices the corners of a glTF file's primitives name. A primitive of one material
/// often names a few of the vertices that all of a body's share.
class NamedVertices {
public:
    /// \param parts must outlive this; its accessors have been checked
    explicit NamedVertices(const GltfParts& parts) : _parts(parts) {}

    /// \param accessor of whole numbers, checked
    /// \param vertices that there are
    /// \return at most so many, and as many as are named; where they are not to be read as they
    ///         stand, at most as many as the accessor has numbers
    std::size_t count(std::size_t accessor, std::size_t vertices);

private:
    std::size_t counted(std::size_t accessor, std::size_t vertices) const;

    const GltfParts& _parts;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> _known;
};

} // namespace osgSkin

#endif
