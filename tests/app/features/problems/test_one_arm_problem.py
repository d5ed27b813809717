"""A stance with gestures of one arm only is a hint, and one click makes the other arm's."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.features.problems.problems_panel import FIX
from metagraph.formats.gltf.writer import write_glb
from metagraph.graph import edits
from metagraph.graph.editing.one_sided import list_one_sided

pytestmark = [pytest.mark.window, pytest.mark.gl]


def test_one_click_makes_the_twins_that_a_stance_lacks(drive, toy, tmp_path):
    for name, swing in (("rest", 0.0), ("wave rt", 0.6), ("beat rt", 0.4)):
        write_glb(tmp_path / f"{name}.glb", [toy.clip(name, 1.0, swing=swing)])
    drive.importing.import_paths([str(tmp_path)])
    drive.wait(lambda: len(drive.document.project.clips) == 3)
    ids = {clip.name: clip.id for clip in drive.document.project.clips.values()}
    drive.document.edit("Stance", lambda p: edits.add_stance(p, "arms", "rest", [ids["rest"]]))
    stance = next(iter(drive.document.project.graphs["arms"].stances))
    drive.document.edit(
        "Place", lambda p: edits.place_clips(p, [ids["wave rt"], ids["beat rt"]], "arms", "gesture", stance)
    )
    drive.document.save(tmp_path / "p.metagraph.yaml")
    panel, tree = drive.problems_panel, drive.problems_panel.tree
    drive.show("problems")

    def rows():
        found = (tree.topLevelItem(n) for n in range(tree.topLevelItemCount()))
        return [row for row in found if "none of the left" in row.text(0)]

    drive.wait(lambda: bool(rows()) and tree.isVisible())
    (row,) = rows()
    assert row.text(0).startswith("'rest' has 2 actions of the right arm")
    assert row.text(FIX) == "Make 2 twins" and not [f for f in panel.fixable() if f.command]
    tree.scrollToItem(row)
    cell = tree.visualRect(tree.indexFromItem(row, FIX))
    steps = drive.document.undo_stack.count()
    QTest.mouseClick(
        tree.viewport(), Qt.MouseButton.LeftButton, pos=QPoint(cell.left() + 20, cell.center().y())
    )
    drive.wait(lambda: not list_one_sided(drive.document.project))
    made = [a for a in drive.document.project.actions() if a.limb == "left"]
    assert sorted(a.name for a in made) == ["beat lf", "wave lf"]
    assert drive.document.undo_stack.count() == steps + 1
    drive.wait(lambda: not rows())
    drive.actions["undo"].trigger()
    drive.wait(lambda: bool(rows()))
