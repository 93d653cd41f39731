// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/BindSource.h"

#include "report/NamingFile.h"
#include "source/MeshWeights.h"

#include <osgSkinBind/Bind>
#include <osgSkinBind/BindWeights>
#include <osgSkinCharacter/ReadWeights>

#include <osg/Notify>

namespace osgSkin {
namespace {

using Painted = CharacterSource::Painted;

VertexWeights paintedWeights(const CharacterSource& source) {
    if (source.weightsFile.empty()) return meshWeights(source.meshFile, source.body, source.rest);
    return readWeights(source.weightsFile, source.rest, source.body.mesh.positions.size());
}

} // namespace

Binding bindSource(const CharacterSource& source, const Progress& progress, BindReport& report) {
    BindOptions options = source.bind;
    options.progress = progress;
    VertexWeights weights;
    if (source.painted != Painted::No) weights = paintedWeights(source);
    const bool byWeights = source.painted == Painted::Yes ||
                           (source.painted == Painted::WhereGood && isWellPainted(weights));
    Binding binding = namingFile(source.file, [&] {
        return byWeights ? bindWeights(source.body.mesh, source.rest, weights, options, &report)
                         : bind(source.body.mesh, source.rest, options, &report);
    });
    OSG_INFO << source.file << ": bound by " << (byWeights ? "painted weights" : "regions") << "\n"
             << report.text();
    return binding;
}

} // namespace osgSkin
