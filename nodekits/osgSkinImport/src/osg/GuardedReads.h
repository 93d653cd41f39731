// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GUARDEDREADS_H
#define OSGSKINIMPORT_GUARDEDREADS_H 1

#include "pictures/PictureCheck.h"

#include <osgSkinImport/ReadLimits>

#include <osgDB/Callbacks>
#include <osgDB/Options>

#include <cstddef>
#include <string>
#include <vector>

namespace osgSkin {

/// Stands before all of OSG's readers for one file and what it names, scenes and pictures alike:
/// opens nothing but files, reads saved scenes by readSaved(), and never asks OSG for formats that
/// we have readers of, whatever stands around their names. Others go to the callback that the
/// application has set, or else to OSG, by the path of the file that was looked at.
class GuardedReads : public osgDB::ReadFileCallback {
public:
    using Result = osgDB::ReaderWriter::ReadResult;

    /// \param options of the application; may be null
    explicit GuardedReads(const osgDB::Options* options);

    /// Why the first file was refused, since a reader between may keep it to itself; empty: none
    /// was.
    const std::string& reason() const { return _reason; }

    Result openArchive(const std::string& name, osgDB::ReaderWriter::ArchiveStatus status,
                       unsigned blockSize, const osgDB::Options* options) override;
    Result readNode(const std::string& name, const osgDB::Options* options) override;
    Result readObject(const std::string& name, const osgDB::Options* options) override;
    Result readImage(const std::string& name, const osgDB::Options* options) override;
    Result readHeightField(const std::string& name, const osgDB::Options* options) override;
    Result readShader(const std::string& name, const osgDB::Options* options) override;
    Result readScript(const std::string& name, const osgDB::Options* options) override;

private:
    template <typename Read>
    Result guarded(const std::string& name, Read read);
    template <typename Read>
    Result readModel(const std::string& name, const osgDB::Options* options, Read next);
    template <typename Read>
    Result readOther(const std::string& name, const osgDB::Options* options, const char* expected,
                     Read next);
    Result readSavedFile(const std::string& found, const osgDB::Options* options);

    const ReadLimits _limits;
    PictureCheck _pictures;
    osg::ref_ptr<osgDB::ReadFileCallback> _next;
    bool _isOsgNext = false; ///< no callback of the application's, which knows more than files
    std::string _reason;
    std::vector<std::string> _open; ///< saved files that are being read
    std::size_t _depth = 0;         ///< reads of any kind within each other
};

} // namespace osgSkin

#endif
