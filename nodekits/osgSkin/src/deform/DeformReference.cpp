// SPDX-License-Identifier: MIT
#include <osgSkin/DeformJob>

#include "deform/RestCopy.h"
#include "model/GradientBlocks.h"
#include "model/SkinBlocks.h"
#include "pose/CorrectiveWeights.h"

#include <osgSkin/BendTwist>
#include <osgSkin/Pose>
#include <osgSkin/SkinModel>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace osgSkin {
namespace {

/// The joints that a group follows fully, up to a partial one, as one map.
struct Rigid {
    glm::mat3 rotation;
    glm::vec3 offset;
    float scale;

    glm::vec3 operator*(const glm::vec3& x) const { return scale * (rotation * x) + offset; }
};

/// A joint that a group follows in part.
struct Partial {
    glm::vec3 centre;
    glm::vec3 translation;
    glm::vec3 bendAxis;  ///< v
    glm::vec3 twistAxis; ///< w
    glm::vec3 crossAxis; ///< v x w
    float halfBend;      ///< psi / 2
    float halfTwist;     ///< phi / 2
    float growth;        ///< scale - 1
};

/// Combines such joints in double precision.
struct Fold {
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 offset{0.0};
    double scale = 1.0;

    void append(const JointTransform& turn) {
        offset += scale * (rotation * turn.offset);
        rotation = rotation * turn.rotation;
        scale *= turn.scale;
    }
    Rigid rounded() const {
        return {glm::mat3(glm::mat3_cast(rotation)), glm::vec3(offset), static_cast<float>(scale)};
    }
};

Partial makePartial(const BoundJoint& joint, const JointTransform& turn) {
    const glm::dvec3 v = turn.split.bendAxis;
    const glm::dvec3 w = joint.twistAxis;
    return {glm::vec3(joint.centre),
            glm::vec3(turn.translation),
            glm::vec3(v),
            glm::vec3(w),
            glm::vec3(glm::cross(v, w)),
            static_cast<float>(0.5 * turn.split.bendAngle),
            static_cast<float>(0.5 * turn.split.twistAngle),
            static_cast<float>(turn.scale - 1.0)};
}

glm::vec3 rotate(float s, const glm::vec3& u, const glm::vec3& x) {
    const glm::vec3 t = 2.0f * glm::cross(u, x);
    return x + s * t + glm::cross(u, t);
}

/// The transforms of a group's vertices in one pose: full[0] partial[0] full[1] partial[1] ...
/// full[n], outermost first.
struct Chain {
    Chain(const SkinModel& model, const SkinModel::Group& group, const Pose& pose) noexcept {
        Fold fold;
        for (std::uint32_t i = group.firstLink; i < group.firstLink + group.linkCount; ++i) {
            const SkinModel::Link& link = model.links()[i];
            const JointTransform turn = pose.transform(link.joint);
            if (!link.partial) {
                fold.append(turn);
                continue;
            }
            full[partialCount] = fold.rounded();
            partial[partialCount] = makePartial(model.joints()[link.joint], turn);
            ++partialCount;
            fold = {};
        }
        full[partialCount] = fold.rounded();
    }

    /// Poses one vertex.
    /// \param ratios one entry per partial joint
    /// \param normal may be null, as may the tangent
    void apply(const SkinModel::Ratio* ratios, glm::vec3& position, glm::vec3* normal,
               glm::vec3* tangent = nullptr) const noexcept {
        glm::vec3 x = full[partialCount] * position;
        glm::vec3 n = normal ? full[partialCount].rotation * *normal : glm::vec3(0.0f);
        glm::vec3 t = tangent ? full[partialCount].rotation * *tangent : glm::vec3(0.0f);
        for (std::size_t k = partialCount; k-- > 0;) {
            const Partial& joint = partial[k];
            // exp(b psi v / 2) exp(t phi w / 2) multiplied out; v . w = 0 (section 3 and eq. 1).
            const float a = ratios[k].bend * joint.halfBend;
            const float b = ratios[k].twist * joint.halfTwist;
            const float sa = std::sin(a), ca = std::cos(a);
            const float sb = std::sin(b), cb = std::cos(b);
            const glm::vec3 u = (sa * cb) * joint.bendAxis + (ca * sb) * joint.twistAxis +
                                (sa * sb) * joint.crossAxis;
            const float s = ca * cb;
            // A translation and a scale of the joint come in with the bend.
            x = joint.centre + ratios[k].bend * joint.translation +
                (1.0f + ratios[k].bend * joint.growth) * rotate(s, u, x - joint.centre);
            x = full[k] * x;
            if (normal) n = full[k].rotation * rotate(s, u, n);
            if (tangent) t = full[k].rotation * rotate(s, u, t);
        }
        position = x;
        if (normal) *normal = n;
        if (tangent) *tangent = t;
    }

    std::size_t partialCount = 0;
    std::array<Rigid, SkinModel::kMaxPartialInfluences + 1> full;
    std::array<Partial, SkinModel::kMaxPartialInfluences> partial;
};

/// Adds a corrective tilt to a rest normal, keeps it unit, and keeps the tangent
/// perpendicular.
void tiltNormal(const glm::dvec3& tilt, glm::vec3& normal, glm::vec3& tangent) noexcept;

bool isMoved(const SkinModel& model, const JointTransform& turn) noexcept {
    const double small = SkinModelAccess::blocks(model).smallMove;
    return glm::dot(turn.translation, turn.translation) > small * small || turn.scale != 1.0;
}

glm::dvec3 scaledTo(const glm::dvec3& direction, double length) noexcept {
    const double is = glm::length(direction);
    return is > 0.0 ? direction * (length / is) : direction;
}

/// Normals and tangents of the deformed surface, of one group in one pose, in double precision.
///
/// Two directions along the skin go through the chain: at a vertex x, a link with ratios a turns a
/// direction d along the skin into D(a) d + (dD/da)(x) (grad a . d). They span the deformed
/// surface; correctives tilt it at rest.
class SurfaceChain {
public:
    /// \pre the model has gradients
    SurfaceChain(const SkinModel& model, std::size_t group, const Pose& pose) noexcept
        : _model(model), _group(group), _pose(pose),
          _frame(restFrame(model, model.groups()[group])) {
        const GradientBlocks& blocks = *SkinModelAccess::gradients(model);
        const SkinModel::Group& of = model.groups()[group];
        const GradientBlocks::Reach* reach = blocks.reach.data() + blocks.firstReach[group];
        std::size_t k = 0;
        for (std::uint32_t i = of.firstLink; i < of.firstLink + of.linkCount; ++i) {
            if (!model.links()[i].partial) continue;
            const JointTransform turn = pose.transform(model.links()[i].joint);
            _links[k] = linkTilt(reach[k], turn.split.bendAngle, turn.split.twistAngle,
                                 isMoved(model, turn));
            if (_links[k++].any()) _tilts = true;
        }
    }

    /// Whether any link tilts normals in this pose; else they rotate as the vertices do.
    bool tilts() const noexcept { return _tilts; }

    /// Poses a normal and a tangent; on entry those at rest.
    ///
    /// \param row of the group
    /// \param ratios one entry per partial joint
    /// \param position at rest, with correctives
    /// \param normal changed
    /// \param tilt what correctives add to the normal
    /// \param tangent changed; may be null
    void apply(std::uint32_t row, const SkinModel::Ratio* ratios, const glm::dvec3& position,
               glm::vec3& normal, const glm::dvec3& tilt, glm::vec3* tangent) const noexcept {
        const GradientBlocks& blocks = *SkinModelAccess::gradients(_model);
        const SkinModel::Group& group = _model.groups()[_group];
        const GradientRow* gradients = blocks.blockOf(_model, _group, row);
        const auto gradient = [&]() {
            return blocks.unit * double((gradients++)->lane[row % kBlock]);
        };
        const SkinDirections rest =
            skinDirections(normal, _frame, blocks.acrossOf(_model, _group, row));
        glm::dvec3 x = position;
        glm::dvec3 u = rest.u - glm::dot(tilt, rest.u) * glm::dvec3(normal);
        glm::dvec3 v = rest.v - glm::dot(tilt, rest.v) * glm::dvec3(normal);
        std::size_t k = group.partialCount;
        for (std::uint32_t i = group.firstLink + group.linkCount; i-- > group.firstLink;) {
            const SkinModel::Link& link = _model.links()[i];
            const JointTransform turn = _pose.transform(link.joint);
            if (!link.partial) {
                x = turn.offset + turn.scale * (turn.rotation * x);
                u = turn.scale * (turn.rotation * u);
                v = turn.scale * (turn.rotation * v);
                continue;
            }
            const BoundJoint& joint = _model.joints()[link.joint];
            const double bend = double(ratios[--k].bend), twist = double(ratios[k].twist);
            const double bendU = gradient(), bendV = gradient();
            const double twistU = gradient(), twistV = gradient();
            const glm::dquat q = partialRotation(turn.split, joint.twistAxis, bend, twist);
            const glm::dvec3 from = q * (x - joint.centre);
            const glm::dvec3 twistAxis =
                glm::angleAxis(bend * turn.split.bendAngle, turn.split.bendAxis) * joint.twistAxis;
            glm::dvec3 byBend(0.0), byTwist(0.0);
            if (_links[k].bends)
                byBend = turn.split.bendAngle * glm::cross(turn.split.bendAxis, from);
            if (_links[k].twists) byTwist = turn.split.twistAngle * glm::cross(twistAxis, from);
            // A translation and a scale of the joint come in with the bend.
            const double factor = 1.0 + bend * (turn.scale - 1.0);
            byBend = factor * byBend;
            if (_links[k].moves) byBend += (turn.scale - 1.0) * from + turn.translation;
            u = factor * (q * u + byTwist * twistU) + byBend * bendU;
            v = factor * (q * v + byTwist * twistV) + byBend * bendV;
            x = joint.centre + bend * turn.translation + factor * from;
        }
        if (tangent) {
            const glm::dvec3 t(*tangent);
            *tangent = scaledTo(glm::dot(t, rest.u) * u + glm::dot(t, rest.v) * v, glm::length(t));
        }
        normal = scaledTo(glm::cross(u, v), 1.0);
    }

private:
    const SkinModel& _model;
    std::size_t _group;
    const Pose& _pose;
    std::array<LinkTilt, SkinModel::kMaxPartialInfluences> _links;
    bool _tilts = false;
    glm::dmat3 _frame; ///< of the group's blocks
};

/// Adds a corrective tilt to a rest normal, keeps it unit, and keeps the tangent perpendicular.
void tiltNormal(const glm::dvec3& tilt, glm::vec3& normal, glm::vec3& tangent) noexcept {
    const glm::dvec3 n = scaledTo(glm::dvec3(normal) + tilt, 1.0);
    const glm::dvec3 t(tangent);
    normal = n;
    tangent = scaledTo(t - glm::dot(t, n) * n, glm::length(t));
}

/// The correctives in one pose, vertex by vertex.
class ReferenceCorrections {
public:
    /// \pre the model has correctives
    ReferenceCorrections(const SkinModel& model, const Pose& pose) noexcept
        : _blocks(*SkinModelAccess::correctives(model)), _weights(model, pose) {}

    /// Adds the correctives of a vertex.
    ///
    /// \param position rest space; changed
    /// \param tilt of the rest normal; changed
    void apply(std::size_t group, std::uint32_t row, glm::dvec3& position,
               glm::dvec3& tilt) noexcept {
        for (std::uint32_t i = _blocks.firstRange[group]; i < _blocks.firstRange[group + 1]; ++i) {
            const CorrectiveBlocks::Range& range = _blocks.ranges[i];
            const CorrectiveRow* from = _blocks.blockOf(range, row);
            if (!from) continue;
            const CorrectiveWeights::Weights* weights = _weights.of(range.joint);
            if (!weights) continue;
            for (std::size_t k = 0; k < _blocks.joints[range.joint].modes; ++k)
                for (int axis = 0; axis < 3; ++axis, ++from)
                    position[axis] +=
                        double(weights->positions[k]) * double(from->lane[row % kBlock]);
            from = _blocks.normalBlockOf(range, row);
            if (!from) continue;
            for (std::size_t k = 0; k < _blocks.joints[range.joint].modes; ++k)
                for (int axis = 0; axis < 3; ++axis, ++from)
                    tilt[axis] += double(weights->normals[k]) * double(from->lane[row % kBlock]);
        }
    }

private:
    const CorrectiveBlocks& _blocks;
    CorrectiveWeights _weights;
};

/// Three rows of a block's vertex, in rest space without its translation.
glm::dvec3 vectorOf(const BlockRow* rows, std::size_t lane, const glm::dmat3& frame) {
    return frame * glm::dvec3(rows[0].lane[lane], rows[1].lane[lane], rows[2].lane[lane]);
}

/// A group's rest vertices as morph targets move them.
class MorphedGroup {
public:
    MorphedGroup(const DeformJob& job, std::size_t group) noexcept
        : _group(SkinModelAccess::blocks(*job.model).groups[group]),
          _frame(restFrame(*job.model, job.model->groups()[group])),
          _rows(job.morphed->rows() + _group.firstRow), _tilts(job.morphed->tilts()),
          _tangents(job.morphed->tangentRows()) {
        if (_tilts) _tilts += 3 * std::size_t(_group.firstBlock);
        if (_tangents) _tangents += _group.firstBlock * SkinBlocks::kTangentRows;
        const SkinModel::Group& of = job.model->groups()[group];
        if (isInJointFrame(*job.model, of))
            _origin = job.model->joints()[job.model->links()[of.firstLink + of.linkCount - 1].joint]
                          .centre;
    }

    /// \param tilt what is added to the normal; unchanged where that is nothing
    /// \param tangent the same
    void read(std::uint32_t row, glm::dvec3& position, glm::dvec3& tilt,
              glm::vec3& tangent) const noexcept {
        const std::size_t block = row / kBlock, lane = row % kBlock;
        const BlockRow* const rows = _rows + block * SkinBlocks::rowsPerBlock(_group.linkCount);
        position = _origin + vectorOf(rows, lane, _frame);
        if (_tilts) tilt = vectorOf(_tilts + 3 * block, lane, _frame);
        if (_tangents)
            tangent = vectorOf(_tangents + block * SkinBlocks::kTangentRows, lane, _frame);
    }

private:
    const SkinBlocks::Group& _group;
    glm::dmat3 _frame;
    glm::dvec3 _origin{0.0};
    const BlockRow *_rows, *_tilts, *_tangents;
};

} // namespace

bool DeformJob::runReference() const noexcept {
    if (!isValid()) return false;
    if (!morphed && isAtRest(*model, *pose)) {
        copyRest(*this, 0, model->vertexCount());
        return true;
    }
    std::optional<ReferenceCorrections> corrections;
    if (SkinModelAccess::correctives(*model)) corrections.emplace(*model, *pose);
    for (std::size_t g = 0; g < model->groups().size(); ++g) {
        const SkinModel::Group& group = model->groups()[g];
        const Chain chain(*model, group, *pose);
        std::optional<SurfaceChain> surface;
        if (SkinModelAccess::gradients(*model)) surface.emplace(*model, g, *pose);
        if (surface && !surface->tilts()) surface.reset();
        std::optional<MorphedGroup> moved;
        if (morphed) moved.emplace(*this, g);
        const SkinModel::Ratio* ratios = model->ratios().data() + group.firstRatio;
        const std::uint32_t* order = model->order().data() + group.firstVertex;
        for (std::uint32_t i = 0; i < group.vertexCount; ++i, ratios += group.partialCount) {
            const std::uint32_t v = order[i];
            glm::dvec3 rest = model->positions()[v];
            glm::vec3 normal = model->normals()[v];
            const glm::vec4 restTangent = tangents ? restTangents->tangents()[v] : glm::vec4(0.0f);
            glm::vec3 tangent(restTangent);
            glm::dvec3 tilt(0.0); // of the rest normal
            if (moved) moved->read(i, rest, tilt, tangent);
            if (corrections) corrections->apply(g, i, rest, tilt);
            glm::vec3 position = rest;
            if (normals && surface) {
                surface->apply(i, ratios, rest, normal, tilt, tangents ? &tangent : nullptr);
                chain.apply(ratios, position, nullptr);
            } else {
                if (tilt != glm::dvec3(0.0)) tiltNormal(tilt, normal, tangent);
                chain.apply(ratios, position, normals ? &normal : nullptr,
                            tangents ? &tangent : nullptr);
            }
            positions[v] = position;
            if (normals) normals[v] = normal;
            if (tangents) tangents[v] = glm::vec4(tangent, restTangent.w);
        }
    }
    return true;
}

} // namespace osgSkin
