// SPDX-License-Identifier: MIT
#include "BlockRows.h"
#include "FileVersion.h"
#include "RegisterWrapper.h"
#include "serialize/BlockWords.h"
#include "serialize/SkinModelBlock.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/GlmOsg>
#include <osgSkin/MorphTargets>
#include <osgSkin/ShareEqualData>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <sstream>
#include <string>
#include <typeinfo>
#include <vector>

namespace {

bool fail(osgDB::InputStream& is, const osgSkin::DeformableSkin& skin, const std::string& what) {
    // The exception rejects the whole file, and osgDB prints the reason. Keep the first one.
    if (!is.getException())
        is.throwException("osgSkin: skin \"" + skin.getName() + "\" has " + what);
    return false;
}

bool checkSkin(const osgSkin::DeformableSkin& skin) {
    return skin.getModel() != nullptr;
}

/// Whether an array is a model's vectors, one per vertex, and nothing else.
bool isVectors(const osg::Array* array, const std::vector<glm::vec3>& vectors) {
    const auto* const same = dynamic_cast<const osg::Vec3Array*>(array);
    return same && same->getBinding() == osg::Array::BIND_PER_VERTEX && !same->getNormalize() &&
           same->getName().empty() && !same->getUserDataContainer() &&
           same->size() == vectors.size() &&
           std::memcmp(same->getDataPointer(), vectors.data(), same->getTotalDataSize()) == 0;
}

osg::ref_ptr<osg::Vec3Array> makeArray(const std::vector<glm::vec3>& vectors) {
    osg::ref_ptr<osg::Vec3Array> array =
        new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, static_cast<unsigned int>(vectors.size()));
    std::copy(vectors.begin(), vectors.end(), osgSkin::asGlm(array->asVector().data()));
    return array;
}

/// Indexed primitives as words: mode, whether indices have 32 bits, their number, the indices.
/// \return false where a primitive set is another one
bool packPrimitives(const osg::Geometry& geometry, osgSkin::BlockWriter& out) {
    out.put(std::size_t{geometry.getNumPrimitiveSets()});
    for (const osg::ref_ptr<osg::PrimitiveSet>& set : geometry.getPrimitiveSetList()) {
        const osg::PrimitiveSet& primitives = *set;
        const std::type_info& type = typeid(primitives);
        const bool isLong = type == typeid(osg::DrawElementsUInt);
        if ((!isLong && type != typeid(osg::DrawElementsUShort)) || set->getNumInstances() != 0 ||
            set->getUserDataContainer() || !set->getName().empty())
            return false;
        out.put(std::uint32_t{set->getMode()});
        out.put(std::uint32_t{isLong ? 1u : 0u});
        out.put(std::size_t{set->getNumIndices()});
        for (unsigned int i = 0; i < set->getNumIndices(); ++i)
            out.put(std::uint32_t{set->index(i)});
    }
    return true;
}

osg::Geometry::PrimitiveSetList unpackPrimitives(const std::vector<std::uint32_t>& words) {
    osgSkin::BlockReader in(words, "rest geometry's block");
    osg::Geometry::PrimitiveSetList sets(in.count("primitive sets", 3));
    for (osg::ref_ptr<osg::PrimitiveSet>& set : sets) {
        const std::uint32_t mode = in.word();
        const bool isLong = in.word() != 0;
        const std::uint32_t count = in.count("indices", 1);
        const osg::ref_ptr<osg::DrawElementsUInt> wide = new osg::DrawElementsUInt(mode, count);
        if (count > 0) in.copy(wide->asVector().data(), count);
        set = wide;
        if (isLong) continue;
        const osg::ref_ptr<osg::DrawElementsUShort> narrow = new osg::DrawElementsUShort(mode);
        for (const GLuint index : *wide) narrow->push_back(static_cast<GLushort>(index));
        set = narrow;
    }
    return sets;
}

/// While this exists, a rest geometry lacks the arrays and primitives that the model and
/// packPrimitives() hold. A copy would not do: skins that share a rest geometry share it again
/// after reading.
class Stripped {
public:
    explicit Stripped(const osg::Geometry& rest)
        : _rest(const_cast<osg::Geometry&>(rest)), _vertices(_rest.getVertexArray()),
          _normals(_rest.getNormalArray()), _primitives(_rest.getPrimitiveSetList()) {
        _rest.setVertexArray(nullptr);
        _rest.setNormalArray(nullptr);
        _rest.setPrimitiveSetList({});
    }
    Stripped(const Stripped&) = delete;
    Stripped& operator=(const Stripped&) = delete;
    ~Stripped() {
        _rest.setVertexArray(_vertices);
        _rest.setNormalArray(_normals);
        _rest.setPrimitiveSetList(_primitives);
    }

private:
    osg::Geometry& _rest;
    const osg::ref_ptr<osg::Array> _vertices, _normals;
    const osg::Geometry::PrimitiveSetList _primitives;
};

/// From this file version on, osg::Node writes properties that osg::Drawable wrote before.
constexpr int kNodesWriteCallbacks = 156;

/// In binary files, a rest geometry lacks what it has in common with the model, and its primitives
/// are a block of words, which is much faster to read. The block is empty where that cannot be.
bool writeSkin(osgDB::OutputStream& os, const osgSkin::DeformableSkin& skin) {
    // OSG marks text files with its current version, even if their contents have an older one.
    if (!os.isBinary() && os.getFileVersion() < kNodesWriteCallbacks)
        os.throwException("skin \"" + skin.getName() + "\": text for version " +
                          std::to_string(os.getFileVersion()) +
                          " could not be read again, expected a TargetFileVersion of " +
                          std::to_string(kNodesWriteCallbacks) + " or more, or .osgb");
    osgSkin::BlockWriter primitives;
    const bool strips =
        os.isBinary() &&
        isVectors(skin.getRestGeometry()->getVertexArray(), skin.getModel()->positions()) &&
        isVectors(skin.getRestGeometry()->getNormalArray(), skin.getModel()->normals()) &&
        packPrimitives(*skin.getRestGeometry(), primitives);
    os << os.BEGIN_BRACKET << std::endl;
    if (strips) {
        const Stripped stripped(*skin.getRestGeometry());
        os << skin.getRestGeometry();
    } else {
        primitives.words.clear();
        os << skin.getRestGeometry();
    }
    os << skin.getModel();
    if (os.isBinary()) writeWords(os, primitives.words);
    os << os.END_BRACKET << std::endl;
    return true;
}

bool readSkin(osgDB::InputStream& is, osgSkin::DeformableSkin& skin) {
    is >> is.BEGIN_BRACKET;
    const osg::ref_ptr<osg::Geometry> rest = is.readObjectOfType<osg::Geometry>();
    const osg::ref_ptr<const osgSkin::SkinModel> model =
        osgSkin::unpackedModel(is.readObjectOfType<osgSkin::SkinModel>().get());
    std::vector<std::uint32_t> primitives;
    if (is.isBinary() && !readWords(is, primitives)) return false;
    is >> is.END_BRACKET;
    if (is.getException()) return false;
    if (!rest) return fail(is, skin, "no rest geometry");
    if (!model) return fail(is, skin, "no skin model");
    // The state set was read with osg::Node's properties, and may differ from the geometry's.
    const osg::ref_ptr<osg::StateSet> stateSet = skin.getStateSet();
    try {
        // One that another skin shares is complete already.
        if (!primitives.empty() && !rest->getVertexArray()) {
            rest->setVertexArray(makeArray(model->positions()));
            rest->setNormalArray(makeArray(model->normals()));
            rest->setPrimitiveSetList(unpackPrimitives(primitives));
        }
        osgSkin::shareEqualArrays(*rest);
        skin.setSkin(rest, model);
    } catch (const std::exception& error) {
        return fail(is, skin, std::string("parts that do not fit: ") + error.what());
    }
    skin.setStateSet(stateSet);
    return true;
}

bool checkTangents(const osgSkin::DeformableSkin& skin) {
    return skin.getTangentAttribute() >= 0;
}

bool writeTangents(osgDB::OutputStream& os, const osgSkin::DeformableSkin& skin) {
    os << skin.getTangentAttribute() << std::endl;
    return true;
}

bool readTangents(osgDB::InputStream& is, osgSkin::DeformableSkin& skin) {
    int attribute = -1;
    is >> attribute;
    if (is.getException()) return false;
    try {
        skin.setTangentAttribute(attribute);
    } catch (const std::exception& error) {
        return fail(is, skin, std::string("tangents that cannot be used: ") + error.what());
    }
    return true;
}

bool checkPose(const osgSkin::DeformableSkin& skin) {
    return skin.getModel() != nullptr;
}

/// Writes the skinning matrices: the pose shown before the first update traversal.
bool writePose(osgDB::OutputStream& os, const osgSkin::DeformableSkin& skin) {
    const std::vector<glm::dmat4> skinning = skin.getPose().skinning();
    os.writeSize(static_cast<unsigned int>(skinning.size()));
    os << os.BEGIN_BRACKET << std::endl;
    for (const glm::dmat4& matrix : skinning) {
        // As single numbers, because .osgx cannot nest a matrix's brackets in a list.
        for (int i = 0; i < 16; ++i) os << glm::value_ptr(matrix)[i];
        os << std::endl;
    }
    os << os.END_BRACKET << std::endl;
    return true;
}

constexpr double kMaxScale = 1e9;   ///< the smallest is its inverse, like in Pose::set()
constexpr double kMaxNumber = 1e18; ///< its square still fits a float

/// Describes why a skinning matrix is invalid for a joint, or would move vertices out of the range
/// of single precision. Empty if the matrix is valid.
std::string matrixError(const glm::dmat4& skinning) {
    for (int i = 0; i < 16; ++i) {
        const double number = glm::value_ptr(skinning)[i];
        if (!std::isfinite(number)) return "that is not finite";
        if (std::abs(number) > kMaxNumber) return "with a number that is too large";
    }
    const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(skinning))));
    if (!(scale > 0.0)) return "that is singular";
    if (scale >= 1.0 / kMaxScale && scale <= kMaxScale) return {};
    std::ostringstream text;
    text << "with a scale of " << scale << ", expected " << 1.0 / kMaxScale << " to " << kMaxScale;
    return text.str();
}

bool readPose(osgDB::InputStream& is, osgSkin::DeformableSkin& skin) {
    const std::size_t joints = skin.getPose().size();
    unsigned int size = 0;
    is >> size >> is.BEGIN_BRACKET;
    if (size != joints)
        return fail(is, skin,
                    "a pose of " + std::to_string(size) + " joints, expected its " +
                        std::to_string(joints));
    std::vector<glm::dmat4> skinning;
    for (unsigned int j = 0; j < size; ++j) {
        glm::dmat4 matrix(0.0);
        for (int i = 0; i < 16; ++i) is >> glm::value_ptr(matrix)[i];
        if (is.getException()) return false;
        const std::string wrong = matrixError(matrix);
        if (!wrong.empty())
            return fail(is, skin,
                        "a pose whose joint \"" + skin.getModel()->joints()[j].name +
                            "\" has a matrix " + wrong);
        skinning.push_back(matrix);
    }
    is >> is.END_BRACKET;
    if (is.getException()) return false;
    if (!skin.setPose(skinning.data(), skinning.size()))
        return fail(is, skin, "a pose with a matrix that is not a transform");
    return true;
}

bool checkMorphs(const osgSkin::DeformableSkin& skin) {
    return skin.getMorphTargets() != nullptr;
}

bool writeMorphs(osgDB::OutputStream& os, const osgSkin::DeformableSkin& skin) {
    os << os.BEGIN_BRACKET << std::endl << skin.getMorphTargets();
    os << os.END_BRACKET << std::endl;
    return true;
}

bool readMorphs(osgDB::InputStream& is, osgSkin::DeformableSkin& skin) {
    is >> is.BEGIN_BRACKET;
    const osg::ref_ptr<const osgSkin::MorphTargets> targets =
        is.readObjectOfType<osgSkin::MorphTargets>();
    is >> is.END_BRACKET;
    if (is.getException()) return false;
    try {
        skin.setMorphTargets(targets);
    } catch (const std::exception& error) {
        return fail(is, skin, std::string("morph targets that cannot be used: ") + error.what());
    }
    return true;
}

bool checkMorphWeights(const osgSkin::DeformableSkin& skin) {
    return skin.isMorphed();
}

// Apart from the targets, because .osgx cannot have numbers behind an object.
bool writeMorphWeights(osgDB::OutputStream& os, const osgSkin::DeformableSkin& skin) {
    os << os.BEGIN_BRACKET << std::endl;
    for (const float weight : skin.getMorphWeights()) os << weight;
    os << std::endl << os.END_BRACKET << std::endl;
    return true;
}

bool readMorphWeights(osgDB::InputStream& is, osgSkin::DeformableSkin& skin) {
    std::vector<float> weights(skin.getMorphWeights().size());
    is >> is.BEGIN_BRACKET;
    for (float& weight : weights) is >> weight;
    is >> is.END_BRACKET;
    if (is.getException()) return false;
    return skin.setMorphWeights(weights) ||
           fail(is, skin, "a weight of a morph target that is not finite");
}

/// Reads nothing after an error: OSG reads on, and would replace the first reason by a later one.
class SkinProperty : public osgDB::UserSerializer<osgSkin::DeformableSkin> {
public:
    using UserSerializer::UserSerializer;
    bool read(osgDB::InputStream& is, osg::Object& object) override {
        return !is.getException() && UserSerializer::read(is, object);
    }
};

void add(osgDB::ObjectWrapper& wrapper, SkinProperty* property) {
    wrapper.addSerializer(property, osgDB::BaseSerializer::RW_USER);
}

} // namespace

REGISTER_OSGSKIN_WRAPPER(osgSkin_DeformableSkin, new osgSkin::DeformableSkin,
                         osgSkin::DeformableSkin,
                         "osg::Object osg::Node osg::Drawable osgSkin::DeformableSkin") {
    addFileVersion(*wrapper);
    ADD_BOOL_SERIALIZER(Eager, false);
    add(*wrapper, new SkinProperty("Skin", &checkSkin, &readSkin, &writeSkin));
    add(*wrapper, new SkinProperty("Tangents", &checkTangents, &readTangents, &writeTangents));
    add(*wrapper, new SkinProperty("Morphs", &checkMorphs, &readMorphs, &writeMorphs));
    add(*wrapper, new SkinProperty("MorphWeights", &checkMorphWeights, &readMorphWeights,
                                   &writeMorphWeights));
    add(*wrapper, new SkinProperty("Pose", &checkPose, &readPose, &writePose));
}
