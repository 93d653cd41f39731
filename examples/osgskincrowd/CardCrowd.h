// SPDX-License-Identifier: MIT
#ifndef OSGSKINCROWD_CARDCROWD_H
#define OSGSKINCROWD_CARDCROWD_H

#include <osgSkinGpu/GpuCrowd>

#include <osg/Group>
#include <osg/Referenced>
#include <osg/ref_ptr>

#include <string>
#include <vector>

/// Characters side by side on the graphics card, each in its own phase of its clip, in a colour and
/// at a speed of its own.
///
/// Callbacks of its scene tell the crowds the time, which is all that the processor does for them
/// but culling each as a whole, and note how long both take. The scene stands still once this is
/// gone.
class CardCrowd : public osg::Referenced {
public:
    /// \param files of characters, which take turns
    /// \throw std::runtime_error where one cannot be read
    CardCrowd(const std::vector<std::string>& files, std::size_t count);

    osg::Group* getScene() const { return _scene.get(); }
    float getRadius() const { return _radius; } ///< of the ground that it covers

    /// Vertices, triangles in each level of detail, bytes.
    std::string summary() const;

    /// Milliseconds that the last update and cull took the processor.
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
