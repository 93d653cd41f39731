// SPDX-License-Identifier: MIT
#include <osgSkin/DeformJob>
#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/PoseBounds>

#include <OpenThreads/ScopedLock>
#include <osgUtil/CullVisitor>

namespace osgSkin {

/// The buffers' bounds are the skin's: known from the pose, before any vertex has been deformed.
class DeformableSkin::CurrentBound : public osg::Drawable::ComputeBoundingBoxCallback {
public:
    osg::BoundingBox box;
    osg::BoundingBox computeBound(const osg::Drawable&) const override { return box; }
};

DeformableSkin::DeformableSkin() {
    setUseDisplayList(false);
    setSupportsDisplayList(false);
    // Keeps the Optimizer from merging two skins into one.
    setDataVariance(osg::Object::DYNAMIC);
}

DeformableSkin::DeformableSkin(const DeformableSkin& other, const osg::CopyOp& copyop)
    : osg::Drawable(other, copyop), _rest(other._rest), _shared(other._shared),
      _model(other._model), _pose(other._pose), _eager(other._eager) {
    makeBuffers();
    poseChanged();
}

DeformableSkin::~DeformableSkin() = default;

void DeformableSkin::setSkin(osg::Geometry* rest, std::shared_ptr<const SkinModel> model) {
    const osg::ref_ptr<SharedSkinModel> shared = new SharedSkinModel(std::move(model));
    setSkin(rest, shared.get());
}

void DeformableSkin::setSkin(osg::Geometry* rest, SharedSkinModel* shared) {
    const std::shared_ptr<const SkinModel> model = shared ? shared->getModel() : nullptr;
    if (!rest || !model) throw Error("deformable skin: expected a geometry and a model");
    const auto* vertices = dynamic_cast<const osg::Vec3Array*>(rest->getVertexArray());
    const auto* normals = dynamic_cast<const osg::Vec3Array*>(rest->getNormalArray());
    if (!vertices || vertices->size() != model->vertexCount() || !normals ||
        normals->size() != model->vertexCount())
        throw Error("deformable skin: the geometry \"" + rest->getName() +
                    "\" needs Vec3Arrays of " + std::to_string(model->vertexCount()) +
                    " vertices and normals, as many as the model has");
    _rest = rest;
    _shared = shared;
    _model = model;
    _pose = Pose(_model->joints());
    setStateSet(rest->getStateSet());
    makeBuffers();
    poseChanged();
}

void DeformableSkin::makeBuffers() {
    _buffers = {};
    _bound = new CurrentBound;
    _current = 0;
    if (!_rest) return;
    for (osg::ref_ptr<osg::Geometry>& buffer : _buffers) {
        buffer = new osg::Geometry(*_rest, osg::CopyOp::SHALLOW_COPY);
        buffer->setStateSet(nullptr); // the outer drawable's stands above it while culling
        buffer->setUpdateCallback(nullptr);
        buffer->setUseDisplayList(false);
        buffer->setUseVertexBufferObjects(true);
        // Each buffer streams from memory of its own: a draw thread may still read the other one.
        const auto stream = [](const osg::Array* source) {
            const osg::ref_ptr<osg::Vec3Array> array =
                new osg::Vec3Array(*static_cast<const osg::Vec3Array*>(source));
            array->setBinding(osg::Array::BIND_PER_VERTEX);
            return array;
        };
        const osg::ref_ptr<osg::VertexBufferObject> vbo = new osg::VertexBufferObject;
        vbo->setUsage(GL_DYNAMIC_DRAW);
        const osg::ref_ptr<osg::Vec3Array> vertices = stream(_rest->getVertexArray());
        const osg::ref_ptr<osg::Vec3Array> normals = stream(_rest->getNormalArray());
        vertices->setVertexBufferObject(vbo);
        normals->setVertexBufferObject(vbo);
        buffer->setVertexArray(vertices);
        buffer->setNormalArray(normals);
        buffer->setComputeBoundingBoxCallback(_bound);
        // Culled by the outer drawable already, before it was deformed.
        buffer->setCullingActive(false);
    }
}

bool DeformableSkin::setPose(const glm::dmat4* skinning, std::size_t count) {
    if (!_model || !_pose.set(skinning, count)) return false;
    poseChanged();
    return true;
}

void DeformableSkin::poseChanged() {
    _dirty = true;
    if (!_model) return;
    const PoseBounds bounds = computePoseBounds(*_model, _pose);
    _bound->box.set(bounds.low.x, bounds.low.y, bounds.low.z, bounds.high.x, bounds.high.y,
                    bounds.high.z);
    for (const osg::ref_ptr<osg::Geometry>& buffer : _buffers) buffer->dirtyBound();
    dirtyBound();
    if (_eager) deform();
}

void DeformableSkin::deform() const {
    if (!_dirty.load(std::memory_order_acquire)) return;
    const OpenThreads::ScopedLock<OpenThreads::Mutex> lock(_mutex);
    if (!_dirty.load(std::memory_order_relaxed) || !_model) return;
    const unsigned int next = 1 - _current;
    auto& vertices = static_cast<osg::Vec3Array&>(*_buffers[next]->getVertexArray());
    auto& normals = static_cast<osg::Vec3Array&>(*_buffers[next]->getNormalArray());
    DeformJob job;
    job.model = _model.get();
    job.pose = &_pose;
    job.positions = asGlm(vertices.asVector().data());
    job.positionCount = vertices.size();
    job.normals = asGlm(normals.asVector().data());
    job.normalCount = normals.size();
    job.run();
    vertices.dirty();
    normals.dirty();
    _current = next;
    ++_deformCount;
    _dirty.store(false, std::memory_order_release);
}

const osg::Geometry* DeformableSkin::getDeformedGeometry() const {
    if (!_model) return nullptr;
    deform();
    return _buffers[_current].get();
}

void DeformableSkin::accept(osg::NodeVisitor& nv) {
    if (!nv.validNodeMask(*this)) return;
    nv.pushOntoNodePath(this);
    if (nv.getVisitorType() == osg::NodeVisitor::CULL_VISITOR)
        cull(nv);
    else
        nv.apply(*this);
    nv.popFromNodePath();
}

void DeformableSkin::cull(osg::NodeVisitor& nv) {
    if (!_model) return;
    osgUtil::CullVisitor* cv = nv.asCullVisitor();
    if (osg::Callback* callback = getCullCallback()) {
        osg::DrawableCullCallback* drawableCallback = callback->asDrawableCullCallback();
        if (drawableCallback &&
            drawableCallback->cull(&nv, this, cv ? &cv->getRenderInfo() : nullptr))
            return;
    }
    if (cv && isCullingActive() && cv->isCulled(getBoundingBox())) return;
    deform();
    osg::StateSet* stateSet = cv ? getStateSet() : nullptr;
    if (stateSet) cv->pushStateSet(stateSet);
    _buffers[_current]->accept(nv);
    if (stateSet) cv->popStateSet();
}

void DeformableSkin::accept(osg::PrimitiveFunctor& functor) const {
    if (const osg::Geometry* geometry = getDeformedGeometry()) geometry->accept(functor);
}

void DeformableSkin::accept(osg::PrimitiveIndexFunctor& functor) const {
    if (const osg::Geometry* geometry = getDeformedGeometry()) geometry->accept(functor);
}

void DeformableSkin::accept(osg::Drawable::ConstAttributeFunctor& functor) const {
    if (const osg::Geometry* geometry = getDeformedGeometry()) geometry->accept(functor);
}

osg::BoundingBox DeformableSkin::computeBoundingBox() const {
    return _model ? _bound->box : osg::BoundingBox();
}

void DeformableSkin::drawImplementation(osg::RenderInfo& renderInfo) const {
    if (const osg::Geometry* geometry = getDeformedGeometry())
        geometry->drawImplementation(renderInfo);
}

void DeformableSkin::compileGLObjects(osg::RenderInfo& renderInfo) const {
    for (const osg::ref_ptr<osg::Geometry>& buffer : _buffers)
        if (buffer) buffer->compileGLObjects(renderInfo);
}

void DeformableSkin::resizeGLObjectBuffers(unsigned int maxSize) {
    osg::Drawable::resizeGLObjectBuffers(maxSize);
    for (const osg::ref_ptr<osg::Geometry>& buffer : _buffers)
        if (buffer) buffer->resizeGLObjectBuffers(maxSize);
}

void DeformableSkin::releaseGLObjects(osg::State* state) const {
    osg::Drawable::releaseGLObjects(state);
    for (const osg::ref_ptr<osg::Geometry>& buffer : _buffers)
        if (buffer) buffer->releaseGLObjects(state);
}

} // namespace osgSkin
