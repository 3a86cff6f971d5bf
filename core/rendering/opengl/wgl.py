"""Contexts behind a hidden window by WGL, on Windows."""

import ctypes
from collections.abc import Sequence
from ctypes import byref, c_char_p, c_int, c_int32, c_void_p, c_wchar_p
from typing import Any

from .context import no_opengl

_MAJOR, _MINOR, _PROFILE, _CORE = 0x2091, 0x2092, 0x9126, 1
_DRAW_TO_WINDOW, _SUPPORT_OPENGL = 0x4, 0x20


class _PixelFormat(ctypes.Structure):
    """``PIXELFORMATDESCRIPTOR``."""

    _fields_ = (
        *((name, ctypes.c_uint16) for name in ("size", "version")),
        ("flags", ctypes.c_uint32),
        *((f"bits_{i}", ctypes.c_uint8) for i in range(20)),
        *((f"mask_{i}", ctypes.c_uint32) for i in range(3)),
    )


class WglContext:
    """A context of a window that is never shown; both belong to the thread that made them.

    Args:
        libraries: user32, gdi32 and opengl32.
        window: an ``HWND``.
        device: the window's ``HDC``.
        handle: an ``HGLRC``.
    """

    def __init__(self, libraries: dict[str, Any], window: int, device: int, handle: int):
        self._libraries, self._window = libraries, window
        self._device, self._handle = device, handle

    def make_current(self) -> None:
        """Makes it the calling thread's."""
        if not self._libraries["opengl32"].wglMakeCurrent(self._device, self._handle):
            raise no_opengl("WGL: it cannot be made current")

    def release(self) -> None:
        """Destroys it and its window."""
        user, gl = self._libraries["user32"], self._libraries["opengl32"]
        gl.wglMakeCurrent(None, None)
        gl.wglDeleteContext(self._handle)
        user.ReleaseDC(self._window, self._device)
        user.DestroyWindow(self._window)


def make(versions: Sequence[tuple[int, int]]) -> WglContext:
    """A context of the first version that the driver gives.

    Raises:
        MocapError: it gives none.
        OSError: there is no OpenGL.
    """
    libraries = _libraries()
    user, gl = libraries["user32"], libraries["opengl32"]
    # a class that Windows has itself; hidden unless it is told to show
    window = user.CreateWindowExW(0, "STATIC", "", 0, 0, 0, 1, 1, None, None, None, None)
    device = window and user.GetDC(window)
    if not device or not _has_pixel_format(libraries["gdi32"], device):
        raise no_opengl("WGL: no window with OpenGL")
    plain = gl.wglCreateContext(device)
    if not plain or not gl.wglMakeCurrent(device, plain):
        raise no_opengl("WGL: no context")
    # further functions are known only where a context is current
    address = gl.wglGetProcAddress(b"wglCreateContextAttribsARB")
    handle = address and _newest(address, device, versions)
    gl.wglMakeCurrent(None, None)
    gl.wglDeleteContext(plain)
    if not handle:
        raise no_opengl("WGL: no context of a core profile")
    return WglContext(libraries, window, device, handle)


def _newest(address: int, device: int, versions: Sequence[tuple[int, int]]) -> int | None:
    kind = ctypes.CFUNCTYPE(c_void_p, c_void_p, c_void_p, c_void_p)
    create = kind(address)
    for major, minor in versions:
        attributes = (c_int32 * 7)(_MAJOR, major, _MINOR, minor, _PROFILE, _CORE, 0)
        handle = create(device, None, attributes)
        if handle:
            return handle
    return None


def _has_pixel_format(gdi: Any, device: int) -> bool:
    wanted = _PixelFormat(ctypes.sizeof(_PixelFormat), 1, _DRAW_TO_WINDOW | _SUPPORT_OPENGL)
    wanted.bits_1 = 24  # colour bits; bits_0 asks for RGBA
    number = gdi.ChoosePixelFormat(device, byref(wanted))
    return bool(number and gdi.SetPixelFormat(device, number, byref(wanted)))


def _libraries() -> dict[str, Any]:
    signatures = {
        "user32": (
            ("CreateWindowExW", c_void_p, (c_int32, c_wchar_p, c_wchar_p, c_int32, c_int, c_int,
             c_int, c_int, c_void_p, c_void_p, c_void_p, c_void_p)),
            ("GetDC", c_void_p, (c_void_p,)),
            ("ReleaseDC", c_int, (c_void_p, c_void_p)),
            ("DestroyWindow", c_int, (c_void_p,)),
        ),
        "gdi32": (
            ("ChoosePixelFormat", c_int, (c_void_p, c_void_p)),
            ("SetPixelFormat", c_int, (c_void_p, c_int, c_void_p)),
        ),
        "opengl32": (
            ("wglCreateContext", c_void_p, (c_void_p,)),
            ("wglMakeCurrent", c_int, (c_void_p, c_void_p)),
            ("wglDeleteContext", c_int, (c_void_p,)),
            ("wglGetProcAddress", c_void_p, (c_char_p,)),
        ),
    }  # fmt: skip
    libraries = {name: ctypes.CDLL(name) for name in signatures}
    for library, functions in signatures.items():
        for name, result, arguments in functions:
            function = getattr(libraries[library], name)
            function.restype, function.argtypes = result, arguments
    return libraries
