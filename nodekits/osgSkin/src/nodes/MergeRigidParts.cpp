// SPDX-License-Identifier: MIT
#include <osgSkin/MergeRigidParts>

#include "model/BindingOf.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/GlmOsg>
#include <osgSkin/RigidPart>
#include <osgSkin/ShareEqualData>

#include <osg/Geometry>
#include <osg/NodeVisitor>
#include <osg/StateSet>
#include <osgAnimation/Bone>
#include <osgAnimation/Skeleton>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <numeric>
#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

/// A rigid part that may be moved.
struct Part {
    osg::ref_ptr<RigidPart> node;
    osg::ref_ptr<osgAnimation::Bone> bone;
    const osg::Geometry* geometry; ///< at rest
    const osg::StateSet* stateSet; ///< may be null
    const DeformableSkin* morphed; ///< where the drawable is one, with morph targets
};

bool isPlain(const osg::Node& node) {
    return !node.getStateSet() && !node.getUpdateCallback() && !node.getCullCallback() &&
           !node.getEventCallback() && node.getNodeMask() == ~0u;
}

/// Finds each skeleton's own skins and rigid parts.
class Characters : public osg::NodeVisitor {
public:
    struct Found {
        std::vector<DeformableSkin*> skins;
        std::vector<Part> parts;
    };

    Characters() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Transform& node) override {
        auto* const skeleton = dynamic_cast<osgAnimation::Skeleton*>(&node);
        auto* const part = dynamic_cast<RigidPart*>(&node);
        osgAnimation::Skeleton* const outer = _skeleton;
        if (skeleton) _skeleton = skeleton;
        if (part && _skeleton) add(*part);
        if (!part) traverse(node);
        _skeleton = outer;
    }
    void apply(osg::Drawable& node) override {
        auto* const skin = dynamic_cast<DeformableSkin*>(&node);
        if (!skin || !_skeleton || !skin->getModel()) return;
        if (skin->getNumParents() != 1 || skin->getParent(0) != _skeleton) return;
        std::vector<DeformableSkin*>& skins = found[_skeleton].skins;
        if (std::find(skins.begin(), skins.end(), skin) == skins.end()) skins.push_back(skin);
    }

    std::map<osgAnimation::Skeleton*, Found> found;

private:
    void add(RigidPart& node) {
        if (node.getNumChildren() != 1 || node.getNumParents() != 1 || !isPlain(node)) return;
        auto* const bone = dynamic_cast<osgAnimation::Bone*>(node.getParent(0));
        if (!bone || bone->getInvBindMatrixInSkeletonSpace() != node.getMatrix()) return;
        const auto skeleton = std::find(getNodePath().begin(), getNodePath().end(), _skeleton);
        for (auto above = skeleton + 1; above != getNodePath().end(); ++above)
            if ((*above)->getStateSet() || (*above)->getNodeMask() != ~0u) return;
        osg::Drawable* const drawable = node.getChild(0)->asDrawable();
        if (!drawable || drawable->getNumParents() != 1 || drawable->getUpdateCallback() ||
            drawable->getCullCallback() || drawable->getEventCallback() ||
            drawable->getDrawCallback() || drawable->getNodeMask() != ~0u)
            return;
        const auto* const skin = dynamic_cast<const DeformableSkin*>(drawable);
        const osg::Geometry* const geometry =
            skin ? skin->getRestGeometry() : drawable->asGeometry();
        if (geometry)
            found[_skeleton].parts.push_back(
                {&node, bone, geometry, drawable->getStateSet(), skin});
    }

    osgAnimation::Skeleton* _skeleton = nullptr;
};

bool areEqual(const osg::StateSet* a, const osg::StateSet* b) {
    return a == b || (a && b && a->compare(*b, true) == 0);
}

/// Calls `visit` with each pair of arrays of two geometries and, for the first, a function that
/// sets it in a geometry.
template <typename Visit>
void visitArrays(const osg::Geometry& a, const osg::Geometry& b, const Visit& visit) {
    using Target = osg::Geometry;
    visit(a.getVertexArray(), b.getVertexArray(),
          [](Target& to, osg::Array* array) { to.setVertexArray(array); });
    visit(a.getNormalArray(), b.getNormalArray(),
          [](Target& to, osg::Array* array) { to.setNormalArray(array); });
    visit(a.getColorArray(), b.getColorArray(),
          [](Target& to, osg::Array* array) { to.setColorArray(array); });
    visit(a.getSecondaryColorArray(), b.getSecondaryColorArray(),
          [](Target& to, osg::Array* array) { to.setSecondaryColorArray(array); });
    visit(a.getFogCoordArray(), b.getFogCoordArray(),
          [](Target& to, osg::Array* array) { to.setFogCoordArray(array); });
    for (unsigned int i = 0; i < std::max(a.getNumTexCoordArrays(), b.getNumTexCoordArrays()); ++i)
        visit(a.getTexCoordArray(i), b.getTexCoordArray(i),
              [i](Target& to, osg::Array* array) { to.setTexCoordArray(i, array); });
    for (unsigned int i = 0;
         i < std::max(a.getNumVertexAttribArrays(), b.getNumVertexAttribArrays()); ++i)
        visit(a.getVertexAttribArray(i), b.getVertexAttribArray(i),
              [i](Target& to, osg::Array* array) { to.setVertexAttribArray(i, array); });
}

bool haveEqualArrays(const osg::Geometry& a, const osg::Geometry& b) {
    bool fit = true;
    const std::size_t vertices = b.getVertexArray() ? b.getVertexArray()->getNumElements() : 0;
    visitArrays(a, b, [&](const osg::Array* one, const osg::Array* other, const auto&) {
        if (!one && !other) return;
        if (!one || !other || typeid(*one) != typeid(*other) ||
            one->getBinding() != other->getBinding() ||
            one->getNormalize() != other->getNormalize()) {
            fit = false;
        } else if (one->getBinding() == osg::Array::BIND_OVERALL) {
            fit = fit && one->getTotalDataSize() == other->getTotalDataSize() &&
                  std::memcmp(one->getDataPointer(), other->getDataPointer(),
                              one->getTotalDataSize()) == 0;
        } else {
            fit = fit && one->getBinding() == osg::Array::BIND_PER_VERTEX &&
                  other->getNumElements() == vertices;
        }
    });
    return fit;
}

bool hasTrianglesAlone(const osg::Geometry& geometry) {
    const osg::Geometry::PrimitiveSetList& sets = geometry.getPrimitiveSetList();
    return std::all_of(sets.begin(), sets.end(), [](const osg::ref_ptr<osg::PrimitiveSet>& set) {
        return set->getMode() == GL_TRIANGLES &&
               (set->getDrawElements() ||
                set->getType() == osg::PrimitiveSet::DrawArraysPrimitiveType);
    });
}

const MorphTargets* targetsOf(const Part& part) {
    return part.morphed ? part.morphed->getMorphTargets() : nullptr;
}

bool haveEqualInitials(const MorphTargets* a, const MorphTargets* b) {
    if (!a || !b) return true;
    return std::all_of(b->targets().begin(), b->targets().end(), [a](const MorphTarget& target) {
        const std::size_t same = a->find(target.name);
        return same == a->targets().size() || a->targets()[same].initial == target.initial;
    });
}

int jointOf(const SkinModel& model, const std::string& name) {
    const auto found = std::find_if(model.joints().begin(), model.joints().end(),
                                    [&](const BoundJoint& joint) { return joint.name == name; });
    return found == model.joints().end() ? -1 : static_cast<int>(found - model.joints().begin());
}

bool takes(const DeformableSkin& skin, const Part& part) {
    const osg::Geometry& rest = *skin.getRestGeometry();
    return areEqual(skin.getStateSet(), part.stateSet) && haveEqualArrays(rest, *part.geometry) &&
           part.geometry->getVertexArray() && part.geometry->getNormalArray() &&
           hasTrianglesAlone(rest) && hasTrianglesAlone(*part.geometry) &&
           jointOf(*skin.getModel(), part.bone->getName()) >= 0 && skin.getNodeMask() == ~0u &&
           haveEqualInitials(skin.getMorphTargets(), targetsOf(part)) &&
           brokenPrimitive(*part.geometry, part.geometry->getVertexArray()->getNumElements())
               .empty();
}

/// A skin and the parts that it takes up: all their vertices, those of the skin first.
class MergedSkin {
public:
    MergedSkin(DeformableSkin& skin, const std::vector<Part>& parts)
        : _skin(skin), _binding(bindingOf(*skin.getModel())) {
        const SkinModel& model = *skin.getModel();
        _positions = model.positions();
        _normals = model.normals();
        addIndices(*skin.getRestGeometry(), 0);
        addTargets(skin, 0);
        _geometries.push_back(skin.getRestGeometry());
        for (const Part& part : parts) add(part);
    }

    /// \throw osgSkin::Error as SkinModel::create(); the skin is then unchanged
    void apply() {
        std::vector<std::uint32_t> all(_positions.size());
        std::iota(all.begin(), all.end(), 0u);
        const auto [own, order] = SkinModel::createInBestOrder(_binding, _positions, _normals, all);
        // Characters of one file that are merged one by one share these, too.
        const osg::ref_ptr<const SkinModel> model = shareEqualModel(own);
        std::vector<std::uint32_t> places(order.size());
        for (std::uint32_t i = 0; i < order.size(); ++i) places[order[i]] = i;
        const osg::ref_ptr<osg::Geometry> rest = makeGeometry(order, places);
        shareEqualArrays(*rest);
        const osg::ref_ptr<const MorphTargets> targets = makeTargets(places);
        const std::vector<glm::dmat4> skinning = _skin.getPose().skinning();
        const osg::ref_ptr<osg::StateSet> stateSet = _skin.getStateSet();
        _skin.setSkin(rest, model);
        _skin.setStateSet(stateSet);
        _skin.setMorphTargets(targets);
        for (const auto& [name, weight] : _weights) _skin.setMorph(name, weight);
        _skin.setPose(skinning.data(), skinning.size());
    }

private:
    void add(const Part& part) {
        const auto first = static_cast<std::uint32_t>(_positions.size());
        const auto& vertices =
            static_cast<const osg::Vec3Array&>(*part.geometry->getVertexArray()).asVector();
        const auto& normals =
            static_cast<const osg::Vec3Array&>(*part.geometry->getNormalArray()).asVector();
        _positions.insert(_positions.end(), asGlm(vertices.data()),
                          asGlm(vertices.data()) + vertices.size());
        _normals.insert(_normals.end(), asGlm(normals.data()),
                        asGlm(normals.data()) + normals.size());
        std::vector<Influence> chain;
        const int joint = jointOf(*_skin.getModel(), part.bone->getName());
        for (int j = joint; j >= 0; j = _binding.joints[static_cast<std::size_t>(j)].parent)
            chain.insert(chain.begin(), {static_cast<std::uint32_t>(j), 1.0f, 1.0f});
        for (std::size_t v = 0; v < vertices.size(); ++v) {
            _binding.regions.push_back(static_cast<std::uint32_t>(joint));
            _binding.influences.insert(_binding.influences.end(), chain.begin(), chain.end());
            _binding.firstInfluence.push_back(
                static_cast<std::uint32_t>(_binding.influences.size()));
            if (!_binding.correctives.empty())
                _binding.correctives.firstEntry.push_back(
                    static_cast<std::uint32_t>(_binding.correctives.entries.size()));
        }
        if (_skin.getModel()->hasSurfaceNormals())
            _binding.gradients.resize(_binding.influences.size());
        addIndices(*part.geometry, first);
        if (part.morphed) addTargets(*part.morphed, first);
        _geometries.push_back(part.geometry);
    }

    void addIndices(const osg::Geometry& geometry, std::uint32_t first) {
        for (const osg::ref_ptr<osg::PrimitiveSet>& set : geometry.getPrimitiveSetList())
            for (unsigned int i = 0; i < set->getNumIndices(); ++i)
                _indices.push_back(first + set->index(i));
    }

    void addTargets(const DeformableSkin& from, std::uint32_t first) {
        if (!from.getMorphTargets()) return;
        for (const MorphTarget& target : from.getMorphTargets()->targets()) {
            const auto known =
                std::find_if(_targets.begin(), _targets.end(),
                             [&](const MorphTarget& other) { return other.name == target.name; });
            MorphTarget& to = known == _targets.end() ? _targets.emplace_back() : *known;
            to.name = target.name;
            to.initial = target.initial;
            append(target.normals, target.vertices.size(), to.normals, to.vertices.size());
            append(target.tangents, target.vertices.size(), to.tangents, to.vertices.size());
            append(target.positions, target.vertices.size(), to.positions, to.vertices.size());
            for (const std::uint32_t v : target.vertices) to.vertices.push_back(first + v);
            _weights.emplace(target.name, from.getMorph(target.name));
        }
    }

    /// Appends offsets to those of `before` vertices; none are zeros, unless there are none at all.
    static void append(const std::vector<glm::vec3>& offsets, std::size_t count,
                       std::vector<glm::vec3>& to, std::size_t before) {
        if (offsets.empty() && to.empty()) return;
        to.resize(before);
        to.insert(to.end(), offsets.begin(), offsets.end());
        to.resize(before + count);
    }

    osg::ref_ptr<osg::Geometry> makeGeometry(const std::vector<std::uint32_t>& order,
                                             const std::vector<std::uint32_t>& places) const {
        osg::ref_ptr<osg::Geometry> made = new osg::Geometry;
        const osg::Geometry& own = *_geometries.front();
        made->setName(own.getName());
        made->setStateSet(const_cast<osg::StateSet*>(own.getStateSet()));
        visitArrays(own, own, [&](const osg::Array* array, const osg::Array*, const auto& set) {
            if (!array) return;
            osg::ref_ptr<osg::Array> copy = static_cast<osg::Array*>(array->cloneType());
            copy->setBinding(array->getBinding());
            copy->setNormalize(array->getNormalize());
            set(*made, copy);
        });
        // Merged arrays: each geometry's in turn, at their new places.
        std::uint32_t first = 0;
        for (const osg::Geometry* from : _geometries) {
            visitArrays(*made, *from,
                        [&](const osg::Array* to, const osg::Array* array, const auto&) {
                            if (array)
                                copyElements(*array, first, places, const_cast<osg::Array&>(*to));
                        });
            first += from->getVertexArray()->getNumElements();
        }
        std::vector<std::uint32_t> indices;
        indices.reserve(_indices.size());
        for (const std::uint32_t i : _indices) indices.push_back(places[i]);
        const auto count = static_cast<unsigned int>(indices.size());
        if (order.size() <= 0xffffu)
            made->addPrimitiveSet(new osg::DrawElementsUShort(
                GL_TRIANGLES, count, std::vector<GLushort>(indices.begin(), indices.end()).data()));
        else
            made->addPrimitiveSet(new osg::DrawElementsUInt(GL_TRIANGLES, count, indices.data()));
        return made;
    }

    static void copyElements(const osg::Array& from, std::uint32_t first,
                             const std::vector<std::uint32_t>& places, osg::Array& to) {
        const bool overall = from.getBinding() == osg::Array::BIND_OVERALL;
        to.resizeArray(overall ? from.getNumElements() : static_cast<unsigned int>(places.size()));
        if (to.getNumElements() == 0) return;
        auto* const bytes = static_cast<char*>(const_cast<GLvoid*>(to.getDataPointer()));
        const std::size_t size = from.getElementSize();
        for (unsigned int i = 0; i < from.getNumElements(); ++i)
            std::memcpy(bytes + size * (overall ? i : places[first + i]), from.getDataPointer(i),
                        size);
    }

    osg::ref_ptr<const MorphTargets> makeTargets(const std::vector<std::uint32_t>& places) const {
        if (_targets.empty()) return nullptr;
        std::vector<MorphTarget> targets;
        for (const MorphTarget& from : _targets) {
            std::vector<std::uint32_t> sorted(from.vertices.size());
            std::iota(sorted.begin(), sorted.end(), 0u);
            std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
                return places[from.vertices[a]] < places[from.vertices[b]];
            });
            MorphTarget& to = targets.emplace_back();
            to.name = from.name;
            to.initial = from.initial;
            for (const std::uint32_t i : sorted) {
                to.vertices.push_back(places[from.vertices[i]]);
                to.positions.push_back(from.positions[i]);
                if (!from.normals.empty()) to.normals.push_back(from.normals[i]);
                if (!from.tangents.empty()) to.tangents.push_back(from.tangents[i]);
            }
        }
        return MorphTargets::create(std::move(targets), places.size());
    }

    DeformableSkin& _skin;
    Binding _binding;
    std::vector<glm::vec3> _positions, _normals;
    std::vector<std::uint32_t> _indices;
    std::vector<MorphTarget> _targets;
    std::map<std::string, float> _weights;
    std::vector<const osg::Geometry*> _geometries;
};

} // namespace

std::size_t mergeRigidParts(osg::Node& scene) {
    Characters characters;
    scene.accept(characters);
    std::size_t moved = 0;
    for (const auto& [skeleton, found] : characters.found) {
        std::map<DeformableSkin*, std::vector<Part>> taken;
        for (const Part& part : found.parts) {
            const auto skin = std::find_if(found.skins.begin(), found.skins.end(),
                                           [&](DeformableSkin* one) { return takes(*one, part); });
            if (skin != found.skins.end()) taken[*skin].push_back(part);
        }
        for (const auto& [skin, parts] : taken) {
            MergedSkin(*skin, parts).apply();
            for (const Part& part : parts) part.bone->removeChild(part.node);
            moved += parts.size();
        }
    }
    return moved;
}

} // namespace osgSkin
