"""Words and triggers. The test is the robot's dialogue, and hears what others would."""

import asyncio
from collections.abc import Callable, Coroutine, Iterator
from pathlib import Path
from typing import Any

import pytest
import saphira
from saphira import topics, v1


@pytest.fixture
def robot(bus: Path) -> Iterator[saphira.Robot]:
    with saphira.connect("test") as robot:
        yield robot


@pytest.fixture
def dialogue(bus: Path) -> Iterator[saphira.Robot]:
    with saphira.connect("dialogue") as dialogue:
        yield dialogue


def with_replies(
    dialogue: saphira.Robot,
    replies: list[v1.Utterance],
    work: Callable[[], Coroutine[Any, Any, None]],
) -> v1.Utterance:
    """Answers the next words; returns them."""
    said = dialogue._bus.writer(topics.SAID.name)

    async def main() -> v1.Utterance:
        heard = dialogue.watch(topics.HEARD)
        task = asyncio.create_task(work())
        words = await heard.__anext__()
        while said.matched() == 0:
            await dialogue._waiter.news(0.1)
        said.write(v1.Utterance(answers=v1.GoalId(1, 1), text="to others", end=True))
        for reply in replies:
            reply.answers = words.id
            said.write(reply)
        await task
        return words

    return asyncio.run(main())


def test_says_a_sentence_and_gives_the_whole_reply(
    robot: saphira.Robot, dialogue: saphira.Robot
) -> None:
    async def work() -> None:
        assert await robot.say("Flakey, this is N2", speaker="karen") == "yes so noted"

    words = with_replies(
        dialogue, [v1.Utterance(text="yes"), v1.Utterance(text="so noted", end=True)], work
    )
    assert (words.text, words.speaker) == ("Flakey, this is N2", "karen")
    assert words.means == v1.UtteranceMeans.UTTERANCE_PROGRAM


def test_a_refused_sentence_is_an_exception(robot: saphira.Robot, dialogue: saphira.Robot) -> None:
    async def work() -> None:
        with pytest.raises(saphira.Refused, match="no coffee here"):
            await robot.say("Flakey, make coffee")

    words = with_replies(
        dialogue, [v1.Utterance(text="no coffee here", end=True, refused=True)], work
    )
    assert words.speaker == "test"


def test_without_a_dialogue_nobody_answers(robot: saphira.Robot) -> None:
    with pytest.raises(saphira.Nobody) as error:
        robot.say("Flakey, hello").wait()
    assert error.value.code == v1.AnswerCode.ANSWER_NOBODY


def test_knows_what_people_have_said(robot: saphira.Robot, dialogue: saphira.Robot) -> None:
    known = v1.Knowledge(known=[v1.Advice(number=3, functor="office_of", speaker="karen")])
    facts = dialogue.writer(topics.KNOWS)
    facts.write(known)
    assert robot.knows.wait() == known


def test_triggers_say_what_they_were_given(robot: saphira.Robot, dialogue: saphira.Robot) -> None:
    place = saphira.call("place_of", person="karen", place=saphira.OPEN)
    patrol = saphira.call("patrol", place=saphira.OPEN)
    every = robot.every(60.0, saphira.call("patrol", rounds=2.0), times=3)
    when = robot.when(place, patrol, period=5.0)
    triggers = dialogue._bus.reader(topics.TRIGGERS.name)
    heard: dict[int, v1.Trigger] = {}
    gone: set[int] = set()

    def hear(until: Callable[[], bool]) -> None:
        async def news() -> None:
            while not until():
                await dialogue._waiter.news(0.2)
                for sample, withdrawn, _, _ in triggers.take():
                    assert isinstance(sample, v1.Trigger)
                    if withdrawn:
                        gone.add(sample.id.number)
                    else:
                        heard[sample.id.number] = sample

        asyncio.run(news())

    hear(lambda: len(heard) == 2)
    timed = heard[every.id.number]
    assert (timed.kind, timed.period, timed.times) == (v1.TriggerKind.TRIGGER_TIME, 60.0, 3)
    assert (timed.condition, timed.action, timed.source) == ("", "patrol", "test")
    assert [(each.name, each.number) for each in timed.action_arguments] == [("rounds", 2.0)]
    data = heard[when.id.number]
    assert (data.kind, data.period, data.times) == (v1.TriggerKind.TRIGGER_DATA, 5.0, 0)
    assert (data.condition, data.action) == ("place_of", "patrol")
    assert [(each.name, each.text) for each in data.condition_arguments][0] == ("person", "karen")
    unbound = v1.ArgumentKind.ARGUMENT_UNBOUND
    assert [each.kind for each in data.action_arguments] == [unbound]
    every.withdraw()
    hear(lambda: bool(gone))
    assert gone == {every.id.number}
