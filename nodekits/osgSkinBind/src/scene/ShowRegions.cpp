// SPDX-License-Identifier: MIT
#include <osgSkinBind/ShowRegions>

#include <osgSkin/Error>

#include <osg/Material>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

osg::ref_ptr<osg::StateSet> plainState() {
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    const osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
    state->setAttributeAndModes(material);
    return state;
}

} // namespace

osg::Vec4 regionColor(std::size_t joint) {
    const double hue = std::fmod(0.618 * double(joint), 1.0) * 6.0;
    const auto channel = [hue](double shift) {
        const double k = std::fmod(hue + shift, 6.0);
        return float(0.92 - 0.55 * std::max(0.0, std::min({k, 4.0 - k, 1.0})));
    };
    return {channel(5.0), channel(3.0), channel(1.0), 1.0f};
}

void showRegions(std::vector<MeshPart>& parts, const Binding& binding) {
    const osg::ref_ptr<osg::StateSet> state = plainState();
    for (MeshPart& part : parts) {
        const osg::ref_ptr<osg::Vec4Array> colours =
            new osg::Vec4Array(osg::Array::BIND_PER_VERTEX);
        for (const std::uint32_t v : part.sourceVertex) {
            if (v >= binding.vertexCount())
                throw Error("show regions: a mesh part names a vertex that is not bound");
            colours->push_back(regionColor(binding.regions[v]));
        }
        part.geometry = new osg::Geometry(*part.geometry, osg::CopyOp::SHALLOW_COPY);
        part.geometry->setColorArray(colours);
        part.geometry->setStateSet(state);
    }
}

} // namespace osgSkin
