"""Contexts without a window by CGL, on macOS; its OpenGL ends at 4.1."""

import ctypes
from collections.abc import Sequence
from ctypes import byref, c_int, c_int32, c_void_p

from .context import no_opengl

_PROFILE, _CORE_4, _CORE_3 = 99, 0x4100, 0x3200
_FRAMEWORK = "/System/Library/Frameworks/OpenGL.framework/OpenGL"


class CglContext:
    """A context without a drawable.

    Args:
        library: the OpenGL framework.
        handle: a ``CGLContextObj``.
    """

    def __init__(self, library: ctypes.CDLL, handle: int):
        self._cgl, self._handle = library, handle

    def make_current(self) -> None:
        """Makes it the calling thread's."""
        if self._cgl.CGLSetCurrentContext(self._handle):
            raise no_opengl("CGL: it cannot be made current")

    def release(self) -> None:
        """Destroys it."""
        self._cgl.CGLSetCurrentContext(None)
        self._cgl.CGLDestroyContext(self._handle)


def make(versions: Sequence[tuple[int, int]]) -> CglContext:
    """A context of the newest core profile not above ``versions``.

    Raises:
        MocapError: there is none.
        OSError: there is no OpenGL.
    """
    cgl = ctypes.CDLL(_FRAMEWORK)
    for name, arguments in (
        ("CGLChoosePixelFormat", (c_void_p, c_void_p, c_void_p)),
        ("CGLCreateContext", (c_void_p, c_void_p, c_void_p)),
        ("CGLDestroyPixelFormat", (c_void_p,)),
        ("CGLDestroyContext", (c_void_p,)),
        ("CGLSetCurrentContext", (c_void_p,)),
    ):
        function = getattr(cgl, name)
        function.restype, function.argtypes = c_int, arguments
    profiles = [_CORE_4] if max(versions) >= (4, 1) else []
    for profile in (*profiles, _CORE_3):
        form, handle, count = c_void_p(), c_void_p(), c_int32()
        wanted = (c_int32 * 3)(_PROFILE, profile, 0)
        if cgl.CGLChoosePixelFormat(wanted, byref(form), byref(count)) or not form.value:
            continue
        refused = cgl.CGLCreateContext(form, None, byref(handle))
        cgl.CGLDestroyPixelFormat(form)
        if not refused and handle.value:
            return CglContext(cgl, handle.value)
    raise no_opengl("CGL gives no context")
