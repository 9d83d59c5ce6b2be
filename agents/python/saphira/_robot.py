"""A robot on the bus."""

import asyncio
import atexit
import math
import sys
import time
import weakref
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar, cast, overload

from . import _bus, topics, v1
from ._agent import Served, capability_of
from ._drive import Drive
from ._errors import Failed, Nobody, Refused, Trouble, trouble_of_answer, trouble_of_goal
from ._values import Point, Values, arguments, values
from ._waiting import Context, Pending, Stream, Waiter
from ._why import Explanation, explanation_of
from .topics import Topic

if TYPE_CHECKING:
    from . import arrays

T = TypeVar("T")
Function = TypeVar("Function", bound=Callable[..., Any])

_EMPTY_BUS = 5.0  # [s] until a question is given up where no program is heard
_UNANSWERED = 15.0  # [s] until a goal without a status is given up
_SILENCE = 11.0  # [s] until a request is given up, after the newest word of an agent
_LOOK = 0.2  # [s]
_PATIENCE = 5.0  # [s] until what a latched topic says is given up
_QUIET = 0.3  # [s] after which no further tile of the grid is expected
_FOUND = 1.0  # [s] until a dialogue that is there has been found
_SHORTEST = 0.1  # [s] period of a trigger

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
    summary: str = "",
) -> "Robot":
    """Joins the bus of a robot, as a program of that name (usual: the script's).

    summary: a line about the program for people, where it can be asked for something.

    Without further arguments it is the robot that the commands of `saphira` mean: the one that
    runs on this machine, or the one of the variables SAPHIRA_ROBOT, SAPHIRA_DOMAIN and so on.
    """
    own = name if name is not None else Path(sys.argv[0]).stem if sys.argv[0] else "python"
    return Robot(_bus.Bus(own or "python", robot, domain, profile, peers, security, summary))


@dataclass(frozen=True)
class Call:
    """A functor with its arguments, for triggers: call("go-to-place", place="N2")."""

    functor: str
    slots: "dict[str, Values]"


def call(functor: str, /, **slots: Values) -> Call:
    return Call(functor, slots)


class Trigger:
    """It fires until it is withdrawn, or the program ends."""

    def __init__(self, robot: "Robot", id: v1.GoalId) -> None:
        self._robot = robot
        self.id = id

    def withdraw(self) -> None:
        self._robot._bus.take_back(self.id)

    def trouble(self) -> Pending[str]:
        """Why it can do nothing now, such as: no agent can do "pong" [empty: it can]."""
        name = f"{self.id.writer:x}:{self.id.number}"

        def of(told: list[v1.Answer]) -> str:
            said = Answer(told[-1])
            known = name in str(said["live"]).split()
            return str(said.values.get(name, "")) if known else "the facilitator does not have it"

        return self._robot._asked(topics.SOLVE, v1.Request(functor="live-triggers"), of)


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
        super().__init__(robot._waiter, self._end)

    @property
    def status(self) -> "v1.GoalStatus | None":
        """The newest; None: the robot has not answered yet."""
        self._robot._poll()
        return self._robot._bus.status(self.id)

    @property
    def done(self) -> bool:
        """It has ended, well or not: `wait()` says how."""
        status = self.status
        return status is not None and _ended(status)

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
                raise Nobody(bus.who_is_there(), v1.GoalCode.CODE_NO_ROBOT)
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
            raise Failed("the bus did not take the sample", v1.AnswerCode.ANSWER_GIVEN_UP)

    def withdraw(self, sample: T) -> None:
        """Withdraws the instance that has the sample's key."""
        self._writer.dispose(sample)


class _Told(list[v1.Answer]):
    """The answers to a request, while somebody may wait for them."""


def _request(functor: str, of: str, deadline: float, slots: "dict[str, Values]") -> v1.Request:
    return v1.Request(functor=functor, service=of, deadline=deadline, arguments=arguments(slots))


def _every_answer(told: list[v1.Answer]) -> list[Answer]:
    return [Answer(each) for each in told[:-1] if each.results or each.text]


def _end_of(told: list[v1.Answer]) -> Answer:
    return Answer(told[-1])


class Robot(Context):
    """A robot, for the thread that connected. Also a context, which ends its goals."""

    def __init__(self, bus: _bus.Bus) -> None:
        self._bus = bus
        self._waiter = Waiter(bus)
        self._told: "weakref.WeakValueDictionary[int, _Told]" = weakref.WeakValueDictionary()
        self._writers: dict[str, _bus.Writer] = {}  # what a writer has declared ends with it
        self._served = Served(bus.answer)
        self._said = 0
        _robots.add(self)

    def _poll(self) -> None:
        self._bus.poll()
        self._hear()
        for request in self._bus.requests():
            self._served.handle(request)

    def _hear(self) -> None:
        for answer in self._bus.answers():
            self._told.get(answer.number, _Told()).append(answer)

    def close(self) -> None:
        """Leaves the bus, which ends all that this program has begun."""
        self._bus.close()

    @property
    def name(self) -> str:
        return self._bus.robot()

    # Goals

    def go(self, *place: "str | float | Point", **options: Any) -> Goal:
        """Sends it to a place of the map, go("N2"), or straight to a point [m], go(3, 1).

        Options as of do().
        """
        if len(place) == 1 and isinstance(place[0], str) and place[0]:
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
        """Ends whatever moves the robot, with this call; waited for, it is done once it is at rest."""
        return self.request(topics.DRIVE_STOP, "stop")

    # Requests

    def ask(
        self, functor: str, /, *, of: str = "", deadline: float = 0.0, **slots: Values
    ) -> Pending[Answer]:
        """Asks whichever agent can answer; of: the one that is meant. OPEN: the answer fills it."""
        return self._asked(topics.SOLVE, _request(functor, of, deadline, slots), _end_of)

    def ask_all(
        self, functor: str, /, *, of: str = "", deadline: float = 0.0, **slots: Values
    ) -> Pending[list[Answer]]:
        """Asks each agent that can answer."""
        request = _request(functor, of, deadline, {**slots, "answers": 0.0})
        return self._asked(topics.SOLVE, request, _every_answer)

    def request(
        self, topic: "Topic[v1.Request]", functor: str, /, *, of: str = "", **slots: Values
    ) -> Pending[Answer]:
        """Asks on a topic of requests, such as topics.SERVO (docs/requests.md)."""
        return self._asked(topic, _request(functor, of, 0.0, slots), _end_of)

    def _asked(
        self, topic: "Topic[v1.Request]", request: v1.Request, result: Callable[[_Told], T]
    ) -> Pending[T]:
        """Sends it now. The module repeats it until it is heard, whatever Python does meanwhile."""
        patience = request.deadline + 1.0 if request.deadline > 0.0 else _SILENCE
        self._hear()
        number = self._bus.send(topic.name, request, patience)
        told = self._told[number] = _Told()

        async def end() -> T:
            await self._end(topic, number, told)
            if told[-1].code == v1.AnswerCode.ANSWER_TOO_LATE and not told[-1].service:
                raise Nobody(f"{request.functor}: {told[-1].text}", v1.AnswerCode.ANSWER_NOBODY)
            trouble = trouble_of_answer(told[-1])
            if trouble is not None:
                raise trouble
            return result(told)

        return Pending(self._waiter, end)

    async def _end(self, topic: "Topic[v1.Request]", number: int, told: _Told) -> None:
        try:
            while True:
                self._poll()
                if told and told[-1].code != v1.AnswerCode.ANSWER_UNDERWAY:
                    break
                # A stop is repeated to the end: a bridge that is not heard yet may be there.
                nobody = "" if told or topic == topics.DRIVE_STOP else self._absence(topic)
                if nobody:
                    raise Nobody(nobody, v1.AnswerCode.ANSWER_NOBODY)
                await self._waiter.news(_LOOK)
        except BaseException:
            if self._bus.is_open():
                self._bus.withdraw(topic.name, number)
            raise

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
        return Writer(self._writer_of(topic.name))

    def _writer_of(self, topic: str) -> _bus.Writer:
        if topic not in self._writers:
            self._writers[topic] = self._bus.writer(topic)
        return self._writers[topic]

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
                self._poll()
                if not heard and self._bus.is_empty() and time.monotonic() > began + _EMPTY_BUS:
                    raise Nobody(self._bus.who_is_there(), v1.AnswerCode.ANSWER_NOBODY)
                await self._waiter.news(_LOOK)

        return Stream(self._waiter, after)

    def read(self, topic: "Topic[T]") -> Pending[T]:
        """The next sample of a topic, or what a latched topic says now. Nobody: none in 5 s."""
        reader = self._bus.reader(topic.name)
        return Pending(self._waiter, lambda: self._read(topic, reader))

    async def _read(self, topic: "Topic[T]", reader: _bus.Reader) -> T:
        began = time.monotonic()
        while time.monotonic() < began + _PATIENCE:
            came = [sample for sample, withdrawn, _, _ in reader.take() if not withdrawn]
            if came:
                return cast(T, came[-1])
            self._poll()
            await self._waiter.news(_LOOK)
        reason = f"nothing is said on {topic.name}; {self._bus.who_is_there()}"
        raise Nobody(reason, v1.AnswerCode.ANSWER_NOBODY)

    @property
    def map(self) -> Pending[v1.FloorMap]:
        """The map, with all that is on it."""
        return self.read(topics.MAP)

    @property
    def knows(self) -> Pending[v1.Knowledge]:
        """What people have told the robot."""
        return self.read(topics.KNOWS)

    @property
    def grid(self) -> "Pending[arrays.Grid]":
        """The occupancy grid, as an array of numpy."""
        return Pending(self._waiter, self._grid)

    async def _grid(self) -> "arrays.Grid":
        from . import arrays

        reader = self._bus.reader(topics.GRID.name)
        tiles: dict[tuple[int, int], v1.GridTile] = {}
        until = time.monotonic() + _PATIENCE
        while time.monotonic() < until:
            for sample, withdrawn, _, _ in reader.take():
                tile = cast(v1.GridTile, sample)
                if not tiles:
                    until = time.monotonic() + _QUIET
                if withdrawn:
                    tiles.pop((tile.column, tile.row), None)
                else:
                    tiles[tile.column, tile.row] = tile
            self._poll()
            await self._waiter.news(_QUIET)
        if not tiles:
            reason = "nothing is said of the grid; " + self._bus.who_is_there()
            raise Nobody(reason, v1.AnswerCode.ANSWER_NOBODY)
        return arrays.grid(list(tiles.values()))

    def sonars(self) -> "Stream[arrays.Array]":
        """The points of the newest echoes [m] in odom, rows (x, y), as an array of numpy."""
        from . import arrays

        stream = self._stream(topics.SONAR_BUCKETS, newest=True)

        async def after() -> "arrays.Array":
            return arrays.echoes(await stream.__anext__())

        return Stream(self._waiter, after)

    # Reasons

    @property
    def picture(self) -> Pending[v1.CameraPicture]:
        """The next picture of the robot's camera. Nobody: none in 5 s."""
        return self.read(topics.CAMERA_PICTURES)

    def pictures(self) -> Stream[v1.CameraPicture]:
        """The pictures of the robot's camera, the newest each time. It is off while nobody reads."""
        return self._stream(topics.CAMERA_PICTURES, newest=True)

    def why(self, cycle: int = 0) -> Pending[Explanation]:
        """Why it does what it does; cycle: in that one, or so many before now (below 0)."""
        return self.why_not("", cycle)

    def why_not(self, wish: str, cycle: int = 0) -> Pending[Explanation]:
        """Why it does not "turn left", "turn right", go "faster" or "slower"."""
        inquiry = self._bus.inquiry(cycle)
        return Pending(self._waiter, lambda: self._why(inquiry, wish))

    async def _why(self, inquiry: _bus.Inquiry, wish: str) -> Explanation:
        try:
            while not inquiry.poll():
                self._poll()
                await self._waiter.news(_LOOK)
            return explanation_of(inquiry.explanation(wish))
        except LookupError as error:
            raise Nobody(str(error), v1.AnswerCode.ANSWER_NOBODY) from None
        finally:
            inquiry.close()

    # Driving

    def drive(self) -> Drive:
        """The wheels: `with robot.drive() as wheels: wheels.go(0.2, seconds=2).wait()`."""
        return Drive(self._bus.driver(), self._waiter)

    # Being asked

    @overload
    def capability(self, function: Function) -> Function: ...
    @overload
    def capability(self, *, name: str) -> Callable[[Function], Function]: ...
    def capability(self, function: Any = None, *, name: str = "") -> Any:
        """Lets others ask this function for a fact; asking changes nothing.

        Its docstring's first line is the summary, its types are the arguments. What it returns
        answers: values by name (a TypedDict or a dataclass declares them), or a text.
        """
        return self._announce(function, name, acts=False)

    @overload
    def action(self, function: Function) -> Function: ...
    @overload
    def action(self, *, name: str) -> Callable[[Function], Function]: ...
    def action(self, function: Any = None, *, name: str = "") -> Any:
        """As capability(), for what changes something: one agent is asked, once.

        An `async def` may take its time; it is cancelled when its asker withdraws the request.
        """
        return self._announce(function, name, acts=True)

    def _announce(self, function: Any, name: str, acts: bool) -> Any:
        def announce(function: Function) -> Function:
            capability = capability_of(function, name, acts)
            self._served.add(capability.functor, function)
            self._bus.can(capability)
            return function

        return announce if function is None else announce(function)

    def serve(self) -> Pending[None]:
        """Answers until it is cancelled. Every other wait answers meanwhile, too."""
        return Pending(self._waiter, self._serve)

    async def _serve(self) -> None:
        while True:
            self._poll()
            await self._waiter.news(_LOOK)

    def run(self) -> None:
        """Answers until Ctrl-C."""
        try:
            asyncio.run(self._serve())
        except KeyboardInterrupt:
            pass

    # Triggers

    def every(self, period: float, action: Call, /, *, times: int = 0) -> Trigger:
        """Asks for the action every so many seconds. times: at most so often [0: without end].

        ValueError: a period below 0.1 s.
        """
        kind = v1.TriggerKind.TRIGGER_TIME
        return self._set(v1.Trigger(kind=kind, period=period), None, action, times)

    def when(
        self, fact: Call, action: Call, /, *, period: float = 1.0, times: int = 0
    ) -> Trigger:
        """Asks for the action when the fact, asked each period [s], is answered differently.

        OPEN slots of the action are filled with what the fact's answer says.
        """
        kind = v1.TriggerKind.TRIGGER_DATA
        return self._set(v1.Trigger(kind=kind, period=period), fact, action, times)

    def on(self, event: Call, action: Call, /, *, times: int = 0) -> Trigger:
        """Asks for the action when some program tells the event."""
        return self._set(v1.Trigger(kind=v1.TriggerKind.TRIGGER_EVENT), event, action, times)

    def _set(
        self, trigger: v1.Trigger, condition: "Call | None", action: Call, times: int
    ) -> Trigger:
        if condition is not None:
            trigger.condition = condition.functor
            trigger.condition_arguments = arguments(condition.slots)
        if trigger.kind != v1.TriggerKind.TRIGGER_EVENT and not (
            _SHORTEST <= trigger.period < math.inf
        ):
            raise ValueError(f"period: expected {_SHORTEST} s or more, found {trigger.period}")
        trigger.action = action.functor
        trigger.action_arguments = arguments(action.slots)
        trigger.times = times
        return Trigger(self, self._bus.set(trigger))

    def tell(self, event: str, /, **slots: Values) -> None:
        """Reports an event, which triggers may wait for."""
        self._bus.tell(v1.AgentEvent(functor=event, arguments=arguments(slots)))

    # Words

    def say(self, text: str, *, speaker: str = "") -> Pending[str]:
        """Says a sentence to the robot, such as advice; waited for, it ends with its reply.

        Refused: it does not act on it. What the sentence began ends with this program.
        """
        reader = self._bus.reader(topics.SAID.name)
        self._said += 1
        utterance = v1.Utterance(
            id=v1.GoalId(self._bus.instance(), self._said),
            speaker=speaker or self._bus.name(),
            text=text,
            means=v1.UtteranceMeans.UTTERANCE_PROGRAM,
            confidence=1.0,
            time=time.time(),
        )
        writer = self._writer_of(topics.HEARD.name)
        until = time.monotonic() + _FOUND
        while writer.matched() == 0 and time.monotonic() < until:
            time.sleep(0.005)  # a dialogue that comes later must not act on it
        written = writer.matched() > 0 and writer.write(utterance)
        return Pending(self._waiter, lambda: self._replies(utterance, writer, written, reader))

    async def _replies(
        self, utterance: v1.Utterance, writer: _bus.Writer, written: bool, reader: _bus.Reader
    ) -> str:
        replies: list[v1.Utterance] = []
        began = time.monotonic()
        while not (replies and replies[-1].end):
            if not written and writer.matched() > 0:
                written = writer.write(utterance)
            self._poll()
            for sample, _, _, _ in reader.take():
                reply = cast(v1.Utterance, sample)
                if reply.answers == utterance.id:
                    replies.append(reply)
            if not replies and time.monotonic() > began + _PATIENCE:
                absent = self._bus.absence("dialogue") or "nothing was answered"
                raise Nobody(absent, v1.AnswerCode.ANSWER_NOBODY)
            await self._waiter.news(_LOOK)
        said = " ".join(reply.text for reply in replies)
        if replies[-1].refused:
            raise Refused(said)
        return said
