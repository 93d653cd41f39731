// SPDX-License-Identifier: MIT
// osgskin_gpu_bench: times compute shaders over a number of vertices, or whole frames.
#include "CommandLine.h"
#include "EglWindow.h"
#include "FindNodes.h"
#include "FrameBench.h"

#include "skin/DeformText.h"

#include <osgSkinGpu/GpuModel>
#include <osgSkinGpu/GpuPalette>

#include <osgSkin/DeformJob>
#include <osgSkin/DeformableSkin>
#include <osgSkin/GlmOsg>

#include <CLI/CLI.hpp>
#include <osg/GLExtensions>
#include <osgDB/ReadFile>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr GLenum kShaderStorage = 0x90D2, kComputeShader = 0x91B9;
constexpr GLuint kThreads = 64;

/// Null if the scene has no skin.
const osgSkin::SkinModel* largestSkin(osg::Node& scene) {
    const osgSkin::SkinModel* largest = nullptr;
    for (const auto& found : test::findNodes<osgSkin::DeformableSkin>(scene)) {
        const osgSkin::SkinModel* model = found.node->getModel();
        if (!largest || model->vertexCount() > largest->vertexCount()) largest = model;
    }
    return largest;
}

/// The current context.
class Card {
public:
    explicit Card(unsigned int id) : gl(*osg::GLExtensions::Get(id, true)) {}

    GLuint program(const std::string& text) const {
        const GLuint shader = gl.glCreateShader(kComputeShader), made = gl.glCreateProgram();
        const char* source = text.c_str();
        gl.glShaderSource(shader, 1, &source, nullptr);
        gl.glCompileShader(shader);
        gl.glAttachShader(made, shader);
        gl.glLinkProgram(made);
        GLint linked = 0;
        gl.glGetProgramiv(made, GL_LINK_STATUS, &linked);
        if (linked) return made;
        char log[2000] = "";
        gl.glGetShaderInfoLog(shader, sizeof log, nullptr, log);
        throw std::runtime_error(std::string("a shader does not compile: ") + log);
    }
    GLuint buffer(GLsizeiptr bytes, const void* data) const {
        GLuint made = 0;
        gl.glGenBuffers(1, &made);
        gl.glBindBuffer(kShaderStorage, made);
        gl.glBufferData(kShaderStorage, bytes, data, GL_STATIC_DRAW_ARB);
        return made;
    }
    void texture(GLuint program, const char* name, GLint unit, GLenum format, GLuint from) const {
        GLuint made = 0;
        glGenTextures(1, &made);
        gl.glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        glBindTexture(GL_TEXTURE_BUFFER_ARB, made);
        gl.glTexBuffer(GL_TEXTURE_BUFFER_ARB, format, from);
        gl.glUseProgram(program);
        gl.glUniform1i(gl.glGetUniformLocation(program, name), unit);
    }
    /// Milliseconds, by the clock: timer queries are wrong on llvmpipe.
    double time(GLuint program, GLuint vertices, GLuint characters) const {
        gl.glUseProgram(program);
        double best = 1e9;
        double all = 0.0;
        for (int i = 0; i < 50 && (i < 3 || all < 2000.0); ++i) {
            glFinish();
            const auto start = std::chrono::steady_clock::now();
            gl.glDispatchCompute((vertices + kThreads - 1) / kThreads, characters, 1);
            glFinish();
            const std::chrono::duration<double, std::milli> took =
                std::chrono::steady_clock::now() - start;
            best = std::min(best, took.count());
            all += took.count();
        }
        return best;
    }

    const osg::GLExtensions& gl;
};

const std::string kOutput = "layout(local_size_x = 64) in;\n"
                            "layout(std430, binding = 0) writeonly buffer To { float to[]; };\n"
                            "uniform int vertices;\n"
                            "void put(int place, vec3 x, vec3 n) {\n"
                            "  for (int i = 0; i < 3; ++i) {\n"
                            "    to[6 * place + i] = x[i];\n"
                            "    to[6 * place + 3 + i] = n[i];\n"
                            "  }\n"
                            "}\n";
const std::string kPlace = "  int vertex = int(gl_GlobalInvocationID.x);\n"
                           "  int character = int(gl_GlobalInvocationID.y);\n"
                           "  if (vertex >= vertices) return;\n"
                           "  int place = character * vertices + vertex;\n";

std::string ours() {
    return "#version 430\n" + osgSkin::deformText() +
           "uniform samplerBuffer palettes;\nuniform int paletteSize;\nint base;\n"
           "vec4 osgSkin_palette(int texel) { return texelFetch(palettes, base + texel); }\n"
           "vec4 osgSkin_rotation(int joint) { return osgSkin_palette(4 * joint); }\n"
           "void osgSkin_anchor(int joint, inout vec3 x, inout vec3 n, inout vec3 t) {\n"
           "  osgSkin_follow(joint, x, n, t);\n}\n" +
           kOutput + "void main() {\n" + kPlace +
           "  base = character * paletteSize;\n  vec3 x, n, t = vec3(0.0);\n"
           "  osgSkin_deform(vertex, x, n, t);\n  put(place, x, n);\n}\n";
}

std::string copying() {
    return "#version 430\nlayout(std430, binding = 1) readonly buffer From { float from[]; };\n" +
           kOutput + "void main() {\n" + kPlace +
           "  int at = 6 * place;\n"
           "  put(place, vec3(from[at], from[at + 1], from[at + 2]),\n"
           "      vec3(from[at + 3], from[at + 4], from[at + 5]));\n}\n";
}

/// A vertex has position and joints, normal, and weights; a palette has three rows per joint.
std::string blending() {
    return "#version 430\nuniform usamplerBuffer rest;\nuniform samplerBuffer palettes;\n"
           "uniform int paletteSize;\n" +
           kOutput + "void main() {\n" + kPlace +
           "  uvec4 a = texelFetch(rest, 3 * vertex);\n"
           "  vec3 n = uintBitsToFloat(texelFetch(rest, 3 * vertex + 1).xyz);\n"
           "  vec4 w = uintBitsToFloat(texelFetch(rest, 3 * vertex + 2));\n"
           "  vec4 rows[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));\n"
           "  for (int i = 0; i < 4; ++i) {\n"
           "    int joint = character * paletteSize + 3 * int((a.w >> uint(8 * i)) & 0xffu);\n"
           "    for (int r = 0; r < 3; ++r) rows[r] += w[i] * texelFetch(palettes, joint + r);\n"
           "  }\n"
           "  vec4 x = vec4(uintBitsToFloat(a.xyz), 1.0);\n"
           "  put(place, vec3(dot(rows[0], x), dot(rows[1], x), dot(rows[2], x)),\n"
           "      normalize(vec3(dot(rows[0].xyz, n), dot(rows[1].xyz, n), dot(rows[2].xyz, "
           "n))));\n"
           "}\n";
}

/// A pose for each character: joints rotated by some tenths of a radian.
std::vector<osgSkin::Pose> poses(const osgSkin::SkinModel& model, std::size_t count) {
    std::vector<osgSkin::Pose> result;
    const std::vector<osgSkin::BoundJoint>& joints = model.joints();
    for (std::size_t c = 0; c < count; ++c) {
        std::vector<glm::dmat4> skinning;
        for (std::size_t j = 0; j < joints.size(); ++j) {
            const double angle = 0.4 * std::sin(0.7 * double(c) + 1.3 * double(j));
            const glm::dquat turn = glm::angleAxis(
                angle, glm::normalize(glm::dvec3(1.0, 0.3 * double(j % 5), 0.2 * double(j % 3))));
            glm::dmat4 own(glm::mat3_cast(turn));
            own[3] = glm::dvec4(joints[j].centre - turn * joints[j].centre, 1.0);
            const int parent = joints[j].parent;
            skinning.push_back(parent < 0 ? own : skinning[static_cast<std::size_t>(parent)] * own);
        }
        result.emplace_back(joints, model.inputs().size());
        result.back().set(skinning.data(), skinning.size());
    }
    return result;
}

unsigned int bits(float x) {
    unsigned int word;
    std::copy_n(reinterpret_cast<const char*>(&x), sizeof word, reinterpret_cast<char*>(&word));
    return word;
}

int bench(const osgSkin::SkinModel& model, GLuint wanted, const Card& card) {
    const osg::GLExtensions& gl = card.gl;
    const osg::ref_ptr<const osgSkin::GpuModel> packed = osgSkin::GpuModel::of(model);
    const auto vertices = static_cast<GLuint>(model.vertexCount());
    const GLuint characters = std::max(1u, std::min(65535u, wanted / vertices));
    const GLsizeiptr bytes = GLsizeiptr(24) * vertices * characters;
    const GLuint to = card.buffer(bytes, nullptr), from = card.buffer(bytes, nullptr);
    gl.glBindBufferBase(kShaderStorage, 0, to);
    gl.glBindBufferBase(kShaderStorage, 1, from);

    const std::vector<osgSkin::Pose> all = poses(model, characters);
    std::vector<osg::Vec4> palettes(packed->paletteSize() * characters);
    for (GLuint c = 0; c < characters; ++c)
        osgSkin::writePalette(*packed, all[c], &palettes[c * packed->paletteSize()]);
    const auto set = [&](GLuint program, const char* name, GLint value) {
        gl.glUseProgram(program);
        gl.glUniform1i(gl.glGetUniformLocation(program, name), value);
    };
    const auto sized = [](const auto& list) {
        return static_cast<GLsizeiptr>(list.size() * sizeof(list[0]));
    };
    const osg::BufferData& texels = *packed->texture()->getBufferData();
    const GLuint deform = card.program(ours());
    card.texture(deform, "osgSkinModel", 0, GL_RGBA32UI_EXT,
                 card.buffer(texels.getTotalDataSize(), texels.getDataPointer()));
    card.texture(deform, "palettes", 1, GL_RGBA32F_ARB,
                 card.buffer(sized(palettes), palettes.data()));
    set(deform, "paletteSize", static_cast<GLint>(packed->paletteSize()));
    set(deform, "vertices", static_cast<GLint>(vertices));

    const GLuint copy = card.program(copying());
    set(copy, "vertices", static_cast<GLint>(vertices));

    // The weights do not matter here, only their number; the joints are neighbours.
    const std::size_t joints = model.joints().size();
    std::vector<osg::Vec4ui> rest;
    for (GLuint v = 0; v < vertices; ++v) {
        const glm::vec3 &p = model.positions()[v], &n = model.normals()[v];
        unsigned int four = 0;
        for (unsigned int i = 0; i < 4; ++i)
            four |= static_cast<unsigned int>((v * joints / vertices + i) % joints % 256) << 8 * i;
        rest.push_back({bits(p.x), bits(p.y), bits(p.z), four});
        rest.push_back({bits(n.x), bits(n.y), bits(n.z), 0});
        rest.push_back({bits(0.4f), bits(0.3f), bits(0.2f), bits(0.1f)});
    }
    const std::vector<osg::Vec4> rows(3 * joints * characters, osg::Vec4(1, 0, 0, 0));
    const GLuint blend = card.program(blending());
    card.texture(blend, "rest", 2, GL_RGBA32UI_EXT, card.buffer(sized(rest), rest.data()));
    card.texture(blend, "palettes", 3, GL_RGBA32F_ARB, card.buffer(sized(rows), rows.data()));
    set(blend, "paletteSize", static_cast<GLint>(3 * joints));
    set(blend, "vertices", static_cast<GLint>(vertices));

    const double million = 1e-6 * double(vertices) * double(characters);
    std::printf("%s\n%.2f million vertices: %u characters of %u, %zu joints\n",
                reinterpret_cast<const char*>(glGetString(GL_RENDERER)), million, characters,
                vertices, joints);
    const double copied = card.time(copy, vertices, characters);
    const double blended = card.time(blend, vertices, characters);
    const double took = card.time(deform, vertices, characters);
    std::printf("copying the bytes  %8.3f ms  %.3f ns a vertex, %.1f GB/s\n", copied,
                copied / million, 2e-6 * double(bytes) / copied);
    std::printf("linear blending    %8.3f ms  %.3f ns a vertex\n", blended, blended / million);
    std::printf("our deformation    %8.3f ms  %.3f ns a vertex: %.2f x copying, %.2f x linear "
                "blending\n",
                took, took / million, took / copied, took / blended);

    // Checks the timed result: the last character against the CPU.
    std::vector<glm::vec3> positions(vertices), normals(vertices);
    osgSkin::DeformJob job;
    job.model = &model;
    job.pose = &all.back();
    job.positions = positions.data();
    job.normals = normals.data();
    job.positionCount = job.normalCount = vertices;
    job.run();
    std::vector<float> computed(std::size_t(6) * vertices);
    gl.glBindBuffer(kShaderStorage, to);
    gl.glGetBufferSubData(kShaderStorage, bytes - sized(computed), sized(computed),
                          computed.data());
    float most = 0.0f, extent = 0.0f;
    for (GLuint v = 0; v < vertices; ++v)
        for (int i = 0; i < 3; ++i) {
            const float is = computed[6 * v + static_cast<GLuint>(i)];
            most = std::max(most, std::abs(is - positions[v][i]));
            extent = std::max(extent, std::abs(positions[v][i]));
        }
    std::printf("farthest from the processor's: %.2g of the extent\n", double(most / extent));
    return most <= 1e-5f * extent ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) {
    example::CommandLine line(
        "osgskin_gpu_bench",
        "Times compute shaders over a number of vertices, in as many characters as needed, "
        "each in its own pose: our deformation, copying the same bytes, and linear blending "
        "of four matrices. With --draw, times whole frames. Needs no display.");
    std::string file = std::string(OSGSKIN_DATA) + "/thrower.skin";
    GLuint wanted = 500000;
    bool frames = false;
    std::vector<std::size_t> crowds = {1000, 10000, 100000};
    std::size_t maxTriangles = 0, singles = 100;
    line.add("character", file, "any file with a deformable skin").showDefault();
    line.add("vertices", wanted, "how many vertices to deform").showDefault();
    const auto whole =
        line.add("--draw", frames, "draw whole frames of 1920 x 1080 pixels instead");
    line.add("--crowd", crowds, "members of the crowds, one crowd after the other")
        .range(1, 10000000)
        .needs(whole);
    line.add("--max-triangles", maxTriangles, "draw the crowds once more with this limit; 0: none")
        .needs(whole);
    line.add("--single", singles,
             "characters that are loaded one by one, drawn with and without the card; 0: none")
        .showDefault()
        .needs(whole);
    return line.run(argc, argv, [&] {
        line.parse(argc, argv);
        if (frames) {
            benchFrames(file, crowds, maxTriangles, singles);
            return 0;
        }
        const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(file);
        const osgSkin::SkinModel* model = scene ? largestSkin(*scene) : nullptr;
        if (!model) throw std::runtime_error(file + ": expected a character with a skin");
        const osg::ref_ptr<test::EglWindow> window = new test::EglWindow(16, 16);
        if (!window->valid() || !window->realize() || !window->makeCurrent())
            throw std::runtime_error("EGL gives no context");
        const int result = bench(*model, wanted, Card(window->getState()->getContextID()));
        window->releaseContext();
        return result;
        return 0;
    });
}
