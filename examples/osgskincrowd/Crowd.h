// SPDX-License-Identifier: MIT
#ifndef OSGSKINCROWD_CROWD_H
#define OSGSKINCROWD_CROWD_H

#include <osgSkin/DeformPool>
#include <osgSkinMotion/ClipCharacter>

#include <osg/Group>
#include <osg/Referenced>
#include <osg/ref_ptr>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

/// Loads a character with the options of `-O`; without, as fits a crowd's distance: without shapes
/// and with rotated normals.
/// \throw osgSkin::Error with the file and the reason
osg::ref_ptr<osg::Node> loadScene(const std::string& file);

/// A character from a file. Its first clip is sampled 60 times per second and baked, so a member of
/// the crowd copies poses and needs no animation manager and no bones.
struct CrowdCharacter {
    /// \throw osgSkin::Error if the file cannot be read or has no skin
    explicit CrowdCharacter(const std::string& file);

    osg::ref_ptr<osgSkin::ClipCharacter> character;
    osg::ref_ptr<const osgSkin::SampledClip> clip;
    std::size_t vertices = 0; ///< of its skins
};

/// A crowd of characters, each in its own phase of its clip. Characters from the same file share
/// their skin models.
///
/// A callback of the scene poses the members on the pool's threads. Then an
/// osgSkin::ParallelDeformCallback deforms the visible skins on the same threads. The scene stops
/// moving when the crowd is deleted.
class Crowd : public osg::Referenced {
public:
    /// \param characters at least one; used in turn
    /// \param count number of members
    /// \param pool threads for posing and deforming
    Crowd(const std::vector<CrowdCharacter>& characters, std::size_t count,
          osgSkin::DeformPool* pool);

    osg::Group* getScene() const { return _scene.get(); }
    float getRadius() const { return _radius; } ///< of the ground that the crowd covers
    std::size_t getVertexCount() const { return _vertices; }

    /// Milliseconds for posing, and for deforming, in all updates with the current simulation time.
    double getPoseTime() const { return _poseTime; }
    double getDeformTime() const { return _deformTime; }

    /// Updates the scene.
    ///
    /// \param time simulation time in seconds
    /// \param deform deforms the skins after they have been posed
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
