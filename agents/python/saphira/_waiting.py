"""Waiting for the bus: with asyncio, or without it. The same coroutines serve both."""

import asyncio
import inspect
import types
from collections.abc import Awaitable, Callable, Coroutine, Generator
from functools import cached_property
from typing import Any, Generic, Self, TypeVar

from ._bus import Bus

T = TypeVar("T")


@types.coroutine
def _pause(seconds: float) -> Generator[float, None, None]:
    yield seconds


class Waiter:
    """Wakes the coroutines that wait for a bus."""

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self._blocks = False
        self._futures: list[asyncio.Future[None]] = []

    async def news(self, seconds: float) -> None:
        """Waits until something has come, and for so long at most."""
        if self._blocks:
            await _pause(seconds)
            return
        loop = asyncio.get_running_loop()
        future: asyncio.Future[None] = loop.create_future()
        fd = self._bus.fd()
        if not self._futures:
            loop.add_reader(fd, self._wake)
        self._futures.append(future)
        timer = loop.call_later(seconds, _release, future)
        try:
            await future
        finally:
            timer.cancel()
            self._futures.remove(future)
            if not self._futures:
                loop.remove_reader(fd)

    def run(self, work: Coroutine[Any, Any, T]) -> T:
        """Runs it to its end in this thread, without asyncio."""
        try:
            while True:
                before, self._blocks = self._blocks, True
                try:
                    seconds = work.send(None)
                except StopIteration as end:
                    return end.value  # type: ignore[no-any-return]
                finally:
                    self._blocks = before
                self._bus.wait(seconds)
        finally:
            work.close()

    def _wake(self) -> None:
        self._bus.clear_wake()
        for future in self._futures:
            _release(future)


def _release(future: "asyncio.Future[None]") -> None:
    if not future.done():
        future.set_result(None)


class Context:
    """Something that is closed at the end of `with` or `async with`."""

    def close(self) -> None:
        raise NotImplementedError

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: "type[BaseException] | None",
        error: "BaseException | None",
        trace: "types.TracebackType | None",
    ) -> None:
        self.close()

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self,
        kind: "type[BaseException] | None",
        error: "BaseException | None",
        trace: "types.TracebackType | None",
    ) -> None:
        self.close()


class Pending(Coroutine[Any, Any, T]):
    """Work that is waited for: `await it`, a task of asyncio, or `it.wait()` without asyncio.

    Its coroutine is made when it is waited for, so it may be dropped.
    """

    def __init__(self, waiter: Waiter, begin: Callable[[], Coroutine[Any, Any, T]]) -> None:
        self._waiter = waiter
        self._begin = begin

    @cached_property
    def _work(self) -> Coroutine[Any, Any, T]:
        return self._begin()

    def wait(self) -> T:
        """Waits in this thread. Ctrl-C ends it like a task that is cancelled."""
        return self._waiter.run(self._work)

    def send(self, value: Any) -> Any:
        return self._work.send(value)

    def throw(self, typ: Any, val: Any = None, tb: Any = None) -> Any:
        if inspect.getcoroutinestate(self._work) == inspect.CORO_CREATED:
            self._work.send(None)  # so that it withdraws what was sent before it was waited for
        return self._work.throw(typ, val, tb)

    def close(self) -> None:
        self._work.close()

    def __await__(self) -> Generator[Any, Any, T]:
        return self._work.__await__()


class Stream(Generic[T]):
    """What comes, in its order: `async for`, or `for` without asyncio."""

    def __init__(self, waiter: Waiter, after: Callable[[], Coroutine[Any, Any, T]]) -> None:
        self._waiter = waiter
        self._after = after

    def __aiter__(self) -> "Stream[T]":
        return self

    def __anext__(self) -> Awaitable[T]:
        return self._after()

    def __iter__(self) -> "Stream[T]":
        return self

    def __next__(self) -> T:
        try:
            return self._waiter.run(self._after())
        except StopAsyncIteration:
            raise StopIteration from None
