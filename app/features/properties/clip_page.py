"""The properties of clips: what was read, and what uses them."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QWidget

from app.features.properties.label_rows import LabelRows
from app.features.properties.page_form import Edit, add_form, make_page_box
from app.look.theme import KIND_MARKS, get_theme
from app.project.document import Document
from app.stage.session import StageSession
from app.translation import tr, tr_error, tr_phrase, tr_plural
from app.widgets.restyling import set_sheet
from app.widgets.vocabulary import get_vocabulary_word
from metagraph.playback.action_table import Column, list_clip_rows, write_cells


class ClipPage(QWidget):
    def __init__(self, document: Document, session: StageSession, edit: Edit, parent: QWidget) -> None:
        super().__init__(parent)
        self.document, self.session, self.edit = document, session, edit
        box = make_page_box(self)
        self.title = QLabel(self, wordWrap=True)
        self.title.setProperty("title", True)
        self.words = QLabel(self, wordWrap=True)
        self.words.setProperty("dim", True)
        self.words.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        box.addWidget(self.title)
        box.addWidget(self.words)
        self.uses = QLabel(self, wordWrap=True)
        self.uses.setTextFormat(Qt.TextFormat.RichText)
        self.uses.linkActivated.connect(lambda ident: self.session.jump(action=ident))
        box.addWidget(self.uses)
        self.label = LabelRows(add_form(box), self)
        self.label.wanted.connect(self._set_label)
        self.trouble = QLabel(self, wordWrap=True)
        box.addWidget(self.trouble)
        box.addStretch(1)

    def show_clips(self, clips: Sequence[str]) -> None:
        """Show what clips are, and what uses them."""
        project, t = self.document.project, get_theme(self.session.look.name)
        entries = [project.clips[c] for c in clips]
        total = sum(e.duration for e in entries)
        if len(entries) == 1:
            e = entries[0]
            self.title.setText(e.name)
            notes = "".join(
                f"\n\n{tr_phrase(note)}"
                for note in (e.motion.notes if e.motion is not None else (tr("The file is missing."),))
            )
            self.words.setText(
                tr(
                    "{duration:.2f} s, {frames} frames at {fps:g} fps\n{path}{notes}",
                    duration=e.duration,
                    frames=e.frames,
                    fps=e.fps,
                    path=e.path,
                    notes=notes,
                )
            )
        else:
            self.title.setText(tr_plural("{count:,} clip", "{count:,} clips", len(entries)))
            self.words.setText(tr("{total:.1f} s in total", total=total))
        lines = []
        for action in [a for c in clips for a in project.uses.get(c, ())][:20]:
            stance = project.stance(action.stance)
            color = t.kinds[action.kind]
            where = escape(
                tr(
                    "{kind} of {stance}, {layer}",
                    kind=get_vocabulary_word(action.kind),
                    stance=stance.name if stance else "?",
                    layer=get_vocabulary_word(action.layer),
                )
            )
            lines.append(
                f"<p style='margin:2px'><span style='color:{color}'>{KIND_MARKS[action.kind]}</span> "
                f"<a style='color:{t.text}' href='{action.id}'>{where}</a></p>"
            )
        keys = tr(
            "<p>Drag onto a node, or press <b>1</b> stance, <b>2</b> gesture, <b>3</b> fidget, <b>4</b> "
            "transition.</p>"
        )
        self.uses.setText("".join(lines) + keys)
        self.label.show_clips(project, clips)
        self._say("")

    def _set_label(self, column: Column, text: str) -> None:
        """Set one part of the label of the selected clips, and say what could not be set."""
        rows = list_clip_rows(self.document.project, self.session.selection.clips)
        written = write_cells(self.document.project, {(row.ident, column): text for row in rows})
        words = {
            "kind": tr("Change kind"),
            "layer": tr("Change layer"),
            "stance": tr("Change stance"),
            "end_stance": tr("Change end stance"),
            "limb": tr("Change limb"),
            "tags": tr("Change tags"),
        }[column]
        self.edit(words, lambda _: written.project)
        self.show_clips(self.session.selection.clips)
        self._say(tr_error(ValueError(next(iter(written.refused.values())))) if written.refused else "")

    def _say(self, trouble: str) -> None:
        self.trouble.setText(trouble)
        self.trouble.setVisible(bool(trouble))
        set_sheet(self.trouble, f"color: {get_theme(self.session.look.name).warning}")
