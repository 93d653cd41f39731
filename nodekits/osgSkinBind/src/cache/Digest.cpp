// SPDX-License-Identifier: GPL-3.0-or-later
#include "cache/Digest.h"

#include "cache/Bytes.h"

#include <osgSkin/Version>

#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>

#include <cstdint>

namespace osgSkin {
namespace {

/// To be raised where the same input gives other shapes than before, or files look different.
constexpr std::uint32_t kMakerVersion = 10;

void add(const RestSkeleton& skeleton, ByteWriter& writer) {
    for (const RestJoint& joint : skeleton.joints) {
        writer.addText(joint.name);
        writer.add(joint.parent);
        writer.add(joint.centre);
        writer.add(joint.tip ? 1 : 0);
        if (joint.tip) writer.add(*joint.tip);
    }
}

void add(const std::vector<PlannedJoint>& joints, ByteWriter& writer) {
    for (const PlannedJoint& joint : joints) {
        for (const glm::dvec3& vector : {joint.boneAxis, joint.comingFrom, joint.twistAxis})
            writer.add(vector);
        for (const double length : {joint.boneLength, joint.lengthAbove}) writer.add(length);
        for (const int number : {static_cast<int>(joint.part), joint.parent, joint.rigid})
            writer.add(number);
        for (const bool flag : {joint.extremity, joint.trunk, joint.holdsRegion}) writer.add(flag);
    }
}

} // namespace

std::string digestOf(const std::string& bytes) {
    const boost::uuids::name_generator_sha1 generate(boost::uuids::ns::oid());
    return boost::uuids::to_string(generate(bytes.data(), bytes.size()));
}

std::string digestOf(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                     const WeldedMesh& mesh, const Binding& binding) {
    ByteWriter writer;
    writer.addText(OSGSKIN_VERSION);
    writer.add(kMakerVersion);
    add(skeleton, writer);
    add(joints, writer);
    writer.addAll(mesh.positions);
    writer.addAll(mesh.weldedOf);
    writer.addAll(mesh.triangles);
    writer.addAll(binding.firstInfluence);
    writer.addAll(binding.influences);
    return digestOf(writer.bytes());
}

} // namespace osgSkin
