"""Properties of what is selected: one action or many at once, clips, or the layer when nothing is."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, Qt, QTimer
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QScrollArea, QSizePolicy, QStackedWidget, QWidget

from app.features.properties.clip_page import ClipPage
from app.features.properties.layer_page import LayerPage
from app.features.properties.page_form import ANY
from app.project.document import Document
from app.stage.session import StageSession
from app.translation import tr_error
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import Action, Project

if TYPE_CHECKING:
    from app.features.properties.action_page import ActionPage

LOW = 240  # pixels of height below which the curves of a timing leave no room for anything else


PLOTS = "app.features.properties.action_page"  # takes long to import
SOON = 1500  # milliseconds after which the page of actions is made, before anybody selects one


class PropertiesPanel(QScrollArea):
    """What is shown is read back from the project. layer, action, clip: its pages. fetch: imports modules on
    a thread, and goes on. furnish: gives the actions' page what else it shows, once it is made.
    """

    def __init__(
        self,
        document: Document,
        session: StageSession,
        fetch: Callable[[Iterable[str], Callable[[], object]], object],
        furnish: Callable[[ActionPage], object],
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.document, self.session = document, session
        self._fetch, self._furnish, self._fetching = fetch, furnish, False
        self._action: ActionPage | None = None
        self.setWidgetResizable(True)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)  # what is in it has the keyboard
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.pages = QStackedWidget(self)
        self.layer = LayerPage(document, session, self._try, self)
        self.clip = ClipPage(document, session, self._try, self)
        self._none = QWidget(self)  # where the page of actions will be
        for page in (self.layer, self._none, self.clip):
            self.pages.addWidget(page)
        self.setWidget(self.pages)
        document.changed.connect(self._edited)
        for signal in (session.selection.changed, session.look.changed):
            signal.connect(self.show_selection)
        for signal in (session.place.layer_changed, session.place.stance_changed):
            signal.connect(self._moved_on)
        self._early = QTimer(self, singleShot=True, interval=SOON)
        self._early.timeout.connect(self._make_early)
        self._early.start()
        self.show_selection()

    # --- the page of actions, which is made when there are any to show, or when nothing else is to be done

    @property
    def action(self) -> ActionPage:
        """The page of actions; it is made now where it was not yet."""
        return self._action or self._make_page()

    def _make_page(self) -> ActionPage:
        from app.features.properties.action_page import ActionPage

        self._action = page = ActionPage(self.document, self.session, self._try, self)
        self.pages.insertWidget(1, page)
        self.pages.removeWidget(self._none)
        self._none.deleteLater()
        self._furnish(page)
        page.fit(self.size())
        self._set_low(page, self.height())
        self.show_selection()
        return page

    def _make_early(self) -> None:
        """Make the page before it is needed: the first click would wait a tenth of a second for it."""
        if self._action is None and not self._fetching:
            self._fetching = True
            self._fetch((PLOTS,), self._fetched)

    def _fetched(self) -> None:
        self._fetching = False
        if self._action is None and PLOTS in sys.modules:
            self._make_page()
        else:
            self.show_selection()

    # --- its size

    def resizeEvent(self, event: QResizeEvent) -> None:
        page = self._action
        if page is not None:
            page.fit(event.size())
            if self._set_low(page, event.size().height()):
                self.show_selection()
        super().resizeEvent(event)
        self._bound()

    def _set_low(self, page: ActionPage, height: int) -> bool:
        """Where it is low and not wide, the curves give way: what can be typed is in sight. Return whether
        that is different now.
        """
        low = page.timing_elsewhere() or (height < LOW and not page.beside)
        page.low, was = low, page.low
        return low != was

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if watched is self.pages and event.type() == QEvent.Type.LayoutRequest:
            self._bound()
        return super().eventFilter(watched, event)

    def _bound(self) -> None:
        """Side by side, the halves are as high as what is seen of them: the second scrolls alone."""
        page = self._action
        beside = page is not None and page.beside and self.pages.currentIndex() == 1
        self.pages.setMaximumHeight(
            max(page.minimumSizeHint().height(), self.viewport().height())
            if page is not None and beside
            else ANY
        )

    # --- showing

    def _moved_on(self) -> None:
        """Another layer or stance is looked at: that shows if nothing is selected."""
        chosen = self.session.selection
        if not chosen.selected_actions() and not chosen.clips:
            self.show_selection()

    def _edited(self, before: Project, after: Project) -> None:
        chosen = self.session.selection.selected_actions()
        if chosen and all(_untouched(before, after, action) for action in chosen):
            return
        if (
            before.graphs is not after.graphs
            or before.clips is not after.clips
            or before.base != after.base
            or before.markov is not after.markov
            or before.settings != after.settings
            or before.marks is not after.marks
        ):
            self.show_selection()

    def show_selection(self) -> None:
        actions = self.session.selection.selected_actions()
        clips = self.session.selection.clips
        if self._fetching and actions:  # what was shown stays until it is there
            return  # not asked of sys.modules, which lists a module while it is still being imported
        if actions and self._action is None and PLOTS not in sys.modules:
            self._fetching = True
            self._fetch((PLOTS,), self._fetched)
            return
        self._turn_to(1 if actions else 2 if clips else 0)
        if self._action is not None and not actions:
            self._action.set_first_low(False)
        if actions:
            self.action.show_actions(actions)
            self._bound()
        elif clips:
            self.clip.show_clips(clips)
        else:
            self.layer.show_layer()

    def _turn_to(self, place: int) -> None:
        """Show a page; the panel is as large as that one needs to be, and not as the largest."""
        policy = QSizePolicy.Policy
        for n in range(self.pages.count()):
            page = self.pages.widget(n)
            if page is not None:
                page.setSizePolicy(policy.Preferred, policy.Preferred if n == place else policy.Ignored)
        self.pages.setCurrentIndex(place)
        self._bound()

    def _try(self, text: str, function: Callable[[Project], Project], merge: str | None = None) -> bool:
        try:
            self.document.edit(text, function, merge)
        except EditError as error:
            self.document.failed.emit(tr_error(error))
            self.show_selection()
            return False
        return True


def _untouched(before: Project, after: Project, action: Action) -> bool:
    """Whether an edit left an action as it was, and all else that its page reports it: its clip, the names of
    stances and the loops it begins and ends in.
    """
    parts = ("clips", "skeleton", "base", "roles", "parts", "settings")
    if any(getattr(before, part) is not getattr(after, part) for part in parts):
        return False
    was, now = before.graphs[action.layer], after.graphs[action.layer]
    return was is now or (
        was.actions.get(action.id) is action
        and was.stances is now.stances
        and was.weights is now.weights
        and all(
            was.of(stance, "stance") is now.of(stance, "stance")
            for stance in (action.stance, action.end_stance)
            if stance is not None
        )
    )
