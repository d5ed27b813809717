"""Where the character is looked at from: sides by key as in other 3D programs, hands near, a flat view, a
turntable; and the picture as it stands, on the clipboard.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject, QTimer
from PySide6.QtGui import QGuiApplication

from app.features.character.overlay_host import OverlayHost
from app.features.character.trails import Trails
from app.look.theme import get_theme
from app.stage.performance import StagePerformance
from app.stage.session import StageSession
from metagraph.graph import anatomy
from metagraph.motion.skeleton import Pose
from preview.camera import Camera, make_whole_figure_camera
from preview.framing import turn_to_face

if TYPE_CHECKING:
    from app.stage.gl_view import GLView, ImageView
    from app.stage.playback_source import ShownPlayback
    from preview.figure import MeshFigure

SIDES: dict[str, tuple[float, float]] = {  # yaw and pitch, degrees
    "front": (0.0, 5.0), "back": (180.0, 5.0), "left": (90.0, 5.0), "right": (-90.0, 5.0),
    "quarter": (28.0, 7.0), "above": (0.0, 89.0),
}  # fmt: skip
ROUND = 8.0  # seconds of a turn of the turntable
TURN = 33  # milliseconds between its steps
DARKEST = 0.35  # of its colour, a joint that hardly moves
LOOKS = 24  # poses of a clip that are looked at to see whether it stays in the picture
CUT = 0.03  # of the picture: what a box round a figure may reach beyond it before it is framed again
HANDS = 0.16  # metres round the hands that are in the picture


class Looking(QObject):
    """What moves the camera of a preview panel by command. A camera that was moved stays where it is until
    the whole character is framed again.
    """

    def __init__(self, panel: OverlayHost) -> None:
        super().__init__(panel.view)
        self.panel = panel
        self.trails = Trails(panel)
        self._fitted: tuple[object, MeshFigure] | None = None  # what was last looked at whole
        self._stepped_back = False  # whether the camera is as far away as that takes
        self._turntable = QTimer(self, interval=TURN)
        self._turntable.timeout.connect(self._turn)

    @property
    def _view(self) -> GLView | ImageView:
        """The view that was touched last, of several."""
        return self.panel.active_view

    def _aim(self, camera: Camera) -> None:
        view = self._view
        view.camera = camera
        view.moved_by_hand = True
        view.update()

    @property
    def heading(self) -> float:
        """Return where the character faces, radians about +Y."""
        stand, last = self.panel.performance.shown.stand, self.panel.drawn
        if stand is not None:
            return stand.turn
        return turn_to_face(last[0], last[2]) if last is not None else 0.0

    def see_from(self, side: str) -> None:
        """Look from one of SIDES, as near as before."""
        yaw, pitch = (math.radians(x) for x in SIDES[side])
        self._aim(self._view.camera.facing(yaw + self.heading, pitch))

    def see_hands(self) -> None:
        """Go near both hands, or to the one there is; nothing happens where no hand is known."""
        room, view = self.hands(), self._view
        if room is not None:
            self._aim(view.camera.frame(room, view.width() / max(1, view.height())))

    def hands(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Return the lowest and highest corner of a box round the hands; None if no hand is known."""
        last, project = self.panel.drawn, self.panel.performance.shown.project
        if last is None or project.skeleton is None or len(last[2]) != len(project.skeleton):
            return None
        roles = anatomy.project_roles(project)
        hands = [last[2][roles[role]] for role in ("left_hand", "right_hand") if role in roles]
        return (np.min(hands, axis=0) - HANDS, np.max(hands, axis=0) + HANDS) if hands else None

    def keep_in_picture(self, shown: ShownPlayback, figure: MeshFigure) -> None:
        """Step back where a clip that plays alone would leave the picture, and go to a performance that plays
        outside it; once until something else plays, unless the camera was moved. What plays after a step back
        is framed again.
        """
        view, clip = self.panel.view, shown.clip
        entry = shown.project.clips.get(clip) if clip is not None else None
        what: object = entry.motion if entry is not None else shown.project.graphs
        same = self._fitted is not None and self._fitted[0] is what and self._fitted[1] is figure
        if same or view.moved_by_hand:
            return
        self._fitted = (what, figure)
        times = np.linspace(0, shown.length, LOOKS) if clip is not None else np.zeros(1)
        pose = shown.pose(times) if not shown.others else None  # who talks with others is framed with them
        if pose is None or shown.skeleton is None or figure.skeleton != shown.skeleton:
            return
        low, high = figure.posed_bounds(*shown.skeleton.globals(pose))
        aspect = view.width() / max(1, view.height())
        corners = np.stack(np.meshgrid(*zip(low, high, strict=True)), -1).reshape(-1, 3)
        at = view.camera.project(corners, aspect)
        middle = at.mean(0)
        inside = (at > -CUT) & (at < 1 + CUT) if clip is not None else (middle > 0) & (middle < 1)
        if self._stepped_back or not inside.all():
            self._stepped_back = clip is not None and not inside.all()
            first = shown.skeleton.globals(Pose(pose.rotations[0], pose.translations[0]))[1]
            view.camera = make_whole_figure_camera((low, high), aspect, turn_to_face(figure, first))

    @property
    def flat(self) -> bool:
        """Whether things far away are as large as near ones."""
        return self._view.camera.flat

    def set_flat(self, on: bool) -> None:
        view = self._view
        moved = view.moved_by_hand
        self._aim(view.camera.flattened() if on else view.camera.deepened())
        view.moved_by_hand = moved

    @property
    def turning(self) -> bool:
        return self._turntable.isActive()

    def set_turning(self, on: bool) -> None:
        """Turn round the character, or stop."""
        if on:
            self._turntable.start()
        else:
            self._turntable.stop()

    def _turn(self) -> None:
        if self.panel.isVisible():
            self._aim(self._view.camera.orbit(2.0 * TURN / 1000 / ROUND, 0.0))

    @property
    def trailing(self) -> bool:
        """Whether the trails of hands and head are shown."""
        return self.trails.on

    def set_trailing(self, on: bool) -> None:
        self.trails.show_or_hide(on)

    def copy(self) -> None:
        """Put the picture on the clipboard."""
        QGuiApplication.clipboard().setPixmap(self.panel.view.grab())


def mask_marks(performance: StagePerformance, session: StageSession) -> dict[int, tuple[float, float, float]]:
    """Point out the joints of the selected action's mask, each in its kind's colour, the darker the less far
    it moves.
    """
    project = performance.document.project
    actions = session.selection.selected_actions()
    if len(actions) != 1 or project.skeleton is None or not (actions[0].joints or actions[0].joint_weights):
        return {}
    moved = anatomy.make_action_mask(project, actions[0])
    color = get_theme(session.look.name).fill(actions[0].kind)
    rgb = np.array([color.redF(), color.greenF(), color.blueF()])
    if moved is None:
        return {}
    shades = {int(j): rgb * (DARKEST + (1 - DARKEST) * moved[j]) for j in np.flatnonzero(moved)}
    return {joint: (float(r), float(g), float(b)) for joint, (r, g, b) in shades.items()}
