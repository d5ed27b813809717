"""A state machine drawn by hand in the real window: clips dropped, links dragged, timed, undone, copied,
played, saved and exported.
"""

from __future__ import annotations

import json

import jsonschema
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu

from metagraph.engines.export import export_schema_text
from metagraph.engines.reading import read_export
from metagraph.formats.store import open_project, save_project
from metagraph.graph import edits
from metagraph.graph.manual import edits as manual_edits
from metagraph.graph.manual.machine import ANY

pytestmark = [pytest.mark.window, pytest.mark.gl]


class Hand:
    """The editor of the window, with places in it by the names of states."""

    def __init__(self, drive) -> None:
        self.drive = drive
        drive.actions["manual"].trigger()
        drive.wait(lambda: drive.editor is not None and drive.editor.isVisible())
        drive.pause(60)
        self.editor = drive.editor
        self.canvas, self.inspector = self.editor.canvas, self.editor.inspector
        self.told: list[str] = []
        self.canvas.refused.connect(self.told.append)

    @property
    def machine(self):
        return self.canvas.scene().manual

    def id(self, name: str) -> str:
        return ANY if name == ANY else next(s.id for s in self.machine.states.values() if s.name == name)

    def state(self, name: str):
        return self.machine.states[self.id(name)]

    def pairs(self) -> list[str]:
        names = {i: s.name for i, s in self.machine.states.items()} | {ANY: ANY}
        return [f"{names[x.source]}>{names[x.target]}" for x in self.machine.links.values()]

    def at(self, x: float, y: float) -> tuple:
        """A place of the machine, on the canvas."""
        point = self.canvas.view.to(QPointF(x, y))
        return self.canvas, QPoint(round(point.x()), round(point.y()))

    def middle(self, name: str) -> tuple:
        centre = self.canvas.scene().nodes[self.id(name)].center()
        return self.at(centre.x(), centre.y())

    def edge(self, name: str) -> tuple:
        box = self.canvas.scene().nodes[self.id(name)]
        return self.at(box.right() - 4, box.center().y() + 8)

    def link(self, source: str, target: str) -> None:
        before = len(self.machine.links)
        self.drive.drag(self.edge(source), self.middle(target), lambda: len(self.machine.links) > before)

    def drop(self, clip: str, x: float, y: float) -> None:
        before = len(self.machine.states)
        self.drive.drag(self.drive.card(clip), self.at(x, y), lambda: len(self.machine.states) > before)

    def key(self, key: Qt.Key, modifier: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
        self.canvas.setFocus()
        QTest.keyClick(self.canvas, key, modifier)


CONTROL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier


@pytest.fixture
def hand(toys) -> Hand:
    return Hand(toys)


@pytest.fixture
def drawn(hand: Hand) -> Hand:
    """rest loop (the start, loops) <-> rest wave rt, and rest long, standing apart."""
    p = hand.drive.document.project
    clips = {e.name: i for i, e in p.clips.items()}

    def edit(project):
        for n, name in enumerate(("rest loop", "rest wave rt", "rest long")):
            project = manual_edits.add_states(project, [clips[name]], "arms", 260 * n, 140 * (n % 2))
        ids = [*project.manual["arms"].states]
        project = manual_edits.update_states(project, ids[:1], loop=True)
        project = manual_edits.add_link(project, "arms", ids[0], ids[1])
        return manual_edits.add_link(project, "arms", ids[1], ids[0])

    hand.drive.document.edit("Draw", edit)
    hand.canvas.fit()
    hand.drive.settle()
    return hand


@pytest.mark.nightly
def test_the_editor_takes_the_meta_graphs_place_and_gives_it_back(hand: Hand) -> None:
    drive = hand.drive
    assert not drive.canvas.isVisible()
    assert hand.inspector.isVisible()
    assert drive.session.onstage.mode == "manual"
    assert not drive.actions["label_gesture"].isEnabled()
    drive.actions["manual"].trigger()
    assert drive.canvas.isVisible()
    assert not hand.editor.isVisible()
    assert drive.properties.isVisible()
    assert drive.actions["new_stance"].isEnabled()


def test_clips_are_dropped_links_are_dragged_and_all_of_it_plays_is_undone_saved_and_exported(
    hand: Hand, tmp_path
) -> None:
    drive = hand.drive
    drive.library.search.setText("rest")
    drive.pause(100)
    hand.drop("rest loop", 60, 60)
    assert hand.machine.start == hand.id("rest loop")
    hand.drop("rest wave rt", 420, 60)
    drive.click(drive.card("rest long"))
    drive.click(drive.card("rest short"), CONTROL)
    drive.wait(lambda: len(drive.session.selection.clips) == 2)
    drive.drag(drive.card("rest short"), hand.at(240, 300), lambda: len(hand.machine.states) == 4)
    assert len(drive.session.selection.states) == 2, "what was dropped is selected"

    # The idle loops; links there and back, the way there on request.
    drive.click(hand.middle("rest loop"))
    drive.wait(lambda: drive.session.selection.states == (hand.id("rest loop"),))
    QTest.mouseClick(
        hand.inspector.loop, Qt.MouseButton.LeftButton, pos=QPoint(8, hand.inspector.loop.height() // 2)
    )
    assert hand.state("rest loop").loop
    hand.link("rest loop", "rest wave rt")
    hand.link("rest wave rt", "rest loop")
    hand.link("rest loop", "rest long")
    hand.link(ANY, "rest short")
    assert hand.pairs() == [
        "rest loop>rest wave rt",
        "rest wave rt>rest loop",
        "rest loop>rest long",
        f"{ANY}>rest short",
    ]
    first = next(iter(hand.machine.links))
    drive.session.selection.select_states((), (first,))
    hand.inspector.when.setCurrentIndex(1)
    hand.inspector.when.activated.emit(1)
    assert hand.machine.links[first].condition.trigger == "rest wave rt"

    # An exit time, typed; one step back, and again.
    back = [*hand.machine.links][1]
    drive.session.selection.select_states((), (back,))
    exits = hand.inspector.exit
    exits.way.setFocus()
    QTest.keyClick(exits.way, Qt.Key.Key_End)
    exits.way.activated.emit(exits.way.currentIndex())
    assert exits.time.isVisible() and not exits.part.isVisible()
    exits.time.setFocus()
    exits.time.selectAll()
    QTest.keyClicks(exits.time, "0.8")
    QTest.keyClick(exits.time, Qt.Key.Key_Return)
    assert hand.machine.links[back].exit_time == 0.8
    drive.document.undo()
    assert hand.machine.links[back].exit_time == pytest.approx(0.95)
    drive.document.redo()

    # A nonsense link is refused in words.
    count = len(hand.machine.links)
    drive.drag(hand.edge("rest wave rt"), hand.middle(ANY), lambda: bool(hand.told))
    assert "other way round" in hand.told[-1]
    assert len(hand.machine.links) == count

    # Fired, it plays.
    drive.wait(lambda: drive.performance.shown.manual is not None)
    drive.session.transport.seek(1.0)
    drive.session.transport.set_playing(False)
    drive.performance.fire("rest wave rt")

    def played() -> list[str]:
        return [p.action.name for p in drive.performance.shown.manual.layers["arms"].played]

    drive.wait(lambda: "rest wave rt" in played())
    assert played()[:2] == ["rest loop", "rest wave rt"]
    assert drive.performance.pose() is not None

    # Saved and opened again it is the same; its journal too.
    drive.document.save(tmp_path / "drawn.metagraph.yaml")
    again = open_project(tmp_path / "drawn.metagraph.yaml").project
    assert again.manual == drive.document.project.manual

    # Exported, it is the meta-graph it amounts to, and the differences are reported.
    from app.features.export.export_dialog import ExportDialog

    drive.wait(lambda: not drive.jobs.running)
    drive.document.edit(
        "Link", lambda p: manual_edits.add_link(p, "arms", hand.id("rest long"), hand.id("rest loop"))
    )
    drive.actions["export"].trigger()
    dialog = drive.window.findChild(ExportDialog)
    assert "differs from the drawn states" in dialog.losses.text()
    dialog.folder.setText(str(tmp_path / "out"))
    assert dialog.go.isEnabled(), dialog.trouble.text()
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: dialog.open_button.isEnabled(), 60)
    dialog.reject()
    written = next((tmp_path / "out").glob("*.json"))
    jsonschema.Draft202012Validator(json.loads(export_schema_text())).validate(
        json.loads(written.read_bytes())
    )
    kinds = {a.name: a.kind for a in read_export(written).actions()}
    assert kinds == {
        "rest loop": "stance",
        "rest wave rt": "gesture",
        "rest long": "fidget",
        "rest short": "gesture",
    }


@pytest.mark.nightly
def test_nodes_are_moved_by_their_middle_in_one_step(drawn: Hand) -> None:
    before, undone = drawn.state("rest long"), drawn.drive.document.undo_stack.count()
    drawn.drive.drag(
        drawn.middle("rest long"), drawn.at(700, 320), lambda: drawn.state("rest long") != before
    )
    after = drawn.state("rest long")
    assert (after.x - before.x, after.y - before.y) != (0, 0)
    assert after.x % 8 == after.y % 8 == 0
    assert drawn.drive.document.undo_stack.count() == undone + 1
    drawn.drive.document.undo()
    assert drawn.state("rest long") == before


@pytest.mark.nightly
def test_selection_by_click_key_and_rubber_band_and_several_moved_at_once(drawn: Hand) -> None:
    drive, ids = drawn.drive, [drawn.id(n) for n in ("rest loop", "rest wave rt", "rest long")]
    drive.click(drawn.middle("rest loop"))
    assert drive.session.selection.states == (ids[0],)
    drive.click(drawn.middle("rest long"), SHIFT)
    assert drive.session.selection.states == (ids[0], ids[2])
    drive.click(drawn.middle("rest loop"), CONTROL)
    assert drive.session.selection.states == (ids[2],)
    drive.drag(drawn.at(-50, -50), drawn.at(300, 240), lambda: len(drive.session.selection.states) == 2)
    assert set(drive.session.selection.states) == set(ids[:2])
    drawn.key(Qt.Key.Key_A, CONTROL)
    assert set(drive.session.selection.states) == set(ids)
    before = {i: s.x for i, s in drawn.machine.states.items()}
    drawn.key(Qt.Key.Key_Right)
    assert {i: s.x - 8 for i, s in drawn.machine.states.items()} == before
    drive.click(drawn.at(-40, 300))
    assert drive.session.selection.states == ()


@pytest.mark.nightly
def test_states_are_copied_with_their_links_duplicated_and_removed(drawn: Hand) -> None:
    drive = drawn.drive
    drive.session.selection.select_states((drawn.id("rest loop"), drawn.id("rest wave rt")))
    drawn.key(Qt.Key.Key_C, CONTROL)
    QTest.mouseMove(drawn.canvas, drawn.at(200, 330)[1])
    drawn.key(Qt.Key.Key_V, CONTROL)
    assert len(drawn.machine.states) == 5
    assert drawn.pairs()[2:] == ["rest loop 2>rest wave rt 2", "rest wave rt 2>rest loop 2"]
    assert len(drive.session.selection.states) == 2
    drawn.key(Qt.Key.Key_D, CONTROL)
    assert len(drawn.machine.states) == 7
    assert len(drawn.machine.links) == 6
    drawn.key(Qt.Key.Key_Delete)
    assert len(drawn.machine.states) == 5
    assert len(drawn.machine.links) == 4
    for _ in range(3):
        drive.document.undo()
    assert len(drawn.machine.states) == 3


@pytest.mark.nightly
def test_a_links_settings_are_pasted_onto_others_and_several_are_edited_at_once(drawn: Hand) -> None:
    drive, (first, second) = drawn.drive, drawn.machine.links
    drive.session.selection.select_states((), (first,))
    drawn.inspector.blend.setValue(0.6)
    QTest.mouseClick(drawn.inspector.copy, Qt.MouseButton.LeftButton)
    drive.session.selection.select_states((), (second,))
    QTest.mouseClick(drawn.inspector.paste, Qt.MouseButton.LeftButton)
    assert drawn.machine.links[second].blend == 0.6
    drive.document.edit("x", lambda p: manual_edits.update_links(p, [second], blend=0.1))
    drive.session.selection.select_states((), (first, second))
    assert drawn.inspector.blend.text() == "mixed"
    drawn.inspector.blend.setValue(0.4)
    assert {x.blend for x in drawn.machine.links.values()} == {0.4}
    assert "2 links" in drawn.inspector.ends.text()


def test_a_link_is_clicked_and_removed(drawn: Hand) -> None:
    drive, first = drawn.drive, next(iter(drawn.machine.links))
    at = drawn.canvas.scene().middle(first)
    drive.click(drawn.at(at.x(), at.y()))
    assert drive.session.selection.links == (first,)
    drive.actions["delete"].trigger()
    assert drawn.pairs() == ["rest wave rt>rest loop"]


@pytest.mark.nightly
def test_double_click_plays_a_state_alone_and_escape_goes_back(drawn: Hand) -> None:
    drive, (canvas, at) = drawn.drive, drawn.middle("rest long")
    QTest.mouseDClick(canvas, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at)
    drive.wait(lambda: abs(drive.performance.shown.length - 2.4) < 1e-6)
    assert drive.session.transport.show == "context"
    drive.actions["show_plan"].trigger()
    drive.wait(lambda: drive.performance.shown.length > 10)


def test_the_view_pans_and_zooms_and_shows_all_again(drawn: Hand) -> None:
    drive, canvas, before = drawn.drive, drawn.canvas, drawn.canvas.view
    QTest.mousePress(canvas, Qt.MouseButton.MiddleButton, pos=QPoint(300, 300))
    QTest.mouseMove(canvas, QPoint(360, 320))
    QTest.mouseRelease(canvas, Qt.MouseButton.MiddleButton, pos=QPoint(360, 320))
    drive.wait(lambda: canvas.view != before)
    assert drive.document.undo_stack.count() == 1
    canvas.fit()
    assert canvas.view.rect(canvas.size().toSizeF()).contains(canvas.scene().bounds)


@pytest.mark.nightly
def test_the_menu_draws_a_link_from_click_to_click_and_escape_gives_it_up(drawn: Hand) -> None:
    from app.features.manual.manual_commands import fill_canvas_menu

    def menu(hit: ManualHit) -> QMenu:
        out = QMenu(drawn.canvas)
        fill_canvas_menu(out, drawn.canvas, hit)
        return out

    from app.features.manual.manual_scene import ManualHit

    drive = drawn.drive
    drive.pick(menu(ManualHit("node", drawn.id("rest wave rt"))), "Draw link from here")
    drawn.key(Qt.Key.Key_Escape)
    assert drawn.canvas.hand.gesture is None
    drive.pick(menu(ManualHit("node", drawn.id("rest wave rt"))), "Draw link from here")
    drive.click(drawn.middle("rest long"))
    assert drawn.pairs()[-1] == "rest wave rt>rest long"
    drive.pick(menu(ManualHit("node", drawn.id("rest long"))), "Start here")
    assert drawn.machine.start == drawn.id("rest long")


def test_arranging_is_one_step_and_shows_all(drawn: Hand) -> None:
    before, undone = drawn.machine, drawn.drive.document.undo_stack.count()
    QTest.mouseClick(drawn.editor.arrange, Qt.MouseButton.LeftButton)
    assert drawn.machine != before
    assert drawn.drive.document.undo_stack.count() == undone + 1
    assert drawn.canvas.view.rect(drawn.canvas.size().toSizeF()).contains(drawn.canvas.scene().bounds)


def test_problems_are_marked_and_a_click_on_one_goes_to_its_state(drawn: Hand) -> None:
    drive, ident = drawn.drive, drawn.id("rest long")
    drive.wait(lambda: ident in drawn.canvas.troubles)
    row = next(n for n in range(drive.problems_panel.tree.topLevelItemCount())
               if "rest long" in drive.problems_panel.tree.topLevelItem(n).text(0))  # fmt: skip
    drive.problems_panel.tree.itemActivated.emit(drive.problems_panel.tree.topLevelItem(row), 0)
    assert drive.session.selection.states == (ident,)
    assert (
        "cannot be reached" in drawn.inspector.state_trouble.text()
        or "cannot be left" in drawn.inspector.state_trouble.text()
    )


@pytest.mark.nightly
def test_each_layer_has_a_machine_of_its_own(drawn: Hand) -> None:
    drive = drawn.drive
    drive.session.place.set_layer("head")
    assert drawn.machine.states == {}
    drawn.canvas.place((next(iter(drive.document.project.clips)),), QPointF(200, 200))
    assert [s.layer for s in drawn.machine.states.values()] == ["head"]
    drive.session.place.set_layer("arms")
    assert len(drawn.machine.states) == 3


def test_the_meta_graph_is_not_changed_unseen(drawn: Hand) -> None:
    drive, graphs = drawn.drive, drawn.drive.document.project.graphs
    drive.session.selection.select_clips(tuple([*drive.document.project.clips][:2]))
    for command in ("label_stance", "label_gesture", "new_stance", "propose", "twins"):
        drive.actions[command].trigger()
    drive.pause(50)
    assert drive.document.project.graphs is graphs
    assert QApplication.activeModalWidget() is None


def test_files_dropped_on_the_editor_are_imported_and_become_states(drawn: Hand, tmp_path, toy) -> None:
    from metagraph.formats.gltf.writer import write_glb

    drive, count = drawn.drive, len(drawn.machine.states)
    write_glb(tmp_path / "late.glb", [toy.clip("late")], None)
    assert drive.drop_files(drawn.at(300, 300), tmp_path / "late.glb")
    drive.wait(lambda: len(drawn.machine.states) == count + 1, 60)
    assert drawn.state("late").y > 200


@pytest.mark.nightly
def test_trimming_stays_inside_the_clip(drawn: Hand) -> None:
    drive = drawn.drive
    drive.session.selection.select_states((drawn.id("rest wave rt"),))
    drawn.inspector.last.setValue(50.0)
    assert drawn.state("rest wave rt").end is None
    drawn.inspector.last.setValue(0.9)
    drawn.inspector.first.setValue(2.0)
    assert drawn.state("rest wave rt").start < drawn.state("rest wave rt").end == 0.9


def test_a_project_that_was_only_drawn_opens_in_the_editor_and_a_meta_graph_without_it(
    drawn: Hand, tmp_path, toy
) -> None:
    drive = drawn.drive
    drive.document.edit("Clear", lambda p: edits.remove_actions(p, [a.id for a in p.actions()]))
    only = drive.document.project
    drive.actions["manual"].trigger()
    assert drive.session.onstage.mode == "meta"
    drive.document.load(only, None)
    drive.files.opened.emit()
    assert drive.session.onstage.mode == "manual"
    assert drawn.canvas.view.rect(drawn.canvas.size().toSizeF()).contains(drawn.canvas.scene().bounds)
    drive.document.load(toy.project(), None)
    drive.files.opened.emit()
    assert drive.session.onstage.mode == "meta"


@pytest.mark.nightly
def test_what_was_only_drawn_is_exported_by_the_command_too(drawn: Hand, tmp_path, capsys) -> None:
    from app.cli.parser import main
    from metagraph.formats.gltf.writer import write_glb

    project = drawn.drive.document.project
    project = edits.remove_actions(project, [a.id for a in project.actions()])
    for entry in project.clips.values():
        write_glb(tmp_path / entry.path, [entry.motion])
    save_project(project, tmp_path / "only.metagraph.yaml")
    assert main(["export", str(tmp_path / "only.metagraph.yaml"), "-o", str(tmp_path / "out")]) == 0
    assert "differs: " in capsys.readouterr().err
    written = read_export(next((tmp_path / "out").glob("*.json")))
    assert {a.name for a in written.actions()} == {"rest loop", "rest wave rt"}


def test_a_clip_that_was_drawn_leaves_those_that_are_to_do(hand: Hand) -> None:
    drive = hand.drive
    action = next(a for a in drive.document.project.actions() if a.kind == "gesture")
    drive.document.edit("Remove", lambda p: edits.remove_actions(p, [a.id for a in p.uses[action.clip]]))
    drive.library.chips["unlabelled"].click()
    before, rows = drive.library.chips["unlabelled"].text(), drive.library.rows.rowCount()
    hand.canvas.place((action.clip,), QPointF(200, 200))
    drive.wait(lambda: drive.library.rows.rowCount() == rows - 1)
    assert drive.library.chips["unlabelled"].text() == f"Unlabelled {rows - 1}" != before
    drive.actions["undo"].trigger()
    drive.wait(lambda: drive.library.rows.rowCount() == rows)
    assert drive.library.chips["unlabelled"].text() == before
