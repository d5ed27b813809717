"""What can be done with clips: a menu, and what its entries do."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QInputDialog, QMenu, QWidget

from app.features.library.clip_badges import HEART, label_icon
from app.features.library.clip_columns import format_stars
from app.look.domain_words import COLOR_LABELS
from app.project.document import Document
from app.stage.session import StageSession
from app.translation import tr, tr_plural
from metagraph.graph import edits
from metagraph.graph.clip_mark import COLORS, STARS
from metagraph.graph.editing.listing import duplicate_clips
from metagraph.graph.editing.marks import mark, mark_of
from metagraph.graph.editing.retiming import keep_clips_in_place
from metagraph.graph.model import ClipEntry


class ClipActs:
    """widget: over which menus and questions appear. row_actions: the window's commands that go into a clip's
    menu. label_actions: those that say what it is.
    """

    def __init__(self, document: Document, session: StageSession, widget: QWidget) -> None:
        self.document, self.session, self.widget = document, session, widget
        self.row_actions: list[QAction] = []
        self.label_actions: list[QAction] = []

    def menu(self, entry: ClipEntry) -> QMenu:
        """Return what can be done with a clip, and with all selected ones."""
        out = QMenu(self.widget)
        out.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        chosen = self.session.selection.clips if entry.id in self.session.selection.clips else (entry.id,)
        out.addAction(tr("Play clip only"), lambda: self.session.transport.show_clip(entry.id))
        out.addAction(tr("Play in context"), lambda: self.session.show_context(entry.id))
        out.addSeparator()
        if self.label_actions:
            out.addMenu(tr("&Label as")).addActions(self.label_actions)
        self._fill_marks(out.addMenu(tr("&Mark")), chosen)
        out.addSeparator()
        out.addAction(tr("Use first frame as base pose"), lambda: self.use_as_base(entry.id, 0))
        if self.session.transport.show == "clip" and self.session.transport.shown == entry.id:
            frame = round(self.session.transport.seconds * entry.fps)
            out.addAction(
                tr("Use this frame ({frame}) as base pose", frame=frame),
                lambda: self.use_as_base(entry.id, frame),
            )
        out.addAction(
            tr("Use rest pose as base pose"),
            lambda: self.document.edit(tr("Set base pose"), lambda p: edits.set_base(p, None)),
        )
        out.addSeparator()
        clips = self.document.project.clips
        held = all(clips[clip].in_place for clip in chosen if clip in clips)
        action = out.addAction(tr("Keep in place"), lambda: self.keep_in_place(chosen, not held))
        action.setCheckable(True)
        action.setChecked(held)
        action.setToolTip(tr("Removes the distance and the turn that the hips have made by the end"))
        out.addAction(tr("Rename…\tF2"), lambda: self.rename(entry.id))
        out.addAction(tr("Duplicate\tCtrl+Shift+D"), lambda: self.duplicate(chosen))
        out.addAction(tr("Reveal in folder"), lambda: self.reveal(entry.id))
        out.addActions(self.row_actions)
        out.addSeparator()
        words = tr_plural(
            "Remove clip from the project\tDel", "Remove {count:,} clips from the project\tDel", len(chosen)
        )
        out.addAction(words, lambda: self.remove(chosen))
        return out

    def _fill_marks(self, menu: QMenu, clips: Iterable[str]) -> None:
        """Offer colour labels, stars and a heart; what all clips have is checked."""
        some = tuple(clips)
        marks = [mark_of(self.document.project, clip) for clip in some]

        def entry(words: str, field: str, value: object, keys: str = "") -> QAction:
            text = f"{words}\t{keys}" if keys else words
            action = menu.addAction(text, partial(self.mark, some, field, value))
            action.setCheckable(True)
            action.setChecked(all(getattr(m, field) == value for m in marks))
            return action

        for color in COLORS:
            entry(COLOR_LABELS[color], "color", color).setIcon(label_icon(color))
        entry(tr("No label"), "color", "")
        menu.addSeparator()
        for rating in range(STARS, -1, -1):
            entry(format_stars(rating) or tr("No stars"), "rating", rating, f"Ctrl+Shift+{rating}")
        menu.addSeparator()
        loved = all(m.favourite for m in marks)
        action = menu.addAction(
            tr("{heart}  Favourite", heart=HEART), lambda: self.mark(some, "favourite", not loved)
        )
        action.setCheckable(True)
        action.setChecked(loved)

    def keep_in_place(self, clips: Iterable[str], on: bool) -> None:
        """Keep clips in place, or let them go their own way."""
        some = tuple(clips)
        what = tr_plural("{count:,} clip", "{count:,} clips", len(some))
        words = tr("Keep {clips} in place", clips=what) if on else tr("Let {clips} travel", clips=what)
        self.document.edit(words, lambda p: keep_clips_in_place(p, some, on))

    def mark(self, clips: Iterable[str], field: str, value: object) -> None:
        """Put something on clips: one field of a `ClipMark`."""
        some = tuple(clips)
        what = tr_plural("{count:,} clip", "{count:,} clips", len(some))
        words = {
            "color": tr("Set colour of {clips}", clips=what),
            "rating": tr("Rate {clips}", clips=what),
            "favourite": tr("Set favourite of {clips}", clips=what),
        }[field]
        self.document.edit(words, lambda p: mark(p, some, **{field: value}))

    def favour(self, clips: Iterable[str]) -> None:
        """Put a heart on clips; where all have one, take it away."""
        some = tuple(clips)
        loved = all(mark_of(self.document.project, clip).favourite for clip in some)
        self.mark(some, "favourite", not loved)

    def duplicate(self, clips: Iterable[str]) -> None:
        """List clips once more, and select what was made."""
        some, before = tuple(clips), self.document.project.clips
        if some:
            self.document.edit(
                tr("Duplicate {clips}", clips=tr_plural("{count:,} clip", "{count:,} clips", len(some))),
                lambda p: duplicate_clips(p, some),
            )
            made = tuple(i for i in self.document.project.clips if i not in before)
            self.session.selection.select_clips(made)

    def reveal(self, clip: str) -> None:
        """Show a clip's file in the system's file manager."""
        entry = self.document.project.clips[clip]
        from app.project.reveal import reveal

        reveal((self.document.folder or Path()) / entry.path)

    def use_as_base(self, clip: str, frame: int) -> None:
        self.document.edit(tr("Set base pose"), lambda p: edits.set_base(p, clip, frame))

    def rename(self, clip: str) -> None:
        entry = self.document.project.clips[clip]
        name, accepted = QInputDialog.getText(self.widget, tr("Rename clip"), tr("Name:"), text=entry.name)
        if accepted and name.strip():
            self.document.edit(tr("Rename clip"), lambda p: edits.rename_clip(p, clip, name))

    def remove(self, clips: Iterable[str]) -> None:
        gone = tuple(clips)
        if gone:
            self.document.edit(
                tr("Remove {clips}", clips=tr_plural("{count:,} clip", "{count:,} clips", len(gone))),
                lambda p: edits.remove_clips(p, gone),
            )
