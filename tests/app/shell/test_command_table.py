"""A table's commands are done by the feature they are bound to, in the window's language."""

from __future__ import annotations

import itertools
from types import SimpleNamespace

import pytest

from app import translation
from app.shell.actions import Command
from app.shell.command_table import bind_commands, require_all, require_any, require_not
from app.translation import tr_noop
from tests.app.catalogue_texts import catalogue_texts

TABLE = (
    Command(
        "undo",
        "&Edit",
        "history",
        lambda feature: f"Undo {feature.name}",
        lambda feature: feature.done.append("undo"),
        ("Ctrl+Z",),
        tip=tr_noop("Undo"),
        enabled=lambda feature: feature.on,
        checked=lambda feature: not feature.on,
    ),
    Command(
        "fill", "&Edit", "history", tr_noop("Undo"), fill=lambda feature, menu: feature.done.append(menu)
    ),
)


@pytest.fixture
def feature():
    yield SimpleNamespace(name="move", on=True, done=[])
    translation.choose("en")


def test_a_command_asks_and_does_what_its_feature_says(feature):
    undo, fill = bind_commands(TABLE, feature)
    undo.run()
    fill.fill("a menu")
    assert feature.done == ["undo", "a menu"]
    assert undo.enabled() and not undo.checked() and undo.words == "Undo move"
    feature.on, feature.name = False, "turn"
    assert not undo.enabled() and undo.checked() and undo.words == "Undo turn"
    assert (undo.id, undo.keys, undo.visible) == ("undo", ("Ctrl+Z",), None)
    fill.run()  # a submenu does nothing itself


def test_two_windows_have_commands_of_their_own(feature):
    other = SimpleNamespace(name="other", on=False, done=[])
    (mine, _), (theirs, _) = bind_commands(TABLE, feature), bind_commands(TABLE, other)
    theirs.run()
    assert other.done and not feature.done and mine.enabled() and not theirs.enabled()


def test_texts_are_in_the_language_that_is_chosen_when_the_window_is_made(feature):
    translation.choose("de")
    undo, fill = bind_commands(TABLE, feature)
    assert undo.tip == fill.words == catalogue_texts("de")["Undo"] != "Undo"


def test_conditions_combine():
    def first(feature):
        return feature[0]

    def second(feature):
        return feature[1]

    for a, b in itertools.product((False, True), repeat=2):
        assert require_all(first, second)((a, b)) == (a and b)
        assert require_any(first, second)((a, b)) == (a or b)
        assert require_not(require_all(first, require_not(second)))((a, b)) == (not a or b)
    assert require_all()(()) and not require_any()(())


@pytest.mark.window
@pytest.mark.gl
def test_no_menu_has_more_than_fifteen_entries(toys):
    for name, menu in toys.menus.items():
        menu.aboutToShow.emit()
        entries = [a for a in menu.actions() if a.isVisible() and not a.isSeparator()]
        assert 0 < len(entries) <= 15, name
        inside = [a.menu() for a in entries if a.menu() is not None and a.objectName() == ""]
        assert all(0 < len(sub.actions()) <= 20 for sub in inside), name
