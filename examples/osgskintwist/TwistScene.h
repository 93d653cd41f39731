// SPDX-License-Identifier: MIT
#ifndef OSGSKINTWIST_TWISTSCENE_H
#define OSGSKINTWIST_TWISTSCENE_H

#include "Blending.h"

#include <osgSkin/DeformableSkin>
#include <osgSkinRig/MeshPart>
#include <osgSkinRig/SkinMesh>

#include <Snapshots.h>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>
#include <osg/Geometry>
#include <osg/Group>
#include <osg/ref_ptr>
#include <osgAnimation/Skeleton>
#include <osgAnimation/StackedQuaternionElement>
#include <osgGA/GUIEventHandler>
#include <osgText/Text>
#include <osgUtil/UpdateVisitor>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace twist {

/// A closed cylinder of radius 1 about the z axis, from z = -4 to z = 4, with flat caps.
struct Cylinder {
    static constexpr double kHalfLength = 4.0;
    static constexpr std::uint32_t kSegments = 48; ///< around
    static constexpr std::uint32_t kSteps = 64;    ///< along; even, so that a ring lies at z = 0
    static constexpr std::uint32_t kCapRings = 4;  ///< from the centre of a cap to its rim
    static constexpr std::uint32_t kChequersAround = 16;
    static constexpr double kChequerLength = 0.4;

    osgSkin::SkinMesh mesh;                        ///< quads; triangles at the cap centres
    osgSkin::MeshPart part;                        ///< with normals, and texture coordinates: 0..1
                                                   ///< around, pairs of chequers along
    std::vector<std::vector<std::uint32_t>> rings; ///< cross-sections of the side, z increasing

    Cylinder();

    /// The ring at z = 0, where the joint is.
    const std::vector<std::uint32_t>& jointRing() const { return rings[kSteps / 2]; }
};

/// A mesh part skinned by linear blending or dual quaternions. Setting the pose deforms it.
class PeerSkin {
public:
    /// One matrix per vertex of the mesh (see Blending.h).
    using Blend = std::function<std::vector<glm::dmat4>(const compare::SkinWeights&,
                                                        const std::vector<glm::dmat4>&)>;

    /// \param part drawn geometry
    /// \param rest positions of the mesh's vertices
    /// \param weights one per vertex of the mesh, not of the part
    /// \param blend the skinning method
    PeerSkin(const osgSkin::MeshPart& part, std::vector<glm::dvec3> rest,
             compare::SkinWeights weights, Blend blend);

    /// \param skinning one matrix per joint of the weights
    void setPose(const std::vector<glm::dmat4>& skinning);

    /// The mesh's vertices in the current pose.
    const std::vector<glm::dvec3>& positions() const { return _positions; }
    osg::Geometry* geometry() const { return _geometry.get(); }

private:
    osgSkin::MeshPart _part;
    std::vector<glm::dvec3> _rest;
    compare::SkinWeights _weights;
    Blend _blend;
    std::vector<glm::dvec3> _positions;
    osg::ref_ptr<osg::Geometry> _geometry;
};

/// Rotation of the upper half of the cylinder relative to the lower half, in degrees.
struct TwistPose {
    double bend = 0.0;  ///< about y: the upper half leans towards +x
    double twist = 0.0; ///< about the bone

    /// Twist first, then bend: eq. 1 of the paper.
    glm::dquat rotation() const {
        return glm::angleAxis(glm::radians(bend), glm::dvec3(0, 1, 0)) *
               glm::angleAxis(glm::radians(twist), glm::dvec3(0, 0, 1));
    }
};

enum class Method { Ours, Linear, DualQuaternion };
constexpr std::array<Method, 3> kMethods{Method::Ours, Method::Linear, Method::DualQuaternion};
const char* nameOf(Method method);

/// A cylinder over two bones, skinned by three methods.
///
/// osgSkin's copy is bound without shapes. The others have smooth weights (paper, eq. 5) over one
/// radius on both sides of the joint.
class Comparison {
public:
    Comparison();

    /// Poses all three copies. osgSkin's copy follows its skeleton, so its drawing changes with the
    /// next update traversal.
    void setPose(const TwistPose& pose);

    /// The node to draw: a skeleton with its skin, or a geometry.
    osg::Node* node(Method method) const;

    /// The cylinder's vertices in the current pose, in the order of cylinder().mesh.
    std::vector<glm::dvec3> positions(Method method);

    const Cylinder& cylinder() const { return _cylinder; }

private:
    Cylinder _cylinder;
    osg::ref_ptr<osgAnimation::Skeleton> _skeleton;
    osg::ref_ptr<osgAnimation::StackedQuaternionElement> _turn; ///< of the upper bone
    osg::ref_ptr<osgSkin::DeformableSkin> _skin;
    std::vector<std::uint32_t> _skinSource; ///< the mesh's vertex for each vertex of the skin
    osg::ref_ptr<osgUtil::UpdateVisitor> _update;
    PeerSkin _linear;
    PeerSkin _dualQuaternion;
};

/// Measurements of a posed cylinder relative to the rest pose.
struct Figures {
    double volume = 1.0;    ///< V'/V
    double leastArea = 1.0; ///< smallest A'/A of the cross-sections along the limb
    double jointArea = 1.0; ///< A'/A at the joint, where both weights of the other methods are 0.5
    double bulge = 1.0;     ///< largest distance to the bones, posed divided by rest
    compare::EdgeStrain strain;
};

/// Measures deformed copies of one cylinder.
class FigureMaker {
public:
    explicit FigureMaker(const Cylinder& cylinder);

    /// \param posed the cylinder's vertices in `pose`
    /// \param pose the pose
    Figures measure(const std::vector<glm::dvec3>& posed, const TwistPose& pose) const;

private:
    const Cylinder& _cylinder;
    std::vector<std::uint32_t> _triangles;
    std::vector<compare::Edge> _edges;
    std::vector<std::uint32_t> _side; ///< the vertices of all rings
};

/// A'/A of a cross-section at half weight with linear blending, in closed form: cos^2(theta / 2)
/// for a twist by theta, cos(theta / 2) for a bend.
double linearBlendJointArea(const TwistPose& pose);

/// A view that shows all three copies in every pose, for pictures twice as wide as high.
example::View sceneView();

/// The three copies side by side on a floor, with their names and measurements, and the angles
/// above.
class TwistScene {
public:
    TwistScene();

    osg::Group* root() const { return _root.get(); }

    const TwistPose& pose() const { return _pose; }
    /// Poses all copies and measures them.
    void setPose(const TwistPose& pose);

    /// Shows or hides a copy; 0 is the left one.
    void toggle(std::size_t copy);

    /// Sets the lines of text below the angles; may be empty.
    void setHelp(const std::string& lines);

private:
    osg::ref_ptr<osg::Node> makeCopy(Method method, const osg::Vec3& colour, float x);

    Comparison _comparison;
    FigureMaker _figures;
    TwistPose _pose;
    osg::ref_ptr<osg::Group> _root;
    std::array<osg::ref_ptr<osg::Node>, kMethods.size()> _copies;
    std::array<osg::ref_ptr<osgText::Text>, kMethods.size()> _labels;
    osg::ref_ptr<osgText::Text> _title;
    osg::ref_ptr<osgText::Text> _help;
};

/// Handles the keys of the interactive window, and runs its animations.
class TwistKeys : public osgGA::GUIEventHandler {
public:
    /// \param scene must outlive the handler
    explicit TwistKeys(TwistScene& scene);

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;

private:
    bool press(int key);
    void advance(double seconds);
    void turn(double bend, double twist);

    TwistScene& _scene;
    bool _bending = false;
    bool _twisting = false;
    bool _paused = false;
    bool _help = false;
    double _bendTime = 0.0; ///< seconds since the animation's start
    double _twistTime = 0.0;
    double _lastFrame = -1.0;
};

} // namespace twist

#endif
