// SPDX-License-Identifier: MIT
#pragma once

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
    explicit Bodies(double size);
    ~Bodies();
    Bodies(const Bodies&) = delete;
    Bodies& operator=(const Bodies&) = delete;

    /// Adds a box that does not move.
    void addGround(const osg::Vec3d& half, const osg::Vec3d& centre);

    /// Adds a body, which moves a little forwards, along -Y.
    /// \param mass kilogrammes
    /// \param parent the body that carries it; -1: none
    /// \param joint in which both may turn by 40 degrees
    void add(const std::shared_ptr<btConvexShape>& shape, double mass, const osg::Matrixd& place,
             int parent, const osg::Vec3d& joint);

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
    double _time = -1.0;
};

/// The recipe fallDown, at the top of stairs.
/// \param size of the figure, in those of a man
osg::ref_ptr<osg::Node> fallDownStairs(const std::string& file, double size = 1.0);
