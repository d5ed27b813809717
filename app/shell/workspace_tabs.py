"""Show the workspaces as tabs in the header, and define their commands."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QHBoxLayout, QInputDialog, QMenu, QMessageBox, QToolButton, QWidget

from app.shell.actions import Actions, Command
from app.shell.workspace_keeper import Workspaces
from app.shell.workspaces import WORKSPACES
from app.translation import tr, tr_error
from app.widgets.making import make_widget
from app.widgets.one_stop import OneStop

KEYS = 9  # workspaces with a key of their own
WIDEST = 110  # pixels of an own workspace's name


def list_workspace_commands(keeper: Callable[[], Workspaces], window: QWidget) -> tuple[Command, ...]:
    """Return the commands for workspaces."""

    def choose(place: int) -> None:
        if place < len(keeper().tabs):
            keeper().choose(keeper().tabs[place].id)

    def there(place: int) -> bool:
        return place < len(keeper().tabs)

    def title(place: int) -> str:
        return keeper().tabs[place].title if there(place) else tr("Workspace {title}", title=place + 1)

    def on(place: int) -> bool:
        return there(place) and keeper().tabs[place].id == keeper().current

    def ask(words: str, title: str, do: Callable[[str], None]) -> None:
        name, said = QInputDialog.getText(window, words, tr("Name"), text=title)
        if not said:
            return
        try:
            do(name)
        except ValueError as error:
            QMessageBox.warning(window, words, tr_error(error))

    view, group = "&View", "workspaces"
    own = lambda: keeper().tab.own  # noqa: E731
    return (
        *(
            Command(
                f"workspace_{n + 1}",
                view,
                group,
                partial(title, n),
                partial(choose, n),
                (f"Ctrl+Alt+{n + 1}",),
                tip=tr(WORKSPACES[n].tip) if n < len(WORKSPACES) else tr("Your own workspace"),
                enabled=partial(there, n),
                visible=partial(there, n),
                checked=partial(on, n),
            )
            for n in range(KEYS)
        ),
        Command(
            "arrange",
            view,
            "workspace",
            tr("&Reset workspace"),
            lambda: keeper().reset(),
            tip=tr("Restore the panels of this workspace to their original places"),
        ),
        Command(
            "save_workspace",
            view,
            "workspace",
            tr("Save &workspace as…"),
            lambda: ask(tr("Save workspace as"), "", keeper().save_as),
            tip=tr("Save the current arrangement of panels as a tab of your own"),
        ),
        Command(
            "rename_workspace",
            view,
            "workspace",
            tr("Re&name workspace…"),
            lambda: ask(tr("Rename workspace"), keeper().tab.title, keeper().rename),
            enabled=own,
            menus=("workspace",),
        ),
        Command(
            "delete_workspace",
            view,
            "workspace",
            tr("&Delete workspace"),
            lambda: keeper().delete(),
            enabled=own,
            menus=("workspace",),
        ),
    )


class WorkspaceTabs(QWidget):
    """A tab for each workspace; that of the current one is pressed."""

    def __init__(self, keeper: Workspaces, actions: Actions, parent: QWidget) -> None:
        super().__init__(parent)
        self.keeper, self.commands = keeper, actions
        self.setAccessibleName(tr("Workspaces"))
        self._row = QHBoxLayout(self)
        self._row.setContentsMargins(0, 0, 0, 0)
        self._row.setSpacing(2)
        self.buttons: list[QToolButton] = []
        self._stop = OneStop((), self)
        keeper.changed.connect(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Show which workspaces there are, and which is current."""
        tabs = self.keeper.tabs
        while len(self.buttons) > len(tabs):
            gone = self.buttons.pop()
            self._row.removeWidget(gone)
            gone.deleteLater()
        while len(self.buttons) < len(tabs):
            self.buttons.append(self._button(len(self.buttons)))
        self._stop.show(self.buttons)
        for place, (tab, button) in enumerate(zip(tabs, self.buttons, strict=True)):
            words = button.fontMetrics().elidedText(tab.title, Qt.TextElideMode.ElideMiddle, WIDEST)
            button.setText(words)
            button.setAccessibleName(tr("Workspace {title}", title=tab.title))
            button.setChecked(tab.id == self.keeper.current)
            button.setToolTip(self._tip(place))

    def _tip(self, place: int) -> str:
        tab = self.keeper.tabs[place]
        words = tab.title if tab.own else tr(tab.of.tip)
        return f"{words} (Ctrl+Alt+{place + 1})" if place < KEYS else words

    def _button(self, place: int) -> QToolButton:
        button = make_widget(QToolButton, self, checkable=True)
        button.clicked.connect(partial(self._choose, place))
        button.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        button.customContextMenuRequested.connect(partial(self._menu, place))
        self._row.addWidget(button)
        return button

    def _choose(self, place: int) -> None:
        self.keeper.choose(self.keeper.tabs[place].id)
        self.refresh()  # a click on the pressed button releases it

    def _menu(self, place: int, at: QPoint) -> None:
        self._choose(place)
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.commands.refresh()
        for ident in ("arrange", "save_workspace", "rename_workspace", "delete_workspace"):
            menu.addAction(self.commands[ident])
        menu.popup(self.buttons[place].mapToGlobal(at))
