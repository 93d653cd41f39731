// SPDX-License-Identifier: MIT
#include "Street.h"

#include "FrameBench.h"
#include "ProgressLine.h"
#include "WindowOptions.h"

#include <osgSkin/DeformPool>
#include <osgSkin/Error>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinCharacter/OptionString>
#include <osgSkinMotion/MakeWalker>

#include <osg/Geometry>
#include <osg/LightSource>
#include <osg/NodeCallback>
#include <osg/Timer>
#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgText/Text>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace {

constexpr double kBlock = 30.0;      ///< m, between the middles of a block's pavements
constexpr double kRoad = 12.0;       ///< m, from the middle of a pavement to that over the street
constexpr double kPavement = 2.0;    ///< m, half its width
constexpr double kKerb = 0.12;       ///< m
constexpr double kStep = 1.0 / 60.0; ///< s
constexpr std::size_t kPeoplePerBlock = 60;

class MovePeople : public osg::NodeCallback {
public:
    explicit MovePeople(Street& street) : _street(&street) {}
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        if (_street && nv->getFrameStamp()) _street->move(nv->getFrameStamp()->getSimulationTime());
        traverse(node, nv);
    }
    void forget() { _street = nullptr; }

private:
    Street* _street;
};

osg::ref_ptr<osgSkin::Walker> loadWalker(const std::string& file) {
    const osg::ref_ptr<osgDB::Options> words = new osgDB::Options("colours=merged");
    example::ProgressLine line(file);
    osgSkin::LoadOptions options = osgSkin::toLoadOptions(
        example::hasOsgOptionString() ? osgDB::Registry::instance()->getOptions() : words.get());
    options.progress = line.progress();
    if (osgDB::getLowerCaseFileExtension(file) == "osgb")
        if (const osg::ref_ptr<osg::Node> saved = osgDB::readRefNodeFile(file))
            if (auto* walker = dynamic_cast<osgSkin::Walker*>(saved.get())) return walker;
    return osgSkin::makeWalker(*osgSkin::loadCharacter(file, options).root);
}

/// Boxes of one colour each, in one geometry.
class Boxes {
public:
    void add(const osg::Vec3d& least, const osg::Vec3d& most, const osg::Vec4& colour) {
        const osg::Vec3d size = most - least;
        for (int axis = 0; axis < 3; ++axis)
            for (const double side : {0.0, 1.0}) {
                osg::Vec3d u, v, normal;
                u[(axis + 1) % 3] = size[(axis + 1) % 3];
                v[(axis + 2) % 3] = size[(axis + 2) % 3];
                normal[axis] = side > 0.0 ? 1.0 : -1.0;
                osg::Vec3d corner = least;
                corner[axis] += side * size[axis];
                if (side == 0.0) std::swap(u, v);
                for (const osg::Vec3d& at : {corner, corner + u, corner + u + v, corner + v}) {
                    _vertices->push_back(at);
                    _normals->push_back(normal);
                    _colours->push_back(colour);
                }
            }
    }
    osg::ref_ptr<osg::Geometry> geometry() const {
        osg::ref_ptr<osg::Geometry> result = new osg::Geometry;
        result->setVertexArray(_vertices);
        result->setNormalArray(_normals, osg::Array::BIND_PER_VERTEX);
        result->setColorArray(_colours, osg::Array::BIND_PER_VERTEX);
        result->addPrimitiveSet(
            new osg::DrawArrays(GL_QUADS, 0, static_cast<GLsizei>(_vertices->size())));
        result->setUseVertexBufferObjects(true);
        return result;
    }

private:
    osg::ref_ptr<osg::Vec3Array> _vertices = new osg::Vec3Array, _normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> _colours = new osg::Vec4Array;
};

} // namespace

Street::Street(const std::vector<std::string>& files, std::size_t count, unsigned int threads) {
    _blocks = std::max(2, static_cast<int>(std::lround(
                              std::ceil(std::sqrt(double(count) / double(kPeoplePerBlock))))));
    _group->setPool(new osgSkin::DeformPool(threads));
    addHouses();
    addPeople(files, count);
    const osg::ref_ptr<osg::LightSource> sun = new osg::LightSource;
    sun->getLight()->setPosition(osg::Vec4(-0.5f, -0.35f, 1.0f, 0.0f));
    sun->getLight()->setAmbient(osg::Vec4(0.38f, 0.40f, 0.44f, 1.0f));
    sun->getLight()->setDiffuse(osg::Vec4(0.72f, 0.70f, 0.64f, 1.0f));
    _scene->addChild(sun);
    _scene->addChild(_group);
    _scene->setUpdateCallback(new MovePeople(*this));
    walkTo(0.0); // all have found their gait
}

Street::~Street() {
    dynamic_cast<MovePeople&>(*_scene->getUpdateCallback()).forget();
}

example::View Street::view() const {
    const osg::Vec2d at = cornerOf(osg::Vec2i(_blocks / 2, 0), 0, 0.5 * kRoad);
    return {
        {at.x() + 1.5, at.y() - 4.0, 1.75}, {at.x() - 1.0, at.y() + 30.0, 1.2}, {0, 0, 1}, 60.0};
}

/// A corner of a block's pavement, counterclockwise from the least x and y.
osg::Vec2d Street::cornerOf(const osg::Vec2i& block, int corner, double lane) const {
    const double pitch = kBlock + kRoad, half = 0.5 * kBlock + lane;
    const osg::Vec2d middle((block.x() + 0.5 - 0.5 * _blocks) * pitch, (block.y() + 0.5) * pitch);
    const bool right = corner == 1 || corner == 2, far = corner >= 2;
    return middle + osg::Vec2d(right ? half : -half, far ? half : -half);
}

/// Where a person goes from a corner on: round the block, or over a street.
void Street::choose(Person& person) {
    const osg::Vec2d from = cornerOf(person.block, person.corner, person.lane);
    // Each corner leads on over two streets.
    static const osg::Vec2i kOver[4][2] = {
        {{-1, 0}, {0, -1}}, {{1, 0}, {0, -1}}, {{1, 0}, {0, 1}}, {{-1, 0}, {0, 1}}};
    const unsigned int draw = _random() % 8;
    const osg::Vec2i over = person.block + kOver[person.corner][draw % 2];
    const bool crosses =
        draw < 4 && over.x() >= 0 && over.y() >= 0 && over.x() < _blocks && over.y() < _blocks;
    if (crosses) {
        const bool sideways = over.y() == person.block.y();
        person.corner = sideways ? person.corner ^ 1 : 3 - person.corner;
        person.block = over;
    } else {
        person.corner = (person.corner + (person.step > 0 ? 1 : 3)) % 4;
    }
    const osg::Vec2d to = cornerOf(person.block, person.corner, person.lane);
    person.from = from;
    person.along = to - from;
    person.length = person.along.normalize();
    person.way = 0.0;
}

void Street::addPeople(const std::vector<std::string>& files, std::size_t count) {
    std::vector<osg::ref_ptr<osgSkin::Walker>> walkers;
    for (const std::string& file : files) walkers.push_back(loadWalker(file));
    std::normal_distribution<double> speeds(1.35, 0.2);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (std::size_t i = 0; i < count; ++i) {
        Person person;
        person.place = new osg::MatrixTransform;
        person.place->setDataVariance(osg::Object::DYNAMIC);
        person.place->addChild(
            osg::clone(walkers[i % walkers.size()].get(), osg::CopyOp(osg::CopyOp::SHALLOW_COPY)));
        const auto blocks = static_cast<unsigned int>(_blocks);
        person.block.set(static_cast<int>(_random() % blocks),
                         static_cast<int>(_random() % blocks));
        person.corner = static_cast<int>(_random() % 4);
        person.step = _random() % 2 ? 1 : -1;
        person.speed = std::clamp(speeds(_random), 0.8, 2.0);
        if (i % 12 == 11) person.speed = 0.0; // waits
        if (i % 97 == 96) person.speed = 3.0; // runs
        person.lane = 0.8 * kPavement * (2.0 * share(_random) - 1.0);
        choose(person);
        person.way = person.length * share(_random);
        person.heading = person.speed > 0.0 ? std::atan2(person.along.y(), person.along.x())
                                            : 2.0 * osg::PI * share(_random);
        _group->addChild(person.place);
        _people.push_back(person);
    }
}

void Street::walkTo(double time) {
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    osgUtil::UpdateVisitor update;
    update.setFrameStamp(stamp);
    while (_time + kStep < time) {
        move(_time + kStep);
        stamp->setFrameNumber(++_step);
        stamp->setSimulationTime(_time);
        update.setTraversalNumber(_step);
        _group->accept(update);
    }
    move(time);
}

void Street::move(double time) {
    const double dt = time - _time;
    if (dt <= 0.0) return;
    _time = time;
    for (Person& person : _people) {
        person.way += person.speed * dt;
        if (person.way > person.length) choose(person);
        if (person.speed > 0.0) { // turns in half a second
            const double turn = std::remainder(
                std::atan2(person.along.y(), person.along.x()) - person.heading, 2.0 * osg::PI);
            person.heading += std::clamp(turn, -4.0 * dt, 4.0 * dt);
        }
        const osg::Vec2d at = person.from + person.along * person.way;
        person.place->setMatrix(osg::Matrix::rotate(person.heading, osg::Vec3d(0, 0, 1)) *
                                osg::Matrix::translate(at.x(), at.y(), 0.0));
    }
}

void Street::addHouses() {
    const double pitch = kBlock + kRoad, reach = 0.5 * _blocks * pitch + kRoad;
    const osg::Vec4 road(0.30f, 0.30f, 0.31f, 1), pavement(0.62f, 0.60f, 0.57f, 1),
        stripe(0.85f, 0.85f, 0.83f, 1);
    const osg::Vec4 walls[] = {{0.72f, 0.64f, 0.55f, 1},
                               {0.60f, 0.45f, 0.38f, 1},
                               {0.70f, 0.70f, 0.68f, 1},
                               {0.55f, 0.58f, 0.60f, 1}};
    Boxes boxes;
    boxes.add({-reach, -kRoad, -1.0}, {reach, _blocks * pitch + kRoad, -kKerb}, road);
    for (int x = 0; x < _blocks; ++x)
        for (int y = 0; y < _blocks; ++y) {
            const osg::Vec2d least = cornerOf(osg::Vec2i(x, y), 0, 0.0);
            const osg::Vec2d most = cornerOf(osg::Vec2i(x, y), 2, 0.0);
            const double p = kPavement, gap = kRoad - 2.0 * p;
            boxes.add({least.x() - p, least.y() - p, -kKerb}, {most.x() + p, most.y() + p, 0.0},
                      pavement);
            const double height = 9.0 + 3.0 * double(_random() % 5);
            boxes.add({least.x() + p, least.y() + p, 0.0}, {most.x() - p, most.y() - p, height},
                      walls[_random() % 4]);
            // Crossings at all corners: raised to the pavement, so that nobody sinks.
            for (const double edge : {least.y() - p, most.y() - p})
                for (double at = 0.5; at + 0.5 < gap && x + 1 < _blocks; at += 1.0)
                    boxes.add({most.x() + p + at, edge, -kKerb},
                              {most.x() + p + at + 0.5, edge + 2.0 * p, 0.0}, stripe);
            for (const double edge : {least.x() - p, most.x() - p})
                for (double at = 0.5; at + 0.5 < gap && y + 1 < _blocks; at += 1.0)
                    boxes.add({edge, most.y() + p + at, -kKerb},
                              {edge + 2.0 * p, most.y() + p + at + 0.5, 0.0}, stripe);
        }
    _scene->addChild(boxes.geometry());
}

void Street::bench(unsigned int frames) {
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    const osg::ref_ptr<osgUtil::UpdateVisitor> update = new osgUtil::UpdateVisitor;
    update->setFrameStamp(stamp);
    FrameCull cull(view());
    std::vector<double> updated, culled;
    constexpr unsigned int kFirst = 60; // until all have found their gait
    for (unsigned int i = 0; i < frames + kFirst; ++i) {
        stamp->setFrameNumber(i + 1);
        stamp->setSimulationTime(i / 60.0);
        update->setTraversalNumber(i + 1);
        move(i / 60.0); // the program's part
        const osg::Timer_t start = osg::Timer::instance()->tick();
        _group->accept(*update);
        _scene->getBound();
        const osg::Timer_t end = osg::Timer::instance()->tick();
        cull.run(*_scene, stamp);
        if (i < kFirst) continue;
        updated.push_back(osg::Timer::instance()->delta_m(start, end));
        culled.push_back(osg::Timer::instance()->delta_m(end, osg::Timer::instance()->tick()));
    }
    std::printf("%u frames of %zu people on %u threads, medians: update and bounds %.2f ms, cull "
                "traversal %.2f ms\n",
                frames, _people.size(), _group->getPool()->getThreadCount(), medianOf(updated),
                medianOf(culled));
}

namespace {

class ShowStreetTime : public osg::DrawableUpdateCallback {
public:
    explicit ShowStreetTime(std::size_t people) : _people(people) {}
    void update(osg::NodeVisitor*, osg::Drawable* drawable) override {
        ++_frames;
        const osg::Timer_t now = osg::Timer::instance()->tick();
        const double passed = osg::Timer::instance()->delta_m(_since, now);
        if (passed < 500.0) return;
        char line[80];
        std::snprintf(line, sizeof line, "%.1f ms a frame, %zu people", passed / _frames, _people);
        static_cast<osgText::Text*>(drawable)->setText(line);
        _since = now;
        _frames = 0;
    }

private:
    std::size_t _people;
    osg::Timer_t _since = osg::Timer::instance()->tick();
    unsigned int _frames = 0;
};

} // namespace

osg::ref_ptr<osg::Camera> makeStreetTime(std::size_t people) {
    return makeTextLine(new ShowStreetTime(people));
}
