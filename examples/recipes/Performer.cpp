// SPDX-License-Identifier: MIT
#include "Performer.h"

#include <lo/lo.h>
#include <lo/lo_cpp.h>
#include <osg/FrameStamp>
#include <osg/Group>
#include <osg/NodeCallback>
#include <osg/NodeVisitor>

#include <cmath>
#include <memory>

osg::ref_ptr<osg::Node> receivePoses(const std::string& file,
                                     const std::shared_ptr<lo::Server>& server);

namespace {

struct Bone {
    const char* name;
    float x, y, z; ///< from the bone above, metres; left is -x, forward +z
};

constexpr Bone kBones[] = {
    {"Hips", 0, 0.95f, 0},
    {"Spine", 0, 0.1f, 0},
    {"Chest", 0, 0.15f, 0},
    {"Neck", 0, 0.25f, 0},
    {"Head", 0, 0.1f, 0},
    {"LeftUpperLeg", -0.09f, -0.04f, 0},
    {"LeftLowerLeg", 0, -0.42f, 0},
    {"LeftFoot", 0, -0.42f, 0},
    {"LeftToes", 0, -0.07f, 0.14f},
    {"RightUpperLeg", 0.09f, -0.04f, 0},
    {"RightLowerLeg", 0, -0.42f, 0},
    {"RightFoot", 0, -0.42f, 0},
    {"RightToes", 0, -0.07f, 0.14f},
    {"LeftUpperArm", -0.17f, 0.2f, 0},
    {"LeftLowerArm", -0.28f, 0, 0},
    {"LeftHand", -0.26f, 0, 0},
    {"RightUpperArm", 0.17f, 0.2f, 0},
    {"RightLowerArm", 0.28f, 0, 0},
    {"RightHand", 0.26f, 0, 0},
};

} // namespace

void Performer::send(double time, const std::map<std::string, osg::Quat>& turns) const {
    lo::Bundle bundle;
    bundle.add("/VMC/Ext/Root/Pos",
               lo::Message("sfffffff", "root", 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f));
    for (const Bone& bone : kBones) {
        const auto turn = turns.find(bone.name);
        const osg::Quat q = turn == turns.end() ? osg::Quat() : turn->second;
        bundle.add("/VMC/Ext/Bone/Pos",
                   lo::Message("sfffffff", bone.name, bone.x, bone.y, bone.z, float(q.x()),
                               float(q.y()), float(q.z()), float(q.w())));
    }
    bundle.add("/VMC/Ext/T", lo::Message("f", float(time)));
    lo::Address("127.0.0.1", _port).send(bundle);
}

osg::ref_ptr<osg::Node> perform(const std::string& file) {
    struct Act : osg::NodeCallback {
        explicit Act(int port) : performer(port) {}
        void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
            const double time = nv->getFrameStamp()->getSimulationTime();
            const double wave = 0.35 * std::sin(6.0 * time);
            performer.send(time, {{"LeftUpperArm", osg::Quat(1.2, osg::Z_AXIS)},
                                  {"RightUpperArm", osg::Quat(0.35, osg::Z_AXIS)},
                                  {"RightLowerArm", osg::Quat(1.15 + wave, osg::Z_AXIS)},
                                  {"Spine", osg::Quat(0.06, osg::Z_AXIS)},
                                  {"Head", osg::Quat(0.25, osg::Y_AXIS)}});
            traverse(node, nv);
        }
        Performer performer;
    };
    const auto server = std::make_shared<lo::Server>(lo_server_new(nullptr, nullptr)); // any port
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(receivePoses(file, server));
    scene->addUpdateCallback(new Act(server->port()));
    return scene;
}
