// SPDX-License-Identifier: MIT
#ifndef OSGSKINCROWD_CROWD_H
#define OSGSKINCROWD_CROWD_H

#include <osgSkin/DeformPool>
#include <osgSkinRig/ClipCharacter>

#include <osg/Group>
#include <osg/Referenced>
#include <osg/ref_ptr>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

/// A character read from a file, with the first of its clips sampled 60 times a second and baked: a
/// member of the crowd copies poses and asks no animation manager and no bone.
struct CrowdCharacter {
    /// \throw std::runtime_error where the file cannot be read, osgSkin::Error where it has no
    ///        skin
    explicit CrowdCharacter(const std::string& file);

    osg::ref_ptr<osgSkin::ClipCharacter> character;
    osg::ref_ptr<const osgSkin::SampledClip> clip;
    std::size_t vertices = 0; ///< of its skins
};

/// Characters side by side, each in its own phase of its clip; all that come from one file share
/// its skin models.
///
/// A callback of its scene has the players pose on the pool's threads, and with the same threads an
/// osgSkin::ParallelDeformCallback deforms the skins that are in view. The scene stands still once
/// the crowd is gone.
class Crowd : public osg::Referenced {
public:
    /// \param characters at least one; they take turns
    Crowd(const std::vector<CrowdCharacter>& characters, std::size_t count,
          osgSkin::DeformPool* pool);

    osg::Group* getScene() const { return _scene.get(); }
    float getRadius() const { return _radius; } ///< of the ground that it covers
    std::size_t getVertexCount() const { return _vertices; }

    /// Milliseconds that updates to the present simulation time took for poses, and for skins.
    double getPoseTime() const { return _poseTime; }
    double getDeformTime() const { return _deformTime; }

    /// One update of the scene.
    ///
    /// \param time simulation time in seconds
    /// \param deform deforms what has been posed
    void update(double time, const std::function<void()>& deform);

protected:
    ~Crowd() override;

private:
    osg::ref_ptr<osg::Group> _scene;
    osg::ref_ptr<osgSkin::DeformPool> _pool;
    std::vector<osg::ref_ptr<osgSkin::ClipPlayer>> _players;
    float _radius = 0.0f;
    std::size_t _vertices = 0;
    double _time = -1.0, _poseTime = 0.0, _deformTime = 0.0;
};

#endif
