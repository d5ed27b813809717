"""The label of clips in Properties: each part set alone, for all selected clips."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.features.library.clip_facts import ClipFacts
from metagraph.graph import edits

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def new(toys, toy):
    """Two clips that are in no stance, selected; the page that shows them."""
    toys.workspaces.choose("graph")
    clips = [(f"{name}.glb", 0, "", toy.clip(name)) for name in ("new one", "new two")]
    toys.document.edit("Add", lambda p: edits.add_clips(p, clips))
    chosen = tuple(c for c in toys.document.project.clips if c not in toys.document.project.uses)
    toys.session.selection.select_clips(chosen)
    toys.wait(lambda: toys.shell.panel("properties").clip.isVisible())
    return chosen


def choose(page, name, value):
    chooser = page.label.choosers[name]
    place = chooser.findData(value)
    chooser.setCurrentIndex(place)
    chooser.activated.emit(place)


def write(page, name, words):
    field = page.label.fields[name]
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, words)
    QTest.keyClick(field, Qt.Key.Key_Return)


@pytest.mark.nightly
def test_a_kind_alone_waits_for_a_stance_and_the_card_says_so(toys, new):
    page = toys.shell.panel("properties").clip
    choose(page, "kind", "gesture")
    project = toys.document.project
    assert not any(clip in project.uses for clip in new)
    assert page.label.waits.text() == "It is placed as soon as its stance is known, too."
    assert ClipFacts(toys.document).missing(project.clips[new[0]]) == "stance?"
    write(page, "stance", "up")
    project = toys.document.project
    assert [project.stance(project.uses[clip][0].stance).name for clip in new] == ["up", "up"]
    assert ClipFacts(toys.document).missing(project.clips[new[0]]) == ""
    toys.document.undo()
    assert not any(clip in toys.document.project.uses for clip in new)


def test_parts_of_placed_clips_are_set_alone_and_what_cannot_be_is_explained(toys, new):
    page = toys.shell.panel("properties").clip
    write(page, "stance", "rest")
    choose(page, "kind", "fidget")
    write(page, "tags", "one, two")
    choose(page, "limb", "left")
    project = toys.document.project
    made = [project.uses[clip][0] for clip in new]
    assert {(a.kind, a.tags, a.limb) for a in made} == {("fidget", ("one", "two"), "left")}
    choose(page, "layer", "head")
    assert "the head layer has no stance 'rest'" in page.trouble.text()
    assert [toys.document.project.uses[clip][0].layer for clip in new] == ["arms", "arms"]
