"""Work done beside the main thread: the next item made ready, the last one put away."""

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

T = TypeVar("T")


def made_ahead(items: Iterable[T]) -> Iterator[T]:
    """The ``items``, each made in another thread while the one before is used.

    What making one raises is raised where it would have come.
    """
    source, end = iter(items), object()
    with ThreadPoolExecutor(1, "ahead") as pool:
        pending = pool.submit(next, source, end)
        while True:
            item = pending.result()
            if item is end:
                return
            pending = pool.submit(next, source, end)
            yield item  # pyright: ignore[reportReturnType]


class Behind:
    """Calls made one after another in another thread, at most one of them unfinished.

    As a context manager: at its end all of them are finished, whatever ended it.
    """

    def __init__(self):
        self._pool = ThreadPoolExecutor(1, "behind")
        self._pending: Future | None = None

    def __enter__(self) -> "Behind":
        return self

    def __exit__(self, kind, *_) -> None:
        self._pool.shutdown()
        if kind is None:
            self.finish()

    def call(self, function: Callable, *arguments: object) -> None:
        """Calls ``function`` once the call before is finished; raises what that one raised."""
        self.finish()
        self._pending = self._pool.submit(function, *arguments)

    def finish(self) -> None:
        """Waits for the last call and raises what it raised."""
        pending, self._pending = self._pending, None
        if pending is not None:
            pending.result()
