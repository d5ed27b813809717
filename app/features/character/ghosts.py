"""Make ghosts beside the character: moments before and after now (onion skin), the stance below, moments that
the timing editor wants to show, and what it is compared with. Each has its name where it is farthest from
the present pose.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

from app.features.character.overlay_host import OverlayHost
from app.features.character.plates import draw_plate
from app.look.theme import get_theme
from app.stage.over_view import lie_over
from app.stage.playback_source import ShownPlayback
from app.translation import format_number, tr
from app.widgets.vocabulary import get_vocabulary_word
from metagraph.graph.model import Project
from metagraph.motion.skeleton import Pose
from metagraph.playback.posing.composer import find_playable_motion
from preview.figure import MeshFigure
from preview.scene import Actor

NOW = 0.03  # seconds from the present moment within which a ghost would only blur the figure
NEAREST, FARTHEST = 0.34, 0.12  # how much of the ghost next to now is seen, and of the last
STANCE = 0.30  # how much of the stance is
COMPARED = 0.45  # how much of what it is compared with is
# What was is dark and what comes is light.
BEFORE = (0.30, 0.32, 0.36)
AFTER, AFTER_ON_LIGHT = (0.86, 0.88, 0.92), (0.56, 0.58, 0.62)
ASIDE = 0.02  # of the height: a stance ghost whose joints are all that near would only blur the figure


class Ghosts(QWidget):
    """Makes the ghosts of a preview panel. It is also the pane over the view that shows their names."""

    def __init__(self, panel: OverlayHost) -> None:
        super().__init__(panel.view)
        self.panel = panel
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._still: tuple[ShownPlayback, ShownPlayback] | None = None  # one that plays, and itself at rest
        self._labels: list[tuple[str, np.ndarray]] = []
        self.hide()
        panel.view.painted.connect(self._follow)
        panel.session.watch.changed.connect(self._chosen)

    def _chosen(self) -> None:
        self._labels = []  # until they are drawn
        self._follow()
        self.panel.view.update()

    def made(self, figure: MeshFigure, seconds: float) -> list[Actor]:
        """Return the ghosts at a time."""
        shown, watch = self.panel.performance.shown, self.panel.session.watch.now
        self._labels = []
        if shown.skeleton is None or shown.others:
            return []
        return [
            *self._of_action(figure, shown, seconds),
            *self._of_other(figure, shown, seconds),
            *(self._of_moments(figure, shown, seconds) if watch.before or watch.after else ()),
            *(self._of_stance(figure, shown, seconds) if watch.stance else ()),
        ]

    def _of_action(self, figure: MeshFigure, shown: ShownPlayback, seconds: float) -> list[Actor]:
        """Return the moments of an action that are to be seen through, except for those that are now."""
        skin, out = self.panel.session.onion.skin, []
        for moment, opacity in skin.moments if skin is not None else ():
            at = shown.seconds_of(skin.action, moment) if skin is not None else None
            if at is None or abs(at - seconds) < NOW:
                continue
            pose = shown.pose(at)
            if pose is not None:
                out.append(self._ghost(figure, shown, pose, opacity))
        return out

    def _of_other(self, figure: MeshFigure, shown: ShownPlayback, seconds: float) -> list[Actor]:
        """Return the pose of now, beside what was before (A/B)."""
        if shown.beside is None or shown.beside.skeleton != shown.skeleton:
            return []
        pose = shown.beside.pose(min(seconds, shown.beside.length))
        if pose is None:
            return []
        color = QColor(get_theme(self.panel.session.look.name).strong)
        ghost = self._ghost(figure, shown, pose, COMPARED, (color.redF(), color.greenF(), color.blueF()))
        return [ghost] if self._label(tr("Now"), ghost) else []

    def _of_moments(self, figure: MeshFigure, shown: ShownPlayback, seconds: float) -> list[Actor]:
        watch = self.panel.session.watch.now
        steps = [*range(-watch.before, 0), *range(1, watch.after + 1)]
        moments = [(k, seconds + k * watch.spacing) for k in steps]
        moments = [(k, at) for k, at in moments if 0.0 <= at <= shown.length]
        poses = shown.pose(np.array([at for _, at in moments])) if moments else None
        out = []
        for n, (k, at) in enumerate(moments if poses is not None else ()):
            assert poses is not None
            far = (abs(k) - 1) / max(1, (watch.before if k < 0 else watch.after) - 1)
            pose = Pose(poses.rotations[n], poses.translations[n])
            actor = self._ghost(figure, shown, pose, NEAREST + (FARTHEST - NEAREST) * far, self._color(k))
            out.append(actor)
            self._label(f"{'−' if k < 0 else '+'}{format_number(abs(at - seconds), '.2g')} s", actor)
        return out

    def _color(self, step: int) -> tuple[float, float, float]:
        if step < 0:
            return BEFORE
        return AFTER if self.panel.session.look.name == "dark" else AFTER_ON_LIGHT

    def _of_stance(self, figure: MeshFigure, shown: ShownPlayback, seconds: float) -> list[Actor]:
        pose = self._stance(shown, seconds)
        if pose is None:
            return []
        color = QColor(get_theme(self.panel.session.look.name).fill("stance"))
        actor = self._ghost(figure, shown, pose, STANCE, (color.redF(), color.greenF(), color.blueF()))
        return [actor] if self._label(get_vocabulary_word("stance"), actor) else []

    def _label(self, words: str, ghost: Actor) -> bool:
        """Name a ghost where it is farthest from now; return whether it is anywhere."""
        last = self.panel.drawn
        if last is None or last[2].shape != ghost.positions.shape:
            return True
        away = np.linalg.norm(ghost.positions - last[2], axis=-1)
        if away.max() < ASIDE * last[0].height:
            return False
        self._labels.append((words, ghost.positions[int(away.argmax())]))
        return True

    def _stance(self, shown: ShownPlayback, seconds: float) -> Pose | None:
        """Return the pose the character would have without what it plays: the stances of all layers; of
        a clip alone the beginning of its stance's loop.
        """
        if shown.clip is not None:
            return _loop_begins(shown.project, shown.clip)
        if shown.manual is not None or shown.motion is not None:
            return None
        if self._still is None or self._still[0] is not shown:
            layers = {layer: replace(of, cues=()) for layer, of in shown.plan.layers.items()}
            self._still = shown, replace(shown, plan=replace(shown.plan, layers=layers), over=None)
        return self._still[1].pose(seconds)

    def _ghost(
        self,
        figure: MeshFigure,
        shown: ShownPlayback,
        pose: Pose,
        opacity: float,
        color: tuple[float, float, float] | None = None,
    ) -> Actor:
        assert shown.skeleton is not None
        rotations, positions = shown.skeleton.globals(pose)
        if shown.stand is not None:
            rotations, positions = shown.stand.placed(rotations, positions)
        marks = dict.fromkeys(range(len(shown.skeleton)), color) if color is not None else {}
        return Actor(figure, rotations, positions, marks=marks, opacity=opacity)

    def _follow(self, *_: object) -> None:
        if bool(self._labels) == self.isHidden():
            self.setVisible(bool(self._labels))
        if self._labels:
            lie_over(self, self.panel.view)

    def paintEvent(self, event: QPaintEvent) -> None:
        view, look = self.panel.view, get_theme(self.panel.session.look.name)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        taken: list[QRectF] = []
        for words, place in self._labels:
            x, y = view.camera.project(place, view.width() / max(1, view.height())) * [
                self.width(),
                self.height(),
            ]
            if not np.isfinite((x, y)).all():
                continue
            high = painter.fontMetrics().height() / 2
            taken.append(draw_plate(painter, look, QPointF(x, y - high), words, taken))  # heads are near
        painter.end()


def _loop_begins(project: Project, clip: str) -> Pose | None:
    """Return the first pose of the loop of the stance that a clip is used on."""
    for action in project.uses.get(clip, ()):
        for loop in project.graphs[action.layer].of(action.stance, "stance"):
            motion = find_playable_motion(project, loop)
            if motion is not None:
                return motion.pose_at(project.span(loop)[0])
    return None
