"""Coroutines that wait for the bus: with asyncio and without it."""

import asyncio
import gc
import os
from typing import Any

import pytest
from saphira._waiting import Pending, Stream, Waiter


class FakeBus:
    """A bus where something comes with each byte in a pipe."""

    def __init__(self) -> None:
        self.out, self.into = os.pipe()
        self.waits: list[float] = []

    def fd(self) -> int:
        return self.out

    def clear_wake(self) -> None:
        os.read(self.out, 100)

    def wait(self, seconds: float) -> bool:
        self.waits.append(seconds)
        if len(self.waits) == 3:
            raise KeyboardInterrupt
        return True


@pytest.fixture
def bus() -> Any:
    return FakeBus()


def test_without_asyncio_the_bus_waits(bus: Any) -> None:
    waiter = Waiter(bus)

    async def work() -> str:
        await waiter.news(0.5)
        await waiter.news(0.25)
        return "done"

    assert Pending(waiter, work).wait() == "done"
    assert bus.waits == [0.5, 0.25]


@pytest.mark.filterwarnings("error")
def test_work_that_nobody_waits_for_is_not_begun(bus: Any) -> None:
    waiter = Waiter(bus)
    begun = []

    async def work() -> None:
        begun.append("begun")

    Pending(waiter, work)
    Pending(waiter, work).close()
    gc.collect()
    assert begun == []


def test_ctrl_c_lets_the_work_clean_up(bus: Any) -> None:
    waiter = Waiter(bus)
    said = []

    async def work() -> None:
        try:
            while True:
                await waiter.news(1.0)
        finally:
            said.append("withdrawn")

    with pytest.raises(KeyboardInterrupt):
        Pending(waiter, work).wait()
    assert said == ["withdrawn"]


def test_with_asyncio_all_are_woken_by_one_arrival(bus: Any) -> None:
    waiter = Waiter(bus)

    async def work() -> str:
        await waiter.news(3600.0)
        return "woken"

    async def main() -> list[str]:
        tasks = [asyncio.create_task(Pending(waiter, work)) for _ in range(3)]
        await asyncio.sleep(0)
        os.write(bus.into, b"1")
        return list(await asyncio.gather(*tasks))

    assert asyncio.run(main()) == ["woken"] * 3
    assert bus.waits == []


def test_a_task_that_is_cancelled_before_it_begins_cleans_up(bus: Any) -> None:
    waiter = Waiter(bus)
    said = []

    async def work() -> None:
        try:
            await waiter.news(3600.0)
        finally:
            said.append("withdrawn")

    async def main() -> None:
        task = asyncio.create_task(Pending(waiter, work))
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task

    asyncio.run(main())
    assert said == ["withdrawn"]


def test_with_asyncio_the_time_ends_a_wait(bus: Any) -> None:
    waiter = Waiter(bus)
    asyncio.run(waiter.news(0.0))


def test_a_stream_ends_both_loops(bus: Any) -> None:
    waiter = Waiter(bus)

    def numbers() -> Stream[int]:
        count = 0

        async def after() -> int:
            nonlocal count
            count += 1
            if count > 3:
                raise StopAsyncIteration
            return count

        return Stream(waiter, after)

    async def collect() -> list[int]:
        return [number async for number in numbers()]

    assert list(numbers()) == [1, 2, 3]
    assert asyncio.run(collect()) == [1, 2, 3]
