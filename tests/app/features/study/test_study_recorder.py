"""What is done in the window is written down: each thing once, and never what was typed."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app import translation
from app.features.study.operator_counting import Counting
from app.features.study.study_changes import describe_change
from app.translation import tr
from metagraph.graph import edits
from metagraph.graph.manual import edits as manual_edits

pytestmark = [pytest.mark.window, pytest.mark.gl]
LEFT = Qt.MouseButton.LeftButton


class Kept:
    """A log in memory."""

    def __init__(self) -> None:
        self.events: list[dict] = []

    def add(self, kind: str, **fields: object) -> None:
        self.events.append({"type": kind, **fields})

    def of(self, *kinds: str) -> list[dict]:
        return [e for e in self.events if e["type"] in kinds]

    def operators(self) -> dict[str, int]:
        out: Counter[str] = Counter()
        for event in self.of("ops"):
            out.update({k: event[k] for k in "KPBDH" if event[k]})
        return dict(out)


@pytest.fixture
def recorded(toys):
    """The toy project's window, and what is recorded of it."""
    from app.features.study.study_recorder import Recorder

    toys.settle()
    log = Kept()
    toys.recorder = Recorder(toys.shell, log)
    toys.log = log
    yield toys
    toys.recorder.stop()


@pytest.mark.nightly
def test_known_input_is_counted_exactly(recorded):
    d = recorded
    canvas = d.canvas
    QTest.mouseMove(canvas, QPoint(5, 5))
    d.pause(400)
    d.recorder.boundary()
    d.log.events.clear()
    QTest.mouseClick(canvas, LEFT, pos=QPoint(6, 6))  # no pointing: it is there
    QTest.mouseClick(canvas, LEFT, pos=QPoint(300, 6))  # a pointing
    d.pause(50)
    for key in (Qt.Key.Key_Comma, Qt.Key.Key_Comma, Qt.Key.Key_Period):
        QTest.keyClick(canvas, key)
    QTest.mouseClick(canvas, LEFT, pos=QPoint(300, 6))
    d.recorder.boundary()
    assert d.log.operators() == {"K": 3, "P": 1, "B": 6, "H": 2}


@pytest.mark.nightly
def test_typing_is_counted_and_not_kept(recorded):
    d = recorded
    d.library.search.setFocus()
    QTest.keyClicks(d.library.search, "secret")
    d.recorder.boundary()
    assert d.log.operators()["K"] == 6
    assert "secret" not in str(d.log.events) and str(int(Qt.Key.Key_S)) not in str(d.log.of("ops"))


@pytest.mark.nightly
def test_a_real_drag_is_one_drag_two_buttons_and_an_edit_after_its_operators(recorded):
    d = recorded
    count = len(d.names("gesture"))
    d.library.search.setText("beat")
    d.pause(100)
    d.recorder.boundary()
    d.log.events.clear()
    d.drag(d.card("rest beat lf"), d.node("gesture"), lambda: len(d.names("gesture")) > count)
    d.pause(200)
    d.recorder.boundary()
    found = d.log.operators()
    assert (found["D"], found["B"]) == (1, 2)
    kinds = [e["type"] for e in d.log.events]
    (edit,) = d.log.of("edit")
    assert (edit["what"], edit["clips"], edit["layer"]) == ("place", ["rest beat lf"], "arms")
    assert "ops" in kinds[: kinds.index("edit")], "its operators come before it"
    assert 0 < sum(e.get("drag_s", 0) for e in d.log.of("ops")) < 10


def test_edits_undos_and_redos_are_told_apart(recorded):
    d = recorded
    d.document.edit("Place one", lambda p: edits.add_stance(p, "arms", "none"))
    d.log.events.clear()
    stance = d.session.place.stance()
    d.document.edit("New stance", lambda p: edits.add_stance(p, "arms", "one"))
    d.document.undo()
    d.document.redo()
    d.document.undo()
    d.document.edit("Rename stance", lambda p: edits.rename_stance(p, stance, "other"))
    d.document.edit("Another", lambda p: edits.add_stance(p, "head", "two"))
    told = [(e["type"], e["words"]) for e in d.log.of("edit", "undo", "redo")]
    assert told == [
        ("edit", "New stance"),
        ("undo", "New stance"),
        ("redo", "New stance"),
        ("undo", "New stance"),
        ("edit", "Rename stance"),
        ("edit", "Another"),
    ]
    assert [e["what"] for e in d.log.of("edit")] == ["stance", "rename", "stance"]


@pytest.mark.nightly
def test_a_log_is_english_in_any_language(recorded):
    d = recorded
    translation.choose("de")
    try:
        d.document.edit(tr("New stance"), lambda p: edits.add_stance(p, "arms", "one"))
        d.document.undo()
        d.document.redo()
        assert d.document.undo_stack.undoText() == tr("New stance") != "New stance"
        d.recorder.boundary()
    finally:
        translation.choose("en")
    told = [(e["type"], e["words"]) for e in d.log.of("edit", "undo", "redo")]
    assert told[-3:] == [(kind, "New stance") for kind in ("edit", "undo", "redo")]


def test_a_drag_of_a_time_is_one_edit_and_a_cancelled_one_none(recorded):
    d = recorded
    action = d.action("rest wave rt")

    def end(seconds: float, merge: str) -> None:
        timing = replace(action.timing, end=seconds)
        d.document.edit(
            "Change end", lambda p: edits.update_actions(p, [action.id], timing=timing), merge=merge
        )

    for n in range(5):
        end(0.6 + n / 100, "drag")
    d.document.finish_merging()
    for n in range(3):
        end(0.8 + n / 100, "again")
    d.document.cancel_merging("again")
    d.recorder.boundary()
    (edit,) = d.log.of("edit")
    assert (edit["what"], edit["clips"], edit["words"]) == ("timing", ["rest wave rt"], "Change end")
    assert not d.log.of("undo")


@pytest.mark.nightly
def test_looks_playing_refusals_and_dialogs_are_told(recorded):
    d = recorded
    d.session.transport.set_playing(False)
    d.session.transport.seek(1.0)
    d.session.transport.seek(1.1)
    d.session.place.set_layer("head")
    d.session.selection.select_actions((d.id("rest wave rt"),))
    d.session.show_context(d.id("rest wave rt"))
    d.canvas.acts.refused.emit("not there")
    d.document.failed.emit("not at all")
    from app.features.study.study_note import NoteDialog

    dialog = NoteDialog(False, d.window)
    dialog.open()
    d.pause(50)
    dialog.reject()
    d.pause(50)
    looks = [e["what"] for e in d.log.of("view")]
    assert looks[:3] == ["layer", "stance", "select"]
    plays = [e["what"] for e in d.log.of("playback")]
    assert plays[:3] == ["pause", "seek", "context"]
    assert [(e["what"], e["words"]) for e in d.log.of("error")] == [
        ("refused", "not there"),
        ("failed", "not at all"),
    ]
    assert [(e["name"], e["state"], e.get("result")) for e in d.log.of("dialog")] == [
        ("NoteDialog", "open", None),
        ("NoteDialog", "close", 0),
    ]


@pytest.mark.nightly
def test_a_problem_that_comes_up_is_told_once(recorded):
    d = recorded
    d.document.edit(
        "Trim",
        lambda p: edits.update_actions(
            p, [d.id("rest wave rt")], timing=replace(d.action("rest wave rt").timing, end=0.0)
        ),
    )
    d.wait(lambda: any(p.severity != "hint" for p in d.problems.problems))
    d.wait(lambda: bool(d.log.of("error")))
    d.pause(1200)
    words = [e["words"] for e in d.log.of("error")]
    assert words and len(set(words)) == len(words)
    assert {e["what"] for e in d.log.of("error")} == {"warning"}


def test_nothing_is_told_after_the_end(recorded):
    d = recorded
    d.recorder.stop()
    before = len(d.log.events)
    d.document.edit("New stance", lambda p: edits.add_stance(p, "arms", "one"))
    QTest.keyClick(d.canvas, Qt.Key.Key_Comma)
    assert len(d.log.events) == before


def test_a_log_that_cannot_be_written_is_told_once(recorded, monkeypatch):
    from metagraph.errors import FileError

    def full(kind: str, **fields: object) -> None:
        raise FileError(
            "log.jsonl", "cannot be written (No space left on device)", "on adding to it", "Make room."
        )

    told = []
    monkeypatch.setattr(recorded.log, "add", full)
    monkeypatch.setattr(recorded.shell, "tell", told.append)
    recorded.session.place.set_layer("head")
    recorded.session.place.set_layer("body")
    assert len([t for t in told if "No space left" in t]) == 1


def test_what_changed_names_its_kind_clips_and_layer(toy):
    project = toy.project()
    clip = toy.id(project, "rest wave rt")
    name = {c.name: c.id for c in project.clips.values()}
    placed = edits.place_clips(project, [name["up beat"]], "arms", "gesture", toy.id(project, "rest"))
    assert describe_change(project, placed) == {"what": "place", "clips": ["up beat"], "layer": "arms"}
    assert describe_change(placed, project) == {"what": "delete", "clips": ["up beat"], "layer": "arms"}
    assert (
        describe_change(project, edits.update_actions(project, [clip], likelihood=3.0))["what"] == "settings"
    )
    assert describe_change(project, edits.rename_project(project, "x")) == {"what": "settings", "clips": []}
    first = manual_edits.add_states(project, [name["rest loop"], name["rest wave rt"]], "arms")
    assert describe_change(project, first)["what"] == "place"
    one, other = list(first.manual["arms"].states)
    linked = manual_edits.add_link(first, "arms", one, other)
    assert describe_change(first, linked) == {
        "what": "link",
        "clips": ["rest loop", "rest wave rt"],
        "layer": "arms",
    }
    assert describe_change(linked, first)["what"] == "delete"


def test_operators_are_counted_outside_a_study_while_that_is_wanted(toys):
    d = toys
    d.actions["count_operators"].trigger()
    assert d.actions["count_operators"].isChecked()
    QTest.keyClick(d.canvas, Qt.Key.Key_Comma)
    QTest.mouseClick(d.canvas, LEFT, pos=QPoint(5, 5))
    d.window.findChild(Counting).show()
    assert d.window.findChild(Counting).label.text().startswith("K 1   P 0   B 2   D 0   H 1   0.")
    d.actions["count_operators"].trigger()
    d.wait(lambda: d.window.findChild(Counting) is None)
    assert not d.actions["count_operators"].isChecked()


@pytest.mark.nightly
def test_an_import_tells_how_long_it_took(recorded, monkeypatch):
    from metagraph.formats.imports import Imported

    d, now = recorded, [100.0]
    monkeypatch.setattr("app.features.study.study_recorder.monotonic", lambda: now[0])
    d.importing.begun.emit()
    now[0] = 107.5
    d.importing.imported.emit(Imported([]), None)
    assert [(e["clips"], e["seconds"]) for e in d.log.of("import")] == [(0, 7.5)]


def test_edits_steps_back_and_looks_say_enough_to_be_seen_again(recorded):
    from metagraph.formats.project.data import to_data
    from metagraph.formats.project.replay import Replay

    d = recorded
    begun = to_data(d.document.project)
    d.document.edit("New stance", lambda p: edits.add_stance(p, "head", "one"))
    d.document.edit("Another", lambda p: edits.add_stance(p, "head", "two"))
    d.document.undo()
    action = d.action("rest wave rt")
    d.session.selection.select_actions((action.id,))
    d.session.transport.set_playing(not d.session.transport.playing)
    again = Replay(begun)
    for event in d.log.of("edit", "undo", "redo"):
        again.apply(event["change"])
    assert again.data() == to_data(d.document.project)
    assert d.log.of("view")[-1]["selected_actions"] == [action.id]
    assert d.log.of("playback")[-1]["what"] in ("play", "pause") and d.log.of("playback")[-1]["at"] >= 0
