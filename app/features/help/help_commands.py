"""Commands of help: the manual, what can be done and by which keys, and what this program is."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import QApplication, QMessageBox

from app.look.names import make_readable_name
from app.look.theme import KIND_MARKS, KIND_TITLES
from app.shell.actions import Command
from app.shell.command_table import Feature
from app.shell.context import Shell
from app.shell.places import PanelPlaces
from app.translation import make_lazy_texts, tr, tr_noop
from app.widgets.vocabulary import get_vocabulary_title
from metagraph.graph.model import KINDS

if TYPE_CHECKING:
    from app.features.help.command_finder import Entry

TIMELINE = make_lazy_texts(
    lambda: (  # and what the timeline does
        (tr("Add a marker"), "M"),
        (tr("Move requests or a marker"), tr("arrows, with Shift by one second")),
        (tr("Withdraw requests and close the gap"), tr("Shift+Del")),
        (tr("Cut, copy, paste requests"), tr("Ctrl+X, Ctrl+C, Ctrl+V")),
        (tr("Copy requests one second later"), tr("Ctrl+D")),
        (tr("Ask for something"), tr("Insert")),
        (tr("Cut to everyone, over the shoulder, close-up"), tr("1 to 9")),
        (tr("Remove the cut"), "0"),
        (tr("Zoom in and out"), "+, −"),
        (tr("Drag without snapping"), tr("Shift")),
    )
)
LANES = make_lazy_texts(
    lambda: (  # what the lanes take for themselves
        (tr("Label as clause, response, hesitation"), "1, 2, 3"),
        (tr("Split a segment"), "S"),
        (tr("Merge segments"), "M"),
        (tr("Set the stress"), "P"),
        (tr("Move from segment to segment"), tr("Tab, arrows")),
    )
)


def list_named_parts(shell: Shell) -> Iterator[Entry]:
    """Return the stances and actions of the project, to go to by typing their names."""
    from app.features.help.command_finder import Entry

    jump = shell.stage.session.jump
    for layer, graph in shell.document.project.graphs.items():
        where = get_vocabulary_title(layer)
        for stance in graph.stances.values():
            group = tr("Stance, {layer}", layer=where)
            run = partial(jump, layer, stance.id)
            yield Entry(group, make_readable_name(stance.name), run=run, by_name=True)
        for action in graph.actions.values():
            if action.kind != "stance":
                group = tr("{kind}, {layer}", kind=tr(KIND_TITLES[action.kind]), layer=where)
                run = partial(jump, action=action.id)
                yield Entry(group, make_readable_name(action.name), run=run, by_name=True)


class HelpFeature(Feature):
    """Manual, commands and what this program is, in one window. recent: the commands done from the list, the
    latest first.
    """

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell)
        self.recent: list[str] = []

    def list_entries(self, keyed: bool) -> Iterator[Entry]:
        """Return every command as it can be used now; keyed: only those with keys."""
        from app.features.help.command_finder import Entry

        actions = self.shell.actions
        actions.refresh()
        for command in actions.commands:
            action = actions[command.id]
            keys = ", ".join(k.toString(QKeySequence.SequenceFormat.NativeText) for k in action.shortcuts())
            if action.menu() is not None or not action.isVisible() or (keyed and not keys):
                continue
            menu, tip = tr(command.menu).replace("&", ""), command.tip if command.tip != command.plain else ""
            yield Entry(menu, command.plain, keys, tip, action.trigger, action.isEnabled())
        if keyed:
            yield from (Entry(tr("On the timeline"), words, keys) for words, keys in TIMELINE)
            yield from (Entry(tr("In a conversation"), words, keys) for words, keys in LANES)
            return
        places = self.shell.services[PanelPlaces]
        named = {c.plain for c in actions.commands if actions[c.id].isVisible()}
        for ident, dock in places.docks.items():
            if dock.windowTitle() not in named:  # a command of that name shows the panel
                yield Entry(tr("Panels"), dock.windowTitle(), also="panel", run=partial(places.show, ident))
        yield from list_named_parts(self.shell)

    def list_keys(self) -> None:
        self._find(tr("Keyboard shortcuts"), True)

    def find_command(self) -> None:
        self._find(tr("Commands"), False)

    def _find(self, title: str, keyed: bool) -> None:
        from app.features.help.command_finder import CommandFinder

        CommandFinder(title, self.list_entries(keyed), self.shell.widget, self.recent).open()

    def read(self, panel: str = "") -> None:
        """Open the page about a panel, else the first one."""
        from app.features.help import manual_pages as pages
        from app.features.help.manual_window import ManualWindow

        widget = self.shell.widget
        if not (pages.DOCS / pages.FIRST).is_file():
            text = tr("This copy of Metagraph came without its manual.")
            box = QMessageBox(QMessageBox.Icon.Information, tr("Manual"), text, parent=widget)
            box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
            return box.open()
        manual = widget.findChild(ManualWindow) or ManualWindow(widget)
        return manual.open_page(pages.PAGES.get(panel, pages.FIRST))

    def read_of_panel(self) -> None:
        self.read(self.shell.services[PanelPlaces].holding(QApplication.focusWidget()))

    def report_system(self) -> None:
        from app.features.help.system_report_dialog import SystemReportDialog

        SystemReportDialog(self.shell.widget).open()

    def list_extras(self) -> None:
        from app.shell.extras_dialog import show_extras

        show_extras(self.shell.widget, self.shell.jobs)

    def show_news(self, release: object = None) -> None:
        """Show what is new in this version, or in a newer release."""
        from app.features.help.news_dialog import NewsDialog
        from app.shell.update_check import Release

        found = release if isinstance(release, Release) else None
        NewsDialog(self.shell.jobs, self.shell.settings, self.shell.widget, found).open()

    def show_about(self) -> None:
        from metagraph import __version__

        kinds = " &nbsp; ".join(f"{KIND_MARKS[k]} {tr(k)}" for k in KINDS)
        text = tr(
            "<h3>Metagraph {version}</h3><p>Drop clips to build a state machine.</p><p>{kinds}</p>",
            version=__version__,
            kinds=kinds,
        )
        box = QMessageBox(QMessageBox.Icon.NoIcon, tr("About Metagraph"), text, parent=self.shell.widget)
        box.setTextFormat(Qt.TextFormat.RichText)
        box.setIconPixmap(box.windowIcon().pixmap(64))
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        box.open()


HELP = "&Help"
HELP_COMMANDS = (
    Command("handbook", HELP, "", tr_noop("&Manual"), HelpFeature.read),
    Command(
        "page_of_panel",
        HELP,
        "",
        tr_noop("Manual page of this &panel"),
        HelpFeature.read_of_panel,
        ("F1",),
        tip=tr_noop("Open the manual page of the active panel"),
    ),
    Command(
        "keys", HELP, "", tr_noop("&Keyboard shortcuts"), HelpFeature.list_keys, ("Shift+F1",), study=True
    ),
    Command(
        "palette",
        HELP,
        "",
        tr_noop("&Commands…"),
        HelpFeature.find_command,
        ("Ctrl+Shift+P",),
        tip=tr_noop("Find commands, panels, stances and actions by name"),
    ),
    Command(
        "extras",
        HELP,
        "",
        tr_noop("&Extras…"),
        HelpFeature.list_extras,
        tip=tr_noop("Install packages that some jobs need: motion graphs, FBX, training, lab recorders"),
    ),
    Command(
        "system_report",
        HELP,
        "",
        tr_noop("&System report"),
        HelpFeature.report_system,
        tip=tr_noop("Versions, graphics and folders, for a problem report"),
    ),
    Command(
        "news",
        HELP,
        "",
        tr_noop("What is &new"),
        HelpFeature.show_news,
        tip=tr_noop("What this version brings, and whether there is a newer one"),
    ),
    Command("about", HELP, "", tr_noop("&About Metagraph"), HelpFeature.show_about, study=True),
)
