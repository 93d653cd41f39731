// SPDX-License-Identifier: MIT
#include "CrowdSubject.h"

#include "SomeCorrectives.h"
#include "TubeSkin.h"

#include <osgSkin/GlmOsg>

#include <osg/MatrixTransform>

#include <cmath>

namespace test {
namespace {

osg::ref_ptr<osgSkin::DeformableSkin> tubeSkin() {
    Tube tube;
    tube.binding.correctives = someCorrectives(tube.binding, 0.05, 3);
    osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    skin->setSkin(makeGeometry(tube), tube.model());
    return skin;
}

osg::ref_ptr<osg::Geometry> makeKnob() {
    Tube tube(7, 12);
    for (glm::vec3& p : tube.positions) p = p * 0.3f + glm::vec3(0.0f, 6.2f, 0.0f);
    return makeGeometry(tube);
}

} // namespace

CrowdSubject::CrowdSubject(std::size_t count) : _skin(tubeSkin()), _knob(makeKnob()) {
    for (std::size_t i = 0; i < count; ++i) {
        osgSkin::CrowdInstance member;
        const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(double(count))));
        const std::size_t row = i / side, column = i % side;
        member.position = osg::Vec3d(5.0 * double(column), 5.0 * double(row), 0.0);
        member.rotation = osg::Quat(0.7 * double(i), osg::Vec3d(0, 0, 1));
        member.scale = 0.6f + 0.1f * static_cast<float>(i % 5);
        member.clip = static_cast<unsigned int>(i % 2);
        member.phase = double(i % kSamples) / kSamplesPerSecond;
        members.push_back(member);
    }
}

std::vector<glm::dmat4> CrowdSubject::skinning(unsigned int clip, std::size_t sample) const {
    const double angle = 2.0 * osg::PI * double(sample) / double(kSamples);
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    const glm::dquat root = glm::angleAxis(0.2 * std::sin(angle), z);
    const glm::dquat middle = clip == 0 ? glm::angleAxis(1.2 * std::sin(angle), x)
                                        : glm::angleAxis(1.5 * std::cos(angle), z);
    const glm::dquat end = glm::angleAxis(0.8 * std::cos(angle), clip == 0 ? y : x);
    return skinningFrom(_skin->getModel()->joints(), {root, middle, end},
                        glm::dvec3(0.0, 0.2 * std::sin(angle), 0.0));
}

osg::ref_ptr<osgSkin::CrowdCharacter> CrowdSubject::character(double time,
                                                              osg::StateSet* knobs) const {
    osg::ref_ptr<osgSkin::CrowdCharacter> result = new osgSkin::CrowdCharacter;
    const std::size_t skin = result->addSkin(*_skin, _upright);
    result->addRigid(*_knob, knobs, skin, "end");
    for (unsigned int clip = 0; clip < 2; ++clip) {
        osgSkin::CrowdCharacter::Samples samples(1);
        for (std::size_t i = 0; i < kSamples; ++i) samples[0].push_back(skinning(clip, i));
        result->addClip(samples, kSamplesPerSecond, true);
    }
    const auto rest = skinning(0, 0);
    result->addClip({std::vector<std::vector<glm::dmat4>>(members.size(), rest)}, 1.0, false);
    osgSkin::Pose pose(_skin->getModel()->joints(), _skin->getModel()->inputs().size());
    for (std::size_t i = 0; i < members.size(); ++i) {
        const auto now = skinning(members[i].clip, sampleOf(members[i], time));
        pose.set(now.data(), now.size());
        result->setSample(2, i, skin, pose);
    }
    return result;
}

std::vector<osgSkin::CrowdInstance> CrowdSubject::posedMembers() const {
    std::vector<osgSkin::CrowdInstance> posed = members;
    for (std::size_t i = 0; i < posed.size(); ++i) {
        posed[i].clip = 2;
        posed[i].phase = double(i);
        posed[i].speed = 0.0f;
    }
    return posed;
}

std::size_t CrowdSubject::sampleOf(const osgSkin::CrowdInstance& member, double time) const {
    const double at = (member.phase + double(member.speed) * time) * kSamplesPerSecond;
    return static_cast<std::size_t>(std::lround(at)) % kSamples;
}

osg::ref_ptr<osg::Group> CrowdSubject::skins(double time) const {
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (const osgSkin::CrowdInstance& member : members) {
        const osg::ref_ptr<osg::MatrixTransform> stand = new osg::MatrixTransform(
            _upright * osg::Matrixd::scale(osg::Vec3d(1, 1, 1) * double(member.scale)) *
            osg::Matrixd::rotate(member.rotation) * osg::Matrixd::translate(member.position));
        const osg::ref_ptr<osgSkin::DeformableSkin> skin =
            osg::clone(_skin.get(), osg::CopyOp::SHALLOW_COPY);
        const auto now = skinning(member.clip, sampleOf(member, time));
        skin->setPose(now.data(), now.size());
        stand->addChild(skin);
        const osg::ref_ptr<osg::MatrixTransform> end =
            new osg::MatrixTransform(osgSkin::toOsg(now.back()));
        end->addChild(_knob);
        stand->addChild(end);
        scene->addChild(stand);
    }
    return scene;
}

osg::ref_ptr<osg::Program> CrowdSubject::program() {
    osg::ref_ptr<osg::Program> made = new osg::Program;
    made->addShader(new osg::Shader(
        osg::Shader::VERTEX,
        "#version 330 compatibility\n"
        "#pragma import_defines(OSGSKIN)\n"
        "#ifdef OSGSKIN\n"
        "void osgSkin_vertex(inout vec4 vertex, inout vec3 normal, inout vec3 tangent,\n"
        "                    inout vec4 colour);\n"
        "#endif\n"
        "out vec3 n;\n"
        "void main() {\n"
        "  vec4 vertex = gl_Vertex, colour = vec4(1.0);\n"
        "  vec3 normal = gl_Normal, tangent = vec3(0.0);\n"
        "#ifdef OSGSKIN\n"
        "  osgSkin_vertex(vertex, normal, tangent, colour);\n"
        "#endif\n"
        "  n = gl_NormalMatrix * normal;\n"
        "  gl_Position = gl_ModelViewProjectionMatrix * vertex;\n"
        "}\n"));
    made->addShader(osgSkin::crowdVertexShader());
    made->addShader(
        new osg::Shader(osg::Shader::FRAGMENT,
                        "#version 330 compatibility\n"
                        "in vec3 n;\n"
                        "void main() { gl_FragColor = vec4(normalize(n) * 0.5 + 0.5, 1.0); }\n"));
    return made;
}

} // namespace test
