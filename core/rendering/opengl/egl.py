"""Contexts without a window by EGL: on a graphics processor, else in Mesa's software."""

import ctypes
from collections.abc import Iterator, Sequence
from ctypes import byref, c_char_p, c_int, c_int32, c_uint, c_void_p

from ...errors import MocapError
from .context import no_opengl

_DEVICE, _SURFACELESS, _EXTENSIONS = 0x313F, 0x31DD, 0x3055
_OPENGL_API, _OPENGL_BIT, _RENDERABLE_TYPE = 0x30A2, 0x0008, 0x3040
_SURFACE_TYPE, _NONE = 0x3033, 0x3038
_MAJOR, _MINOR, _PROFILE, _CORE = 0x3098, 0x30FB, 0x30FD, 1
_MOST_DEVICES = 16


class EglContext:
    """A context without any surface.

    Args:
        library: EGL.
        display: an ``EGLDisplay``, initialised.
        handle: an ``EGLContext`` of it.
    """

    def __init__(self, library: ctypes.CDLL, display: int, handle: int):
        self._egl, self._display, self._handle = library, display, handle

    def make_current(self) -> None:
        """Makes it the calling thread's."""
        self._egl.eglBindAPI(_OPENGL_API)
        if not self._egl.eglMakeCurrent(self._display, None, None, self._handle):
            raise no_opengl(f"EGL: error {self._egl.eglGetError():#x} when it was made current")

    def release(self) -> None:
        """Destroys it; the display stays, as others may use it, too."""
        self._egl.eglMakeCurrent(self._display, None, None, None)
        self._egl.eglDestroyContext(self._display, self._handle)


def make(versions: Sequence[tuple[int, int]]) -> EglContext:
    """A context of the first version on the first display that gives one.

    Raises:
        MocapError: none does.
        OSError: there is no EGL.
    """
    egl = _library()
    for display in _displays(egl):
        if not egl.eglInitialize(display, None, None):
            continue
        for version in versions:
            handle = _context(egl, display, version)
            if handle is None:
                continue
            context = EglContext(egl, display, handle)
            try:
                context.make_current()
            except MocapError:
                context.release()
                break
            return context
    raise no_opengl("EGL gives no context without a window")


def _library() -> ctypes.CDLL:
    egl = ctypes.CDLL("libEGL.so.1")
    for name, result, arguments in (
        ("eglGetProcAddress", c_void_p, (c_char_p,)),
        ("eglGetDisplay", c_void_p, (c_void_p,)),
        ("eglInitialize", c_uint, (c_void_p, c_void_p, c_void_p)),
        ("eglBindAPI", c_uint, (c_uint,)),
        ("eglChooseConfig", c_uint, (c_void_p, c_void_p, c_void_p, c_int, c_void_p)),
        ("eglCreateContext", c_void_p, (c_void_p, c_void_p, c_void_p, c_void_p)),
        ("eglMakeCurrent", c_uint, (c_void_p, c_void_p, c_void_p, c_void_p)),
        ("eglDestroyContext", c_uint, (c_void_p, c_void_p)),
        ("eglGetError", c_int, ()),
    ):
        function = getattr(egl, name)
        function.restype, function.argtypes = result, arguments
    return egl


def _displays(egl: ctypes.CDLL) -> Iterator[int]:
    """Graphics processors, then Mesa without a window system, then whatever is the default."""
    get_display = _extension(egl, b"eglGetPlatformDisplayEXT", c_void_p, c_uint, c_void_p, c_void_p)
    if get_display is not None:
        places = [(_DEVICE, device) for device in _devices(egl)]
        for platform, device in (*places, (_SURFACELESS, None)):
            display = get_display(platform, device, None)
            if display:
                yield display
    display = egl.eglGetDisplay(None)
    if display:
        yield display


def _devices(egl: ctypes.CDLL) -> list[int]:
    """Handles of the devices, those of hardware only."""
    query = _extension(egl, b"eglQueryDevicesEXT", c_uint, c_int, c_void_p, c_void_p)
    tell = _extension(egl, b"eglQueryDeviceStringEXT", c_char_p, c_void_p, c_int)
    if query is None or tell is None:
        return []
    devices, count = (c_void_p * _MOST_DEVICES)(), c_int()
    if not query(_MOST_DEVICES, devices, byref(count)):
        return []
    found = [device for device in devices[: count.value] if device]
    return [d for d in found if b"software" not in (tell(d, _EXTENSIONS) or b"")]


def _extension(egl: ctypes.CDLL, name: bytes, result, *arguments):
    """The extension's function, or None."""
    address = egl.eglGetProcAddress(name)
    return ctypes.CFUNCTYPE(result, *arguments)(address) if address else None


def _context(egl: ctypes.CDLL, display: int, version: tuple[int, int]) -> int | None:
    egl.eglBindAPI(_OPENGL_API)
    wanted = (c_int32 * 5)(_SURFACE_TYPE, 0, _RENDERABLE_TYPE, _OPENGL_BIT, _NONE)
    config, count = c_void_p(), c_int()
    if not egl.eglChooseConfig(display, wanted, byref(config), 1, byref(count)) or not count.value:
        return None
    major, minor = version
    attributes = (c_int32 * 7)(_MAJOR, major, _MINOR, minor, _PROFILE, _CORE, _NONE)
    return egl.eglCreateContext(display, config, None, attributes)
