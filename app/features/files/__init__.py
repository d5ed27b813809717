"""New, open, save, import: the document's files as commands, and what is told of an import."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QMenu, QMessageBox

from app.features.files.import_line import ImportLine
from app.project.files import PRACTICE, SAMPLE, SEATED, Files
from app.project.importing import Importing
from app.project.label_files import LabelFiles
from app.project.watching import Watcher
from app.shell.actions import Command, Standard
from app.shell.context import Contribution, HeaderItem, Shell
from app.translation import tr
from metagraph.formats.imports import Imported

LINES = 6  # of a report that are shown at once


def contribute(shell: Shell) -> Contribution:
    files, importing, watcher = shell.services[Files], shell.services[Importing], shell.services[Watcher]
    session, stack = shell.stage.session, shell.document.undo_stack
    watcher.set_on(str(shell.settings.value("watch", "true")) == "true")

    def watch() -> None:
        watcher.set_on(not watcher.on)
        shell.settings.setValue("watch", "true" if watcher.on else "false")
        shell.actions.refresh()

    def fill_recent(menu: QMenu) -> None:
        for path in files.recent():
            menu.addAction(f"{path.name.split('.')[0]}   {path.parent}", partial(files.open, path))
        if menu.isEmpty():
            menu.addAction(tr("None yet")).setEnabled(False)

    def imported(result: Imported, place: object) -> None:
        load = importing.load_for(result)
        if place is None and load.clips:
            session.selection.select_clips(load.clips if len(load.clips) < 2 else ())

    def show_versions() -> None:
        from app.features.files.versions_dialog import Found, VersionsDialog, found_versions
        from app.project.questions import moment_words

        path, now = shell.document.path, shell.document.project
        if path is None:
            return

        def open_copy(found: Found) -> None:
            words = moment_words(found.version.saved).replace(":", ".")
            files.open(found.version.path, template=True, name=f"{now.name} {words}")

        def show(found: tuple[Found, ...]) -> None:
            if shell.document.path == path:
                VersionsDialog(path.name, found, open_copy, shell.widget).open()

        shell.jobs.start(
            tr("Reading earlier versions"), lambda _: found_versions(path, now), show, files.show_failure
        )

    files.opened.connect(session.open_project)
    files.report.connect(lambda title, lines: _report(shell, title, lines))
    importing.report.connect(lambda title, lines: _report(shell, title, lines))
    importing.imported.connect(imported)
    line = ImportLine(
        shell.document,
        importing,
        lambda command: shell.actions[command].trigger(),
        lambda title, lines: _report(shell, title, lines),
        shell.widget,
    )
    labels = LabelFiles(shell.document, shell.jobs, files, importing, shell.widget)
    shell.widget.addToolBar(Qt.ToolBarArea.BottomToolBarArea, line)
    line.hide()
    menu = "&File"
    return Contribution(
        commands=(
            Command("new", menu, "project", tr("&New project"), files.new, (Standard.New,)),
            Command("open", menu, "project", tr("&Open…"), files.ask_open, (Standard.Open,)),
            Command("recent", menu, "project", tr("Open &recent"), fill=fill_recent),
            Command(
                "sample",
                menu,
                "project",
                tr("Open the &sample project"),
                lambda: files.open(SAMPLE, template=True),
            ),
            Command(
                "seated",
                menu,
                "project",
                tr("Open the seate&d project"),
                lambda: files.open(SEATED, template=True),
                tip=tr("Somebody who sits on a stool, and gets up when asked"),
            ),
            Command(
                "practice",
                menu,
                "project",
                tr("Open the &practice project"),
                lambda: files.open(PRACTICE, template=True),
                tip=tr("152 clips to label"),
            ),
            Command(
                "recover",
                menu,
                "project",
                tr("Reco&ver…"),
                files.recover,
                tip=tr("All work that is in no file, of windows that were not closed properly"),
            ),
            Command(
                "network",
                menu,
                "project",
                tr("Files on other &computers…"),
                files.network.ask,
                tip=tr("Whether files on other computers that this project names are opened"),
            ),
            Command("save", menu, "save", tr("&Save"), files.save, (Standard.Save,)),
            Command("save_as", menu, "save", tr("Save &as…"), files.save_as, (Standard.SaveAs,)),
            Command(
                "versions",
                menu,
                "save",
                tr("Earlier &versions…"),
                show_versions,
                tip=tr("What each save has kept of this project, and how many are kept"),
                enabled=lambda: shell.document.path is not None,
            ),
            Command(
                "import",
                menu,
                "import",
                tr("&Import folder…"),
                importing.ask_import_folder,
                ("Ctrl+I",),
                icon="folder",
            ),
            Command(
                "import_files",
                menu,
                "import",
                tr("Import &files…"),
                importing.ask_import_files,
                ("Ctrl+Shift+I",),
            ),
            Command(
                "import_labels",
                menu,
                "import",
                tr("Import &labels…"),
                labels.ask,
                tip=tr("A file of labels, as Blender's add-on writes it, with the clips beside it"),
            ),
            Command(
                "watch",
                menu,
                "import",
                tr("Follow changed &files"),
                watch,
                checked=lambda: watcher.on,
                tip=tr("Clips that are exported again are read again, in place"),
            ),
            Command("find_missing", menu, "import", tr("Find missing files…"), importing.find_missing),
            Command(
                "undo",
                "&Edit",
                "history",
                lambda: tr("&Undo {what}", what=stack.undoText()).strip(),
                shell.document.undo,
                (Standard.Undo,),
                tip=tr("Undo"),
                icon="undo",
                enabled=stack.canUndo,
                study=True,
            ),
            Command(
                "redo",
                "&Edit",
                "history",
                lambda: tr("&Redo {what}", what=stack.redoText()).strip(),
                shell.document.redo,
                (Standard.Redo, "Ctrl+Y"),
                tip=tr("Redo"),
                icon="redo",
                enabled=stack.canRedo,
                study=True,
            ),
        ),
        header=(HeaderItem("left", "import"), HeaderItem("left", "undo"), HeaderItem("left", "redo")),
        drops=(labels.drop,),
    )


def _report(shell: Shell, title: str, lines: Sequence[str]) -> None:
    box = QMessageBox(
        QMessageBox.Icon.Information, "Metagraph", title, QMessageBox.StandardButton.Ok, shell.widget
    )
    more = tr("\n… and {count} more", count=len(lines) - LINES) if len(lines) > LINES else ""
    box.setInformativeText("\n".join(lines[:LINES]) + more)
    if more:
        box.setDetailedText("\n".join(lines))
    box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    box.open()
