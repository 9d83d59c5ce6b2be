"""What became of a goal or a request that was not done."""

from . import v1

_REMEDIES = {
    v1.GoalCode.CODE_UNKNOWN_FUNCTOR: "`saphira goal activities` lists what can be asked for",
    v1.GoalCode.CODE_BAD_ARGUMENT: "`saphira goal activities NAME` lists its arguments",
    v1.GoalCode.CODE_TOO_MANY: "wait for the end of earlier goals, or cancel them",
    v1.GoalCode.CODE_FORGOTTEN: "ask again to have it done",
    v1.GoalCode.CODE_DEADLINE: "ask again with a longer deadline",
    v1.GoalCode.CODE_BLOCKED: "clear the way, and ask again",
    v1.GoalCode.CODE_NO_ROBOT: "`saphira status` shows what is missing",
    v1.GoalCode.CODE_NO_POSITION: "`saphira map place NAME` says where the robot is",
    v1.GoalCode.CODE_NO_ROUTE: "`saphira map list` shows the map; another place may be reachable",
    v1.GoalCode.CODE_TIMEOUT: "ask again, or ask for less at once",
    v1.GoalCode.CODE_PREEMPTED: "ask again, perhaps with a greater priority",
    v1.GoalCode.CODE_APPROVAL: "`saphira goal approve ID` by a person lets it begin",
    v1.GoalCode.CODE_STOPPED: "ask again to have it done",
}


class Trouble(Exception):
    """A goal or a request was not done."""

    def __init__(
        self,
        reason: str,
        code: "v1.GoalCode | v1.AnswerCode" = v1.AnswerCode.ANSWER_REFUSED,
        remedy: "str | None" = None,
    ) -> None:
        #: in words
        self.reason = reason
        self.code = code
        #: the advice for what to do [empty: none]
        self.remedy = remedy if remedy is not None else _remedy(code)
        super().__init__(reason, code, self.remedy)

    def __str__(self) -> str:
        return self.reason + (f" ({self.remedy})" if self.remedy else "")


class Refused(Trouble):
    """Nothing was begun."""


class Failed(Trouble):
    """It was begun, and not done."""


class Canceled(Trouble):
    """Somebody ended it: its asker, a stop, or another goal."""


class Nobody(Trouble):
    """No program has answered."""


def _remedy(code: "v1.GoalCode | v1.AnswerCode") -> str:
    return _REMEDIES.get(code, "") if isinstance(code, v1.GoalCode) else ""


_OF_GOAL = {
    v1.GoalState.GOAL_REFUSED: Refused,
    v1.GoalState.GOAL_FAILED: Failed,
    v1.GoalState.GOAL_CANCELED: Canceled,
}
_OF_ANSWER = {
    v1.AnswerCode.ANSWER_REFUSED: Refused,
    v1.AnswerCode.ANSWER_UNKNOWN_FUNCTOR: Refused,
    v1.AnswerCode.ANSWER_BAD_ARGUMENT: Refused,
    v1.AnswerCode.ANSWER_NOBODY: Nobody,
}


def trouble_of_goal(status: v1.GoalStatus, advice: str) -> "Trouble | None":
    """None: it succeeded, or has not ended."""
    kind = _OF_GOAL.get(status.state)
    return None if kind is None else kind(status.reason, status.code, advice or None)


def trouble_of_answer(answer: v1.Answer) -> "Trouble | None":
    """None: it was answered, or is underway."""
    if answer.code <= v1.AnswerCode.ANSWER_SENT:
        return None
    return _OF_ANSWER.get(answer.code, Failed)(answer.text or answer.code.name, answer.code)
