"""The marks and ghosts over the view of a preview panel, made when they are wanted."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from app.features.character.overlay_host import OverlayHost

if TYPE_CHECKING:
    from app.features.character.foot_marks import FootMarks
    from app.features.character.ghosts import Ghosts
    from app.features.character.hand_marks import HandMarks
    from preview.figure import MeshFigure
    from preview.scene import Actor


class Overlays:
    """The marks of feet and hands and the ghosts of a preview panel. Until they are wanted they are not even
    read.
    """

    def __init__(self, panel: OverlayHost) -> None:
        self.panel = panel
        panel.session.watch.changed.connect(self._chosen)

    def _chosen(self) -> None:
        if self.panel.session.watch.now.feet:
            _ = self.feet
        if self.panel.session.watch.now.hands:
            _ = self.hands
        self.panel.view.update()

    def begin(self) -> None:
        """Show what was shown last."""
        self._chosen()

    @cached_property
    def feet(self) -> FootMarks:
        from app.features.character.foot_marks import FootMarks

        return FootMarks(self.panel)

    @cached_property
    def hands(self) -> HandMarks:
        from app.features.character.hand_marks import HandMarks

        return HandMarks(self.panel)

    @cached_property
    def ghosts(self) -> Ghosts:
        from app.features.character.ghosts import Ghosts

        return Ghosts(self.panel)

    def made(self, figure: MeshFigure, seconds: float) -> list[Actor]:
        """Return the ghosts at a time."""
        session, watch = self.panel.session, self.panel.session.watch.now
        compared = self.panel.performance.shown.beside is not None
        wanted = watch.stance or watch.before or watch.after or compared or session.onion.skin is not None
        return self.ghosts.made(figure, seconds) if wanted or "ghosts" in self.__dict__ else []

    def set_bare(self) -> None:
        """Show or hide what stands below the view."""
        if "feet" in self.__dict__:
            self.feet.show_or_hide()
