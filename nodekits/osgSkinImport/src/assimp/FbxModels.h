// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_ASSIMP_FBXMODELS_H
#define OSGSKINIMPORT_ASSIMP_FBXMODELS_H

#include "assimp/FbxCurve.h"
#include "assimp/FbxDocument.h"
#include "scene/SourceScene.h"

#include <osgSkinImport/ReadLimits>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace osgSkin {

/// The parts of a model's transform that an animation changes.
enum FbxChannel : std::size_t { Translation, Rotation, Scaling };

/// Translation, rotation in degrees, and scale, before all else.
using FbxLocal = std::array<glm::dvec3, 3>;

glm::dmat4 matrixOf(const glm::dvec3& translation, const glm::dquat& rotation,
                    const glm::dvec3& scale);

struct FbxModel;

/// From joints to the scene, as a skin binds them.
using FbxBinds = std::map<const FbxModel*, glm::dmat4>;

/// A model, FBX's node.
struct FbxModel {
    explicit FbxModel(const FbxRecord& object);

    bool hasPivots() const;

    bool hasGeometric() const { return geometric != glm::dmat4(1.0); }

    /// From the model's frame to its parent's.
    /// \param parentsScale which the model does not inherit
    NodeTransform transform(const FbxLocal& local, const glm::dvec3& parentsScale) const;

    std::string name;
    FbxLocal own;
    glm::dvec3 rotationOffset, rotationPivot, scalingOffset, scalingPivot;
    bool ignoresParentsScale; ///< FBX's inheritance "Rrs"
    bool inheritsAsNode;      ///< "RSrs": the product of matrices; else scale follows all rotations
    glm::dmat4 geometric;     ///< from a mesh to the model's frame
    int order = 0;
    glm::dquat before{1.0, 0.0, 0.0, 0.0}, after{1.0, 0.0, 0.0, 0.0};
    const FbxBinds* binds = nullptr; ///< of the joints of its mesh's skin; null: none
    const FbxModel* parent = nullptr;
    std::vector<FbxModel*> children; ///< in the order of connections
    int node = -1;                   ///< index in the scene
};

/// A property of a model in one animation.
struct FbxCurves {
    std::array<const FbxCurve*, 3> axes{}; ///< null: constant
    glm::dvec3 constant{0.0};

    glm::dvec3 at(double time) const;
};

/// One animation of one model.
using FbxMoves = std::map<std::size_t, FbxCurves>; ///< by Channel

struct FbxStack {
    std::string name;
    double start = 0.0, stop = 0.0; ///< seconds; equal if not given
    std::map<const FbxModel*, FbxMoves> moves;
    std::size_t unusedLayers = 0;

    static constexpr double kRounding = 2e-6; ///< seconds
    bool isInRange(double time) const {
        return start == stop || (time >= start - kRounding && time <= stop + kRounding);
    }
};

/// The models and animations of a file, connected.
class FbxModels {
public:
    using Id = std::int64_t;

    explicit FbxModels(const FbxDocument& document);

    /// Refuses models of which Assimp would make too many nodes, one for each way of connections,
    /// or that are below themselves.
    /// \param path of the file, for errors
    /// \throw osgSkin::Error
    void checkNodes(const std::string& path, const ReadLimits& limits) const;

    std::map<Id, FbxModel> models;
    std::vector<FbxModel*> roots;
    std::vector<FbxStack> stacks;

private:
    void connect(const std::vector<FbxRecord>& connections);
    FbxCurves curvesOf(Id node, const std::array<const FbxCurve*, 3>& axes,
                       const glm::dvec3& own) const;
    void addBinds(const std::map<Id, const FbxModel*>& joints, const std::map<Id, Id>& deformed);

    std::map<Id, FbxCurve> _curves;
    std::map<Id, const FbxRecord*> _curveNodes;
    std::map<Id, std::size_t> _stackOf;
    std::map<Id, const FbxRecord*> _deformers;
    std::set<Id> _geometries;
    std::map<Id, FbxBinds> _binds; ///< of a geometry
};

} // namespace osgSkin

#endif
