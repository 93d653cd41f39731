// SPDX-License-Identifier: MIT
// Callbacks have virtual bases, for which the wrapper's default cast does not compile.
#undef OBJECT_CAST
#define OBJECT_CAST dynamic_cast

#include "AttachmentFile.h"
#include "FileVersion.h"
#include "RegisterWrapper.h"
#include "springs/SpringMemory.h"

#include <osgSkinMotion/SpringBones>

#include <memory>

namespace osgSkinMotion {
using osgSkin::SpringBones; // osgDB knows classes by their libraries
} // namespace osgSkinMotion

namespace osgSkin {
namespace {

template <typename Archive>
void passMemory(Archive& archive, SpringMemory& memory) {
    archive.list(memory.groups, "groups", 2, [&](SpringMemory::Group& group) {
        archive.list(group.bones, "bones", 59, [&](SpringMemory::Bone& bone) {
            SpringChains::State& state = bone.state;
            archive(bone.name, bone.base, bone.tip, bone.pose.head, bone.pose.tip, bone.pose.axes);
            archive(state.frameSpeed, state.head, state.headSpeed, state.speed, state.pull,
                    state.bone, state.pose);
        });
        archive.list(group.colliders, "colliders", 14, [&](SpringChains::Collider& collider) {
            archive(collider.start, collider.end, collider.radius);
        });
    });
}

} // namespace

/// All numbers are doubles.
template <typename Archive>
void AttachmentFile::pass(Archive& archive, SpringBones& springs) {
    osg::Matrixd toWorld = springs.getToWorld();
    SpringSettings settings = springs.getSettings();
    archive(toWorld);
    archive.list(settings.colliders, "colliders", 15, [&](SpringSettings::Collider& collider) {
        archive(collider.joint, collider.start, collider.end, collider.radius);
    });
    archive.list(settings.chains, "chains", 3, [&](SpringSettings::Chain& chain) {
        archive(chain.centre);
        archive.list(chain.colliders, "colliders of a chain", 1,
                     [&](std::size_t& collider) { archive(collider); });
        archive.list(chain.joints, "joints", 19, [&](SpringSettings::Joint& joint) {
            archive(joint.name, joint.tip, joint.stiffness, joint.drag, joint.radius,
                    joint.gravity);
        });
    });
    auto memory = Archive::kReads ? std::make_shared<SpringMemory>() : springs.remember();
    passMemory(archive, *memory);
    if constexpr (Archive::kReads) {
        springs.set(settings, toWorld);
        springs._memory = memory;
    }
}

} // namespace osgSkin

REGISTER_OSGSKIN_WRAPPER(osgSkinMotion_SpringBones, new osgSkin::SpringBones,
                         osgSkinMotion::SpringBones,
                         "osg::Object osg::Callback osg::NodeCallback osgSkinMotion::SpringBones") {
    addFileVersion(*wrapper);
    addBlock<osgSkin::SpringBones, osgSkin::AttachmentFile>(*wrapper, "Settings", "springs");
    ADD_BOOL_SERIALIZER(Enabled, true);
}
