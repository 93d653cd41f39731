// SPDX-License-Identifier: MIT
#pragma once

#include "Stage.h"

#include <osgGA/GUIEventHandler>

namespace viewer {

/// What the keys do, a line each.
const char* keysHelp();

/// Does what the key is for. False where it is for nothing.
bool press(Stage& stage, int key);

/// Passes a window's keys on to press().
class Keys : public osgGA::GUIEventHandler {
public:
    explicit Keys(Stage& stage) : _stage(stage) {}
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter&) override;

private:
    Stage& _stage;
};

} // namespace viewer
