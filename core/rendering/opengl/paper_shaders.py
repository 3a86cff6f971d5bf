"""Paper mode's shaders: one segment in one view, flattened; what is drawn is the stencil alone."""

from .shaders import CUTTING, NEAREST

_HEAD = "#version 330 core\n"
_MATRIX = """
layout(location = 0) in vec3 point;  // m, joint's space
uniform vec4 rows[3];                // homogeneous px from joint
vec3 homogeneous() {
    vec4 p = vec4(point, 1.0);
    return vec3(dot(rows[0], p), dot(rows[1], p), dot(rows[2], p));
}
"""
WHOLE_VERTEX = f"""{_HEAD}{_MATRIX}{NEAREST}
uniform vec2 shift;
void main() {{ gl_Position = placed(homogeneous(), shift); }}
"""
CUT_VERTEX = f"""{_HEAD}{_MATRIX}
out vec3 corner_px;
void main() {{ corner_px = homogeneous(); }}
"""
CUT_GEOMETRY = f"""{_HEAD}
layout(triangles) in;
layout(triangle_strip, max_vertices = 18) out;
in vec3 corner_px[];
uniform vec2 shift;
uniform vec4 region;
{NEAREST}{CUTTING}
void main() {{
    vec3 corners[8];
    for (int i = 0; i < 3; i++) corners[i] = corner_px[i];
    int count = cut(corners, 3, region);
    for (int i = 2; i < count; i++) {{
        for (int k = 0; k < 3; k++) {{
            gl_Position = placed(corners[k == 0 ? 0 : i - 2 + k], shift);
            EmitVertex();
        }}
        EndPrimitive();
    }}
}}
"""
FRAGMENT = f"{_HEAD}void main() {{}}\n"
