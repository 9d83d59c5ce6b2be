"""Driving the wheels, as a program (role direct)."""

import math
import time

from . import _bus, v1
from ._errors import Canceled, Refused
from ._waiting import Context, Pending, Waiter

_PERIOD = 0.05  # [s]; the bridge's lease is 0.3 s
_PATIENCE = 1.0  # [s] until commands are heeded


class Drive(Context):
    """The wheels, until its context ends: `with robot.drive() as wheels`, or `async with`.

    The robot stops 0.3 s after the newest command, so a program that hangs does not drive on.
    """

    def __init__(self, driver: _bus.Driver, waiter: Waiter) -> None:
        self._driver = driver
        self._waiter = waiter

    def send(self, speed: float = 0.0, turn: float = 0.0) -> None:
        """One command: [m/s] forward, [rad/s] to the left. At least five a second keep it moving.

        Canceled: somebody has stopped the robot.
        """
        if not (math.isfinite(speed) and math.isfinite(turn)):
            raise ValueError(f"speed and turn: expected finite numbers, found {speed}, {turn}")
        self._expect_no_stop()
        command = v1.MotorCommand(
            active=True,
            translation=v1.TranslationMode.TRANSLATION_VELOCITY,
            velocity=speed,
            rotation=v1.RotationMode.ROTATION_VELOCITY,
            rotation_velocity=turn,
        )
        self._driver.drive(command)

    def _expect_no_stop(self) -> None:
        self._driver.poll()
        if self._driver.stopped_by():
            reason = "stopped by " + self._driver.stopped_by()
            raise Canceled(reason, v1.GoalCode.CODE_STOPPED)

    def go(self, speed: float = 0.0, turn: float = 0.0, *, seconds: float) -> Pending[None]:
        """Drives while it is waited for, so long from when it is let. Refused: others drive, or nobody
        may.
        """
        if not seconds >= 0.0:
            raise ValueError(f"seconds: expected 0 or more, found {seconds}")
        return Pending(self._waiter, lambda: self._go(speed, turn, seconds))

    @property
    def drives(self) -> bool:
        """True where its commands go to the wheels."""
        self._driver.poll()
        return self._driver.drives()

    @property
    def trouble(self) -> str:
        """In words: another driver, a refusal, what the guard does [empty: none]."""
        self._driver.poll()
        return self._driver.trouble()

    async def _go(self, speed: float, turn: float, seconds: float) -> None:
        heeded = time.monotonic()  # the newest moment in which its commands were
        end: "float | None" = None  # from the first such moment on
        while end is None or time.monotonic() < end:
            self.send(speed, turn)
            now = time.monotonic()
            if self.drives:
                heeded = now
                end = now + seconds if end is None else end
            elif now > heeded + _PATIENCE and (trouble := self.trouble):
                self._expect_no_stop()  # it may have come just now
                raise Refused(trouble, v1.GoalCode.CODE_PREEMPTED, "")
            due = now + _PERIOD
            while (left := due - time.monotonic()) > 0:
                await self._waiter.news(left)

    def close(self) -> None:
        """Lets go, which stops the robot."""
        self._driver.release()
        self._driver.close()
