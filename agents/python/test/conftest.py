"""A simulated robot with its services, on a bus of its own."""

import fcntl
import os
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import saphira

PROGRAMS = Path(os.environ["SAPHIRA_BIN_DIR"])


def reserve_domain() -> Any:
    """A domain that no other test uses, as tests/support/live_main.cpp does it."""
    folder = Path("/tmp/saphira-test-domains")
    folder.mkdir(mode=0o777, exist_ok=True)
    for i in range(80):
        domain = 20 + (os.getpid() + i) % 80
        file = open(folder / str(domain), "a")
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            continue
        os.environ["SAPHIRA_DOMAIN"] = str(domain)
        os.set_inheritable(file.fileno(), True)
        return file
    raise RuntimeError("every domain for tests is taken")


@pytest.fixture(scope="session")
def bus(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The bus of these tests, without a program on it."""
    folder = tmp_path_factory.mktemp("run")
    lock = None if "SAPHIRA_DOMAIN" in os.environ else reserve_domain()
    os.environ["SAPHIRA_ROBOT"] = f"t{os.getpid()}"
    os.environ["SAPHIRA_RUN"] = str(folder)
    yield folder
    if lock is not None:
        lock.close()


@pytest.fixture(scope="session")
def programs(bus: Path) -> Iterator[None]:
    """The robot in the small office, and the facilitator."""
    commands: list[list[Any]] = [
        [PROGRAMS / "saphira-all", "--world", "small-office", "--map", "small-office",
         "--socket", bus / "robot", "--camera-socket", bus / "camera"],
        [PROGRAMS / "saphira-camera", "--socket", bus / "camera"],
        [PROGRAMS / "saphira-facilitator"],
    ]  # fmt: skip
    log = open(bus / "log", "w")
    started = [subprocess.Popen(command, stdout=log, stderr=log) for command in commands]
    with saphira.connect("fixture") as robot:
        next(robot.state())
        robot.ask("live-triggers", deadline=60).wait()
    yield
    for program in started:
        program.terminate()
    for program in started:
        assert program.wait(30) == 0, (bus / "log").read_text()[-2000:]


@pytest.fixture
def robot(programs: None) -> Iterator[saphira.Robot]:
    with saphira.connect("test") as robot:
        yield robot


def until(true: Callable[[], bool]) -> None:
    """Waits for a condition; a minute is far more than it needs."""
    end = time.monotonic() + 60
    while not true():
        assert time.monotonic() < end
        time.sleep(0.01)
