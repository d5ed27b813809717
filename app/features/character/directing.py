"""The preview of a conversation as it is cut, and the captions over it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

from app.stage.playback_source import ShownPlayback
from app.widgets.memo import Once

if TYPE_CHECKING:
    from app.stage.cutting import Cutting
    from metagraph.speech.captions import Caption
    from preview.scene import LampTurn


class CaptionLabel(QWidget):
    """Lies over the view and lets the mouse through."""

    def __init__(self, view: QWidget) -> None:
        super().__init__(view)
        self.view, self.shown = view, list["Caption"]()
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setAccessibleName("Captions")
        self.hide()
        view.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize:
            self.resize(self.view.size())
        return False

    def say(self, shown: list[Caption]) -> None:
        if shown != self.shown:
            self.shown = shown
            self.setAccessibleDescription("\n".join(c.text for c in shown))
            self.resize(self.view.size())
            self.setVisible(bool(shown))
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        from app.stage.caption_paint import paint_captions

        painter = QPainter(self)
        paint_captions(painter, self.width(), self.height(), self.shown)
        painter.end()


class Directing:
    """panel: the preview. Its camera is the cuts' until the hand moves it, and again once it is framed."""

    def __init__(self, panel: Any) -> None:
        self.panel = panel
        self.label = CaptionLabel(panel.view)
        self._cutting: Cutting | None = None
        self._captions: Once[tuple[Caption, ...]] = Once()
        self._cut = False  # the camera is the cuts'
        panel.performance.timeline.changed.connect(panel.view.update)
        panel.performance.document.loaded.connect(self.forget)

    def forget(self) -> None:
        self._cutting, self._captions, self._cut = None, Once(), False
        self.label.say([])

    def follow(self, shown: ShownPlayback, seconds: float) -> LampTurn | None:
        """Let the camera be where the cuts want it, and return how they turn the light; called before a
        picture is drawn.
        """
        view, performance = self.panel.view, self.panel.performance
        cuts = performance.timeline.now.cuts if shown.others else ()
        if not cuts or view.moved_by_hand or self.panel.session.transport.show != "plan":
            if self._cut and not view.moved_by_hand:
                self._cut = False
                self.panel.frame_all()  # all are seen, as before there were cuts
            self._cut = self._cut and bool(cuts)
            return None
        seen = [(self.panel.figures.of(one), one) for one in shown.everyone]
        if any(figure is None for figure, _ in seen):
            return None
        if self._cutting is None:
            from app.stage.cutting import Cutting

            self._cutting = Cutting()
        filmed = self._cutting.camera(seen, cuts, seconds, view.width() / max(1, view.height()))
        if filmed is not None:
            view.camera, self._cut = filmed.camera, True
            return filmed.lamp
        if self._cut:  # before the first cut
            self._cut = False
            self.panel.frame_all()
        return None

    def tell(self, seconds: float) -> None:
        """Show the words of who speaks, where they are wanted."""
        performance = self.panel.performance
        if not performance.timeline.now.captions or self.panel.session.transport.show != "plan":
            self.label.say([])
            return
        from pathlib import Path

        from app.stage.cutting import list_captions
        from metagraph.speech.captions import find_captions_at

        shown, document = performance.shown, performance.document
        talk = document.project.conversations.get(performance.conversation or "")
        folder = document.folder or Path()
        found = self._captions.of((), (shown, talk), lambda: list_captions(shown, talk, folder))
        self.label.say(find_captions_at(found, seconds))
