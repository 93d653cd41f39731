// SPDX-License-Identifier: MIT
#include "PoseFigures.h"

#include <cmath>

namespace quality {
namespace {

PoseFigures measure(const Subject& subject, Method method, const std::vector<NamedPose>& poses) {
    PoseFigures sum;
    const double volume = compare::enclosedVolume(subject.rest, subject.triangles);
    const auto count = static_cast<double>(poses.size());
    for (const NamedPose& pose : poses) {
        const compare::Points posed = deform(subject, method, pose.skinning);
        const double posedVolume = compare::enclosedVolume(posed, subject.triangles);
        const PoseFigure figure{pose.name, compare::edgeStrain(subject.rest, posed, subject.edges),
                                std::abs(posedVolume / volume - 1.0)};
        sum.strain += figure.strain.rms / count;
        sum.percentile999 += figure.strain.percentile999 / count;
        sum.volumeError += figure.volumeError / count;
        if (figure.strain.largest > sum.longest) {
            sum.longest = figure.strain.largest;
            sum.longestIn = figure.name;
        }
        sum.poses.push_back(figure);
    }
    return sum;
}

} // namespace

PerMethod<PoseFigures> measurePoses(const Subject& subject, const std::vector<NamedPose>& poses) {
    PerMethod<PoseFigures> result;
    for (const Method method : kMethods) result[method] = measure(subject, method, poses);
    return result;
}

} // namespace quality
