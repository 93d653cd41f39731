// SPDX-License-Identifier: MIT
#include "PoseFigures.h"

#include "LimbBulge.h"
#include "SelfIntersections.h"

#include <cmath>

namespace quality {
namespace {

/// What the skin's shape needs to be looked at again for, in every pose.
struct ShapeMeasures {
    explicit ShapeMeasures(const Subject& subject) : bulge(subject), intersections(subject) {}
    LimbBulge bulge;
    SelfIntersections intersections;
};

PoseFigures measure(const Subject& subject, Method method, const std::vector<NamedPose>& poses,
                    ShapeMeasures* shape) {
    PoseFigures sum;
    const double volume = compare::enclosedVolume(subject.rest, subject.triangles);
    const auto count = static_cast<double>(poses.size());
    for (const NamedPose& pose : poses) {
        const PosedSkin posed = shape ? deformWithNormals(subject, method, pose.skinning)
                                      : PosedSkin{deform(subject, method, pose.skinning), {}};
        const double posedVolume = compare::enclosedVolume(posed.points, subject.triangles);
        PoseFigure figure;
        figure.name = pose.name;
        figure.strain = compare::edgeStrain(subject.rest, posed.points, subject.edges);
        figure.volumeError = std::abs(posedVolume / volume - 1.0);
        if (shape) {
            figure.normals = normalError(subject, posed);
            figure.bulge = shape->bulge.of(posed.points, pose.skinning);
            figure.intersections = shape->intersections.beyondRest(posed.points);
        }
        sum.strain += figure.strain.rms / count;
        sum.percentile999 += figure.strain.percentile999 / count;
        sum.volumeError += figure.volumeError / count;
        sum.normals.mean += figure.normals.mean / count;
        sum.normals.percentile95 += figure.normals.percentile95 / count;
        sum.bulge += figure.bulge / count;
        sum.intersections += static_cast<double>(figure.intersections) / count;
        if (figure.strain.largest > sum.longest) {
            sum.longest = figure.strain.largest;
            sum.longestIn = figure.name;
        }
        sum.poses.push_back(figure);
    }
    return sum;
}

} // namespace

PoseFigures measureOurs(const Subject& subject, const std::vector<NamedPose>& poses) {
    return measure(subject, Method::Ours, poses, nullptr);
}

PerMethod<PoseFigures> measureStrains(const Subject& subject, const std::vector<NamedPose>& poses) {
    PerMethod<PoseFigures> result;
    for (const Method method : kMethods) result[method] = measure(subject, method, poses, nullptr);
    return result;
}

PerMethod<PoseFigures> measurePoses(const Subject& subject, const std::vector<NamedPose>& poses) {
    ShapeMeasures shape(subject);
    PerMethod<PoseFigures> result;
    for (const Method method : kMethods) result[method] = measure(subject, method, poses, &shape);
    return result;
}

} // namespace quality
