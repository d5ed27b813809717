"""The menus of the canvas."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QMenu

from app.features.graph.graph_acts import GraphActs
from app.features.graph.graph_layout import GraphHit
from app.translation import tr
from app.widgets.vocabulary import get_vocabulary_title
from metagraph.graph import edits


def make_menu_for(acts: GraphActs, hit: GraphHit, row_actions: Sequence[QAction]) -> QMenu:
    """Return the menu for what is under the pointer, and select an action there."""
    menu = QMenu(acts.widget)
    menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    if hit.area in ("row", "bar", "head") and hit.ident:
        if hit.ident not in acts.session.selection.actions:
            acts.session.selection.select_actions((hit.ident,))
        menu.addAction(tr("Play in context"), lambda: acts.session.show_context(str(hit.ident)))
        menu.addSeparator()
        move = menu.addMenu(tr("Move to stance"))
        for stance in acts.document.project.graphs[acts.session.place.layer].stances.values():
            move.addAction(stance.name, partial(acts.move_to, stance.id))
        if hit.kind == "transition":
            ends = menu.addMenu(tr("End in stance"))
            for stance in acts.document.project.graphs[acts.session.place.layer].stances.values():
                if stance.id != acts.session.place.stance():
                    ends.addAction(stance.name, partial(acts.end_selection_in, stance.id))
        menu.addAction(tr("Show clip in the library"), acts.show_clip)
        menu.addSeparator()
        menu.addActions(row_actions)
        menu.addSeparator()
        menu.addAction(tr("Remove from the graph\tDel"), acts.remove_selection)
    elif hit.area in ("chip", "card") and hit.ident:
        stance_id = hit.ident
        menu.addAction(tr("Rename stance…\tF2"), lambda: acts.rename_stance(stance_id))
        menu.addAction(
            tr("Start here"),
            lambda: acts.document.edit(tr("Start here"), lambda p: edits.set_start_stance(p, stance_id)),
        )
        others = [
            s
            for s in acts.document.project.graphs[acts.session.place.layer].stances.values()
            if s.id != hit.ident
        ]
        if others:
            into = menu.addMenu(tr("Merge into"))
            for stance in others:
                into.addAction(stance.name, partial(acts.merge, stance_id, stance.id))
        namesakes = acts.list_namesakes(stance_id)
        if namesakes:
            same = menu.addMenu(tr("Same as"))
            own = acts.document.project.stance(stance_id)
            for stance in namesakes:
                text = tr("{layer}: {stance}", layer=get_vocabulary_title(stance.layer), stance=stance.name)
                entry = same.addAction(text, partial(acts.mark_same, stance_id, stance.id))
                entry.setCheckable(True)
                entry.setChecked(own is not None and own.name.casefold() == stance.name.casefold())
        menu.addSeparator()
        menu.addAction(tr("Move stance left"), partial(acts.shift_stance, -1, stance_id))
        menu.addAction(tr("Move stance right"), partial(acts.shift_stance, 1, stance_id))
        menu.addAction(tr("Find stance…"), acts.find_stance)
        menu.addSeparator()
        menu.addAction(
            tr("Remove stance and its actions"),
            lambda: acts.document.edit(tr("Remove stance"), lambda p: edits.remove_stance(p, stance_id)),
        )
    else:
        menu.addAction(tr("New stance…"), acts.new_stance)
    return menu


def make_ends_menu(acts: GraphActs) -> QMenu:
    """Return a menu of the stances that dropped transitions can end in."""
    menu = QMenu(acts.widget)
    menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    current, other = acts.session.place.stance(), acts.session.place.other()
    for stance in acts.document.project.graphs[acts.session.place.layer].stances.values():
        if stance.id != current:
            entry = menu.addAction(stance.name, partial(acts.session.place.set_other, stance.id))
            entry.setCheckable(True)
            entry.setChecked(stance.id == other)
    if menu.isEmpty():
        menu.addAction(tr("Make a second stance first")).setEnabled(False)
    return menu
