// SPDX-License-Identifier: MIT
#include "WalkerFile.h"

#include "SceneFile.h"

#include <osgSkin/Error>
#include <osgSkinMotion/MakeWalker>

#include <osgDB/ObjectWrapper>
#include <osgDB/Registry>

#include <iomanip>
#include <iostream>

namespace bake {
namespace {

void tell(const osgSkin::WalkerReport& report) {
    const auto gait = [](const char* does, const std::string& clip, double speed, double slide) {
        std::cerr << does << " \"" << osgSkin::onOneLine(clip) << "\", " << std::setprecision(3)
                  << speed << " m/s; planted feet of the clip slide by " << 100.0 * slide
                  << " % of its stride\n";
    };
    gait("walks as", report.walking, report.walkSpeed, report.walkSlide);
    if (report.running.empty())
        std::cerr << "has no clip to run by: it walks faster\n";
    else
        gait("runs as", report.running, report.runSpeed, report.runSlide);
    if (report.standing.empty())
        std::cerr << "has no clip to stand by: it stands as it walks, on straight legs\n";
    else
        std::cerr << "stands as \"" << osgSkin::onOneLine(report.standing) << "\"\n";
    std::cerr << std::flush;
}

} // namespace

void writeWalker(osgSkin::Character& character, const Arguments& arguments) {
    // OSG leaves out what it has no serializer for, and reports success.
    for (const char* name : {"osgSkinMotion::Walker", "osgSkin::DeformableSkin"})
        if (!osgDB::Registry::instance()->getObjectWrapperManager()->findWrapper(name))
            throw osgSkin::Error(
                "the serializers of walkers (osgdb_serializers_osgskinmotion, "
                "osgdb_serializers_osgskin) "
                "are missing: expected OSG_LIBRARY_PATH to name the folder of osgSkin's plug-ins");
    osgSkin::WalkerReport report;
    const osg::ref_ptr<osgSkin::Walker> walker =
        osgSkin::makeWalker(*character.root, arguments.walkerOptions, &report);
    writeScene(arguments.walker, *walker);
    if (!arguments.quiet) tell(report);
}

} // namespace bake
