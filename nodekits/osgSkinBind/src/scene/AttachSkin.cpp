// SPDX-License-Identifier: GPL-3.0-or-later
#include <osgSkinBind/AttachSkin>

#include <osgSkin/BoneReader>
#include <osgSkin/Error>
#include <osgSkinBind/RigidJoints>

namespace osgSkin {

AttachedSkin placeSkins(osgAnimation::Skeleton& skeleton, const SkinParts& parts) {
    const osgAnimation::BoneMap named = bonesOf(skeleton);
    std::vector<osg::ref_ptr<osgAnimation::Bone>> bones;
    for (const SkinParts::Rigid& rigid : parts.rigids) {
        const auto bone = named.find(rigid.joint);
        if (bone == named.end())
            throw Error("attach skin: the skeleton has no bone \"" + rigid.joint +
                        "\", which a rigid part needs");
        bones.push_back(bone->second);
    }
    AttachedSkin result;
    result.skins = parts.skins;
    for (const SkinParts::Skin& skin : parts.skins) skeleton.addChild(skin.drawable);
    for (std::size_t i = 0; i < bones.size(); ++i) {
        const MeshPart& part = parts.rigids[i].part;
        result.rigids.push_back({new RigidPart(part.geometry, *bones[i]), bones[i], part});
    }
    return result;
}

AttachedSkin attachSkin(osgAnimation::Skeleton& skeleton, const SkinMesh& mesh,
                        const std::vector<MeshPart>& parts, const Binding& binding,
                        const RigidSplit& split) {
    return placeSkins(skeleton, makeSkins(mesh, parts, binding, split));
}

AttachedSkin attachSkin(osgAnimation::Skeleton& skeleton, const SkinMesh& mesh,
                        const std::vector<MeshPart>& parts, const Binding& binding) {
    RestSkeleton joints;
    for (const BoundJoint& joint : binding.joints)
        joints.joints.push_back({joint.name, joint.parent, joint.centre, {}});
    return attachSkin(skeleton, mesh, parts, binding,
                      splitRigid(mesh, binding, automaticRigidJoints(joints)));
}

} // namespace osgSkin
