// SPDX-License-Identifier: MIT
#include <osgSkin/SkinModel>

#include "model/CorrectiveBlocks.h"
#include "model/GradientBlocks.h"
#include "model/JointBoxes.h"
#include "model/SkinBlocks.h"

#include <osgSkin/Binding>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace osgSkin {

/// A skin's vertices, checked against their binding and grouped for the deformation.
///
/// The vertices of a group have one signature: they follow the same joints fully and the same in
/// part. Small groups join others, whose additional joints their vertices follow by ratios of 0 or
/// 1, where that costs less than vectors with empty lanes.
class VertexGroups {
public:
    struct Joint {
        std::uint32_t index; ///< in Binding::joints
        bool partial;        ///< whether some vertices follow it in part
    };
    struct Group {
        std::vector<Joint> joints;     ///< that its vertices follow, in productOrder()
        std::uint32_t firstVertex = 0; ///< in order()
        std::uint32_t vertexCount = 0;
    };

    /// Checks and groups the vertices.
    ///
    /// \param binding must outlive this
    /// \param source for each vertex, the vertex of `binding` whose ratios it takes
    /// \throw osgSkin::Error where the binding is not valid, a source is not one of its vertices,
    ///        or a vertex follows more than SkinModel::kMaxPartialInfluences joints in part
    VertexGroups(const Binding& binding, std::vector<std::uint32_t> source);

    const Binding& binding() const { return *_binding; }
    /// For each vertex, the vertex of the binding.
    const std::vector<std::uint32_t>& source() const { return _source; }

    /// Sorted by signature, so that groups side by side begin with the same joints.
    const std::vector<Group>& groups() const { return _groups; }

    /// The order in which the deformation writes vertices: group by group, within a group sorted by
    /// the joints' correctives that they follow, otherwise as before.
    const std::vector<std::uint32_t>& order() const { return _order; }

    /// Renumbers the vertices: vertex order()[i] becomes vertex i, and order() the identity.
    void reorder();

private:
    const Binding* _binding;
    std::vector<std::uint32_t> _source;
    std::vector<Group> _groups;
    std::vector<std::uint32_t> _order;
};

namespace {

/// The most joints that a joined group follows in part; as many as bindings have.
constexpr std::size_t kMaxJoined = 4;

/// For each joint that a group's vertices follow, twice its position in the product, plus 1 where
/// they follow it in part. Sorted.
using Signature = std::vector<std::uint32_t>;

/// \param places of the joints in the product
Signature signatureOf(const Binding& binding, const std::vector<std::uint32_t>& places,
                      std::uint32_t vertex) {
    Signature signature;
    for (std::uint32_t i = binding.firstInfluence[vertex]; i < binding.firstInfluence[vertex + 1];
         ++i) {
        const Influence& influence = binding.influences[i];
        if (influence.bend == 0.0f && influence.twist == 0.0f) continue;
        signature.push_back(2 * places[influence.joint] + (influence.isPartial() ? 1u : 0u));
    }
    std::sort(signature.begin(), signature.end());
    return signature;
}

std::size_t partialCount(const Signature& signature) {
    return static_cast<std::size_t>(std::count_if(signature.begin(), signature.end(),
                                                  [](std::uint32_t key) { return key % 2 == 1; }));
}

/// The signature for vertices of both: joints that not both follow fully are followed in part, by
/// ratios 0 or 1.
void unite(const Signature& a, const Signature& b, Signature& result) {
    result.clear();
    auto i = a.begin(), k = b.begin();
    while (i != a.end() || k != b.end()) {
        const std::uint32_t joint =
            std::min(i != a.end() ? *i / 2 : *k / 2, k != b.end() ? *k / 2 : *i / 2);
        const bool inA = i != a.end() && *i / 2 == joint, inB = k != b.end() && *k / 2 == joint;
        const bool whole = inA && inB && *i % 2 == 0 && *k % 2 == 0;
        result.push_back(2 * joint + (whole ? 0u : 1u));
        if (inA) ++i;
        if (inB) ++k;
    }
}

/// The vertices of each signature. Sorted, so that groups side by side share their outer links.
using Members = std::map<Signature, std::vector<std::uint32_t>>;

/// The approximate time to deform a group, in units of one link of one block.
double costOf(const Signature& signature, std::size_t vertices) {
    constexpr double kGroup = 2.0; // to begin one
    const std::size_t count = (vertices + kBlock - 1) / kBlock;
    const auto blocks = static_cast<double>(count);
    return kGroup + blocks * (1.0 + static_cast<double>(partialCount(signature)));
}

/// Joins small groups with others where that saves time. Each tries only the groups next to it in
/// order, and fewer of those for long chains: painted weights make thousands of groups.
void joinSmall(Members& members) {
    constexpr std::size_t kSmall = 2 * kBlock;
    constexpr std::size_t kTriedOnASide = 64, kJointsTried = 64 * kTriedOnASide;
    struct Small {
        std::size_t vertices;
        Signature signature;
        bool operator<(const Small& other) const {
            return std::tie(vertices, signature) < std::tie(other.vertices, other.signature);
        }
    };
    std::vector<Small> small;
    for (const auto& [signature, vertices] : members)
        if (vertices.size() < kSmall) small.push_back({vertices.size(), signature});
    std::sort(small.begin(), small.end());
    Signature united, best;
    for (const Small& one : small) {
        const auto own = members.find(one.signature);
        if (own == members.end() || own->second.size() >= kSmall) continue;
        const std::size_t count = own->second.size();
        const std::size_t tried =
            std::min(kTriedOnASide, kJointsTried / std::max<std::size_t>(one.signature.size(), 1));
        double most = 0.0;
        auto with = members.end();
        auto other = own, last = own;
        for (std::size_t i = 0; i < tried && other != members.begin(); ++i) --other;
        for (std::size_t i = 0; i <= tried && last != members.end(); ++i) ++last;
        for (; other != last; ++other) {
            if (other == own) continue;
            unite(one.signature, other->first, united);
            if (partialCount(united) > kMaxJoined &&
                partialCount(united) > partialCount(other->first))
                continue;
            const std::size_t others = other->second.size();
            const double saved = costOf(one.signature, count) + costOf(other->first, others) -
                                 costOf(united, count + others);
            if (saved <= most) continue;
            most = saved;
            with = other;
            best = united;
        }
        if (with == members.end()) continue;
        std::vector<std::uint32_t> all = std::move(with->second);
        all.insert(all.end(), own->second.begin(), own->second.end());
        members.erase(own);
        members.erase(with);
        std::vector<std::uint32_t>& to = members[best]; // may exist already
        if (to.size() < all.size()) to.swap(all);
        to.insert(to.end(), all.begin(), all.end());
    }
}

/// \param order productOrder() of the binding's joints
Members groupVertices(const Binding& binding, const std::vector<std::uint32_t>& order,
                      const std::vector<std::uint32_t>& source) {
    const std::vector<std::uint32_t> places = productPlaces(order);
    Members members;
    for (std::uint32_t v = 0; v < source.size(); ++v) {
        if (source[v] >= binding.vertexCount())
            throw Error("skin model: vertex " + std::to_string(v) + " comes from no bound vertex");
        members[signatureOf(binding, places, source[v])].push_back(v);
    }
    joinSmall(members);
    for (auto& [signature, vertices] : members) {
        std::sort(vertices.begin(), vertices.end());
        if (binding.correctives.empty()) continue;
        std::stable_sort(vertices.begin(), vertices.end(), [&](std::uint32_t a, std::uint32_t b) {
            return correctedBy(binding, source[a]) < correctedBy(binding, source[b]);
        });
    }
    return members;
}

std::vector<VertexGroups::Joint> jointsOf(const std::vector<std::uint32_t>& order,
                                          const Signature& signature) {
    std::vector<VertexGroups::Joint> joints;
    for (const std::uint32_t key : signature) joints.push_back({order[key / 2], key % 2 == 1});
    return joints;
}

void checkPartial(const std::vector<VertexGroups::Joint>& joints, std::uint32_t vertex) {
    const auto partial = static_cast<std::size_t>(std::count_if(
        joints.begin(), joints.end(), [](const VertexGroups::Joint& j) { return j.partial; }));
    if (partial > SkinModel::kMaxPartialInfluences)
        throw Error("skin model: vertex " + std::to_string(vertex) + " follows " +
                    std::to_string(partial) + " joints partly, expected at most " +
                    std::to_string(SkinModel::kMaxPartialInfluences));
}

/// Appends the ratios of a group's vertices for its partial joints.
void addRatios(const VertexGroups& vertices, const VertexGroups::Group& group,
               std::vector<SkinModel::Ratio>& ratios) {
    const Binding& binding = vertices.binding();
    for (std::uint32_t k = 0; k < group.vertexCount; ++k) {
        const std::uint32_t s = vertices.source()[vertices.order()[group.firstVertex + k]];
        for (const VertexGroups::Joint& joint : group.joints) {
            if (!joint.partial) continue;
            const Influence* own = influenceOf(binding, s, joint.index);
            ratios.push_back(own ? SkinModel::Ratio{own->bend, own->twist}
                                 : SkinModel::Ratio{0.0f, 0.0f});
        }
    }
}

/// Products of longer normals leave single precision.
constexpr float kLongestNormal = 10.0f;

/// Written so that NaN is refused.
void checkVertices(const std::vector<glm::vec3>& positions, const std::vector<glm::vec3>& normals,
                   std::size_t sources) {
    if (positions.size() != sources || normals.size() != sources)
        throw Error("skin model: expected one position, one normal and one source per vertex");
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const bool isPlace = isInRange(positions[v]);
        if (isPlace && glm::length(normals[v]) <= kLongestNormal) continue;
        throw Error("skin model: vertex " + std::to_string(v) +
                    (isPlace ? " has a normal that is not finite, or longer than 10"
                             : " has a position that is not finite, or beyond -1e18 to 1e18"));
    }
}

std::vector<glm::vec3> gather(const std::vector<glm::vec3>& vectors,
                              const std::vector<std::uint32_t>& order) {
    std::vector<glm::vec3> result;
    result.reserve(order.size());
    for (const std::uint32_t v : order) result.push_back(vectors[v]);
    return result;
}

} // namespace

VertexGroups::VertexGroups(const Binding& binding, std::vector<std::uint32_t> source)
    : _binding(&binding), _source(std::move(source)) {
    binding.validate();
    _order.reserve(_source.size());
    const std::vector<std::uint32_t> order = productOrder(binding.joints);
    for (const auto& [signature, vertices] : groupVertices(binding, order, _source)) {
        const std::vector<Joint> joints = jointsOf(order, signature);
        checkPartial(joints, vertices.front());
        _groups.push_back({joints, static_cast<std::uint32_t>(_order.size()),
                           static_cast<std::uint32_t>(vertices.size())});
        _order.insert(_order.end(), vertices.begin(), vertices.end());
    }
}

void VertexGroups::reorder() {
    std::vector<std::uint32_t> source;
    source.reserve(_source.size());
    for (const std::uint32_t v : _order) source.push_back(_source[v]);
    _source.swap(source);
    std::iota(_order.begin(), _order.end(), 0u);
}

std::vector<std::uint32_t> SkinModel::bestOrder(const Binding& binding,
                                                const std::vector<std::uint32_t>& source) {
    return VertexGroups(binding, source).order();
}

SkinModel::SkinModel() : _blocks(std::make_shared<SkinBlocks>(*this)) {}

// Copies share the immutable data.
SkinModel::SkinModel(const SkinModel& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), _joints(other._joints), _positions(other._positions),
      _normals(other._normals), _order(other._order), _groups(other._groups), _links(other._links),
      _ratios(other._ratios), _blocks(other._blocks), _jointBoxes(other._jointBoxes),
      _correctives(other._correctives), _gradients(other._gradients) {}

SkinModel::~SkinModel() = default;

const std::vector<std::string>& SkinModel::inputs() const {
    static const std::vector<std::string> none;
    return _correctives ? _correctives->inputs : none;
}

Correctives SkinModel::correctives() const {
    return correctivesOf(*this);
}

osg::ref_ptr<const SkinModel> SkinModel::create(const Binding& binding,
                                                std::vector<glm::vec3> positions,
                                                std::vector<glm::vec3> normals,
                                                const std::vector<std::uint32_t>& source) {
    checkVertices(positions, normals, source.size());
    return arrange(VertexGroups(binding, source), std::move(positions), std::move(normals));
}

osg::ref_ptr<const SkinModel> SkinModel::create(const Binding& binding,
                                                const osg::Vec3Array* positions,
                                                const osg::Vec3Array* normals,
                                                const std::vector<std::uint32_t>& source) {
    if (!positions || !normals)
        throw Error("skin model: expected an array of positions and one of normals");
    const glm::vec3* p = asGlm(positions->asVector().data());
    const glm::vec3* n = asGlm(normals->asVector().data());
    return create(binding, {p, p + positions->size()}, {n, n + normals->size()}, source);
}

SkinModel::Ordered SkinModel::createInBestOrder(const Binding& binding,
                                                const std::vector<glm::vec3>& positions,
                                                const std::vector<glm::vec3>& normals,
                                                const std::vector<std::uint32_t>& source) {
    checkVertices(positions, normals, source.size());
    VertexGroups vertices(binding, source);
    const std::vector<std::uint32_t> order = vertices.order();
    vertices.reorder();
    return {arrange(vertices, gather(positions, order), gather(normals, order)), order};
}

namespace {

/// The most joints that all vertices together follow: small files could otherwise take very long.
constexpr std::size_t kMaxFollowed = 1'000'000'000;

[[noreturn]] void refuse(const std::string& what) {
    throw Error("skin model: " + what);
}

void checkOrder(const std::vector<std::uint32_t>& order, std::size_t vertices) {
    std::vector<bool> isThere(vertices, false);
    if (order.size() != vertices) refuse("its order is not that of its vertices");
    for (const std::uint32_t v : order) {
        if (v >= vertices || isThere[v]) refuse("its order is not that of its vertices");
        isThere[v] = true;
    }
}

/// \param links of the group, outermost first
/// \param places of the joints in the product
void checkLinks(const SkinModel::Link* links, std::size_t count,
                const std::vector<std::uint32_t>& places) {
    if (count == 0 || links[0].joint != 0 || links[0].partial)
        refuse("a group does not follow the root with ratio 1");
    std::size_t partial = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (links[i].joint >= places.size()) refuse("a group names a joint that is not there");
        if (i > 0 && places[links[i].joint] <= places[links[i - 1].joint])
            refuse("a group lists its joints out of order");
        partial += links[i].partial ? 1u : 0u;
    }
    if (partial > SkinModel::kMaxPartialInfluences)
        refuse("a group follows " + std::to_string(partial) + " joints partly, expected at most " +
               std::to_string(SkinModel::kMaxPartialInfluences));
}

} // namespace

std::vector<std::uint32_t> linkPlaces(const std::vector<BoundJoint>& joints,
                                      const std::vector<SkinModel::Group>& groups,
                                      const std::vector<SkinModel::Link>& links) {
    std::vector<std::uint32_t> places = productPlaces(productOrder(joints));
    std::size_t i = 0;
    for (const SkinModel::Group& group : groups)
        for (const std::size_t first = i; i < links.size() && i < first + group.linkCount; ++i) {
            if (links[i].joint >= places.size()) return places;
            if (i > first && places[links[i].joint] < places[links[i - 1].joint])
                return productPlaces(subtreeOrder(joints));
        }
    return places;
}

osg::ref_ptr<SkinModel> SkinModelAccess::make(Arranged&& from) {
    checkVertices(from.positions, from.normals, from.positions.size());
    checkOrder(from.order, from.positions.size());
    const std::vector<std::uint32_t> places = linkPlaces(from.joints, from.groups, from.links);
    std::size_t vertices = 0, links = 0, ratios = 0, followed = 0;
    for (SkinModel::Group& group : from.groups) {
        if (group.vertexCount == 0 || group.vertexCount > from.positions.size() - vertices ||
            group.linkCount > from.links.size() - links)
            refuse("its groups do not fit its vertices");
        const SkinModel::Link* const own = from.links.data() + links;
        checkLinks(own, group.linkCount, places);
        group.firstVertex = static_cast<std::uint32_t>(vertices);
        group.firstLink = static_cast<std::uint32_t>(links);
        group.firstRatio = static_cast<std::uint32_t>(ratios);
        group.partialCount = static_cast<std::uint32_t>(std::count_if(
            own, own + group.linkCount, [](const SkinModel::Link& l) { return l.partial; }));
        vertices += group.vertexCount;
        links += group.linkCount;
        followed += std::size_t{group.vertexCount} * group.linkCount;
        if (followed > kMaxFollowed) refuse("its vertices follow too many joints");
        ratios += std::size_t{group.vertexCount} * group.partialCount;
        if (ratios > from.ratios.size()) break;
    }
    if (vertices != from.positions.size() || links != from.links.size() ||
        ratios != from.ratios.size())
        refuse("its groups do not fit its vertices");
    for (const SkinModel::Ratio& ratio : from.ratios)
        if (!(ratio.bend >= 0.0f && ratio.bend <= 1.0f) ||
            !(ratio.twist >= 0.0f && ratio.twist <= 1.0f))
            refuse("a ratio is outside [0, 1]");
    osg::ref_ptr<SkinModel> model = new SkinModel;
    model->_joints = std::move(from.joints);
    model->_positions = std::move(from.positions);
    model->_normals = std::move(from.normals);
    model->_order = std::move(from.order);
    model->_groups = std::move(from.groups);
    model->_links = std::move(from.links);
    model->_ratios = std::move(from.ratios);
    model->_blocks = std::make_shared<SkinBlocks>(*model);
    return model;
}

void SkinModelAccess::addJointBoxes(SkinModel& model) {
    if (model.vertexCount() > 0) model._jointBoxes = std::make_shared<JointBoxes>(model);
}

osg::ref_ptr<SkinModel> SkinModel::arrange(const VertexGroups& vertices,
                                           std::vector<glm::vec3> positions,
                                           std::vector<glm::vec3> normals) {
    osg::ref_ptr<SkinModel> model = new SkinModel;
    model->_joints = vertices.binding().joints;
    model->_positions = std::move(positions);
    model->_normals = std::move(normals);
    model->_order = vertices.order();
    for (const VertexGroups::Group& grouped : vertices.groups()) {
        Group group{};
        group.firstVertex = grouped.firstVertex;
        group.vertexCount = grouped.vertexCount;
        group.firstLink = static_cast<std::uint32_t>(model->_links.size());
        group.linkCount = static_cast<std::uint32_t>(grouped.joints.size());
        group.firstRatio = static_cast<std::uint32_t>(model->_ratios.size());
        for (const VertexGroups::Joint& joint : grouped.joints) {
            model->_links.push_back({joint.index, joint.partial});
            group.partialCount += joint.partial ? 1u : 0u;
        }
        model->_groups.push_back(group);
        addRatios(vertices, grouped, model->_ratios);
    }
    model->_blocks = std::make_shared<SkinBlocks>(*model);
    if (!vertices.binding().gradients.empty())
        model->_gradients =
            std::make_shared<GradientBlocks>(*model, vertices.binding(), vertices.source());
    if (!vertices.binding().correctives.empty()) // after the gradients, which these read
        model->_correctives =
            std::make_shared<CorrectiveBlocks>(*model, vertices.binding(), vertices.source());
    SkinModelAccess::addJointBoxes(*model);
    return model;
}

} // namespace osgSkin
