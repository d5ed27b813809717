"""A sitting is seen again as it was: each edit, step back, look and pause, forwards and backwards."""

from __future__ import annotations

from dataclasses import replace

import pytest

from metagraph.errors import FileError
from metagraph.formats.store import read_project
from metagraph.graph import edits
from metagraph.research.study.study_plan import read_study

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def sat(drive, takes_part, tiny):
    """A participant who placed, took back, timed, looked and paused in the practice, and left."""
    p = takes_part()
    p.titled("A tiny study")
    p.page.tick.setChecked(True)
    p.go()
    p.titled("Practice: Meta-graph")
    p.go()
    p.working()
    d = drive
    clip = next(iter(d.document.project.clips))
    d.session.place.set_layer("head")
    d.document.edit("New stance", lambda q: edits.add_stance(q, "head", "mine", [clip]))
    d.document.edit("Another", lambda q: edits.add_stance(q, "head", "gone"))
    d.document.undo()
    action = next(iter(d.document.project.actions()))
    d.session.selection.select_actions((action.id,))
    d.pause(50)
    p.guide.pause()
    p.go()
    p.working()
    timing = replace(action.timing, end=0.5)
    d.document.edit("Change end", lambda q: edits.update_actions(q, [action.id], timing=timing))
    p.guide.recorder.boundary()
    p.guide.leave()
    return read_project(p.guide.sitting.file)


def stances(d) -> list[str]:
    return [s.name for s in d.document.project.graphs["head"].stances.values()]


@pytest.mark.nightly
def test_a_sitting_is_seen_again(drive, sat, tiny):
    from app.features.study.study_replay import Replayer

    d = drive
    again = Replayer(d.shell, read_study(tiny), "P01")
    assert again.bar.part.count() == 1 and again.part.silent == 0
    loaded = []
    again.ready.connect(lambda: loaded.append(True))
    again.choose(0)
    d.wait(lambda: bool(loaded))
    assert stances(d) == [] and not d.actions["new_stance"].isEnabled(), "it is only looked at"
    kinds = {
        e["words"]: t for e, t in zip(again.part.events, again.part.times, strict=True) if e.get("words")
    }
    again.seek(kinds["New stance"])
    assert stances(d) == ["mine"] or stances(d) == ["mine", "gone"], (
        "moments of the same millisecond come together"
    )
    again.seek(again.part.seconds)
    assert stances(d) == ["mine"] == [s.name for s in sat.graphs["head"].stances.values()]
    (action,) = d.document.project.actions()
    assert action.timing.end == 0.5 and d.session.selection.actions == (action.id,)
    assert d.session.place.layer == "head"
    assert d.document.project.clips[action.clip].motion is not None
    again.seek(0.0)
    assert stances(d) == [], "backwards, too"
    again.bar.set_speed(1000.0)
    again.set_playing(True)
    d.wait(lambda: again.at >= again.part.seconds)
    assert stances(d) == ["mine"] and not again.bar.play.isChecked()
    again.seek(
        next(t for e, t in zip(again.part.events, again.part.times, strict=True) if e["type"] == "pause")
    )
    assert again.bar.told.text() in ("Paused", "Resumes", "Preview: pause")
    again.leave()
    assert not d.document.project.clips and d.actions["open"].isEnabled() and not d.document.dirty


@pytest.mark.nightly
def test_who_did_nothing_has_nothing_to_be_seen(drive, tiny):
    from app.features.study.study_replay import Replayer

    study = read_study(tiny)
    with pytest.raises(ValueError, match="does not take part"):
        Replayer(drive.shell, study, "nobody")
    with pytest.raises(FileError):
        Replayer(drive.shell, study, "P02")
