// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/LivePlayer>
#include <osgSkinRig/VmcPose>

#include <lo/lo.h>
#include <lo/lo_cpp.h>
#include <memory>

/// A figure that moves as an actor does, whose poses come by the VMC protocol.
osg::ref_ptr<osg::Node> receivePoses(const std::string& file,
                                     const std::shared_ptr<lo::Server>& server) {
    struct Receive : osg::NodeCallback {
        void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
            while (server->recv(0) > 0) continue;
            traverse(node, nv); // moves the figure
        }
        osg::ref_ptr<osgSkin::LivePlayer> player;
        std::shared_ptr<lo::Server> server;
        osgSkin::VmcPose pose;
    };
    const osgSkin::Character figure = osgSkin::loadCharacter(file);
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(figure.root);
    osg::ref_ptr<Receive> to = new Receive;
    to->server = server;
    scene->addUpdateCallback(to);
    server->add_method({}, "sfffffff",
                       [to = to.get()](const char* path, const char*, lo_arg** a, int) {
                           to->pose.take(path, &a[0]->s, {a[1]->f, a[2]->f, a[3]->f},
                                         {a[4]->f, a[5]->f, a[6]->f, a[7]->f});
                       });
    server->add_method("/VMC/Ext/T", "f", [to = to.get(), figure](lo_arg** time, int) {
        if (!to->player && to->pose.hasBody())
            to->player = osgSkin::attach<osgSkin::LivePlayer>(
                *figure.root, osgSkin::LiveRetarget(to->pose.skeleton(), figure.rest));
        if (to->player) to->player->receive(time[0]->f, to->pose.rotations(), to->pose.root());
    });
    return scene;
}
