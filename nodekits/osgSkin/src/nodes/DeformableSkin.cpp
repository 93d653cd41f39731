// SPDX-License-Identifier: MIT
#include <osgSkin/DeformableSkin>

#include "nodes/OtherFormats.h"

#include <osgSkin/DeformJob>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/PoseBounds>

#include <osg/Geometry>
#include <osgUtil/CullVisitor>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

namespace osgSkin {
namespace {

std::size_t fewest(const osg::Array& array, const osg::Geometry& geometry,
                   std::size_t vertexCount) {
    switch (array.getBinding()) {
    case osg::Array::BIND_PER_VERTEX:
        return vertexCount;
    case osg::Array::BIND_PER_PRIMITIVE_SET:
        return geometry.getNumPrimitiveSets();
    case osg::Array::BIND_OVERALL:
        return 1;
    default:
        return 0;
    }
}

/// The first array with fewer elements than its binding needs; empty where there is none.
std::string findShort(const osg::Geometry& geometry, std::size_t vertices) {
    osg::Geometry::ArrayList arrays;
    geometry.getArrayList(arrays);
    for (const osg::ref_ptr<osg::Array>& array : arrays)
        if (array->getNumElements() < fewest(*array, geometry, vertices))
            return "an array with " + std::to_string(array->getNumElements()) +
                   " elements, expected at least " +
                   std::to_string(fewest(*array, geometry, vertices)) + " for " +
                   std::to_string(vertices) + " vertices";
    return {};
}

/// \return the size of `names` where it is not among them
std::size_t indexOf(const std::string& name, const std::vector<std::string>& names) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// Copies an array to memory that a deformation may write, in a buffer object.
/// \param source null, or not as setSkin() has seen it, where the application has replaced it
template <typename Array>
osg::ref_ptr<Array> stream(const osg::Array* source, std::size_t count,
                           osg::VertexBufferObject& vbo) {
    osg::ref_ptr<Array> array =
        new Array(osg::Array::BIND_PER_VERTEX, static_cast<unsigned int>(count));
    const auto* same = dynamic_cast<const Array*>(source);
    if (same && same->size() == count) array->asVector() = same->asVector();
    if (source) array->setNormalize(source->getNormalize());
    // Without vertex array objects OSG takes an array for the one that it has drawn before if
    // address and count of changes are alike. Memory that was freed is used again, so counts begin
    // far from each other.
    static std::atomic<unsigned int> firstCount{0};
    array->setModifiedCount(firstCount += 0x9e3779b9u);
    array->setVertexBufferObject(&vbo);
    return array;
}

} // namespace

DeformableSkin::DrawBackend::~DrawBackend() = default;

bool DeformableSkin::DrawBackend::upload(const DeformableSkin&, const osg::Geometry&) {
    return false;
}

DeformableSkin::DeformableSkin() {
    setUseDisplayList(false);
    setSupportsDisplayList(false);
    setUseVertexBufferObjects(true);
    // Keeps the Optimizer from merging two skins into one.
    setDataVariance(osg::Object::DYNAMIC);
}

DeformableSkin::DeformableSkin(const DeformableSkin& other, const osg::CopyOp& copyop)
    : osg::Drawable(other, copyop), _rest(other._rest), _model(other._model), _pose(other._pose),
      _pool(other._pool), _backend(other._backend ? other._backend->clone() : nullptr),
      _eager(other._eager), _tangentAttribute(other._tangentAttribute) {
    if (other._extras) {
        _extras = std::make_unique<Extras>();
        _extras->tangents = other._extras->tangents;
        _extras->targets = other._extras->targets;
        _extras->weights = other._extras->weights;
        _extras->shown = other._extras->shown;
        _extras->isMorphed = other._extras->isMorphed;
    }
    forgetBuffers();
    if (_backend && _model) _backend->skinChanged(*this);
    poseChanged();
}

DeformableSkin::~DeformableSkin() = default;

void DeformableSkin::setSkin(osg::Geometry* rest, const osg::ref_ptr<const SkinModel>& model) {
    if (!rest || !model) throw Error("deformable skin: expected a geometry and a model");
    const auto* vertices = dynamic_cast<const osg::Vec3Array*>(rest->getVertexArray());
    const auto* normals = dynamic_cast<const osg::Vec3Array*>(rest->getNormalArray());
    if (!vertices || vertices->size() != model->vertexCount() || !normals ||
        normals->size() != model->vertexCount())
        throw Error("deformable skin: the geometry \"" + rest->getName() +
                    "\" needs Vec3Arrays of " + std::to_string(model->vertexCount()) +
                    " vertices and normals, as many as the model has");
    std::string broken = brokenPrimitive(*rest, model->vertexCount());
    if (broken.empty()) broken = findShort(*rest, model->vertexCount());
    if (!broken.empty())
        throw Error("deformable skin: the geometry \"" + rest->getName() + "\" has " + broken);
    const auto tangents = tangentsOf(*rest, _tangentAttribute, *model);
    const Pose before = _pose;
    const std::vector<std::string> inputs = _model ? _model->inputs() : std::vector<std::string>();
    _rest = rest;
    _model = model;
    const MorphTargets* const targets = getMorphTargets();
    if (targets && targets->vertexCount() != model->vertexCount()) _extras.reset();
    setTangents(tangents);
    _pose = Pose(_model->joints(), _model->inputs().size());
    setStateSet(rest->getStateSet());
    forgetBuffers();
    if (_backend) _backend->skinChanged(*this);
    poseChanged();
    for (std::size_t i = 0; i < inputs.size(); ++i) setActivation(inputs[i], before.input(i));
}

osg::ref_ptr<const SkinTangents> DeformableSkin::tangentsOf(const osg::Geometry& rest,
                                                            int attribute, const SkinModel& model) {
    if (attribute < 0) return nullptr;
    const osg::Array* array = rest.getVertexAttribArray(static_cast<unsigned int>(attribute));
    std::vector<glm::vec4> tangents;
    if (const auto* four = dynamic_cast<const osg::Vec4Array*>(array))
        for (const osg::Vec4& t : *four) tangents.emplace_back(t.x(), t.y(), t.z(), t.w());
    else if (const auto* three = dynamic_cast<const osg::Vec3Array*>(array))
        for (const osg::Vec3& t : *three) tangents.emplace_back(t.x(), t.y(), t.z(), 1.0f);
    if (tangents.size() != model.vertexCount())
        throw Error("deformable skin: the geometry \"" + rest.getName() +
                    "\" needs a Vec4Array of " + std::to_string(model.vertexCount()) +
                    " tangents as vertex attribute " + std::to_string(attribute));
    return SkinTangents::create(&model, std::move(tangents));
}

void DeformableSkin::setTangents(const osg::ref_ptr<const SkinTangents>& tangents) {
    if (tangents && !_extras) _extras = std::make_unique<Extras>();
    if (!_extras) return;
    _extras->tangents = tangents;
    _extras->rest.reset();
}

void DeformableSkin::setTangentAttribute(int index) {
    if (_model) setTangents(tangentsOf(*_rest, index, *_model));
    _tangentAttribute = index;
    if (!_model) return;
    forgetBuffers();
    if (_backend) _backend->skinChanged(*this);
    poseChanged();
}

osg::ref_ptr<osg::Geometry> DeformableSkin::makeDrawnGeometry() const {
    osg::ref_ptr<osg::Geometry> buffer = new osg::Geometry(*_rest, osg::CopyOp::SHALLOW_COPY);
    buffer->setStateSet(nullptr); // cull() applies the skin's own
    buffer->setUpdateCallback(nullptr);
    buffer->setEventCallback(nullptr);
    buffer->setCullCallback(nullptr);
    buffer->setNodeMask(~0u);
    buffer->setDataVariance(osg::Object::UNSPECIFIED); // DYNAMIC would delay the next update
    buffer->setUseDisplayList(false);
    buffer->setSupportsDisplayList(false);
    buffer->setUseVertexBufferObjects(getUseVertexBufferObjects());
    // Each buffer has memory of its own: a draw thread may still read the other one.
    const osg::ref_ptr<osg::VertexBufferObject> vbo = new osg::VertexBufferObject;
    vbo->setUsage(GL_DYNAMIC_DRAW);
    const std::size_t count = _model->vertexCount();
    buffer->setVertexArray(stream<osg::Vec3Array>(_rest->getVertexArray(), count, *vbo));
    buffer->setNormalArray(stream<osg::Vec3Array>(_rest->getNormalArray(), count, *vbo));
    if (tangents()) {
        const auto index = static_cast<unsigned int>(_tangentAttribute);
        buffer->setVertexAttribArray(
            index, stream<osg::Vec4Array>(_rest->getVertexAttribArray(index), count, *vbo));
    }
    // Bounds are found from the pose, before vertices are deformed, and set as initial bounds; this
    // callback adds nothing to them.
    static const osg::ref_ptr<osg::Drawable::ComputeBoundingBoxCallback> nothing =
        new osg::Drawable::ComputeBoundingBoxCallback;
    buffer->setComputeBoundingBoxCallback(nothing);
    // The skin itself is culled before it is deformed.
    buffer->setCullingActive(false);
    return buffer;
}

/// Forgets the buffers but for the bounds. They are made when they are needed (fill()): characters
/// that nobody has seen yet, or that a backend has always drawn, own no vertices.
void DeformableSkin::forgetBuffers() {
    // The buffers' own GL objects go with them. Textures, programs and arrays may be shared, and a
    // draw thread may be using them: nothing is released here.
    const osg::ref_ptr<osg::Geometry> before = _buffers[0];
    _buffers = {};
    _current = 0;
    _dirty = true;
    _handedOut = false;
    if (!_rest) return;
    _buffers[0] = new osg::Geometry;
    if (before) _buffers[0]->setInitialBound(before->getInitialBound());
}

namespace {

/// Makes the buffers where there are none.
void fill(std::array<osg::ref_ptr<osg::Geometry>, 2>& buffers, const DeformableSkin& skin) {
    if (buffers[1]) return;
    const osg::BoundingBox bounds = buffers[0]->getInitialBound();
    for (osg::ref_ptr<osg::Geometry>& buffer : buffers) {
        buffer = skin.makeDrawnGeometry();
        buffer->setInitialBound(bounds);
        buffer->getBound(); // now: several cull threads may ask for it at once
    }
}

} // namespace

void DeformableSkin::setDrawBackend(DrawBackend* drawer) {
    uploadAgain();
    _backend = drawer;
    if (!_backend || !_model) return;
    forgetBuffers();
    _backend->skinChanged(*this);
    _backend->poseChanged(*this);
}

bool DeformableSkin::setPose(const glm::dmat4* skinning, std::size_t count, Pose::Twist twist) {
    bool changed = false;
    if (!_model || !_pose.set(skinning, count, twist, &changed)) return false;
    if (changed) poseChanged();
    return true;
}

bool DeformableSkin::setPose(const osg::Matrixd* skinning, std::size_t count, Pose::Twist twist) {
    return setPose(asGlm(skinning), count, twist);
}

bool DeformableSkin::setPose(const JointMap* own, std::size_t count, Pose::Twist twist) {
    bool changed = false;
    if (!_model || !_pose.set(own, count, twist, &changed)) return false;
    if (changed) poseChanged();
    return true;
}

bool DeformableSkin::setPose(const JointMap* own, std::size_t count,
                             const osg::BoundingBox& bounds) {
    bool changed = false;
    if (!_model || !_pose.set(own, count, Pose::Twist::Shortest, &changed)) return false;
    if (changed) poseChanged(bounds);
    return true;
}

bool DeformableSkin::setPose(const Pose& pose, const osg::BoundingBox& bounds) {
    bool changed = false;
    if (!_model || !_pose.setJoints(pose, &changed)) return false;
    const osg::BoundingBox& known = _extras ? _extras->poseBounds : _buffers[0]->getInitialBound();
    if (changed || bounds._min != known._min || bounds._max != known._max) poseChanged(bounds);
    return true;
}

bool DeformableSkin::setActivation(const std::string& input, float activation) {
    if (!_model) return false;
    const std::size_t index = indexOf(input, _model->inputs());
    const float before = _pose.input(index);
    if (!_pose.setInput(index, activation)) return false;
    if (activation != before) poseChanged();
    return true;
}

float DeformableSkin::getActivation(const std::string& input) const {
    return _model ? _pose.input(indexOf(input, _model->inputs())) : 0.0f;
}

void DeformableSkin::setMorphTargets(const osg::ref_ptr<const MorphTargets>& targets) {
    if (targets && !_model) throw Error("deformable skin: expected a skin before morph targets");
    if (targets && targets->vertexCount() != _model->vertexCount())
        throw Error("deformable skin: morph targets of " + std::to_string(targets->vertexCount()) +
                    " vertices, expected the skin's " + std::to_string(_model->vertexCount()));
    if (!_extras) _extras = std::make_unique<Extras>();
    _extras->targets = targets;
    _extras->weights = targets ? targets->initialWeights() : std::vector<float>();
    _extras->shown = _extras->weights;
    _extras->isMorphed = false;
    _extras->rest.reset();
    if (!_model) return;
    if (_backend) _backend->skinChanged(*this);
    poseChanged();
}

bool DeformableSkin::setMorph(const std::string& name, float weight) {
    const std::size_t index = getMorphTargets() ? getMorphTargets()->find(name) : 0;
    if (index >= getMorphWeights().size() || !std::isfinite(weight)) return false;
    if (std::exchange(_extras->weights[index], weight) != weight) shapeChanged();
    return true;
}

float DeformableSkin::getMorph(const std::string& name) const {
    const std::size_t index = getMorphTargets() ? getMorphTargets()->find(name) : 0;
    return index < getMorphWeights().size() ? _extras->weights[index] : 0.0f;
}

bool DeformableSkin::setMorphWeights(const std::vector<float>& weights) {
    if (weights.size() != getMorphWeights().size() ||
        !std::all_of(weights.begin(), weights.end(), [](float w) { return std::isfinite(w); }))
        return false;
    if (weights == getMorphWeights()) return true;
    _extras->weights = weights;
    shapeChanged();
    return true;
}

const std::vector<float>& DeformableSkin::getMorphWeights() const {
    static const std::vector<float> none;
    return _extras ? _extras->weights : none;
}

const std::vector<float>& DeformableSkin::shownMorphWeights() const {
    return _extras ? _extras->shown : getMorphWeights();
}

/// \pre there are morph targets
void DeformableSkin::shapeChanged() {
    _extras->targets->applyRules(_extras->weights, _extras->shown);
    _extras->isRestOld = true;
    _extras->isMorphed = false;
    for (std::size_t i = 0; i < _extras->shown.size(); ++i)
        if (_extras->shown[i] != _extras->targets->targets()[i].initial) _extras->isMorphed = true;
    poseChanged(osg::BoundingBox(_extras->poseBounds));
}

/// Copies the skin's draw settings to its buffers.
void DeformableSkin::applyDrawSettings() {
    if (!_rest) return;
    osg::Drawable::DrawCallback* const callback =
        getDrawCallback() ? getDrawCallback() : _rest->getDrawCallback();
    for (const osg::ref_ptr<osg::Geometry>& buffer : _buffers) {
        if (!buffer) continue;
        if (buffer->getUseVertexArrayObject() != getUseVertexArrayObject())
            buffer->setUseVertexArrayObject(getUseVertexArrayObject());
        if (buffer->getDrawCallback() != callback) buffer->setDrawCallback(callback);
    }
}

void DeformableSkin::setDrawCallback(DrawCallback* callback) {
    osg::Drawable::setDrawCallback(callback);
    applyDrawSettings();
    uploadAgain();
}

void DeformableSkin::poseChanged() {
    poseChanged(_model ? toOsg(computePoseBounds(*_model, _pose)) : osg::BoundingBox());
}

void DeformableSkin::poseChanged(const osg::BoundingBox& poseBounds) {
    _dirty = true;
    if (!_model) return;
    applyDrawSettings();
    if (_extras) _extras->poseBounds = poseBounds;
    osg::BoundingBox bounds = poseBounds;
    if (isMorphed() && bounds.valid()) {
        double reach = _extras->targets->reach(_extras->shown);
        for (std::size_t j = 0; j < _pose.size(); ++j)
            reach *= std::max(1.0, _pose.transform(j).scale);
        const auto room = static_cast<float>(reach);
        bounds._min -= osg::Vec3(room, room, room);
        bounds._max += osg::Vec3(room, room, room);
    }
    const osg::BoundingBox& before = _buffers[0]->getInitialBound();
    if (bounds._min != before._min || bounds._max != before._max) {
        for (const osg::ref_ptr<osg::Geometry>& buffer : _buffers) {
            if (!buffer) continue;
            buffer->setInitialBound(bounds);
            buffer->getBound(); // now: several cull threads may ask for it at once
        }
        dirtyBound();
        getBound(); // now, as above
    }
    if (_backend) _backend->poseChanged(*this);
    if (_eager) deform();
}

void DeformableSkin::deform() const {
    if (!_dirty.load(std::memory_order_acquire)) return;
    const std::lock_guard<std::mutex> lock(_mutex);
    if (!_dirty.load(std::memory_order_relaxed) || !_model) return;
    auto& self = const_cast<DeformableSkin&>(*this); // deforming on demand is const
    fill(self._buffers, *this);
    self.applyDrawSettings();
    // A draw may still read the buffer that a cull handed out last. The other one is free: no
    // update begins before the draw of the last frame but one has ended.
    const unsigned int next = _handedOut ? 1 - _current : _current.load();
    osg::Geometry& buffer = *_buffers[next];
    auto& vertices = static_cast<osg::Vec3Array&>(*buffer.getVertexArray());
    auto& normals = static_cast<osg::Vec3Array&>(*buffer.getNormalArray());
    DeformJob job;
    job.model = _model.get();
    job.pose = &_pose;
    if (isMorphed()) {
        Extras& extras = *_extras;
        if (!extras.rest) {
            extras.rest = std::make_unique<MorphedRest>(_model, extras.targets, extras.tangents);
            extras.isRestOld = true;
        }
        if (extras.isRestOld) extras.rest->set(extras.shown);
        extras.isRestOld = false;
        job.morphed = extras.rest.get();
    }
    job.positions = asGlm(vertices.asVector().data());
    job.positionCount = vertices.size();
    job.normals = asGlm(normals.asVector().data());
    job.normalCount = normals.size();
    osg::Vec4Array* posed = nullptr;
    if (const SkinTangents* const rest = tangents()) {
        posed = static_cast<osg::Vec4Array*>(
            buffer.getVertexAttribArray(static_cast<unsigned int>(_tangentAttribute)));
        job.restTangents = rest;
        job.tangents = asGlm(posed->asVector().data());
        job.tangentCount = posed->size();
    }
    if (_pool)
        _pool->run(&job, 1);
    else
        job.run();
    if (!_backend || !_backend->upload(*this, buffer)) {
        vertices.dirty();
        normals.dirty();
        if (posed) posed->dirty();
        buffer.dirtyGLObjects(); // else a vertex array object does not upload them
    }
    _current = next;
    _handedOut = false;
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
    else if (writesOtherFormat(nv) && _model)
        writeGeometry(*getDeformedGeometry(), *this, nv);
    else
        nv.apply(*this);
    nv.popFromNodePath();
}

void DeformableSkin::cull(osg::NodeVisitor& nv) {
    if (!_model) return;
    osgUtil::CullVisitor* cv = nv.asCullVisitor();
    if (osg::Callback* callback = getCullCallback()) {
        osg::DrawableCullCallback* drawableCallback = callback->asDrawableCullCallback();
        if (!drawableCallback)
            callback->run(this, &nv);
        else if (drawableCallback->cull(&nv, this, cv ? &cv->getRenderInfo() : nullptr))
            return;
    }
    if (cv && isCullingActive() && cv->isCulled(getBoundingBox())) return;
    osg::Geometry* drawn = nullptr;
    if (_backend && cv && !_eager && !getDrawCallback()) drawn = _backend->cull(*this, *cv);
    if (!drawn) {
        deform();
        _handedOut = true;
        drawn = _buffers[_current].get();
    }
    osg::StateSet* stateSet = cv ? getStateSet() : nullptr;
    if (stateSet) cv->pushStateSet(stateSet);
    drawn->accept(nv);
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

void DeformableSkin::setUseVertexBufferObjects(bool flag) {
    osg::Drawable::setUseVertexBufferObjects(flag);
    for (const osg::ref_ptr<osg::Geometry>& buffer : _buffers)
        if (buffer) buffer->setUseVertexBufferObjects(flag);
}

osg::BoundingBox DeformableSkin::computeBoundingBox() const {
    return _model ? _buffers[0]->getInitialBound() : osg::BoundingBox();
}

void DeformableSkin::drawImplementation(osg::RenderInfo& renderInfo) const {
    if (const osg::Geometry* geometry = getDeformedGeometry()) {
        _handedOut = true;
        geometry->drawImplementation(renderInfo);
    }
}

void DeformableSkin::compileGLObjects(osg::RenderInfo& renderInfo) const {
    // One context's thread may compile while another's deforms.
    const std::lock_guard<std::mutex> lock(_mutex);
    if (_model && !_backend) fill(const_cast<DeformableSkin&>(*this)._buffers, *this);
    for (const osg::ref_ptr<osg::Geometry>& buffer : _buffers)
        if (buffer && _buffers[1]) buffer->compileGLObjects(renderInfo);
    if (_backend) _backend->compileGLObjects(renderInfo);
}

void DeformableSkin::resizeGLObjectBuffers(unsigned int maxSize) {
    osg::Drawable::resizeGLObjectBuffers(maxSize);
    for (const osg::ref_ptr<osg::Geometry>& buffer : _buffers)
        if (buffer) buffer->resizeGLObjectBuffers(maxSize);
    if (_backend) _backend->resizeGLObjectBuffers(maxSize);
}

void DeformableSkin::releaseGLObjects(osg::State* state) const {
    osg::Drawable::releaseGLObjects(state);
    for (const osg::ref_ptr<osg::Geometry>& buffer : _buffers)
        if (buffer) buffer->releaseGLObjects(state);
    if (_backend) _backend->releaseGLObjects(state);
}

} // namespace osgSkin
