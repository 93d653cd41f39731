// SPDX-License-Identifier: MIT
#include <osgSkinGpu/GpuModel>

#include "model/PackModel.h"

#include <osg/BufferObject>
#include <osg/observer_ptr>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

namespace osgSkin {
namespace {

struct Known {
    std::mutex mutex;
    std::map<const SkinModel*, osg::observer_ptr<GpuModel>> models;
};

/// Never destroyed: models of an application's own statics outlive ours.
Known& known() {
    static Known& instance = *new Known;
    return instance;
}

double largestCoordinate(const SkinModel& model) {
    float largest = 0.0f;
    for (const glm::vec3& p : model.positions())
        largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return static_cast<double>(largest);
}

} // namespace

osg::ref_ptr<const GpuModel> GpuModel::of(const SkinModel& model) {
    Known& all = known();
    const std::lock_guard<std::mutex> lock(all.mutex);
    osg::ref_ptr<GpuModel> found;
    osg::observer_ptr<GpuModel>& place = all.models[&model];
    // An address may be a new model's: the one that was there before has gone with its GpuModel.
    if (!place.lock(found)) {
        found = new GpuModel(model);
        place = found.get();
    }
    return found;
}

GpuModel::GpuModel(const SkinModel& model)
    : _model(&model), _smallMove(1e-9 * largestCoordinate(model)) {
    const Correctives correctives = model.correctives();
    _correctiveJoints = correctives.joints;
    _paletteSize = weightTexels(model, _correctiveJoints).back();
    const osg::ref_ptr<osg::Vec4uiArray> texels = packModel(model, correctives);
    _texels = texels->size();
    const osg::ref_ptr<osg::VertexBufferObject> buffer = new osg::VertexBufferObject;
    texels->setVertexBufferObject(buffer);
    _texture = new osg::TextureBuffer(texels);
    _texture->setInternalFormat(GL_RGBA32UI_EXT);
}

GpuModel::~GpuModel() {
    Known& all = known();
    const std::lock_guard<std::mutex> lock(all.mutex);
    const auto found = all.models.find(_model.get());
    if (found != all.models.end() && !found->second.valid()) all.models.erase(found);
}

} // namespace osgSkin
