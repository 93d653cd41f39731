// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinGpu/GpuCrowd>

#include <osg/Group>
#include <osg/NodeCallback>
#include <osg/ref_ptr>

#include <string>
#include <vector>

/// Characters side by side on the graphics card, each in its own phase of its clip, in a colour and
/// at a speed of its own.
///
/// The update callback of its own scene: it tells the crowds the time, which is all that the
/// processor does for them but culling each as a whole; it notes how long both take.
class CardCrowd : public osg::NodeCallback {
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

    void operator()(osg::Node* node, osg::NodeVisitor* nv) override;

private:
    class TimeCull;

    osg::ref_ptr<osg::Group> _scene;
    std::vector<osg::ref_ptr<osgSkin::CrowdCharacter>> _characters;
    std::vector<osg::ref_ptr<osgSkin::GpuCrowd>> _crowds;
    float _radius = 0.0f;
    double _updateTime = 0.0, _cullTime = 0.0;
};
