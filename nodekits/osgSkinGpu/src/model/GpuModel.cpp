// SPDX-License-Identifier: MIT
#include <osgSkinGpu/GpuModel>

#include "model/PackTexels.h"
#include "model/PackedOnce.h"

#include <osgSkin/Correctives>
#include <osgSkin/DeformJob>
#include <osgSkin/SkinModel>

#include <osg/Array>
#include <osg/ref_ptr>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// The texels in a palette where the weights of each corrective joint begin; then their end.
std::vector<unsigned int> weightTexels(const SkinModel& model,
                                       const std::vector<CorrectiveJoint>& joints) {
    std::vector<unsigned int> texels = {static_cast<unsigned int>(4 * model.joints().size())};
    for (const CorrectiveJoint& joint : joints)
        texels.push_back(texels.back() + static_cast<unsigned int>((joint.modes + 1) / 2));
    return texels;
}

constexpr unsigned int kNone = ~0u;

unsigned int halves(int low, int high) {
    return (static_cast<unsigned int>(low) & 0xffffu) | static_cast<unsigned int>(high) << 16;
}

/// The two directions along the skin that the shader derives from a normal.
struct SkinDirections {
    glm::dvec3 u, v;
};

SkinDirections skinDirections(const glm::dvec3& n) {
    const double s = n.z >= 0.0 ? 1.0 : -1.0;
    const double a = -1.0 / (s + n.z);
    const double b = n.x * n.y * a;
    return {{1.0 + s * n.x * n.x * a, s * b, -s * n.x}, {b, s + n.y * n.y * a, -n.y}};
}

/// A group's chain: the joint whose G is applied last, and the links before that, innermost first.
struct PackedChain {
    struct Link {
        unsigned int joint;
        std::uint32_t link; ///< in SkinModel::links()
        std::size_t ratio;  ///< index in the vertex's partial ratios; kFull: 1, 1
    };
    static constexpr std::size_t kFull = ~std::size_t(0);

    unsigned int anchor = kNone;
    std::vector<Link> links;

    /// The centre of the i-th link; the origin behind the last one.
    glm::dvec3 centre(const SkinModel& model, std::size_t i) const {
        return i < links.size() ? model.joints()[links[i].joint].centre : glm::dvec3(0.0);
    }
};

PackedChain chainOf(const SkinModel& model, const SkinModel::Group& group) {
    PackedChain chain;
    std::size_t partial = 0;
    for (std::uint32_t i = 0; i < group.linkCount; ++i) {
        const SkinModel::Link& link = model.links()[group.firstLink + i];
        const int above = chain.anchor == kNone ? -1 : static_cast<int>(chain.anchor);
        // Full links are a joint's G while they are a path from the root.
        if (!link.partial && chain.links.empty() && model.joints()[link.joint].parent == above)
            chain.anchor = link.joint;
        else
            chain.links.push_back(
                {link.joint, group.firstLink + i, link.partial ? partial : PackedChain::kFull});
        partial += link.partial ? 1 : 0;
    }
    std::reverse(chain.links.begin(), chain.links.end());
    return chain;
}

class Packer {
public:
    Packer(const SkinModel& model, const Correctives& correctives)
        : _model(model), _correctives(correctives), _slopes(surfaceSlopesOf(model)),
          _weights(weightTexels(model, correctives.joints)), _texels(new osg::Vec4uiArray) {}

    osg::ref_ptr<osg::Vec4uiArray> pack() {
        packJoints(_model.joints(), *_texels);
        std::vector<PackedChain> chains;
        std::vector<std::size_t> chainTexels;
        for (const SkinModel::Group& group : _model.groups()) {
            chains.push_back(chainOf(_model, group));
            chainTexels.push_back(_texels->size());
            addChain(chains.back());
        }
        const std::size_t vertices = _texels->size();
        const std::size_t count = _model.vertexCount();
        (*_texels)[0] = {word(_model.joints().size()), word(vertices), word(count),
                         word(_weights.back())};
        _texels->resize(vertices + 2 * count);
        for (std::size_t g = 0; g < chains.size(); ++g) {
            const SkinModel::Group& group = _model.groups()[g];
            const SkinModel::Ratio* ratios = _model.ratios().data() + group.firstRatio;
            for (std::uint32_t row = 0; row < group.vertexCount;
                 ++row, ratios += group.partialCount) {
                const std::uint32_t v = _model.order()[group.firstVertex + row];
                const glm::dvec3 from = _model.positions()[v];
                (*_texels)[vertices + 2 * std::size_t(v)] =
                    packedTexel(from - chains[g].centre(_model, 0), word(chainTexels[g]));
                (*_texels)[vertices + 2 * std::size_t(v) + 1] =
                    packedTexel(_model.normals()[v], word(_texels->size()));
                addLinks(chains[g], ratios);
                if (_model.hasSurfaceNormals()) addGradients(chains[g], ratios, v);
                if (!_correctives.empty()) addCorrectives(v);
            }
        }
        return _texels;
    }

private:
    static unsigned int word(std::size_t number) { return static_cast<unsigned int>(number); }

    void addChain(const PackedChain& chain) {
        _texels->push_back(
            {chain.anchor, word(chain.links.size()),
             (_correctives.empty() ? 0u : 1u) | (_model.hasSurfaceNormals() ? 2u : 0u), 0});
        for (const PackedChain::Link& link : chain.links) {
            // A full link has no gradients.
            glm::vec2 reach(-1.0f);
            if (_model.hasSurfaceNormals() && link.ratio != PackedChain::kFull)
                reach = _slopes.reach[link.link];
            _texels->push_back({link.joint, floatBits(reach.x), floatBits(reach.y), 0});
        }
        for (std::size_t i = 0; i < chain.links.size(); ++i)
            _texels->push_back(
                packedTexel(chain.centre(_model, i) - chain.centre(_model, i + 1), 0));
    }

    void addLinks(const PackedChain& chain, const SkinModel::Ratio* ratios) {
        for (const PackedChain::Link& link : chain.links) {
            const SkinModel::Ratio ratio = link.ratio == PackedChain::kFull
                                               ? SkinModel::Ratio{1.0f, 1.0f}
                                               : ratios[link.ratio];
            _texels->push_back({floatBits(ratio.bend), floatBits(ratio.twist), 0, 0});
        }
    }

    /// For each link the bend ratio's along u and v, and the twist ratio's.
    void addGradients(const PackedChain& chain, const SkinModel::Ratio* ratios,
                      std::uint32_t vertex) {
        const SkinDirections at = skinDirections(_model.normals()[vertex]);
        const auto along = [](const glm::vec3& gradient, const glm::dvec3& direction) {
            return floatBits(static_cast<float>(glm::dot(glm::dvec3(gradient), direction)));
        };
        const auto first = static_cast<std::size_t>(ratios - _model.ratios().data());
        for (const PackedChain::Link& link : chain.links) {
            const RatioGradient own = link.ratio == PackedChain::kFull
                                          ? RatioGradient{}
                                          : _slopes.gradients[first + link.ratio];
            _texels->push_back({along(own.bend, at.u), along(own.bend, at.v),
                                along(own.twist, at.u), along(own.twist, at.v)});
        }
    }

    void addCorrectives(std::uint32_t vertex) {
        const std::uint32_t first = _correctives.firstEntry[vertex];
        const std::uint32_t end = _correctives.firstEntry[vertex + 1];
        _texels->push_back({end - first, 0, 0, 0});
        for (std::uint32_t i = first; i < end; ++i) {
            const Correctives::Entry& entry = _correctives.entries[i];
            const std::size_t modes = _correctives.joints[entry.joint].modes;
            _texels->push_back({_weights[entry.joint], word(modes), 0, 0});
            for (std::size_t k = 0; k < modes; ++k) {
                const std::size_t at = entry.firstShare + 3 * k;
                const std::int16_t* p = &_correctives.shares[at];
                osg::Vec4ui packed(halves(p[0], p[1]), halves(p[2], 0), 0, 0);
                if (_correctives.hasNormals()) {
                    const std::int16_t* n = &_correctives.normalShares[at];
                    packed[2] = halves(n[0], n[1]);
                    packed[3] = halves(n[2], 0);
                }
                _texels->push_back(packed);
            }
        }
    }

    const SkinModel& _model;
    const Correctives& _correctives;
    SurfaceSlopes _slopes;
    std::vector<unsigned int> _weights;
    osg::ref_ptr<osg::Vec4uiArray> _texels;
};

/// The texels of a GpuModel.
///
/// \param model may have no vertices
osg::ref_ptr<osg::Vec4uiArray> packModel(const SkinModel& model, const Correctives& correctives) {
    return Packer(model, correctives).pack();
}

double largestCoordinate(const SkinModel& model) {
    float largest = 0.0f;
    for (const glm::vec3& p : model.positions())
        largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return static_cast<double>(largest);
}

} // namespace

osg::ref_ptr<const GpuModel> GpuModel::of(const SkinModel& model) {
    return PackedOnce<SkinModel, GpuModel>::find(model, [&] { return new GpuModel(model); });
}

GpuModel::GpuModel(const SkinModel& model)
    : _model(&model), _smallMove(1e-9 * largestCoordinate(model)) {
    const Correctives correctives = model.correctives();
    _correctiveJoints = correctives.joints;
    _paletteSize = weightTexels(model, _correctiveJoints).back();
    const osg::ref_ptr<osg::Vec4uiArray> texels = packModel(model, correctives);
    _texels = texels->size();
    _texture = textureOf(*texels, GL_RGBA32UI_EXT);
}

GpuModel::~GpuModel() {
    PackedOnce<SkinModel, GpuModel>::forget(*_model);
}

} // namespace osgSkin
