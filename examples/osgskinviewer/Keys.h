// SPDX-License-Identifier: MIT
#pragma once

#include "Stage.h"

#include <osgGA/GUIEventHandler>

namespace viewer {

/// A list of the keys, as lines of text.
const char* keysHelp();

/// Handles a key. Returns false if the key has no function.
bool press(Stage& stage, int key);

/// Passes a window's keys to press().
class Keys : public osgGA::GUIEventHandler {
public:
    explicit Keys(Stage& stage) : _stage(stage) {}
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter&) override;

private:
    Stage& _stage;
};

} // namespace viewer
