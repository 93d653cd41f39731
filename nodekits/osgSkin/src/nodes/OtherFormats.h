// SPDX-License-Identifier: MIT
//
// Plug-ins of osgDB that write formats of others (OBJ, STL, ...) read osg::Geometry alone, some of
// them only in an osg::Geode.
#ifndef OSGSKIN_NODES_OTHERFORMATS_H
#define OSGSKIN_NODES_OTHERFORMATS_H 1

#include <osg/Geode>
#include <osg/Geometry>
#include <osg/NodeVisitor>

#include <algorithm>
#include <iterator>
#include <string>
#include <typeinfo>

namespace osgSkin {

/// Whether a visitor belongs to such a plug-in.
inline bool writesOtherFormat(const osg::NodeVisitor& nv) {
    if (nv.getVisitorType() != osg::NodeVisitor::NODE_VISITOR) return false;
    const std::string type = typeid(nv).name();
    constexpr const char* kWriters[] = {"WriterNodeVisitor", // OBJ, 3DS, DXF, POV
                                        "StlVisitor", "FltExportVisitor", "daeWriter"};
    return std::any_of(std::begin(kWriters), std::end(kWriters),
                       [&](const char* name) { return type.find(name) != std::string::npos; });
}

/// Gives such a visitor a geometry.
/// \param owner its name and state set are the geometry's
inline void writeGeometry(const osg::Geometry& geometry, const osg::Node& owner,
                          osg::NodeVisitor& nv) {
    const osg::ref_ptr<osg::Geometry> shown = new osg::Geometry(geometry);
    shown->setName(owner.getName());
    shown->setStateSet(const_cast<osg::StateSet*>(owner.getStateSet())); // which it only reads
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(shown);
    geode->accept(nv);
}

} // namespace osgSkin

#endif
