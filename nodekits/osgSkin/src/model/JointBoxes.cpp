// SPDX-License-Identifier: MIT
#include "model/JointBoxes.h"

#include "model/CorrectiveBlocks.h"
#include "model/SkinBlocks.h"

#include <osgSkin/Error>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

/// The bend and twist of a typical pose, radians.
constexpr double kUsualBend = 0.5, kUsualTwist = 0.25;
/// Vertices that deviate by less than this in a typical pose, relative to the skin's size, have a
/// box of their own.
constexpr double kRigid = 0.008;
constexpr std::uint32_t kNone = ~0u;

/// A box before it is stored. Joints are the model's.
struct Draft {
    glm::dvec3 low{std::numeric_limits<double>::max()}, high{-low};
    std::map<std::uint32_t, JointBoxes::Term> terms; ///< by linkPlaces()
    std::map<std::uint32_t, double> reaches;         ///< shares, by joint of the correctives
};

class BoxBuilder {
public:
    BoxBuilder(const SkinModel& model, JointBoxes& boxes)
        : _model(model), _correctives(SkinModelAccess::correctives(model)), _boxes(boxes),
          _places(linkPlaces(model.joints(), model.groups(), model.links())) {
        double largest = 0.0;
        for (const glm::vec3& p : model.positions()) {
            for (int axis = 0; axis < 3; ++axis)
                largest = std::max(largest, std::abs(double(p[axis])));
            _extent = std::max(_extent, double(glm::distance(p, model.positions().front())));
        }
        boxes.rounding = 1.5e-5 * largest;
    }

    void build() {
        if (_correctives) findModeReach();
        for (std::size_t g = 0; g < _model.groups().size(); ++g)
            for (std::uint32_t row = 0; row < _model.groups()[g].vertexCount; ++row)
                addVertex(g, row);
        storeJoints();
        for (const auto& [key, draft] : _drafts) store(key.first, draft);
    }

private:
    /// A box's joint, and the one by which its vertices deviate most or kNone.
    using Key = std::pair<std::uint32_t, std::uint32_t>;

    /// Sets _terms to those of a vertex alone.
    ///
    /// \return its box's joint
    std::uint32_t findTerms(const SkinModel::Group& group, std::uint32_t row, const glm::dvec3& x) {
        const SkinModel::Link* const links = _model.links().data() + group.firstLink;
        const SkinModel::Ratio* partial =
            _model.ratios().data() + group.firstRatio + std::size_t(row) * group.partialCount;
        _terms.clear();
        std::uint32_t last = 0;
        for (std::uint32_t i = 0; i < group.linkCount; ++i) {
            const std::uint32_t k = links[i].joint;
            const BoundJoint& joint = _model.joints()[k];
            const SkinModel::Ratio ratio =
                links[i].partial ? *partial++ : SkinModel::Ratio{1.0f, 1.0f};
            const bool isFull =
                i == 0 || (joint.parent == static_cast<int>(last) && ratio.bend >= 0.5f);
            if (isFull) last = k;
            const double s = isFull ? 1.0 : 0.0;
            const double bend = std::abs(double(ratio.bend) - s);
            const double twist = std::abs(double(ratio.twist) - s);
            if (bend == 0.0 && twist == 0.0) continue;
            if (_terms.size() == JointBoxes::kMaxTerms)
                throw Error("skin model: a vertex follows more than " +
                            std::to_string(JointBoxes::kMaxTerms) +
                            " joints in part or in several branches");
            const glm::dvec3 lever = x - joint.centre;
            const double wide = glm::length(glm::cross(lever, joint.twistAxis));
            _terms.push_back(
                {k, last, isFull, bend, twist, bend * glm::length(lever), twist * wide});
        }
        return last;
    }

    void addVertex(std::size_t g, std::uint32_t row) {
        const SkinModel::Group& group = _model.groups()[g];
        const glm::dvec3 x = _model.positions()[_model.order()[group.firstVertex + row]];
        const std::uint32_t joint = findTerms(group, row, x);
        double sum = 0.0, most = 0.0;
        std::uint32_t worst = kNone;
        for (const JointBoxes::Term& term : _terms) {
            const double usual = kUsualBend * term.bendReach + kUsualTwist * term.twistReach;
            sum += usual;
            if (usual <= most) continue;
            most = usual;
            worst = term.joint;
        }
        Draft& draft = _drafts[{joint, sum < kRigid * _extent ? kNone : worst}];
        const glm::dvec3 inFrame = x * SkinModelAccess::blocks(_model).jointFrames[joint];
        draft.low = glm::min(draft.low, inFrame);
        draft.high = glm::max(draft.high, inFrame);
        for (const JointBoxes::Term& term : _terms) {
            JointBoxes::Term& all =
                draft.terms.try_emplace(_places[term.joint], term).first->second;
            all.bend = std::max(all.bend, term.bend);
            all.twist = std::max(all.twist, term.twist);
            all.bendReach = std::max(all.bendReach, term.bendReach);
            all.twistReach = std::max(all.twistReach, term.twistReach);
        }
        if (!_correctives) return;
        forEachShare(g, row, [&](std::uint32_t of, std::size_t mode, double length) {
            double& share = draft.reaches[of];
            share = std::max(share, length / modeReach(of, mode));
        });
    }

    double& modeReach(std::uint32_t joint, std::size_t mode) {
        return _boxes.modeReach[joint * CorrectiveJoint::kMaxModes + mode];
    }

    void findModeReach() {
        _boxes.modeReach.resize(_correctives->joints.size() * CorrectiveJoint::kMaxModes);
        for (std::size_t g = 0; g < _model.groups().size(); ++g)
            for (std::uint32_t row = 0; row < _model.groups()[g].vertexCount; ++row)
                forEachShare(g, row, [&](std::uint32_t joint, std::size_t mode, double length) {
                    modeReach(joint, mode) = std::max(modeReach(joint, mode), length);
                });
    }

    /// Calls each(joint, mode, length) for the shares of a vertex that are not 0.
    template <typename Each>
    void forEachShare(std::size_t g, std::uint32_t row, Each&& each) const {
        for (std::uint32_t i = _correctives->firstRange[g]; i < _correctives->firstRange[g + 1];
             ++i) {
            const CorrectiveBlocks::Range& range = _correctives->ranges[i];
            const CorrectiveRow* xyz = _correctives->blockOf(range, row);
            if (!xyz) continue;
            const std::size_t lane = row % kBlock;
            for (std::size_t k = 0; k < _correctives->joints[range.joint].modes; ++k, xyz += 3) {
                const glm::dvec3 share(xyz[0].lane[lane], xyz[1].lane[lane], xyz[2].lane[lane]);
                if (share != glm::dvec3(0.0)) each(range.joint, k, glm::length(share));
            }
        }
    }

    /// Stores the joints that boxes and terms need, and those above them.
    void storeJoints() {
        const std::vector<BoundJoint>& joints = _model.joints();
        std::vector<bool> isNeeded(joints.size(), false);
        for (const auto& [key, draft] : _drafts) {
            isNeeded[key.first] = true;
            for (const auto& [place, term] : draft.terms)
                isNeeded[term.joint] = isNeeded[term.from] = true;
        }
        for (std::size_t j = joints.size(); j-- > 1;)
            if (isNeeded[j]) isNeeded[static_cast<std::size_t>(joints[j].parent)] = true;
        _indices.resize(joints.size());
        for (std::uint32_t j = 0; j < joints.size(); ++j) {
            if (!isNeeded[j]) continue;
            _indices[j] = static_cast<int>(_boxes.joints.size());
            const int parent = joints[j].parent;
            _boxes.joints.push_back({j,
                                     parent < 0 ? -1 : _indices[static_cast<std::size_t>(parent)],
                                     SkinModelAccess::blocks(_model).jointFrames[j], 0, 0});
        }
    }

    /// \param joint the box's
    void store(std::uint32_t joint, const Draft& draft) {
        const auto sizeOf = [](const auto& list) {
            return static_cast<std::uint32_t>(list.size());
        };
        const auto indexOf = [&](std::uint32_t j) {
            return static_cast<std::uint32_t>(_indices[j]);
        };
        JointBoxes::Joint& of = _boxes.joints[indexOf(joint)];
        if (of.boxCount++ == 0) of.firstBox = sizeOf(_boxes.boxes);
        _boxes.boxes.push_back({0.5 * (draft.low + draft.high), 0.5 * (draft.high - draft.low),
                                sizeOf(_boxes.terms), sizeOf(draft.terms), sizeOf(_boxes.reaches),
                                sizeOf(draft.reaches)});
        for (const auto& [place, term] : draft.terms) {
            _boxes.terms.push_back(term);
            _boxes.terms.back().joint = indexOf(term.joint);
            _boxes.terms.back().from = indexOf(term.from);
        }
        for (const auto& [by, share] : draft.reaches) _boxes.reaches.push_back({by, share});
    }

    const SkinModel& _model;
    const CorrectiveBlocks* _correctives; ///< null without correctives
    JointBoxes& _boxes;
    std::vector<std::uint32_t> _places;                  ///< linkPlaces()
    double _extent = std::numeric_limits<double>::min(); ///< about the skin's size
    std::map<Key, Draft> _drafts;
    std::vector<JointBoxes::Term> _terms;
    std::vector<int> _indices; ///< in JointBoxes::joints, by joint of the model
};

} // namespace

JointBoxes::JointBoxes(const SkinModel& model) {
    BoxBuilder(model, *this).build();
}

} // namespace osgSkin
