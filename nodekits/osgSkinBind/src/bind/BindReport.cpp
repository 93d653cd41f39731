// SPDX-License-Identifier: MIT
#include <osgSkinBind/BindReport>

#include <osgSkin/Error>

#include <iomanip>
#include <sstream>

namespace osgSkin {

std::string BindReport::text() const {
    std::ostringstream out;
    out << "bound by " << (boundaries.empty() ? "painted weights" : "regions") << "\n"
        << "vertices " << vertices << ", welded " << weldedVertices << ", shells " << shells
        << ", vertices on others " << layeredVertices << ", open edges " << openEdges << "\n"
        << "regions " << regions.size() << ", rejected Delaunay edges " << rejectedEdges
        << ", unassigned vertices " << unassigned << "\n"
        << std::fixed << std::setprecision(2) << "influences a vertex " << influencesPerVertex
        << ", capped vertices " << cappedVertices << ", " << std::setprecision(3) << seconds
        << " s\n";
    for (const Region& region : regions)
        out << "region " << onOneLine(region.joint) << ": " << region.vertices << " vertices, "
            << region.seeds << " seeds\n";
    for (const std::string& note : notes) out << "note: " << onOneLine(note) << "\n";
    return out.str();
}

} // namespace osgSkin
