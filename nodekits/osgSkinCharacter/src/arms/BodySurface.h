// SPDX-License-Identifier: MIT
#ifndef OSGSKINCHARACTER_ARMS_BODYSURFACE_H
#define OSGSKINCHARACTER_ARMS_BODYSURFACE_H

#include <osgSkin/Binding>
#include <osgSkin/GlmTypes>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/SkinMesh>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// Some points of a skin, each moving with one joint. Rest space.
struct SkinPoints {
    std::vector<glm::dvec3> places;
    std::vector<glm::dvec3> normals; ///< unit, outward
    std::vector<std::uint32_t> joints;

    std::size_t size() const { return places.size(); }

    /// Adds a point.
    /// \param place position
    /// \param normal unit
    /// \param joint that moves it
    void add(const glm::dvec3& place, const glm::dvec3& normal, std::uint32_t joint) {
        places.push_back(place);
        normals.push_back(normal);
        joints.push_back(joint);
    }

    /// At most `most` of the points, spread evenly by farthest point sampling; deterministic.
    /// \param most 1 or more
    /// \return those points, unchanged
    SkinPoints spread(std::size_t most) const;

    /// As spread(), with each point and normal averaged over those around it that move with the
    /// same joint, which removes the skin's small features.
    ///
    /// \param most 1 or more
    /// \return those points
    SkinPoints averaged(std::size_t most) const;
};

/// The joints in a pose, skeleton space.
struct PosedJoints {
    std::vector<glm::dvec3> rest;      ///< their centres at rest
    std::vector<glm::dquat> rotations; ///< relative to rest
    std::vector<glm::dvec3> centres;

    /// The posed position of a rest point that moves with `joint`.
    glm::dvec3 place(const glm::dvec3& point, std::size_t joint) const {
        return centres[joint] + rotations[joint] * (point - rest[joint]);
    }
};

/// A closed piece of a body (trunk, head, thigh) as an implicit surface through points of its skin:
/// moving least squares with planes, "IMLS" (Shen, O'Brien, Shewchuk 2004; Kolluri 2005). It
/// follows its points as joints move them, and is smooth whatever they do.
class BodySurface {
public:
    /// The depth of a point, and the direction out of the body.
    struct Depth {
        double depth = 0.0; ///< positive inside
        glm::dvec3 out{
            0.0}; ///< at most unit length; shorter where several directions lead out equally fast
    };

    /// \param points of the whole piece, one at least
    explicit BodySurface(SkinPoints points);

    /// Moves the points.
    void pose(const PosedJoints& joints);

    /// Whether depth() is defined at `place`: within the bounding sphere of all points, enlarged by
    /// `margin`. Points beyond are outside.
    bool isNear(const glm::dvec3& place, double margin) const;

    /// The depth of `place` in the posed piece.
    Depth depth(const glm::dvec3& place) const;

private:
    SkinPoints _points;
    double _softening = 0.0; ///< square of a length
    std::vector<glm::dvec3> _places, _normals;
    glm::dvec3 _centre{0.0};
    double _radius = 0.0;
};

/// An arm that can be rotated: its joint, and its skin from the elbow on.
struct ArmPiece {
    std::size_t upper = 0; ///< the upper arm's joint
    double length = 0.0;   ///< from there to the wrist
    SkinPoints skin;
};

/// The parts of a body that avoidBody() uses, at rest.
struct BodyPieces {
    std::vector<BodySurface> surfaces; ///< trunk, head, thighs, as far as they exist
    std::vector<ArmPiece> arms;        ///< left, right, as far as they exist
};

/// Finds pieces by the joints' roles and the vertices' regions. Helper joints belong to their
/// parents' pieces; chains of them (hair, tails, capes) are no part of the body. Pieces are closed
/// where they were cut from each other.
///
/// \param rest valid
/// \param roles of its joints
/// \param mesh in rest space
/// \param binding of `mesh` to `rest`
BodyPieces findBodyPieces(const RestSkeleton& rest, const JointRoles& roles, const SkinMesh& mesh,
                          const Binding& binding);

} // namespace osgSkin

#endif
