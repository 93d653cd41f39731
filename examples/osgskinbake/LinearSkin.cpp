// SPDX-License-Identifier: MIT
#include "LinearSkin.h"

#include <osgSkin/BendTwist>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace bake {

using osgSkin::Binding;
using osgSkin::Influence;
using osgSkin::JointMap;

JointMap operator*(const JointMap& a, const JointMap& b) {
    return {a.rotation * b.rotation, a * b.offset, a.scale * b.scale};
}

glm::dvec3 operator*(const JointMap& map, const glm::dvec3& x) {
    return map.offset + map.scale * (map.rotation * x);
}

JointMap inverse(const JointMap& map) {
    const glm::dquat back = glm::conjugate(map.rotation);
    return {back, back * map.offset * (-1.0 / map.scale), 1.0 / map.scale};
}

PosedJoints::PosedJoints(const std::vector<osgSkin::BoundJoint>& joints, const osgSkin::Pose& pose)
    : _joints(joints) {
    for (std::size_t j = 0; j < joints.size(); ++j) _turns.push_back(pose.transform(j));
}

JointMap PosedJoints::own(const Influence& ratio) const {
    const osgSkin::JointTransform& turn = _turns[ratio.joint];
    if (ratio.bend == 1.0f && ratio.twist == 1.0f) return {turn.rotation, turn.offset, turn.scale};
    const osgSkin::BoundJoint& joint = _joints[ratio.joint];
    const double bend = double(ratio.bend), scale = 1.0 + bend * (turn.scale - 1.0);
    const glm::dquat q =
        osgSkin::partialRotation(turn.split, joint.twistAxis, bend, double(ratio.twist));
    return {q, joint.centre + bend * turn.translation - scale * (q * joint.centre), scale};
}

JointMap PosedJoints::product(const Ratios& ratios) const {
    JointMap result;
    for (const Influence& ratio : ratios) result = result * own(ratio);
    return result;
}

ModeWeights modeWeights(const osgSkin::Pose& pose, const osgSkin::CorrectiveJoint& joint,
                        const Binding& binding) {
    glm::dvec2 xy(0.0);
    if (joint.basis == osgSkin::CorrectiveJoint::Basis::Input) {
        xy.x = double(pose.input(joint.joint));
    } else {
        const osgSkin::BendTwist split = pose.transform(joint.joint).split;
        xy = joint.coordinates(split.bendAxis, split.bendAngle,
                               binding.joints[joint.joint].twistAxis);
    }
    ModeWeights weights{};
    joint.weights(xy, weights.data());
    return weights;
}

std::vector<double> limbRadii(const Binding& binding, const std::vector<glm::dvec3>& rest) {
    std::vector<std::vector<double>> distances(binding.joints.size());
    for (std::size_t v = 0; v < rest.size(); ++v)
        for (std::uint32_t i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1]; ++i) {
            const Influence& influence = binding.influences[i];
            if (influence.bend < 0.25f || influence.bend > 0.75f) continue;
            const osgSkin::BoundJoint& joint = binding.joints[influence.joint];
            const glm::dvec3 d = rest[v] - joint.centre;
            distances[influence.joint].push_back(
                glm::length(d - glm::dot(d, joint.twistAxis) * joint.twistAxis));
        }
    std::vector<double> radii(distances.size(), 0.0), known;
    const auto median = [](std::vector<double>& of) {
        const auto middle = of.begin() + std::ptrdiff_t(of.size() / 2);
        std::nth_element(of.begin(), middle, of.end());
        return *middle;
    };
    for (std::size_t j = 0; j < radii.size(); ++j)
        if (!distances[j].empty()) known.push_back(radii[j] = median(distances[j]));
    const double other = known.empty() ? 1.0 : median(known);
    for (double& radius : radii)
        if (!(radius > 0.0)) radius = other;
    return radii;
}

namespace {

constexpr std::size_t kNear = 12; ///< nearest helpers that a vertex's weights are chosen from
constexpr std::size_t kCandidates = kNear + 8; ///< and others
constexpr double kNegligible = 0.002;   ///< error in radii of the limb; no helper is made for it
constexpr double kLeast = 0.002;        ///< smallest weight
constexpr std::size_t kMaxTried = 6000; ///< vertices for which helpers are chosen

/// Products of distances from a vertex, of up to kCandidates helpers.
using Gram = std::array<std::array<double, kCandidates>, kCandidates>;
using Weights = std::array<double, kCandidates>;

double squaredError(const Gram& gram, const Weights& w) {
    double sum = 0.0;
    for (std::size_t i = 0; i < kCandidates; ++i)
        for (std::size_t k = 0; w[i] > 0.0 && k < kCandidates; ++k) sum += w[i] * gram[i][k] * w[k];
    return sum;
}

/// The weights of sum 1, of any sign, with the least error, where only `used` may be other than 0.
Weights affineWeights(const Gram& gram, const std::vector<std::size_t>& used) {
    // Cholesky; a little on the diagonal separates helpers that move alike.
    const std::size_t n = used.size();
    Gram factor{};
    double largest = 0.0;
    for (const std::size_t i : used) largest = std::max(largest, gram[i][i]);
    const double little = 1e-12 * largest + std::numeric_limits<double>::min();
    std::array<double, kCandidates> z{};
    for (std::size_t i = 0; i < n; ++i) {
        double one = 1.0;
        for (std::size_t k = 0; k <= i; ++k) {
            double sum = gram[used[i]][used[k]] + (i == k ? little : 0.0);
            for (std::size_t m = 0; m < k; ++m) sum -= factor[i][m] * factor[k][m];
            factor[i][k] = i == k ? std::sqrt(std::max(sum, little)) : sum / factor[k][k];
            if (k < i) one -= factor[i][k] * z[k];
        }
        z[i] = one / factor[i][i];
    }
    double total = 0.0;
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) z[i] -= factor[k][i] * z[k];
        total += z[i] /= factor[i][i];
    }
    Weights result{};
    for (std::size_t i = 0; i < n; ++i) result[used[i]] = z[i] / total;
    return result;
}

/// The weights of sum 1 and at least 0 with the least error: the point nearest to the vertex in the
/// hull of its positions by each helper alone (Wolfe 1976).
Weights hullWeights(const Gram& gram, const std::vector<std::size_t>& allowed) {
    std::vector<std::size_t> used{
        *std::min_element(allowed.begin(), allowed.end(),
                          [&](std::size_t a, std::size_t b) { return gram[a][a] < gram[b][b]; })};
    Weights w{};
    w[used[0]] = 1.0;
    for (std::size_t round = 0; round < 3 * kCandidates; ++round) {
        std::size_t best = kCandidates;
        double least = squaredError(gram, w) * (1.0 - 1e-9);
        for (const std::size_t i : allowed) {
            double slope = 0.0;
            for (const std::size_t k : used) slope += gram[i][k] * w[k];
            if (w[i] <= 0.0 && slope < least) {
                least = slope;
                best = i;
            }
        }
        if (best == kCandidates) break;
        used.push_back(best);
        for (;;) {
            const Weights next = affineWeights(gram, used);
            double step = 1.0;
            for (const std::size_t i : used)
                if (next[i] <= 0.0) step = std::min(step, w[i] / (w[i] - next[i]));
            for (const std::size_t i : used) w[i] += step * (next[i] - w[i]);
            if (step >= 1.0) break;
            const auto gone = [&](std::size_t i) { return w[i] <= 1e-12; };
            for (const std::size_t i : used)
                if (gone(i)) w[i] = 0.0;
            used.erase(std::remove_if(used.begin(), used.end(), gone), used.end());
            if (used.empty()) return w; // not reached: weights sum to 1
        }
    }
    return w;
}

/// hullWeights() of which at most `most` are not 0.
Weights fewWeights(const Gram& gram, std::size_t count, std::size_t most) {
    std::vector<std::size_t> allowed(count);
    std::iota(allowed.begin(), allowed.end(), std::size_t(0));
    Weights w = hullWeights(gram, allowed);
    for (;;) {
        allowed.clear();
        for (std::size_t i = 0; i < count; ++i)
            if (w[i] > kLeast) allowed.push_back(i);
        if (allowed.size() <= most) break;
        // Leave out the one whose loss costs least.
        double least = std::numeric_limits<double>::max();
        for (const std::size_t out : allowed) {
            std::vector<std::size_t> others;
            for (const std::size_t i : allowed)
                if (i != out) others.push_back(i);
            const Weights next = hullWeights(gram, others);
            const double error = squaredError(gram, next);
            if (error < least) {
                least = error;
                w = next;
            }
        }
    }
    return hullWeights(gram, allowed);
}

class Fit {
public:
    Fit(const Binding& binding, const std::vector<glm::dvec3>& rest,
        const std::vector<osgSkin::Pose>& poses, const LinearSkinOptions& options)
        : _binding(binding), _rest(rest), _options(options), _radii(limbRadii(binding, rest)) {
        for (const osgSkin::Pose& pose : poses) {
            _poses.emplace_back(binding.joints, pose);
            _modes.emplace_back();
            for (const osgSkin::CorrectiveJoint& joint : binding.correctives.joints)
                _modes.back().push_back(modeWeights(pose, joint, binding));
        }
        _bends.resize(binding.joints.size(), 1e-6);
        _twists = _bends;
        for (const PosedJoints& pose : _poses)
            for (std::size_t j = 0; j < _bends.size(); ++j) {
                const double count = double(_poses.size());
                _bends[j] += pose[j].split.bendAngle * pose[j].split.bendAngle / count;
                _twists[j] += pose[j].split.twistAngle * pose[j].split.twistAngle / count;
            }
        const std::vector<std::uint32_t> places =
            osgSkin::productPlaces(osgSkin::productOrder(binding.joints));
        const auto inOrder = [&](const Influence& a, const Influence& b) {
            return places[a.joint] < places[b.joint];
        };
        for (std::size_t v = 0; v < rest.size(); ++v) {
            _ratios.emplace_back(binding.influences.begin() + binding.firstInfluence[v],
                                 binding.influences.begin() + binding.firstInfluence[v + 1]);
            std::sort(_ratios[v].begin(), _ratios[v].end(), inOrder);
        }
        for (std::uint32_t j = 0; j < binding.joints.size(); ++j) {
            Ratios chain;
            for (int at = int(j); at >= 0; at = binding.joints[std::size_t(at)].parent)
                chain.push_back({std::uint32_t(at), 1.0f, 1.0f});
            std::sort(chain.begin(), chain.end(), inOrder);
            addTarget({chain, j, j});
        }
    }

    LinearSkin run() {
        LinearSkin result;
        result.vertices.resize(_rest.size());
        std::vector<Vertex> blended;
        // Copies of a vertex, as along a seam of its texture, have the same weights.
        std::map<std::vector<double>, std::size_t> known;
        std::vector<std::pair<std::uint32_t, std::size_t>> copies;
        for (std::uint32_t v = 0; v < _rest.size(); ++v) {
            const std::size_t joint = wholeJoint(v);
            if (joint < _binding.joints.size()) {
                result.vertices[v] = {{std::uint32_t(joint), 1.0f}};
                continue;
            }
            const auto [entry, isNew] = known.emplace(keyOf(v), blended.size());
            if (isNew) blended.push_back(vertexOf(v));
            copies.emplace_back(v, entry->second);
        }
        chooseHelpers(blended);
        for (Vertex& vertex : blended) {
            if (vertex.candidates.empty())
                for (std::size_t h = 0; h < _targets.size(); ++h) offer(vertex, h);
            solve(vertex);
            refine(vertex);
            result.worst = std::max(result.worst, vertex.error);
            std::sort(vertex.weights.begin(), vertex.weights.end(),
                      [](const auto& a, const auto& b) { return a.weight > b.weight; });
        }
        for (const auto& [v, i] : copies) result.vertices[v] = blended[i].weights;
        keepUsedHelpers(result);
        return result;
    }

private:
    /// A vertex that follows some joint in part.
    struct Vertex {
        std::uint32_t index = 0;
        std::uint32_t joint = 0; ///< that it follows most evenly in part
        double radius = 1.0;
        /// The nearest joints and helpers by squared distance, kNear at most, and some others.
        std::vector<std::pair<double, std::uint32_t>> candidates;
        std::vector<LinearSkin::Weight> weights;
        double error = 0.0; ///< largest over the poses, in radii
    };

    /// Where a vertex is at rest, and its ratios.
    std::vector<double> keyOf(std::uint32_t v) const {
        std::vector<double> key{_rest[v].x, _rest[v].y, _rest[v].z};
        for (const Influence& ratio : _ratios[v])
            for (const double number :
                 {double(ratio.joint), double(ratio.bend), double(ratio.twist)})
                key.push_back(number);
        return key;
    }

    /// Adds the helpers to the result, without those that no vertex needs in the end.
    void keepUsedHelpers(LinearSkin& result) const {
        const std::size_t joints = _binding.joints.size();
        std::map<std::uint32_t, std::uint32_t> numbers;
        for (std::vector<LinearSkin::Weight>& weights : result.vertices)
            for (LinearSkin::Weight& weight : weights) {
                if (weight.joint < joints) continue;
                const auto [entry, isNew] =
                    numbers.emplace(weight.joint, std::uint32_t(joints + result.helpers.size()));
                if (isNew) result.helpers.push_back(_targets[weight.joint]);
                weight.joint = entry->second;
            }
    }

    void addTarget(HelperJoint helper) {
        std::vector<JointMap> maps;
        for (const PosedJoints& pose : _poses) maps.push_back(pose.product(helper.ratios));
        _maps.push_back(std::move(maps));
        _targets.push_back(std::move(helper));
    }

    /// The joint whose motion a vertex has wholly; the number of joints if there is none.
    std::size_t wholeJoint(std::uint32_t v) const {
        for (std::size_t j = 0; j < _binding.joints.size(); ++j) {
            const Ratios& chain = _targets[j].ratios;
            if (chain.size() == _ratios[v].size() &&
                std::equal(chain.begin(), chain.end(), _ratios[v].begin(),
                           [](const Influence& a, const Influence& b) {
                               return a.joint == b.joint && a.bend == b.bend && a.twist == b.twist;
                           }))
                return j;
        }
        return _binding.joints.size();
    }

    Vertex vertexOf(std::uint32_t v) const {
        Vertex result;
        result.index = v;
        float most = -1.0f;
        for (const Influence& ratio : _ratios[v]) {
            const float evenly =
                std::max(ratio.bend * (1.0f - ratio.bend), ratio.twist * (1.0f - ratio.twist));
            if (evenly <= most) continue;
            most = evenly;
            result.joint = ratio.joint;
        }
        result.radius = _radii[result.joint];
        return result;
    }

    /// How far a helper takes a vertex from its place, roughly and squared, in the poses' mean.
    double distance(const Vertex& vertex, const Ratios& helper) const {
        const Ratios& own = _ratios[vertex.index];
        double sum = 0.0;
        const auto add = [&](std::uint32_t j, double bend, double twist) {
            const glm::dvec3 d = _rest[vertex.index] - _binding.joints[j].centre;
            sum += glm::dot(d, d) * (bend * bend * _bends[j] + twist * twist * _twists[j]);
        };
        for (const Influence& a : own) {
            const auto b = find(helper, a.joint);
            if (b == helper.end())
                add(a.joint, double(a.bend), double(a.twist));
            else if (a.bend != b->bend || a.twist != b->twist)
                add(a.joint, double(a.bend - b->bend), double(a.twist - b->twist));
        }
        for (const Influence& b : helper)
            if (find(own, b.joint) == own.end()) add(b.joint, double(b.bend), double(b.twist));
        return sum;
    }
    static Ratios::const_iterator find(const Ratios& in, std::uint32_t joint) {
        return std::find_if(in.begin(), in.end(),
                            [&](const Influence& ratio) { return ratio.joint == joint; });
    }

    /// Makes a helper a candidate of a vertex if it is one of the nearest.
    bool offer(Vertex& vertex, std::size_t helper) const {
        const std::pair<double, std::uint32_t> entry{distance(vertex, _targets[helper].ratios),
                                                     std::uint32_t(helper)};
        auto& candidates = vertex.candidates;
        // refine() may have found a helper that was made just now.
        if (std::find(candidates.begin(), candidates.end(), entry) != candidates.end())
            return false;
        const auto nearest = std::ptrdiff_t(std::min(candidates.size(), kNear - 1));
        if (candidates.size() >= kNear) {
            if (candidates[kNear - 1] <= entry) return false;
            candidates.erase(candidates.begin() + nearest);
        }
        const auto begin = candidates.begin();
        candidates.insert(std::upper_bound(begin, begin + nearest, entry), entry);
        return true;
    }

    /// Where correctives move a vertex at rest, in each pose.
    std::vector<glm::dvec3> correctedRest(std::uint32_t v) const {
        std::vector<glm::dvec3> result(_poses.size(), _rest[v]);
        const osgSkin::Correctives& from = _binding.correctives;
        if (from.empty()) return result;
        for (std::uint32_t i = from.firstEntry[v]; i < from.firstEntry[v + 1]; ++i) {
            const auto& entry = from.entries[i];
            const std::int16_t* share = &from.shares[entry.firstShare];
            for (std::size_t k = 0; k < from.joints[entry.joint].modes; ++k, share += 3) {
                const glm::dvec3 vector =
                    glm::dvec3(share[0], share[1], share[2]) / double(osgSkin::Correctives::kUnit);
                for (std::size_t p = 0; p < result.size(); ++p)
                    result[p] += _modes[p][entry.joint][k] * vector;
            }
        }
        return result;
    }

    /// Finds the weights of a vertex, and its error; keeps those that it has if they are better.
    void solve(Vertex& vertex) const {
        const std::vector<glm::dvec3> rest = correctedRest(vertex.index);
        const std::size_t count = vertex.candidates.size();
        Gram gram{};
        std::vector<std::array<glm::dvec3, kCandidates>> away(_poses.size());
        for (std::size_t p = 0; p < _poses.size(); ++p) {
            const glm::dvec3 place = _poses[p].product(_ratios[vertex.index]) * rest[p];
            for (std::size_t i = 0; i < count; ++i) {
                away[p][i] = _maps[vertex.candidates[i].second][p] * rest[p] - place;
                for (std::size_t k = 0; k <= i; ++k) gram[i][k] += glm::dot(away[p][i], away[p][k]);
            }
        }
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t k = i + 1; k < count; ++k) gram[i][k] = gram[k][i];
        const Weights weights = fewWeights(gram, count, _options.weights);
        double worst = 0.0;
        for (const auto& row : away) {
            glm::dvec3 error(0.0);
            for (std::size_t i = 0; i < count; ++i) error += weights[i] * row[i];
            worst = std::max(worst, glm::length(error) / vertex.radius);
        }
        if (!vertex.weights.empty() && worst >= vertex.error) return;
        vertex.error = worst;
        vertex.weights.clear();
        for (std::size_t i = 0; i < count; ++i)
            if (weights[i] > 0.0)
                vertex.weights.push_back({vertex.candidates[i].second, float(weights[i])});
    }

    /// Looks among all helpers for some that improve a vertex, although others are nearer.
    void refine(Vertex& vertex) const {
        const std::vector<glm::dvec3> rest = correctedRest(vertex.index);
        std::vector<glm::dvec3> places;
        for (std::size_t p = 0; p < rest.size(); ++p)
            places.push_back(_poses[p].product(_ratios[vertex.index]) * rest[p]);
        while (vertex.error > kNegligible) {
            std::vector<glm::dvec3> errors;
            double squared = 0.0;
            for (std::size_t p = 0; p < _poses.size(); ++p) {
                glm::dvec3 error = -places[p];
                for (const LinearSkin::Weight& w : vertex.weights)
                    error += double(w.weight) * (_maps[w.joint][p] * rest[p]);
                errors.push_back(error);
                squared += glm::dot(error, error);
            }
            double most = 1e-3 * std::sqrt(squared); // by how much the error may fall
            std::pair<double, std::uint32_t> best{0.0, 0};
            for (std::uint32_t h = 0; h < _targets.size(); ++h) {
                double slope = 0.0, length = 0.0;
                for (std::size_t p = 0; p < _poses.size(); ++p) {
                    const glm::dvec3 step = places[p] + errors[p] - _maps[h][p] * rest[p];
                    slope += glm::dot(step, errors[p]);
                    length += glm::dot(step, step);
                }
                if (slope <= most * std::sqrt(length)) continue;
                const std::pair<double, std::uint32_t> entry{distance(vertex, _targets[h].ratios),
                                                             h};
                const auto& known = vertex.candidates;
                // Joints of other limbs may happen to move alike in some poses.
                if (entry.first > 4.0 * known[std::min(kNear, known.size()) - 1].first) continue;
                if (std::find(known.begin(), known.end(), entry) != known.end()) continue;
                most = slope / std::sqrt(length);
                best = entry;
            }
            if (best.first == 0.0 || vertex.candidates.size() == kCandidates) return;
            Vertex next = vertex;
            next.candidates.push_back(best);
            solve(next);
            if (next.error >= vertex.error) return;
            vertex = std::move(next);
        }
    }

    /// Makes helpers of the vertices that are farthest off, a few at a time.
    void chooseHelpers(std::vector<Vertex>& blended) {
        std::vector<Vertex*> tried;
        const std::size_t step = 1 + blended.size() / kMaxTried;
        std::set<std::uint32_t> bent;
        for (std::size_t i = 0; i < blended.size(); i += step) {
            tried.push_back(&blended[i]);
            bent.insert(blended[i].joint);
            for (std::size_t h = 0; h < _targets.size(); ++h) offer(blended[i], h);
            solve(blended[i]);
        }
        const std::size_t most = _targets.size() + _options.helpers * bent.size();
        while (_targets.size() < most) {
            std::map<std::uint32_t, Vertex*> worst; // of each joint
            for (Vertex* vertex : tried) {
                Vertex*& of = worst[vertex->joint];
                if (of == nullptr || vertex->error > of->error) of = vertex;
            }
            std::vector<Vertex*> order;
            for (const auto& entry : worst) order.push_back(entry.second);
            std::sort(order.begin(), order.end(),
                      [](const Vertex* a, const Vertex* b) { return a->error > b->error; });
            const double bad = std::max(0.75 * order[0]->error, kNegligible);
            const std::size_t first = _targets.size();
            bool refined = false;
            for (Vertex* vertex : order) {
                const double before = vertex->error;
                if (before <= bad || _targets.size() == most) break;
                refine(*vertex);
                if (vertex->error < 0.8 * before)
                    refined = true;
                else
                    addTarget(helperAt(*vertex));
            }
            if (_targets.size() == first && refined) continue;
            if (_targets.size() == first) break;
            for (Vertex* vertex : tried) {
                bool changed = false;
                for (std::size_t h = first; h < _targets.size(); ++h)
                    changed = offer(*vertex, h) || changed;
                if (changed) solve(*vertex);
            }
        }
    }

    HelperJoint helperAt(const Vertex& vertex) const {
        HelperJoint result{_ratios[vertex.index], vertex.joint, 0};
        int at = _binding.joints[vertex.joint].parent;
        for (; at > 0; at = _binding.joints[std::size_t(at)].parent) {
            const auto ratio = find(result.ratios, std::uint32_t(at));
            if (ratio != result.ratios.end() && ratio->bend == 1.0f && ratio->twist == 1.0f) break;
        }
        result.parent = std::uint32_t(std::max(at, 0));
        return result;
    }

    const Binding& _binding;
    const std::vector<glm::dvec3>& _rest;
    LinearSkinOptions _options;
    std::vector<double> _radii;
    std::vector<PosedJoints> _poses;
    std::vector<std::vector<ModeWeights>> _modes; ///< of the correctives' joints in each pose
    std::vector<double> _bends, _twists;          ///< mean squared angles of each joint
    std::vector<Ratios> _ratios;                  ///< of each vertex
    std::vector<HelperJoint> _targets;            ///< the joints themselves, then the helpers
    std::vector<std::vector<JointMap>> _maps;     ///< of each of these, in each pose
};

} // namespace

LinearSkin fitLinearSkin(const Binding& binding, const std::vector<glm::dvec3>& rest,
                         const std::vector<osgSkin::Pose>& poses,
                         const LinearSkinOptions& options) {
    return Fit(binding, rest, poses, options).run();
}

} // namespace bake
