"""Frames of the arrays."""

import math

import pytest

from saphira import v1

np = pytest.importorskip("numpy")

from saphira import arrays  # noqa: E402

UP = math.pi / 2


def test_echoes_are_in_odom() -> None:
    heard = v1.SonarBucket(
        reading=v1.SonarReading(echo=True), pose_in_odom=v1.Pose2(10.0, 20.0, UP), x=1.0, y=0.5
    )
    silent = v1.SonarBucket(reading=v1.SonarReading(echo=False), x=9.0)
    points = arrays.echoes(v1.SonarBuckets(buckets=[heard, silent]))
    assert np.allclose(points, [(9.5, 21.0)])
    assert arrays.echoes(v1.SonarBuckets()).shape == (0, 2)


def test_points_of_odom_are_placed_on_the_map() -> None:
    registration = v1.Registration(odom_in_map=v1.Pose2(3.0, 4.0, UP))
    assert np.allclose(arrays.in_map(np.array([(1.0, 0.0)]), registration), [(3.0, 5.0)])


def test_an_outline_follows_the_heading() -> None:
    artifact = v1.MapArtifact(pose_in_map=v1.Pose2(0.0, 0.0, UP), length=4.0, width=2.0)
    corners = arrays.outline(artifact)
    assert np.allclose(corners[0], (-1.0, 2.0)) and np.allclose(corners[0], corners[-1])
