"""Aliases, links of many at once, links copied to other states, tables and finding, in the real window."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu

from app.features.manual import manual_commands, manual_many
from metagraph.graph.manual import edits as manual_edits
from metagraph.graph.manual import groups as manual_groups
from tests.app.features.manual.test_manual_editor import CONTROL, Hand

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def hand(toys) -> Hand:
    """rest loop, rest wave rt and rest long below each other, up beat apart to their right, no links."""
    hand = Hand(toys)
    clips = {e.name: i for i, e in toys.document.project.clips.items()}

    def edit(project):
        for n, name in enumerate(("rest loop", "rest wave rt", "rest long")):
            project = manual_edits.add_states(project, [clips[name]], "arms", 0, 130 * n)
        return manual_edits.add_states(project, [clips["up beat"]], "arms", 520, 130)

    toys.document.edit("Draw", edit)
    hand.canvas.fit()
    toys.settle()
    return hand


def chosen(hand: Hand) -> tuple[str, ...]:
    return hand.drive.session.selection.states


def select(hand: Hand, *names: str) -> None:
    hand.drive.session.selection.select_states(tuple(hand.id(n) for n in names))


def alias(hand: Hand, *names: str) -> str:
    """Make an alias by its key, and show all."""
    select(hand, *names)
    hand.key(Qt.Key.Key_G, CONTROL)
    (ident,) = chosen(hand)
    hand.drive.session.selection.select_states()
    hand.canvas.fit()
    hand.drive.settle()
    hand.drive.session.selection.select_states((ident,))
    return ident


def edge_of(hand: Hand, ident: str) -> tuple:
    box = hand.canvas.scene().nodes[ident]
    return hand.at(box.right() - 4, box.center().y())


@pytest.mark.nightly
def test_an_alias_is_made_of_what_is_selected_named_shown_and_undone(hand: Hand) -> None:
    ident = alias(hand, "rest loop", "rest wave rt")
    made = hand.machine.aliases[ident]
    assert made.name == "rest" and len(made.states) == 2
    page = hand.inspector.alias
    assert page.isVisible() and page.name.text() == "rest"
    assert hand.inspector.pages.currentWidget() is page
    page.name.setText("standing")
    page.name.editingFinished.emit()
    assert hand.machine.aliases[ident].name == "standing"
    rows = {page.list.item(n).text(): page.list.item(n) for n in range(page.list.count())}
    rows["rest long"].setCheckState(Qt.CheckState.Checked)
    assert len(hand.machine.aliases[ident].states) == 3
    page.entry.setCurrentIndex(1)
    page.entry.activated.emit(1)
    assert hand.machine.aliases[ident].entry == hand.id("rest loop")
    QTest.mouseClick(page.every, Qt.MouseButton.LeftButton, pos=page.every.rect().center() * 0.1)
    page.every.click()
    page.search.setText("up")
    assert [n for n in rows if not rows[n].isHidden()] == ["up beat"]
    for _ in range(9):
        hand.drive.document.undo()
    assert not hand.machine.aliases


@pytest.mark.nightly
def test_a_link_dragged_from_an_alias_is_one_link_for_many_connections(hand: Hand) -> None:
    ident = alias(hand, "rest loop", "rest wave rt", "rest long")
    hand.drive.drag(edge_of(hand, ident), hand.middle("up beat"), lambda: bool(hand.machine.links))
    (link,) = hand.machine.links.values()
    assert link.source == ident and link.exit_part == 1
    assert hand.inspector.ends.text() == "rest → up beat"
    assert hand.inspector.exit.way.currentText() == "when the source ends"
    assert "1 link for 3 connections" in hand.editor.words.text()


@pytest.mark.nightly
def test_links_are_dragged_from_all_that_are_selected_and_to_all(hand: Hand) -> None:
    select(hand, "rest loop", "rest wave rt", "rest long")
    hand.link("rest wave rt", "up beat")
    assert len(hand.machine.links) == 3 and len(hand.drive.session.selection.links) == 3
    assert {x.target for x in hand.machine.links.values()} == {hand.id("up beat")}
    select(hand, "rest loop", "rest wave rt")
    hand.link("up beat", "rest wave rt")
    assert len(hand.machine.links) == 5
    hand.drive.document.undo()
    assert len(hand.machine.links) == 3  # one step


@pytest.mark.nightly
def test_links_are_selected_by_their_ends_changed_together_and_pasted_for_other_states(hand: Hand) -> None:
    select(hand, "rest loop", "rest wave rt", "rest long")
    hand.link("rest wave rt", "up beat")
    select(hand, "up beat")
    hand.key(Qt.Key.Key_O)
    assert "no link leaves" in hand.told[-1]
    hand.key(Qt.Key.Key_I)
    assert len(hand.drive.session.selection.links) == 3
    hand.inspector.when.activated.emit(1)
    assert {x.condition.trigger for x in hand.machine.links.values()} == {"up beat"}
    select(hand, "rest loop")
    hand.key(Qt.Key.Key_O)
    hand.key(Qt.Key.Key_C, CONTROL)
    select(hand, "up beat")
    hand.key(Qt.Key.Key_V, CONTROL)
    assert "already exist" in hand.told[-1]
    select(hand, "rest wave rt")
    hand.drive.document.edit(
        "x",
        lambda p: manual_edits.remove_states(
            p, links=manual_groups.find_links(hand.machine, [hand.id("rest wave rt")])
        ),
    )
    hand.key(Qt.Key.Key_V, CONTROL)
    assert "rest wave rt>up beat" in hand.pairs()


@pytest.mark.nightly
def test_states_are_found_by_typing_and_handed_to_the_canvas(hand: Hand) -> None:
    hand.key(Qt.Key.Key_Slash)
    assert QApplication.focusWidget() is hand.editor.search
    QTest.keyClicks(hand.editor.search, "REST w")
    assert chosen(hand) == (hand.id("rest wave rt"),)
    QTest.keyClick(hand.editor.search, Qt.Key.Key_Return)
    assert QApplication.focusWidget() is hand.canvas


def test_a_table_is_imported_pasted_and_copied_and_its_bad_rows_are_told(hand: Hand, tmp_path) -> None:
    path = tmp_path / "links.csv"
    path.write_text("from,to,when\nrest*,up beat,request\nup beat,nobody,\n")
    manual_many.import_table(hand.canvas, path)
    assert len(hand.machine.links) == 1 and len(hand.machine.ways) == 3
    for piece in ("1 link ", "links.csv", "1 row", "line 3", "'nobody'"):
        assert piece in hand.told[-1], piece
    manual_many.copy_table(hand.canvas)
    hand.drive.document.undo()
    assert not hand.machine.links
    QApplication.clipboard().setText("from\tto\nrest loop\tup beat\n")
    menu = QMenu()
    manual_commands.fill_canvas_menu(
        menu, hand.canvas, hand.canvas.scene().hit(hand.canvas.view.back(hand.canvas.at), 1.0)
    )
    QApplication.clipboard().setText("hello")
    manual_many.paste_table(hand.canvas)
    assert "no table" in hand.told[-1]
    QApplication.clipboard().setText("from\tto\nrest loop\tup beat\n")
    manual_many.paste_table(hand.canvas)
    assert hand.pairs() == ["rest loop>up beat"]
    manual_many.import_table(hand.canvas, tmp_path / "none.csv")
    assert "none.csv" in hand.told[-1]


@pytest.mark.nightly
def test_the_menu_of_an_alias_takes_in_what_was_selected(hand: Hand) -> None:
    ident = alias(hand, "rest loop")
    select(hand, "rest long", "up beat")
    menu = QMenu()
    box = hand.canvas.scene().nodes[ident]
    manual_commands.fill_canvas_menu(menu, hand.canvas, hand.canvas.scene().hit(box.center(), 1.0))
    hand.drive.pick(menu, "Add 2 selected states")
    assert len(hand.machine.aliases[ident].states) == 3 and chosen(hand) == (ident,)
    assert "contains rest loop" in manual_commands.describe_canvas_hit(
        hand.canvas, hand.canvas.scene().hit(box.center(), 1.0)
    )
    hand.key(Qt.Key.Key_Delete)
    assert not hand.machine.aliases


@pytest.mark.nightly
def test_arranging_puts_aliases_beside_what_they_stand_for(hand: Hand) -> None:
    ident = alias(hand, "rest loop", "rest long")
    hand.drive.drag(edge_of(hand, ident), hand.middle("up beat"), lambda: bool(hand.machine.links))
    manual_commands.arrange_canvas(hand.canvas)
    made = hand.machine.aliases[ident]
    assert made.x < min(s.x for s in hand.machine.states.values())
    assert len({(r.x(), r.y()) for r in hand.canvas.scene().nodes.values()}) == 6
