// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinGpu/GpuCrowd>

#include <osg/Group>
#include <osg/Program>

#include <vector>

namespace test {

/// Rows of bending tubes with correctives and a rigid knob at their ends, both as a crowd and as
/// separate skins.
struct CrowdSubject {
    static constexpr std::size_t kSamples = 8;
    static constexpr double kSamplesPerSecond = 10.0;

    explicit CrowdSubject(std::size_t count);

    /// A character with two clips, and a third clip with one sample per member: its pose at `time`.
    ///
    /// \param time of the members' poses in the third clip, seconds
    /// \param knobs drawable of the rigid part; may be null
    osg::ref_ptr<osgSkin::CrowdCharacter> character(double time = 0.0,
                                                    osg::StateSet* knobs = nullptr) const;
    osg::Geometry& knob() const { return *_knob; }
    /// The members, each in its own phase of one of the clips, all on samples at whole times.
    std::vector<osgSkin::CrowdInstance> members;
    /// The same members, each at its own sample of the third clip.
    std::vector<osgSkin::CrowdInstance> posedMembers() const;

    /// The members at a time, as skins deformed on the CPU.
    osg::ref_ptr<osg::Group> skins(double time) const;

    /// One program for crowds and everything else; the colour shows the normal.
    static osg::ref_ptr<osg::Program> program();

private:
    std::vector<glm::dmat4> skinning(unsigned int clip, std::size_t sample) const;
    std::size_t sampleOf(const osgSkin::CrowdInstance& member, double time) const;

    osg::ref_ptr<osgSkin::DeformableSkin> _skin;
    osg::ref_ptr<osg::Geometry> _knob;
    osg::Matrixd _upright = osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0));
};

} // namespace test
