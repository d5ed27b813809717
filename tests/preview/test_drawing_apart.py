"""Pictures drawn in other processes."""

from __future__ import annotations

import itertools
import time

import numpy as np
import pytest

from metagraph.common.child_channel import Child
from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose
from preview import drawing_apart
from preview.camera import make_whole_figure_camera
from preview.drawing_apart import WORTH_LEVELS, draw_scenes
from preview.figure import SkinnedFigure, StickFigure
from preview.offscreen import Offscreen
from preview.scene import DARK, Actor, Scene
from sample_clips.make.mannequin_skeleton import mannequin_skeleton
from tests.preview.conftest import chain

SIZE = (96, 72)
COUNT = 60

pytestmark = pytest.mark.gl


def waving(figure, count=COUNT):
    """Somebody who turns one joint a little more in each picture."""
    skeleton = figure.skeleton
    for n in range(count):
        turns = skeleton.rest_rotations.copy()
        turns[1] = rotation.multiply(turns[1], rotation.from_axis_angle(np.array([0.0, 0, 1]), n / count))
        actor = Actor(figure, *skeleton.globals(Pose(turns, skeleton.rest_translations)))
        yield Scene((actor,)), make_whole_figure_camera(Scene((actor,)).bounds(), SIZE[0] / SIZE[1])


@pytest.fixture
def children(monkeypatch):
    """The processes that are started."""
    made: list[Child] = []

    def child(*words: str) -> Child:
        made.append(Child(*words))
        return made[-1]

    monkeypatch.setattr(drawing_apart, "Child", child)
    return made


@pytest.mark.nightly
def test_pictures_are_the_same_and_in_order_wherever_they_are_drawn(offscreen, mannequin, monkeypatch):
    """As many as it takes until others have drawn some."""
    scenes = list(waving(SkinnedFigure(mannequin)))
    here = [offscreen.render(scene, camera, DARK, SIZE).copy() for scene, camera in scenes]
    drawn_here = []
    render = Offscreen.render
    monkeypatch.setattr(Offscreen, "render", lambda *a, **k: drawn_here.append(1) or render(*a, **k))
    pictures = draw_scenes(itertools.cycle(scenes), COUNT, SIZE, DARK, processes=2)
    for n, picture in enumerate(pictures):
        np.testing.assert_array_equal(picture, here[n % COUNT])
        if n + 1 - len(drawn_here) >= COUNT:
            break
        time.sleep(0.002)
    pictures.close()
    assert any(not np.array_equal(here[0], other) for other in here)


@pytest.mark.nightly
def test_all_come_in_one_array_for_who_asks_so(offscreen):
    into = np.zeros((SIZE[1], SIZE[0], 4), np.uint8)
    figure = StickFigure(mannequin_skeleton())
    sums = []
    for picture in draw_scenes(waving(figure), COUNT, SIZE, DARK, into, processes=1):
        assert picture is into
        sums.append(int(picture.astype(int).sum()))
    expected = [int(p.astype(int).sum()) for p in draw_scenes(waving(figure), COUNT, SIZE, DARK, processes=0)]
    assert sums == expected


@pytest.mark.nightly
def test_processes_that_end_leave_no_hole(offscreen, children):
    scenes = list(waving(StickFigure(mannequin_skeleton())))
    here = [offscreen.render(scene, camera, DARK, SIZE).copy() for scene, camera in scenes]
    killed: dict[int, int] = {}
    for n, picture in enumerate(draw_scenes(itertools.cycle(scenes), COUNT, SIZE, DARK, processes=2)):
        np.testing.assert_array_equal(picture, here[n % COUNT])
        if not killed and n >= 100:
            for child in children:
                child.process.terminate()
                killed[child.process.pid] = n
        if killed and n > max(killed.values()) + COUNT:
            break
        time.sleep(0.005)
    assert killed


@pytest.mark.nightly
def test_who_comes_in_later_is_drawn_as_well(offscreen):
    figure, other = StickFigure(mannequin_skeleton()), StickFigure(chain("a", "b", "c"))
    scenes = [*waving(figure, 40), *waving(other, 40)]
    here = list(draw_scenes(iter(scenes), 80, SIZE, DARK, processes=0))
    apart = list(draw_scenes(iter(scenes), 80, SIZE, DARK, processes=1))
    for one, two in zip(here, apart, strict=True):
        np.testing.assert_array_equal(one, two)


@pytest.mark.nightly
def test_who_stops_early_leaves_no_process(offscreen, children):
    figure = StickFigure(chain("a", "b", "c"))
    pictures = draw_scenes(waving(figure, 500), 500, SIZE, DARK, processes=1)
    for _ in range(50):
        next(pictures)
    pictures.close()
    assert [child.process.poll() is not None for child in children] == [True]


def test_no_scenes_are_no_pictures(offscreen):
    assert list(draw_scenes(iter(()), 0, SIZE, DARK, processes=1)) == []


@pytest.mark.nightly
def test_of_many_pictures_figures_have_levels_of_detail_and_of_few_they_have_none(mannequin):
    for count, made in ((WORTH_LEVELS - 1, False), (WORTH_LEVELS, True)):
        figure = SkinnedFigure(mannequin)
        pictures = draw_scenes(waving(figure), count, SIZE, DARK, processes=0)
        next(pictures)
        pictures.close()
        assert bool(figure.levels) == made
