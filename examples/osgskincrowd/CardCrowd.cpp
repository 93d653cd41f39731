// SPDX-License-Identifier: MIT
#include "CardCrowd.h"
#include "Crowd.h"

#include <osgSkinGpu/CrowdCharacter>

#include <osg/FrameStamp>
#include <osg/NodeCallback>
#include <osg/NodeVisitor>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

} // namespace

/// Measures a traversal. Stores a reference, because the crowd owns the scene that owns this.
class CardCrowd::Timed : public osg::NodeCallback {
public:
    using Step = std::function<void(double)>; ///< argument: simulation time in seconds

    Timed(double& milliseconds, Step first)
        : _milliseconds(milliseconds), _first(std::move(first)) {}
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        const auto start = Clock::now();
        const bool timed = nv && nv->getFrameStamp();
        if (_first) _first(timed ? nv->getFrameStamp()->getSimulationTime() : 0.0);
        traverse(node, nv);
        _milliseconds = millisecondsSince(start);
    }

private:
    double& _milliseconds;
    Step _first;
};

CardCrowd::CardCrowd(const std::vector<std::string>& files, std::size_t count)
    : _scene(new osg::Group) {
    std::vector<double> seconds(files.size());
    float width = 0.0f;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const osg::ref_ptr<osg::Node> scene = loadScene(files[i]);
        _characters.push_back(osgSkin::CrowdCharacter::create(*scene));
        seconds[i] = _characters.back()->loopSeconds(0);
        const osg::BoundingBox& box = _characters.back()->bounds();
        width = std::max({width, box.xMax() - box.xMin(), box.yMax() - box.yMin()});
    }
    width *= 0.7f; // their arms may overlap
    const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
    _radius = 0.5f * width * static_cast<float>(side);
    std::vector<std::vector<osgSkin::CrowdInstance>> members(files.size());
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t line = i / side, kind = i % files.size();
        const double row = static_cast<double>(line) - 0.5 * static_cast<double>(side);
        const double column = static_cast<double>(i % side) + (line % 2 == 0 ? 0.0 : 0.5) -
                              0.5 * static_cast<double>(side);
        osgSkin::CrowdInstance member;
        member.position = osg::Vec3d(column, row, 0.0) * static_cast<double>(width);
        member.phase = std::fmod(0.617 * static_cast<double>(i), 1.0) * seconds[kind];
        member.speed = 0.9f + 0.02f * static_cast<float>(i % 11);
        const float shade = 0.7f + 0.03f * static_cast<float>(i % 10);
        member.colour = osg::Vec4(shade, 0.9f * shade, 1.0f - 0.3f * shade, 1.0f);
        members[kind].push_back(member);
    }
    for (std::size_t i = 0; i < files.size(); ++i) {
        _crowds.push_back(new osgSkin::GpuCrowd(_characters[i]));
        _crowds.back()->setInstances(members[i]);
        _scene->addChild(_crowds.back());
    }
    _scene->setUpdateCallback(new Timed(_updateTime, [this](double time) {
        for (const osg::ref_ptr<osgSkin::GpuCrowd>& crowd : _crowds) crowd->setTime(time);
    }));
    _scene->setCullCallback(new Timed(_cullTime, {}));
}

CardCrowd::~CardCrowd() {
    _scene->setUpdateCallback(nullptr);
    _scene->setCullCallback(nullptr);
}

std::string CardCrowd::summary() const {
    std::ostringstream out;
    for (std::size_t i = 0; i < _crowds.size(); ++i) {
        const osgSkin::CrowdCharacter& character = *_characters[i];
        std::size_t vertices = 0;
        for (const osgSkin::CrowdCharacter::Part& part : character.parts())
            vertices += part.rest->getVertexArray()->getNumElements();
        out << (i > 0 ? "; " : "") << _crowds[i]->getInstanceCount() << " members of " << vertices
            << " vertices, triangles";
        for (std::size_t level = 0; level < character.levelCount(); ++level)
            out << ' ' << character.triangleCount(level);
    }
    out << "; " << osgSkin::CrowdInstance::kTexels * 16 << " bytes a member";
    return out.str();
}
