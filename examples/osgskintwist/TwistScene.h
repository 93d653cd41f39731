// SPDX-License-Identifier: MIT
#pragma once

#include "Comparison.h"
#include "Figures.h"

#include <Snapshots.h>

#include <osg/Group>
#include <osgText/Text>

#include <array>
#include <cstddef>

namespace twist {

/// Where the camera stands; sees all three copies in every pose. For pictures twice as wide as
/// high.
example::View sceneView();

/// The three copies side by side on a floor, each with its name and figures, and the angles on top.
class TwistScene {
public:
    TwistScene();

    osg::Group* root() const { return _root.get(); }

    const TwistPose& pose() const { return _pose; }
    /// Also measures every copy anew.
    void setPose(const TwistPose& pose);

    /// Shows or hides a copy: 0, 1 or 2, from the left.
    void toggle(std::size_t copy);

    /// Lines of text below the angles; empty for none.
    void setHelp(const std::string& lines);

private:
    osg::ref_ptr<osg::Node> makeCopy(Method method, const osg::Vec3& colour, float x);

    Comparison _comparison;
    FigureMaker _figures;
    TwistPose _pose;
    osg::ref_ptr<osg::Group> _root;
    std::array<osg::ref_ptr<osg::Node>, kMethods.size()> _copies;
    std::array<osg::ref_ptr<osgText::Text>, kMethods.size()> _labels;
    osg::ref_ptr<osgText::Text> _title;
    osg::ref_ptr<osgText::Text> _help;
};

} // namespace twist
