// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Node>
#include <osg/Quat>
#include <osg/ref_ptr>

#include <map>
#include <string>

/// An actor of 1.7 m in a T-pose, as a program for motion capture sends him by the VMC protocol.
class Performer {
public:
    /// \param port of this machine
    explicit Performer(int port) : _port(port) {}

    /// Sends all bones, and then the time.
    /// \param time seconds
    /// \param turns of bones of Unity's humanoid, in Unity's space; the others keep the T-pose
    void send(double time, const std::map<std::string, osg::Quat>& turns) const;

private:
    int _port;
};

/// The recipe receivePoses, and an actor who sends his poses to it: he raises a hand and waves.
/// \param file of a character
osg::ref_ptr<osg::Node> perform(const std::string& file);
