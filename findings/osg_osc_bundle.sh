#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# OpenSceneGraph 3.6.5, plug-in osc, `PORT.receiver.osc`: messages of one address in one bundle, as
# motion capture sends a pose bone by bone, arrive as one event that has the last one's arguments;
# the others are lost without a warning. One expects an event each, as for messages in packets of
# their own. Needs g++, OpenSceneGraph's headers and python3.
. "$(dirname "$0")/common.sh"
debian_package libopenscenegraph-dev 3.6.5+dfsg1-8+b2
cat >receive.cpp <<'END'
#include <OpenThreads/Thread>
#include <osg/UserDataContainer>
#include <osg/ValueObject>
#include <osgDB/ReadFile>
#include <osgGA/Device>
#include <iostream>

int main(int, char** argv) {
    osg::setNotifyLevel(osg::FATAL);
    const osg::ref_ptr<osgGA::Device> device =
        osgDB::readRefFile<osgGA::Device>("127.0.0.1:" + std::string(argv[1]) + ".receiver.osc");
    std::cerr << "ready" << std::endl;
    for (int i = 0; i < 15; ++i) {
        OpenThreads::Thread::microSleep(100000);
        osgGA::EventQueue::Events events;
        device->getEventQueue()->takeEvents(events);
        for (const auto& event : events) {
            std::string bone;
            if (event->getUserDataContainer() && event->getUserValue("Pos_0", bone))
                std::cout << " " << bone;
        }
    }
    std::cout << std::endl;
}
END
g++ receive.cpp -o receive -losgGA -losgDB -losg -lOpenThreads
cat >send.py <<'END'
import socket
import struct
import subprocess
import sys
import time


def text(string):
    return string.encode() + b"\0" * (4 - len(string) % 4)


def message(bone):
    return text("/VMC/Ext/Bone/Pos") + text(",sfffffff") + text(bone) + struct.pack(">7f", *7 * [0.5])


bones = ["Hips", "Spine", "Head"]
bundle = text("#bundle") + struct.pack(">Q", 1)
for bone in bones:
    bundle += struct.pack(">i", len(message(bone))) + message(bone)
probe = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
probe.bind(("127.0.0.1", 0))
port = probe.getsockname()[1]
probe.close()
sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
for what, packets in (("packets:", [message(bone) for bone in bones]), ("bundle:", [bundle])):
    receiver = subprocess.Popen(["./receive", str(port)], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    receiver.stderr.readline()
    time.sleep(0.2)
    for packet in packets:
        sender.sendto(packet, ("127.0.0.1", port))
    print(what + receiver.communicate()[0].decode().rstrip())
END
python3 send.py >seen
expect <<'END'
packets: Hips Spine Head
bundle: Head
END
