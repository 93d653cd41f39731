// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/LivePlayer>
#include <osgSkinRig/VmcPose>

#include <lo/lo_cpp.h>

/// A figure that moves as an actor does, whose poses come by the VMC protocol.
osg::ref_ptr<osg::Node> receivePoses(const std::string& file,
                                     const std::shared_ptr<lo::Server>& server) {
    struct Receive : osg::NodeCallback {
        void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
            for (int most = 1000; most > 0 && server->recv(0) > 0; --most) continue;
            if (std::exchange(isWhole, false) && !player && pose.hasBody())
                if (auto actor = osgSkin::LiveRetarget::create(pose.skeleton(), figure.rest))
                    player = osgSkin::attach<osgSkin::LivePlayer>(*figure.root, std::move(*actor));
            traverse(node, nv); // moves the figure
        }
        osg::ref_ptr<osgSkin::LivePlayer> player;
        std::shared_ptr<lo::Server> server;
        osgSkin::Character figure;
        osgSkin::VmcPose pose;
        bool isWhole = false;
    };
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    Receive* const to = new Receive;
    scene->addUpdateCallback(to); // which owns it
    scene->addChild((to->figure = osgSkin::loadCharacter(file)).root);
    to->server = server;
    for (const char* types : {"sfffffff", "sfffffffffffff"}) // VMC 2.1's root has more numbers
        server->add_method({}, types, [to](const char* path, const char*, lo_arg** a, int) {
            const osg::Quat turn(a[4]->f, a[5]->f, a[6]->f, a[7]->f);
            to->pose.take(path, &a[0]->s, {a[1]->f, a[2]->f, a[3]->f}, turn);
        });
    server->add_method("/VMC/Ext/T", "f", [to](lo_arg** time, int) {
        to->isWhole = true;
        if (to->player) to->player->receive(time[0]->f, to->pose.rotations(), to->pose.root());
    });
    return scene;
}
