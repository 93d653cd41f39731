// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINCHARACTER_OPTIONS_LOADREPORT_H
#define OSGSKINCHARACTER_OPTIONS_LOADREPORT_H

#include <osgSkin/Error>
#include <osgSkinBind/BindOptions>
#include <osgSkinBind/Progress>

#include <osg/Notify>

#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// Tells how far a load has come that consists of stages, one after the other.
class LoadStages {
public:
    /// About what each stage takes of the time, measured on bodies of 4,000 vertices with 31
    /// joints: only the proportions count.
    static constexpr double kMesh = 10.0;
    static constexpr double kSkeleton = 0.5;
    static constexpr double kFit = 400.0;
    static constexpr double kModel = 50.0; ///< a rigged model: mesh, skeleton and animations
    static constexpr double kBinding = 75.0;
    static constexpr double kPaintedBinding = 10.0; ///< by painted weights
    static constexpr double kMotion = 15.0;         ///< each motion file
    static constexpr double kScene = 3.0;
    static constexpr double kPlayedScene = 40.0; ///< with animations that must be played for bounds

    /// What is to be added to the binding.
    static constexpr double shapesSize(std::optional<BindOptions::Shapes> shapes) {
        return shapes == BindOptions::Shapes::Elastic ? 2500.0 : 0.0;
    }

    /// \param progress told; may be empty
    explicit LoadStages(Progress progress);

    /// Before the second stage: the sum of the sizes of all stages.
    void plan(double total);

    /// The next stage begins.
    ///
    /// \param what its name
    /// \param size one of those above
    /// \return for the stage to tell how far it has come itself
    Progress begin(const std::string& what, double size);

    /// All is done.
    void finish();

private:
    Progress _progress;
    double _total = 1.0;
    double _begun = 0.0; ///< sum of the stages before the present one
    double _size = 0.0;  ///< of the present one
};

/// Runs a step whose errors know a mesh's vertices and a skeleton's joints but not the file that
/// they came from: it is put before them.
///
/// \param file that errors are to name
/// \param step called once
/// \return what `step` returns
/// \throw Error that begins with `file`
template <typename Step>
auto namingFile(const std::string& file, const Step& step) {
    try {
        return step();
    } catch (const Error& error) {
        const std::string what = error.what();
        if (what.rfind(file, 0) == 0) throw;
        throw Error(file + ": " + what);
    }
}

/// Keeps a line on something unusual for the caller, and tells OSG's notify handler too.
inline void takeNote(std::vector<std::string>& notes, const std::string& line) {
    notes.push_back(onOneLine(line));
    OSG_NOTICE << notes.back() << std::endl;
}

} // namespace osgSkin

#endif
