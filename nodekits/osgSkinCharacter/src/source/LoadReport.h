// SPDX-License-Identifier: MIT
#ifndef OSGSKINCHARACTER_SOURCE_LOADREPORT_H
#define OSGSKINCHARACTER_SOURCE_LOADREPORT_H

#include <osgSkin/Error>
#include <osgSkinBind/BindOptions>
#include <osgSkinBind/Progress>

#include <osg/Notify>

#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// Reports the progress of a load in consecutive stages.
class LoadStages {
public:
    /// Approximate relative durations of the stages, measured on bodies of 4,000 vertices with 31
    /// joints.
    static constexpr double kMesh = 10.0;
    static constexpr double kSkeleton = 0.5;
    static constexpr double kFit = 400.0;
    static constexpr double kModel = 50.0; ///< a rigged model: mesh, skeleton and animations
    static constexpr double kBinding = 75.0;
    static constexpr double kPaintedBinding = 10.0; ///< by painted weights
    static constexpr double kMotion = 15.0;         ///< each motion file
    static constexpr double kScene = 3.0;
    static constexpr double kPlayedScene = 40.0; ///< with animations that are played to find bounds

    /// \param progress called for each step; may be empty
    explicit LoadStages(Progress progress);

    /// Sets the sum of all stages' sizes. Call it before the second stage.
    void plan(double total);

    /// Begins the next stage.
    ///
    /// \param what its name
    /// \param size one of those above
    /// \return the stage's own progress
    Progress begin(const std::string& what, double size);

    /// Reports the end.
    void finish();

private:
    Progress _progress;
    double _total = 1.0;
    double _begun = 0.0; ///< sum of the stages before the present one
    double _size = 0.0;  ///< of the present one
};

/// Runs a step and adds a file's name to its errors: to those that name vertices and joints but no
/// file, or another file that this one names.
///
/// \param file the name to add
/// \param step called once
/// \return what `step` returns
/// \throw Error that begins with `file`
template <typename Step>
auto withFileContext(const std::string& file, const Step& step) {
    try {
        return step();
    } catch (const Error& error) {
        const std::string what = error.what();
        if (what.rfind(file, 0) == 0) throw;
        throw Error(file + ": " + what);
    }
}

/// Adds a warning to the notes for the caller, and prints it by OSG_NOTICE.
inline void warn(std::vector<std::string>& notes, const std::string& line) {
    notes.push_back(onOneLine(line));
    OSG_NOTICE << notes.back() << std::endl;
}

} // namespace osgSkin

#endif
