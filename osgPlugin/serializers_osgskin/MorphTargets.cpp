// SPDX-License-Identifier: MIT
//
// Morph targets, and the callback that animates them.
// Callbacks have virtual bases, for which the wrapper's default cast does not compile.
#undef OBJECT_CAST
#define OBJECT_CAST dynamic_cast

#include "RegisterWrapper.h"

#include <osgSkin/MorphTargets>
#include <osgSkin/UpdateMorphs>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <exception>
#include <string>
#include <utility>
#include <vector>

namespace {

using osgSkin::MorphTarget;
using osgSkin::MorphTargets;

using Offsets = std::vector<glm::vec3> MorphTarget::*;
constexpr Offsets kOffsets[] = {&MorphTarget::positions, &MorphTarget::normals,
                                &MorphTarget::tangents};

bool checkTargets(const MorphTargets& targets) {
    return !targets.targets().empty();
}

/// A target's kinds of offsets, as bits in the order of kOffsets; then its rules, which older
/// readers leave out.
unsigned int kindsOf(const MorphTarget& target) {
    unsigned int kinds = 1u; // positions
    if (!target.normals.empty()) kinds |= 2u;
    if (!target.tangents.empty()) kinds |= 4u;
    const osgSkin::ExpressionRules& rules = target.rules;
    if (rules.isBinary) kinds |= 8u;
    return kinds | unsigned(rules.part) << 4 | unsigned(rules.blink) << 6 |
           unsigned(rules.lookAt) << 8 | unsigned(rules.mouth) << 10;
}

osgSkin::ExpressionRules rulesOf(unsigned int kinds) {
    using Override = osgSkin::ExpressionRules::Override;
    const auto two = [kinds](unsigned int shift) { return kinds >> shift & 3u; };
    const auto override = [&](unsigned int shift) { return Override(two(shift) % 3); };
    return {osgSkin::ExpressionRules::Part(two(4)), (kinds & 8u) != 0, override(6), override(8),
            override(10)};
}

/// Each vertex comes with its number plus 1; 0 ends a target. There is no count of vertices,
/// because a damaged file could make us allocate any amount of memory.
bool writeTargets(osgDB::OutputStream& os, const MorphTargets& targets) {
    os << os.BEGIN_BRACKET << std::endl;
    os << static_cast<unsigned int>(targets.vertexCount()) << std::endl;
    for (const MorphTarget& target : targets.targets()) {
        const unsigned int kinds = kindsOf(target);
        os << kinds << target.initial;
        os.writeWrappedString(target.name);
        os << std::endl;
        for (std::size_t i = 0; i < target.vertices.size(); ++i) {
            os << target.vertices[i] + 1u;
            for (unsigned int kind = 0; kind < 3; ++kind) {
                if ((kinds >> kind & 1u) == 0) continue;
                const glm::vec3& offset = (target.*kOffsets[kind])[i];
                os << offset.x << offset.y << offset.z;
            }
            os << std::endl;
        }
        os << 0u << std::endl;
    }
    os << 0u << std::endl << os.END_BRACKET << std::endl;
    return true;
}

bool readTarget(osgDB::InputStream& is, unsigned int kinds, MorphTarget& target) {
    target.rules = rulesOf(kinds);
    is >> target.initial;
    is.readWrappedString(target.name);
    while (!is.getException()) {
        unsigned int vertex = 0;
        is >> vertex;
        if (vertex == 0) break;
        target.vertices.push_back(vertex - 1);
        for (unsigned int kind = 0; kind < 3; ++kind) {
            if ((kinds >> kind & 1u) == 0) continue;
            glm::vec3 offset(0.0f);
            is >> offset.x >> offset.y >> offset.z;
            (target.*kOffsets[kind]).push_back(offset);
        }
    }
    return !is.getException();
}

bool readTargets(osgDB::InputStream& is, MorphTargets& targets) {
    std::vector<MorphTarget> read;
    unsigned int vertices = 0;
    is >> is.BEGIN_BRACKET >> vertices;
    while (!is.getException()) {
        unsigned int kinds = 0;
        is >> kinds;
        if (kinds == 0) break;
        if (!readTarget(is, kinds, read.emplace_back())) return false;
    }
    is >> is.END_BRACKET;
    if (is.getException()) return false;
    try {
        targets.set(std::move(read), vertices);
    } catch (const std::exception& error) {
        is.throwException(std::string("osgSkin: ") + error.what()); // refuses the whole file
        return false;
    }
    return true;
}

} // namespace

REGISTER_OSGSKIN_WRAPPER(osgSkin_MorphTargets, new osgSkin::MorphTargets, osgSkin::MorphTargets,
                         "osg::Object osgSkin::MorphTargets") {
    ADD_USER_SERIALIZER(Targets);
}

REGISTER_OSGSKIN_WRAPPER(osgSkin_UpdateMorphs, new osgSkin::UpdateMorphs, osgSkin::UpdateMorphs,
                         "osg::Object osg::Callback osg::NodeCallback osgSkin::UpdateMorphs") {}
