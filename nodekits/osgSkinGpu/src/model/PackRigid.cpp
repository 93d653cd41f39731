// SPDX-License-Identifier: MIT
#include "model/PackRigid.h"

#include "model/PackTexels.h"

#include <osgSkin/GlmOsg>

namespace osgSkin {

osg::ref_ptr<osg::Vec4uiArray> packRigid(const std::vector<BoundJoint>& joints, unsigned int joint,
                                         const osg::Vec3Array& positions,
                                         const osg::Vec3Array& normals) {
    osg::ref_ptr<osg::Vec4uiArray> texels = new osg::Vec4uiArray;
    packJoints(joints, *texels);
    const auto chain = static_cast<unsigned int>(texels->size());
    texels->push_back(osg::Vec4ui(joint, 0, 0, 0));
    texels->front() = osg::Vec4ui(static_cast<unsigned int>(joints.size()), chain + 1,
                                  static_cast<unsigned int>(positions.size()), 0u);
    for (std::size_t v = 0; v < positions.size(); ++v) {
        texels->push_back(packedTexel(*asGlm(&positions[v]), chain));
        texels->push_back(packedTexel(*asGlm(&normals[v]), 0));
    }
    return texels;
}

} // namespace osgSkin
