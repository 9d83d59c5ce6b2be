"""What the robot senses and knows as arrays of numpy, for computing and plotting. Lengths in m."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import v1

Array = NDArray[np.float64]

_NEVER_SEEN = 255
_CERTAIN = 200.0


def _placed(points: Array, pose: v1.Pose2) -> Array:
    """Points of the frame that has this pose, in the frame of the pose."""
    cos, sin = np.cos(pose.th), np.sin(pose.th)
    turn = np.array([(cos, -sin), (sin, cos)], dtype=np.float64)
    placed: Array = points @ turn.T + (pose.x, pose.y)
    return placed


def echoes(sonars: v1.SonarBuckets) -> Array:
    """The points of the newest echoes in odom: a row (x, y) for each sonar that has one."""
    heard = [each for each in sonars.buckets if each.reading.echo]
    rows = [_placed(np.array([(each.x, each.y)]), each.pose_in_odom)[0] for each in heard]
    return np.array(rows, dtype=np.float64).reshape(-1, 2)


def outline(artifact: v1.MapArtifact) -> Array:
    """Its corners on the map, the first one again at the end: rows (x, y), ready to be plotted."""
    sides = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1), (1, 1)], dtype=np.float64)
    return _placed(sides * (artifact.length / 2, artifact.width / 2), artifact.pose_in_map)


def in_map(points: Array, registration: v1.Registration) -> Array:
    """Points of odom, rows (x, y), on the map."""
    return _placed(points, registration.odom_in_map)


@dataclass(frozen=True)
class Grid:
    """The occupancy grid in odom."""

    #: probability that a cell is occupied [NaN: never seen]; rows from the smallest y
    occupied: Array
    #: [m] the edge of a cell
    resolution: float
    #: (x, y) of the corner with the smallest of both
    origin: tuple[float, float]

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """As matplotlib's imshow takes it, with origin="lower"."""
        rows, columns = self.occupied.shape
        x, y = self.origin
        return x, x + columns * self.resolution, y, y + rows * self.resolution


def grid(tiles: "list[v1.GridTile]") -> Grid:
    """ValueError: there are no tiles."""
    if not tiles:
        raise ValueError("a grid has at least one tile")
    side, resolution = tiles[0].side, tiles[0].resolution
    left, bottom = min(each.column for each in tiles), min(each.row for each in tiles)
    columns = max(each.column for each in tiles) - left + 1
    rows = max(each.row for each in tiles) - bottom + 1
    cells = np.full((rows * side, columns * side), _NEVER_SEEN, dtype=np.uint8)
    for each in tiles:
        y, x = (each.row - bottom) * side, (each.column - left) * side
        cells[y : y + side, x : x + side] = np.frombuffer(each.cells, np.uint8).reshape(side, side)
    occupied = np.where(cells == _NEVER_SEEN, np.nan, cells / _CERTAIN)
    size = side * resolution
    return Grid(occupied, resolution, (left * size, bottom * size))
