"""What a program can be asked for: functions, by their types and docstrings."""

import asyncio
import dataclasses
import inspect
import traceback
from collections.abc import Callable, Mapping
from typing import Annotated, Any, Literal, get_args, get_origin, get_type_hints

from . import v1
from ._errors import Trouble
from ._values import Point, arguments, values

_KINDS = {
    str: v1.ArgumentKind.ARGUMENT_TEXT,
    float: v1.ArgumentKind.ARGUMENT_NUMBER,
    int: v1.ArgumentKind.ARGUMENT_NUMBER,
    bool: v1.ArgumentKind.ARGUMENT_TRUTH,
    Point: v1.ArgumentKind.ARGUMENT_POINT,
}


def _parameter(name: str, hint: Any, required: bool) -> v1.CapabilityParameter:
    made = v1.CapabilityParameter(name=name, required=required)
    if get_origin(hint) is Annotated:
        hint, *notes = get_args(hint)
        for note in notes:
            if isinstance(note, str):
                made.meaning = note
            else:
                made.low, made.high = note
    if get_origin(hint) is Literal:
        made.choices = [str(choice) for choice in get_args(hint)]
        hint = str
    if hint not in _KINDS:
        raise TypeError(f"{name}: expected str, float, int, bool, Point or Literal, found {hint}")
    made.kind = _KINDS[hint]
    if hint is Point:
        made.frame = v1.Frame.FRAME_ODOM
    return made


def capability_of(function: Callable[..., Any], name: str, acts: bool) -> v1.Capability:
    """TypeError names a parameter that no request can give."""
    hints = get_type_hints(function, include_extras=True)
    summary = (inspect.getdoc(function) or "").split("\n")[0]
    made = v1.Capability(functor=name or function.__name__, summary=summary, acts=acts)
    for parameter in inspect.signature(function).parameters.values():
        required = parameter.default is inspect.Parameter.empty
        if parameter.name not in hints:
            raise TypeError(f"{parameter.name}: expected a type, found none")
        made.parameters.append(_parameter(parameter.name, hints[parameter.name], required))
    result = hints.get("return")
    slots = getattr(result, "__annotations__", {}) if isinstance(result, type) else {}
    if slots:
        for slot, hint in get_type_hints(result, include_extras=True).items():
            if slot not in hints:
                made.parameters.append(_parameter(slot, hint, False))
    return made


def _given(function: Callable[..., Any], request: v1.Request) -> dict[str, Any]:
    hints = get_type_hints(function)
    given: dict[str, Any] = {}
    bound = [each for each in request.arguments if each.kind != v1.ArgumentKind.ARGUMENT_UNBOUND]
    for name, value in values(bound).items():
        if name in inspect.signature(function).parameters:
            given[name] = int(value) if hints[name] is int else value  # type: ignore[arg-type]
    return given


def _answer(result: Any) -> v1.Answer:
    made = v1.Answer(code=v1.AnswerCode.ANSWER_DONE)
    if isinstance(result, str):
        made.text = result
    elif isinstance(result, Mapping):
        made.results = arguments(result)
    elif dataclasses.is_dataclass(result):
        names = [field.name for field in dataclasses.fields(result)]
        made.results = arguments({name: getattr(result, name) for name in names})
    elif hasattr(result, "_asdict"):
        made.results = arguments(result._asdict())
    elif result is not None:
        raise TypeError(f"expected values by name, a str or None, found {result!r}")
    return made


def _refusal(functor: str, error: Exception) -> v1.Answer:
    if isinstance(error, Trouble):
        code = error.code
        if not isinstance(code, v1.AnswerCode):
            code = v1.AnswerCode.ANSWER_REFUSED
        return v1.Answer(code=code, text=str(error).replace("\0", "\\0"))
    traceback.print_exception(error)
    text = f"{functor} has failed: {type(error).__name__}: {error}".replace("\0", "\\0")
    return v1.Answer(code=v1.AnswerCode.ANSWER_REFUSED, text=text)


class Served:
    """The functions that a program can be asked for, and what it is at work on."""

    def __init__(self, answer: Callable[[v1.Request, v1.Answer], None]) -> None:
        self._functions: dict[str, Callable[..., Any]] = {}
        self._tasks: dict[tuple[int, int], asyncio.Task[Any]] = {}
        self._answer = answer

    def add(self, functor: str, function: Callable[..., Any]) -> None:
        self._functions[functor] = function

    def handle(self, request: v1.Request) -> None:
        key = (request.asker, request.number)
        if request.functor not in self._functions:  # it is withdrawn
            if key in self._tasks:
                self._tasks[key].cancel()
            return
        function = self._functions[request.functor]
        try:
            given = _given(function, request)
            inspect.signature(function).bind(**given)
        except (TypeError, ValueError) as error:
            wrong = v1.Answer(code=v1.AnswerCode.ANSWER_BAD_ARGUMENT, text=str(error))
            self._give(request, wrong)
            return
        if inspect.iscoroutinefunction(function):
            try:
                loop = asyncio.get_running_loop()
            except RuntimeError:
                text = f"{request.functor} is an async function, and its program runs no asyncio"
                self._give(request, v1.Answer(code=v1.AnswerCode.ANSWER_REFUSED, text=text))
                return
            task = loop.create_task(self._work(request, function, given))
            self._tasks[key] = task
            task.add_done_callback(lambda _: self._tasks.pop(key, None))
            return
        try:
            answer = _answer(function(**given))
        except Exception as error:
            answer = _refusal(request.functor, error)
        self._give(request, answer)

    async def _work(
        self, request: v1.Request, function: Callable[..., Any], given: dict[str, Any]
    ) -> None:
        try:
            answer = _answer(await function(**given))
        except Exception as error:
            answer = _refusal(request.functor, error)
        except asyncio.CancelledError:
            withdrawn = v1.Answer(code=v1.AnswerCode.ANSWER_REFUSED, text="withdrawn")
            self._give(request, withdrawn)
            raise
        self._give(request, answer)

    def _give(self, request: v1.Request, answer: v1.Answer) -> None:
        try:
            self._answer(request, answer)
        except ValueError as error:  # such as a text with a zero character
            self._answer(request, _refusal(request.functor, error))
