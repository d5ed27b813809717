"""The main window: docks round the canvas, one table of commands, a status bar with the running job."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QPointF, QSettings, Qt, QTimer
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDragMoveEvent, QDropEvent
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QComboBox,
    QMainWindow,
    QMessageBox,
    QSplitter,
)

from app.features.character.character_panel import PreviewPanel
from app.features.graph.graph_canvas import Canvas
from app.features.graph.graph_drops import Drop
from app.features.library.library_panel import LibraryPanel
from app.features.manual.manual_place import Place
from app.look import icons
from app.look.theme import apply, theme
from app.project.document import Document
from app.project.files import Files
from app.project.jobs import Jobs
from app.project.learned import Learned
from app.project.watching import Watcher
from app.shell.actions import Actions
from app.shell.commands import CONVERSATION, commands
from app.shell.dialogs import Dialogs
from app.shell.docks import Docks
from app.shell.header import Header
from app.shell.job_line import JobLine
from app.shell.notice import Notice
from app.stage.compatibility_state import Compatibility, merged
from app.stage.figures import Figures
from app.stage.line_player import Sound
from app.stage.performance import Performance
from app.stage.session import Session
from app.stage.thumbnails import Thumbnails
from app.widgets.mime import load_of, sounds_of
from metagraph.formats.imports import Imported
from metagraph.graph.check import Problem, check
from metagraph.graph.model import Layer, Project

if TYPE_CHECKING:
    from app.features.study.operator_counting import Counting

LATE = 4000  # milliseconds after which the late panels are made whatever else is going on
CHECK_AFTER = 250  # milliseconds of quiet after an edit before problems are looked for


class Window(QMainWindow):
    """Owns document, session, jobs and panels, and nothing else: what they do is theirs."""

    def __init__(self) -> None:
        super().__init__()
        self.setWindowTitle("Metagraph")
        self.setAcceptDrops(True)
        self.document = Document(self)
        self.session = Session(self.document, self)
        self.jobs = Jobs(self)
        self.learned = Learned(self)
        self.figures = Figures(self.document, self.jobs, self)
        self.performance = Performance(self.document, self.session, self.jobs, self)
        self.thumbnails = Thumbnails(self.document, self.session, self.figures, self)
        self.files = Files(self.document, self.jobs, self)
        self.watcher = Watcher(self.document, self.jobs, self)
        self.sound = Sound(self.document, self.session, self.performance, self.jobs, self)
        self.compatibility = Compatibility(self.document, self.jobs, self)
        self.problems: tuple[Problem, ...] = ()
        self._found: tuple[Problem, ...] = ()  # by `check`, without what the statistics flag
        settings = QSettings()
        self.watcher.set_on(str(settings.value("watch", "true")) == "true")
        if settings.value("theme") in ("dark", "light"):
            self.session.theme = str(settings.value("theme"))  # type: ignore[assignment]
        apply(QApplication.instance(), theme(self.session.theme))  # type: ignore[arg-type]
        self.preview = PreviewPanel(self.session, self.performance, self.figures, self)
        self.library = LibraryPanel(self.document, self.session, self.thumbnails, self)
        self.canvas = Canvas(self.document, self.session, self.performance, self.thumbnails, self)
        self.centre = QSplitter(Qt.Orientation.Horizontal, self)
        self.centre.addWidget(self.canvas)
        self.centre.setChildrenCollapsible(False)
        self.setCentralWidget(self.centre)
        self.setDockOptions(
            QMainWindow.DockOption.AnimatedDocks | QMainWindow.DockOption.AllowNestedDocks | QMainWindow.DockOption.AllowTabbedDocks
        )
        self.docks = Docks(self, self.centre)
        self.docks.fill("library", self.library)
        self.docks.fill("preview", self.preview)
        self.manual = Place(self)
        self.dialogs = Dialogs(self)
        self.actions = Actions(self, commands(self))
        self.canvas.row_actions = [self.actions[name] for name in ("rename", "copy", "paste", "replace_clip", "twins")]
        self.library.row_actions = [self.actions[name] for name in ("twins", "repairs")]
        self._menus()
        self.header = Header(self.document, self.session, self.actions, self)
        self.addToolBar(self.header)
        self.header.problem_button.clicked.connect(lambda: self.show_dock("problems"))
        self.header.machine_button.clicked.connect(self.show_machine)
        self.header.export_button.clicked.connect(self.dialogs.export)
        self.job_line = JobLine(self.jobs, self)
        self.statusBar().addPermanentWidget(self.job_line)
        self.job_line.told.connect(self.tell)
        self.notice = Notice(self)
        self.statusBar().addPermanentWidget(self.notice)
        self._wire()
        self.resize(1680, 1020)
        self.docks.arrange()
        self.docks.restore()
        self.restyle()
        self.refresh()

    # --- building

    def load_late_panels_soon(self) -> None:
        """Load them once the first picture is painted and the project is open, which must not wait for them."""
        self.preview.view.painted.connect(self._late_now)
        QTimer.singleShot(LATE, self.load_late_panels)  # the character may be hidden

    def _late_now(self) -> None:
        if not self.jobs.running:
            self.preview.view.painted.disconnect(self._late_now)
            self.load_late_panels()

    def load_late_panels(self) -> None:
        """Import what the late panels need on a thread, then make them, one at a time."""
        if not self._loading:
            self._loading = True
            self.jobs.start("panels", lambda _: late_modules(), lambda _: self.make_late_panels(), quick=True)

    def make_late_panels(self) -> None:
        """Fill the docks that were left empty for a fast start."""
        from app.features.conversation.conversation_panel import ConversationPanel
        from app.features.life.life_panel import LifePanel
        from app.features.lines.lines_panel import LinesPanel
        from app.features.machine.machine_panel import MachinePanel
        from app.features.models.models_panel import ModelsPanel
        from app.features.problems.problems_panel import ProblemsPanel
        from app.features.properties.properties_panel import PropertiesPanel
        from app.features.timeline.timeline_panel import TimelinePanel

        if self.ready:
            return
        self.properties = PropertiesPanel(self.document, self.session, self.performance, self)
        self.life = LifePanel(self.document, self.session, self)
        self.timeline = TimelinePanel(self.document, self.session, self.performance, self)
        self.problems_panel = ProblemsPanel(self.session, self)
        self.models = ModelsPanel(self.document, self.session, self.jobs, self)
        self.models.learn_wanted.connect(self.dialogs.annotate)
        self.lines = LinesPanel(self.document, self.session, self.performance, self.jobs, self)
        self.lines.told.connect(self.tell)
        self.conversation = ConversationPanel(self.document, self.session, self.jobs, self)
        self.conversation.files_dropped.connect(self.dialogs.converse)
        self.conversation.add.clicked.connect(lambda: self.dialogs.converse())
        self.conversation.more_menu.addActions([self.actions[name] for name in CONVERSATION])
        self.conversation.more_menu.aboutToShow.connect(self.actions.refresh)
        self.machine = MachinePanel(self.document, self.session, self)
        self.centre.addWidget(self.machine)
        self.machine.setVisible(self._machine_wanted)
        for key, panel in (
            ("properties", self.properties), ("life", self.life), ("timeline", self.timeline), ("lines", self.lines),
            ("conversation", self.conversation), ("problems", self.problems_panel),
        ):  # fmt: skip
            self.docks.fill(key, panel)
        self.docks.fill("models", self.models, scrolls=True)
        self.problems_panel.mend_wanted.connect(self.compatibility.mend)
        self.problems_panel.show_problems(self.problems)
        self.properties.set_misfits(self.canvas.misfits)
        self.properties.plot.set_compatibility(self.compatibility)
        self.ready = True
        self.compatibility.start()
        if not self.docks.restored:
            self.docks.size()

    ready = False
    _loading = False
    _machine_wanted = False

    def _menus(self) -> None:
        self.menus = self.actions.fill(self.menuBar())
        for menu in self.menus.values():
            menu.aboutToShow.connect(self.actions.refresh)  # panels have buttons for some of it, too
        view = self.menus["&View"]
        panels = view.addMenu("Panels")
        for dock in self.docks.values():
            panels.addAction(dock.toggleViewAction())
        file = self.menus["&File"]
        self.recent_menu = file.addMenu("Open &recent")
        file.insertMenu(self.actions["sample"], self.recent_menu)
        self.recent_menu.aboutToShow.connect(self._fill_recent)

    def _fill_recent(self) -> None:
        self.recent_menu.clear()
        for path in self.files.recent():
            self.recent_menu.addAction(f"{path.name.split('.')[0]}   {path.parent}", lambda p=path: self.files.open(p))
        if self.recent_menu.isEmpty():
            self.recent_menu.addAction("None yet").setEnabled(False)

    def _wire(self) -> None:
        d, s = self.document, self.session
        d.changed.connect(self._edited)
        d.state_changed.connect(self.refresh)
        d.failed.connect(self.tell)
        d.saved.connect(lambda: self.learned.keep(d, self.jobs))
        self.learned.failed.connect(self.tell)
        for signal in (
            s.layer_changed, s.selection_changed, s.show_changed, s.playing_changed, s.stance_changed, s.performance_changed,
            s.conversation_changed,
        ):  # fmt: skip
            signal.connect(self.refresh)
        s.theme_changed.connect(self.restyle)
        s.mode_changed.connect(self._show_problems)
        self.library.import_wanted.connect(self.files.ask_import_folder)
        self.library.files_dropped.connect(lambda paths: self.files.import_paths(list(paths)))
        self.canvas.files_dropped.connect(lambda paths, drop: self.files.import_paths(list(paths), drop))
        self.canvas.refused.connect(self.tell)
        self.preview.view.failed.connect(self.tell)
        self.files.told.connect(self.tell)
        self.watcher.told.connect(self.tell)
        self.compatibility.failed.connect(self.tell)
        self.compatibility.changed.connect(self._show_problems)
        self.sound.told.connect(self.tell)
        self.files.report.connect(self._report)
        self.files.repaired.connect(self.dialogs.repairs)
        self.files.noticed.connect(self._repaired)
        d.loaded.connect(self.notice.clear)
        self.files.imported.connect(self._imported)
        self.files.annotation_dropped.connect(self.dialogs.annotate)
        self.files.conversation_dropped.connect(self.dialogs.converse)
        self.files.lines_dropped.connect(self._add_lines)
        self.files.opened.connect(self._opened)
        self._check_timer = QTimer(self, singleShot=True, interval=CHECK_AFTER)
        self._check_timer.timeout.connect(self._check)
        self._checking = False

    def show_dock(self, key: str) -> None:
        self.docks.show(key)

    def show_machine(self, on: bool | None = None) -> None:
        """Show or hide the expanded graph beside the meta-graph."""
        self._machine_wanted = not self._machine_wanted if on is None else on
        self.header.machine_button.setChecked(self._machine_wanted)
        if self.ready:
            self.machine.setVisible(self._machine_wanted)
            width = self.centre.width()
            self.centre.setSizes([width * 6 // 10, width * 4 // 10])
        self.actions.refresh()

    def only_character(self) -> None:
        """Give the character the whole window, or put everything back."""
        self.docks.only("preview")

    # --- looks

    def restyle(self) -> None:
        look = theme(self.session.theme)
        apply(QApplication.instance(), look)  # type: ignore[arg-type]
        for command in self.actions.commands:
            if command.icon:
                self.actions[command.id].setIcon(icons.icon(command.icon, look.text))
        self.library.restyle()
        QSettings().setValue("theme", look.name)
        self.header.show_problems(self.problems)
        self.canvas.update()

    def toggle_theme(self) -> None:
        self.session.set_theme("light" if self.session.theme == "dark" else "dark")
        self.refresh()

    def refresh(self) -> None:
        """Show the state of document and session in title, toolbar and menus."""
        d = self.document
        self.actions.refresh()
        undo, redo = d.undo_stack.undoText(), d.undo_stack.redoText()
        self.actions["undo"].setText(f"&Undo {undo}".strip())
        self.actions["redo"].setText(f"&Redo {redo}".strip())
        self.setWindowTitle(f"{d.project.name}{'[*]'} - Metagraph")
        self.setWindowModified(d.dirty)
        self.header.refresh()
        places = list(d.project.graphs[self.session.layer].stances.values())
        for number in range(1, 10):
            name = places[number - 1].name if number <= len(places) else f"Stance {number}"
            self.actions[f"stance_{number}"].setText(name)
            self.actions[f"stance_{number}"].setVisible(number <= len(places))

    def tell(self, words: str) -> None:
        self.statusBar().showMessage(words.replace("*", ""), 8000)

    # --- following

    def _edited(self, before: Project, after: Project) -> None:
        self._check_timer.start()
        if before.graphs is not after.graphs or before.name != after.name or before.character != after.character:
            self.refresh()

    def _check(self) -> None:
        if self._checking:
            self._check_timer.start()
            return
        self._checking = True
        project = self.document.project
        self.jobs.start("check", lambda _: check(project), self._checked, lambda e: self._checked([]), quick=True)

    def _checked(self, problems: list[Problem]) -> None:
        self._checking = False
        self._found = tuple(problems)
        self._show_problems()

    def _show_problems(self) -> None:
        flags = self.compatibility.flags
        # Problems of what is not edited now are not shown.
        found = tuple(p for p in self._found if self.session.mode == "manual" or not (p.state or p.link))
        found = tuple(p for p in found if self.session.mode == "meta" or not (p.stance or p.action))
        self.problems = merged(found, flags if self.session.mode == "meta" else {})
        misfits = {p.action: f"{p.message}. {p.remedy}" for p in self.problems if p.action and p.severity != "hint"}
        self.canvas.set_misfits(misfits)
        if self.ready:
            self.properties.set_misfits(misfits)
            self.problems_panel.show_problems(self.problems, flags)
        if self.manual.editor is not None:
            self.manual.editor.show_problems(self.problems)
        self.header.show_problems(self.problems)

    def _opened(self) -> None:
        self.session.stances.clear()
        self.session.others.clear()
        self.session.select_clips(())
        project = self.document.project
        self.manual.opened(project)
        if not project.graphs[self.session.layer].actions and self.session.mode == "meta":
            layer: Layer | None = next((x for x in ("arms", "body", "head") if project.graphs[x].actions), None)  # type: ignore[index]
            if layer is not None:
                self.session.set_layer(layer)
        self.session.stance_changed.emit()
        self.session.show_plan()
        self.session.seek(0.0)
        self.preview.frame_all()
        self.refresh()

    def _imported(self, result: Imported, drop: Drop | QPointF | None) -> None:
        load = self.files.load_for(result)
        if isinstance(drop, QPointF):
            self.manual.imported(load, drop)
        elif drop is not None and load.clips:
            self.canvas.do(drop, load)
        elif load.clips:
            self.session.select_clips(load.clips if len(load.clips) < 2 else ())

    def _add_lines(self, paths: list[Path]) -> None:
        self.make_late_panels()
        self.show_dock("lines")
        self.lines.add_files(paths)

    def _repaired(self, title: str, clips: tuple[str, ...], lines: list[str]) -> None:
        self.notice.tell("Some clips were repaired: look…", "What reading them put right, and what to leave as it is in the files",
                         lambda: self.dialogs.repairs(title, clips, tuple(lines)))  # fmt: skip

    def _report(self, title: str, lines: list[str]) -> None:
        box = QMessageBox(QMessageBox.Icon.Information, "Metagraph", title, QMessageBox.StandardButton.Ok, self)
        box.setInformativeText("\n".join(lines[:6]) + (f"\n… and {len(lines) - 6} more" if len(lines) > 6 else ""))
        if len(lines) > 6:
            box.setDetailedText("\n".join(lines))
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        box.open()

    # --- commands

    def choose_stance(self, place: int) -> None:
        stances = list(self.document.project.graphs[self.session.layer].stances)
        if place < len(stances):
            self.session.set_stance(stances[place])

    def remove(self) -> None:
        if self.manual.takes("remove"):
            return
        if self.session.asks:
            self.performance.withdraw(*self.session.asks)
        elif self.session.actions:
            self.canvas.remove_selection()
        else:
            self.library.remove(self.session.clips)

    def rename(self) -> None:
        if self.manual.takes("rename"):
            return
        if len(self.session.clips) == 1:
            self.library.rename(self.session.clips[0])
        elif len(self.session.actions) > 1:
            self.dialogs.batch("rename")
        elif len(self.session.actions) == 1 and self.ready:
            self.show_dock("properties")
            self.properties.name.setFocus()
            self.properties.name.selectAll()
        else:
            self.canvas.rename_stance()

    def copy_properties(self) -> None:
        """Remember the selected action, so that others can be given its properties."""
        if not self.manual.takes("copy"):
            self.session.copied = self.session.actions[0]
        self.actions.refresh()

    def toggle_watching(self) -> None:
        """Begin or end reading changed clip files anew."""
        self.watcher.set_on(not self.watcher.on)
        QSettings().setValue("watch", "true" if self.watcher.on else "false")
        self.actions.refresh()

    def select_all(self) -> None:
        if self.library.isAncestorOf(QApplication.focusWidget() or self):
            self.library.list.selectAll()
        elif not self.manual.takes("select_all"):
            self.session.select_actions(tuple(a.id for a in self.canvas._listed()))

    def toggle_live(self) -> None:
        """Begin or end the live session."""
        (self.performance.go_live if self.performance.live is None else self.performance.stop_live)()
        self.show_dock("timeline")
        self.actions.refresh()

    def step(self, frames: int) -> None:
        self.session.set_playing(False)
        self.session.seek(self.session.seconds + frames / 30)

    def play_alone(self) -> None:
        clip = self.session.clips[0] if self.session.clips else next((a.clip for a in self.session.selected_actions()), None)
        if clip is not None:
            self.session.show_clip(clip)

    def play_in_context(self) -> None:
        ident = self.session.actions[0] if self.session.actions else self.session.clips[0] if self.session.clips else None
        if ident is not None:
            self.session.show_context(ident)

    counting: Counting | None = None

    def count_operators(self) -> None:
        """Begin or end counting keys, pointings, buttons and drags."""
        if self.counting is None:
            from app.features.study.operator_counting import Counting

            self.counting = Counting(self)
        else:
            self.counting.stop()
            self.counting = None
        self.actions.refresh()

    # --- the window itself

    def event(self, event: QEvent) -> bool:
        # Asked last, when what has the keyboard does not want a key for itself: the space bar presses a focused button.
        if event.type() == QEvent.Type.ShortcutOverride and event.key() == Qt.Key.Key_Space:  # type: ignore[attr-defined]
            focus = QApplication.focusWidget()
            if isinstance(focus, QAbstractButton | QComboBox) and not event.modifiers():  # type: ignore[attr-defined]
                event.accept()
                return True
        return super().event(event)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if load_of(event.mimeData()).files or sounds_of(event.mimeData()):
            event.acceptProposedAction()

    def dragMoveEvent(self, event: QDragMoveEvent) -> None:
        self.dragEnterEvent(event)  # type: ignore[arg-type]

    def dropEvent(self, event: QDropEvent) -> None:
        sounds = sounds_of(event.mimeData())
        if sounds:
            event.acceptProposedAction()
            self.files.import_sounds(sounds)
            return
        files = load_of(event.mimeData()).files
        if files:
            event.acceptProposedAction()
            self.files.import_paths(list(files))

    def closeEvent(self, event: QCloseEvent) -> None:
        if not self.files.may_leave():
            event.ignore()
            return
        self.docks.save()
        self.learned.keep(self.document)
        self.performance.stop_live()
        self.sound.stop()
        self.document.close_journal()
        self.preview._timer.stop()
        self.canvas._hero_timer.stop()
        self._check_timer.stop()
        self.compatibility.stop()
        self.jobs.stop()
        self.thumbnails.stop()
        event.accept()


def late_modules() -> None:
    """Import what takes long and is not in the first picture."""
    import app.features.conversation.conversation_panel
    import app.features.life.life_panel
    import app.features.lines.lines_panel
    import app.features.machine.machine_panel
    import app.features.models.annotation_dialog
    import app.features.models.models_panel
    import app.features.problems.problems_panel
    import app.features.properties.properties_panel
    import app.features.timeline.timeline_panel  # noqa: F401
