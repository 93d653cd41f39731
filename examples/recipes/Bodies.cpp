// SPDX-License-Identifier: MIT
#include "Bodies.h"

#include <osg/Group>
#include <osg/MatrixTransform>
#include <osg/Matrixf>
#include <osg/ShapeDrawable>

osg::ref_ptr<osg::Node> fallDown(const std::string& file, const std::shared_ptr<Bodies>& bodies);

namespace {

constexpr int kGround = 1, kBody = 2;
constexpr btScalar kStep = 1.0f / 240.0f; ///< seconds

btVector3 toBullet(const osg::Vec3d& v) {
    return {btScalar(v.x()), btScalar(v.y()), btScalar(v.z())};
}

btTransform toBullet(const osg::Matrixd& matrix) {
    const osg::Quat q = matrix.getRotate();
    return btTransform(
        btQuaternion(btScalar(q.x()), btScalar(q.y()), btScalar(q.z()), btScalar(q.w())),
        toBullet(matrix.getTrans()));
}

} // namespace

Bodies::Bodies(double size) {
    _world.setGravity({0, 0, btScalar(-9.81 * size)});
}

Bodies::~Bodies() {
    for (const auto& joint : _joints) _world.removeConstraint(joint.get());
    for (const auto& body : _bodies) _world.removeRigidBody(body.get());
    for (const auto& ground : _grounds) _world.removeRigidBody(ground.get());
}

void Bodies::addGround(const osg::Vec3d& half, const osg::Vec3d& centre) {
    _shapes.push_back(std::make_shared<btBoxShape>(toBullet(half)));
    _grounds.push_back(std::make_unique<btRigidBody>(0.0f, nullptr, _shapes.back().get()));
    _grounds.back()->setWorldTransform(toBullet(osg::Matrixd::translate(centre)));
    _grounds.back()->setFriction(0.6f);
    _world.addRigidBody(_grounds.back().get(), kGround, kBody);
}

void Bodies::add(const std::shared_ptr<btConvexShape>& shape, double mass,
                 const osg::Matrixd& place, int parent, const osg::Vec3d& joint) {
    btVector3 inertia;
    shape->calculateLocalInertia(btScalar(mass), inertia);
    _shapes.push_back(shape);
    auto body = std::make_unique<btRigidBody>(btScalar(mass), nullptr, shape.get(), inertia);
    body->setWorldTransform(toBullet(place));
    body->setLinearVelocity({0, btScalar(-0.7 * place.getTrans().z()), 0}); // it tips over
    body->setDamping(0.05f, 0.6f);
    body->setFriction(0.6f);
    body->setActivationState(DISABLE_DEACTIVATION);
    _world.addRigidBody(body.get(), kBody, kGround);
    if (parent >= 0) {
        btRigidBody& other = *_bodies[std::size_t(parent)];
        const btTransform at = toBullet(osg::Matrixd::translate(joint));
        auto cone = std::make_unique<btConeTwistConstraint>(
            *body, other, body->getWorldTransform().inverse() * at,
            other.getWorldTransform().inverse() * at);
        cone->setLimit(0.7f, 0.7f, 0.4f);
        _world.addConstraint(cone.get(), true);
        _joints.push_back(std::move(cone));
    }
    _bodies.push_back(std::move(body));
}

osg::Matrixd Bodies::place(std::size_t body) const {
    const btTransform& at = _bodies[body]->getWorldTransform();
    const btQuaternion q = at.getRotation();
    osg::Matrixd result =
        osg::Matrixd::rotate(osg::Quat(double(q.x()), double(q.y()), double(q.z()), double(q.w())));
    const btVector3& p = at.getOrigin();
    result.setTrans(double(p.x()), double(p.y()), double(p.z()));
    return result;
}

void Bodies::stepTo(double time) {
    if (_time >= 0.0 && time > _time) _world.stepSimulation(btScalar(time - _time), 10000, kStep);
    _time = time;
}

osg::ref_ptr<osg::Node> fallDownStairs(const std::string& file, double size) {
    constexpr int steps = 8;
    const double rise = 0.17 * size, tread = 0.29 * size, wide = 1.2 * size;
    const auto bodies = std::make_shared<Bodies>(size);
    const osg::ref_ptr<osg::MatrixTransform> scene =
        new osg::MatrixTransform(osg::Matrixd::translate(0.0, 0.0, rise * steps));
    const auto addBox = [&](const osg::Vec3d& half, const osg::Vec3d& centre) {
        bodies->addGround(half, centre);
        scene->addChild(new osg::ShapeDrawable(new osg::Box(
            osg::Vec3(centre), 2 * float(half.x()), 2 * float(half.y()), 2 * float(half.z()))));
    };
    for (int i = 0; i < steps; ++i) { // solid down to the floor
        const double top = -rise * i, depth = i == 0 ? size : 0.5 * tread,
                     down = rise * (steps - i);
        const double y = i == 0 ? 0.75 * size : -0.25 * size - tread * (i - 0.5);
        addBox({wide, depth, 0.5 * down}, {0.0, y, top - 0.5 * down});
    }
    bodies->addGround(osg::Vec3d(10.0, 10.0, 0.5) * size, {0.0, 0.0, -rise * steps - 0.5 * size});
    scene->addChild(fallDown(file, bodies));
    return scene;
}
