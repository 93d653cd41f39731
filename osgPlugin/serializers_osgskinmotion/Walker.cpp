// SPDX-License-Identifier: MIT
#include "FileVersion.h"
#include "RegisterWrapper.h"

#include <osgSkinMotion/Walker>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <exception>
#include <string>

namespace osgSkinMotion {
using osgSkin::Walker; // osgDB knows classes by their libraries
} // namespace osgSkinMotion

namespace {

bool checkGaits(const osgSkin::Walker& walker) {
    return walker.getGaits() != nullptr;
}

bool writeGaits(osgDB::OutputStream& os, const osgSkin::Walker& walker) {
    os << os.BEGIN_BRACKET << std::endl;
    os << walker.getGaits();
    os << os.END_BRACKET << std::endl;
    return true;
}

/// After the children, which the gaits pose.
bool readGaits(osgDB::InputStream& is, osgSkin::Walker& walker) {
    is >> is.BEGIN_BRACKET;
    const osg::ref_ptr<osgSkin::Gaits> gaits = is.readObjectOfType<osgSkin::Gaits>();
    is >> is.END_BRACKET;
    if (is.getException()) return false;
    try {
        walker.setGaits(gaits);
    } catch (const std::exception& error) {
        is.throwException(std::string("osgSkin: ") + error.what()); // refuses the whole file
        return false;
    }
    return true;
}

} // namespace

REGISTER_OSGSKIN_WRAPPER(osgSkinMotion_Walker, new osgSkin::Walker, osgSkinMotion::Walker,
                         "osg::Object osg::Node osg::Group osgSkinMotion::Walker") {
    addFileVersion(*wrapper);
    ADD_DOUBLE_SERIALIZER(Step, 0.0);
    ADD_USER_SERIALIZER(Gaits);
}
