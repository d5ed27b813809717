"""Shows the characters that the project can be drawn with, in the first pose of its clips, to choose one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QIcon, QPainter, QPixmap
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QLabel,
    QListView,
    QListWidget,
    QListWidgetItem,
    QVBoxLayout,
)

from app.features.character.character_choice import (
    OURS,
    ask_character_file,
    draw_default_body,
    list_recent,
    remember_character,
    take_character,
)
from app.features.character.character_portraits import Portrait, draw_portraits, find_still
from app.look.theme import strengthen
from app.shell.context import Shell
from app.stage.gl_view import to_image
from app.translation import tr, tr_error

SIDE = 208  # pixels of a picture
ROLE = Qt.ItemDataRole.UserRole


@dataclass(frozen=True)
class CharacterCard:
    """A character that can be chosen. file: None for the default body. note: what else to say of it. refused:
    why it cannot be drawn.
    """

    name: str
    file: Path | None
    note: str = ""
    refused: str = ""


class CharacterGallery(QDialog):
    """Lists Ada, Ben, the default body, the project's own character and those that were chosen lately."""

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell.widget)
        self.shell, self.document = shell, shell.document
        self._drawn = 0  # characters that have their picture
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Choose character"))
        self.resize(780, 440)
        words = QLabel(
            tr("Each is fitted to the skeleton of your clips, whatever its joints are called."), self
        )
        words.setProperty("dim", True)
        self.list = QListWidget(self)
        self.list.setAccessibleName(tr("Characters"))
        self.list.setViewMode(QListView.ViewMode.IconMode)
        self.list.setResizeMode(QListView.ResizeMode.Adjust)
        self.list.setMovement(QListView.Movement.Static)
        self.list.setIconSize(QSize(SIDE, SIDE))
        self.list.setGridSize(QSize(SIDE + 24, SIDE + 52))
        self.list.setWordWrap(True)
        self.list.itemSelectionChanged.connect(self._selected)
        self.list.itemActivated.connect(lambda _: self._use())
        self.said = QLabel(self, wordWrap=True)
        self.buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel, self)
        self.from_file = self.buttons.addButton(tr("From a file…"), QDialogButtonBox.ButtonRole.ActionRole)
        self.from_file.clicked.connect(self._ask)
        self.use = self.buttons.addButton(tr("Use"), QDialogButtonBox.ButtonRole.AcceptRole)
        strengthen(self.use)
        self.use.clicked.connect(self._use)
        self.buttons.rejected.connect(self.reject)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 14, 16, 14)
        layout.setSpacing(10)
        for part in (words, self.list, self.said, self.buttons):
            layout.addWidget(part, 1 if part is self.list else 0)
        self.document.loaded.connect(self.reject)
        self._fill()

    # --- what can be chosen

    def _current(self) -> Path | None:
        character = self.document.project.character
        return (self.document.folder or Path()) / character if character is not None else None

    def _fill(self) -> None:
        current = self._current()
        ours = [
            CharacterCard(name, file, tr("Comes with Metagraph, with a face of 52 shapes."))
            for name, file in OURS.items()
            if file.is_file()
        ]
        choices = [
            *ours,
            CharacterCard(tr("Default body"), None, tr("A mannequin in the measures of your skeleton.")),
        ]
        known = [file.resolve() for file in OURS.values()]
        own = [current] if current is not None and current.is_file() else []
        for file in [*own, *list_recent()]:
            if file.resolve() not in known:
                known.append(file.resolve())
                choices.append(CharacterCard(file.stem, file, str(file)))
        for choice in choices:
            self._add(choice)
            same = choice.file == current or (
                choice.file is not None and current is not None and choice.file.resolve() == current.resolve()
            )
            if same:
                self.list.setCurrentRow(self.list.count() - 1)
        if self.list.currentRow() < 0:
            self.list.setCurrentRow(0)
        self._look([self.list.item(n) for n in range(self.list.count())])

    def _add(self, choice: CharacterCard) -> QListWidgetItem:
        item = QListWidgetItem(QIcon(self._write(tr("Drawing…"))), choice.name, self.list)
        item.setToolTip(choice.note or choice.name)
        item.setData(ROLE, choice)
        item.setTextAlignment(Qt.AlignmentFlag.AlignHCenter)
        return item

    def _write(self, words: str) -> QPixmap:
        """Return words in the place of a picture."""
        out = QPixmap(SIDE, SIDE)
        out.fill(Qt.GlobalColor.transparent)
        painter = QPainter(out)
        painter.setFont(self.font())
        painter.setPen(self.palette().placeholderText().color())
        painter.drawText(out.rect(), Qt.AlignmentFlag.AlignCenter, words)
        painter.end()
        return out

    def _look(self, items: Sequence[QListWidgetItem]) -> None:
        """Read the files and draw them, beside the window."""
        project, skeleton = self.document.project, self.document.project.skeleton
        clip = find_still(project)
        footing = None
        if skeleton is not None:
            footing = self.shell.stage.figures.footing(skeleton, project)
        theme = self.shell.stage.session.look.name
        files = [item.data(ROLE).file for item in items]

        def done(portraits: list[Portrait]) -> None:
            for item, portrait in zip(items, portraits, strict=True):
                self._show(item, portrait)
            self._drawn += len(items)
            self._selected()

        self.shell.jobs.start(
            "characters",
            lambda _: draw_portraits(files, clip, theme, footing),
            done,
            lambda error: self.said.setText(tr_error(error)),
            quick=True,
        )

    def is_drawn(self) -> bool:
        """Return whether every character has its picture."""
        return self._drawn == self.list.count() > 0

    def _show(self, item: QListWidgetItem, portrait: Portrait) -> None:
        if portrait.picture is not None:
            picture = QPixmap.fromImage(to_image(portrait.picture))
            icon = QIcon(picture)
            icon.addPixmap(picture, QIcon.Mode.Selected)  # Qt would tint it
            item.setIcon(icon)
        else:
            item.setIcon(QIcon(self._write(tr("No picture"))))
        item.setData(ROLE, replace(item.data(ROLE), refused=portrait.refused))
        if portrait.refused:
            item.setForeground(self.palette().placeholderText())

    def _chosen(self) -> CharacterCard | None:
        items = self.list.selectedItems()
        return items[0].data(ROLE) if items else None

    def _selected(self) -> None:
        choice = self._chosen()
        self.use.setEnabled(choice is not None and not choice.refused)
        self.said.setText("" if choice is None else choice.refused or choice.note)

    # --- what is chosen

    def _ask(self) -> None:
        path = ask_character_file(self, self.document.folder)
        if path is None:
            return
        item = self._add(CharacterCard(path.stem, path, str(path)))
        self.list.setCurrentItem(item)
        self._look([item])

    def _use(self) -> None:
        choice = self._chosen()
        if choice is None or choice.refused:
            return
        self.accept()
        if choice.file is None:
            draw_default_body(self.shell)
            return
        if choice.file not in OURS.values():
            remember_character(choice.file)
        if choice.file != self._current():
            take_character(self.shell, choice.file)
