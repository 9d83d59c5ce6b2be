"""The programs of docs/python.md, typed as they stand there, each beside a robot of its own world."""

import contextlib
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import saphira

PAGE = (Path(os.environ["SAPHIRA_SOURCE_DIR"]) / "docs" / "python.md").read_text()
PROGRAMS = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)


def test_the_first_agent_has_at_most_ten_lines() -> None:
    assert len(PROGRAMS[0].splitlines()) <= 10


def run(text: str, folder: Path) -> str:
    (folder / "program.py").write_text(text)
    done = subprocess.run(
        [sys.executable, "program.py"], cwd=folder, capture_output=True, text=True, timeout=200
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_first_agent_drives(programs: None, tmp_path: Path) -> None:
    """To places of the small office: those of the page are of the demo's."""
    said = run(PROGRAMS[0].replace('["N2", "S3"]', '["start", "nowhere"]'), tmp_path)
    assert "reached start\n" in said
    assert re.search("nowhere not reached: .*nowhere", said)


def test_the_program_with_asyncio_drives(programs: None, tmp_path: Path) -> None:
    said = run(PROGRAMS[1].replace("N2", "D").replace("battery < 20", "battery < 99"), tmp_path)
    assert said.endswith("GOAL_SUCCEEDED 100% \n")


def test_the_calendar_is_asked(robot: saphira.Robot, tmp_path: Path) -> None:
    (tmp_path / "calendar_agent.py").write_text(PROGRAMS[2])
    program = subprocess.Popen([sys.executable, "calendar_agent.py"], cwd=tmp_path)
    try:
        answer = None
        while answer is None:  # until the facilitator has heard of the agent
            assert program.poll() is None
            with contextlib.suppress(saphira.Nobody):
                answer = robot.ask("place_of", person="karen", of="calendar").wait()
        assert answer["place"] == "library"
        program.send_signal(signal.SIGINT)
        assert program.wait(30) == 0
    finally:
        program.kill()


def test_the_driver_turns_and_lets_go(robot: saphira.Robot, tmp_path: Path) -> None:
    before = next(robot.state()).pose_in_odom.th
    run(PROGRAMS[3], tmp_path)
    assert abs(next(robot.state()).pose_in_odom.th - before) > 0.2
