"""A participant's sitting in the real window: consent, practice, both conditions, questionnaires, the end;
and after a break-off.
"""

from __future__ import annotations

import hashlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QMessageBox, QToolBar

from app.features.study import study_guide
from app.features.study.reserved_window import ReservedWindow
from app.shell.actions import Command
from metagraph.formats.store import open_project, read_project
from metagraph.graph import edits
from metagraph.graph.manual import edits as manual_edits
from metagraph.research.study.analysis.reading import collect_study
from metagraph.research.study.logs.log import read_log
from metagraph.research.study.logs.withdrawal import note_withdrawal
from metagraph.research.study.questionnaires import compute_sus_score
from metagraph.research.study.sitting import Sitting, describe_standing
from metagraph.research.study.study_plan import read_study
from tests.processes import started

pytestmark = [pytest.mark.window, pytest.mark.gl]
ROOT = Path(__file__).resolve().parents[4]
LEFT = Qt.MouseButton.LeftButton


def consent(p) -> None:
    p.titled("A tiny study")
    assert not p.page.go.isEnabled()
    p.page.tick.setFocus()
    QTest.keyClick(p.page.tick, Qt.Key.Key_Space)
    p.go()


def practise(p, editor: str) -> None:
    p.titled(f"Practice: {editor}")
    p.go()
    p.working()
    p.finish()


def events(tiny: Path, *kinds: str) -> list[dict]:
    return [e for e in read_log(tiny.parent / "data" / "P01" / "log.jsonl").events if e["type"] in kinds]


@pytest.mark.nightly
def test_a_whole_sitting(drive, takes_part, tiny, tmp_path):
    p = takes_part()
    d = drive
    consent(p)
    practise(p, "Meta-graph")
    assert not d.actions["undo"].isEnabled(), "a screen lies over the window"

    # The meta-graph: a stance by a real drag.
    p.titled("Two nods: Meta-graph")
    assert "You have 5 minutes." in p.page.text.text()
    p.go()
    p.working()
    assert d.session.onstage.mode == "meta"
    assert not d.learned.on and not d.compatibility.on, "no help that the other condition does not have"
    assert len(d.document.project.clips) == 3 and not d.names()
    assert all(c.motion is not None for c in d.document.project.clips.values())
    for ident in ("open", "save", "save_as", "import", "propose", "use_times", "export", "study"):
        assert not d.actions[ident].isEnabled(), ident
    for ident in ("new_stance", "play", "theme", "quit"):
        assert d.actions[ident].isEnabled(), ident
    d.importing.import_paths([str(ROOT / "sample_clips" / "clips")])
    d.pause(100)
    assert len(d.document.project.clips) == 3, "no other clips are brought in"
    d.session.place.set_layer("head")
    d.drag(
        d.card("head_straight__stance"), d.middle(), lambda: d.names("stance") == ["head_straight__stance"]
    )
    d.drag(d.card("head_straight__nod_single_01"), d.node("gesture"), lambda: len(d.names("gesture")) == 1)
    d.show("machine")
    d.docks["properties"].setFloating(True)
    QTest.mouseClick(p.guide.bar.pause, LEFT)
    p.titled("Paused")
    assert not d.docks["properties"].isFloating() and not d.library.search.isEnabled(), (
        "nothing of the work is seen or reached"
    )
    p.go()
    p.working()
    QTest.mouseClick(p.guide.bar.note, LEFT)
    from app.features.study.study_note import NoteDialog

    note = d.window.findChild(NoteDialog)
    QTest.keyClicks(note.words, "a note")
    QTest.mouseClick(note.keep, LEFT)
    d.document.undo()
    p.finish()

    # Questions.
    p.titled("System Usability Scale")
    assert all(q.value is None for q in p.page.questions)
    p.go()
    assert all(q.missing.isVisible() for q in p.page.questions), "what is open is shown"
    for n, question in enumerate(p.page.questions):
        QTest.mouseClick(question.group.button(3 if n % 2 == 0 else 1), LEFT)
    p.go()
    p.titled("Time for a break")
    p.go()

    # The manual state machine.
    practise(p, "State machine")
    p.titled("Two nods: State machine")
    p.go()
    p.working()
    assert d.session.onstage.mode == "manual"
    assert not d.names(), "everybody begins with nothing"
    clips = list(d.document.project.clips)
    d.document.edit("Add states", lambda q: manual_edits.add_states(q, clips[:2], "head"))
    one, other = d.document.project.manual["head"].states
    d.document.edit("Add link", lambda q: manual_edits.add_link(q, "head", one, other))
    assert not d.actions["label_stance"].isEnabled()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(study_guide, "monotonic", lambda: time.monotonic() + 3000)
        p.titled("Time is up")
    p.go()
    p.titled("System Usability Scale")
    for question in p.page.questions:
        question.group.button(2).setFocus()
        QTest.keyClick(question.group.button(2), Qt.Key.Key_Space)
    p.go()
    p.titled("Some questions")
    QTest.keyClicks(p.page.questions[0].words, "Nothing.")
    p.go()
    p.titled("Thank you")
    assert "That was all." in p.page.text.text()
    p.go()
    d.wait(lambda: not p.guide.bar.isVisible())
    assert d.actions["open"].isEnabled() and not d.files.closed and d.session.onstage.mode == "meta"
    assert d.learned.on and d.compatibility.on and d.library.search.isEnabled()

    # The log, event by event.
    log = read_log(tiny.parent / "data" / "P01" / "log.jsonl")
    assert log.complete and not log.problems and not log.torn
    told = [
        " ".join(str(e[k]) for k in ("name", "condition", "task") if k in e)
        for e in log.events
        if e["type"] == "phase"
    ]
    half = ["instructions {0}", "training {0}", "instructions {0} nods", "task {0} nods", "questionnaire {0}"]
    course = [
        "consent",
        *(h.format("meta") for h in half),
        "break",
        *(h.format("manual") for h in half),
        "questionnaire",
        "end",
    ]
    assert told == [x for name in course for x in (name, name)]
    meta, manual = log.tasks()
    assert (meta.condition, meta.finished, meta.timed_out, meta.undos) == ("meta", True, False, 1)
    assert (manual.condition, manual.finished, manual.timed_out) == ("manual", False, True)
    assert (meta.operators["D"], meta.edits) == (2, 2)
    assert list(meta.per_clip) == ["head_straight__stance", "head_straight__nod_single_01"]
    assert meta.seconds > 0 and meta.paused > 0
    assert sum(meta.spent.values()) == pytest.approx(meta.seconds)
    assert manual.per_clip.keys() == {"head_straight__stance", "head_straight__nod_single_01"}
    assert [(e["what"], e["clips"]) for e in log.events if e["type"] == "edit"] == [
        ("place", ["head_straight__stance"]), ("place", ["head_straight__nod_single_01"]),
        ("place", ["head_straight__stance", "head_straight__nod_single_01"]),
        ("link", ["head_straight__stance", "head_straight__nod_single_01"]),
    ]  # fmt: skip
    assert [(e["words"], e["by"]) for e in log.events if e["type"] == "note"] == [("a note", "participant")]
    scores = [
        compute_sus_score(
            {a.item: a.value for a in log.answers() if a.questionnaire == "sus" and a.condition == c}
        )
        for c in ("meta", "manual")
    ]
    assert scores == [75, 50]
    assert [a.value for a in log.answers() if a.questionnaire == "more"] == ["Nothing."]
    for run, names in ((meta, ["head_straight__stance"]), (manual, [])):
        path = log.path.parent / run.artefact
        assert hashlib.sha256(path.read_bytes()).hexdigest() == run.digest
        project = open_project(path).project
        assert [a.name for a in project.actions()] == names
    assert len(project.manual["head"].links) == 1
    assert log.events[0]["machine"].keys() == {"os", "python", "screen"}


@pytest.mark.nightly
def test_a_sitting_that_was_broken_off_goes_on_with_the_work_as_it_was(drive, takes_part, tiny):
    d = drive
    p = takes_part()
    consent(p)
    practise(p, "Meta-graph")
    p.titled("Two nods: Meta-graph")
    p.go()
    p.working()
    d.document.edit("New stance", lambda q: edits.add_stance(q, "head", "mine"))
    p.guide.leave()
    assert not d.document.dirty and d.actions["open"].isEnabled()

    p = takes_part()
    p.titled("Welcome back")
    assert [s.name for s in d.document.project.graphs["head"].stances.values()] == ["mine"]
    p.go()
    p.working()
    p.finish()
    p.titled("System Usability Scale")
    p.guide.leave()
    told = [(e["index"], e["state"]) for e in events(tiny, "phase")]
    assert len(set(told)) == len(told)
    (run,) = read_log(tiny.parent / "data" / "P01" / "log.jsonl").tasks()
    assert run.finished and run.edits == 1


@pytest.mark.nightly
def test_closing_the_window_keeps_the_work_and_asks_nothing(drive, takes_part, tiny, monkeypatch):
    p = takes_part()
    consent(p)
    p.titled("Practice: Meta-graph")
    p.go()
    p.working()
    drive.document.edit("New stance", lambda q: edits.add_stance(q, "head", "mine"))
    path = p.guide.sitting.file
    drive.window.close()
    assert [s.name for s in read_project(path).graphs["head"].stances.values()] == ["mine"]
    assert events(tiny, "phase")[-1]["state"] == "begin"


@pytest.mark.nightly
def test_who_declines_leaves_a_word_and_may_still_agree(drive, takes_part, tiny):
    p = takes_part()
    p.titled("A tiny study")
    drive.wait(lambda: bool(events(tiny, "frozen")))
    (frozen,) = events(tiny, "frozen")
    assert "consent" in frozen["digests"] and any(n.endswith("nod_single_01.glb") for n in frozen["digests"])
    p.press("I do not want to take part")
    assert [e["type"] for e in events(tiny, "declined", "phase")] == ["phase", "declined"]
    study = read_study(tiny)
    assert describe_standing(study, "P01") == "declined"
    assert any(words.startswith("P01: declined") for words in collect_study(tiny, jumps=False).missing)
    again = Sitting(study, "P01")
    again.begin()
    again.end()
    again.begin()
    again.close()
    assert read_log(study.log("P01")).standing == "broken off"


@pytest.mark.nightly
def test_who_withdrew_cannot_go_on(drive, takes_part, tiny, monkeypatch):
    from app.features.study.study_chooser import begin_sitting

    takes_part().guide.leave()
    study = read_study(tiny)
    assert note_withdrawal(study, "P01") and not note_withdrawal(study, "P01")
    told = []
    monkeypatch.setattr(QMessageBox, "warning", lambda *words: told.append(words[2]))
    assert begin_sitting(drive.shell, study, "P01") is None
    assert told[0].startswith("P01 withdrew")


@pytest.mark.nightly
def test_a_sitting_is_open_once(drive, takes_part, tiny, monkeypatch):
    from app.features.study.study_chooser import begin_sitting

    takes_part()
    told = []
    monkeypatch.setattr(QMessageBox, "warning", lambda *words: told.append(words[2]))
    assert begin_sitting(drive.shell, read_study(tiny), "P01") is None
    assert begin_sitting(drive.shell, read_study(tiny), "nobody") is None
    assert "another window" in told[0] and "'nobody'" in told[1]


@pytest.mark.nightly
def test_clips_that_cannot_be_read_are_told_and_can_be_tried_again(drive, takes_part, tiny):
    text = tiny.read_text()
    tiny.write_text(text.replace("clips: [", "clips: [missing.glb, ", 1))
    p = takes_part()
    consent(p)
    p.titled("Practice: Meta-graph")
    p.go()
    p.titled("The study cannot continue")
    assert "'missing.glb'" in p.page.text.text()


def test_who_takes_part_is_chosen_from_a_list_that_tells_how_far_each_is(drive, takes_part, tiny):
    from app.features.study.study_chooser import StudyChooser, run_study

    p = takes_part("P02")
    p.guide.leave()
    run_study(drive.shell, tiny)
    chooser = drive.window.findChild(StudyChooser)
    rows = [chooser.list.item(n).text() for n in range(chooser.list.count())]
    assert rows == [
        "P01    not begun",
        "P02    goes on at: A tiny study",
        "P03    not begun",
        "P04    not begun",
    ]
    drive.pause(100)
    chooser.reject()


def offered(drive, mode: str, labels: bool) -> set[str]:
    """Return what a task offers, of what could be done at all."""
    drive.session.set_mode(mode)
    reserved = ReservedWindow(drive.shell, QToolBar(drive.window), labels)
    reserved.allow_task()
    out = {c.id for c in drive.actions.commands if drive.actions.allowed(c) and c.when in ("any", mode)}
    reserved.allow(None)
    return out


@pytest.mark.nightly
def test_proposals_are_offered_where_the_study_allows_them(drive):
    proposals = {"propose", "use_times", "patterns", "compatibility"}
    assert not offered(drive, "meta", False) & proposals
    assert offered(drive, "meta", True) - offered(drive, "meta", False) == proposals
    assert not offered(drive, "manual", True) & proposals
    assert "undo" in offered(drive, "manual", False) and "label_gesture" not in offered(
        drive, "manual", False
    )


@pytest.mark.nightly
def test_a_command_that_says_nothing_of_studies_is_not_offered_while_a_task_is_worked_on(drive):
    assert Command("x", "&Help", "", "X").study is False
    meta = offered(drive, "meta", True)
    menus, groups = ("&Conversation", "&Study"), ("project", "save", "import", "write")
    materials = {c.id for c in drive.actions.commands if c.menu in menus or c.group in groups}
    assert not meta & (
        materials
        | {
            "motion_graph",
            "twins",
            "repairs",
            "character",
            "live",
            "mimic",
            "skeleton",
            "joint_maps",
            "manual",
        }
    )
    assert meta >= {
        "undo",
        "redo",
        "delete",
        "rename",
        "label_stance",
        "new_stance",
        "play",
        "in_context",
        "machine",
        "theme",
        "quit",
    }


KILLED = """
import os, sys, random
from pathlib import Path
from PySide6.QtCore import QTimer
from app.main import prepare_application
app = prepare_application()
from app.main import make_window
from app.features.study.study_chooser import begin_sitting
from metagraph.graph import edits
from metagraph.research.study.sitting import Sitting, describe_standing
from metagraph.research.study.study_plan import read_study
from metagraph.research.study.logs.withdrawal import note_withdrawal
window = make_window()
window.show()
guide = begin_sitting(window.shell, read_study(Path(sys.argv[1])), "P01")
def step():
    if guide._working:
        count = len(window.shell.document.project.graphs["head"].stances)
        window.shell.document.edit("New stance", lambda p: edits.add_stance(p, "head", f"stance {count}"))
        print(count + 1, flush=True)
    elif guide.screen.page.go is not None:
        if hasattr(guide.screen.page, "tick"):
            guide.screen.page.tick.setChecked(True)
        guide.screen.page.go.click()
timer = QTimer(interval=5)
timer.timeout.connect(step)
timer.start()
QTimer.singleShot(60000, lambda: os._exit(9))
app.exec()
"""


@pytest.mark.nightly
def test_a_window_that_is_killed_loses_nothing(tiny, tmp_path, qapp):
    env = {
        **os.environ,
        "XDG_DATA_HOME": str(tmp_path / "d"),
        "XDG_CONFIG_HOME": str(tmp_path / "c"),
        "PYTHONPATH": str(ROOT),
    }
    log = tiny.parent / "data" / "P01" / "log.jsonl"
    made = 0
    for kill in (3, 11, 29):
        with started(sys.executable, "-c", KILLED, tiny, env=env, stdout=subprocess.PIPE) as process:
            for line in process.stdout:
                made = int(line)
                if made >= kill:
                    break
            process.send_signal(signal.SIGKILL)
            process.wait(10)
        assert made >= kill
        found = read_log(log)
        assert not found.problems and [e["n"] for e in found.events] == list(range(len(found.events)))
        assert sum(e["type"] == "edit" for e in found.events) in (made - 1, made, made + 1)
    from metagraph.research.study.plan.task_projects import reopen

    project = reopen(next(log.parent.glob("*training*.yaml")))[0].project
    assert len(project.graphs["head"].stances) in (made, made + 1)
    marks = [(e["index"], e["state"]) for e in read_log(log).events if e["type"] == "phase"]
    assert marks == [(0, "begin"), (0, "end"), (1, "begin"), (1, "end"), (2, "begin")]


@pytest.mark.nightly
def test_tasks_begin_with_a_clap_where_the_study_wants_it(drive, takes_part, tiny):
    tiny.write_text(tiny.read_text() + "claps: true\n")
    p = takes_part()
    consent(p)
    p.titled("Practice: Meta-graph")
    p.go()
    p.working()
    (clap,) = events(tiny, "marker")
    assert (clap["name"], clap["number"]) == ("clap", 1)

    def areas() -> dict[str, list[int]]:
        return next(
            (e["areas"] for e in reversed(events(tiny, "view")) if e["what"] == "layout" and e["areas"]), {}
        )

    def node_on_screen() -> list[int]:
        corner = drive.canvas.mapToGlobal(drive.canvas.rect().topLeft())
        rect = drive.canvas.layout_now().nodes["gesture"].rect
        return [corner.x() + round(rect.x()), corner.y() + round(rect.y())]

    # What stands elsewhere once the window has settled is reported again.
    drive.wait(lambda: areas().get("graph gesture", [])[:2] == node_on_screen())
    graph, node = areas()["graph"], areas()["graph gesture"]
    assert graph[0] <= node[0] and node[0] + node[2] <= graph[0] + graph[2]
