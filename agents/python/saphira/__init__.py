"""Agents for Saphira robots.

    import saphira

    robot = saphira.connect()
    robot.go("N2").wait()

With asyncio, `await robot.go("N2")`. docs/python.md has the rest.
"""

from . import topics, v1
from ._bus import version
from ._drive import Drive
from ._errors import Canceled, Failed, Nobody, Refused, Trouble
from ._robot import Answer, Call, Goal, Robot, Trigger, Writer, call, connect
from ._values import OPEN, Open, Point
from ._waiting import Pending, Stream
from ._why import Cause, Explanation

__version__ = version.split()[1].rstrip(",")
__all__ = [
    "OPEN", "Answer", "Call", "Canceled", "Cause", "Drive", "Explanation", "Failed", "Goal",
    "Nobody", "Open", "Pending", "Point", "Refused", "Robot", "Stream", "Trigger", "Trouble",
    "Writer", "call", "connect", "topics", "v1",
]  # fmt: skip
