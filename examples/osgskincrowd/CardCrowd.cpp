// SPDX-License-Identifier: MIT
#include "CardCrowd.h"

#include "CardCharacter.h"

#include <osg/FrameStamp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

} // namespace

class CardCrowd::TimeCull : public osg::NodeCallback {
public:
    explicit TimeCull(double& milliseconds) : _milliseconds(milliseconds) {}
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        const auto start = Clock::now();
        traverse(node, nv);
        _milliseconds = millisecondsSince(start);
    }

private:
    double& _milliseconds;
};

CardCrowd::CardCrowd(const std::vector<std::string>& files, std::size_t count)
    : _scene(new osg::Group) {
    std::vector<double> seconds(files.size());
    float width = 0.0f;
    for (std::size_t i = 0; i < files.size(); ++i) {
        _characters.push_back(readCardCharacter(files[i], seconds[i]));
        const osg::BoundingBox& box = _characters.back()->bounds();
        width = std::max({width, box.xMax() - box.xMin(), box.yMax() - box.yMin()});
    }
    width *= 0.7f; // they may reach between each other
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
        member.phase =
            static_cast<float>(std::fmod(0.617 * static_cast<double>(i), 1.0) * seconds[kind]);
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
    _scene->setUpdateCallback(this);
    _scene->setCullCallback(new TimeCull(_cullTime));
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

void CardCrowd::operator()(osg::Node* node, osg::NodeVisitor* nv) {
    const auto start = Clock::now();
    const double time = nv && nv->getFrameStamp() ? nv->getFrameStamp()->getSimulationTime() : 0.0;
    for (const osg::ref_ptr<osgSkin::GpuCrowd>& crowd : _crowds) crowd->setTime(time);
    traverse(node, nv);
    _updateTime = millisecondsSince(start);
}
