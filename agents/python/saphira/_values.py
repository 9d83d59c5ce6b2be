"""Arguments of goals and requests as values of Python."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Union

from . import v1


@dataclass(frozen=True)
class Point:
    """A place [m], with a heading [rad], in a frame."""

    x: float
    y: float
    th: float = 0.0
    frame: v1.Frame = v1.Frame.FRAME_ODOM


@dataclass(frozen=True)
class Open:
    """A slot that the answer fills. Slots of one variable have the same value."""

    variable: str = ""


OPEN = Open()

Value = Union[str, float, bool, Point, Open]
Values = Union[Value, Sequence[Value]]


def argument(name: str, value: Value) -> v1.Argument:
    kinds = v1.ArgumentKind
    if isinstance(value, bool):
        return v1.Argument(name, kinds.ARGUMENT_TRUTH, number=float(value))
    if isinstance(value, str):
        return v1.Argument(name, kinds.ARGUMENT_TEXT, text=value)
    if isinstance(value, Point):
        pose = v1.Pose2(value.x, value.y, value.th)
        return v1.Argument(name, kinds.ARGUMENT_POINT, point=pose, frame=value.frame)
    if isinstance(value, Open):
        return v1.Argument(name, kinds.ARGUMENT_UNBOUND, text=value.variable)
    try:
        return v1.Argument(name, kinds.ARGUMENT_NUMBER, number=float(value))
    except (TypeError, ValueError):
        raise TypeError(
            f"{name}: expected a number, a str, a bool, a Point or OPEN, found {value!r}"
        ) from None


def arguments(values: Mapping[str, Values]) -> list[v1.Argument]:
    """Several values of one name are a list."""
    made = []
    for name, value in values.items():
        several = value if isinstance(value, (list, tuple)) else [value]
        made += [argument(name, each) for each in several]
    return made


def value(argument: v1.Argument) -> Value:
    if argument.kind == v1.ArgumentKind.ARGUMENT_TEXT:
        return argument.text
    if argument.kind == v1.ArgumentKind.ARGUMENT_TRUTH:
        return argument.number != 0.0
    if argument.kind == v1.ArgumentKind.ARGUMENT_POINT:
        point = argument.point
        return Point(point.x, point.y, point.th, argument.frame)
    if argument.kind == v1.ArgumentKind.ARGUMENT_UNBOUND:
        return Open(argument.text)
    return argument.number


def values(arguments: Sequence[v1.Argument]) -> dict[str, Values]:
    found: dict[str, list[Value]] = {}
    for each in arguments:
        found.setdefault(each.name, []).append(value(each))
    return {name: all[0] if len(all) == 1 else all for name, all in found.items()}
