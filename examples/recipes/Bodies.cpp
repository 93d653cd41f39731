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

Bodies::Bodies(double size, const osg::Vec3d& push) : _push(push) {
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
                 const osgSkin::HitBoxes::Limb& limb, const osg::Matrixd& motion) {
    btVector3 inertia;
    shape->calculateLocalInertia(btScalar(mass), inertia);
    _shapes.push_back(shape);
    const osg::Matrixd& rest = limb.shapes[0].frame;
    auto body = std::make_unique<btRigidBody>(btScalar(mass), nullptr, shape.get(), inertia);
    body->setWorldTransform(toBullet(rest * motion));
    body->setLinearVelocity(toBullet(_push * (rest * motion).getTrans().z())); // it tips over
    body->setDamping(0.05f, 0.6f);
    body->setFriction(0.6f);
    body->setActivationState(DISABLE_DEACTIVATION);
    _world.addRigidBody(body.get(), kBody, kGround);
    if (limb.parent >= 0) {
        const auto parent = std::size_t(limb.parent);
        if (limb.hinge * limb.hinge > 0.0) { // between places at rest, about Z of this one
            osg::Matrixd at = osg::Matrixd::rotate(osg::Vec3d(0, 0, 1), limb.hinge);
            at.setTrans(limb.centre);
            auto hinge = std::make_unique<btHingeConstraint>(
                *body, *_bodies[parent], toBullet(at * osg::Matrixd::inverse(rest)),
                toBullet(at * osg::Matrixd::inverse(_rest[parent])));
            hinge->setLimit(btScalar(limb.straight), btScalar(limb.bent));
            _joints.push_back(std::move(hinge));
        } else {
            const btTransform at = toBullet(osg::Matrixd::translate(limb.centre * motion));
            auto cone = std::make_unique<btConeTwistConstraint>(
                *body, *_bodies[parent], body->getWorldTransform().inverse() * at,
                _bodies[parent]->getWorldTransform().inverse() * at);
            cone->setLimit(0.6f, 0.6f, 0.4f);
            _joints.push_back(std::move(cone));
        }
        _world.addConstraint(_joints.back().get(), true);
    }
    _rest.push_back(rest);
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
    return fallDownStairs(file, size, {0.0, -0.62, 0.0});
}

osg::ref_ptr<osg::Node> fallDownStairs(const std::string& file, double size,
                                       const osg::Vec3d& push) {
    constexpr int steps = 8;
    const double rise = 0.17 * size, tread = 0.29 * size, wide = 1.2 * size;
    const auto bodies = std::make_shared<Bodies>(size, push);
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
