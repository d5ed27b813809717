"""Keep the current workspace, how each was left, and the user's own workspaces, between runs of the
program.
"""

from __future__ import annotations

import json
from dataclasses import dataclass

from PySide6.QtCore import QByteArray, QObject, QSettings, Signal
from PySide6.QtWidgets import (
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QLineEdit,
    QPlainTextEdit,
    QTextEdit,
    QWidget,
)

from app.shell.places import ARRANGED, PanelPlaces
from app.shell.workspaces import ALL, FIRST, WORKSPACES, Workspace
from app.translation import tr

GROUP = (
    f"workspaces {ARRANGED}"  # what was kept when docks were made otherwise lies elsewhere, and is not read
)
FIELDS = (QAbstractSpinBox, QComboBox, QLineEdit, QPlainTextEdit, QTextEdit)
OLD = "state"  # one arrangement for everything, as kept before there were workspaces


@dataclass(frozen=True)
class Tab:
    """A workspace that can be chosen. `id` is the workspace's own for those that come with the program. `of`
    is the workspace that it is an arrangement of.
    """

    id: str
    title: str
    of: Workspace

    @property
    def own(self) -> bool:
        """Return whether the user made it."""
        return self.id != self.of.id


class Workspaces(QObject):
    """The workspaces of a window. `changed` is emitted if another one is current, or the list changed.
    `current` is the id of the current one.
    """

    changed = Signal()

    def __init__(self, places: PanelPlaces, parent: QObject) -> None:
        super().__init__(parent)
        self.places = places
        self.tabs: list[Tab] = [Tab(w.id, tr(w.title), w) for w in WORKSPACES]
        self.current = FIRST.id
        self._panels = " ".join(sorted(places.docks))

    @property
    def tab(self) -> Tab:
        """Return the current workspace."""
        return next(t for t in self.tabs if t.id == self.current)

    # --- from one time to the next

    def restore(self) -> None:
        """Open the workspace that was current when the window was last closed, as it was left."""
        settings = QSettings()
        settings.remove(OLD)
        geometry = settings.value(self._geometry_key())
        if isinstance(geometry, QByteArray):
            self.places.window.restoreGeometry(geometry)
        self.tabs = [t for t in self.tabs if not t.own] + _own(settings.value(f"{GROUP}/own"))
        kept = settings.value(f"{GROUP}/current")
        self.current = str(kept) if any(t.id == kept for t in self.tabs) else FIRST.id
        self._open()

    def save(self) -> None:
        """Keep everything for the next run."""
        settings = QSettings()
        settings.setValue(self._geometry_key(), self.places.window.saveGeometry())
        settings.setValue(f"{GROUP}/current", self.current)
        self._keep()

    def _geometry_key(self) -> str:
        """Return where the window's place is kept: each size of screen has its own."""
        size = self.places.window.screen().size()
        return f"geometry {size.width()}x{size.height()}"

    def _keep(self) -> None:
        """Keep how the current workspace is left, unless all panels are shown for something else."""
        if self.places.workspace.id != ALL.id:
            self._write(self.current, "left")

    def _write(self, ident: str, key: str) -> None:
        settings = QSettings()
        state, shares = self.places.state()
        settings.setValue(f"{GROUP}/{ident}/{key}", state)
        settings.setValue(f"{GROUP}/{ident}/{key} shares", shares)
        settings.setValue(f"{GROUP}/{ident}/panels", self._panels)

    def _read(self, ident: str, key: str) -> tuple[QByteArray, str] | None:
        """Return an arrangement that was kept; None if it is for other panels than the current ones."""
        settings = QSettings()
        if settings.value(f"{GROUP}/{ident}/panels") != self._panels:
            return None
        state = settings.value(f"{GROUP}/{ident}/{key}")
        shares = str(settings.value(f"{GROUP}/{ident}/{key} shares"))
        return (state, shares) if isinstance(state, QByteArray) else None

    # --- choosing

    def choose(self, ident: str) -> None:
        """Open a workspace as it was left. Raises LookupError if there is none."""
        if not any(t.id == ident for t in self.tabs):
            raise LookupError(f"there is no workspace {ident!r}")
        if ident == self.current and self.places.workspace.id != ALL.id and not self.places.alone:
            return
        self._keep()
        self.current = ident
        self._open()

    def _open(self) -> None:
        tab, focus = self.tab, QApplication.focusWidget()
        self.places.arrange(tab.of, self._read(tab.id, "left") or self._first())
        self._follow_focus(focus)
        self.changed.emit()

    def _first(self) -> tuple[QByteArray, str] | None:
        """Return how an own workspace was when it was saved."""
        return self._read(self.current, "first") if self.tab.own else None

    def _follow_focus(self, focus: QWidget | None) -> None:
        """Return the focus to the widget that had it, or to the large panel if that is no longer visible."""
        window = self.places.window
        if focus is None or focus is window or not window.isAncestorOf(focus):
            return
        if focus.isVisible():
            focus.setFocus()
        else:
            self.focus_large()

    def focus_large(self) -> None:
        """Give the focus to the large panel, but to none of its fields: a key that means a command would be
        typed there.
        """
        name = self.places.large()
        large = self.places.panel(name) if name and self.places.ready else None
        inside = [large, *large.findChildren(QWidget)] if large is not None else []
        takes = (w for w in inside if w.focusPolicy().value and w.isVisible() and not isinstance(w, FIELDS))
        next(takes, self.places.window).setFocus()

    def everything(self) -> None:
        """Show every panel at once, until a workspace is chosen."""
        self._keep()
        self.places.arrange(ALL)
        self.changed.emit()

    def show(self, ident: str, on: bool = True) -> None:
        """Show a panel in front, or hide it. A panel without a place in the current workspace is shown in its
        home workspace, unless it was opened here already.
        """
        places = self.places
        panel = places.panels[places.dock(ident).objectName()]
        if on and places.dock(ident).isHidden() and not places.belongs(ident, places.workspace):
            home = next(iter((*panel.where, *panel.opens)), None)
            if home is not None:
                self.choose(home)
        places.show(ident, on)

    # --- changing

    def reset(self) -> None:
        """Put the panels of the current workspace back."""
        if self.places.workspace.id == ALL.id:
            self.places.arrange(ALL)
            return
        QSettings().remove(f"{GROUP}/{self.current}/left")
        self.places.arrange(self.tab.of, self._first())
        self.changed.emit()

    def save_as(self, title: str) -> None:
        """Keep the current arrangement as an own workspace, and continue in it. Raises ValueError for a title
        that is empty or taken.
        """
        title = self._free(title)
        here = self.tab
        taken = {t.id for t in self.tabs}
        ident = next(i for n in range(1, len(taken) + 2) if (i := f"own-{n}") not in taken)
        self._write(ident, "first")
        self.tabs.append(Tab(ident, title, here.of))
        self._keep_own()
        self.current = ident
        self.changed.emit()

    def rename(self, title: str) -> None:
        """Rename the current workspace, which must be the user's. Raises ValueError for a title that is empty
        or taken, and if it is not the user's.
        """
        tab = self._mine()
        if title.strip() == tab.title:
            return
        title = self._free(title)
        self.tabs = [Tab(t.id, title, t.of) if t.id == tab.id else t for t in self.tabs]
        self._keep_own()
        self.changed.emit()

    def delete(self) -> None:
        """Delete the current workspace, and open the one it was made from. Raises ValueError if it is not the
        user's.
        """
        tab = self._mine()
        self.tabs = [t for t in self.tabs if t.id != tab.id]
        self._keep_own()
        self.current = tab.of.id
        self._open()
        QSettings().remove(f"{GROUP}/{tab.id}")

    def _mine(self) -> Tab:
        if not self.tab.own:
            raise ValueError(
                tr(
                    "The workspace {title} is built in: it cannot be renamed or deleted.",
                    title=self.tab.title,
                )
            )
        return self.tab

    def _free(self, title: str) -> str:
        title = " ".join(title.split())
        if not title:
            raise ValueError(tr("A workspace needs a name."))
        if any(t.title.casefold() == title.casefold() for t in self.tabs):
            raise ValueError(tr("There is already a workspace called {title}.", title=title))
        return title

    def _keep_own(self) -> None:
        own = [{"id": t.id, "title": t.title, "of": t.of.id} for t in self.tabs if t.own]
        QSettings().setValue(f"{GROUP}/own", json.dumps(own))


def _own(kept: object) -> list[Tab]:
    """Return the user's own workspaces; those that cannot be read are left out."""
    of = {w.id: w for w in WORKSPACES}
    try:
        rows = json.loads(str(kept or "[]"))
        return [
            Tab(str(r["id"]), str(r["title"]), of[r["of"]]) for r in rows if str(r["id"]).startswith("own-")
        ]
    except (ValueError, KeyError, TypeError):
        return []
