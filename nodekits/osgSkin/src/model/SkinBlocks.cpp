// SPDX-License-Identifier: MIT
#include "model/SkinBlocks.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>
#include <osgSkin/SkinTangents>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace osgSkin {
namespace {

using Index = ChainPlan::Index;
using State = ChainPlan::State;

PlannedFrame planFrame(const BoundJoint& joint, std::uint32_t number) {
    const glm::dmat3 axes = jointFrame(joint);
    PlannedFrame frame{};
    frame.joint = number;
    for (int axis = 0; axis < 3; ++axis) {
        frame.e1[axis] = roundedToFloat(axes[0][axis]);
        frame.e2[axis] = roundedToFloat(axes[1][axis]);
        frame.w[axis] = roundedToFloat(axes[2][axis]);
    }
    return frame;
}

/// The map to a joint's frame: rows v, w x v, w.
PlannedWideInto planWideInto(const BoundJoint& joint, std::uint32_t number) {
    const glm::dmat3 axes = jointFrame(joint); // e1, e2, w
    PlannedWideInto map{};
    map.joint = number;
    for (int column = 0; column < 4; ++column) {
        const glm::dvec3 along = column < 3 ? glm::dvec3(glm::row(axes, column))
                                            : -joint.centre * axes; // transposed: into the frame
        const std::size_t first = 4 * static_cast<std::size_t>(column);
        double* const byCosine = map.byCosine + first;
        double* const bySine = map.bySine + first;
        byCosine[0] = bySine[1] = along[0];
        byCosine[1] = bySine[0] = along[1];
        bySine[1] = -bySine[1];
        map.constant[first + 2] = along[2];
    }
    map.constant[15] = 1.0;
    return map;
}

/// Fills a plan, section by section.
class ChainPlanner {
public:
    ChainPlanner(const SkinModel& model, ChainPlan& plan)
        : _model(model), _plan(plan), _numbers(model.joints().size(), kNoNumber) {}

    void plan() {
        begin();
        for (const SkinModel::Group& group : _model.groups()) {
            if (!fits(group)) {
                end();
                begin();
            }
            add(group);
        }
        end();
        addSection(); // behind the last
        _plan.arePartial.resize(_plan.joints.size() + ChainPlan::kMaxJoints, 0);
        for (std::size_t i = 0; i + 1 < _plan.sections.size(); ++i)
            for (std::size_t f = _plan.sections[i].frame; f < _plan.sections[i + 1].frame; ++f)
                _plan.arePartial[_plan.sections[i].joint + _plan.frames[f].joint] = 1;
    }

private:
    static constexpr std::uint32_t kNoNumber = ~0u;

    const SkinModel::Link* linksOf(const SkinModel::Group& group) const {
        return _model.links().data() + group.firstLink;
    }

    const ChainPlan::Section& section() const { return _plan.sections.back(); }
    std::size_t jointCount() const { return _plan.joints.size() - section().joint; }
    std::size_t outCount() const { return _plan.outs.size() - section().out; }

    void addSection() {
        const auto behind = [](const auto& all) { return static_cast<std::uint32_t>(all.size()); };
        _plan.sections.push_back({behind(_plan.groups), behind(_plan.joints), behind(_plan.frames),
                                  behind(_plan.wideIntos), behind(_plan.states),
                                  behind(_plan.outs)});
    }

    void begin() {
        addSection();
        _states.clear();
        _outs.clear();
        _about.clear();
        _stateCount = _narrowedCount = 0;
        if (!_plan.inOrder) return;
        _plan.joints.resize(section().joint + _model.joints().size());
        std::iota(_plan.joints.begin() + static_cast<std::ptrdiff_t>(section().joint),
                  _plan.joints.end(), 0u);
        std::iota(_numbers.begin(), _numbers.end(), 0u);
    }

    void end() {
        for (std::size_t i = section().joint; i < _plan.joints.size(); ++i)
            _numbers[_plan.joints[i]] = kNoNumber;
    }

    /// Whether a group's maps fit into the section.
    bool fits(const SkinModel::Group& group) const {
        std::size_t joints = jointCount(), states = _stateCount, outs = outCount() + 1;
        Index state = ChainPlan::kIdentity;
        bool known = true; // whether the section has all maps so far
        for (std::uint32_t i = 0; i < group.linkCount; ++i) {
            const SkinModel::Link& link = linksOf(group)[i];
            const std::uint32_t number = _numbers[link.joint];
            if (number == kNoNumber) ++joints;
            if (link.partial) {
                ++outs;
                known = number != kNoNumber;
                if (known) state = ChainPlan::into(number);
                continue;
            }
            const auto found =
                known && number != kNoNumber ? _states.find({state, number}) : _states.end();
            known = found != _states.end();
            if (known)
                state = found->second;
            else
                ++states;
        }
        return joints <= ChainPlan::kMaxJoints && states <= ChainPlan::kMaxStates &&
               outs <= ChainPlan::kMaxOuts;
    }

    void number(std::uint32_t joint) {
        if (_numbers[joint] != kNoNumber || jointCount() == ChainPlan::kMaxJoints) return;
        _numbers[joint] = static_cast<std::uint32_t>(jointCount());
        _plan.joints.push_back(joint);
    }

    /// A state in single precision, as of its latest step.
    Index narrowed(Index from, Index with) {
        State& state = *std::find_if(_plan.states.rbegin(), _plan.states.rend(),
                                     [&](const State& each) { return each.to == from; });
        Index& narrowed = with == ChainPlan::kIdentity ? state.narrowedLead : state.narrowed;
        if (narrowed != ChainPlan::kIdentity) return narrowed;
        narrowed = ChainPlan::narrowed(_narrowedCount++);
        const glm::dvec3 about = startOf(with);
        if (with != ChainPlan::kIdentity) state.about = {about.x, about.y, about.z};
        _about[narrowed] = about;
        return narrowed;
    }

    /// The pivot where a map starts.
    glm::dvec3 startOf(Index with) const {
        if (with == ChainPlan::kIdentity) return glm::dvec3(0.0);
        return boundJoint(with - ChainPlan::frame(0)).centre;
    }

    /// The pivot of a map that comes last.
    glm::dvec3 aboutOf(Index from) const {
        if (from == ChainPlan::kIdentity) return glm::dvec3(0.0);
        if (from < ChainPlan::frame(0)) return boundJoint(from - ChainPlan::into(0)).centre;
        return _about.at(from);
    }

    Index out(Index from, Index with) {
        if (from >= ChainPlan::state(0)) from = narrowed(from, with);
        const auto [made, isNew] = _outs.insert({{from, with}, static_cast<Index>(outCount())});
        if (!isNew) return made->second;
        const glm::dvec3 move = startOf(with) - aboutOf(from);
        _plan.outs.push_back(
            {{roundedToFloat(move.x), roundedToFloat(move.y), roundedToFloat(move.z), 1.0f},
             from,
             with});
        return made->second;
    }

    Index state(Index from, std::uint32_t joint) {
        const std::uint32_t number = _numbers[joint];
        const std::uint32_t with = number == kNoNumber ? ChainPlan::kUncached | joint : number;
        const auto found = _states.find({from, with});
        if (found != _states.end()) return found->second;
        if (from != ChainPlan::kIdentity && from < ChainPlan::state(0)) addWideInto(from);
        // A group too long for a section continues in the last state, which no other group uses.
        const bool isNew = _stateCount < ChainPlan::kMaxStates;
        if (isNew) ++_stateCount;
        const Index to = ChainPlan::state(_stateCount - 1);
        if (isNew && _stateCount < ChainPlan::kMaxStates) _states[{from, with}] = to;
        _plan.states.push_back({from, to, ChainPlan::kIdentity, ChainPlan::kIdentity, with, {}});
        return to;
    }

    const BoundJoint& boundJoint(std::uint32_t number) const {
        return _model.joints()[_plan.joints[section().joint + number]];
    }

    template <typename All>
    static bool has(const All& all, std::uint32_t first, std::uint32_t number) {
        return std::any_of(all.begin() + first, all.end(),
                           [&](const auto& each) { return each.joint == number; });
    }

    void addFrame(std::uint32_t number) {
        if (has(_plan.frames, section().frame, number)) return;
        _plan.frames.push_back(planFrame(boundJoint(number), number));
    }

    void addWideInto(Index into) {
        const std::uint32_t number = into - ChainPlan::into(0);
        if (has(_plan.wideIntos, section().wideInto, number)) return;
        _plan.wideIntos.push_back(planWideInto(boundJoint(number), number));
    }

    void add(const SkinModel::Group& group) {
        const SkinModel::Link* const links = linksOf(group);
        for (const bool partial : {true, false}) // partial ones first: they need numbers
            for (std::uint32_t i = 0; i < group.linkCount; ++i)
                if (links[i].partial == partial) number(links[i].joint);
        ChainPlan::Group added{static_cast<std::uint32_t>(_plan.links.size()), ChainPlan::kNoLead};
        Index from = ChainPlan::kIdentity;
        for (std::uint32_t i = 0; i < group.linkCount; ++i) {
            if (!links[i].partial) {
                from = state(from, links[i].joint);
                continue;
            }
            const std::uint32_t own = _numbers[links[i].joint];
            addFrame(own);
            _plan.links.push_back({static_cast<Index>(own), out(from, ChainPlan::frame(own))});
            from = ChainPlan::into(own);
        }
        if (group.linkCount == 0 || !links[group.linkCount - 1].partial)
            added.lead = out(from, ChainPlan::kIdentity);
        _plan.groups.push_back(added);
    }

    const SkinModel& _model;
    ChainPlan& _plan;
    std::vector<std::uint32_t> _numbers; ///< of the model's joints in the section
    std::size_t _stateCount = 0, _narrowedCount = 0;
    std::map<Index, glm::dvec3> _about;                       ///< of narrowed states
    std::map<std::pair<Index, std::uint32_t>, Index> _states; ///< by from and joint
    std::map<std::pair<Index, Index>, Index> _outs;           ///< by from and with
};

/// Of single precision, relative to a skin's coordinates.
constexpr double kRounding = 1e-7;

double largestCoordinate(const SkinModel& model) {
    float largest = 0.0f;
    for (const glm::vec3& p : model.positions())
        largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return static_cast<double>(largest);
}

bool isIdentity(const std::vector<std::uint32_t>& order) {
    for (std::uint32_t i = 0; i < order.size(); ++i)
        if (order[i] != i) return false;
    return true;
}

std::uint32_t frameOf(const SkinModel& model, const SkinModel::Group& group) {
    if (!isInJointFrame(model, group)) return SkinBlocks::kRestFrame;
    return model.links()[group.firstLink + group.linkCount - 1].joint;
}

/// Writes a vertex to its lane of a block.
void place(const SkinModel& model, const SkinModel::Group& group, std::uint32_t row,
           const glm::dmat3& frame, BlockRow* block) {
    const std::uint32_t v = model.order()[group.firstVertex + row];
    glm::dvec3 p = glm::dvec3(model.positions()[v]);
    if (isInJointFrame(model, group))
        p -= model.joints()[model.links()[group.firstLink + group.linkCount - 1].joint].centre;
    p = p * frame; // transposed: into the frame
    const glm::dvec3 n = glm::dvec3(model.normals()[v]) * frame;
    const std::size_t lane = row % kBlock;
    for (int axis = 0; axis < 3; ++axis) {
        block[axis].lane[lane] = static_cast<float>(p[axis]);
        block[3 + axis].lane[lane] = static_cast<float>(n[axis]);
    }
    const SkinModel::Ratio* ratios =
        model.ratios().data() + group.firstRatio + std::size_t(row) * group.partialCount;
    BlockRow* to = block + 6;
    for (std::size_t k = group.partialCount; k-- > 0; to += 2) {
        to[0].lane[lane] = ratios[k].bend;
        to[1].lane[lane] = ratios[k].twist;
    }
}

} // namespace

ChainPlan::ChainPlan(const SkinModel& model) : inOrder(model.joints().size() <= kMaxJoints) {
    ChainPlanner(model, *this).plan();
}

glm::dmat3 jointFrame(const BoundJoint& joint) {
    const glm::dvec3 w = glm::normalize(joint.twistAxis);
    const glm::dvec3 e1 = -anyPerpendicular(w);
    return {e1, glm::cross(w, e1), w};
}

glm::dmat3 restFrame(const SkinModel& model, const SkinModel::Group& group) {
    if (!isInJointFrame(model, group)) return glm::dmat3(1.0);
    return jointFrame(model.joints()[model.links()[group.firstLink + group.linkCount - 1].joint]);
}

SkinBlocks::SkinBlocks(const SkinModel& model)
    : plan(model), inOrder(isIdentity(model.order())),
      smallMove(kRounding * largestCoordinate(model)) {
    for (const BoundJoint& joint : model.joints()) jointFrames.push_back(jointFrame(joint));
    for (const SkinModel::Group& group : model.groups()) {
        const std::size_t blockRows = rowsPerBlock(group.partialCount);
        const glm::dmat3 frame = restFrame(model, group);
        const std::size_t first = rows.size();
        const std::size_t blocks = (group.vertexCount + kBlock - 1) / kBlock;
        const ChainPlan::Group& planned = plan.groups[groups.size()];
        groups.push_back({first, static_cast<std::uint32_t>(firstBlock.back()), group.firstVertex,
                          group.vertexCount, planned.firstLink, frameOf(model, group), planned.lead,
                          static_cast<std::uint16_t>(group.partialCount)});
        firstBlock.push_back(firstBlock.back() + blocks);
        rows.resize(first + blocks * blockRows, BlockRow{});
        for (std::uint32_t row = 0; row < group.vertexCount; ++row)
            place(model, group, row, frame, &rows[first + row / kBlock * blockRows]);
    }
}

const Influence* influenceOf(const Binding& binding, std::uint32_t vertex, std::uint32_t joint) {
    const auto end = binding.influences.begin() + binding.firstInfluence[vertex + 1];
    const auto found = std::find_if(binding.influences.begin() + binding.firstInfluence[vertex],
                                    end, [joint](const Influence& i) { return i.joint == joint; });
    return found == end ? nullptr : &*found;
}

osg::ref_ptr<const SkinTangents> SkinTangents::create(const osg::ref_ptr<const SkinModel>& model,
                                                      std::vector<glm::vec4> tangents) {
    if (!model) throw Error("skin tangents: expected a model");
    if (tangents.size() != model->vertexCount())
        throw Error("skin tangents: expected " + std::to_string(model->vertexCount()) +
                    " tangents, one per vertex of the model; there are " +
                    std::to_string(tangents.size()));
    for (std::size_t v = 0; v < tangents.size(); ++v)
        for (int axis = 0; axis < 4; ++axis)
            if (!std::isfinite(tangents[v][axis]))
                throw Error("skin tangents: vertex " + std::to_string(v) +
                            " has a tangent that is not finite");
    return new SkinTangents(model, std::move(tangents));
}

SkinTangents::SkinTangents(const osg::ref_ptr<const SkinModel>& model,
                           std::vector<glm::vec4> tangents)
    : _model(model), _tangents(std::move(tangents)) {
    for (const SkinModel::Group& group : _model->groups()) {
        const glm::dmat3 frame = restFrame(*_model, group);
        const std::size_t first = _rows.size();
        const std::size_t blocks = (group.vertexCount + kBlock - 1) / kBlock;
        _rows.resize(first + blocks * SkinBlocks::kTangentRows, BlockRow{});
        for (std::uint32_t row = 0; row < group.vertexCount; ++row) {
            const glm::vec4& t = _tangents[_model->order()[group.firstVertex + row]];
            const glm::vec4 turned(glm::vec3(glm::dvec3(t) * frame), t.w); // transposed
            for (int axis = 0; axis < 4; ++axis)
                _rows[first + row / kBlock * SkinBlocks::kTangentRows + std::size_t(axis)]
                    .lane[row % kBlock] = turned[axis];
        }
    }
}

SkinTangents::~SkinTangents() = default;

} // namespace osgSkin
