// SPDX-License-Identifier: MIT
#include "shader/ComputeProgram.h"

#include "shader/DeformText.h"

#include <osg/Shader>
#include <osg/ref_ptr>

namespace osgSkin {
namespace {

const char* const kMain = R"(
uniform samplerBuffer osgSkinPalette;

vec4 osgSkin_palette(int texel) {
  return texelFetch(osgSkinPalette, texel);
}

vec4 osgSkin_rotation(int joint) {
  return osgSkin_palette(4 * joint);
}

void osgSkin_anchor(int joint, inout vec3 x, inout vec3 n, inout vec3 t) {
  osgSkin_follow(joint, x, n, t);
}

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer OsgSkinPositions { float osgSkinPositions[]; };
layout(std430, binding = 1) writeonly buffer OsgSkinNormals { float osgSkinNormals[]; };
#ifdef OSGSKIN_TANGENTS
uniform samplerBuffer osgSkinTangents;
layout(std430, binding = 2) writeonly buffer OsgSkinPosedTangents { vec4 osgSkinPosedTangents[]; };
#endif

void main() {
  int vertex = int(gl_GlobalInvocationID.x);
  if (vertex >= int(osgSkin_words(0).z)) return;
  vec3 position, normal;
#ifdef OSGSKIN_TANGENTS
  vec4 rest = texelFetch(osgSkinTangents, vertex);
  vec3 tangent = rest.xyz;
#else
  vec3 tangent = vec3(0.0);
#endif
  osgSkin_deform(vertex, position, normal, tangent);
  for (int i = 0; i < 3; ++i) {
    osgSkinPositions[3 * vertex + i] = position[i];
    osgSkinNormals[3 * vertex + i] = normal[i];
  }
#ifdef OSGSKIN_TANGENTS
  osgSkinPosedTangents[vertex] = vec4(tangent, rest.w);
#endif
}
)";

osg::ref_ptr<osg::Program> make(const char* name, const char* defines) {
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->setName(name);
    program->addShader(new osg::Shader(osg::Shader::COMPUTE, std::string("#version 430\n") +
                                                                 defines + deformText() + kMain));
    return program;
}

} // namespace

osg::Program* computeProgram(bool withTangents) {
    // Never deleted: contexts may be gone when a process ends.
    static const auto& plain = *new osg::ref_ptr<osg::Program>(make("osgSkin deform", ""));
    static const auto& tangents = *new osg::ref_ptr<osg::Program>(
        make("osgSkin deform with tangents", "#define OSGSKIN_TANGENTS\n"));
    return withTangents ? tangents.get() : plain.get();
}

} // namespace osgSkin
