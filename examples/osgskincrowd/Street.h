// SPDX-License-Identifier: MIT
#ifndef OSGSKINCROWD_STREET_H
#define OSGSKINCROWD_STREET_H

#include "Snapshots.h"

#include <osgSkin/CharacterGroup>
#include <osgSkinMotion/Walker>

#include <osg/Camera>
#include <osg/Group>
#include <osg/MatrixTransform>
#include <osg/Referenced>
#include <osg/ref_ptr>

#include <cstddef>
#include <random>
#include <string>
#include <vector>

/// Blocks of houses, with people who walk on the pavements and over the crossings, each at a speed
/// of its own. They are osgSkin::Walker below an osgSkin::CharacterGroup; a callback of the scene
/// moves the transforms above them, and does nothing else.
class Street : public osg::Referenced {
public:
    /// \param files walkers, or characters with a clip that walks; at least one, used in turn
    /// \param count number of people
    /// \param threads of the group; 0: all processors
    /// \throw osgSkin::Error with the file and the reason
    Street(const std::vector<std::string>& files, std::size_t count, unsigned int threads);

    osg::Group* getScene() const { return _scene.get(); }

    /// At the eyes of somebody who waits at a crossing.
    example::View view() const;

    /// Moves the people.
    /// \param time simulation time in seconds; does not decrease
    void move(double time);

    /// Moves them and updates their poses in steps of 60 Hz: a long way at once is no walk.
    void walkTo(double time);

    /// Runs frames at 60 Hz without a window, and prints the times of update and cull traversals.
    void bench(unsigned int frames);

protected:
    ~Street() override;

private:
    /// Walks along a straight line from corner to corner.
    struct Person {
        osg::ref_ptr<osg::MatrixTransform> place;
        osg::Vec2i block;     ///< its indices
        int corner = 0;       ///< of the block, counterclockwise: the one that it left
        int step = 1;         ///< to the next corner: 1 or -1; 2: over the street to the next block
        double way = 0.0;     ///< m from that corner
        double length = 0.0;  ///< m to the next one
        double speed = 0.0;   ///< m/s
        double lane = 0.0;    ///< m from the pavement's middle, to the outside
        double heading = 0.0; ///< radians
        osg::Vec2d from, along; ///< where it left the corner; unit
    };

    osg::Vec2d cornerOf(const osg::Vec2i& block, int corner, double lane) const;
    void choose(Person& person);
    void addHouses();
    void addPeople(const std::vector<std::string>& files, std::size_t count);

    osg::ref_ptr<osg::Group> _scene = new osg::Group;
    osg::ref_ptr<osgSkin::CharacterGroup> _group = new osgSkin::CharacterGroup;
    std::vector<Person> _people;
    std::mt19937 _random{7};
    int _blocks = 2; ///< in each direction
    double _time = -1.5;
    unsigned int _step = 1U << 30; ///< frame number, of none of a viewer's
};

/// A line of text at the lower edge of the window: frame time and number of people, averaged over
/// half a second.
osg::ref_ptr<osg::Camera> makeStreetTime(std::size_t people);

#endif
