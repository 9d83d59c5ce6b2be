"""Programs that watch the simulated robot, send it and ask."""

import asyncio
import math
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
import saphira
from conftest import until
from saphira import _bus, topics, v1


def status_of(robot: saphira.Robot, id: v1.GoalId) -> v1.GoalStatus:
    """The end of a goal of any program."""
    for status in robot.watch(topics.GOAL_STATUS):
        if status.id == id and status.state > v1.GoalState.GOAL_SUSPENDED:
            return status
    raise AssertionError


def test_a_wait_may_be_endless_and_ends_with_a_signal(bus: Path) -> None:
    class Rung(Exception):
        pass

    def ring(number: int, frame: object) -> None:
        raise Rung

    own = _bus.Bus("waits", None, None, None, [], None, "")
    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, 0.3)
    try:
        with pytest.raises(Rung):
            while own.wait(math.inf):
                own.poll()
    finally:
        signal.signal(signal.SIGALRM, before)
    own.wait(-math.inf)
    own.wait(math.nan)
    own.close()


def test_goes_to_a_place_with_progress(robot: saphira.Robot) -> None:
    goal = robot.go(0.5, 0.0)
    states = [status.state for status in goal]
    assert v1.GoalState.GOAL_UNDERWAY in states
    assert states[-1] == v1.GoalState.GOAL_SUCCEEDED
    assert goal.wait().progress == 1.0


def test_asyncio_watches_while_it_goes(robot: saphira.Robot) -> None:
    async def drive() -> tuple[v1.GoalStatus, set[float]]:
        task = asyncio.create_task(robot.go(saphira.Point(1.0, 0.0)))
        speeds = set()
        async for state in robot.state():
            speeds.add(state.velocity)
            if task.done():
                break
        return await task, speeds

    status, speeds = asyncio.run(drive())
    assert status.state == v1.GoalState.GOAL_SUCCEEDED
    assert max(speeds) > 0.1


def test_a_cancelled_task_withdraws_its_goal(robot: saphira.Robot) -> None:
    goal = robot.go("D")

    async def begin() -> None:
        task = asyncio.create_task(goal)
        async for status in goal:
            if status.state == v1.GoalState.GOAL_UNDERWAY:
                break
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task

    asyncio.run(begin())
    assert status_of(robot, goal.id).code == v1.GoalCode.CODE_DISPOSED


def test_a_refusal_has_code_reason_and_remedy(robot: saphira.Robot) -> None:
    with pytest.raises(saphira.Refused) as error:
        robot.do("flie").wait()
    assert error.value.code == v1.GoalCode.CODE_UNKNOWN_FUNCTOR
    assert "flie" in error.value.reason
    assert error.value.remedy
    with pytest.raises(saphira.Trouble) as other:
        robot.go("nowhere").wait()
    assert "nowhere" in other.value.reason
    with pytest.raises(TypeError, match="expected go"):
        robot.go("")


def test_asks_agents(robot: saphira.Robot) -> None:
    with pytest.raises(saphira.Nobody) as error:
        robot.ask("place_of", person="karen").wait()
    assert error.value.code == v1.AnswerCode.ANSWER_NOBODY
    assert "place_of" in error.value.reason
    answer = robot.ask("live-triggers").wait()
    assert answer["live"] == ""
    assert robot.stop().wait().text

    async def both() -> None:
        one, other = await asyncio.gather(robot.ask("live-triggers"), robot.ask("live-triggers"))
        assert one.agent == other.agent

    asyncio.run(both())


def test_a_goal_ends_with_its_process(robot: saphira.Robot) -> None:
    program = subprocess.Popen(
        [sys.executable, "-c", "import saphira; saphira.connect('killed').go('D').wait()"]
    )
    mine = None
    for status in robot.watch(topics.GOAL_STATUS):
        if status.requester == "killed" and status.state == v1.GoalState.GOAL_UNDERWAY:
            mine = status.id
            break
    program.kill()
    program.wait()
    assert mine is not None
    assert status_of(robot, mine).code == v1.GoalCode.CODE_WRITER_LOST


def test_ctrl_c_ends_a_wait_and_withdraws_the_goal(robot: saphira.Robot) -> None:
    goal = robot.go("D")
    until(lambda: goal.status is not None)
    timer = threading.Timer(0.1, os.kill, [os.getpid(), signal.SIGINT])
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        goal.wait()
    timer.join()
    assert status_of(robot, goal.id).code == v1.GoalCode.CODE_DISPOSED


def test_other_threads_run_while_one_waits(robot: saphira.Robot) -> None:
    counted = []
    done = threading.Event()

    def count() -> None:
        while not done.is_set():
            counted.append(1)
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    stream = robot.state()
    before = len(counted)
    for _ in range(3):
        next(stream)
    assert len(counted) > before
    done.set()
    thread.join()


def test_a_robot_is_for_its_thread_and_its_process(robot: saphira.Robot) -> None:
    errors: list[BaseException] = []

    def use() -> None:
        try:
            robot.stop().wait()
        except RuntimeError as error:
            errors.append(error)

    thread = threading.Thread(target=use)
    thread.start()
    thread.join()
    assert "thread" in str(errors[0])

    child = os.fork()
    if child == 0:
        try:
            next(robot.state())
        except RuntimeError as error:
            robot.close()
            os._exit(0 if "fork" in str(error) else 1)
        os._exit(2)
    assert os.waitpid(child, 0)[1] == 0
    assert next(robot.state()).stamp.cycle > 0


def test_another_thread_closes_a_robot(robot: saphira.Robot) -> None:
    other = saphira.connect("closed elsewhere")
    goal = other.go("D")
    until(lambda: goal.status is not None)
    thread = threading.Timer(0.1, other.close)
    thread.start()
    with pytest.raises(RuntimeError, match="closed"):
        goal.wait()
    thread.join()
    assert not other._bus.is_open()
    assert status_of(robot, goal.id).code == v1.GoalCode.CODE_DISPOSED


def test_a_handler_of_a_signal_closes_a_robot_in_its_wait(robot: saphira.Robot) -> None:
    other = saphira.connect("closed by a signal")
    goal = other.go("D")
    until(lambda: goal.status is not None)  # a goal that is withdrawn unheard has no status
    before = signal.signal(signal.SIGALRM, lambda *_: other.close())
    signal.setitimer(signal.ITIMER_REAL, 0.2)
    with pytest.raises(RuntimeError, match="closed"):
        goal.wait()
    signal.signal(signal.SIGALRM, before)
    assert status_of(robot, goal.id).code == v1.GoalCode.CODE_DISPOSED


def test_a_closed_robot_says_so(programs: None) -> None:
    robot = saphira.connect("closed")
    stream = robot.watch(topics.ROBOT_STATE)
    robot.close()
    with pytest.raises(RuntimeError, match="closed"):
        next(stream)
    with pytest.raises(RuntimeError, match="closed"):
        robot.go("A")
