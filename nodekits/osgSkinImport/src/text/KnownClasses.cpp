// SPDX-License-Identifier: MIT
#include "text/KnownClasses.h"

#include <algorithm>
#include <cctype>
#include <set>

namespace osgSkin {
namespace {

const std::set<std::string>& classesOfOsg() {
    static const std::set<std::string> classes = {
        // scene
        "Node", "Group", "Geode", "Switch", "LOD", "Transform", "MatrixTransform",
        "PositionAttitudeTransform", "AutoTransform", "LightSource", "Drawable", "Geometry",
        "ShapeDrawable", "Shape", "Box", "Capsule", "Cone", "Cylinder", "Sphere",
        // callbacks
        "Object", "Callback", "NodeCallback", "UpdateCallback", "UniformCallback",
        "ComputeBoundingBoxCallback", "ComputeBoundingSphereCallback", "AnimationPath",
        "AnimationPathCallback",
        // arrays and primitives
        "BufferData", "BufferObject", "VertexBufferObject", "ElementBufferObject", "Array",
        "ByteArray", "ShortArray", "IntArray", "UByteArray", "UShortArray", "UIntArray",
        "FloatArray", "DoubleArray", "Vec2bArray", "Vec3bArray", "Vec4bArray", "Vec2sArray",
        "Vec3sArray", "Vec4sArray", "Vec2iArray", "Vec3iArray", "Vec4iArray", "Vec2ubArray",
        "Vec3ubArray", "Vec4ubArray", "Vec2usArray", "Vec3usArray", "Vec4usArray", "Vec2uiArray",
        "Vec3uiArray", "Vec4uiArray", "Vec2Array", "Vec3Array", "Vec4Array", "Vec2dArray",
        "Vec3dArray", "Vec4dArray", "PrimitiveSet", "DrawArrays", "DrawArrayLengths",
        "DrawElementsUByte", "DrawElementsUShort", "DrawElementsUInt",
        // state
        "StateSet", "StateAttribute", "AlphaFunc", "BlendColor", "BlendEquation", "BlendFunc",
        "ColorMask", "CullFace", "Depth", "Fog", "FrontFace", "Light", "LightModel", "LineWidth",
        "Material", "Multisample", "Point", "PolygonMode", "PolygonOffset", "Program", "ShadeModel",
        "Shader", "TexEnv", "TexEnvCombine", "TexGen", "TexMat", "Texture", "Texture1D",
        "Texture2D", "Texture2DArray", "TextureCubeMap", "TextureRectangle", "Uniform",
        // users' values
        "UserDataContainer", "DefaultUserDataContainer", "BoolValueObject", "CharValueObject",
        "UCharValueObject", "ShortValueObject", "UShortValueObject", "IntValueObject",
        "UIntValueObject", "FloatValueObject", "DoubleValueObject", "StringValueObject",
        "Vec2fValueObject", "Vec3fValueObject", "Vec4fValueObject", "Vec2dValueObject",
        "Vec3dValueObject", "Vec4dValueObject", "QuatValueObject", "PlaneValueObject",
        "MatrixfValueObject", "MatrixdValueObject"};
    return classes;
}

} // namespace

bool isKnownClass(const std::string& className, const ReadLimits& limits) {
    const std::size_t sign = className.find("::");
    const std::string library = className.substr(0, sign);
    const auto isNameLetter = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
    const auto isLetter = [&](unsigned char c) { return isNameLetter(c) || c == ':'; };
    // OSG names a library after the first part, and tells of classes that it does not know.
    if (sign == std::string::npos || !std::all_of(library.begin(), library.end(), isNameLetter) ||
        !std::all_of(className.begin(), className.end(), isLetter))
        return false;
    if (library == "osgAnimation" || library == "osgSkin") return true;
    if (library == "osg" && classesOfOsg().count(className.substr(sign + 2)) > 0) return true;
    return std::any_of(limits.classes.begin(), limits.classes.end(), [&](const std::string& name) {
        return name == className || name == library;
    });
}

} // namespace osgSkin
