"""GPU mode's shaders: 32 candidates to a pixel, one in each bit; sums of weights by candidate."""

from .shaders import CUTTING, NEAREST

CANDIDATES = 32
"""In one pixel."""
LOW_BITS = 13
LANES, ROWS = 32, 64
"""Size in px of the pieces into which tiles are divided for the sums."""

_HEAD = "#version 430 core\n"
_ITEMS = f"""
layout(location = 0) in vec3 point;    // m, joint's space
layout(location = 1) in uint column;   // which of the segments
layout(std430, binding = 0) readonly buffer Rows {{ vec4 rows[]; }};
layout(std430, binding = 1) readonly buffer States {{ uint states[]; }};
layout(std430, binding = 2) readonly buffer Items {{ uint items[]; }};  // view * N + candidate
struct Tile {{ vec4 region; ivec4 area; vec4 shift; }};
layout(std430, binding = 3) readonly buffer Tiles {{ Tile tiles[]; }};
uniform int candidates, segments, blocks;  // blocks: in a row
uniform ivec2 block;  // px
uniform uint wanted;

struct Item {{ int view; int candidate; int state; }};
Item item_of(uint index) {{
    int view = int(index) / candidates, candidate = int(index) - view * candidates;
    return Item(view, candidate, int(index) * segments + int(column));
}}
vec3 homogeneous(Item item) {{
    int stride = candidates * segments;
    int at = item.view * 2 * stride + item.state;
    vec4 p = vec4(point, 1.0);
    return vec3(dot(rows[at], p), dot(rows[at + stride], p), dot(rows[at + 2 * stride], p));
}}
ivec2 corner_of(int candidate) {{
    int group = candidate / {CANDIDATES};
    return ivec2(group % blocks, group / blocks) * block;
}}
"""

WHOLE_VERTEX = f"""{_HEAD}{_ITEMS}{NEAREST}
flat out uint bit;
flat out ivec4 area;
void main() {{
    Item item = item_of(items[gl_InstanceID]);
    ivec2 corner = corner_of(item.candidate);
    bit = 1u << (item.candidate % {CANDIDATES});
    area = tiles[item.view].area + corner.xyxy;
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0);  // out of sight
    if (states[item.state] == wanted)
        gl_Position = placed(homogeneous(item), tiles[item.view].shift.xy + vec2(corner));
}}
"""

CUT_VERTEX = f"""{_HEAD}{_ITEMS}
out vec3 corner_px;
flat out ivec2 item_of_corner;  // view, candidate; -1 for none
void main() {{
    Item item = item_of(items[gl_InstanceID]);
    bool shown = states[item.state] == wanted;
    item_of_corner = shown ? ivec2(item.view, item.candidate) : ivec2(-1);
    corner_px = homogeneous(item);
}}
"""

CUT_GEOMETRY = f"""{_HEAD}
layout(triangles) in;
layout(triangle_strip, max_vertices = 18) out;
struct Tile {{ vec4 region; ivec4 area; vec4 shift; }};
layout(std430, binding = 3) readonly buffer Tiles {{ Tile tiles[]; }};
uniform int blocks;
uniform ivec2 block;
in vec3 corner_px[];
flat in ivec2 item_of_corner[];
flat out uint bit;
flat out ivec4 area;
{NEAREST}{CUTTING}
void main() {{
    ivec2 item = item_of_corner[0];
    if (item.x < 0) return;
    vec3 corners[8];
    for (int i = 0; i < 3; i++) corners[i] = corner_px[i];
    int count = cut(corners, 3, tiles[item.x].region);
    int group = item.y / {CANDIDATES};
    ivec2 corner = ivec2(group % blocks, group / blocks) * block;
    vec2 shift = tiles[item.x].shift.xy + vec2(corner);
    for (int i = 2; i < count; i++) {{
        for (int k = 0; k < 3; k++) {{
            bit = 1u << (item.y % {CANDIDATES});
            area = tiles[item.x].area + corner.xyxy;
            gl_Position = placed(corners[k == 0 ? 0 : i - 2 + k], shift);
            EmitVertex();
        }}
        EndPrimitive();
    }}
}}
"""

FRAGMENT = f"""{_HEAD}
flat in uint bit;
flat in ivec4 area;
layout(location = 0) out uint covered;
void main() {{
    ivec2 place = ivec2(gl_FragCoord.xy);
    if (any(lessThan(place, area.xy)) || any(greaterThanEqual(place, area.zw))) discard;
    covered = bit;  // or-ed to what is there
}}
"""

SUMS = f"""{_HEAD}
layout(local_size_x = {LANES}) in;
layout(binding = 0) uniform usampler2D covered;
layout(binding = 1) uniform isampler2D weights;
struct Piece {{ ivec4 area; ivec4 view; }};
layout(std430, binding = 4) readonly buffer Pieces {{ Piece pieces[]; }};
layout(std430, binding = 5) buffer Sums {{ int sums[]; }};  // [group][bit][view]: low bits, high
uniform int views, blocks;
uniform ivec2 block;
shared int parts[{LANES}][{CANDIDATES + 1}];
shared uint seen;
void main() {{
    Piece piece = pieces[gl_WorkGroupID.x];
    int group = int(gl_WorkGroupID.y), lane = int(gl_LocalInvocationID.x);
    ivec2 corner = ivec2(group % blocks, group / blocks) * block;
    int x = piece.area.x + lane;
    int sum[{CANDIDATES}];
    for (int k = 0; k < {CANDIDATES}; k++) sum[k] = 0;
    uint any_word = 0u;
    if (lane == 0) seen = 0u;
    barrier();
    if (x < piece.area.z)
        for (int y = piece.area.y; y < piece.area.w; y++) {{
            uint word = texelFetch(covered, corner + ivec2(x, y), 0).r;
            if (word == 0u) continue;
            any_word |= word;
            int weight = texelFetch(weights, ivec2(x, y), 0).r;
            for (int k = 0; k < {CANDIDATES}; k++)
                sum[k] += weight & (int(word << ({CANDIDATES - 1} - k)) >> 31);
        }}
    if (any_word != 0u) atomicOr(seen, any_word);
    barrier();
    if (seen == 0u) return;
    for (int k = 0; k < {CANDIDATES}; k++) parts[lane][k] = sum[k];
    barrier();
    int total = 0;
    for (int i = 0; i < {LANES}; i++) total += parts[i][lane];
    if (total != 0) {{
        int at = ((group * {CANDIDATES} + lane) * views + piece.view.x) * 2;
        atomicAdd(sums[at], total & ((1 << {LOW_BITS}) - 1));
        atomicAdd(sums[at + 1], total >> {LOW_BITS});
    }}
}}
"""
"""A piece has 2,048 px, so that the sum of its weights fits 27 bits. Both halves of it can be added
up over 2^17 pieces, the largest picture there is, without leaving 32 bits; the processor puts them
together in 64."""
