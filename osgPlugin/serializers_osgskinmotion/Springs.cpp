// SPDX-License-Identifier: MIT
// Callbacks have virtual bases, for which the wrapper's default cast does not compile.
#undef OBJECT_CAST
#define OBJECT_CAST dynamic_cast

#include "BlockRows.h"
#include "FileVersion.h"
#include "RegisterWrapper.h"
#include "serialize/BlockWords.h"

#include <osgSkinMotion/Springs>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <exception>
#include <string>
#include <utility>
#include <vector>

namespace osgSkinMotion {
using osgSkin::Springs; // osgDB knows classes by their libraries
} // namespace osgSkinMotion

namespace {

using osgSkin::BlockReader;
using osgSkin::BlockWriter;
using osgSkin::Springs;
using osgSkin::SpringSettings;

bool checkSettings(const Springs&) {
    return true;
}

/// The matrix; number of colliders, and of each: joint, start, end, radius; number of chains, and
/// of each: centre, its colliders, number of joints, and of each: name, tip, stiffness, drag,
/// radius, gravity. All numbers are doubles.
bool writeSettings(osgDB::OutputStream& os, const Springs& springs) {
    const SpringSettings& settings = springs.getSettings();
    BlockWriter out;
    for (int i = 0; i < 16; ++i) out.put(springs.getToWorld().ptr()[i]);
    out.put(settings.colliders.size());
    for (const SpringSettings::Collider& collider : settings.colliders) {
        out.put(collider.joint);
        out.putVector(collider.start);
        out.putVector(collider.end);
        out.put(collider.radius);
    }
    out.put(settings.chains.size());
    for (const SpringSettings::Chain& chain : settings.chains) {
        out.put(chain.centre);
        out.put(chain.colliders.size());
        for (const std::size_t collider : chain.colliders) out.put(collider);
        out.put(chain.joints.size());
        for (const SpringSettings::Joint& joint : chain.joints) {
            out.put(joint.name);
            out.putVector(joint.tip);
            for (const double number : {joint.stiffness, joint.drag, joint.radius}) out.put(number);
            out.putVector(joint.gravity);
        }
    }
    writeWords(os, out.words);
    return true;
}

void unpackSettings(const std::vector<std::uint32_t>& words, Springs& springs) {
    BlockReader in(words, "springs");
    osg::Matrixd toWorld;
    for (int i = 0; i < 16; ++i) toWorld.ptr()[i] = in.longReal();
    SpringSettings settings;
    settings.colliders.resize(in.count("colliders", 15));
    for (SpringSettings::Collider& collider : settings.colliders) {
        collider.joint = in.text();
        collider.start = in.longVector();
        collider.end = in.longVector();
        collider.radius = in.longReal();
    }
    settings.chains.resize(in.count("chains", 3));
    for (SpringSettings::Chain& chain : settings.chains) {
        chain.centre = in.text();
        chain.colliders.resize(in.count("colliders of a chain", 1));
        for (std::size_t& collider : chain.colliders) collider = in.word();
        chain.joints.resize(in.count("joints", 19));
        for (SpringSettings::Joint& joint : chain.joints) {
            joint.name = in.text();
            joint.tip = in.longVector();
            for (double* number : {&joint.stiffness, &joint.drag, &joint.radius})
                *number = in.longReal();
            joint.gravity = in.longVector();
        }
    }
    if (!in.atEnd()) in.fail("it goes on after its end");
    springs.set(settings, toWorld);
}

bool readSettings(osgDB::InputStream& is, Springs& springs) {
    std::vector<std::uint32_t> words;
    if (!readWords(is, words)) return false;
    try {
        unpackSettings(words, springs);
    } catch (const std::exception& error) {
        is.throwException(std::string("osgSkin: ") + error.what()); // refuses the whole file
        return false;
    }
    return true;
}

} // namespace

REGISTER_OSGSKIN_WRAPPER(osgSkinMotion_Springs, new osgSkin::Springs, osgSkinMotion::Springs,
                         "osg::Object osg::Callback osg::NodeCallback osgSkinMotion::Springs") {
    addFileVersion(*wrapper);
    ADD_USER_SERIALIZER(Settings);
    ADD_BOOL_SERIALIZER(Enabled, true);
}
