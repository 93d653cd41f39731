// SPDX-License-Identifier: MIT
#include <osgSkinBind/ConvertRigs>

#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkinBind/Bind>
#include <osgSkinBind/BindWeights>
#include <osgSkinBind/MakeSkins>
#include <osgSkinBind/NonUniformScale>
#include <osgSkinBind/ShowRegions>
#include <osgSkinRig/MeshPart>
#include <osgSkinRig/ReadSkeleton>
#include <osgSkinRig/SkinMesh>

#include <osg/LOD>
#include <osg/Matrixd>
#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osg/Sequence>
#include <osg/Switch>
#include <osg/Transform>
#include <osg/TriangleIndexFunctor>
#include <osgAnimation/Animation>
#include <osgAnimation/AnimationManagerBase>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <vector>

namespace osgSkin {
namespace {

/// Finds a scene's rigs and all node paths that lead to each from its skeleton.
class RigCollector : public osg::NodeVisitor {
public:
    RigCollector() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    struct Rig {
        osg::ref_ptr<osgAnimation::RigGeometry> geometry;
        /// Nodes from below the skeleton down to the rig's parent, one list for each parent.
        std::vector<osg::NodePath> nodePaths;
        osgAnimation::Skeleton* skeleton = nullptr;
        bool severalSkeletons = false;
    };
    std::vector<Rig> rigs;             ///< in the scene's order
    osgAnimation::AnimationList clips; ///< of the animation managers in and above the scene

    /// Collects the clips of the nodes above `scene`.
    void lookAbove(osg::Node& scene) {
        for (const osg::NodePath& path : scene.getParentalNodePaths())
            for (osg::Node* node : path) addClips(*node);
    }

    void apply(osg::Node& node) override {
        addClips(node);
        traverse(node);
    }
    void apply(osg::Geometry& geometry) override { apply(static_cast<osg::Drawable&>(geometry)); }
    void apply(osg::Drawable& drawable) override {
        auto* geometry = dynamic_cast<osgAnimation::RigGeometry*>(&drawable);
        if (geometry == nullptr) return;
        osg::NodePath path = getNodePath();
        if (!path.empty() && path.back() == geometry) path.pop_back();
        osgAnimation::Skeleton* skeleton = nullptr;
        auto below = path.end();
        while (below != path.begin() && skeleton == nullptr) {
            skeleton = dynamic_cast<osgAnimation::Skeleton*>(*(below - 1));
            if (skeleton == nullptr) --below;
        }
        const auto [entry, isNew] = _index.emplace(geometry, rigs.size());
        if (isNew) {
            rigs.push_back({});
            rigs.back().geometry = geometry;
            rigs.back().skeleton = skeleton;
        }
        Rig& rig = rigs[entry->second];
        rig.severalSkeletons = rig.severalSkeletons || rig.skeleton != skeleton;
        osg::NodePath nodes(below, path.end());
        if (std::find(rig.nodePaths.begin(), rig.nodePaths.end(), nodes) == rig.nodePaths.end())
            rig.nodePaths.push_back(nodes);
    }

private:
    void addClips(osg::Node& node) {
        for (osg::Callback* callback = node.getUpdateCallback(); callback != nullptr;
             callback = callback->getNestedCallback()) {
            const auto* manager = dynamic_cast<osgAnimation::AnimationManagerBase*>(callback);
            if (manager == nullptr) continue;
            for (const auto& clip : manager->getAnimationList())
                if (clip && std::find(clips.begin(), clips.end(), clip) == clips.end())
                    clips.push_back(clip);
        }
    }

    std::map<osgAnimation::RigGeometry*, std::size_t> _index;
};

using Rig = RigCollector::Rig;

struct Triangles {
    std::vector<unsigned int> corners;
    void operator()(unsigned int a, unsigned int b, unsigned int c) {
        if (a != b && b != c && c != a) corners.insert(corners.end(), {a, b, c});
    }
};

const osg::Geometry& sourceOf(const osgAnimation::RigGeometry& rig) {
    const osg::Geometry* source = rig.getSourceGeometry();
    if (dynamic_cast<const osgAnimation::MorphGeometry*>(source) != nullptr)
        throw Error("it has morph targets");
    return source != nullptr ? *source : rig;
}

const osg::Vec3Array& verticesOf(const osg::Geometry& source) {
    const auto* vertices = dynamic_cast<const osg::Vec3Array*>(source.getVertexArray());
    if (vertices == nullptr || vertices->empty())
        throw Error("it has no vertex array of three floats");
    for (const osg::Vec3& v : *vertices)
        if (!v.valid() || !std::isfinite(v.length2())) throw Error("a vertex is not finite");
    return *vertices;
}

/// DeformableSkin draws attributes that are given per vertex or once for the whole geometry.
void checkBindings(const osg::Geometry& source, std::size_t vertices) {
    osg::Geometry::ArrayList arrays;
    source.getArrayList(arrays);
    for (const osg::ref_ptr<osg::Array>& array : arrays) {
        const auto binding = array->getBinding();
        if (binding == osg::Array::BIND_PER_PRIMITIVE_SET ||
            (binding == osg::Array::BIND_PER_VERTEX && array->getNumElements() < vertices))
            throw Error("an attribute is not given per vertex");
    }
}

osg::ref_ptr<osg::Vec3Array> smoothNormals(const osg::Vec3Array& vertices,
                                           const std::vector<unsigned int>& corners) {
    osg::ref_ptr<osg::Vec3Array> normals =
        new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, unsigned(vertices.size()));
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        const osg::Vec3& a = vertices[corners[i]];
        const osg::Vec3 area = (vertices[corners[i + 1]] - a) ^ (vertices[corners[i + 2]] - a);
        for (std::size_t k = 0; k < 3; ++k) (*normals)[corners[i + k]] += area;
    }
    for (osg::Vec3& normal : *normals)
        if (normal.normalize() == 0.0f) normal.set(0.0f, 0.0f, 1.0f);
    return normals;
}

osg::ref_ptr<osg::Vec3Array> normalsOf(const osg::Geometry& source, const osg::Vec3Array& vertices,
                                       const std::vector<unsigned int>& corners) {
    const auto* given = dynamic_cast<const osg::Vec3Array*>(source.getNormalArray());
    if (given == nullptr || given->size() < vertices.size() ||
        given->getBinding() == osg::Array::BIND_OVERALL)
        return smoothNormals(vertices, corners);
    osg::ref_ptr<osg::Vec3Array> normals =
        new osg::Vec3Array(given->begin(), given->begin() + std::ptrdiff_t(vertices.size()));
    return normals;
}

void move(const osg::Matrixd& toSkeleton, osg::Vec3Array& vertices, osg::Vec3Array& normals) {
    if (toSkeleton.isIdentity()) return; // to the last bit
    const osg::Matrixd inverse = osg::Matrixd::inverse(toSkeleton);
    for (osg::Vec3& v : vertices) v = v * toSkeleton;
    for (osg::Vec3& n : normals) {
        n = osg::Matrixd::transform3x3(inverse, n);
        n.normalize();
    }
}

MeshPart makePart(const osgAnimation::RigGeometry& rig, const osg::Matrixd& toSkeleton) {
    const osg::Geometry& source = sourceOf(rig);
    const osg::Vec3Array& given = verticesOf(source);
    checkBindings(source, given.size());
    const std::string broken = brokenPrimitive(source, given.size());
    if (!broken.empty()) throw Error("it has " + broken);
    osg::TriangleIndexFunctor<Triangles> triangles;
    source.accept(triangles);
    if (triangles.corners.empty()) throw Error("it has no triangles");

    MeshPart part;
    part.geometry = new osg::Geometry(source, osg::CopyOp::SHALLOW_COPY);
    osg::Geometry& geometry = *part.geometry;
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array(given.begin(), given.end());
    const osg::ref_ptr<osg::Vec3Array> normals = normalsOf(source, given, triangles.corners);
    move(toSkeleton, *vertices, *normals);
    geometry.setVertexArray(vertices);
    geometry.setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    geometry.removePrimitiveSet(0, geometry.getNumPrimitiveSets());
    geometry.addPrimitiveSet(new osg::DrawElementsUInt(
        GL_TRIANGLES, unsigned(triangles.corners.size()), triangles.corners.data()));
    geometry.setName(rig.getName().empty() ? source.getName() : rig.getName());
    if (rig.getStateSet() != nullptr)
        geometry.setStateSet(const_cast<osg::StateSet*>(rig.getStateSet()));
    geometry.setUpdateCallback(nullptr);
    return part;
}

VertexWeights weightsOf(const osgAnimation::RigGeometry& rig, std::size_t vertices,
                        const RestSkeleton& skeleton) {
    VertexWeights result(vertices);
    bool any = false;
    if (rig.getInfluenceMap() != nullptr)
        for (const auto& [bone, entries] : *rig.getInfluenceMap()) {
            const int joint = skeleton.find(bone);
            if (joint < 0) continue;
            for (const auto& [vertex, weight] : entries) {
                if (vertex >= vertices || !std::isfinite(weight) || weight < 0.0f)
                    throw Error("bone \"" + bone + "\" has a weight that is negative, not finite " +
                                "or for a vertex that does not exist");
                result[vertex].push_back({static_cast<std::uint32_t>(joint), double(weight)});
                any = any || weight > 0.0f;
            }
        }
    if (!any) throw Error("it has no weights for the bones of its skeleton");
    return result;
}

/// The rigs of one skeleton as one body.
struct RigBody {
    SkinMesh mesh; ///< skeleton space
    std::vector<MeshPart> parts;
    VertexWeights weights;

    /// Adds a rig as the next part.
    ///
    /// \param rig not changed
    /// \param toSkeleton from the rig's space to skeleton space
    /// \param skeleton its joints are the rig's bones, by name
    /// \throw osgSkin::Error if the rig cannot be converted; nothing is added then
    void add(const osgAnimation::RigGeometry& rig, const osg::Matrixd& toSkeleton,
             const RestSkeleton& skeleton) {
        MeshPart part = makePart(rig, toSkeleton);
        const auto& vertices = static_cast<const osg::Vec3Array&>(*part.geometry->getVertexArray());
        const VertexWeights own = weightsOf(rig, vertices.size(), skeleton);

        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        const auto firstFace = static_cast<std::uint32_t>(mesh.faceSizes.size());
        for (const osg::Vec3& v : vertices) {
            part.sourceVertex.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
            mesh.positions.push_back(toGlm(osg::Vec3d(v)));
        }
        const auto& corners =
            static_cast<const osg::DrawElementsUInt&>(*part.geometry->getPrimitiveSet(0));
        for (std::size_t i = 0; i < corners.size(); ++i) {
            mesh.faceVertices.push_back(first + corners[i]);
            if (i % 3 == 0) {
                part.sourceFace.push_back(firstFace + static_cast<std::uint32_t>(i / 3));
                mesh.faceSizes.push_back(3);
            }
        }
        weights.insert(weights.end(), own.begin(), own.end());
        parts.push_back(part);
    }
};

std::string nameOf(const Rig& rig) {
    return "rig \"" + rig.geometry->getName() + "\"";
}

BindOptions optionsFor(const RestSkeleton& skeleton, const BindOptions& wanted) {
    BindOptions options = wanted;
    for (auto joint = options.joints.begin(); joint != options.joints.end();)
        joint = skeleton.find(joint->first) < 0 ? options.joints.erase(joint) : std::next(joint);
    return options;
}

Binding bindBody(const RigBody& body, const RestSkeleton& skeleton, const ConvertOptions& options,
                 BindReport& report) {
    const BindOptions own = optionsFor(skeleton, options.bind);
    const bool painted =
        options.ratios == ConvertOptions::Ratios::Painted ||
        (options.ratios == ConvertOptions::Ratios::Best && isWellPainted(body.weights));
    Binding binding = painted ? bindWeights(body.mesh, skeleton, body.weights, own, &report)
                              : bind(body.mesh, skeleton, own, &report);
    OSG_INFO << "osgSkin: bound by " << (painted ? "painted weights" : "regions") << "\n"
             << report.text();
    return binding;
}

/// Whether a node of the path decides when its children are drawn.
bool isChosen(const osg::NodePath& path) {
    return std::any_of(path.begin(), path.end(), [](const osg::Node* node) {
        return node->getNodeMask() != ~0u || node->getCullCallback() != nullptr ||
               dynamic_cast<const osg::Switch*>(node) != nullptr ||
               dynamic_cast<const osg::LOD*>(node) != nullptr ||
               dynamic_cast<const osg::Sequence*>(node) != nullptr;
    });
}

/// Replacing a rig below a transform moves its skin out of this path (see replace()).
/// \throw osgSkin::Error if a node of the path decides when the rig is drawn
void requireDrawnAsBefore(const Rig& rig) {
    for (const osg::NodePath& path : rig.nodePaths)
        if (isChosen(path) && !osg::computeLocalToWorld(path).isIdentity())
            throw Error("it is below a transform and a switch, a level of detail, a node mask or "
                        "a cull callback");
}

/// Whether update callbacks move transforms between the skeleton and the rig.
bool isAnimatedAttachment(const Rig& rig) {
    return std::any_of(rig.nodePaths.begin(), rig.nodePaths.end(), [](const osg::NodePath& path) {
        const bool moves = std::any_of(path.begin(), path.end(), [](const osg::Node* node) {
            return node->asTransform() != nullptr && node->getUpdateCallback() != nullptr;
        });
        return moves && !osg::computeLocalToWorld(path).isIdentity();
    });
}

/// Callbacks of the application on a rig that its skin does not take over; may be empty.
std::string unsupportedParts(const osgAnimation::RigGeometry& rig) {
    const auto isOwn = [](const osg::Callback* callback) {
        return dynamic_cast<const osgAnimation::UpdateRigGeometry*>(callback) != nullptr;
    };
    bool updates = false;
    for (const osg::Callback* c = rig.getUpdateCallback(); c != nullptr; c = c->getNestedCallback())
        updates = updates || !isOwn(c);
    const osg::Drawable::ComputeBoundingBoxCallback* box = rig.getComputeBoundingBoxCallback();
    std::string result = updates ? "update callback" : "";
    if (box != nullptr &&
        dynamic_cast<const osgAnimation::RigComputeBoundingBoxCallback*>(box) == nullptr)
        result += result.empty() ? "bounding box callback" : " and bounding box callback";
    return result;
}

/// Replaces the rig by its skin.
void replace(const Rig& rig, DeformableSkin& skin) {
    skin.setName(rig.geometry->getName());
    skin.setNodeMask(rig.geometry->getNodeMask());
    skin.setUserDataContainer(rig.geometry->getUserDataContainer());
    skin.setCullCallback(rig.geometry->getCullCallback());
    skin.setEventCallback(rig.geometry->getEventCallback());
    skin.setCullingActive(rig.geometry->getCullingActive());
    if (rig.geometry->getDrawCallback()) skin.setDrawCallback(rig.geometry->getDrawCallback());
    const osg::ref_ptr<osg::Node> keep = rig.geometry;
    for (const osg::NodePath& path : rig.nodePaths) {
        osg::Group* parent = path.empty() ? rig.skeleton : path.back()->asGroup();
        if (osg::computeLocalToWorld(path).isIdentity()) {
            parent->replaceChild(rig.geometry, &skin);
            continue;
        }
        parent->removeChild(rig.geometry);
        // The skin is in skeleton space, so it leaves the transforms; keep the path's state sets.
        osg::ref_ptr<osg::StateSet> state;
        for (const osg::Node* node : path) {
            if (node->getStateSet() == nullptr) continue;
            if (!state) state = new osg::StateSet;
            state->merge(*node->getStateSet());
        }
        osg::Group* holder = rig.skeleton;
        if (state) {
            const osg::ref_ptr<osg::Group> group = new osg::Group;
            group->setStateSet(state);
            rig.skeleton->addChild(group);
            holder = group;
        }
        if (!holder->containsNode(&skin)) holder->addChild(&skin);
    }
}

void convertSkeleton(osgAnimation::Skeleton& skeleton, const std::vector<const Rig*>& rigs,
                     const ConvertOptions& options, ConvertReport& report) {
    ConvertedBody made;
    made.skeleton = &skeleton;
    made.rest = readSkeleton(skeleton);
    RigBody body;
    std::vector<const Rig*> taken;
    for (const Rig* rig : rigs) {
        try {
            requireDrawnAsBefore(*rig);
            body.add(*rig->geometry, osg::computeLocalToWorld(rig->nodePaths.front()), made.rest);
            taken.push_back(rig);
        } catch (const Error& error) {
            report.notes.push_back(nameOf(*rig) + " is left as it is: " + error.what());
        }
    }
    if (taken.empty()) return;
    made.binding = bindBody(body, made.rest, options, made.report);
    if (options.showRegions) showRegions(body.parts, made.binding);
    RigidSplit whole;
    whole.faceJoint.assign(body.mesh.faceSizes.size(), RigidSplit::kSkin);
    made.skins = makeSkins(body.mesh, body.parts, made.binding, whole).skins;
    for (std::size_t i = 0; i < taken.size(); ++i) {
        DeformableSkin& skin = *made.skins[i].drawable;
        const std::string lost = unsupportedParts(*taken[i]->geometry);
        if (!lost.empty()) report.notes.push_back(nameOf(*taken[i]) + " loses its own " + lost);
        if (isAnimatedAttachment(*taken[i]))
            report.notes.push_back(nameOf(*taken[i]) +
                                   " does not follow its transforms, which have update callbacks");
        replace(*taken[i], skin);
        report.skins.push_back(&skin);
    }
    made.mesh = std::move(body.mesh);
    made.parts = std::move(body.parts);
    report.bodies.push_back(std::move(made));
}

void noteNonUniformScale(osgAnimation::Skeleton& skeleton, const osgAnimation::AnimationList& clips,
                         ConvertReport& report) {
    const ConvertedBody& body = report.bodies.back();
    const std::vector<std::string> bones =
        findNonUniformScale(skeleton, clips, body.binding, body.skins);
    if (bones.empty()) return;
    std::string note = "skeleton \"" + skeleton.getName() + "\": " + bones.front();
    if (bones.size() > 1) note += " and " + std::to_string(bones.size() - 1) + " more";
    report.notes.push_back(note +
                           " scaled non-uniformly, mirrored or to zero, which skins do not follow");
}

} // namespace

ConvertReport convertRigs(osg::Node& scene, const ConvertOptions& options) {
    RigCollector collector;
    collector.lookAbove(scene);
    scene.accept(collector);
    ConvertReport report;
    std::vector<osgAnimation::Skeleton*> skeletons; // in the scene's order
    std::map<osgAnimation::Skeleton*, std::vector<const Rig*>> rigs;
    for (const Rig& rig : collector.rigs) {
        if (rig.skeleton == nullptr || rig.severalSkeletons) {
            report.notes.push_back(nameOf(rig) + " is left as it is: it is below " +
                                   (rig.skeleton == nullptr ? "no skeleton" : "several skeletons"));
            continue;
        }
        if (rigs[rig.skeleton].empty()) skeletons.push_back(rig.skeleton);
        rigs[rig.skeleton].push_back(&rig);
    }
    double done = 0.0;
    const double each = 1.0 / std::max(1.0, double(skeletons.size()));
    for (osgAnimation::Skeleton* skeleton : skeletons) {
        ConvertOptions own = options;
        own.bind.progress = subProgress(options.bind.progress, done, done + each);
        done += each;
        try {
            const std::size_t before = report.skins.size();
            convertSkeleton(*skeleton, rigs[skeleton], own, report);
            if (report.skins.size() > before)
                noteNonUniformScale(*skeleton, collector.clips, report);
        } catch (const Error& error) {
            for (const Rig* rig : rigs[skeleton])
                report.notes.push_back(nameOf(*rig) + " is left as it is: " + error.what());
        }
    }
    for (const std::string& note : report.notes)
        OSG_NOTICE << "osgSkin: " << onOneLine(note) << std::endl;
    return report;
}

} // namespace osgSkin
