"""A robot on the bus."""

import atexit
import sys
import time
import weakref
from collections.abc import Coroutine, Sequence
from functools import cached_property
from pathlib import Path
from types import TracebackType
from typing import Any, Generic, TypeVar, cast

from . import _bus, topics, v1
from ._errors import Failed, Nobody, Trouble, trouble_of_answer, trouble_of_goal
from ._values import Point, Values, arguments, values
from ._waiting import Pending, Stream, Waiter
from .topics import Topic

T = TypeVar("T")

_EMPTY_BUS = 5.0  # [s] until a question is given up where no program is heard
_UNANSWERED = 15.0  # [s] until a goal without a status is given up
_SILENCE = 11.0  # [s] until a request is given up, after the newest word of an agent
_AGAIN = 0.3  # [s] between two writings of a request, until it is answered
_LOOK = 0.2  # [s]

_robots: "weakref.WeakSet[Robot]" = weakref.WeakSet()


@atexit.register
def _close_all() -> None:
    for robot in list(_robots):
        robot.close()


def connect(
    name: "str | None" = None,
    *,
    robot: "str | None" = None,
    domain: "int | None" = None,
    profile: "str | None" = None,
    peers: Sequence[str] = (),
    security: "str | None" = None,
) -> "Robot":
    """Joins the bus of a robot, as a program of that name (usual: the script's).

    Without further arguments it is the robot that the commands of `saphira` mean: the one that
    runs on this machine, or the one of the variables SAPHIRA_ROBOT, SAPHIRA_DOMAIN and so on.
    """
    own = name if name is not None else Path(sys.argv[0]).stem if sys.argv[0] else "python"
    return Robot(_bus.Bus(own or "python", robot, domain, profile, peers, security))


class Answer:
    """The answer of an agent: `answer["place"]`."""

    def __init__(self, answer: v1.Answer) -> None:
        self.agent = answer.service
        self.text = answer.text
        self.values: dict[str, Values] = values(answer.results)

    def __getitem__(self, name: str) -> Values:
        return self.values[name]

    def __repr__(self) -> str:
        return f"Answer(agent={self.agent!r}, text={self.text!r}, values={self.values!r})"


class Goal(Pending[v1.GoalStatus]):
    """A goal that the robot was asked for.

    `await goal` or `goal.wait()` ends with it: a status of success, or an exception with code,
    reason and remedy. A wait that is cancelled withdraws the goal. `async for` and `for` give each
    change of its status, and end with it; leaving them withdraws nothing.
    """

    def __init__(self, robot: "Robot", goal: v1.Goal) -> None:
        self._robot = robot
        self._goal = goal
        self._began = time.monotonic()
        self.id = robot._bus.ask_goal(goal)
        self._waiter = robot._waiter

    @cached_property
    def _work(self) -> Coroutine[Any, Any, v1.GoalStatus]:  # type: ignore[override]
        return self._end()  # made when it is waited for

    @property
    def status(self) -> "v1.GoalStatus | None":
        """The newest; None: the robot has not answered yet."""
        self._robot._bus.poll()
        return self._robot._bus.status(self.id)

    def cancel(self, why: str = "") -> None:
        """Withdraws it. The reason is for people."""
        self._robot._bus.cancel(self.id, why)

    def _trouble(self, status: v1.GoalStatus) -> "Trouble | None":
        return trouble_of_goal(status, _bus.advice_after_failure(self._goal))

    async def _change(self, before: "v1.GoalStatus | None") -> v1.GoalStatus:
        bus = self._robot._bus
        while True:
            status = self.status
            if status is not None and status != before:
                return status
            waited = time.monotonic() - self._began
            if status is None and waited > (_EMPTY_BUS if bus.is_empty() else _UNANSWERED):
                self.cancel()
                raise Nobody(v1.GoalCode.CODE_NO_ROBOT, bus.who_is_there())
            await self._waiter.news(_LOOK)

    async def _end(self) -> v1.GoalStatus:
        status = None
        try:
            while status is None or not _ended(status):
                status = await self._change(status)
        except BaseException:
            if self._robot._bus.is_open() and (status is None or not _ended(status)):
                self.cancel()
            raise
        trouble = self._trouble(status)
        if trouble is not None:
            raise trouble
        return status

    def _changes(self) -> Stream[v1.GoalStatus]:
        before: "v1.GoalStatus | None" = None

        async def after() -> v1.GoalStatus:
            nonlocal before
            if before is not None and _ended(before):
                raise StopAsyncIteration
            before = await self._change(before)
            return before

        return Stream(self._waiter, after)

    def __aiter__(self) -> Stream[v1.GoalStatus]:
        return self._changes()

    def __iter__(self) -> Stream[v1.GoalStatus]:
        return self._changes()


def _ended(status: v1.GoalStatus) -> bool:
    return status.state in (
        v1.GoalState.GOAL_REFUSED,
        v1.GoalState.GOAL_SUCCEEDED,
        v1.GoalState.GOAL_FAILED,
        v1.GoalState.GOAL_CANCELED,
    )


class Writer(Generic[T]):
    """Writes a topic. What it has declared ends with the program."""

    def __init__(self, writer: _bus.Writer) -> None:
        self._writer = writer

    def write(self, sample: T) -> None:
        """ValueError names a member that cannot have its value; nothing is written then."""
        if not self._writer.write(sample):
            raise Failed(v1.AnswerCode.ANSWER_GIVEN_UP, "the bus did not take the sample")

    def withdraw(self, sample: T) -> None:
        """Withdraws the instance that has the sample's key."""
        self._writer.dispose(sample)


class Robot:
    """A robot, for the thread that connected. Also a context, which ends its goals."""

    def __init__(self, bus: _bus.Bus) -> None:
        self._bus = bus
        self._waiter = Waiter(bus)
        self._answers: dict[tuple[str, int], list[v1.Answer]] = {}
        _robots.add(self)

    def close(self) -> None:
        """Leaves the bus, which ends all that this program has begun."""
        self._bus.close()

    def __enter__(self) -> "Robot":
        return self

    def __exit__(
        self,
        kind: "type[BaseException] | None",
        error: "BaseException | None",
        trace: "TracebackType | None",
    ) -> None:
        self.close()

    @property
    def name(self) -> str:
        return self._bus.robot()

    # Goals

    def go(self, *place: "str | float | Point", **options: Any) -> Goal:
        """Sends it to a place of the map, go("N2"), or straight to a point [m], go(3, 1).

        Options as of do().
        """
        if len(place) == 1 and isinstance(place[0], str):
            return self.do("go-to-place", place=place[0], **options)
        if len(place) == 1 and isinstance(place[0], Point):
            return self.do("go_to", position=place[0], **options)
        if len(place) == 2 and not any(isinstance(part, (str, Point)) for part in place):
            x, y = cast("tuple[float, float]", place)
            return self.do("go_to", position=Point(x, y), **options)
        raise TypeError(f"expected go(PLACE), go(X, Y) or go(Point(...)), found go{place!r}")

    def do(
        self,
        activity: str,
        /,
        *,
        priority: int = 0,
        deadline: float = 0.0,
        level: float = 0.0,
        **parameters: Values,
    ) -> Goal:
        """Asks for an activity, as `saphira goal` does. deadline: [s] of robot time [0: none]."""
        goal = v1.Goal(
            functor=activity,
            arguments=arguments(parameters),
            priority=priority,
            deadline=deadline,
            level=level,
        )
        return Goal(self, goal)

    def stop(self) -> Pending[Answer]:
        """Ends whatever moves the robot, and is done once it is at rest."""
        return self.request(topics.DRIVE_STOP, "stop")

    # Requests

    def ask(
        self, functor: str, /, *, of: str = "", deadline: float = 0.0, **slots: Values
    ) -> Pending[Answer]:
        """Asks whichever agent can answer; of: the one that is meant. OPEN: the answer fills it."""
        return Pending(self._waiter, self._ask_one(topics.SOLVE, functor, of, deadline, slots))

    def ask_all(
        self, functor: str, /, *, of: str = "", deadline: float = 0.0, **slots: Values
    ) -> Pending[list[Answer]]:
        """Asks each agent that can answer."""
        return Pending(self._waiter, self._ask_all(functor, of, deadline, slots))

    def request(
        self, topic: "Topic[v1.Request]", functor: str, /, *, of: str = "", **slots: Values
    ) -> Pending[Answer]:
        """Asks on a topic of requests, such as topics.SERVO (docs/requests.md)."""
        return Pending(self._waiter, self._ask_one(topic, functor, of, 0.0, slots))

    async def _ask_one(
        self, topic: "Topic[v1.Request]", functor: str, of: str, deadline: float, slots: Any
    ) -> Answer:
        request = v1.Request(
            functor=functor, service=of, deadline=deadline, arguments=arguments(slots)
        )
        return Answer((await self._asked(topic, request))[-1])

    async def _ask_all(self, functor: str, of: str, deadline: float, slots: Any) -> list[Answer]:
        request = v1.Request(
            functor=functor,
            service=of,
            deadline=deadline,
            arguments=arguments({**slots, "answers": 0.0}),
        )
        told = await self._asked(topics.SOLVE, request)
        return [Answer(each) for each in told[:-1] if each.results or each.text]

    async def _asked(self, topic: "Topic[v1.Request]", request: v1.Request) -> list[v1.Answer]:
        """All answers, the end last. The request is written again until it is answered."""
        number = self._bus.send(topic.name, request)
        key = (topic.name, number)
        self._answers[key] = told = cast("list[v1.Answer]", [])
        patience = request.deadline + 1.0 if request.deadline > 0.0 else _SILENCE
        again, heard, count = time.monotonic() + _AGAIN, time.monotonic(), 0
        try:
            while True:
                for answer in self._bus.answers(topic.name):
                    asked = self._answers.get((topic.name, answer.number))
                    if asked is not None:
                        asked.append(answer)
                if told and told[-1].code != v1.AnswerCode.ANSWER_UNDERWAY:
                    break
                now = time.monotonic()
                if len(told) > count:
                    count, heard = len(told), now
                self._bus.poll()
                nobody = "" if told else self._absence(topic)
                if nobody or now > heard + patience:
                    why = nobody or f"{request.functor}: nothing was heard for {patience:.0f} s"
                    raise Nobody(v1.AnswerCode.ANSWER_NOBODY, why)
                if now > again:
                    self._bus.again(topic.name, number, request)
                    again = now + (_AGAIN if not told else 10 * _AGAIN)
                await self._waiter.news(_AGAIN)
        except BaseException:
            if self._bus.is_open():
                self._bus.again(topic.name, number, v1.Request(functor="withdraw"))
            raise
        finally:
            del self._answers[key]
        trouble = trouble_of_answer(told[-1])
        if trouble is not None:
            raise trouble
        return told

    def _absence(self, topic: "Topic[v1.Request]") -> str:
        return self._bus.absence("facilitator" if topic == topics.SOLVE else "bridge")

    # Watching

    def state(self) -> Stream[v1.RobotState]:
        """The robot's state, ten times a second: the newest, where this program is slower."""
        return self._stream(topics.ROBOT_STATE, newest=True)

    def watch(self, topic: "Topic[T]") -> Stream[T]:
        """Each sample of a topic that comes from now on, and what a latched topic says now."""
        return self._stream(topic, newest=False)

    def writer(self, topic: "Topic[T]") -> "Writer[T]":
        return Writer(self._bus.writer(topic.name))

    def _stream(self, topic: "Topic[T]", newest: bool) -> Stream[T]:
        reader = self._bus.reader(topic.name)
        came: list[T] = []
        began = time.monotonic()
        heard = False

        async def after() -> T:
            nonlocal heard
            while True:
                for sample, withdrawn, _, _ in reader.take():
                    if not withdrawn:
                        came.append(cast(T, sample))
                if newest:
                    del came[:-1]
                if came:
                    heard = True
                    return came.pop(0)
                self._bus.poll()
                if not heard and self._bus.is_empty() and time.monotonic() > began + _EMPTY_BUS:
                    raise Nobody(v1.AnswerCode.ANSWER_NOBODY, self._bus.who_is_there())
                await self._waiter.news(_LOOK)

        return Stream(self._waiter, after)
