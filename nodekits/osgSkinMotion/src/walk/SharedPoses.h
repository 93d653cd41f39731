// SPDX-License-Identifier: MIT
#pragma once

#include "walk/GaitState.h"
#include "walk/WalkPlayer.h"

#include <osgSkin/DeformableSkin>
#include <osgSkinMotion/Gaits>

#include <osg/BoundingBox>
#include <osg/Geometry>
#include <osg/Matrixd>
#include <osg/Referenced>
#include <osg/observer_ptr>
#include <osg/ref_ptr>

#include <atomic>
#include <cstddef>
#include <mutex>
#include <vector>

namespace osgSkin {

/// Poses of one figure's gaits as static geometries, for all walkers that are so small on the
/// screen that nobody can tell their pose from the nearest of these. Made when they are first
/// needed.
///
/// Thread rules: all const functions from any thread.
class SharedPoses : public osg::Referenced {
public:
    using Skins = std::vector<osg::ref_ptr<DeformableSkin>>;

    struct Shown {
        std::vector<osg::ref_ptr<osg::Geometry>> skins; ///< rest space
        std::vector<osg::Matrixd> joints;               ///< from rest space to walker space
    };

    /// The poses of these gaits and skins; one object for all walkers that have both.
    /// \throw osgSkin::Error where the skins cannot be posed
    static osg::ref_ptr<const SharedPoses> of(const osg::ref_ptr<const Gaits>& gaits,
                                              const Skins& skins);

    /// The nearest pose.
    /// \param coarseness 0 for all phases of a gait; each 1 more takes every second of them
    std::size_t nearest(const GaitState& gait, unsigned int coarseness) const;
    const Shown& shown(std::size_t pose) const;

    /// The feet of a walker that goes on from a pose.
    WalkPlayer::Feet feet(std::size_t pose) const;

    /// Bounds of the standing figure, one of each skin, rest space.
    const std::vector<osg::BoundingBox>& standing() const { return _standing; }
    /// Bounds of all poses.
    const std::vector<osg::BoundingBox>& all() const;

    double hipsHeight() const { return _player->hipsHeight(); } ///< above the floor, walker space
    double height() const { return _height; }                   ///< of the standing figure

    /// The number of the next walker that gets these poses, from 0.
    unsigned int number() const { return _number++; }

    void resizeGLObjectBuffers(unsigned int maxSize) const;
    void releaseGLObjects(osg::State* state) const;

protected:
    ~SharedPoses() override;

private:
    static constexpr std::size_t kStanding = 32;                 ///< poses of the standing clip
    static constexpr std::size_t kPhases = 160;                  ///< poses of a cycle
    static constexpr std::size_t kRows = 2 * GaitState::kLevels; ///< from standing to running

    /// Poses of one length of strides, with feet that keep their place.
    using Row = std::vector<WalkPlayer::Stance>;

    SharedPoses(const osg::ref_ptr<const Gaits>& gaits, const Skins& skins);
    bool has(const Gaits::Set& set, const Skins& skins) const;
    void makeAll() const;
    const WalkPlayer::Stance& stance(std::size_t pose) const;
    Row walkThrough(std::size_t row, double direction) const;
    osg::ref_ptr<osg::Geometry> still(const DeformableSkin& skin, std::size_t index) const;

    const osg::ref_ptr<const Gaits> _gaits;
    Skins _skins; ///< copies, which pose for the geometries
    osg::ref_ptr<WalkPlayer> _player;
    std::vector<osg::BoundingBox> _standing;
    double _height = 0.0;
    mutable std::vector<osg::BoundingBox> _all;
    mutable std::once_flag _hasAll;
    mutable std::mutex _mutex;
    mutable std::vector<Row> _rows; ///< standing, forwards and backwards; empty: not made yet
    mutable std::vector<std::atomic<const Shown*>> _shown; ///< null: not made yet
    mutable std::atomic<unsigned int> _number{0};
};

} // namespace osgSkin
