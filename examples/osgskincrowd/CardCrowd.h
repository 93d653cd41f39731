// SPDX-License-Identifier: MIT
#ifndef OSGSKINCROWD_CARDCROWD_H
#define OSGSKINCROWD_CARDCROWD_H

#include <osgSkinGpu/GpuCrowd>

#include <osg/Group>
#include <osg/Referenced>
#include <osg/ref_ptr>

#include <string>
#include <vector>

/// A crowd on the graphics card. Each character has its own phase in its clip, colour and speed.
///
/// The processor only passes the time to each osgSkin::GpuCrowd and culls it as a whole. Callbacks
/// of the scene do that and measure it; the scene stops moving when this object is deleted.
class CardCrowd : public osg::Referenced {
public:
    /// \param files of characters, used in turn
    /// \param count number of members
    /// \throw std::runtime_error if a file cannot be read
    CardCrowd(const std::vector<std::string>& files, std::size_t count);

    osg::Group* getScene() const { return _scene.get(); }
    float getRadius() const { return _radius; } ///< of the ground that the crowd covers

    /// Describes the crowd: vertices, triangles of each level of detail, bytes per member.
    std::string summary() const;

    /// Processor time of the last update and cull in milliseconds.
    double getProcessorTime() const { return _updateTime + _cullTime; }

protected:
    ~CardCrowd() override;

private:
    class Timed;

    osg::ref_ptr<osg::Group> _scene;
    std::vector<osg::ref_ptr<osgSkin::CrowdCharacter>> _characters;
    std::vector<osg::ref_ptr<osgSkin::GpuCrowd>> _crowds;
    float _radius = 0.0f;
    double _updateTime = 0.0, _cullTime = 0.0;
};

#endif
