"""Compose the main window from what the features contribute; it knows none of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module
from pathlib import Path
from typing import Any

from PySide6.QtCore import QEvent, QSettings, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDragMoveEvent, QDropEvent, QKeyEvent, QShowEvent
from PySide6.QtWidgets import QAbstractButton, QApplication, QMainWindow

from app.look import icons
from app.look.comfort import read_comfort
from app.look.theme import apply_theme, get_theme
from app.project.document import Document
from app.project.files import Files
from app.project.importing import Importing
from app.project.jobs import Jobs
from app.project.learned import Learned
from app.project.second_start import SecondStarts
from app.project.watching import Watcher
from app.shell.actions import Actions, Command, Standard
from app.shell.comfort_menu import make_comfort_command
from app.shell.context import Contribute, Contribution, HeaderItem, Services
from app.shell.fault_dialog import FaultTeller
from app.shell.header import Header
from app.shell.job_line import JobLine
from app.shell.keyboard import Keyboard
from app.shell.language_menu import make_language_command
from app.shell.notice import Notice
from app.shell.places import PanelPlaces
from app.shell.studio_defaults import SHOW_ALL, is_all_shown, is_anything_hidden
from app.shell.verbs import Verbs
from app.shell.workspace_keeper import Workspaces
from app.shell.workspace_tabs import WorkspaceTabs, list_workspace_commands
from app.stage.compatibility_state import Compatibility
from app.stage.problem_watch import ProblemWatch
from app.stage.stage import Stage
from app.translation import tr
from app.widgets.drop_frame import DropFrame
from app.widgets.within_screen import FRAME
from metagraph.common.studio import get_studio
from metagraph.formats.store import SUFFIX

FIRST_THEME = "dark"
LATE = 4000  # milliseconds after which the late panels are made in any case


class WindowShell:
    """The `Shell` of a window's features. Panels and actions exist once all features have contributed."""

    places: PanelPlaces
    workspaces: Workspaces
    actions: Actions

    def __init__(self, window: QMainWindow) -> None:
        self.widget = window
        self.settings = QSettings()
        self.services = services = Services()
        self.document = Document(window)
        self.jobs = Jobs(window)
        self.stage = Stage(self.document, self.jobs, window)
        self.files = services.add(Files(self.document, self.jobs, window))
        self.importing = services.add(Importing(self.document, self.jobs, self.files, window))
        self.learned = services.add(Learned(window))
        self.watcher = services.add(Watcher(self.document, self.jobs, window))
        self.compatibility = services.add(Compatibility(self.document, self.jobs, window))
        self.problems = services.add(
            ProblemWatch(self.document, self.stage.session, self.jobs, self.compatibility, window)
        )
        self.notice = services.add(Notice(window))
        self.second_starts = services.add(SecondStarts(window))
        services.add(Verbs())
        self.faults = FaultTeller(self.document, window, self.tell)

    def tell(self, words: str) -> None:
        self.widget.statusBar().showMessage(words.replace("*", ""), 8000)

    def panel(self, ident: str) -> Any:
        return self.places.panel(ident)

    def show(self, ident: str, on: bool = True) -> None:
        self.workspaces.show(ident, on)
        self.actions.refresh()


SIZE = QSize(1680, 1020)  # of a new window, where the screen has room for it


def fit_screen(room: QSize) -> QSize:
    """Return the size of a new window on a screen with room of a size, so that its frame is seen, too."""
    return SIZE.boundedTo(room - FRAME)


class Window(QMainWindow):
    """Owns the shell, and composes panels, menus, header and status bar from what the features contribute.

    `language_chosen` has the code of a language, for the object that can replace the window. `replaced` means
    that another window continues with the document.
    """

    language_chosen = Signal(str)
    replaced = False

    def __init__(self, features: Iterable[Contribute]) -> None:
        super().__init__()
        self.setWindowTitle("Metagraph")
        self.setAcceptDrops(True)
        self.shell = shell = WindowShell(self)
        session = shell.stage.session
        kept: Any = shell.settings.value("theme") or get_studio().theme
        if kept == "dark" or kept == "light":
            session.look.name = kept
        if read_comfort().still:
            session.transport.set_playing(False)
        apply_theme(_application(), get_theme(session.look.name))
        self.contributions = [*(contribute(shell) for contribute in features), self._own()]
        self.places = shell.places = shell.services.add(
            PanelPlaces(self, (p for c in self.contributions for p in c.panels), session)
        )
        self.workspaces = shell.workspaces = shell.services.add(Workspaces(self.places, self))
        shell.importing.drops = tuple(drop for c in self.contributions for drop in c.drops)
        offered = (command for c in self.contributions for command in c.commands)
        shell.actions = Actions(self, offered, lambda: session.onstage.mode)
        self.places.fetch = self._fetch
        self.places.make_early()
        self.menus = shell.actions.fill(self.menuBar())
        self._add_toggles()
        items = [item for c in self.contributions for item in c.header]
        tabs = HeaderItem("middle", lambda parent: WorkspaceTabs(self.workspaces, shell.actions, parent))
        self.header = shell.services.add(Header(shell.document, session, shell.actions, [tabs, *items], self))
        self.addToolBar(self.header)
        self.drop_frame = DropFrame(self, session.look, tr("Drop to import"))
        self.job_line = JobLine(shell.jobs, self)
        self.statusBar().addPermanentWidget(self.job_line)
        self.statusBar().addPermanentWidget(shell.notice)
        self.keyboard = Keyboard(self, shell.actions)
        self.resize(fit_screen(self.screen().availableSize()))
        self.workspaces.restore()
        self.places.proportions.follow()
        self._wire()  # now: each signal before would have everything shown once more
        self.restyle()

    # --- building

    def _own(self) -> Contribution:
        """Return the window's own commands."""
        session = self.shell.stage.session
        light = lambda: session.look.name == "light"  # noqa: E731
        return Contribution(
            commands=(
                Command(
                    "quit", "&File", "quit", tr("&Quit"), self.close, (Standard.Quit, "Ctrl+Q"), study=True
                ),
                *list_workspace_commands(lambda: self.workspaces, self),
                Command(
                    "theme",
                    "&View",
                    "look",
                    tr("&Light theme"),
                    lambda: session.look.choose("dark" if light() else "light"),
                    checked=light,
                    icon="theme",
                    study=True,
                ),
                make_language_command(self.shell, self.language_chosen.emit),
                make_comfort_command(self.shell),
                Command(
                    "show_all",
                    "&View",
                    "look",
                    tr("Show what your studio hi&des"),
                    self._toggle_hidden,
                    tip=tr("At the next start"),
                    checked=lambda: is_all_shown(self.shell.settings),
                    visible=is_anything_hidden,
                ),
            ),
        )

    def _toggle_hidden(self) -> None:
        shown = is_all_shown(self.shell.settings)
        self.shell.settings.setValue(SHOW_ALL, "false" if shown else "true")
        self.shell.tell(tr("This takes effect at the next start."))

    def _add_toggles(self) -> None:
        panels = self.menus["&View"].addMenu(tr("Panels"))
        for dock in self.places.docks.values():
            toggle = dock.toggleViewAction()
            toggle.triggered.connect(lambda on, dock=dock: dock.raise_() if on else None)
            panels.addAction(toggle)

    def _wire(self) -> None:
        d, s, shell = self.shell.document, self.shell.stage.session, self.shell
        d.state_changed.connect(self._follow)
        d.loaded.connect(shell.notice.clear)
        shell.watcher.file_touched.connect(shell.files.look_at_file)
        shell.files.noticed.connect(shell.notice.tell)
        shell.files.extra_wanted.connect(self._show_extras)
        d.saved.connect(lambda: shell.learned.keep(d, shell.jobs))
        for signal in (
            s.place.layer_changed,
            s.selection.changed,
            s.transport.show_changed,
            s.transport.playing_changed,
            s.place.stance_changed,
            s.onstage.performance_changed,
            s.onstage.conversation_changed,
            s.onstage.mode_changed,
            shell.stage.performance.live.changed,
            shell.compatibility.changed,
            self.workspaces.changed,
        ):
            signal.connect(self._follow)
        s.look.changed.connect(self.restyle)
        for words in (
            d.failed, shell.learned.failed, shell.stage.refused, shell.files.told, shell.importing.told,
            shell.watcher.told, shell.compatibility.failed,
            shell.stage.sound.told, self.job_line.told,
        ):  # fmt: skip
            words.connect(shell.tell)

    # --- the panels that are not in the first picture

    def load_late_panels_soon(self) -> None:
        """Load the visible late panels once the first picture is painted and the project is open, which must
        not wait for them.
        """
        self.shell.stage.painted.connect(self._late_now)
        QTimer.singleShot(LATE, self.load_late_panels)  # the character may be hidden

    def _late_now(self) -> None:
        if not self.shell.jobs.running:
            self.shell.stage.painted.disconnect(self._late_now)
            self.load_late_panels()

    def load_late_panels(self) -> None:
        """Import on a thread what the visible late panels need, then make them."""
        if not self._loading:
            self._loading = True
            self._fetch(self.places.to_import(), self.make_late_panels)

    _loading = False

    def _fetch(self, names: Iterable[str], then: Callable[[], object]) -> None:
        """Import modules on a thread, then continue."""

        def fetched(_: object) -> None:
            then()

        self.shell.jobs.start(
            "panels", lambda _: [import_module(name) for name in names], fetched, quick=True
        )

    def make_late_panels(self) -> None:
        """Fill the visible docks that were left empty for a fast start; from now on each is filled when it is
        first seen.
        """
        if not self.places.ready:
            self.places.make_late()
            self.shell.compatibility.start()

    # --- looks

    def restyle(self) -> None:
        look = get_theme(self.shell.stage.session.look.name)
        apply_theme(_application(), look)
        for command in self.shell.actions.commands:
            if command.icon:
                self.shell.actions[command.id].setIcon(icons.make_icon(command.icon, look.text))
        if look.name != (self.shell.settings.value("theme") or get_studio().theme or FIRST_THEME):
            self.shell.settings.setValue("theme", look.name)  # a studio's is not the user's choice
        self.refresh()

    def refresh(self) -> None:
        """Show the state of document and session in title, header and menus."""
        self.shell.actions.refresh()
        self._show_title()

    def _show_extras(self, name: str) -> None:
        from app.shell.extras_dialog import show_extras

        show_extras(self, self.shell.jobs, name)

    def _follow(self) -> None:
        """Show it, updating the commands once for several changes."""
        self.shell.actions.refresh_soon()
        self._show_title()

    def _show_title(self) -> None:
        document = self.shell.document
        read_only = tr(" (read-only)") if document.read_only else ""
        self.setWindowTitle(f"{document.project.name}{'[*]'}{read_only} - Metagraph")
        if self.isWindowModified() != document.dirty:  # Qt notifies the whole window each time
            self.setWindowModified(document.dirty)
        self.header.refresh()

    # --- the window itself

    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.WindowActivate:  # the user may have changed the file meanwhile
            self.shell.files.look_at_file()
        # Checked last, for keys that the focused widget does not use: the space bar presses a focused button.
        if (
            event.type() == QEvent.Type.ShortcutOverride
            and isinstance(event, QKeyEvent)
            and event.key() == Qt.Key.Key_Space
        ):
            focus = QApplication.focusWidget()
            if isinstance(focus, QAbstractButton) and not event.modifiers():
                event.accept()
                return True
        return super().event(event)

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        if self.focusWidget() is None:  # else Qt gives it to the first field
            self.workspaces.focus_large()

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        paths = list_dropped_files(event)
        if self.shell.importing.takes(paths):
            event.acceptProposedAction()
            opens = any(path.name.lower().endswith(SUFFIX) for path in paths)
            self.drop_frame.follow(event, tr("Drop to open") if opens else "")

    def dragMoveEvent(self, event: QDragMoveEvent) -> None:
        if self.shell.importing.takes(list_dropped_files(event)):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        paths = list_dropped_files(event)
        if self.shell.importing.takes(paths):
            event.acceptProposedAction()
            self.shell.importing.import_paths([str(p) for p in paths])

    def closeEvent(self, event: QCloseEvent) -> None:
        if not self.replaced and not self.shell.files.may_leave():
            event.ignore()
            return
        self.shell.faults.stop()
        self.shell.second_starts.stop()
        self.workspaces.save()
        self.shell.learned.keep(self.shell.document)
        self.shell.stage.stop()
        for contribution in self.contributions:
            if contribution.close is not None:
                contribution.close()
        self.shell.document.close_journal()
        self.shell.problems.stop()
        self.shell.compatibility.stop()
        self.shell.jobs.stop()
        event.accept()


def list_dropped_files(event: QDropEvent) -> list[Path]:
    """Return the files that are dropped."""
    return [Path(u.toLocalFile()) for u in event.mimeData().urls() if u.isLocalFile()]


def _application() -> QApplication:
    found = QApplication.instance()
    assert isinstance(found, QApplication)
    return found
