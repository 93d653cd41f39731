// SPDX-License-Identifier: MIT
#include "RegisterWrapper.h"
#include "SavedPose.h"
#include "serialize/SkinModelBlock.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/ShareEqualData>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <glm/gtc/type_ptr.hpp>

#include <exception>
#include <vector>

namespace {

bool fail(osgDB::InputStream& is, const osgSkin::DeformableSkin& skin, const std::string& what) {
    // The exception rejects the whole file, and osgDB prints the reason. Keep the first one.
    if (!is.getException())
        is.throwException("osgSkin: skin \"" + skin.getName() + "\" has " + what);
    return false;
}

bool checkSkin(const osgSkin::DeformableSkin& skin) {
    return skin.getModel() != nullptr;
}

/// From this file version on, osg::Node writes properties that osg::Drawable wrote before.
constexpr int kNodesWriteCallbacks = 156;

bool writeSkin(osgDB::OutputStream& os, const osgSkin::DeformableSkin& skin) {
    // OSG marks text files with its current version, even if their contents have an older one.
    if (!os.isBinary() && os.getFileVersion() < kNodesWriteCallbacks)
        os.throwException("skin \"" + skin.getName() + "\": text for version " +
                          std::to_string(os.getFileVersion()) +
                          " could not be read again, expected a TargetFileVersion of " +
                          std::to_string(kNodesWriteCallbacks) + " or more, or .osgb");
    os << os.BEGIN_BRACKET << std::endl;
    os << skin.getRestGeometry();
    os << skin.getModel();
    os << os.END_BRACKET << std::endl;
    return true;
}

bool readSkin(osgDB::InputStream& is, osgSkin::DeformableSkin& skin) {
    is >> is.BEGIN_BRACKET;
    const osg::ref_ptr<osg::Geometry> rest = is.readObjectOfType<osg::Geometry>();
    const osg::ref_ptr<const osgSkin::SkinModel> model =
        osgSkin::unpackedModel(is.readObjectOfType<osgSkin::SkinModel>().get());
    is >> is.END_BRACKET;
    if (is.getException()) return false;
    if (!rest) return fail(is, skin, "no rest geometry");
    if (!model) return fail(is, skin, "no skin model");
    // The state set was read with osg::Node's properties, and may differ from the geometry's.
    const osg::ref_ptr<osg::StateSet> stateSet = skin.getStateSet();
    osgSkin::shareEqualArrays(*rest);
    try {
        skin.setSkin(rest, model);
    } catch (const std::exception& error) {
        return fail(is, skin, std::string("parts that do not fit: ") + error.what());
    }
    skin.setStateSet(stateSet);
    return true;
}

bool checkTangents(const osgSkin::DeformableSkin& skin) {
    return skin.getTangentAttribute() >= 0;
}

bool writeTangents(osgDB::OutputStream& os, const osgSkin::DeformableSkin& skin) {
    os << skin.getTangentAttribute() << std::endl;
    return true;
}

bool readTangents(osgDB::InputStream& is, osgSkin::DeformableSkin& skin) {
    int attribute = -1;
    is >> attribute;
    if (is.getException()) return false;
    try {
        skin.setTangentAttribute(attribute);
    } catch (const std::exception& error) {
        return fail(is, skin, std::string("tangents that cannot be used: ") + error.what());
    }
    return true;
}

bool checkPose(const osgSkin::DeformableSkin& skin) {
    return skin.getModel() != nullptr;
}

/// Writes the skinning matrices: the pose shown before the first update traversal.
bool writePose(osgDB::OutputStream& os, const osgSkin::DeformableSkin& skin) {
    const std::vector<glm::dmat4> skinning = skin.getPose().skinning();
    os.writeSize(static_cast<unsigned int>(skinning.size()));
    os << os.BEGIN_BRACKET << std::endl;
    for (const glm::dmat4& matrix : skinning) {
        // As single numbers, because .osgx cannot nest a matrix's brackets in a list.
        for (int i = 0; i < 16; ++i) os << glm::value_ptr(matrix)[i];
        os << std::endl;
    }
    os << os.END_BRACKET << std::endl;
    return true;
}

bool readPose(osgDB::InputStream& is, osgSkin::DeformableSkin& skin) {
    const std::size_t joints = skin.getPose().size();
    unsigned int size = 0;
    is >> size >> is.BEGIN_BRACKET;
    if (size != joints)
        return fail(is, skin,
                    "a pose of " + std::to_string(size) + " joints, expected its " +
                        std::to_string(joints));
    std::vector<glm::dmat4> skinning;
    for (unsigned int j = 0; j < size; ++j) {
        glm::dmat4 matrix(0.0);
        for (int i = 0; i < 16; ++i) is >> glm::value_ptr(matrix)[i];
        if (is.getException()) return false;
        const std::string wrong = whatIsWrongWith(matrix);
        if (!wrong.empty())
            return fail(is, skin,
                        "a pose whose joint \"" + skin.getModel()->joints()[j].name +
                            "\" has a matrix " + wrong);
        skinning.push_back(matrix);
    }
    is >> is.END_BRACKET;
    if (is.getException()) return false;
    if (!skin.setPose(skinning.data(), skinning.size()))
        return fail(is, skin, "a pose with a matrix that is no transform");
    return true;
}

} // namespace

REGISTER_OSGSKIN_WRAPPER(osgSkin_DeformableSkin, new osgSkin::DeformableSkin,
                         osgSkin::DeformableSkin,
                         "osg::Object osg::Node osg::Drawable osgSkin::DeformableSkin") {
    ADD_BOOL_SERIALIZER(Eager, false);
    ADD_USER_SERIALIZER(Skin);
    ADD_USER_SERIALIZER(Tangents);
    ADD_USER_SERIALIZER(Pose);
}
