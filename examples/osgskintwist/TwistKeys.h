// SPDX-License-Identifier: MIT
#pragma once

#include "TwistScene.h"

#include <osgGA/GUIEventHandler>

namespace twist {

/// The keyboard of the interactive window, and the clock of its animations.
class TwistKeys : public osgGA::GUIEventHandler {
public:
    /// \param scene must outlive the handler
    explicit TwistKeys(TwistScene& scene);

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;

private:
    bool press(int key);
    void advance(double seconds);
    void turn(double bend, double twist);

    TwistScene& _scene;
    bool _bending = false;
    bool _twisting = false;
    bool _paused = false;
    bool _help = false;
    double _bendTime = 0.0; ///< seconds into the animations
    double _twistTime = 0.0;
    double _lastFrame = -1.0;
};

} // namespace twist
