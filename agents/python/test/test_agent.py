"""Programs that others ask, that drive, and that want to know why."""

import asyncio
import contextlib
import math
import threading
import time
from collections.abc import Iterator
from typing import TypedDict

import pytest
import saphira
from saphira import topics, v1


class Place(TypedDict):
    place: str


@pytest.fixture
def calendar(programs: None) -> Iterator[saphira.Robot]:
    with saphira.connect("calendar", summary="knows where people are") as calendar:
        yield calendar


def test_is_asked_for_a_fact(robot: saphira.Robot, calendar: saphira.Robot) -> None:
    @calendar.capability
    def place_of(person: str) -> Place:
        """where a person is"""
        if person != "karen":
            raise saphira.Refused("the calendar has no " + person)
        return {"place": "A"}

    async def main() -> None:
        serving = asyncio.create_task(calendar.serve())
        async for agent in robot.watch(topics.AGENTS):
            if agent.name == "calendar":
                assert agent.summary == "knows where people are"
                assert agent.capabilities[0].summary == "where a person is"
                break
        answer = None
        while answer is None:  # until the facilitator has heard of the agent as well
            with contextlib.suppress(saphira.Nobody):
                answer = await robot.ask("place_of", person="karen", place=saphira.OPEN)
        assert (answer["place"], answer.agent) == ("A", "calendar")
        assert [each["place"] for each in await robot.ask_all("place_of", person="karen")] == ["A"]
        with pytest.raises(saphira.Refused, match="no john"):
            await robot.ask("place_of", person="john")
        serving.cancel()

    asyncio.run(main())


def test_a_trigger_asks_for_an_action(robot: saphira.Robot, calendar: saphira.Robot) -> None:
    rung = asyncio.Event()

    @calendar.action
    async def note(door: str) -> None:
        """Writes a door down"""
        if door == "3":
            rung.set()

    async def main() -> None:
        serving = asyncio.create_task(calendar.serve())
        bell = saphira.call("bell", door=saphira.OPEN)
        trigger = robot.on(bell, saphira.call("note", door=saphira.OPEN))
        while not rung.is_set():
            robot.tell("bell", door="3")
            try:
                await asyncio.wait_for(robot.ask("live-triggers"), 1.0)
            except (asyncio.TimeoutError, saphira.Trouble):
                pass
        trigger.withdraw()
        serving.cancel()

    asyncio.run(main())


def test_drives_and_lets_go(robot: saphira.Robot) -> None:
    with robot.drive() as wheels:
        wheels.go(turn=0.5, seconds=1.0).wait()
        for state in robot.state():
            wheels.send(turn=0.5)
            if wheels.drives and state.rotation_velocity > 0.2:
                break
    for grant in robot.watch(topics.GRANT):
        if not grant.source.startswith("test"):
            break
    for state in robot.state():
        if state.rotation_velocity == 0.0:
            break


def test_a_stop_ends_a_drive(robot: saphira.Robot) -> None:
    def stop() -> None:
        with saphira.connect("other") as other:
            other.stop().wait()

    thread = threading.Thread(target=stop)
    with robot.drive() as wheels:
        wheels.go(turn=0.3, seconds=0.5).wait()
        thread.start()
        with pytest.raises(saphira.Canceled) as error:
            wheels.go(turn=0.3, seconds=60).wait()
    thread.join()
    assert error.value.code == v1.GoalCode.CODE_STOPPED
    assert "other" in error.value.reason


@pytest.mark.parametrize("first", [True, False])
def test_a_stop_that_nobody_waits_for_stops(robot: saphira.Robot, first: bool) -> None:
    goal = robot.go("D")
    for state in robot.state():
        if state.velocity > 0.1:
            break
    if first:  # of its program, which ends at once
        with saphira.connect("other") as other:
            other.stop()
    else:
        robot.stop()
    time.sleep(2.0)  # this program does nothing
    assert next(robot.state()).velocity == 0.0
    with pytest.raises(saphira.Canceled) as error:
        goal.wait()
    assert error.value.code == v1.GoalCode.CODE_STOPPED


def test_a_trigger_says_what_it_waits_for(robot: saphira.Robot) -> None:
    trigger = robot.every(60.0, saphira.call("pong"))
    while (trouble := trigger.trouble().wait()) == "the facilitator does not have it":
        pass
    assert "pong" in trouble
    trigger.withdraw()
    for period in (0.01, 0.0, -1.0, math.nan, math.inf):
        with pytest.raises(ValueError, match="0.1 s"):
            robot.every(period, saphira.call("pong"))


def test_a_short_drive_that_nobody_heeds_is_refused(robot: saphira.Robot) -> None:
    with saphira.connect(robot="nobody") as absent, absent.drive() as wheels:
        with pytest.raises(saphira.Refused, match="no bridge is heard"):
            wheels.go(turn=0.3, seconds=0.1).wait()


def test_says_why_and_why_not(robot: saphira.Robot) -> None:
    explanation = robot.why().wait()
    assert explanation.cycle > 0
    assert explanation.sentence in str(explanation)
    assert robot.why_not("turn left").wait().cause.text
    with pytest.raises(ValueError, match="turn left"):
        robot.why_not("fly").wait()
    with pytest.raises(saphira.Nobody, match="not known"):
        robot.why(10**9).wait()


def test_the_map_and_the_senses_are_arrays(robot: saphira.Robot) -> None:
    np = pytest.importorskip("numpy")
    from saphira import arrays

    floor = robot.map.wait()
    room = next(each for each in floor.artifacts if each.name == "A" and each.length > 2.0)
    corners = arrays.outline(room)
    assert corners.shape == (5, 2)
    assert np.allclose(corners.min(axis=0), (0.5, 5.2), atol=0.05)
    points = next(robot.sonars())
    assert points.ndim == 2 and points.shape[1] == 2
    grid = robot.grid.wait()
    assert np.nanmax(grid.occupied) <= 1.0 and np.isnan(grid.occupied).any()
    assert grid.extent[0] < grid.extent[1]


def test_the_camera_gives_pictures(robot: saphira.Robot) -> None:
    picture = robot.picture.wait()
    assert (picture.columns, picture.rows) == (320, 240)
    assert picture.jpeg.startswith(b"\xff\xd8")
    stream = robot.pictures()
    first, second = next(stream), next(stream)
    assert first.number < second.number
