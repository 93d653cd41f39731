// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>
#include <osg/StateSet>
#include <osg/Vec4>
#include <osg/ref_ptr>

#include <osgDB/Options>

#include <string>

namespace osgSkin {

/// The look of a part, as far as the file formats share one.
struct Look {
    osg::Vec4 diffuse{0.8f, 0.74f, 0.68f, 1.0f}; ///< a neutral skin for files without materials
    osg::Vec4 specular{0.1f, 0.1f, 0.1f, 1.0f};
    osg::Vec4 emission{0.0f, 0.0f, 0.0f, 1.0f};
    float shininess = 16.0f;        ///< 0..128
    osg::ref_ptr<osg::Image> image; ///< of the diffuse texture, if any
};

/// A state set with an osg::Material, the texture on unit 0, and blending where it is transparent.
osg::ref_ptr<osg::StateSet> makeStateSet(const Look& look);

/// Reads a texture that the mesh file `meshPath` names. Null, with a notice, where it is missing.
osg::ref_ptr<osg::Image> readTexture(const std::string& name, const std::string& meshPath,
                                     const osgDB::Options* options);

} // namespace osgSkin
