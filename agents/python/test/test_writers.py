"""What a program has declared lasts as long as its robot, whoever keeps the writer."""

import gc
import weakref
from typing import Any

import saphira
from saphira import topics, v1


class FakeWriter:
    def __init__(self) -> None:
        self.written: list[Any] = []

    def matched(self) -> int:
        return 1

    def write(self, sample: Any) -> bool:
        self.written.append(sample)
        return True


class FakeBus:
    """Each utterance is answered at once."""

    def __init__(self) -> None:
        self.made: list["weakref.ref[FakeWriter]"] = []

    def writer(self, topic: str) -> FakeWriter:
        made = FakeWriter()
        self.made.append(weakref.ref(made))
        return made

    def reader(self, topic: str) -> "FakeBus":
        return self

    def take(self) -> list[Any]:
        writer = self.made[-1]()
        written = writer.written if writer is not None else []
        return [
            (v1.Utterance(answers=words.id, text="yes", end=True), False, None, 0.0)
            for words in written
        ]

    def wait(self, seconds: float) -> bool:
        return True

    def poll(self) -> None:
        pass

    def answers(self) -> list[v1.Answer]:
        return []

    def requests(self) -> list[v1.Request]:
        return []

    def answer(self, request: v1.Request, answer: v1.Answer) -> None:
        raise AssertionError

    def instance(self) -> int:
        return 1

    def name(self) -> str:
        return "test"

    def close(self) -> None:
        pass


def test_a_writer_that_nobody_keeps_withdraws_nothing() -> None:
    bus: Any = FakeBus()
    robot = saphira.Robot(bus)
    robot.writer(topics.KNOWS).write(v1.Knowledge())
    robot.writer(topics.KNOWS).write(v1.Knowledge())
    gc.collect()
    (only,) = bus.made
    assert len(only().written) == 2
    del robot
    gc.collect()
    assert only() is None


def test_what_words_have_begun_goes_on_after_the_reply() -> None:
    bus: Any = FakeBus()
    robot = saphira.Robot(bus)
    assert robot.say("Flakey, go to N2").wait() == "yes"
    gc.collect()
    (only,) = bus.made
    assert only() is not None
