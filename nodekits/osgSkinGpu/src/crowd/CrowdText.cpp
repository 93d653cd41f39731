// SPDX-License-Identifier: MIT
#include "crowd/CrowdText.h"

#include "skin/ComputeStage.h"
#include "skin/DeformText.h"

#include <osg/ref_ptr>

namespace osgSkin {
namespace {

// Layouts: CrowdCharacter::writeClips() for clips, CrowdInstance::pack() for instances.
const char* const kInstances = R"(
uniform samplerBuffer osgSkinClips;
uniform usamplerBuffer osgSkinInstances;
uniform usamplerBuffer osgSkinVisible;
uniform int osgSkinFirstVisible;
uniform int osgSkinPaletteSize;
uniform float osgSkinTime;
uniform mat4 osgSkinStand;

ivec4 osgSkinFrames;     // the texels of two samples of one clip, then of the other
vec3 osgSkinShares;      // weights of the second sample of each, and of the other clip

vec4 osgSkin_palette(int texel) {
  vec4 one = mix(texelFetch(osgSkinClips, osgSkinFrames.x + texel),
                 texelFetch(osgSkinClips, osgSkinFrames.y + texel), osgSkinShares.x);
  if (osgSkinShares.z == 0.0) return one;
  vec4 other = mix(texelFetch(osgSkinClips, osgSkinFrames.z + texel),
                   texelFetch(osgSkinClips, osgSkinFrames.w + texel), osgSkinShares.y);
  return mix(one, other, osgSkinShares.z);
}

vec4 osgSkin_mixed(vec4 a, vec4 b, float share) {
  return share == 0.0 ? a : mix(a, dot(a, b) < 0.0 ? -b : b, share);
}

vec4 osgSkin_rotation(int joint) {
  int texel = 4 * joint;
  vec4 q = osgSkin_mixed(texelFetch(osgSkinClips, osgSkinFrames.x + texel),
                         texelFetch(osgSkinClips, osgSkinFrames.y + texel), osgSkinShares.x);
  if (osgSkinShares.z != 0.0)
    q = osgSkin_mixed(normalize(q),
                      osgSkin_mixed(texelFetch(osgSkinClips, osgSkinFrames.z + texel),
                                    texelFetch(osgSkinClips, osgSkinFrames.w + texel),
                                    osgSkinShares.y),
                      osgSkinShares.z);
  return osgSkinShares == vec3(0.0) ? q : normalize(q);
}
)";

// Between samples of a clip, G is interpolated; between two clips, which may differ much, it is
// computed from the joints' blended rotations, so that the skin stays whole where a ratio
// reaches 1.
const char* const kBlend = R"(
void osgSkin_anchor(int joint, inout vec3 x, inout vec3 n, inout vec3 t) {
  if (osgSkinShares.z > 0.0 && osgSkinShares.z < 1.0)
    for (int i = 0; i < 256; ++i) {
      uvec4 rest = osgSkin_words(1 + 2 * joint);
      int parent = int(rest.w);
      if (parent < 0) break;
      vec3 centre = uintBitsToFloat(rest.xyz);
      vec3 pole = uintBitsToFloat(osgSkin_words(2 + 2 * joint).xyz);
      vec4 turn = osgSkin_palette(4 * joint + 2);
      vec4 move = osgSkin_palette(4 * joint + 3);
      vec4 q = osgSkin_product(osgSkin_turn(0.5 * turn.xyz), osgSkin_twist(pole, 0.25 * turn.w));
      x = centre + move.xyz + (1.0 + move.w) * osgSkin_rotate(q, x - centre);
      n = osgSkin_rotate(q, n);
      t = osgSkin_rotate(q, t);
      joint = parent;
    }
  osgSkin_follow(joint, x, n, t);
}

/// The two samples of a clip around a time: their texels, and the weight of the second.
void osgSkin_sample(int clip, float seconds, out ivec2 texels, out float share) {
  vec4 about = texelFetch(osgSkinClips, clip); // first texel, samples, samples per second, loops
  float last = about.y - 1.0;
  float at = seconds * about.z;
  at = about.w > 0.5 ? at - about.y * floor(at / about.y) : clamp(at, 0.0, last);
  float first = min(floor(at), last);
  share = at - first;
  float next = first < last ? first + 1.0 : about.w > 0.5 ? 0.0 : last;
  texels = int(about.x) + osgSkinPaletteSize * ivec2(int(first), int(next));
}

void osgSkin_vertex(inout vec4 vertex, inout vec3 normal, inout vec3 tangent, inout vec4 colour) {
  int id = 4 * int(texelFetch(osgSkinVisible, osgSkinFirstVisible + gl_InstanceID).x);
  vec4 place = uintBitsToFloat(texelFetch(osgSkinInstances, id));
  vec4 facing = uintBitsToFloat(texelFetch(osgSkinInstances, id + 1));
  vec4 times = uintBitsToFloat(texelFetch(osgSkinInstances, id + 2));
  uvec4 rest = texelFetch(osgSkinInstances, id + 3);
  osgSkinShares.z = uintBitsToFloat(rest.y);
  osgSkin_sample(int(rest.x & 0xffffu), times.x + times.y * osgSkinTime, osgSkinFrames.xy,
                 osgSkinShares.x);
  osgSkinFrames.zw = osgSkinFrames.xy;
  osgSkinShares.y = 0.0;
  if (osgSkinShares.z != 0.0)
    osgSkin_sample(int(rest.x >> 16u), times.z + times.w * osgSkinTime, osgSkinFrames.zw,
                   osgSkinShares.y);
  vec3 x, n;
  vec3 t = tangent;
  osgSkin_deform(gl_VertexID, x, n, t);
  mat3 upright = mat3(osgSkinStand);
  x = (osgSkinStand * vec4(x, 1.0)).xyz;
  vertex = vec4(place.xyz + place.w * osgSkin_rotate(facing, x), 1.0);
  normal = osgSkin_rotate(facing, upright * n);
  tangent = osgSkin_rotate(facing, upright * t);
  colour *= vec4(rest.z & 0xffu, (rest.z >> 8u) & 0xffu, (rest.z >> 16u) & 0xffu, rest.z >> 24u) /
            255.0;
}
)";

const char* const kPlainVertex = R"(#version 330 compatibility
#pragma import_defines(OSGSKIN)
#ifdef OSGSKIN
void osgSkin_vertex(inout vec4 vertex, inout vec3 normal, inout vec3 tangent, inout vec4 colour);
#endif
out vec4 osgSkinColour;
out vec3 osgSkinNormal;
out vec3 osgSkinPlace;
out vec2 osgSkinTexture;
void main() {
  vec4 vertex = gl_Vertex;
  vec3 normal = gl_Normal, tangent = vec3(0.0);
  osgSkinColour = gl_FrontMaterial.diffuse;
#ifdef OSGSKIN // undefined while OSG precompiles
  osgSkin_vertex(vertex, normal, tangent, osgSkinColour);
#endif
  osgSkinNormal = gl_NormalMatrix * normal;
  osgSkinPlace = (gl_ModelViewMatrix * vertex).xyz;
  osgSkinTexture = gl_MultiTexCoord0.xy;
  gl_Position = gl_ModelViewProjectionMatrix * vertex;
}
)";

const char* const kPlainFragment = R"(#version 330 compatibility
#pragma import_defines(OSGSKIN_TEXTURE, OSGSKIN_FAR)
in vec4 osgSkinColour;
in vec3 osgSkinNormal;
in vec3 osgSkinPlace;
in vec2 osgSkinTexture;
#ifdef OSGSKIN_TEXTURE
uniform sampler2D osgSkinImage;
#endif
void main() {
  vec4 colour = osgSkinColour;
#ifdef OSGSKIN_TEXTURE
  colour *= texture(osgSkinImage, osgSkinTexture);
#endif
  vec3 normal = osgSkinNormal;
#ifdef OSGSKIN_FAR // so few vertices that normals between them may cancel each other
  normal = cross(dFdx(osgSkinPlace), dFdy(osgSkinPlace));
#endif
  float lit = max(0.0, dot(normalize(normal), normalize(gl_LightSource[0].position.xyz)));
  gl_FragColor = vec4(colour.rgb * (0.2 + 0.8 * lit), colour.a);
}
)";

// The size of a character is its sphere's radius in the picture, in half picture heights. Levels as
// CrowdLevels has them.
const char* const kCull = R"(#version 430
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer OsgSkinCommands { uint osgSkinCommands[]; };
layout(std430, binding = 1) writeonly buffer OsgSkinList { uint osgSkinList[]; };
layout(std430, binding = 2) buffer OsgSkinFit {
  uint osgSkinFit;       // 256 less the steps that sizes are raised by
  uint osgSkinAsIs[8];   // members of each level without a limit
  uint osgSkinBins[256]; // members of each bin of sizes
};
uniform usamplerBuffer osgSkinInstances;
uniform vec4 osgSkinPlanes[4];
uniform vec4 osgSkinSphere;    // of a character in its own space: centre and radius
uniform vec4 osgSkinEye;       // and the size of radius 1 at distance 1
uniform int osgSkinIsFlat;     // orthographic
uniform ivec4 osgSkinCounts;   // instances, levels, parts, list entries per level
uniform float osgSkinSizes[8]; // below which each level is drawn
uniform int osgSkinStep;       // see CullStep
uniform uint osgSkinMaxTriangles; // 0: no limit
uniform uint osgSkinTriangles[8]; // of a member in each level

int osgSkin_bin(float size) {
  return clamp((floatBitsToInt(size) >> 19) - 1840, 0, 255);
}

int osgSkin_level(float size, int bin, int steps) {
  int level = 0;
  while (level + 1 < osgSkinCounts.y &&
         (steps == 0 ? size < osgSkinSizes[level + 1]
                     : bin < osgSkin_bin(osgSkinSizes[level + 1]) + steps)) ++level;
  return level;
}

/// Whether the limit has room for some members, which it then has no more.
bool osgSkin_take(inout uint room, uint members, int level) {
  uint each = osgSkinTriangles[level];
  if (members == 0u || each == 0u) return true;
  if (members > room / each) return false;
  room -= members * each;
  return true;
}

bool osgSkin_fits(int steps) {
  uint room = osgSkinMaxTriangles;
  if (steps == 0) {
    for (int level = 0; level < osgSkinCounts.y; ++level)
      if (!osgSkin_take(room, osgSkinAsIs[level], level)) return false;
  } else {
    for (int bin = 0; bin < 256; ++bin)
      if (!osgSkin_take(room, osgSkinBins[bin], osgSkin_level(0.0, bin, steps))) return false;
  }
  return true;
}

void main() {
  int id = int(gl_GlobalInvocationID.x);
  if (osgSkinStep == 2) {
    if (osgSkin_fits(id)) atomicMax(osgSkinFit, 256u - uint(id));
    return;
  }
  if (id >= osgSkinCounts.x) return;
  vec4 place = uintBitsToFloat(texelFetch(osgSkinInstances, 4 * id));
  vec4 q = uintBitsToFloat(texelFetch(osgSkinInstances, 4 * id + 1));
  vec3 t = 2.0 * cross(q.xyz, osgSkinSphere.xyz);
  vec3 centre = place.xyz + place.w * (osgSkinSphere.xyz + q.w * t + cross(q.xyz, t));
  float radius = abs(place.w) * osgSkinSphere.w;
  for (int i = 0; i < 4; ++i)
    if (dot(osgSkinPlanes[i].xyz, centre) + osgSkinPlanes[i].w < -radius) return;
  float size = radius * osgSkinEye.w;
  if (osgSkinIsFlat == 0) size /= max(distance(osgSkinEye.xyz, centre), 1e-6);
  if (osgSkinStep == 1) {
    atomicAdd(osgSkinAsIs[osgSkin_level(size, 0, 0)], 1u);
    atomicAdd(osgSkinBins[osgSkin_bin(size)], 1u);
    return;
  }
  int steps = osgSkinMaxTriangles == 0u ? 0 : 256 - int(osgSkinFit);
  int level = osgSkin_level(size, osgSkin_bin(size), steps);
  uint slot = 0u;
  for (int part = 0; part < osgSkinCounts.z; ++part) {
    uint before = atomicAdd(osgSkinCommands[5 * (level * osgSkinCounts.z + part) + 1], 1u);
    if (part == 0) slot = before;
  }
  osgSkinList[uint(level * osgSkinCounts.w) + slot] = uint(id);
}
)";

osg::ref_ptr<osg::Program> program(const char* name) {
    osg::ref_ptr<osg::Program> made = new osg::Program;
    made->setName(name);
    return made;
}

} // namespace

std::string crowdText() {
    return "#version 330\n#pragma import_defines(OSGSKIN_PLAIN)\n#pragma requires(OSGSKIN)\n" +
           deformText() + kInstances + kBlend;
}

osg::ref_ptr<osg::Program> plainCrowdProgram() {
    static SharedProgram plain([] {
        osg::ref_ptr<osg::Program> made = program("osgSkin crowd");
        made->addShader(new osg::Shader(osg::Shader::VERTEX, kPlainVertex));
        made->addShader(new osg::Shader(osg::Shader::VERTEX, crowdText()));
        made->addShader(new osg::Shader(osg::Shader::FRAGMENT, kPlainFragment));
        return made;
    });
    return plain.get();
}

osg::ref_ptr<osg::Program> cullProgram() {
    static SharedProgram cull([] {
        osg::ref_ptr<osg::Program> made = program("osgSkin crowd culling");
        made->addShader(new osg::Shader(osg::Shader::COMPUTE, kCull));
        return made;
    });
    return cull.get();
}

} // namespace osgSkin
