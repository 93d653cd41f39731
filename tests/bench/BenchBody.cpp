// SPDX-License-Identifier: MIT
#include "BenchBody.h"

#include "Subdivide.h"

#include <osgSkin/BoneReader>
#include <osgSkin/Correctives>
#include <osgSkin/GlmOsg>
#include <osgSkinBind/Bind>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinMotion/ApplyFrame>
#include <osgSkinRig/MakeSkeleton>
#include <osgSkinRig/Motion>
#include <osgSkinRig/Retarget>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <osgAnimation/RigTransformSoftware>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <set>
#include <vector>

namespace bench {

namespace {

/// Drops weights that are not positive and normalises the rest.
Weights::Vertex normalised(const std::map<std::uint32_t, double>& weights) {
    double sum = 0.0;
    for (const auto& [joint, weight] : weights) sum += std::max(0.0, weight);
    Weights::Vertex result;
    for (const auto& [joint, weight] : weights)
        if (weight > 0.0) result.emplace_back(joint, static_cast<float>(weight / sum));
    return result;
}

} // namespace

std::size_t Weights::groupCount() const {
    return std::set<Vertex>(vertices.begin(), vertices.end()).size();
}

Weights readPaintedWeights(const std::string& file, const std::vector<osgSkin::BoundJoint>& joints,
                           std::size_t vertices) {
    Weights result;
    std::ifstream in(file);
    if (!in) return result;
    result.name = std::filesystem::path(file).stem().string();
    std::map<std::string, std::uint32_t> index;
    for (std::uint32_t j = 0; j < joints.size(); ++j) index[joints[j].name] = j;
    std::vector<std::map<std::uint32_t, double>> painted(vertices);
    const nlohmann::json document = nlohmann::json::parse(in);
    for (const auto& [bone, pairs] : document.at("weights").items())
        if (const auto joint = index.find(bone); joint != index.end())
            for (const nlohmann::json& pair : pairs)
                painted.at(pair[0].get<std::size_t>())[joint->second] += pair[1].get<double>();
    for (auto& vertex : painted) {
        if (vertex.empty()) vertex[0] = 1.0;
        result.vertices.push_back(normalised(vertex));
    }
    return result;
}

Weights weightsFromRatios(const osgSkin::Binding& binding) {
    Weights result;
    result.name = "from our own ratios";
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        std::map<std::uint32_t, double> weights;
        for (std::uint32_t i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1]; ++i) {
            const osgSkin::Influence& influence = binding.influences[i];
            const auto share = static_cast<double>(influence.bend);
            weights[influence.joint] += share;
            // Joints that the vertex does not follow pass on their child's share.
            int parent = binding.joints[influence.joint].parent;
            while (parent > 0 && !weights.count(static_cast<std::uint32_t>(parent)))
                parent = binding.joints[static_cast<std::size_t>(parent)].parent;
            if (parent >= 0) weights[static_cast<std::uint32_t>(parent)] -= share;
        }
        result.vertices.push_back(normalised(weights));
    }
    return result;
}

Weights blend(const Weights& weights, const std::vector<Blend>& vertices) {
    Weights result;
    result.name = weights.name;
    result.vertices.reserve(vertices.size());
    for (const Blend& vertex : vertices) {
        if (vertex.share[0] == 1.0) {
            result.vertices.push_back(weights.vertices[vertex.corner[0]]);
            continue;
        }
        std::map<std::uint32_t, double> sum;
        for (std::size_t k = 0; k < 3; ++k)
            for (const auto& [joint, weight] : weights.vertices[vertex.corner[k]])
                sum[joint] += vertex.share[k] * static_cast<double>(weight);
        result.vertices.push_back(normalised(sum));
    }
    return result;
}

namespace {

/// The correctives of the new vertices, as means of the old ones. Empty if there are no
/// correctives.
osgSkin::Correctives blend(const osgSkin::Correctives& correctives,
                           const std::vector<Blend>& vertices) {
    osgSkin::Correctives result;
    if (correctives.empty()) return result;
    result.joints = correctives.joints;
    result.firstEntry.push_back(0);
    for (const Blend& vertex : vertices) {
        struct Sums {
            std::vector<double> shares, normalShares;
        };
        std::map<std::uint32_t, Sums> sums; // by joint
        for (std::size_t k = 0; k < 3; ++k) {
            if (vertex.share[k] == 0.0) continue;
            const std::uint32_t v = vertex.corner[k];
            for (std::uint32_t i = correctives.firstEntry[v]; i < correctives.firstEntry[v + 1];
                 ++i) {
                const osgSkin::Correctives::Entry& entry = correctives.entries[i];
                const auto add = [&](const std::vector<std::int16_t>& from,
                                     std::vector<double>& sum) {
                    if (from.empty()) return;
                    sum.resize(correctives.sharesOf(entry.joint), 0.0);
                    for (std::size_t s = 0; s < sum.size(); ++s)
                        sum[s] += vertex.share[k] * from[entry.firstShare + s];
                };
                add(correctives.shares, sums[entry.joint].shares);
                add(correctives.normalShares, sums[entry.joint].normalShares);
            }
        }
        for (const auto& [joint, sum] : sums) {
            result.entries.push_back({joint, static_cast<std::uint32_t>(result.shares.size())});
            for (const double share : sum.shares)
                result.shares.push_back(static_cast<std::int16_t>(std::lrint(share)));
            for (const double share : sum.normalShares)
                result.normalShares.push_back(static_cast<std::int16_t>(std::lrint(share)));
        }
        result.firstEntry.push_back(static_cast<std::uint32_t>(result.entries.size()));
    }
    return result;
}

struct Files {
    std::string name, mesh, skeleton, motion, weights;
    std::size_t skipFrames;
};

Files files() {
    const std::string shared = OSGSKIN_SHARED_DATA;
    Files body4k{"body4k_neutral",
                 shared + "/makehuman/body/body4k_neutral.obj",
                 shared + "/makehuman/rig/cmu_mb_neutral.bvh",
                 shared + "/cmu/mb/12_01_walk_pybvh.bvh",
                 shared + "/makehuman/weights/body4k_weights_cmu_mb.json",
                 1};
    if (std::filesystem::exists(body4k.mesh)) return body4k;
    const std::string own = OSGSKIN_DATA;
    return {"thrower", own + "/thrower.obj", own + "/thrower.bvh", own + "/throw.bvh", "", 0};
}

std::vector<glm::vec3> smoothNormals(const std::vector<glm::vec3>& positions,
                                     const std::vector<std::uint32_t>& triangles) {
    std::vector<glm::vec3> normals(positions.size(), glm::vec3(0.0f));
    for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
        const glm::vec3& a = positions[triangles[t]];
        const glm::vec3 area =
            glm::cross(positions[triangles[t + 1]] - a, positions[triangles[t + 2]] - a);
        for (std::size_t k = 0; k < 3; ++k) normals[triangles[t + k]] += area;
    }
    for (glm::vec3& n : normals) n = glm::normalize(n);
    return normals;
}

osgSkin::Binding blend(const osgSkin::Binding& binding, const std::vector<Blend>& vertices) {
    osgSkin::Binding result;
    result.joints = binding.joints;
    result.firstInfluence.push_back(0);
    for (const Blend& vertex : vertices) {
        std::map<std::uint32_t, std::pair<double, double>> sum;
        std::map<std::uint32_t, osgSkin::RatioGradient> gradients;
        for (std::size_t k = 0; k < 3; ++k) {
            if (vertex.share[k] == 0.0) continue;
            const std::uint32_t v = vertex.corner[k];
            for (std::uint32_t i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1];
                 ++i) {
                const osgSkin::Influence& influence = binding.influences[i];
                sum[influence.joint].first += vertex.share[k] * static_cast<double>(influence.bend);
                sum[influence.joint].second +=
                    vertex.share[k] * static_cast<double>(influence.twist);
                if (binding.gradients.empty()) continue;
                osgSkin::RatioGradient& gradient = gradients[influence.joint];
                gradient.bend += static_cast<float>(vertex.share[k]) * binding.gradients[i].bend;
                gradient.twist += static_cast<float>(vertex.share[k]) * binding.gradients[i].twist;
            }
        }
        for (const auto& [joint, gradient] : gradients) result.gradients.push_back(gradient);
        for (const auto& [joint, ratio] : sum)
            result.influences.push_back({joint, std::min(1.0f, static_cast<float>(ratio.first)),
                                         std::min(1.0f, static_cast<float>(ratio.second))});
        result.regions.push_back(binding.regions[vertex.corner[0]]);
        result.firstInfluence.push_back(static_cast<std::uint32_t>(result.influences.size()));
    }
    result.correctives = blend(binding.correctives, vertices);
    return result;
}

std::vector<glm::vec3> blend(const std::vector<glm::vec3>& vectors,
                             const std::vector<Blend>& vertices) {
    std::vector<glm::vec3> result;
    for (const Blend& vertex : vertices) {
        glm::vec3 sum(0.0f);
        for (std::size_t k = 0; k < 3; ++k)
            sum += static_cast<float>(vertex.share[k]) * vectors[vertex.corner[k]];
        result.push_back(sum);
    }
    return result;
}

/// Sorts the vertices as attachSkin() does, so that their results are written in order.
void bringIntoOrder(Body& body) {
    std::vector<std::uint32_t> source(body.positions.size());
    std::iota(source.begin(), source.end(), 0u);
    const std::vector<std::uint32_t> order = osgSkin::SkinModel::bestOrder(body.binding, source);
    std::vector<Blend> vertices;
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        source[order[i]] = i;
        vertices.push_back({{order[i], order[i], order[i]}, {1.0, 0.0, 0.0}});
    }
    body.binding = blend(body.binding, vertices);
    body.positions = blend(body.positions, vertices);
    body.normals = blend(body.normals, vertices);
    if (!body.weights.vertices.empty()) body.weights = blend(body.weights, vertices);
    for (std::uint32_t& corner : body.triangles) corner = source[corner];
}

Body load(Kind kind) {
    const Files file = files();
    Body body;
    body.name = file.name;
    const osgSkin::SkinMesh mesh = osgSkin::importMesh(file.mesh).mesh;
    body.rig = osgSkin::importSkeleton(file.skeleton);
    body.clip = osgSkin::retarget(osgSkin::importMotion(file.motion, file.skipFrames), body.rig);
    osgSkin::BindOptions options;
    options.surfaceNormals = kind != Kind::Turned;
    options.shapes = kind == Kind::Shaped ? osgSkin::BindOptions::Shapes::Fast
                                          : osgSkin::BindOptions::Shapes::None;
    body.binding = osgSkin::bind(mesh, body.rig, options);
    body.positions.assign(mesh.positions.begin(), mesh.positions.end());
    body.triangles = mesh.triangles();
    body.normals = smoothNormals(body.positions, body.triangles);
    body.weights =
        readPaintedWeights(file.weights, body.binding.joints, body.binding.vertexCount());
    if (body.weights.vertices.empty()) body.weights = weightsFromRatios(body.binding);
    bringIntoOrder(body);

    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(body.rig);
    osgSkin::BoneReader bones(body.binding.joints, *skeleton);
    for (std::size_t frame = 0; frame < body.clip.frames; ++frame) {
        osgSkin::applyFrame(body.clip, body.rig, frame, *skeleton);
        body.skinning.push_back(bones.read());
    }
    return body;
}

/// Finer bodies are not compared with osgAnimation: its weights would fill the memory.
constexpr std::uint32_t kMaxWeighted = 10;

Body refine(const Body& coarse, std::uint32_t parts) {
    const Subdivided mesh = subdivide(coarse.triangles, coarse.positions.size(), parts);
    Body body = coarse;
    body.weights.vertices.clear();
    body.binding = blend(coarse.binding, mesh.vertices);
    body.positions = blend(coarse.positions, mesh.vertices);
    body.normals = blend(coarse.normals, mesh.vertices);
    for (glm::vec3& n : body.normals) n = glm::normalize(n);
    body.triangles = mesh.triangles;
    if (parts <= kMaxWeighted) body.weights = blend(coarse.weights, mesh.vertices);
    bringIntoOrder(body);
    return body;
}

} // namespace

osg::ref_ptr<const osgSkin::SkinModel> Body::model() const {
    std::vector<std::uint32_t> source(positions.size());
    for (std::uint32_t v = 0; v < source.size(); ++v) source[v] = v;
    return osgSkin::SkinModel::create(binding, positions, normals, source);
}

double Body::partialPerVertex() const {
    std::size_t partial = 0;
    for (const osgSkin::Influence& i : binding.influences)
        partial += i.bend != i.twist || (i.bend > 0.0f && i.bend < 1.0f) ? 1 : 0;
    return static_cast<double>(partial) / static_cast<double>(positions.size());
}

const Body& body(std::uint32_t parts, Kind kind) {
    static std::map<std::pair<std::uint32_t, Kind>, Body> bodies;
    const auto found = bodies.find({parts, kind});
    if (found != bodies.end()) return found->second;
    Body made = parts == 1 ? load(kind) : refine(body(1, kind), parts);
    return bodies.emplace(std::pair(parts, kind), std::move(made)).first->second;
}

namespace {

osg::ref_ptr<osg::Vec3Array> toArray(const std::vector<glm::vec3>& vectors) {
    osg::ref_ptr<osg::Vec3Array> array =
        new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, static_cast<unsigned int>(vectors.size()));
    std::copy(vectors.begin(), vectors.end(), osgSkin::asGlm(array->asVector().data()));
    return array;
}

} // namespace

OsgRig::OsgRig(const Body& body)
    : _body(body), _skeleton(osgSkin::makeSkeleton(body.rig)), _rig(new osgAnimation::RigGeometry) {
    const osg::ref_ptr<osg::Geometry> source = new osg::Geometry;
    source->setVertexArray(toArray(body.positions));
    source->setNormalArray(toArray(body.normals));
    source->addPrimitiveSet(new osg::DrawElementsUInt(
        GL_TRIANGLES, static_cast<unsigned int>(body.triangles.size()), body.triangles.data()));
    const osg::ref_ptr<osgAnimation::VertexInfluenceMap> map = new osgAnimation::VertexInfluenceMap;
    for (unsigned int v = 0; v < body.weights.vertices.size(); ++v)
        for (const auto& [joint, weight] : body.weights.vertices[v]) {
            osgAnimation::VertexInfluence& influence = (*map)[body.binding.joints[joint].name];
            influence.setName(body.binding.joints[joint].name);
            influence.emplace_back(v, weight);
        }
    _rig->setInfluenceMap(map);
    _rig->setSourceGeometry(source);
    _rig->setRigTransformImplementation(new osgAnimation::RigTransformSoftware);
    _skeleton->addChild(_rig);
    // The first update finds the skeleton and groups the vertices.
    osgAnimation::UpdateRigGeometry().update(nullptr, _rig);
}

void OsgRig::pose(std::size_t frame) {
    osgSkin::applyFrame(_body.clip, _body.rig, frame, *_skeleton);
}

double OsgRig::error(std::size_t frame) const {
    const auto& skinned = static_cast<const osg::Vec3Array&>(*_rig->getVertexArray());
    double worst = 0.0;
    for (std::size_t v = 0; v < _body.positions.size(); ++v) {
        glm::dvec3 sum(0.0);
        for (const auto& [joint, weight] : _body.weights.vertices[v])
            sum += static_cast<double>(weight) *
                   glm::dvec3(_body.skinning[frame][joint] *
                              glm::dvec4(glm::dvec3(_body.positions[v]), 1.0));
        worst = std::max(
            worst,
            glm::distance(sum, osgSkin::toGlm(osg::Vec3d(skinned[static_cast<unsigned int>(v)]))));
    }
    return worst;
}

} // namespace bench
