// SPDX-License-Identifier: MIT
#include "skin/DeformText.h"

namespace osgSkin {
namespace {

// The layout of osgSkinModel: see GpuModel; of the palette: see GpuPalette.
const char* const kFetch = R"(
uniform usamplerBuffer osgSkinModel;

uvec4 osgSkin_words(int texel) {
  return texelFetch(osgSkinModel, texel);
}
)";

// Built-in sines and cosines may be off by 1e-3. Minimax up to pi / 2, errors 3.3e-9 and 5.3e-8,
// and exact at 0, for the rest pose.
const char* const kTurns = R"(
vec2 osgSkin_sineByAngleAndCosine(float t) {
  float s = 2.5904852963e-06;
  s = s * t - 1.9800896183e-04;
  s = s * t + 8.3328997978e-03;
  s = s * t - 1.6666647633e-01;
  s = s * t + 9.9999997659e-01;
  float c = 2.3194355375e-05;
  c = c * t - 1.3855925896e-03;
  c = c * t + 4.1663989297e-02;
  c = c * t - 4.9999932288e-01;
  return vec2(s, c * t + 1.0);
}

/// The rotation about `halfTurn` by twice its length, which is up to pi / 2.
vec4 osgSkin_turn(vec3 halfTurn) {
  vec2 sc = osgSkin_sineByAngleAndCosine(dot(halfTurn, halfTurn));
  return vec4(sc.x * halfTurn, sc.y);
}

/// The rotation about a unit axis by four times `quarter`, which is up to pi / 2.
vec4 osgSkin_twist(vec3 axis, float quarter) {
  vec2 sc = osgSkin_sineByAngleAndCosine(quarter * quarter);
  float s = sc.x * quarter;
  return vec4((2.0 * s * sc.y) * axis, 1.0 - 2.0 * s * s);
}

vec4 osgSkin_product(vec4 a, vec4 b) {
  return vec4(a.w * b.xyz + b.w * a.xyz + cross(a.xyz, b.xyz), a.w * b.w - dot(a.xyz, b.xyz));
}

vec3 osgSkin_rotate(vec4 q, vec3 x) {
  vec3 t = 2.0 * cross(q.xyz, x);
  return x + q.w * t + cross(q.xyz, t);
}

vec3 osgSkin_scaledTo(vec3 x, float size) {
  float is = length(x);
  return is > 0.0 ? x * (size / is) : x;
}
)";

// Where the model has gradients and a joint tilts the group's normals, two directions along the
// skin go through the chain; else normals rotate as their vertices do. Positions are relative to
// the centre of the next joint: normals of folded skin need the digits.
const char* const kDeform = R"(
/// By the skinning matrix G of a joint.
void osgSkin_follow(int joint, inout vec3 x, inout vec3 n, inout vec3 t) {
  vec4 q = osgSkin_rotation(joint);
  vec4 place = osgSkin_palette(4 * joint + 1);
  x = place.xyz + place.w * osgSkin_rotate(q, x - uintBitsToFloat(osgSkin_words(1 + 2 * joint).xyz));
  n = osgSkin_rotate(q, n);
  t = osgSkin_rotate(q, t);
}

/// The two directions along the skin of the gradients' components.
void osgSkin_directions(vec3 n, out vec3 u, out vec3 v) {
  float s = n.z >= 0.0 ? 1.0 : -1.0;
  float a = -1.0 / (s + n.z);
  float b = n.x * n.y * a;
  u = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
  v = vec3(b, s + n.y * n.y * a, -n.y);
}

vec2 osgSkin_shorts(uint word) {
  return vec2(float(int(word << 16u) >> 16), float(int(word) >> 16));
}

void osgSkin_correct(int texel, out vec3 correction, out vec3 tilt) {
  correction = tilt = vec3(0.0);
  int entries = int(osgSkin_words(texel++).x);
  for (int i = 0; i < entries; ++i) {
    uvec4 entry = osgSkin_words(texel++);
    int modes = int(entry.y);
    for (int k = 0; k < modes; ++k) {
      uvec4 shares = osgSkin_words(texel++);
      vec4 two = osgSkin_palette(int(entry.x) + (k >> 1));
      vec2 weights = (k & 1) == 0 ? two.xy : two.zw;
      correction += weights.x * vec3(osgSkin_shorts(shares.x), osgSkin_shorts(shares.y).x);
      tilt += weights.y * vec3(osgSkin_shorts(shares.z), osgSkin_shorts(shares.w).x);
    }
  }
}

/// Poses a vertex of the model. The tangent is at rest on entry.
void osgSkin_deform(int vertex, out vec3 position, out vec3 normal, inout vec3 tangent) {
  uvec4 head = osgSkin_words(0);
  uvec4 a = osgSkin_words(int(head.y) + 2 * vertex);
  uvec4 b = osgSkin_words(int(head.y) + 2 * vertex + 1);
  uvec4 chain = osgSkin_words(int(a.w));
#ifdef OSGSKIN_PLAIN
  chain.z = 0u; // neither correctives nor gradients
#endif
  int links = int(chain.y);
  vec3 x = uintBitsToFloat(a.xyz); // from the first link's centre
  vec3 n = uintBitsToFloat(b.xyz);
  vec3 t = tangent;
  vec3 correction = vec3(0.0), tilt = vec3(0.0);
  bool hasGradients = (chain.z & 2u) != 0u;
  if ((chain.z & 1u) != 0u)
    osgSkin_correct(int(b.w) + (hasGradients ? 2 * links : links), correction, tilt);
  x += correction;
#ifdef OSGSKIN_MORPHS
  osgSkin_morph(vertex, n, x, tilt, t);
#endif
  float tangentLength = length(t);

  bool tilts = false;
  if (hasGradients)
    for (int i = 0; i < links; ++i) {
      uvec4 link = osgSkin_words(int(a.w) + 1 + i);
      vec4 turn = osgSkin_palette(4 * int(link.x) + 2);
      vec2 reach = uintBitsToFloat(link.yz);
      tilts = tilts || length(turn.xyz) * reach.x > 1e-3 || abs(turn.w) * reach.y > 1e-3 ||
              (reach.x >= 0.0 && osgSkin_palette(4 * int(link.x) + 3) != vec4(0.0));
    }
  vec3 u = vec3(0.0), v = vec3(0.0);
  if (tilts) {
    osgSkin_directions(n, u, v);
    vec2 along = vec2(dot(t, u), dot(t, v));
    u -= dot(tilt, u) * n;
    v -= dot(tilt, v) * n;
    t = vec3(along, 0.0);
  } else if (tilt != vec3(0.0)) {
    n = osgSkin_scaledTo(n + tilt, 1.0);
    t = osgSkin_scaledTo(t - dot(t, n) * n, tangentLength);
  }

  for (int i = 0; i < links; ++i) { // innermost first
    uvec4 link = osgSkin_words(int(a.w) + 1 + i);
    uvec4 own = osgSkin_words(int(b.w) + i);
    vec2 ratio = uintBitsToFloat(own.xy);
    int joint = int(link.x);
    vec3 next = uintBitsToFloat(osgSkin_words(int(a.w) + 1 + links + i).xyz);
    vec3 pole = uintBitsToFloat(osgSkin_words(2 + 2 * joint).xyz);
    vec4 turn = osgSkin_palette(4 * joint + 2); // psi v, phi
    vec4 move = osgSkin_palette(4 * joint + 3);
    vec4 twist = osgSkin_twist(pole, 0.25 * ratio.y * turn.w);
    vec4 q = osgSkin_product(osgSkin_turn(0.5 * ratio.x * turn.xyz), twist);
    float factor = 1.0 + ratio.x * move.w;
    vec3 from = osgSkin_rotate(q, x);
    if (tilts) {
      // Added before the rotation: where skin folds, the sum is small, and keeps its digits.
      vec2 reach = uintBitsToFloat(link.yz);
      vec3 byBend = vec3(0.0), byTwist = vec3(0.0);
      if (length(turn.xyz) * reach.x > 1e-3)
        byBend = cross(osgSkin_rotate(vec4(-twist.xyz, twist.w), turn.xyz), x);
      if (abs(turn.w) * reach.y > 1e-3) byTwist = turn.w * cross(pole, x);
      // The bend ratio's along u and v, the twist ratio's along u and v.
      vec4 slope = uintBitsToFloat(osgSkin_words(int(b.w) + links + i));
      u += slope.z * byTwist + slope.x * byBend;
      v += slope.w * byTwist + slope.y * byBend;
      vec3 byMove = move.w * from + move.xyz;
      u = factor * osgSkin_rotate(q, u) + slope.x * byMove;
      v = factor * osgSkin_rotate(q, v) + slope.y * byMove;
    } else {
      n = osgSkin_rotate(q, n);
      t = osgSkin_rotate(q, t);
    }
    x = (factor * from + ratio.x * move.xyz) + next;
  }

  if (tilts) {
    vec3 most = max(abs(u), abs(v));
    float size = max(most.x, max(most.y, most.z));
    if (size > 1e4 || (size > 0.0 && size < 1e-4)) { // squares of squares may overflow
      u /= size;
      v /= size;
    }
    n = osgSkin_scaledTo(cross(u, v), 1.0);
    t = osgSkin_scaledTo(t.x * u + t.y * v, tangentLength);
  }
  if (chain.x != 0xffffffffu) osgSkin_anchor(int(chain.x), x, n, t);
  position = x;
  normal = n;
  tangent = t;
}
)";

} // namespace

const std::string& deformText() {
    // Functions that differ between single skins and crowds come with the including shader.
    static const std::string text =
        std::string(kFetch) + kTurns +
        "vec4 osgSkin_palette(int texel);\n"
        "vec4 osgSkin_rotation(int joint);\n"
        "void osgSkin_anchor(int joint, inout vec3 x, inout vec3 n, inout vec3 t);\n"
        "void osgSkin_morph(int vertex, vec3 n, inout vec3 x, inout vec3 tilt, inout vec3 t);\n" +
        kDeform;
    return text;
}

} // namespace osgSkin
