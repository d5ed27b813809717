"""Which figure draws the character, made on a thread; and thumbnails from the other process."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.figures import Figures
from app.stage.session import StageSession
from app.stage.thumbnails import Thumbnails
from metagraph.graph import edits
from preview.default_body.figure import DefaultBody
from preview.figure import SkinnedFigure, StickFigure

MANNEQUIN = Path(__file__).resolve().parents[3] / "sample_clips" / "mannequin.glb"


@pytest.fixture
def document(qapp):
    document = Document()
    yield document
    document.close_journal()


@pytest.fixture
def figures(document):
    jobs = Jobs()
    yield Figures(document, jobs)
    jobs.stop()


def test_a_skeleton_without_a_character_is_drawn_as_the_default_body_once_it_is_built(
    document, figures, toy, qtbot
):
    document.load(toy.project(), None)
    told = []
    figures.changed.connect(lambda: told.append(True))
    assert figures.figure(toy.skeleton) is None, "the window does not wait"
    qtbot.waitUntil(lambda: figures.figure(toy.skeleton) is not None)
    assert isinstance(figures.figure(toy.skeleton), DefaultBody)
    assert len(told) == 1


def test_the_projects_character_is_drawn_on_the_projects_skeleton_alone(
    document, figures, sample, toy, qtbot
):
    document.load(replace(sample, character=str(MANNEQUIN)), None)
    qtbot.waitUntil(lambda: figures.figure(sample.skeleton) is not None)
    assert isinstance(figures.figure(sample.skeleton), SkinnedFigure)
    figures.figure(toy.skeleton)
    qtbot.waitUntil(lambda: figures.figure(toy.skeleton) is not None)
    assert isinstance(figures.figure(toy.skeleton), DefaultBody)
    document.edit("Draw the default body", lambda p: edits.set_character(p, None))
    figures.figure(sample.skeleton)
    qtbot.waitUntil(lambda: isinstance(figures.figure(sample.skeleton), DefaultBody))
    document.undo()
    qtbot.waitUntil(lambda: isinstance(figures.figure(sample.skeleton), SkinnedFigure))


def test_the_choice_of_sticks_redraws_what_has_no_mesh(document, toy, qtbot):
    session, jobs = StageSession(document), Jobs()
    figures = Figures(document, jobs, session.watch)
    document.load(toy.project(), None)
    figures.figure(toy.skeleton)
    qtbot.waitUntil(lambda: isinstance(figures.figure(toy.skeleton), DefaultBody))
    session.watch.set(sticks=True)
    qtbot.waitUntil(lambda: isinstance(figures.figure(toy.skeleton), StickFigure))
    session.watch.set(sticks=False)
    qtbot.waitUntil(lambda: isinstance(figures.figure(toy.skeleton), DefaultBody))
    jobs.stop()


@pytest.mark.parametrize("content", [None, b"", b"glTF\x02\x00\x00\x00"])
def test_a_character_that_cannot_be_read_is_told_once_and_the_default_body_is_drawn(
    document, figures, toy, tmp_path, qtbot, content
):
    path = tmp_path / "broken.glb"
    if content is not None:
        path.write_bytes(content)
    told = []
    document.failed.connect(told.append)
    document.load(replace(toy.project(), character=str(path)), None)
    qtbot.waitUntil(lambda: figures.figure(toy.skeleton) is not None)
    assert isinstance(figures.figure(toy.skeleton), DefaultBody)
    assert len(told) == 1
    assert "broken.glb" in told[0]


@pytest.mark.nightly
@pytest.mark.gl
def test_thumbnails_are_drawn_elsewhere_and_a_loop_moves(document, figures, toy, qtbot):
    document.load(toy.project(), None)
    thumbnails = Thumbnails(document, StageSession(document), figures)
    try:
        loop = toy.id(document.project, "rest loop")
        clip = document.project.action(loop).clip
        assert thumbnails.picture(clip) is None
        qtbot.waitUntil(
            lambda: thumbnails.picture(clip) is not None and thumbnails.picture(clip, bare=True) is not None,
            timeout=20000,
        )
        card, bare = thumbnails.picture(clip), thumbnails.picture(clip, bare=True)
        assert card.pixelColor(1, 1).alpha() == 255
        assert bare.pixelColor(1, 1).alpha() == 0
        thumbnails.moving(clip, 0)
        qtbot.waitUntil(lambda: thumbnails.moving(clip, 0) is not bare, timeout=20000)
        beats = [thumbnails.moving(clip, n) for n in range(24)]
        assert any(beats[0] != other for other in beats), "the arms swing"
        assert thumbnails.moving(clip, 24) == beats[0]
        gone = {i: replace(e, motion=None) for i, e in document.project.clips.items()}
        document.load(replace(document.project, clips=gone), None)
        assert thumbnails.picture(clip) is None
        assert thumbnails.picture("no such clip") is None
    finally:
        thumbnails.stop()
    assert thumbnails.picture(clip) is None, "stopped, it orders nothing"


@pytest.mark.nightly
def test_a_figure_is_drawn_at_once_and_gets_its_levels_of_detail_later(document, figures, sample, qtbot):
    document.load(replace(sample, character=str(MANNEQUIN)), None)
    qtbot.waitUntil(lambda: figures.figure(sample.skeleton) is not None)
    figure = figures.figure(sample.skeleton)
    assert isinstance(figure, SkinnedFigure) and not figure.levels, "nobody waits for them"
    qtbot.waitUntil(lambda: bool(figure.levels), timeout=60_000)
    counts = [len(figure.mesh.triangles), *(len(level.mesh.triangles) for level in figure.levels)]
    assert counts == sorted(counts, reverse=True)
