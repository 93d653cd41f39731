// SPDX-License-Identifier: MIT
#include <osgSkin/ParallelDeformCallback>

#include <osg/Group>
#include <osg/NodeVisitor>

#include <algorithm>

namespace osgSkin {
namespace {

class FindSkins : public osg::NodeVisitor {
public:
    explicit FindSkins(std::vector<osg::ref_ptr<DeformableSkin>>& skins)
        : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _skins(skins) {
        setNodeMaskOverride(~0u); // skins that are switched off may be switched on later
    }
    void apply(osg::Drawable& drawable) override {
        if (auto* skin = dynamic_cast<DeformableSkin*>(&drawable)) _skins.emplace_back(skin);
    }

private:
    std::vector<osg::ref_ptr<DeformableSkin>>& _skins;
};

unsigned int childrenOf(const osg::Node& node) {
    const osg::Group* group = node.asGroup();
    return group ? group->getNumChildren() : 0;
}

} // namespace

ParallelDeformCallback::ParallelDeformCallback(DeformPool* pool)
    : _pool(pool ? pool : new DeformPool) {}

ParallelDeformCallback::ParallelDeformCallback(const ParallelDeformCallback& other,
                                               const osg::CopyOp& copyop)
    // Skins are not copied: the copy finds those below its own node.
    : osg::Object(other, copyop), osg::Callback(other, copyop), osg::NodeCallback(other, copyop),
      _pool(other._pool), _onlySeen(other._onlySeen) {}

ParallelDeformCallback::~ParallelDeformCallback() = default;

void ParallelDeformCallback::find(osg::Node& node) {
    _skins.clear();
    FindSkins visitor(_skins);
    node.accept(visitor);
    // A skin with several parents is deformed once.
    std::sort(_skins.begin(), _skins.end());
    _skins.erase(std::unique(_skins.begin(), _skins.end()), _skins.end());
    _now.reserve(_skins.size());
    _children = childrenOf(node);
    _known = true;
}

void ParallelDeformCallback::operator()(osg::Node* node, osg::NodeVisitor* nv) {
    traverse(node, nv);
    if (!node) return;
    if (!_known || childrenOf(*node) != _children) find(*node);
    _now.clear();
    std::size_t vertices = 0;
    for (const osg::ref_ptr<DeformableSkin>& skin : _skins) {
        if (skin->getNumParents() == 0) _known = false;
        if (!skin->needsDeform() || (_onlySeen && !skin->wasSeen())) continue;
        _now.push_back(skin.get());
        vertices += skin->getModel()->vertexCount();
    }
    const auto deform = [this](std::size_t i) { _now[i]->getDeformedGeometry(); };
    if (vertices < _pool->getMinimumVertices())
        for (std::size_t i = 0; i < _now.size(); ++i) deform(i);
    else
        _pool->forEach(_now.size(), deform);
}

} // namespace osgSkin
