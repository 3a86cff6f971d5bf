"""The shaders of both modes, and how they are compiled.

Vertices are flattened: they have no depth, and lie on a grid of 1/256 px before OpenGL sees them.
As the range of OpenGL's coordinates is a power of two of px wide, its own arithmetic is exact from
there on, and a silhouette does not depend on where in a large picture it is drawn.
"""

from typing import Any

from .context import no_opengl

NEAREST = """
uniform float half_side;  // px, half the side of the viewport
vec4 placed(vec3 h, vec2 shift) {
    return vec4((roundEven(h.xy / h.z * 256.0) / 256.0 + shift) / half_side, 0.0, 1.0);
}
"""
"""``placed``: clip space of homogeneous px; ``shift`` leads to px from the viewport's centre."""

CUTTING = """
uniform float near;  // m
// signed distance of homogeneous px to the near plane and the sides of the region (px)
float inside(vec3 h, int plane, vec4 region) {
    if (plane == 0) return h.z - near;
    if (plane == 1) return h.x - region.x * h.z;
    if (plane == 2) return h.y - region.y * h.z;
    if (plane == 3) return region.z * h.z - h.x;
    return region.w * h.z - h.y;
}
// cuts the polygon of `count` corners to the region (Sutherland and Hodgman); what is left of it
int cut(inout vec3 corners[8], int count, vec4 region) {
    for (int plane = 0; plane < 5; plane++) {
        vec3 kept[8];
        int left = 0;
        for (int i = 0; i < count; i++) {
            vec3 a = corners[i], b = corners[i + 1 == count ? 0 : i + 1];
            float da = inside(a, plane, region), db = inside(b, plane, region);
            if (da >= 0.0 && left < 8) kept[left++] = a;
            if ((da >= 0.0) != (db >= 0.0) && left < 8)
                // from the inner point outwards, so that neighbours agree on it
                kept[left++] = da >= 0.0 ? a + da / (da - db) * (b - a)
                                         : b + db / (db - da) * (a - b);
        }
        count = left;
        corners = kept;
    }
    return count;
}
"""


def program(gl: Any, **stages: str) -> int:
    """The linked program of its ``vertex``, ``geometry``, ``fragment`` and ``compute`` shaders.

    Raises:
        MocapError: the driver refuses one.
    """
    result = gl.glCreateProgram()
    for stage, source in stages.items():
        shader = gl.glCreateShader(getattr(gl, f"GL_{stage.upper()}_SHADER"))
        gl.glShaderSource(shader, source)
        gl.glCompileShader(shader)
        if not gl.glGetShaderiv(shader, gl.GL_COMPILE_STATUS):
            raise no_opengl(f"{stage} shader: {_told(gl.glGetShaderInfoLog(shader))}")
        gl.glAttachShader(result, shader)
        gl.glDeleteShader(shader)
    gl.glLinkProgram(result)
    if not gl.glGetProgramiv(result, gl.GL_LINK_STATUS):
        raise no_opengl(f"shaders: {_told(gl.glGetProgramInfoLog(result))}")
    return result


def _told(log: bytes | str) -> str:
    text = log.decode(errors="replace") if isinstance(log, bytes) else log
    return " ".join(text.split())


def uniforms(gl: Any, program: int, *names: str) -> dict[str, int]:
    """Locations of the program's uniforms."""
    return {name: gl.glGetUniformLocation(program, name) for name in names}
