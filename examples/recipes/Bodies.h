// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinMotion/HitBoxes>

#include <btBulletDynamicsCommon.h>

#include <osg/Matrixd>
#include <osg/Node>
#include <osg/Vec3d>
#include <osg/ref_ptr>

#include <memory>
#include <string>
#include <vector>

/// Bodies in a world of Bullet, with Z up, and joints between them. They do not hit each other.
class Bodies {
public:
    /// \param size of the figures, in those of a man: they fall as fast as he
    /// \param push metres a second, for each metre of height
    Bodies(double size, const osg::Vec3d& push);
    ~Bodies();
    Bodies(const Bodies&) = delete;
    Bodies& operator=(const Bodies&) = delete;

    /// Adds a box that does not move.
    void addGround(const osg::Vec3d& half, const osg::Vec3d& centre);

    /// Adds a limb's body. Elbows and knees are hinges, other joints turn by 35 degrees.
    /// \param mass kilogrammes
    /// \param motion of the limb from rest; it starts there, in the direction of the push
    void add(const std::shared_ptr<btConvexShape>& shape, double mass,
             const osgSkin::HitBoxes::Limb& limb, const osg::Matrixd& motion);

    std::size_t count() const { return _bodies.size(); }
    osg::Matrixd place(std::size_t body) const;

    /// \param time seconds; the first call only tells the time
    void stepTo(double time);

private:
    btDefaultCollisionConfiguration _configuration;
    btCollisionDispatcher _dispatcher{&_configuration};
    btDbvtBroadphase _broadphase;
    btSequentialImpulseConstraintSolver _solver;
    btDiscreteDynamicsWorld _world{&_dispatcher, &_broadphase, &_solver, &_configuration};
    std::vector<std::shared_ptr<btCollisionShape>> _shapes;
    std::vector<std::unique_ptr<btRigidBody>> _grounds, _bodies;
    std::vector<std::unique_ptr<btTypedConstraint>> _joints;
    std::vector<osg::Matrixd> _rest; ///< of the bodies
    osg::Vec3d _push;
    double _time = -1.0;
};

/// The recipe fallDown, at the top of stairs.
/// \param size of the figure, in those of a man
osg::ref_ptr<osg::Node> fallDownStairs(const std::string& file, double size = 1.0);
/// \param push see Bodies
osg::ref_ptr<osg::Node> fallDownStairs(const std::string& file, double size,
                                       const osg::Vec3d& push);
