"""Hold the shaders, GLSL 3.30. Colours are lit in linear light and written as sRGB."""

from __future__ import annotations

from preview.occlusion import FROM_END, FROM_START, LIMBS, OWN, tabulate_occlusion

# A triangle that covers the picture.
COVER = """#version 330 core
out vec2 v_at;
void main() {
    v_at = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
    gl_Position = vec4(v_at * 2.0 - 1.0, 0.0, 1.0);
}
"""

# A rectangle of the picture, in pixels: left, low, right, high.
PART_VERTEX = """#version 330 core
uniform vec2 u_pixel;  // one by the picture's size
in vec4 in_part;
void main() {
    vec2 at = mix(in_part.xy, in_part.zw, vec2(gl_VertexID & 1, gl_VertexID >> 1)) * u_pixel;
    gl_Position = vec4(at * 2.0 - 1.0, 0.0, 1.0);
}
"""

_SKY = """
uniform vec2 u_pixel;  // one by the picture's size
uniform vec3 u_top, u_bottom;
vec3 sky() {
    vec2 at = gl_FragCoord.xy * u_pixel;
    vec2 off = (at - vec2(0.5, 0.42)) * vec2(0.9, 1.15);
    float t = clamp(1.0 - 1.9 * dot(off, off), 0.0, 1.0);  // light gathers behind the figure
    // Half a step of noise hides the bands eight bits would show.
    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    return mix(u_top, u_bottom, t) + (noise - 0.5) / 255.0;
}
"""

SKY = "#version 330 core\n" + _SKY + "out vec4 o_color;\nvoid main() { o_color = vec4(sky(), 1.0); }\n"

GROUND_VERTEX = """#version 330 core
uniform mat4 u_matrix;
uniform vec4 u_patch;  // x, z, half the width, half the depth
uniform vec2 u_turn;   // the direction of the width
out vec2 v_at;
void main() {
    vec2 corner = (vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0) * u_patch.zw;
    v_at = u_patch.xy + corner.x * u_turn + corner.y * vec2(-u_turn.y, u_turn.x);
    gl_Position = u_matrix * vec4(v_at.x, 0.0, v_at.y, 1.0);
}
"""

GROUND = (
    "#version 330 core\n"
    + _SKY
    + """
uniform vec3 u_floor, u_line;
uniform vec4 u_patch;
uniform vec2 u_spacing;  // metres between lines; strength of the lines
uniform float u_reach;   // metres after which the ground has become sky
in vec2 v_at;
out vec4 o_color;
void main() {
    vec3 back = sky();
    vec2 away = (v_at - u_patch.xy) / u_reach;
    float near = clamp(1.0 - dot(away, away), 0.0, 1.0);
    near *= near;
    vec2 p = v_at / u_spacing.x;
    vec2 w = max(fwidth(p), vec2(1e-5));
    vec2 d = abs(fract(p - 0.5) - 0.5) / w;
    // A line a pixel and a bit wide; where lines come closer than pixels they melt into their mean.
    vec2 l = clamp(1.35 - d, 0.0, 1.0) * clamp(0.55 / w - 0.6, 0.0, 1.0);
    vec2 axis = 1.0 + 0.7 * clamp(1.5 - abs(p) / w, 0.0, 1.0);
    float ink = max(l.x * axis.x, l.y * axis.y) * u_spacing.y * near;
    vec3 color = mix(back, mix(back, u_floor, 0.85), near);
    o_color = vec4(mix(color, u_line, ink), 1.0);
}
"""
)

_SHADOW = """
uniform sampler2DShadow u_shadow;
uniform mat4 u_light;
uniform vec2 u_spread;  // of the map
uniform float u_off;  // metres, before the surface
float tap(vec3 p) { return textureLod(u_shadow, p, 0.0); }
// Two taps, each the mean of four texels: enough for an edge a few pixels wide.
float lit(vec3 world, float bias) {
    vec4 p = u_light * vec4(world, 1.0);
    p.z -= bias;
    return 0.5 * (tap(p.xyz + vec3(u_spread, 0.0)) + tap(p.xyz - vec3(u_spread, 0.0)));
}
"""

# The shadow on the ground, seen from above: a small picture that is drawn enlarged. The farther a caster is
# from the ground, the softer is its shadow, because the lamp is not a point.
SOFT = """#version 330 core
uniform sampler2D u_depth;  // as the lamp sees it
uniform mat4 u_light;
uniform vec4 u_patch;   // x, z, half the width, half the depth
uniform vec2 u_turn;
uniform vec3 u_fade;    // x, z and radius of what the shadow fades towards
uniform float u_scale;  // of the shadow map, by metres
in vec2 v_at;
out vec4 o_color;
// Points spread evenly over a disc (Vogel's spiral), near the middle first.
vec2 spread(int i, float count) {
    float turn = float(i) * 2.39996323;
    return sqrt((float(i) + 0.5) / count) * vec2(cos(turn), sin(turn));
}
// How far before the ground the lamp's light ends; less than 0 where it does not.
float before(vec3 p, vec2 off) {
    ivec2 size = textureSize(u_depth, 0);
    float depth = texelFetch(u_depth, clamp(ivec2((p.xy + off) * vec2(size)), ivec2(0), size - 1), 0).r;
    return p.z - depth - 9.0 * step(1.0, depth);
}
void main() {
    vec2 corner = (v_at * 2.0 - 1.0) * u_patch.zw;
    vec2 at = u_patch.xy + corner.x * u_turn + corner.y * vec2(-u_turn.y, u_turn.x);
    vec3 p = (u_light * vec4(at.x, 0.0, at.y, 1.0)).xyz;
    p.z -= 0.002;
    float found = 0.0, gap = 0.0;
    for (int i = 0; i < 8; ++i) {
        float d = before(p, spread(i, 8.0) * (0.045 * u_scale));
        found += step(0.0, d);
        gap += max(d, 0.0);
    }
    float dark = 0.0;
    if (found > 0.0) {
        float radius = clamp(0.034 * gap / (found * u_scale), 0.008, 0.055) * u_scale;
        for (int i = 0; i < 12; ++i)
            dark += step(0.0, before(p, spread(i, 12.0) * radius));
    }
    vec2 off = (at - u_fade.xy) / u_fade.z;
    float near = clamp(1.15 - dot(off, off), 0.0, 1.0);
    o_color = vec4(dark / 12.0 * near * 0.75);
}
"""

# A square under the figure that multiplies what has been drawn.
CAST = """#version 330 core
uniform sampler2D u_soft;
uniform vec3 u_dark;
uniform vec4 u_patch;
uniform vec2 u_turn;
in vec2 v_at;
out vec4 o_color;
void main() {
    vec2 off = v_at - u_patch.xy;
    vec2 at = vec2(dot(off, u_turn), dot(off, vec2(-u_turn.y, u_turn.x))) / u_patch.zw * 0.5 + 0.5;
    o_color = vec4(mix(vec3(1.0), u_dark, textureLod(u_soft, at, 0.0).r), 1.0);
}
"""

# Soft spots where the body is near the ground: one square each.
SPOT_VERTEX = """#version 330 core
uniform mat4 u_matrix;
uniform float u_most;  // that a spot of strength 1 takes
in vec4 in_spot;  // x, z, radius, strength
out vec2 v_at;
out float v_strength;
void main() {
    v_strength = in_spot.w;
    // Farther out a spot takes less than a step of 512 from the ground.
    float seen = sqrt(1.0 - min(1.0, sqrt(1.0 / (512.0 * u_most * v_strength))));
    v_at = (vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0) * seen;
    gl_Position = u_matrix * vec4(in_spot.x + v_at.x * in_spot.z, 0.0, in_spot.y + v_at.y * in_spot.z, 1.0);
}
"""
SPOT = """#version 330 core
uniform vec3 u_dark;
in vec2 v_at;
in float v_strength;
out vec4 o_color;
void main() {
    float t = clamp(1.0 - dot(v_at, v_at), 0.0, 1.0);
    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy + v_strength * 97.0, vec2(0.06711056, 0.00583715))));
    vec3 less = (vec3(1.0) - u_dark) * (t * t * v_strength);
    o_color = vec4(1.0 - less - (noise - 0.5) * min(vec3(1.0 / 255.0), less), 1.0);
}
"""

_SKIN = """
uniform sampler2D u_palette;  // three texels a matrix, one row an instance
uniform int u_row;
in vec3 in_position;
in uvec4 in_bones;
in vec4 in_weights;
mat4x3 skin() {
    int row = u_row + gl_InstanceID;
    ivec4 at = ivec4(in_bones) * 3;
    vec4 x = texelFetch(u_palette, ivec2(at.x, row), 0) * in_weights.x;
    vec4 y = texelFetch(u_palette, ivec2(at.x + 1, row), 0) * in_weights.x;
    vec4 z = texelFetch(u_palette, ivec2(at.x + 2, row), 0) * in_weights.x;
    for (int i = 1; i < 4; ++i) {
        int a = at[i];
        float w = in_weights[i];
        x += texelFetch(u_palette, ivec2(a, row), 0) * w;
        y += texelFetch(u_palette, ivec2(a + 1, row), 0) * w;
        z += texelFetch(u_palette, ivec2(a + 2, row), 0) * w;
    }
    return transpose(mat3x4(x, y, z));
}
"""

DEPTH_VERTEX = (
    "#version 330 core\n"
    + _SKIN
    + """
uniform mat4 u_matrix;
void main() { gl_Position = u_matrix * vec4(skin() * vec4(in_position, 1.0), 1.0); }
"""
)
DEPTH = "#version 330 core\nvoid main() {}\n"

_OCCLUSION = f"""
#ifdef OCCLUDED
const int RODS = {len(LIMBS)};
const int WAYS[RODS * RODS] = int[RODS * RODS]({", ".join(str(way) for way in tabulate_occlusion().ravel())});
uniform vec4 u_rod_starts[RODS], u_rod_ends[RODS];  // with the radius; with 1 where there is such a limb
in uint in_limb;
out float v_open;
// How much of the light round about comes here past the other limbs.
float open_to(vec3 at, vec3 n) {{
    float left = 1.0;
    for (int c = 0; c < RODS; ++c) {{
        int way = in_limb < uint(RODS) ? WAYS[int(in_limb) * RODS + c] : {OWN};
        vec3 start = u_rod_starts[c].xyz, along = u_rod_ends[c].xyz - start;
        float t = clamp(dot(at - start, along) / max(dot(along, along), 1e-9), 0.0, 1.0);
        vec3 to = start + along * t - at;
        float d = max(length(to), 1e-4), r = u_rod_starts[c].w;
        float part = min(r * r / (d * d), 1.0) * clamp(dot(n, to) / d * 0.8 + 0.2, 0.0, 1.0);
        part *= smoothstep(0.75, 1.1, d / max(r, 1e-4));  // within a rod nothing is told
        float joined = way == {FROM_START} ? t : way == {FROM_END} ? 1.0 - t : 1.0;
        part *= smoothstep(0.1, 0.6, joined);
        left *= way == {OWN} ? 1.0 : 1.0 - 0.85 * part * u_rod_ends[c].w;
    }}
    return left;
}}
#endif
"""

BODY_VERTEX = (
    _SKIN
    + _OCCLUSION
    + """
uniform mat4 u_matrix;
in vec3 in_normal;
in vec2 in_uv;
in vec4 in_color;
out vec3 v_world, v_normal;
out vec2 v_uv;
out vec4 v_color;
#ifdef GRAINED
in vec2 in_grain;
out vec2 v_grain;
#endif
#ifdef MARKED
uniform sampler2D u_marks;  // one texel a matrix: colour, amount
uniform int u_marks_row;
out vec4 v_mark;
#endif
void main() {
    mat4x3 m = skin();
    v_world = m * vec4(in_position, 1.0);
    v_normal = mat3(m) * in_normal;
    v_uv = in_uv;
#ifdef GRAINED
    v_grain = in_grain;
#endif
    v_color = vec4(pow(in_color.rgb, vec3(1.1)), in_color.a);  // the root of linear light: so colours fade evenly
#ifdef MARKED
    v_mark = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        vec4 mark = texelFetch(u_marks, ivec2(int(in_bones[i]), u_marks_row), 0) * in_weights[i];
        v_mark += vec4(mark.rgb * texelFetch(u_marks, ivec2(int(in_bones[i]), u_marks_row), 0).a, mark.a);
    }
#endif
#ifdef OCCLUDED
    v_open = open_to(v_world, normalize(v_normal));
#endif
    gl_Position = u_matrix * vec4(v_world, 1.0);
}
"""
)

BODY = (
    _SHADOW
    + """
uniform vec3 u_eye, u_to_light, u_key, u_above, u_below, u_rim;
uniform float u_shade, u_opacity;  // how much of the cast shadow to use
uniform vec2 u_near_ground;  // how much of the light round about the ground takes, and 1 by up to where
#ifdef TEXTURED
uniform sampler2D u_image;
#endif
in vec3 v_world, v_normal;
in vec2 v_uv;
in vec4 v_color;
#ifdef GRAINED
uniform sampler2D u_grain;
in vec2 v_grain;
// The normal that a normal map bends n to, and how deep in the grain the place is: 1 on top. The directions of
// the map come from how its coordinates change on the screen.
const float BLUR = 1.3;  // mipmaps beyond the nearest, or rows of stitches make rings where they are a few pixels wide
vec4 grained(vec3 n) {
    vec3 map = texture(u_grain, v_grain, BLUR).xyz * 2.0 - 1.0;
    vec3 right = cross(dFdy(v_world), n), up = cross(n, dFdx(v_world));
    vec2 x = dFdx(v_grain), y = dFdy(v_grain);
    vec3 along = right * x.x + up * y.x, across = right * x.y + up * y.y;
    float size = inversesqrt(max(max(dot(along, along), dot(across, across)), 1e-20));
    return vec4(normalize((along * map.x - across * map.y) * size + n * max(map.z, 0.05)), map.z);
}
#endif
#ifdef MARKED
in vec4 v_mark;
#endif
#ifdef OCCLUDED
in float v_open;
#endif
out vec4 o_color;
void main() {
#ifdef SUNK
    if (v_world.y < -0.004) discard;  // the ground hides what is below it
#endif
    vec3 n = normalize(v_normal) * (gl_FrontFacing ? 1.0 : -1.0);
    vec3 v = normalize(u_eye - v_world);
    vec3 base = v_color.rgb * v_color.rgb;
#ifdef TEXTURED
    vec3 texel = texture(u_image, v_uv).rgb;
    base *= texel * texel * (0.7 * texel + 0.3);  // close to the power of 2.2, without it
#endif
#ifdef MARKED
    float amount = clamp(v_mark.a, 0.0, 1.0);
    base = mix(base, v_mark.rgb * v_mark.rgb / max(v_mark.a, 1e-3), amount);
#endif
#ifdef GRAINED
    vec4 bent = grained(n);
    n = bent.xyz;
    base *= 0.5 + 0.5 * bent.w * bent.w;  // little light comes into the grain
#endif
    float facing = dot(n, u_to_light);
    float away = 1.0 - clamp(dot(n, v), 0.0, 1.0);
    float light = clamp(facing * 0.86 + 0.14, 0.0, 1.0);  // the terminator is soft, as on skin
    // Under skin light goes on a little beyond the terminator, red the farthest: an odd shininess is skin's.
    float skin = step(0.5, fract(v_color.a * 127.5 + 0.25));
    vec3 spread = skin * vec3(0.150, 0.035, 0.010) * max(0.0, 1.0 - abs(facing + 0.05) * 1.9);
#ifdef SHADOWED
    // Where the surface turns away it is dark by itself: there the map's texels would show as teeth.
    float seen = mix(1.0, lit(v_world + n * u_off, 0.0025), u_shade * smoothstep(0.0, 0.3, facing));
    light *= seen;
    spread *= seen;
#endif
    float up = n.y * 0.5 + 0.5;
    vec3 fill = mix(u_below, u_above, up) * (1.0 - 0.25 * away);
    float under = max(0.0, 1.0 - v_world.y * u_near_ground.y);  // soles and hems are darker, above all beneath
    fill *= 1.0 - u_near_ground.x * under * under * (0.65 - 0.35 * n.y);
#ifdef OCCLUDED
    fill *= v_open;
    light *= 0.6 + 0.4 * v_open;  // the lamp is large: its edges are hidden, too
#endif
    fill += u_above * (0.22 * clamp(dot(n, v), 0.0, 1.0));  // a weak lamp beside the camera
    float edge = away * away;
    float rim = edge * edge * (0.35 + 0.65 * up);
    vec3 h = normalize(u_to_light + v);
    float shine = v_color.a;
    float nh = clamp(dot(n, h), 0.0, 1.0);
    float gloss = pow(nh, 8.0 + 240.0 * shine * shine) * (0.03 + 0.9 * shine * shine) * light;
    vec3 color = base * (u_key * (light + spread) + fill) + u_rim * rim * (0.14 + base) + u_key * gloss;
    color = color / (1.0 + 0.18 * max(color.r, max(color.g, color.b)));  // roll highlights off
    vec3 root = sqrt(color);  // to sRGB: within a step of 255 of the power 1 / 2.2, and cheaper
    o_color = vec4(0.94823 * root + 0.09858 * sqrt(root) - 0.04681 * color, 1.0) * u_opacity;
}
"""
)

# Lines of constant width in pixels with a dark rim, for the skeleton over the mesh.
LINE_VERTEX = """#version 330 core
uniform mat4 u_matrix;
uniform vec2 u_size;
uniform float u_width;
in vec3 in_start, in_end;
out vec2 v_pixel;
flat out vec2 v_from, v_to;
void main() {
    vec4 a = u_matrix * vec4(in_start, 1.0), b = u_matrix * vec4(in_end, 1.0);
    a.xy /= max(a.w, 1e-3); b.xy /= max(b.w, 1e-3);
    vec2 p = (a.xy * 0.5 + 0.5) * u_size, q = (b.xy * 0.5 + 0.5) * u_size;
    vec2 along = q - p;
    float len = length(along);
    along = len > 1e-3 ? along / len : vec2(1.0, 0.0);
    vec2 side = vec2(-along.y, along.x);
    float pad = u_width + 1.5;
    bool last = (gl_VertexID & 1) == 1;
    vec2 at = (last ? q + along * pad : p - along * pad) + side * ((gl_VertexID >> 1) == 1 ? pad : -pad);
    v_pixel = at; v_from = p; v_to = q;
    float hidden = min(a.w, b.w) > 1e-3 ? 0.0 : 2.0;
    gl_Position = vec4(at / u_size * 2.0 - 1.0, hidden, 1.0);
}
"""
LINE = """#version 330 core
uniform vec3 u_ink;
uniform float u_width;
in vec2 v_pixel;
flat in vec2 v_from, v_to;
out vec4 o_color;
void main() {
    vec2 along = v_to - v_from, off = v_pixel - v_from;
    float t = clamp(dot(off, along) / max(dot(along, along), 1e-6), 0.0, 1.0);
    float d = length(off - along * t);
    float line = clamp(u_width * 0.5 + 0.5 - d, 0.0, 1.0);
    float rim = clamp(u_width * 0.5 + 1.5 - d, 0.0, 1.0) * 0.45;
    float alpha = max(line, rim);
    o_color = vec4(u_ink * line, 1.0) * alpha;
}
"""

COPY = """#version 330 core
uniform sampler2D u_picture;
out vec4 o_color;
void main() { o_color = texelFetch(u_picture, ivec2(gl_FragCoord.xy), 0); }
"""

# A picture in the middle. `u_part` is the share of the width and of the height that it covers.
BEHIND = """#version 330 core
uniform sampler2D u_picture;
uniform vec2 u_part;
in vec2 v_at;
out vec4 o_color;
void main() {
    vec2 at = (v_at - 0.5) / u_part + 0.5;
    if (any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)))) discard;
    o_color = vec4(textureLod(u_picture, vec2(at.x, 1.0 - at.y), 0.0).rgb, 1.0);
}
"""

# A studio or a room, by a ray for each pixel: the place where it leaves the box. Of a wall that is nearer than
# the box nothing is seen. Lengths are metres.
WALLS = (
    "#version 330 core\n"
    + _SKY
    + """
uniform vec3 u_eye, u_right, u_ahead, u_above_eye;  // the second to fourth: to the picture's side, middle, top
uniform vec3 u_low, u_high, u_floor, u_wall, u_tint, u_to_light;
uniform float u_bend, u_furnished;
in vec2 v_at;
out vec4 o_color;
const float BOARD = 0.14, PLINTH = 0.09, SHEET = 0.35;
// How far a place is outside the box with round edges, less than 0 inside.
float outside(vec3 p) {
    vec3 q = abs(p - (u_low + u_high) * 0.5) - (u_high - u_low) * 0.5 + u_bend;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0) - u_bend;
}
// 1 inside a rectangle, with an edge of a pixel, which is w wide.
float inside(vec2 p, vec2 w, vec2 low, vec2 high) {
    vec2 a = clamp((p - low) / w + 0.5, 0.0, 1.0) * clamp((high - p) / w + 0.5, 0.0, 1.0);
    return a.x * a.y;
}
float grain(vec2 p) { return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453); }
void main() {
    vec3 way = normalize(u_ahead + (v_at.x * 2.0 - 1.0) * u_right + (v_at.y * 2.0 - 1.0) * u_above_eye);
    vec3 safe = way + vec3(equal(way, vec3(0.0))) * 1e-6;
    vec3 to_low = (u_low - u_eye) / safe, to_high = (u_high - u_eye) / safe;
    vec3 first = min(to_low, to_high), last = max(to_low, to_high);
    float near = max(max(first.x, first.y), first.z), far = min(min(last.x, last.y), last.z);
    vec3 p = u_eye + way * far;
    vec3 middle = (u_low + u_high) * 0.5;
    vec3 n = -sign(p - middle);
    if (u_bend > 0.001) {
        for (int i = 0; i < 6; ++i) p -= way * max(outside(p), 0.0);  // back to the round edge
        n *= normalize(max(abs(p - middle) - (u_high - u_low) * 0.5 + u_bend, 1e-4));
    } else {
        n *= last.x <= far ? vec3(1.0, 0.0, 0.0) : last.y <= far ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
    }
    float floored = smoothstep(0.4, 0.95, n.y);
    vec3 color = mix(u_wall, u_floor, floored);
    float light = 0.80 + 0.14 * max(dot(n, u_to_light), 0.0) + 0.06 * n.y;
    if (u_furnished > 0.5) {
        vec2 ground = vec2(p.x, p.z) / vec2(BOARD, 1.9);
        vec2 w = max(fwidth(ground), vec2(1e-5));
        ground.y += 0.37 * floor(ground.x);
        vec2 seam = clamp(1.2 - min(fract(ground), 1.0 - fract(ground)) / w, 0.0, 1.0);
        float seams = max(seam.x * clamp(0.3 / w.x - 0.5, 0.0, 1.0), seam.y * clamp(0.3 / w.y - 0.5, 0.0, 1.0));
        float glass = 0.0, frame = 0.0;  // of a window in the wall on the left
        vec2 pane = vec2(p.z - middle.z, p.y), thin = max(fwidth(pane), vec2(1e-5));
        if (n.y > 0.5) {
            color *= 0.90 + 0.20 * grain(floor(ground)) * clamp(0.5 / w.x, 0.0, 1.0);
            color *= 1.0 - 0.35 * seams;
        } else if (n.y < -0.5) {
            color = vec3(0.93, 0.92, 0.90);
        } else {
            float top = u_low.y + PLINTH, wide = thin.y;
            color = mix(color, vec3(0.93, 0.92, 0.90), clamp((top - p.y) / wide + 0.5, 0.0, 1.0));
            color *= 1.0 - 0.25 * clamp(1.2 - abs(p.y - top) / wide, 0.0, 1.0);
            if (n.x > 0.5) {
                frame = inside(pane, thin, vec2(-0.95, 0.85), vec2(0.95, 2.25));
                for (int i = 0; i < 4; ++i) {
                    vec2 low = vec2((i & 1) == 0 ? -0.88 : 0.03, i < 2 ? 0.92 : 1.78);
                    glass += inside(pane, thin, low, low + vec2(0.85, i < 2 ? 0.80 : 0.40));
                }
                color = mix(color, vec3(0.95, 0.94, 0.92), frame);
            }
            light *= n.x > 0.5 ? 0.90 : n.x < -0.5 ? 1.04 : 1.0;
        }
        // Corners are darker.
        vec3 gap = min(p - u_low, u_high - p);
        vec3 dark = exp(-max(gap, 0.0) / SHEET) * (1.0 - abs(n));
        light *= (1.0 - 0.22 * dark.x) * (1.0 - 0.22 * dark.y) * (1.0 - 0.22 * dark.z);
        if (n.y > 0.5) {  // what comes in through the window
            vec2 spot = (vec2(p.x - u_low.x, p.z - middle.z) - vec2(1.7, -0.2)) / vec2(1.5, 1.3);
            light += 0.22 * exp(-2.0 * dot(spot, spot));
        }
        color = mix(color * light, vec3(0.86, 0.93, 1.0) * (0.92 + 0.1 * pane.y / 2.2), clamp(glass, 0.0, 1.0));
    } else {
        vec2 off = vec2(p.x, p.z) - middle.xz;
        light *= 1.0 - 0.16 * smoothstep(1.0, 4.5, length(vec3(off.x, 0.7 * p.y, off.y)));
        color *= light * 1.06;
    }
    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    color = clamp(color * u_tint, 0.0, 1.0) + (noise - 0.5) / 255.0;
    o_color = vec4(far > max(near, 0.0) ? color : sky(), 1.0);
}
"""
)

# Smooths edges found by contrast: mixes a pixel with its neighbours along the edge. Reading farther pixels
# shows no improvement, and in software reading between pixels takes four times as long as reading one.
SMOOTH = """#version 330 core
uniform sampler2D u_picture;
out vec4 o_color;
float luma(vec4 c) { return dot(c, vec4(0.30, 0.59, 0.11, 0.30)); }
vec4 near(int x, int y) { return texelFetch(u_picture, ivec2(gl_FragCoord.xy) + ivec2(x, y), 0); }
void main() {
    vec4 here = near(0, 0), left = near(-1, 0), right = near(1, 0), low = near(0, -1), high = near(0, 1);
    float m = luma(here), a = luma(left), b = luma(right), c = luma(low), d = luma(high);
    float least = min(m, min(min(a, b), min(c, d))), most = max(m, max(max(a, b), max(c, d)));
    vec2 along = abs(vec2(d - c, b - a));
    along /= min(along.x, along.y) + max((a + b + c + d) * 0.015, 0.004);
    along = min(along * 0.4, 1.0);
    along *= 0.5 / max(1.0, along.x + along.y);
    vec4 mean = here + along.x * (left + right - 2.0 * here) + along.y * (low + high - 2.0 * here);
    o_color = most - least < 0.03 ? here : mean;
}
"""

# How much a place of the picture is blurred: 0 in focus, 1 for what is blurred most.
_FOCUS = """#version 330 core
uniform sampler2D u_color, u_depth;
uniform vec3 u_eye, u_right, u_ahead, u_above_eye, u_low, u_high;
uniform vec2 u_ends, u_focus;  // near and far of the depths; what is in focus, and what is sharp round it
in vec2 v_at;
out vec4 o_color;
float blurred(float depth) {
    float far;
    if (depth < 1.0) {
        far = u_ends.x * u_ends.y / (u_ends.y - depth * (u_ends.y - u_ends.x));
    } else {
        vec3 way = u_ahead + (v_at.x * 2.0 - 1.0) * u_right + (v_at.y * 2.0 - 1.0) * u_above_eye;
        vec3 safe = way + vec3(equal(way, vec3(0.0))) * 1e-6;
        vec3 last = max((u_low - u_eye) / safe, (u_high - u_eye) / safe);
        far = max(min(min(last.x, last.y), last.z), 1e-3);
    }
    return clamp(max(abs(far - u_focus.x) - u_focus.y, 0.0) / far, 0.0, 1.0);
}
"""
# What is in focus counts less, so that it does not spread over what is behind it.
FOCUS_PART = (
    _FOCUS
    + """
void main() {
    ivec2 most = textureSize(u_depth, 0) - 1;
    o_color = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 at = min(ivec2(gl_FragCoord.xy) * 2 + ivec2(i & 1, i >> 1), most);
        float k = max(blurred(texelFetch(u_depth, at, 0).r), 0.002);
        o_color += vec4(texelFetch(u_color, at, 0).rgb * k, k) * 0.25;
    }
}
"""
)
FOCUS_BLUR = """#version 330 core
uniform sampler2D u_color;
uniform vec2 u_way;
in vec2 v_at;
out vec4 o_color;
void main() {
    vec4 sum = vec4(0.0);
    for (int i = -6; i <= 6; ++i) {
        float x = float(i) / 6.0;
        sum += exp(-2.5 * x * x) * texture(u_color, v_at + x * u_way);
    }
    o_color = sum / 6.2;
}
"""
FOCUS = (
    _FOCUS
    + """
uniform sampler2D u_blurred;
uniform float u_pixels;
void main() {
    vec4 sharp = texture(u_color, v_at), soft = texture(u_blurred, v_at);
    float k = blurred(texture(u_depth, v_at).r);
    float share = smoothstep(0.0, 1.0, min(1.0, k * u_pixels / 3.0));
    o_color = vec4(mix(sharp.rgb, soft.rgb / max(soft.a, 1e-5), share), sharp.a);
}
"""
)
