"""Every type of the contract goes to C++ and back unchanged, and what does not fit is refused."""

import dataclasses
import enum
import math
from typing import Any, get_args, get_origin, get_type_hints

import pytest
import saphira
from saphira import _bus, topics, v1

TYPES: list[Any] = sorted(
    {topic.type for topic in vars(topics).values() if isinstance(topic, topics.Topic)},
    key=str,
)


class Filler:
    """Samples with a different value in each member."""

    def __init__(self, extreme: int) -> None:
        self.count = 0
        self.extreme = extreme

    def value(self, type_: Any) -> Any:
        self.count += 1
        if get_origin(type_) is list:
            return [self.value(get_args(type_)[0]) for _ in range(2)]
        if dataclasses.is_dataclass(type_):
            make: Any = type_
            return make(*(self.value(member) for member in get_type_hints(type_).values()))
        if issubclass(type_, enum.IntEnum):
            numbers: Any = type_
            return numbers([0, 1, 77][self.extreme])
        if type_ is bool:
            return self.count % 2 == 0
        if type_ is int:
            return self.count % 100
        if type_ is float:
            return [self.count / 8, -0.0, [math.nan, math.inf, -math.inf][self.count % 3]][
                self.extreme
            ]
        if type_ is str:
            return ["text", "\x01 ä \U0001f916", "\udcff"][self.extreme] + str(self.count)
        assert type_ is bytes, type_
        return bytes([self.count % 256, 0, 255])


@pytest.mark.parametrize("extreme", [0, 1, 2])
@pytest.mark.parametrize("type_", TYPES, ids=[each.__name__ for each in TYPES])
def test_each_type_comes_back_unchanged(type_: Any, extreme: int) -> None:
    sample = Filler(extreme).value(type_)
    assert repr(_bus.there_and_back(sample)) == repr(sample)
    empty = type_()
    assert _bus.there_and_back(empty) == empty


def test_a_list_that_breaks_is_an_exception() -> None:
    class Broken:
        def __len__(self) -> int:
            return 2

        def __getitem__(self, index: int) -> v1.Argument:
            raise LookupError("broken")

    with pytest.raises(LookupError, match="broken"):
        _bus.there_and_back(v1.Goal(arguments=Broken()))  # type: ignore[arg-type]


def test_a_list_that_changes_while_it_is_read_is_read_as_it_was() -> None:
    arguments: list[v1.Argument] = []

    class Clearing(v1.Argument):
        def __getattribute__(self, name: str) -> Any:
            arguments.clear()
            return super().__getattribute__(name)

    arguments += [Clearing("a"), v1.Argument("b"), v1.Argument("c")]
    back = _bus.there_and_back(v1.Goal(arguments=arguments))
    assert [each.name for each in back.arguments] == ["a", "b", "c"]


def test_whole_numbers_keep_their_limits() -> None:
    state = v1.RobotState(ptu=2**16 - 1, say=255, bad_packets=2**32 - 1)
    state.stamp.epoch = 2**64 - 1
    assert _bus.there_and_back(state) == state
    goal = v1.Goal(priority=-(2**31))
    assert _bus.there_and_back(goal) == goal


@pytest.mark.parametrize(
    "sample, place",
    [
        (v1.RobotState(say=256), "RobotState.say: expected a whole number from 0 to 255"),
        (v1.RobotState(stamp=v1.Stamp(epoch=-1)), "RobotState.stamp.epoch: expected"),
        (v1.Goal(priority=2**31), "Goal.priority: expected"),
        (v1.Goal(functor=3), "Goal.functor: expected a str, found 3"),  # type: ignore[arg-type]
        (v1.Goal(functor="a\0b"), "Goal.functor: expected a str without a zero character"),
        (v1.Goal(level="1"), "Goal.level: expected a number"),  # type: ignore[arg-type]
        (v1.MotorCommand(active=1), "MotorCommand.active: expected"),  # type: ignore[arg-type]
        (
            v1.Goal(arguments=[v1.Argument("x"), v1.Argument("y", point=v1.Pose2(x=None))]),  # type: ignore[arg-type]
            "Goal.arguments[1].point.x: expected a number, found None",
        ),
        (v1.Goal(arguments=[v1.Argument()] * 17), "Goal.arguments: expected at most 16, found 17"),
        (
            v1.RobotState(sonars=[v1.SonarReading(range=1e39)]),
            "RobotState.sonars[0].range: expected a number from -3.4e38 to 3.4e38",
        ),
    ],
)
def test_a_value_that_does_not_fit_is_refused_by_its_place(sample: Any, place: str) -> None:
    with pytest.raises(ValueError) as error:
        _bus.there_and_back(sample)
    assert str(error.value).startswith(place)


def test_a_misspelt_member_is_refused() -> None:
    with pytest.raises(AttributeError):
        v1.Goal().prioriti = 1  # type: ignore[attr-defined]


def test_values_become_arguments_and_back() -> None:
    point = saphira.Point(1.0, 2.0, 0.5, v1.Frame.FRAME_MAP)
    given = {"a": 1.5, "b": "text", "c": True, "d": point, "e": ["x", "y"], "f": saphira.OPEN}
    from saphira._values import arguments, values

    made = arguments(given)  # type: ignore[arg-type]
    assert [each.name for each in made] == ["a", "b", "c", "d", "e", "e", "f"]
    assert values(made) == given
    with pytest.raises(TypeError):
        arguments({"a": None})  # type: ignore[dict-item]
