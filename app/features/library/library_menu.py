"""What the library's menu offers: what is shown, in which order, in which groups and columns, and filters
that were kept under a name.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, Protocol

from PySide6.QtGui import QActionGroup
from PySide6.QtWidgets import QInputDialog, QMenu

from app.features.library.clip_badges import HEART, PENCIL, label_icon
from app.features.library.clip_columns import format_stars
from app.features.library.clip_filter import Filter
from app.features.library.clip_groups import GROUPS
from app.features.library.clip_list import ClipList
from app.features.library.clip_order import GIVEN, ORDERS
from app.features.library.clip_rows import ClipRows
from app.features.library.clip_sizes import Style
from app.features.library.library_settings import LibrarySettings
from app.look.domain_words import COLOR_LABELS, KIND_TITLES, LAYER_LONG_TITLES
from app.look.theme import KIND_MARKS
from app.translation import tr
from metagraph.graph.clip_mark import COLORS, STARS
from metagraph.graph.model import KINDS, LAYERS


class MenuHost(Protocol):
    """What the menu knows of the library, and has it do."""

    list: ClipList
    rows: ClipRows
    settings: LibrarySettings

    def narrow(self, layer: str | None = None, kind: str | None = None) -> None: ...
    def ask_for(self, **changes: Any) -> None: ...
    def show_filter(self, rule: Filter) -> None: ...
    def show_as(self, style: Style) -> None: ...
    def sort(self, order: str) -> None: ...
    def group_by(self, group: str) -> None: ...
    def close_all(self) -> None: ...


class LibraryMenu:
    """orders, groups: submenus of which one entry each is checked. It is filled once; `marks`, `kept` and
    `columns` are filled when they are opened.
    """

    def __init__(self, panel: MenuHost, menu: QMenu) -> None:
        self.panel = panel
        menu.addAction(tr("All kinds and layers"), lambda: panel.narrow())
        menu.addSeparator()
        for kind in KINDS:
            menu.addAction(f"{KIND_MARKS[kind]}  {KIND_TITLES[kind]}", partial(panel.narrow, kind=kind))
        menu.addSeparator()
        for layer in LAYERS:
            menu.addAction(LAYER_LONG_TITLES[layer], partial(panel.narrow, layer=layer))
        menu.addSeparator()
        self.marks = menu.addMenu(tr("With these &marks"))
        self.marks.aboutToShow.connect(self.fill_marks)
        self.kept = menu.addMenu(tr("Sa&ved filters"))
        self.kept.aboutToShow.connect(self.fill_kept)
        menu.addSeparator()
        self.orders = menu.addMenu(tr("&Sort by"))
        self._choices(self.orders, {k: words for k, (words, _) in ORDERS.items()}, GIVEN, panel.sort)
        self.orders.addSeparator()
        again = lambda: panel.sort(panel.rows.listing.order)  # noqa: E731
        self.backwards = self.orders.addAction(tr("&Reverse order"), again)
        self.backwards.setCheckable(True)
        self.groups = menu.addMenu(tr("&Group by"))
        titles = {k: words for k, (words, _) in GROUPS.items()}
        self._choices(self.groups, titles, panel.rows.listing.group, panel.group_by)
        self.groups.addSeparator()
        self.groups.addAction(tr("Collapse all\t-"), panel.close_all)
        self.groups.addAction(tr("Expand all\t*"), lambda: panel.rows.close_groups(frozenset()))
        self.columns = menu.addMenu(tr("&Columns"))
        self.columns.aboutToShow.connect(self.fill_columns)

    def _choices(
        self, menu: QMenu, titles: dict[str, str], now: str, choose: Callable[[str], object]
    ) -> None:
        group = QActionGroup(menu)
        for key, words in titles.items():
            action = menu.addAction(words, partial(choose, key))
            action.setCheckable(True)
            action.setChecked(key == now)
            action.setData(key)
            group.addAction(action)

    @staticmethod
    def check(menu: QMenu, key: str) -> None:
        """Check the entry of a choice."""
        for action in menu.actions():
            if action.data() is not None:
                action.setChecked(action.data() == key)

    def fill_marks(self) -> None:
        """Offer what clips can have on them; what is requested is checked, a click takes it back."""
        menu, rule = self.marks, self.panel.rows.filter
        menu.clear()

        def entry(words: str, on: bool, **changes: object) -> None:
            action = menu.addAction(words, partial(self.panel.ask_for, **changes))
            action.setCheckable(True)
            action.setChecked(on)

        entry(tr("{heart}  Favourites", heart=HEART), rule.favourite, favourite=not rule.favourite)
        entry(tr("{pencil}  With a note", pencil=PENCIL), rule.noted, noted=not rule.noted)
        entry(tr("!  With problems"), rule.broken, broken=not rule.broken)
        menu.addSeparator()
        for color in COLORS:
            on = rule.color == color
            entry(COLOR_LABELS[color], on, color=None if on else color)
            menu.actions()[-1].setIcon(label_icon(color))
        menu.addSeparator()
        for rating in range(1, STARS + 1):
            on = rule.stars == rating
            words = format_stars(rating)
            words = tr("{stars} or more", stars=words) if rating < STARS else words
            entry(words, on, stars=0 if on else rating)

    def fill_kept(self) -> None:
        """Offer the filters that have a name."""
        menu, kept = self.kept, self.panel.settings.filters()
        menu.clear()
        menu.addAction(tr("&Save this filter as…"), self.save).setEnabled(self.panel.rows.filter != Filter())
        if kept:
            menu.addSeparator()
        for name, rule in kept.items():
            menu.addAction(name.replace("&", "&&"), partial(self.panel.show_filter, rule))
        if kept:
            menu.addSeparator()
            gone = menu.addMenu(tr("&Delete"))
            for name in kept:
                gone.addAction(name.replace("&", "&&"), partial(self.forget, name))

    def save(self) -> None:
        """Ask for a name, and keep what is shown now under it."""
        rule = self.panel.rows.filter
        usual = " ".join(filter(None, (rule.text.strip(), rule.words())))
        name, accepted = QInputDialog.getText(self.panel.list, tr("Save filter"), tr("Name:"), text=usual)
        if accepted and name.strip():
            self.panel.settings.keep_filters({**self.panel.settings.filters(), name.strip(): rule})

    def forget(self, name: str) -> None:
        """Delete a filter that was kept."""
        left = {n: rule for n, rule in self.panel.settings.filters().items() if n != name}
        self.panel.settings.keep_filters(left)

    def fill_columns(self) -> None:
        """Offer the columns."""
        self.columns.clear()
        if self.panel.list.style_of == "columns":
            self.panel.list.header.fill(self.columns)
        else:
            self.columns.addAction(tr("Show as columns"), lambda: self.panel.show_as("columns"))
