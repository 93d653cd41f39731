// SPDX-License-Identifier: MIT
#include "model/ChainPlan.h"

#include <map>
#include <numeric>
#include <utility>

namespace osgSkin {
namespace {

using Index = ChainPlan::Index;

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
    }

private:
    static constexpr std::uint32_t kNoNumber = ~0u;
    using Made = std::map<std::pair<Index, std::uint32_t>, Index>; ///< by from and with

    const SkinModel::Link* linksOf(const SkinModel::Group& group) const {
        return _model.links().data() + group.firstLink;
    }
    std::size_t jointCount() const { return _plan.joints.size() - _firstJoint; }

    void begin() {
        _firstJoint = _plan.joints.size();
        _firstStep = _plan.steps.size();
        _states.clear();
        _outs.clear();
        _stateCount = 0;
        if (!_plan.inOrder) return;
        _plan.joints.resize(_firstJoint + _model.joints().size());
        std::iota(_plan.joints.begin() + static_cast<std::ptrdiff_t>(_firstJoint),
                  _plan.joints.end(), 0u);
        std::iota(_numbers.begin(), _numbers.end(), 0u);
    }

    void end() {
        _plan.sections.push_back(
            {static_cast<std::uint32_t>(_plan.groups.size()),
             static_cast<std::uint32_t>(_firstStep), static_cast<std::uint32_t>(_plan.steps.size()),
             static_cast<std::uint32_t>(_firstJoint), static_cast<std::uint32_t>(jointCount())});
        for (std::size_t i = _firstJoint; i < _plan.joints.size(); ++i)
            _numbers[_plan.joints[i]] = kNoNumber;
    }

    /// Whether what a group adds has room in the section.
    bool fits(const SkinModel::Group& group) const {
        std::size_t joints = jointCount(), states = _stateCount, outs = _outs.size() + 1;
        Index state = ChainPlan::kIdentity;
        bool known = true; // so far all of it is there already
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
                known && number != kNoNumber
                    ? _states.find({state, static_cast<std::uint32_t>(ChainPlan::full(number))})
                    : _states.end();
            known = found != _states.end();
            if (known)
                state = found->second;
            else
                ++states;
        }
        return joints <= ChainPlan::kMostJoints && states <= ChainPlan::kMostStates &&
               outs <= ChainPlan::kMostOuts;
    }

    void number(std::uint32_t joint) {
        if (_numbers[joint] != kNoNumber || jointCount() == ChainPlan::kMostJoints) return;
        _numbers[joint] = static_cast<std::uint32_t>(jointCount());
        _plan.joints.push_back(joint);
    }

    Index out(Index from, std::uint32_t with) {
        const auto [made, isNew] = _outs.insert({{from, with}, static_cast<Index>(_outs.size())});
        if (isNew) _plan.steps.push_back({from, made->second, true, with});
        return made->second;
    }

    Index state(Index from, std::uint32_t joint) {
        const std::uint32_t number = _numbers[joint];
        const std::uint32_t with = number == kNoNumber
                                       ? ChainPlan::kUncached | joint
                                       : static_cast<std::uint32_t>(ChainPlan::full(number));
        const auto found = _states.find({from, with});
        if (found != _states.end()) return found->second;
        if (from == ChainPlan::kIdentity && number != kNoNumber) {
            _states[{from, with}] = static_cast<Index>(with);
            return static_cast<Index>(with);
        }
        // A group too long for a section of its own goes on in the last state, which is its alone.
        const bool isNew = _stateCount < ChainPlan::kMostStates;
        if (isNew) ++_stateCount;
        const auto to = static_cast<Index>(ChainPlan::kFirstState + _stateCount - 1);
        if (isNew && _stateCount < ChainPlan::kMostStates) _states[{from, with}] = to;
        _plan.steps.push_back({from, to, false, with});
        return to;
    }

    void add(const SkinModel::Group& group) {
        const SkinModel::Link* const links = linksOf(group);
        for (const bool partial : {true, false}) // those must have numbers
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
    std::size_t _firstJoint = 0, _firstStep = 0, _stateCount = 0;
    Made _states, _outs;
};

} // namespace

ChainPlan::ChainPlan(const SkinModel& model) : inOrder(model.joints().size() <= kMostJoints) {
    ChainPlanner(model, *this).plan();
}

} // namespace osgSkin
