"""Functions become what a program can be asked for."""

import asyncio
from dataclasses import dataclass
from typing import Annotated, Any, Literal, TypedDict

import pytest
import saphira
from saphira import v1
from saphira._agent import Served, capability_of
from saphira._values import arguments


class Place(TypedDict):
    place: str


@dataclass
class Found:
    x: float
    person: str


def test_types_and_docstring_declare_a_capability() -> None:
    def seek(
        person: str,
        speed: Annotated[float, "how fast [m/s]", (0.1, 1.0)],
        side: Literal["left", "right"],
        near: saphira.Point,
        often: int = 1,
        loudly: bool = False,
    ) -> Found:
        """Looks for a person.

        Room by room.
        """
        raise NotImplementedError

    made = capability_of(seek, "", acts=True)
    assert (made.functor, made.summary, made.acts) == ("seek", "Looks for a person.", True)
    kinds = v1.ArgumentKind
    assert [(each.name, each.kind, each.required) for each in made.parameters] == [
        ("person", kinds.ARGUMENT_TEXT, True),
        ("speed", kinds.ARGUMENT_NUMBER, True),
        ("side", kinds.ARGUMENT_TEXT, True),
        ("near", kinds.ARGUMENT_POINT, True),
        ("often", kinds.ARGUMENT_NUMBER, False),
        ("loudly", kinds.ARGUMENT_TRUTH, False),
        ("x", kinds.ARGUMENT_NUMBER, False),
    ]
    speed, side = made.parameters[1:3]
    assert (speed.meaning, speed.low, speed.high) == ("how fast [m/s]", 0.1, 1.0)
    assert side.choices == ["left", "right"]


def test_a_parameter_that_no_request_can_give_is_refused() -> None:
    def of_bytes(what: bytes) -> None: ...

    with pytest.raises(TypeError, match="what: expected str"):
        capability_of(of_bytes, "", acts=False)

    untyped: Any = lambda what: None  # noqa: E731
    with pytest.raises(TypeError, match="what: expected a type"):
        capability_of(untyped, "", acts=False)


def asked(function: Any, **slots: Any) -> v1.Answer:
    """The answer of a function to a request."""
    answers: list[v1.Answer] = []
    served = Served(lambda request, answer: answers.append(answer))
    served.add("f", function)
    served.handle(v1.Request(functor="f", arguments=arguments(slots)))
    return answers[0]


def test_answers_are_values_by_name_or_a_text() -> None:
    def place_of(person: str) -> Place:
        return {"place": "library of " + person}

    answer = asked(place_of, person="karen", place=saphira.OPEN)
    assert answer.code == v1.AnswerCode.ANSWER_DONE
    assert answer.results == arguments({"place": "library of karen"})
    assert asked(lambda: "hello").text == "hello"
    assert asked(lambda: Found(1.0, "ann")).results == arguments({"x": 1.0, "person": "ann"})
    assert asked(lambda: None).code == v1.AnswerCode.ANSWER_DONE


def test_what_fails_is_refused_and_harms_nothing() -> None:
    def wrong(person: str) -> None:
        raise saphira.Refused("no " + person)

    def broken() -> None:
        raise KeyError("karen")

    assert asked(wrong, person="ann").text == "no ann"
    assert asked(wrong).code == v1.AnswerCode.ANSWER_BAD_ARGUMENT
    failed = asked(broken)
    assert failed.code == v1.AnswerCode.ANSWER_REFUSED
    assert "KeyError" in failed.text
    assert asked(lambda: 3).code == v1.AnswerCode.ANSWER_REFUSED


def test_an_answer_that_the_bus_does_not_take_is_a_refusal() -> None:
    answers: list[v1.Answer] = []

    def take(_: v1.Request, answer: v1.Answer) -> None:
        if "\0" in answer.text:
            raise ValueError("Answer.text: found a zero\0 character")
        answers.append(answer)

    served = Served(take)
    served.add("f", lambda: "a\0b")
    served.handle(v1.Request(functor="f"))
    assert [answer.code for answer in answers] == [v1.AnswerCode.ANSWER_REFUSED]


def test_an_async_function_needs_asyncio() -> None:
    async def slow() -> None: ...

    assert asked(slow).code == v1.AnswerCode.ANSWER_REFUSED


def test_a_withdrawn_request_cancels_its_function() -> None:
    said: list[str] = []
    answers: list[v1.Answer] = []

    async def fetch() -> None:
        try:
            await asyncio.sleep(3600)
        finally:
            said.append("put down")

    async def main() -> None:
        served = Served(lambda request, answer: answers.append(answer))
        served.add("fetch", fetch)
        served.handle(v1.Request(asker=1, number=2, functor="fetch"))
        await asyncio.sleep(0)
        served.handle(v1.Request(asker=1, number=2, functor="withdraw"))
        while not answers:
            await asyncio.sleep(0)

    asyncio.run(main())
    assert said == ["put down"]
    assert answers[0].code == v1.AnswerCode.ANSWER_REFUSED
