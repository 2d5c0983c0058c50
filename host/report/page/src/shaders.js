// What the graphics processor computes for points and triangles. Positions are relative to the origin
// of the geometry; `section` is a plane, (normal, distance), whose outer side is not drawn.

const HEAD = `precision highp float;
precision highp int;
`;

const VERTEX = `${HEAD}
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform vec4 section;
out float outside;
void put(vec3 place, float nearer) {
  outside = dot(section.xyz, place) - section.w;
  vec4 seen = modelViewMatrix * vec4(place, 1.0);
  seen.z += nearer;
  gl_Position = projectionMatrix * seen;
}
`;

// Scale.colour of scale.js says the same.
const COLOUR = `${HEAD}
uniform vec3 ramp[9];
uniform vec3 above, below, within;
uniform float range, epsilon, slack;
uniform bool diverging, goNoGo;
vec3 colourOf(float d) {
  float limit = (goNoGo ? epsilon : range) + slack;
  if (d > limit) return above;
  if (d < -limit) return below;
  if (goNoGo) return within;
  float place = clamp(diverging ? d / range * 0.5 + 0.5 : d / range, 0.0, 1.0) * 8.0;
  int low = min(int(place), 7);
  return mix(ramp[low], ramp[low + 1], place - float(low));
}
`;

export const points_vertex = `${VERTEX}
in vec4 position;
uniform vec3 start, stride;
uniform float deviationStep, nearer, size;
out float deviation;
void main() {
  deviation = (position.w - 32768.0) * deviationStep;
  put(start + stride * position.xyz, nearer);
  gl_PointSize = size;
}`;

export const points_fragment = `${COLOUR}
in float deviation, outside;
out vec4 colour;
void main() {
  vec2 from = gl_PointCoord - 0.5;
  if (outside > 0.0 || dot(from, from) > 0.25) discard;
  colour = vec4(colourOf(deviation), 1.0);
}`;

// 1e30 stands for a triangle that is nearest to no point.
export const mesh_vertex = `${VERTEX}
in vec3 position;
in float deviation;
flat out float ofTriangle;
flat out int triangle;
out vec3 seenAt, corner;
void main() {
  ofTriangle = deviation;
  triangle = gl_VertexID / 3;
  int which = gl_VertexID % 3;
  corner = vec3(which == 0, which == 1, which == 2);
  put(position, 0.0);
  seenAt = (modelViewMatrix * vec4(position, 1.0)).xyz;
}`;

export const mesh_fragment = `${COLOUR}
flat in float ofTriangle;
flat in int triangle;
in vec3 seenAt, corner;
in float outside;
uniform bool faces, edges, coloured;
uniform vec3 plain, line;
uniform int marked;
uniform float lineWidth;
out vec4 colour;
void main() {
  if (outside > 0.0) discard;
  vec3 slope = fwidth(corner);
  vec3 away = corner / max(slope, vec3(1e-12));
  float nearest = min(min(away.x, away.y), away.z);
  bool isMarked = triangle == marked;
  float drawn = edges || isMarked ? 1.0 - smoothstep(lineWidth - 0.5, lineWidth + 0.5, isMarked ? nearest - 1.5 * lineWidth : nearest) : 0.0;
  // Where triangles are smaller than some pixels, lines would cover them.
  if (!isMarked) drawn *= 0.5 * (1.0 - smoothstep(0.08, 0.35, max(max(slope.x, slope.y), slope.z)));
  if (!faces) {
    if (drawn < 0.15) discard;
    colour = vec4(line, 1.0);
    return;
  }
  vec3 normal = normalize(cross(dFdx(seenAt), dFdy(seenAt)));
  float light = 0.5 + 0.5 * abs(dot(normal, normalize(vec3(0.25, 0.35, 1.0))));
  vec3 base = coloured && ofTriangle < 1e29 ? colourOf(ofTriangle) : plain;
  if (!gl_FrontFacing) base = mix(base, plain, 0.35) * 0.8;
  colour = vec4(mix(base * light, isMarked ? vec3(0.0) : line, drawn), 1.0);
}`;

// Crosses for points that were left out, a ring for the point that is looked at.
export const sign_vertex = `${VERTEX}
in vec3 position;
uniform float size, nearer;
void main() {
  put(position, nearer);
  gl_PointSize = size;
}`;

export const sign_fragment = `${HEAD}
in float outside;
uniform bool ring;
uniform vec3 plain;
out vec4 colour;
void main() {
  if (outside > 0.0 && !ring) discard;
  vec2 from = 2.0 * gl_PointCoord - 1.0;
  float dark = ring ? abs(length(from) - 0.8) : min(abs(from.x - from.y), abs(from.x + from.y)) * 0.7071;
  if (dark > 0.2) discard;
  colour = vec4(mix(plain, vec3(1.0), step(0.12, dark)), 1.0);
}`;
