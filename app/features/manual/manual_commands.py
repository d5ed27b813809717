"""What can be done in the editor: one list that makes the menus and the keys, and the words about what is
under the mouse.
"""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent, QKeySequence
from PySide6.QtWidgets import QMenu

from app.features.manual import manual_many
from app.features.manual.arranging import arrange_nodes
from app.features.manual.drags.host import ManualHost
from app.features.manual.manual_painter import describe_link, describe_state_facts
from app.features.manual.manual_scene import ManualHit
from app.project.load import Load
from app.translation import tr, tr_phrase, tr_plural
from metagraph.graph.manual import edits as manual_edits
from metagraph.graph.manual.machine import ANY, Link
from metagraph.graph.model import Project

Run = Callable[[], object]
Standard = QKeySequence.StandardKey
SHIFT = 28.0  # units by which a duplicate stands beside what it is of


class Clipboard:
    """What was copied last: states with the links among them, or links, one of which gives its settings to
    other links.
    """

    piece: manual_edits.CopiedPiece | None = None
    links: tuple[Link, ...] = ()

    @property
    def settings(self) -> Link | None:
        """The settings that are pasted onto links."""
        return self.links[0] if len(self.links) == 1 else None


kept = Clipboard()


def remove_selected(canvas: ManualHost) -> None:
    s = canvas.session
    count = len(s.selection.states) + len(s.selection.links)
    if count == 1:
        text = tr("Remove state") if s.selection.states else tr("Remove link")
    elif s.selection.states and s.selection.links:
        text = tr("Remove {count:,} nodes and links", count=count)
    elif s.selection.states:
        text = tr_plural("Remove {count:,} state", "Remove {count:,} states", count)
    else:
        text = tr_plural("Remove {count:,} link", "Remove {count:,} links", count)
    canvas.do(text, lambda p: manual_edits.remove_states(p, s.selection.states, s.selection.links))


def copy(canvas: ManualHost) -> None:
    """Keep the selected states, or the selected links."""
    s, project = canvas.session, canvas.document.project
    if s.selection.states:
        kept.piece, kept.links = manual_edits.copy_states(project, s.selection.states), ()
    elif s.selection.links:
        found = (project.link(i) for i in s.selection.links)
        kept.piece, kept.links = None, tuple(x for x in found if x is not None)


def paste_here(canvas: ManualHost) -> None:
    """Paste states where the mouse is, settings onto the selected links, or links for the selected states."""
    links, settings = canvas.session.selection.links, kept.settings
    if settings is not None and links:
        canvas.do(tr("Paste link settings"), lambda p: manual_edits.paste_settings(p, links, settings))
    elif kept.links and canvas.session.selection.states:
        manual_many.paste_links_on_selected(canvas, kept.links)
    elif kept.piece is not None:
        at = canvas.view.back(canvas.at)
        _paste(canvas, kept.piece, at.x(), at.y(), tr("Paste {states}", states=_states(kept.piece)))


def duplicate(canvas: ManualHost) -> None:
    piece = manual_edits.copy_states(canvas.document.project, canvas.session.selection.states)
    if piece.states:
        x, y = min(s.x for s in piece.states), min(s.y for s in piece.states)
        _paste(canvas, piece, x + SHIFT, y + SHIFT, tr("Duplicate {states}", states=_states(piece)))


def _states(piece: manual_edits.CopiedPiece) -> str:
    return tr_plural("{count:,} state", "{count:,} states", len(piece.states))


def _paste(canvas: ManualHost, piece: manual_edits.CopiedPiece, x: float, y: float, words: str) -> None:
    layer = canvas.session.place.layer
    made: tuple[str, ...] = ()

    def edit(project: Project) -> Project:
        nonlocal made
        after, made = manual_edits.paste_states(project, layer, piece, round(x / 8) * 8, round(y / 8) * 8)
        return after

    if canvas.do(words, edit):
        canvas.session.selection.select_states(made)


def select_all(canvas: ManualHost) -> None:
    canvas.session.selection.select_states(tuple(canvas.scene().manual.states))


def arrange_canvas(canvas: ManualHost) -> None:
    """Put every node where the automatic layout has it, and show all."""
    layer, places = canvas.session.place.layer, arrange_nodes(canvas.scene().manual)
    canvas.do(tr("Arrange nodes"), lambda p: manual_edits.move_nodes(p, layer, places))
    canvas.session.selection.select_states()
    canvas.fit()


def start_here(canvas: ManualHost, state: str) -> None:
    canvas.do(tr("Start here"), lambda p: manual_edits.set_start_state(p, state))


def nudge(canvas: ManualHost, x: float, y: float) -> None:
    """Move the selected nodes a little."""
    layer, found = canvas.session.place.layer, canvas.scene().manual.states
    places = {i: (found[i].x + x, found[i].y + y) for i in canvas.session.selection.states if i in found}
    if places:
        canvas.do(
            tr_plural("Move {count:,} node", "Move {count:,} nodes", len(places)),
            lambda p: manual_edits.move_nodes(p, layer, places),
        )


def can_paste(canvas: ManualHost) -> bool:
    links = kept.settings is not None and bool(canvas.session.selection.links)
    return kept.piece is not None or links or (bool(kept.links) and bool(canvas.session.selection.states))


def find_key_command(canvas: ManualHost, event: QKeyEvent) -> Run | None:
    """Return what a key does here, None if it is the window's."""
    s = canvas.session
    control = event.modifiers() == Qt.KeyboardModifier.ControlModifier
    if event.key() == Qt.Key.Key_G and control and s.selection.states:
        return lambda: manual_many.make_alias(canvas)
    if event.key() in (Qt.Key.Key_O, Qt.Key.Key_I) and not event.modifiers() and s.selection.states:
        into = event.key() == Qt.Key.Key_I
        return lambda: manual_many.select_links(canvas, into)
    if event.key() == Qt.Key.Key_Escape:
        return (lambda: canvas.hand.drop("escape")) if canvas.hand.gesture is not None else None
    if event.text() == "/":
        return canvas.find_states
    if event.key() == Qt.Key.Key_D and control:  # on X11 also a key to delete
        return lambda: duplicate(canvas)
    for standard, run in (
        (Standard.Delete, remove_selected),
        (Standard.Copy, copy),
        (Standard.Paste, paste_here),
        (Standard.SelectAll, select_all),
    ):
        if event.matches(standard):
            return lambda: run(canvas)
    plain = not event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
    if event.key() == Qt.Key.Key_F and plain:
        return canvas.fit
    if event.key() == Qt.Key.Key_Backspace and plain:
        return lambda: remove_selected(canvas)
    arrow = {
        Qt.Key.Key_Left: (-1, 0),
        Qt.Key.Key_Right: (1, 0),
        Qt.Key.Key_Up: (0, -1),
        Qt.Key.Key_Down: (0, 1),
    }
    step = arrow.get(Qt.Key(event.key()))
    if step is not None and s.selection.states:
        far = 24 if event.modifiers() & Qt.KeyboardModifier.ShiftModifier else 8
        return lambda: nudge(canvas, step[0] * far, step[1] * far)
    return None


def fill_canvas_menu(out: QMenu, canvas: ManualHost, hit: ManualHit) -> None:
    """Fill a menu with what can be done with what is under the mouse; it is selected, unless it is
    already.
    """
    s = canvas.session

    def add(text: str, run: Run, keys: str = "", enabled: bool = True) -> None:
        told = QKeySequence(keys).toString(QKeySequence.SequenceFormat.NativeText)
        action = out.addAction(f"{text}\t{told}" if keys else text, run)
        action.setEnabled(enabled)

    node = hit.area in ("node", "edge")
    others = tuple(i for i in s.selection.states if i in canvas.scene().manual.states)
    if node and hit.ident != ANY and hit.ident not in s.selection.states:
        s.selection.select_states((hit.ident,))
    if hit.area == "link" and hit.ident not in s.selection.links:
        s.selection.select_states((), (hit.ident,))
    if node:
        add(tr("Draw link from here"), lambda: canvas.begin_link(hit.ident))
    alias = canvas.scene().manual.aliases.get(hit.ident)
    if alias is not None:
        _fill_alias(canvas, add, alias.id, others)
    if node and hit.ident != ANY and alias is None:
        add(tr("Make alias from selection"), lambda: manual_many.make_alias(canvas), "Ctrl+G")
        add(
            tr("Start here"),
            lambda: start_here(canvas, hit.ident),
            enabled=canvas.scene().manual.start != hit.ident,
        )
        add(tr("Play alone"), lambda: s.show_context(hit.ident))
    if node and hit.ident != ANY:
        out.addSeparator()
        add(tr("Select links out of here"), lambda: manual_many.select_links(canvas, False), "O")
        add(tr("Select links to here"), lambda: manual_many.select_links(canvas, True), "I")
        out.addSeparator()
        if kept.links:
            add(tr("Paste links"), lambda: paste_here(canvas), "Ctrl+V")
        add(tr("Copy"), lambda: copy(canvas), "Ctrl+C")
        add(tr("Duplicate"), lambda: duplicate(canvas), "Ctrl+D")
        add(tr("Remove"), lambda: remove_selected(canvas), "Del")
    elif hit.area == "link":
        add(tr("Play link"), lambda: s.show_context(hit.ident))
        out.addSeparator()
        add(tr("Copy"), lambda: copy(canvas), "Ctrl+C")
        add(tr("Paste settings"), lambda: paste_here(canvas), "Ctrl+V", kept.settings is not None)
        add(tr("Remove"), lambda: remove_selected(canvas), "Del")
    elif not node:
        add(tr("Paste"), lambda: paste_here(canvas), "Ctrl+V", kept.piece is not None)
        add(tr("Select all"), lambda: select_all(canvas), "Ctrl+A")
        out.addSeparator()
        chosen = bool(s.selection.states)
        add(tr("Make alias from selection"), lambda: manual_many.make_alias(canvas), "Ctrl+G", chosen)
        there = bool(canvas.scene().manual.states)
        add(tr("Make alias of all states"), lambda: manual_many.make_alias(canvas, True), enabled=there)
        add(
            tr("Paste links from a table"),
            lambda: manual_many.paste_table(canvas),
            "",
            manual_many.has_table(),
        )
        add(tr("Copy links as a table"), lambda: manual_many.copy_table(canvas), enabled=there)
        out.addSeparator()
        add(tr("Arrange nodes"), lambda: arrange_canvas(canvas), enabled=bool(canvas.scene().manual.states))
        add(tr("Show all"), lambda: _show_all(canvas), "F")


def _fill_alias(canvas: ManualHost, add: Callable[..., None], alias: str, chosen: tuple[str, ...]) -> None:
    """Offer what can be done with an alias. chosen: the states that were selected before."""
    add(tr("Select its states"), lambda: manual_many.select_members(canvas, alias))
    if chosen:
        count = len(chosen)
        add(
            tr_plural("Add {count:,} selected state", "Add {count:,} selected states", count),
            lambda: manual_many.choose_for_alias(canvas, alias, chosen),
        )
        add(
            tr_plural("Remove {count:,} selected state", "Remove {count:,} selected states", count),
            lambda: manual_many.choose_for_alias(canvas, alias, chosen, False),
        )


def _show_all(canvas: ManualHost) -> None:
    canvas.session.selection.select_states()
    canvas.fit()


def drop_words(project: Project, load: Load) -> tuple[bool, str]:
    """Return whether a drop makes states, and what it does or why not."""
    why = manual_edits.find_state_refusal(project, load.clips) if load.clips else None
    words = tr_phrase(why or "") or (
        tr_plural("drop to add {count:,} state here", "drop to add {count:,} states here", load.count)
    )
    return why is None, words[:1].upper() + words[1:]


def describe_canvas_hit(canvas: ManualHost, hit: ManualHit) -> str:
    """Return what to say about what is under the mouse."""
    manual = canvas.scene().manual
    trouble = canvas.troubles.get(hit.ident, "")
    if hit.ident == ANY:
        return tr(
            "Any state: links from here can be taken from every state\nDrag from its border to a "
            "state to draw a link"
        )
    if hit.area in ("node", "edge") and hit.ident in manual.aliases:
        alias = manual.aliases[hit.ident]
        names = [manual.states[i].name for i in manual.members(alias)]
        more = tr(" and {count} more", count=len(names) - 12) if len(names) > 12 else ""
        stands = (
            tr("contains {names}{more}", names=", ".join(names[:12]), more=more)
            if names
            else tr("contains no states")
        )
        help_ = tr("Drag from its border to draw links from all its states, double-click to select them")
        return "\n".join(x for x in (alias.name, stands, trouble, help_) if x)
    if hit.area in ("node", "edge") and hit.ident in manual.states:
        state = manual.states[hit.ident]
        help_ = (
            tr("Drag to draw a link")
            if hit.area == "edge"
            else tr("Drag to move, double-click to play it alone")
        )
        return "\n".join(
            x for x in (state.name, describe_state_facts(canvas.document.project, state), trouble, help_) if x
        )
    if hit.area == "link" and hit.ident in manual.links:
        link = manual.links[hit.ident]
        begins = tr("Any state") if link.source == ANY else manual_edits.get_manual_name(manual, link.source)
        ends = f"{begins} → {manual_edits.get_manual_name(manual, link.target)}"
        when = (
            tr("on request: ")
            if link.condition.when == "request"
            else tr("when finished ")
            if not describe_link(link)
            else tr("at ")
        )
        return "\n".join(
            x
            for x in (
                ends,
                f"{when}{describe_link(link)}".strip(),
                tr("has a blend of {blend:g} s", blend=link.blend),
                trouble,
            )
            if x
        )
    return ""
