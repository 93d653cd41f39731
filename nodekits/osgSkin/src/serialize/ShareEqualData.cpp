// SPDX-License-Identifier: MIT
#include <osgSkin/ShareEqualData>

#include "core/ContentHash.h"
#include "serialize/SharedObjects.h"

#include <osg/BufferObject>
#include <osg/PrimitiveSet>

#include <cstring>
#include <typeinfo>

namespace osgSkin {
namespace {

bool mayBeShared(const osg::BufferData& data) {
    return data.getDataVariance() != osg::Object::DYNAMIC && !data.getUserDataContainer() &&
           data.getDataPointer() && !data.getModifiedCallback();
}

ContentHash hashOf(const osg::BufferData& data) {
    ContentHash hash;
    const char* const type = typeid(data).name();
    hash.add(type, std::strlen(type));
    hash.add(data.getDataPointer(), data.getTotalDataSize());
    return hash;
}

bool haveEqualBytes(const osg::BufferData& a, const osg::BufferData& b) {
    return typeid(a) == typeid(b) && a.getName() == b.getName() &&
           a.getTotalDataSize() == b.getTotalDataSize() &&
           std::memcmp(a.getDataPointer(), b.getDataPointer(), a.getTotalDataSize()) == 0;
}

// A buffer object each, set before other threads see the data: geometries set it where it is
// missing.
void setBufferObject(osg::Array& array) {
    if (!array.getVertexBufferObject()) array.setVertexBufferObject(new osg::VertexBufferObject);
}

void setBufferObject(osg::PrimitiveSet& primitives) {
    osg::DrawElements* const elements = primitives.getDrawElements();
    if (elements && !elements->getElementBufferObject())
        elements->setElementBufferObject(new osg::ElementBufferObject);
}

osg::ref_ptr<osg::Array> shared(osg::Array& array) {
    if (!mayBeShared(array)) return &array;
    setBufferObject(array);
    return SharedObjects<osg::Array>::instance().add(
        hashOf(array), &array, [&](const osg::Array& other) {
            return mayBeShared(other) && other.getBinding() == array.getBinding() &&
                   other.getNormalize() == array.getNormalize() &&
                   other.getPreserveDataType() == array.getPreserveDataType() &&
                   haveEqualBytes(other, array);
        });
}

osg::ref_ptr<osg::PrimitiveSet> shared(osg::PrimitiveSet& primitives) {
    if (!primitives.getDrawElements() || !mayBeShared(primitives)) return &primitives;
    setBufferObject(primitives);
    return SharedObjects<osg::PrimitiveSet>::instance().add(
        hashOf(primitives), &primitives, [&](const osg::PrimitiveSet& other) {
            return mayBeShared(other) && other.getMode() == primitives.getMode() &&
                   other.getNumInstances() == primitives.getNumInstances() &&
                   haveEqualBytes(other, primitives);
        });
}

} // namespace

void shareEqualArrays(osg::Geometry& geometry) {
    if (osg::Array* array = geometry.getVertexArray()) geometry.setVertexArray(shared(*array));
    if (osg::Array* array = geometry.getNormalArray()) geometry.setNormalArray(shared(*array));
    if (osg::Array* array = geometry.getColorArray()) geometry.setColorArray(shared(*array));
    for (unsigned int i = 0; i < geometry.getNumTexCoordArrays(); ++i)
        if (osg::Array* array = geometry.getTexCoordArray(i))
            geometry.setTexCoordArray(i, shared(*array));
    for (unsigned int i = 0; i < geometry.getNumVertexAttribArrays(); ++i)
        if (osg::Array* array = geometry.getVertexAttribArray(i))
            geometry.setVertexAttribArray(i, shared(*array));
    for (unsigned int i = 0; i < geometry.getNumPrimitiveSets(); ++i)
        if (osg::PrimitiveSet* primitives = geometry.getPrimitiveSet(i))
            geometry.setPrimitiveSet(i, shared(*primitives));
}

} // namespace osgSkin
