"""What is done to the meta-graph from its canvas, by drops, keys and menus: an edit, or words that say why
not.
"""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QInputDialog, QWidget

from app.features.graph.graph_drops import Drop, drop_at, perform_drop
from app.features.graph.graph_layout import GraphHit
from app.project.document import Document
from app.project.load import Load
from app.stage.session import StageSession
from app.translation import tr, tr_error, tr_plural
from app.widgets.vocabulary import get_vocabulary_word
from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.half_labels import follow_stance_name
from metagraph.graph.editing.listing import reorder_stances, shift_actions, shift_stance
from metagraph.graph.editing.merging_stances import merge_stances
from metagraph.graph.model import KINDS, LAYERS, Action, Kind, Project, Stance
from metagraph.graph.same_stances import find_same_stances


class GraphActs(QObject):
    """refused: words for the status bar. labelled: clips were placed by a key; (clips, the actions made of
    them). widget: over which questions appear.
    """

    refused = Signal(str)
    labelled = Signal(object, object)

    def __init__(self, document: Document, session: StageSession, widget: QWidget) -> None:
        super().__init__(widget)
        self.document, self.session, self.widget = document, session, widget

    def what(self, hit: GraphHit, load: Load) -> Drop:
        """Return what letting a load go on something would do."""
        return drop_at(
            self.document.project,
            self.session.place.layer,
            self.session.place.stance(),
            self.session.place.other(),
            hit,
            load,
        )

    def do(self, drop: Drop, load: Load) -> None:
        """Perform a drop and select what it made."""
        before = {a.id for a in self.document.project.actions()}
        layer = self.session.place.layer
        if load.actions:
            what = tr_plural("{count:,} action", "{count:,} actions", load.count)
        else:
            what = tr_plural("{count:,} clip", "{count:,} clips", load.count)
        words = (
            tr("Reorder {what}", what=what)
            if drop.reorder
            else tr("Move {what}", what=what)
            if load.actions
            else tr("Place {what}", what=what)
        )
        try:
            self.document.edit(words, lambda p: perform_drop(p, layer, drop, load))
        except EditError as error:
            self.refused.emit(tr_error(error))
            return
        made = tuple(a.id for a in self.document.project.actions() if a.id not in before) or load.actions
        if drop.kind in ("stance", None) and made:
            action = self.document.project.action(made[0])
            if action is not None:
                self.session.place.set_stance(action.stance)
        self.session.selection.select_actions(made)
        self.session.transport.show_plan()

    def place_selection(self, kind: Kind) -> None:
        """Give the selected actions a kind, or place the selected clips with it on the current stance: the
        keys 1 to 4.
        """
        load = Load(clips=self.session.selection.clips)
        if self.session.selection.actions:
            self.set_kind(kind)
            return
        if not load:
            self.refused.emit(tr("Select clips or actions first."))
            return
        if kind == "stance":
            hit = GraphHit("card", self.session.place.stance(), kind)
        else:
            hit = GraphHit("node", None, kind)
        drop = self.what(hit, load)
        if not drop.possible:
            self.refused.emit(drop.words)
            return
        before = self.document.project
        self.do(drop, load)
        if self.document.project is not before:
            self.labelled.emit(load.clips, self.session.selection.actions)

    def set_kind(self, kind: Kind) -> None:
        """Give the selected actions a kind. They stay on their layers and stances."""
        chosen, end = self.session.selection.actions, self.session.place.other()
        words = tr("Change kind")
        try:
            self.document.edit(words, lambda p: edits.set_kind(p, chosen, kind, end))
        except EditError as error:
            self.refused.emit(tr_error(error))

    def shift(self, steps: int) -> None:
        """List the selected actions a place earlier (-1) or later (1) in their nodes."""
        chosen = self.session.selection.actions
        words = tr("Reorder {what}", what=tr_plural("{count:,} action", "{count:,} actions", len(chosen)))
        self.document.edit(words, lambda p: shift_actions(p, chosen, steps))

    def move_to(self, stance: str) -> None:
        chosen = self.session.selection.actions
        try:
            self.document.edit(tr("Move actions"), lambda p: edits.to_stance(p, chosen, stance))
        except EditError as error:
            self.refused.emit(tr_error(error))

    def end_selection_in(self, stance: str) -> None:
        self.end_in(self.session.selection.actions, stance)

    def end_in(self, actions: Sequence[str], stance: str) -> None:
        """Let transitions end in another stance, in one step."""
        try:
            self.document.edit(tr("Change end stance"), lambda p: edits.set_ends(p, actions, stance))
        except EditError as error:
            self.refused.emit(tr_error(error))

    def merge(self, merged: str, into: str) -> None:
        """Make one stance part of another, in one step, and show that."""
        stances = self.document.project.graphs[self.session.place.layer].stances
        if merged not in stances or into not in stances:  # one was removed during the drag
            return
        words = tr("Merge {stance} into {other}", stance=stances[merged].name, other=stances[into].name)
        try:
            self.document.edit(words, lambda p: merge_stances(p, merged, into))
        except EditError as error:
            self.refused.emit(tr_error(error))
            return
        self.session.place.set_stance(into)

    def list_stance(self, stance: str, before: str | None) -> None:
        """List a stance in front of another, or at the end."""
        self.document.edit(tr("Reorder stances"), lambda p: reorder_stances(p, stance, before))

    def shift_stance(self, steps: int, stance: str | None = None) -> None:
        """List a stance, else the current one, a place earlier (-1) or later (1)."""
        found = stance or self.session.place.stance()
        if found is not None:
            self.document.edit(tr("Reorder stances"), lambda p: shift_stance(p, found, steps))

    def show_stance(self, stance: str) -> None:
        """Show a stance, and on the other layers those that are one posture with it."""
        found = self.document.project.stance(stance)
        if found is not None:
            same = find_same_stances(self.document.project, found.layer).get(stance, ())
            self.session.place.set_stances((stance, *(s.id for s in same)))

    def find_stance(self) -> None:
        """Ask for a stance by typing, and go there."""
        from app.features.graph.stance_finder import StanceFinder

        layer = self.session.place.layer
        StanceFinder(self.document.project, layer, self.show_stance, self.widget.window()).open()

    def list_namesakes(self, stance: str) -> list[Stance]:
        """The stances of other layers whose name a stance can take, to be one posture with them."""
        project, found = self.document.project, self.document.project.stance(stance)
        if found is None:
            return []
        taken = {s.name.casefold() for s in project.graphs[found.layer].stances.values() if s.id != stance}
        others = (s for x in LAYERS if x != found.layer for s in project.graphs[x].stances.values())
        return [s for s in others if s.name.casefold() not in taken]

    def mark_same(self, stance: str, other: str) -> None:
        """Make a stance one posture with a stance of another layer: it takes its name."""
        found = self.document.project.stance(other)
        if found is not None:
            self._rename(stance, found.name, tr("Same stance as {other}", other=found.name))

    def _rename(self, stance: str, name: str, words: str) -> None:
        def rename(project: Project) -> Project:
            before = project.stance(stance)
            project = edits.rename_stance(project, stance, name)
            renamed = project.stance(stance)
            assert before is not None and renamed is not None
            return follow_stance_name(project, before.layer, before.name, renamed.name)

        self.document.edit(words, rename)

    def show_clip(self) -> None:
        actions = self.session.selection.selected_actions()
        self.session.selection.select_clips(tuple(dict.fromkeys(a.clip for a in actions)))

    def new_stance(self) -> None:
        name, accepted = QInputDialog.getText(
            self.widget,
            tr("New stance"),
            tr("Name of the new {layer} stance:", layer=get_vocabulary_word(self.session.place.layer)),
        )
        if accepted and name.strip():
            layer = self.session.place.layer
            self.document.edit(tr("New stance"), lambda p: edits.add_stance(p, layer, name))
            self.session.place.set_stance(list(self.document.project.graphs[layer].stances)[-1])

    def rename_stance(self, stance: str | None = None) -> None:
        found = self.document.project.stance(stance or self.session.place.stance())
        if found is None:
            return
        name, accepted = QInputDialog.getText(self.widget, tr("Rename stance"), tr("Name:"), text=found.name)
        if accepted and name.strip():
            self._rename(found.id, name, tr("Rename stance"))

    def remove_selection(self) -> None:
        """Take the selected actions out of the graph."""
        gone = self.session.selection.actions
        if gone:
            self.document.edit(
                tr("Remove {actions}", actions=tr_plural("{count:,} action", "{count:,} actions", len(gone))),
                lambda p: edits.remove_actions(p, gone),
            )

    def listed(self) -> list[Action]:
        """The actions of the current stance, in the order of the nodes."""
        stance = self.session.place.stance()
        graph = self.document.project.graphs[self.session.place.layer]
        return [a for kind in KINDS[1:] for a in (graph.of(stance, kind) if stance else ())]

    def loops(self) -> tuple[Action, ...]:
        """The loops of the current stance."""
        stance = self.session.place.stance()
        graph = self.document.project.graphs[self.session.place.layer]
        return tuple(graph.of(stance, "stance")) if stance else ()

    def nudge_likelihood(self, action: str, by: float) -> None:
        """Make the selected actions, or one alone, likelier or less likely; a key held down is one step."""
        found = self.document.project.action(action)
        if found is not None:
            value = round(min(3.0, max(0.1, found.likelihood + by)), 1)
            chosen = self.session.selection.actions or (action,)
            self.document.edit(
                tr("Change likelihood"),
                lambda p: edits.update_actions(p, chosen, likelihood=value),
                merge="likelihood keys",
            )

    def select(self, action: str, more: bool, since: str | None) -> None:
        """Select what is pressed. more: beside what is selected already, or no longer. since: all from this
        one on.
        """
        chosen, ids = self.session.selection.actions, [a.id for a in self.listed()]
        if more:
            rest = tuple(i for i in chosen if i != action)
            self.session.selection.select_actions(rest if action in chosen else (*chosen, action))
        elif since is not None:
            if since in ids and action in ids:
                a, b = sorted((ids.index(since), ids.index(action)))
                self.session.selection.select_actions(tuple(ids[a : b + 1]))
        elif action not in chosen:
            self.session.selection.select_actions((action,))
