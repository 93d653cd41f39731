// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SAVEDSTREAM_H
#define OSGSKINIMPORT_SAVEDSTREAM_H 1

#include <osg/Object>
#include <osgDB/InputStream>

#include <string>
#include <vector>

namespace osgSkin {

/// OSG's reader of saved files, with what it has read so far for SavedInput to see.
class SavedStream : public osgDB::InputStream {
public:
    explicit SavedStream(const osgDB::Options* options) : osgDB::InputStream(options) {}

    /// The classes whose fields are being read, the innermost last.
    const std::vector<std::string>& fields() const { return _fields; }
    const IdentifierMap& objects() const { return _identifierMap; }
};

} // namespace osgSkin

#endif
