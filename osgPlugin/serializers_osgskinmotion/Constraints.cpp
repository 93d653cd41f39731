// SPDX-License-Identifier: MIT
// Callbacks have virtual bases, for which the wrapper's default cast does not compile.
#undef OBJECT_CAST
#define OBJECT_CAST dynamic_cast

#include "BlockRows.h"
#include "FileVersion.h"
#include "RegisterWrapper.h"
#include "serialize/BlockWords.h"

#include <osgSkinMotion/Constraints>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <exception>
#include <string>
#include <utility>
#include <vector>

namespace osgSkinMotion {
using osgSkin::Constraints; // osgDB knows classes by their libraries
} // namespace osgSkinMotion

namespace {

using osgSkin::BlockReader;
using osgSkin::BlockWriter;
using osgSkin::Constraint;
using osgSkin::Constraints;

bool checkList(const Constraints& constraints) {
    return !constraints.get().empty();
}

/// Number of constraints, and of each: kind, axis, weight, and of joint and source: name and three
/// rotations (w, x, y, z). All numbers are doubles.
bool writeList(osgDB::OutputStream& os, const Constraints& constraints) {
    BlockWriter out;
    out.put(constraints.get().size());
    for (const Constraint& constraint : constraints.get()) {
        out.put(static_cast<std::uint32_t>(constraint.kind));
        out.putVector(constraint.axis);
        out.put(constraint.weight);
        for (const Constraint::Joint* joint : {&constraint.joint, &constraint.source}) {
            out.put(joint->name);
            for (const glm::dquat& q : {joint->rest, joint->axes, joint->above})
                for (const double number : {q.w, q.x, q.y, q.z}) out.put(number);
        }
    }
    writeWords(os, out.words);
    return true;
}

void unpackList(const std::vector<std::uint32_t>& words, Constraints& constraints) {
    BlockReader in(words, "constraints");
    std::vector<Constraint> list(in.count("constraints", 59));
    for (Constraint& constraint : list) {
        const std::uint32_t kind = in.word();
        if (kind > 2) in.fail("a constraint is of no known kind");
        constraint.kind = static_cast<Constraint::Kind>(kind);
        constraint.axis = in.longVector();
        constraint.weight = in.longReal();
        for (Constraint::Joint* joint : {&constraint.joint, &constraint.source}) {
            joint->name = in.text();
            for (glm::dquat* q : {&joint->rest, &joint->axes, &joint->above})
                for (double* number : {&q->w, &q->x, &q->y, &q->z}) *number = in.longReal();
        }
    }
    if (!in.atEnd()) in.fail("it goes on after its end");
    constraints.set(std::move(list));
}

bool readList(osgDB::InputStream& is, Constraints& constraints) {
    std::vector<std::uint32_t> words;
    if (!readWords(is, words)) return false;
    try {
        unpackList(words, constraints);
    } catch (const std::exception& error) {
        is.throwException(std::string("osgSkin: ") + error.what()); // refuses the whole file
        return false;
    }
    return true;
}

} // namespace

REGISTER_OSGSKIN_WRAPPER(osgSkinMotion_Constraints, new osgSkin::Constraints,
                         osgSkinMotion::Constraints,
                         "osg::Object osg::Callback osg::NodeCallback osgSkinMotion::Constraints") {
    addFileVersion(*wrapper);
    ADD_USER_SERIALIZER(List);
}
