"""Thumbnails: the telling frame and the picture."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh, MeshMaterial, Surface
from metagraph.motion.clip import Clip
from preview.figure import SkinnedFigure, StickFigure
from preview.thumbnail import (
    ThumbnailStyle,
    draw_clip_thumbnail,
    find_telling_frame,
    render_thumbnail,
    render_thumbnails,
)
from sample_clips.make.mannequin_skeleton import mannequin_skeleton

SKELETON = mannequin_skeleton()


def clip(angles, joint="LeftUpperArm", walk=0.0):
    rotations = np.tile(SKELETON.rest_rotations, (len(angles), 1, 1))
    rotations[:, SKELETON.index(joint)] = rotation.from_axis_angle(np.array([0.0, 0, 1]), np.array(angles))
    root = SKELETON.rest_translations[0] + np.linspace(0, walk, len(angles))[:, None, None] * [0, 0, 1.0]
    return Clip("c", SKELETON, 30, rotations, root)


def test_one_frame_is_the_telling_one():
    assert find_telling_frame(clip([0.0])) == 0


def test_the_telling_frame_is_where_the_arm_is_farthest_from_the_start():
    assert find_telling_frame(clip([0.0, 0.4, 1.2, 0.5, 0.1])) == 2


def test_walking_away_does_not_make_a_frame_telling():
    assert find_telling_frame(clip([0.0, 0.0, 0.9, 0.0, 0.0], walk=9.0)) == 2


def test_long_clips_are_looked_at_here_and_there():
    angles = np.zeros(3000)
    angles[1400:1600] = 1.0
    assert 1400 <= find_telling_frame(clip(angles)) < 1600


@pytest.mark.gl
def test_a_thumbnail_shows_the_figure_on_tinted_paper(offscreen):
    figure = StickFigure(SKELETON)
    plain = draw_clip_thumbnail(offscreen, figure, clip([0.0, 1.0]), ThumbnailStyle(40))
    tinted = draw_clip_thumbnail(
        offscreen, figure, clip([0.0, 1.0]), ThumbnailStyle(40, tint=(0.94, 0.65, 0.24))
    )
    clear = draw_clip_thumbnail(offscreen, figure, clip([0.0, 1.0]), ThumbnailStyle(40, paper=None))
    assert plain.shape == (80, 80, 4)
    assert plain[0, 0].tolist() == [28, 29, 33, 255]
    assert tinted[0, 0, 0] > tinted[0, 0, 2] + 10
    assert clear[0, 0, 3] == 0
    assert plain[..., :3].max() > 150


@pytest.mark.gl
def test_the_figure_is_seen_from_the_front_wherever_it_stands_and_faces(offscreen):
    figure = StickFigure(SKELETON)
    rotations, positions = SKELETON.globals(SKELETON.rest)
    turn = rotation.from_axis_angle(np.array([0.0, 1, 0]), np.array(2.0))
    there = rotation.rotate_vectors(turn, positions) + [7.0, 0, -3.0]
    first = render_thumbnail(offscreen, figure, rotations, positions, ThumbnailStyle(40)).astype(int)
    second = render_thumbnail(
        offscreen, figure, rotation.multiply(turn, rotations), there, ThumbnailStyle(40)
    )
    assert np.abs(first - second).mean() < 0.5


@pytest.mark.gl
def test_a_gesture_of_the_arms_is_nearer_than_a_step_and_all_its_frames_are_framed_alike(offscreen):
    def tall(picture):
        rows = np.flatnonzero(picture[..., 3].any(1))
        head = np.flatnonzero(picture[rows[0] + 2, :, 3])  # how wide the head is, two pixels below its top
        return len(head), rows[0]

    figure = StickFigure(SKELETON)
    waved, stepped = clip([0.0, 0.9, 0.0]), clip([0.0, 0.9, 0.0], "LeftUpperLeg")
    frames = np.array([0, 1, 2])
    near = [tall(p) for p in render_thumbnails(offscreen, figure, waved, frames, 96)]
    far = [tall(p) for p in render_thumbnails(offscreen, figure, stepped, frames, 96)]
    assert min(n[0] for n in near) > max(f[0] for f in far)
    assert len(set(near)) == 1, "the head stays where it is"


@pytest.mark.gl
def test_a_head_that_is_wider_than_shoulders_is_whole(offscreen):
    head, count = SKELETON.index("Head"), 12
    _, rest = SKELETON.globals(SKELETON.rest)
    ring = np.linspace(0, 2 * np.pi, count, endpoint=False)
    points = rest[head] + np.stack([0.7 * np.cos(ring), 0.1 + 0.2 * np.sin(ring), 0 * ring], 1)
    wide = CharacterMesh(
        "wide",
        SKELETON,
        points,
        np.tile([0.0, 0, 1], (count, 1)),
        np.zeros((count, 2)),
        np.tile([head, 0, 0, 0], (count, 1)),
        np.tile([1.0, 0, 0, 0], (count, 1)),
        np.array([[0, n, n + 1] for n in range(1, count - 1)]),
        (MeshMaterial("m"),),
        (Surface(0, count - 2, 0),),
    )
    (picture,) = render_thumbnails(
        offscreen, SkinnedFigure(wide), clip([0.0, 0.4], "Head"), np.array([0]), 96
    )
    seen = np.flatnonzero(picture[..., 3].any(0))
    assert seen[0] > 0 and seen[-1] < 95 and seen[-1] - seen[0] > 60
