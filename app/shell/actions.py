"""Define the commands of all features as data: one table makes the menus, the header, the shortcuts and the
list of shortcuts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import groupby
from typing import Literal

from PySide6.QtCore import QObject, QSettings
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QMenu, QMenuBar, QWidget

from app import faults
from app.shell.mnemonics import with_distinct_keys
from app.shell.studio_defaults import find_hidden_commands, find_studio_shortcuts
from app.translation import tr, tr_noop
from app.widgets.soon import Soon

Standard = QKeySequence.StandardKey
Words = str | Callable[..., str]

# The menus with their groups, in order; a line separates groups. A group that is not listed here comes last
# in its menu.
MENUS: dict[str, tuple[str, ...]] = {
    tr_noop("&File"): ("project", "examples", "kept", "save", "import", "character", "write", "quit"),
    tr_noop("&Edit"): ("history", "selection", "properties", "find"),
    tr_noop("&Graph"): ("author", "label", "layers", "stances", "skeleton"),
    tr_noop("C&lips"): ("rating", "labels", "favourites", "files", "view", "groups"),
    tr_noop("&Motion"): ("make", "contacts"),
    tr_noop("&Play"): ("transport", "range", "markers", "timeline", "live", "show"),
    tr_noop("&Conversation"): ("read", "settings", "stage", "write", "remove"),
    tr_noop("&View"): ("workspaces", "workspace", "character", "sides", "watch", "graph", "look"),
    tr_noop("&Study"): (),
    tr_noop("&Help"): (),
}
# Groups that are a submenu, by their menu; neighbours with the same title share one. So no menu has more
# than 15 entries.
SUBMENUS: dict[str, dict[str, str]] = {
    "&File": {
        "examples": tr_noop("Open an e&xample"),
        "import": tr_noop("&Import"),
        "character": tr_noop("C&haracter"),
    },
    "&Graph": {"layers": tr_noop("&Go to"), "stances": tr_noop("&Go to")},
    "C&lips": {"rating": tr_noop("&Rating"), "labels": tr_noop("&Colour label"), "groups": tr_noop("&Group")},
    "&Play": {
        "range": tr_noop("Loop &range"),
        "markers": tr_noop("&Markers"),
        "timeline": tr_noop("&Timeline"),
    },
    "&View": {
        "workspaces": tr_noop("&Workspace"),
        "workspace": tr_noop("&Workspace"),
        "sides": tr_noop("&Camera"),
        "watch": tr_noop("&Show"),
    },
}


@dataclass(frozen=True)
class Command:
    """Something a user can do.

    `id` is stable. `menu` and `group` say where it is, see `MENUS`. `keys` are its shortcuts. `tip` adds to
    its text. `enabled` and `checked` are called whenever something changed, `visible` says whether it is in
    its menu; `text` may be a function, too. `when` is the mode in which it can be used. `study` says whether
    it is offered during a study's task; "labels" offers it if the study allows proposals. `menus` are the
    context menus it is in: "action", "clip" or others. `fill` fills a submenu that is shown instead. In a
    table (`app/shell/command_table.py`) all functions take the feature first.
    """

    id: str
    menu: str
    group: str
    text: Words
    run: Callable[..., object] = lambda *_: None
    keys: tuple[str | QKeySequence.StandardKey, ...] = ()
    tip: str = ""
    icon: str = ""
    enabled: Callable[..., bool] | None = None
    checked: Callable[..., bool] | None = None
    visible: Callable[..., bool] | None = None
    when: Literal["any", "meta", "manual"] = "any"
    study: Literal[False, True, "labels"] = False
    menus: tuple[str, ...] = ()
    fill: Callable[..., object] | None = None

    @property
    def words(self) -> str:
        """Return the current text."""
        return self.text if isinstance(self.text, str) else self.text()

    @property
    def plain(self) -> str:
        """Return the text without marks, as a tooltip or a list shows it."""
        return self.words.replace("&", "").rstrip("…")


class _Shown:
    """A command's action, and what it was last set to; nothing else sets these."""

    def __init__(self, command: Command, action: QAction) -> None:
        self.command, self.action, self.text = command, action, command.text
        self.enabled, self.words = action.isEnabled(), action.text()


def _run(command: Command) -> None:
    faults.note(command.id)
    command.run()


class Actions:
    """The window's QActions by command id. `refresh` updates whether they are enabled and checked;
    `refresh_soon` does so once for several changes at a time, or when one of them is needed.

    `allowed` says which commands may be used at all; None allows every one. `mode` returns what is edited
    now.
    """

    def __init__(self, parent: QWidget, commands: Iterable[Command], mode: Callable[[], str]) -> None:
        self.commands = _in_order(tuple(commands))
        self.allowed: Callable[[Command], bool] | None = None
        self._mode = mode
        self._soon = Soon(self.refresh, parent)
        self._made: dict[str, QAction] = {}
        usual = {c.id: tuple(QKeySequence(k).toString() for k in c.keys) for c in self.commands}
        studio = find_studio_shortcuts(usual)
        self._hidden = find_hidden_commands(usual, QSettings())
        room = QObject(parent)  # a window handles an event for each child of its own
        for command in self.commands:
            if command.id in self._made:
                raise ValueError(f"two commands are called {command.id!r}")
            action = QAction(command.words, room)
            action.setObjectName(command.id)
            # A platform's standard key may equal the one given beside it; twice, it would be ambiguous.
            keys_once = dict.fromkeys(studio.get(command.id, usual[command.id]))
            if keys_once:
                action.setShortcuts([QKeySequence(k) for k in keys_once])
            if command.id in self._hidden:
                action.setVisible(False)
            keys = action.shortcut().toString(QKeySequence.SequenceFormat.NativeText)
            tip = command.tip or command.plain
            action.setToolTip(f"{tip} ({keys})" if keys else tip)
            action.setStatusTip(command.tip)
            action.setCheckable(command.checked is not None)
            if command.fill is not None:
                menu = QMenu(parent)
                menu.aboutToShow.connect(lambda m=menu, fill=command.fill: (m.clear(), fill(m)))
                action.setMenu(menu)
            action.triggered.connect(lambda _=False, c=command: _run(c))
            parent.addAction(action)
            self._made[command.id] = action
        self._shown = [_Shown(command, self._made[command.id]) for command in self.commands]
        self._by_menu = [
            (_submenu_titles(menu) if not title else (), tuple(shown))
            for (menu, title), shown in _grouped(self._shown).items()
        ]

    @property
    def by_id(self) -> dict[str, QAction]:
        """Return all of them, up to date."""
        self.settle()
        return self._made

    def __getitem__(self, ident: str) -> QAction:
        return self.by_id[ident]

    def __contains__(self, ident: str) -> bool:
        return ident in self._made

    def of_menu(self, name: str) -> list[QAction]:
        """Return the actions of a context menu, in the menus' order."""
        return [self._made[c.id] for c in self.commands if name in c.menus]

    def fill(self, bar: QMenuBar) -> dict[str, QMenu]:
        """Make the menus and their submenus; return the menus."""
        menus: dict[str, QMenu] = {}
        names = list(dict.fromkeys(command.menu for command in self.commands))
        titles = dict(zip(names, with_distinct_keys(tuple(tr(name) for name in names)), strict=True))
        for (name, group), commands in groupby(self.commands, lambda command: (command.menu, command.group)):
            if name not in menus:
                menus[name] = bar.addMenu(titles[name])
                menus[name].aboutToShow.connect(self.refresh)  # panels have buttons for some of it, too
                inside: dict[str, QMenu] = {}  # its submenus
                apart = False  # whether a line must separate what comes next
            title = SUBMENUS.get(name, {}).get(group)
            if title is None:
                place = menus[name]
                if apart:
                    place.addSeparator()
            elif title in inside:
                place = inside[title]
                place.addSeparator()
            else:
                place = inside[title] = menus[name].addMenu(tr(title))
            apart = True
            for command in commands:
                place.addAction(self._made[command.id])
        return menus

    def settle(self) -> None:
        """Update every command, if that is still to be done."""
        self._soon.now()

    def refresh_soon(self) -> None:
        """Update every command once the present changes are over."""
        self._soon.ask()

    def refresh(self) -> None:
        """Update every command now."""
        self._soon.done()
        mode, allowed = self._mode(), self.allowed
        for shown in self._shown:
            command, action = shown.command, shown.action
            usable = command.when in ("any", mode) and (allowed is None or allowed(command))
            enabled = usable and (command.enabled is None or command.enabled())
            if enabled != shown.enabled:
                shown.enabled = enabled
                action.setEnabled(enabled)
            if command.checked is not None:
                action.setChecked(command.checked())  # a click changes it, too
            if command.visible is not None and command.id not in self._hidden:
                action.setVisible(command.visible())
        for titles, menu in self._by_menu:
            texts = tuple([s.text if isinstance(s.text, str) else s.text() for s in menu])
            for shown, text in zip(menu, with_distinct_keys((*titles, *texts))[len(titles) :], strict=True):
                if text != shown.words:
                    shown.words = text
                    shown.action.setText(text)


def _grouped(shown: Iterable[_Shown]) -> dict[tuple[str, str], list[_Shown]]:
    """Return the commands by their menu and submenu, "" for none."""
    out: dict[tuple[str, str], list[_Shown]] = {}
    for one in shown:
        title = SUBMENUS.get(one.command.menu, {}).get(one.command.group, "")
        out.setdefault((one.command.menu, title), []).append(one)
    return out


def _submenu_titles(menu: str) -> tuple[str, ...]:
    return tuple(tr(title) for title in dict.fromkeys(SUBMENUS.get(menu, {}).values()))


def _in_order(commands: tuple[Command, ...]) -> tuple[Command, ...]:
    """Return commands by menu and group; within a group in the given order."""
    menus = list(MENUS)

    def place(command: Command) -> tuple[int, str, int]:
        groups = MENUS.get(command.menu, ())
        menu = menus.index(command.menu) if command.menu in MENUS else len(menus)
        return menu, command.menu, groups.index(command.group) if command.group in groups else len(groups)

    return tuple(sorted(commands, key=place))
