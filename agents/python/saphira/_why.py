"""Why the robot does what it does."""

import json
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Cause:
    """A fact, and what it is because of."""

    kind: str  #: wheels, motors, grant, guard, speed, turn, behavior, rule, intention, goal, ...
    text: str
    because: "tuple[Cause, ...]" = field(default=())

    def lines(self, indent: str = "") -> list[str]:
        below = [line for cause in self.because for line in cause.lines(indent + "  ")]
        return [indent + self.text, *below]


@dataclass(frozen=True)
class Explanation:
    """Of one cycle: in a sentence, and as a tree of causes."""

    epoch: int
    cycle: int
    sentence: str
    cause: Cause

    def __str__(self) -> str:
        return "\n".join([self.sentence, *self.cause.lines("  ")])


def _cause(told: Any) -> Cause:
    return Cause(told["kind"], told["text"], tuple(_cause(each) for each in told["because"]))


def explanation_of(text: str) -> Explanation:
    told = json.loads(text)
    return Explanation(told["epoch"], told["cycle"], told["sentence"], _cause(told["tree"]))
