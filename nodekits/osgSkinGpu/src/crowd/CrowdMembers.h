// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinGpu/CrowdCharacter>
#include <osgSkinGpu/CrowdInstance>

#include <osg/Array>
#include <osg/BoundingBox>
#include <osg/TextureBuffer>
#include <osg/Vec4f>

#include <vector>

namespace osgSkin {

/// \throw osgSkin::Error where a member plays a clip that the character does not have, or has a
///        number that is not finite or a blend beyond 0..1
void checkMembers(const CrowdCharacter& character, const std::vector<CrowdInstance>& instances);

/// The members of a crowd, for shaders and for the processor's culling.
class CrowdMembers {
public:
    /// \param character outlives this
    /// \param since the time that shaders count from, seconds
    CrowdMembers(const CrowdCharacter& character, const std::vector<CrowdInstance>& instances,
                 double since);

    std::size_t size() const { return _instances.size(); }
    osg::TextureBuffer* texture() const { return _texture.get(); }
    const std::vector<CrowdInstance>& instances() const { return _instances; }
    /// The same number of them.
    void set(const std::vector<CrowdInstance>& instances);

    /// The time that shaders count from: theirs is in single precision.
    double since() const { return _since; }
    void setSince(double seconds);

    /// Takes the character's bounds.
    void findSpheres();

    const std::vector<osg::Vec4f>& spheres() const { return _spheres; } ///< centre, radius
    const osg::BoundingBox& box() const { return _box; }                ///< of all of them

private:
    double phaseOf(unsigned int clip, double phase, float speed) const;
    void pack();

    const CrowdCharacter& _character;
    std::vector<CrowdInstance> _instances;
    double _since;
    osg::ref_ptr<osg::Vec4uiArray> _texels;
    osg::ref_ptr<osg::TextureBuffer> _texture;
    std::vector<osg::Vec4f> _spheres;
    osg::BoundingBox _box;
};

} // namespace osgSkin
