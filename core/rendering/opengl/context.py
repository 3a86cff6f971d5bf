"""OpenGL off-screen: a context that nobody sees, in a thread of its own.

A context belongs to the thread in which it is current, and a windowed Blender keeps its own current
in the main thread. Ours is therefore made in one worker thread, stays there, and all calls of
OpenGL are handed to that thread. PyOpenGL is imported by the first of them, never earlier.
"""

import importlib
import os
import sys
import weakref
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from functools import cache
from typing import Any, ParamSpec, Protocol, TypeVar, cast

from ...errors import MocapError

REMEDY = "choose another evaluator, or install a driver for OpenGL 4.3"
VERSIONS = ((4, 3), (4, 1), (3, 3))
"""Asked for in turn, core profile; drivers give the newest that is compatible."""
_PLATFORM = "PYOPENGL_PLATFORM"
P = ParamSpec("P")
R = TypeVar("R")


class Context(Protocol):
    """An off-screen context; made by the functions ``make`` of egl.py, wgl.py and cgl.py."""

    def make_current(self) -> None:
        """Makes it the calling thread's; raises a MocapError where that fails."""
        ...

    def release(self) -> None:
        """Takes it from the calling thread and destroys it."""
        ...


def make_context() -> Context:
    """A context for this platform, not yet current.

    Raises:
        MocapError: there is no OpenGL here, or it makes no context.
    """
    if sys.platform == "win32":
        from .wgl import make
    elif sys.platform == "darwin":
        from .cgl import make
    else:
        from .egl import make
    try:
        return make(VERSIONS)
    except OSError as error:
        raise no_opengl(str(error)) from error


def no_opengl(reason: str) -> MocapError:
    """The fault of a machine without OpenGL of our kind."""
    return MocapError(f"OpenGL cannot be used ({reason})", REMEDY)


def load_functions() -> Any:
    """PyOpenGL's module ``OpenGL.GL``, on Linux bound to EGL.

    Raises:
        MocapError: it is not installed, or was loaded for another window system.
    """
    before = os.environ.get(_PLATFORM)
    if sys.platform.startswith("linux"):
        os.environ[_PLATFORM] = "egl"
    try:
        functions = importlib.import_module("OpenGL.GL")
        platform = importlib.import_module("OpenGL.platform").PLATFORM
    except (ImportError, AttributeError, TypeError) as error:
        raise no_opengl(f"PyOpenGL: {error}") from error
    finally:
        if before is None:
            os.environ.pop(_PLATFORM, None)
        else:
            os.environ[_PLATFORM] = before
    kind = type(platform).__name__
    if sys.platform.startswith("linux") and kind != "EGLPlatform":
        raise no_opengl(f"PyOpenGL was loaded as {kind} before")
    return functions


class GlThread:
    """A thread with a context; OpenGL is only ever called in it.

    Args:
        make: makes the context, called in the thread.

    Attributes:
        gl: PyOpenGL's functions; to be called in the thread only.
        renderer: the name of the graphics processor, as its driver tells it.
        version: (major, minor) of the context.

    Raises:
        MocapError: the context fails.
    """

    def __init__(self, make: Callable[[], Context] = make_context):
        self._pool = ThreadPoolExecutor(1, "opengl")
        self._forgotten: deque[tuple[str, int]] = deque()
        self._kept: dict[Callable, object] = {}
        self.gl: Any = None
        self.renderer, self.version = "", (0, 0)
        try:
            self._context = self._pool.submit(self._begin, make).result()
        except BaseException:
            self._pool.shutdown(wait=False)
            raise

    def call(self, function: Callable[P, R], *args: P.args, **kwargs: P.kwargs) -> R:
        """What ``function`` returns when it is called in the thread.

        Raises:
            MocapError: OpenGL refuses something, such as more memory.
        """
        return self.submit(function, *args, **kwargs).result()

    def submit(self, function: Callable[P, R], *args: P.args, **kwargs: P.kwargs) -> Future[R]:
        """The same, but the caller goes on at once."""
        return self._pool.submit(self._run, function, *args, **kwargs)

    def forget_with(self, owner: object, deleter: str, name: int) -> None:
        """Deletes the object ``name`` by ``gl.deleter`` some time after ``owner`` is gone."""
        finalizer = weakref.finalize(owner, self._forgotten.append, (deleter, name))
        finalizer.atexit = False

    def kept(self, make: Callable[["GlThread"], R]) -> R:
        """What ``make`` returns, made once in the thread; such as programs that all share."""

        def once() -> object:
            if make not in self._kept:
                self._kept[make] = make(self)
            return self._kept[make]

        return cast(R, self.call(once))

    def release(self) -> None:
        """Destroys the context and ends the thread."""
        self._pool.submit(self._context.release).result()
        self._pool.shutdown()

    def _begin(self, make: Callable[[], Context]) -> Context:
        context = make()
        context.make_current()
        try:
            self.gl = load_functions()
            self.renderer = self.gl.glGetString(self.gl.GL_RENDERER).decode()
            self.version = tuple(
                int(self.gl.glGetIntegerv(name))
                for name in (self.gl.GL_MAJOR_VERSION, self.gl.GL_MINOR_VERSION)
            )
        except BaseException as error:
            context.release()
            if isinstance(error, MocapError):
                raise
            raise no_opengl(f"{type(error).__name__}: {error}") from error
        return context

    def _run(self, function: Callable[P, R], *args: P.args, **kwargs: P.kwargs) -> R:
        while self._forgotten:
            deleter, name = self._forgotten.popleft()
            getattr(self.gl, deleter)(1, [name])
        try:
            return function(*args, **kwargs)
        except self.gl.GLError as error:
            called = getattr(error.baseOperation, "__name__", "a call")
            raise no_opengl(f"{self.renderer}: error {error.err:#x} of {called}") from error


@cache
def shared_thread() -> GlThread:
    """The thread that all evaluators of this process share.

    Raises:
        MocapError: the context fails; the next call tries anew.
    """
    return GlThread()
