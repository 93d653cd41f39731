// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Notify>
#include <osg/ref_ptr>

#include <algorithm>
#include <string>

namespace test {

/// Captures OSG's notify output of level NOTICE and worse while this is alive.
class Notices {
public:
    Notices() { osg::setNotifyHandler(_handler); }
    ~Notices() { osg::setNotifyHandler(_before); }
    Notices(const Notices&) = delete;
    Notices& operator=(const Notices&) = delete;

    const std::string& text() const { return _handler->text; }
    const std::string& warnings() const { return _handler->warnings; }
    std::size_t lines() const {
        return std::size_t(std::count(text().begin(), text().end(), '\n'));
    }
    bool say(const std::string& part) const { return text().find(part) != std::string::npos; }

private:
    struct Handler : osg::NotifyHandler {
        void notify(osg::NotifySeverity severity, const char* message) override {
            if (severity > osg::NOTICE) return;
            text += message;
            if (severity <= osg::WARN) warnings += message;
        }
        std::string text, warnings;
    };
    osg::ref_ptr<osg::NotifyHandler> _before = osg::getNotifyHandler();
    osg::ref_ptr<Handler> _handler = new Handler;
};

} // namespace test
