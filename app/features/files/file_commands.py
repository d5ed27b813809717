"""The commands that open, save and import, and undo and redo."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from PySide6.QtWidgets import QMenu

from app.features.files.import_line import ImportLine
from app.features.files.import_report import show_report
from app.project.files import PRACTICE, SAMPLE, SEATED, Files
from app.project.importing import Importing
from app.project.label_files import LabelFiles
from app.project.menu_entry import add_to_menu, find_unpacked_bundle, is_in_menu, remove_from_menu
from app.project.second_start import SecondStarts, is_handed_over
from app.project.watching import Watcher
from app.shell.actions import Command, Standard
from app.shell.command_table import Feature
from app.shell.context import Shell
from app.translation import tr, tr_noop
from metagraph.formats.imports import Imported

FILE, EDIT = "&File", "&Edit"


class FileFeature(Feature):
    """Does the commands of this module, and reports what came of opening and importing."""

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell)
        self.files, self.importing = shell.services[Files], shell.services[Importing]
        self.watcher, self.undo_stack = shell.services[Watcher], shell.document.undo_stack
        self.labels = LabelFiles(shell.document, shell.jobs, self.files, self.importing, shell.widget)
        self.bundle = find_unpacked_bundle()
        self.in_menu = self.bundle is not None and is_in_menu(self.bundle)
        self.watcher.set_on(str(shell.settings.value("watch", "true")) == "true")
        report = partial(show_report, shell)
        self.files.opened.connect(self.session.open_project)
        self.files.report.connect(report)
        self.importing.report.connect(report)
        self.importing.imported.connect(self.select_imported)

    def make_import_line(self) -> ImportLine:
        shell = self.shell
        return ImportLine(
            self.document,
            self.importing,
            lambda command: shell.actions[command].trigger(),
            partial(show_report, shell),
            shell.widget,
        )

    def select_imported(self, result: Imported, place: object) -> None:
        """Select a clip that was imported alone, not dropped on a place."""
        load = self.importing.load_for(result)
        if place is None and load.clips:
            self.session.selection.select_clips(load.clips if len(load.clips) < 2 else ())

    # --- projects

    def new(self) -> None:
        self.files.new()

    def ask_open(self) -> None:
        self.files.ask_open()

    def fill_recent(self, menu: QMenu) -> None:
        for path in self.files.recent():
            menu.addAction(f"{path.name.split('.')[0]}   {path.parent}", partial(self.files.open, path))
        if menu.isEmpty():
            menu.addAction(tr("No recent projects")).setEnabled(False)

    def open_sample(self) -> None:
        self.files.open(SAMPLE, template=True)

    def open_seated(self) -> None:
        self.files.open(SEATED, template=True)

    def open_practice(self) -> None:
        self.files.open(PRACTICE, template=True)

    def recover(self) -> None:
        self.files.recover()

    def ask_network(self) -> None:
        self.files.network.ask()

    def save(self) -> None:
        self.files.save()

    def save_as(self) -> None:
        self.files.save_as()

    def is_saved(self) -> bool:
        """Whether the project has a file."""
        return self.document.path is not None

    def show_versions(self) -> None:
        from app.features.files.versions_dialog import Found, VersionsDialog, find_versions
        from app.project.questions import describe_moment

        path, now = self.document.path, self.document.project
        if path is None:
            return

        def open_copy(found: Found) -> None:
            words = describe_moment(found.version.saved).replace(":", ".")
            self.files.open(found.version.path, template=True, name=f"{now.name} {words}")

        def show(found: tuple[Found, ...]) -> None:
            if self.document.path == path:
                VersionsDialog(path.name, found, open_copy, self.shell.widget).open()

        self.shell.jobs.start(
            tr("Reading earlier versions"), lambda _: find_versions(path, now), show, self.files.show_failure
        )

    def compare(self) -> None:
        from app.features.files.compare_dialog import CompareDialog, OtherVersion, list_other_versions

        path, now = self.document.path, self.document.project
        folder = self.document.folder or Path()

        def show(others: tuple[OtherVersion, ...]) -> None:
            if self.document.path == path:
                CompareDialog(now, others, self.shell.jobs, folder, self.shell.widget).open()

        self.shell.jobs.start(
            tr("Looking for versions"),
            lambda _: list_other_versions(path) if path is not None else (),
            show,
            self.files.show_failure,
        )

    # --- clips

    def import_folder(self) -> None:
        self.importing.ask_import_folder()

    def import_files(self) -> None:
        self.importing.ask_import_files()

    def import_labels(self) -> None:
        self.labels.ask()

    def find_missing(self) -> None:
        self.importing.find_missing()

    def toggle_watching(self) -> None:
        self.watcher.set_on(not self.watcher.on)
        self.shell.settings.setValue("watch", "true" if self.watcher.on else "false")
        self.shell.actions.refresh()

    def watches(self) -> bool:
        return self.watcher.on

    # --- other starts

    def toggle_second_start(self) -> None:
        self.shell.services[SecondStarts].choose(not is_handed_over())
        self.shell.actions.refresh()

    def takes_second_start(self) -> bool:
        return is_handed_over()

    def toggle_menu_entry(self) -> None:
        if self.bundle is None:
            return
        try:
            if self.in_menu:
                remove_from_menu()
            else:
                add_to_menu(self.bundle)
                self.files.told.emit(tr("Metagraph is in the desktop's menu and opens projects"))
        except OSError as error:
            self.files.show_warning(tr("Desktop's menu"), error)
        self.in_menu = is_in_menu(self.bundle)
        self.shell.actions.refresh()

    def has_menu_entry(self) -> bool:
        return self.in_menu

    def is_unpacked(self) -> bool:
        return self.bundle is not None

    # --- history

    def undo(self) -> None:
        self.document.undo()

    def can_undo(self) -> bool:
        return self.undo_stack.canUndo()

    def undo_text(self) -> str:
        what = self.undo_stack.undoText()
        return tr("&Undo {what}", what=what) if what else tr("&Undo")

    def redo(self) -> None:
        self.document.redo()

    def can_redo(self) -> bool:
        return self.undo_stack.canRedo()

    def redo_text(self) -> str:
        what = self.undo_stack.redoText()
        return tr("&Redo {what}", what=what) if what else tr("&Redo")


COMMANDS = (
    Command("new", FILE, "project", tr_noop("&New project"), FileFeature.new, (Standard.New,)),
    Command("open", FILE, "project", tr_noop("&Open…"), FileFeature.ask_open, (Standard.Open,)),
    Command(
        "second_start",
        "&View",
        "look",
        tr_noop("&Open from the desktop in this window"),
        FileFeature.toggle_second_start,
        tip=tr_noop("Files that you open from the desktop open in this window, not in a second one"),
        checked=FileFeature.takes_second_start,
    ),
    Command(
        "menu_entry",
        "&View",
        "look",
        tr_noop("Show in the &desktop's menu"),
        FileFeature.toggle_menu_entry,
        tip=tr_noop("Adds Metagraph to your desktop's menu; a double click on a project then opens it"),
        checked=FileFeature.has_menu_entry,
        visible=FileFeature.is_unpacked,
    ),
    Command("recent", FILE, "project", tr_noop("Open &recent"), fill=FileFeature.fill_recent),
    Command("sample", FILE, "examples", tr_noop("Open the &sample project"), FileFeature.open_sample),
    Command(
        "seated",
        FILE,
        "examples",
        tr_noop("Open the seate&d project"),
        FileFeature.open_seated,
        tip=tr_noop("A character that sits on a stool and gets up when asked"),
    ),
    Command(
        "practice",
        FILE,
        "examples",
        tr_noop("Open the &practice project"),
        FileFeature.open_practice,
        tip=tr_noop("152 clips to label"),
    ),
    Command(
        "recover",
        FILE,
        "kept",
        tr_noop("Reco&ver…"),
        FileFeature.recover,
        tip=tr_noop("Recover unsaved work from windows that were not closed properly"),
    ),
    Command(
        "network",
        FILE,
        "import",
        tr_noop("Files on other &computers…"),
        FileFeature.ask_network,
        tip=tr_noop("Choose whether to open the files on other computers that this project names"),
    ),
    Command("save", FILE, "save", tr_noop("&Save"), FileFeature.save, (Standard.Save,)),
    Command("save_as", FILE, "save", tr_noop("Save &as…"), FileFeature.save_as, (Standard.SaveAs,)),
    Command(
        "versions",
        FILE,
        "save",
        tr_noop("Earlier &versions…"),
        FileFeature.show_versions,
        tip=tr_noop("Open a version that an earlier save kept, and set how many versions are kept"),
        enabled=FileFeature.is_saved,
    ),
    Command(
        "compare",
        FILE,
        "save",
        tr_noop("Co&mpare versions…"),
        FileFeature.compare,
        tip=tr_noop("Show what is new, gone or changed since an earlier version, in Git or in another file"),
    ),
    Command(
        "import",
        FILE,
        "import",
        tr_noop("&Import folder…"),
        FileFeature.import_folder,
        ("Ctrl+I",),
        icon="folder",
    ),
    Command(
        "import_files", FILE, "import", tr_noop("Import &files…"), FileFeature.import_files, ("Ctrl+Shift+I",)
    ),
    Command(
        "import_labels",
        FILE,
        "import",
        tr_noop("Import &labels…"),
        FileFeature.import_labels,
        tip=tr_noop("Import a file of labels that Blender's add-on wrote, with the clips beside it"),
    ),
    Command(
        "watch",
        FILE,
        "import",
        tr_noop("Follow changed &files"),
        FileFeature.toggle_watching,
        checked=FileFeature.watches,
        tip=tr_noop("Read clips again when their files change"),
    ),
    Command("find_missing", FILE, "import", tr_noop("Find missing files…"), FileFeature.find_missing),
    Command(
        "undo",
        EDIT,
        "history",
        FileFeature.undo_text,
        FileFeature.undo,
        (Standard.Undo,),
        tip=tr_noop("Undo"),
        icon="undo",
        enabled=FileFeature.can_undo,
        study=True,
    ),
    Command(
        "redo",
        EDIT,
        "history",
        FileFeature.redo_text,
        FileFeature.redo,
        (Standard.Redo, "Ctrl+Y"),
        tip=tr_noop("Redo"),
        icon="redo",
        enabled=FileFeature.can_redo,
        study=True,
    ),
)
