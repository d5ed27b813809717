"""The preview panel: the character, live, with its transport, and the base pose always named."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from PySide6.QtCore import QElapsedTimer, QMargins, Qt, QTimer
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QBoxLayout, QHBoxLayout, QLabel, QToolButton, QVBoxLayout, QWidget

from app.features.character.directing import Directing
from app.features.character.looking import Looking, mask_marks
from app.features.character.no_mesh import NoMesh
from app.features.character.overlays import Overlays
from app.features.character.panes import Panes
from app.features.character.reference import Reference, ReferenceBar, ReferencePicture
from app.look import icons
from app.look.names import make_readable_name
from app.look.theme import get_theme
from app.stage.figures import Figures
from app.stage.gl_view import GLView, ImageView, make_view
from app.stage.navigation import get_navigation
from app.stage.performance import StagePerformance
from app.stage.playback_source import ASIDE
from app.stage.playhead import Playhead
from app.stage.props import make_prop_actors
from app.stage.session import StageSession
from app.stage.stools import make_stools
from app.translation import format_number, tr, tr_noop
from app.widgets.making import make_widget
from app.widgets.more_button import MoreButton
from app.widgets.one_stop import OneStop
from app.widgets.quiet_fields import ComboBox, Scrub
from app.widgets.sentence import OneLine
from app.widgets.vocabulary import get_vocabulary_word
from metagraph.graph.model import LAYERS, Project
from preview.camera import Camera, close_up, make_whole_figure_camera
from preview.figure import MeshFigure, SkinnedFigure
from preview.framing import find_lamp_turn, has_studio_lamp, turn_to_face
from preview.scene import Actor, LampTurn, Scene

SPEEDS = (0.1, 0.25, 0.5, 1.0, 1.5, 2.0)
BASE_TIP = tr_noop(
    "The neutral pose that all layers are added to. To set it, right-click a clip in the library."
)
FRAME = 16  # milliseconds between frames
SOFT_FRAME = 33  # where the processor draws them, which has other things to do as well
HINT = 4000  # milliseconds for which it is told how to come back
WIDE = 560  # pixels from which the playhead stands in the line of the buttons


class PreviewPanel(QWidget):
    """Shows what the performance plays at the playhead. Drives the playhead while playing."""

    def __init__(
        self,
        session: StageSession,
        performance: StagePerformance,
        playhead: Playhead,
        figures: Figures,
        parent: QWidget | None = None,
        choose: Callable[[], object] = lambda: None,
        may_choose: Callable[[], bool] = lambda: False,
    ) -> None:
        super().__init__(parent)
        self.session, self.performance, self.playhead, self.figures = session, performance, playhead, figures
        self.bones = False
        self.shown_elsewhere = False  # in a window of its own
        self._framed: tuple[object, ...] = ()  # whom the camera was last framed on
        self._turn = 0.0  # where the character faces who was framed, radians about +Y
        self.composed = Scene()  # what was drawn last
        self._last: tuple[MeshFigure, np.ndarray, np.ndarray] | None = None
        self._marks: dict[int, tuple[float, float, float]] = {}  # of joints, as drawn last
        self._make_view(choose, may_choose)
        self.overlays = Overlays(self)
        self.looking = Looking(self)
        self.directing = Directing(self)
        self.frames = 0
        self.view.painted.connect(self._painted)
        self._lay_out()
        self._clock = QElapsedTimer()
        self._clock.start()
        self._timer = QTimer(self)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._tick)
        self._follow()
        self._restyle()
        self._show_state()
        self._run_or_rest()
        self.overlays.begin()

    # --- building

    def _make_view(self, choose: Callable[[], object], may_choose: Callable[[], bool]) -> None:
        """Make the view and what lies over it."""
        self.view = make_view(self.scene, self)
        self.view.frame_wanted.connect(self.frame_all)
        self.show_navigation()
        self.bare = False
        self._margins: list[QMargins] = []  # of what is hidden then
        self.hint = QLabel(tr("Press F11 to show the other panels again"), self.view)
        self.hint.setProperty("card", True)
        self.hint.setContentsMargins(8, 4, 8, 4)
        self.hint.hide()
        self._hint_goes = QTimer(self, singleShot=True, interval=HINT)
        self._hint_goes.timeout.connect(self.hint.hide)
        self.no_mesh = NoMesh(self.view, choose, may_choose)
        self.mesh_button: QToolButton | None = None  # who makes the panel gives it
        self.watch_button = MoreButton(
            self.session.look, tr("Display options"), tr("What the view shows, and how"), self.view, "eye"
        )
        self.watch_button.setProperty("over", True)

    def _lay_out(self) -> None:
        self._layout = layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        self.panes = Panes(self, self.looking)
        layout.addWidget(self.panes, 1)
        self.reference = Reference(self)
        self.reference.changed.connect(self.view.update)
        self.panes.put_beside(ReferencePicture(self.reference, self.panes))
        self.reference_bar = ReferenceBar(self.reference, self)
        layout.addWidget(self.reference_bar)
        self.scrub = Scrub(Qt.Orientation.Horizontal, self, toolTip=tr("Scrub"))
        self.scrub.setRange(0, 10000)
        self.scrub.setAccessibleName(tr("Playhead"))
        self.scrub.setSingleStep(50)
        self.scrub.setPageStep(500)
        self.scrub.actionTriggered.connect(lambda _: self._scrubbed(self.scrub.sliderPosition()))
        self._above = QHBoxLayout()
        self._above.setContentsMargins(12, 6, 12, 0)
        self._above.addWidget(self.scrub)
        layout.addLayout(self._above)
        self._row = self._transport()
        layout.addLayout(self._row)
        self._lines = self._captions()
        layout.addLayout(self._lines)

    def show_navigation(self) -> None:
        """Say how the mouse moves the camera."""
        words = tr(get_navigation().words)
        self.view.setToolTip(words)
        self.view.setAccessibleDescription(words)

    def _follow(self) -> None:
        """Draw again, and show again, what changes."""
        session, performance = self.session, self.performance
        session.transport.moved.connect(lambda _: self.view.update())
        session.transport.playing_changed.connect(self._show_state)
        session.transport.playing_changed.connect(self._run_or_rest)
        session.transport.show_changed.connect(self._show_state)
        session.selection.changed.connect(self.view.update)
        for looks in (session.look.changed, session.watch.changed):
            looks.connect(self._restyle)
        session.watch.changed.connect(self._run_or_rest)
        session.onion.changed.connect(self.view.update)
        performance.changed.connect(self.view.update)
        performance.document.changed.connect(self._edited)
        self.figures.changed.connect(self.view.update)

    def _transport(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setContentsMargins(8, 2, 8, 2)
        row.setSpacing(2)

        def button(tip: str, slot: object, checkable: bool = False) -> QToolButton:
            out = make_widget(QToolButton, self, toolTip=tip, checkable=checkable)
            out.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            out.setAccessibleName(tip.split(" (")[0])
            out.clicked.connect(slot)
            row.addWidget(out)
            return out

        self.start_button = button(tr("Back to the start (Home)"), lambda: self.session.transport.seek(0.0))
        self.play_button = button(
            tr("Play or pause (Space)"),
            lambda: self.session.transport.set_playing(not self.session.transport.playing),
        )
        self.loop_button = button(tr("Loop (L)"), self._set_loop, checkable=True)
        self.loop_button.setChecked(self.session.transport.loop)
        self.speed_box = ComboBox(self, toolTip=tr("Speed"))
        self.speed_box.setAccessibleName(tr("Speed"))
        self.speed_box.addItems([f"{format_number(s, 'g')}×" for s in SPEEDS])
        self.speed_box.setCurrentIndex(SPEEDS.index(1.0))
        self.speed_box.activated.connect(lambda i: setattr(self.session.transport, "speed", SPEEDS[i]))
        row.addWidget(self.speed_box)
        self._scrub_place = row.count()
        row.addStretch(1)
        self.time = QLabel("0:00.0", self)
        self.time.setMinimumWidth(52)
        self.time.setAlignment(Qt.AlignmentFlag.AlignCenter)
        row.addWidget(self.time)
        row.addStretch(1)
        self.frame_button = button(tr("Frame the whole character (F)"), self.frame_all)
        self.face_button = button(tr("Close-up of the face (Shift+F)"), self.frame_face)
        self.bones_button = button(tr("Show the skeleton (B)"), self._set_bones, checkable=True)
        OneStop((self.start_button, self.play_button, self.loop_button), self, self.play_button)
        OneStop((self.frame_button, self.face_button, self.bones_button), self)
        return row

    def _captions(self) -> QBoxLayout:
        """What plays, and the base pose below it; long names are cut, not the window widened."""
        lines = QBoxLayout(QBoxLayout.Direction.TopToBottom)
        lines.setContentsMargins(12, 0, 12, 8)
        lines.setSpacing(2)
        self.caption, self.base = OneLine(self), OneLine(self, tr(BASE_TIP))
        for label in (self.caption, self.base):
            label.setProperty("dim", True)
            lines.addWidget(label)
        return lines

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Where it is wide, what stands below the view takes half as many lines: the view is the larger."""
        super().resizeEvent(event)
        wide = event.size().width() >= WIDE
        if wide == (self._row.indexOf(self.scrub) >= 0):
            return
        if wide:
            self._above.removeWidget(self.scrub)
            self._row.insertWidget(self._scrub_place, self.scrub, 12)
        else:
            self._row.removeWidget(self.scrub)
            self._above.addWidget(self.scrub)
        self._above.setContentsMargins(12, 0 if wide else 6, 12, 0)
        directions = QBoxLayout.Direction
        self._lines.setDirection(directions.LeftToRight if wide else directions.TopToBottom)

    def _restyle(self) -> None:
        look = get_theme(self.session.look.name)
        self.view.theme = self.session.make_view_look()
        for button, name in (
            (self.start_button, "start"), (self.loop_button, "loop"), (self.frame_button, "frame"),
            (self.face_button, "face"), (self.bones_button, "bones"),
        ):  # fmt: skip
            button.setIcon(icons.make_icon(name, look.text))
        self._show_state()
        self.view.update()

    # --- drawing

    def scene(self) -> Scene:
        """Return what is drawn now; called by the view when it paints."""
        shown, seconds, actors = self.performance.shown, self.session.transport.seconds, []
        props: list[Actor] = []
        seats: list[Actor] = []
        kind, meshes = self.session.watch.now.seat, self.figures.props.meshes
        for one in shown.everyone:
            pose, skeleton = one.pose(seconds), one.skeleton
            figure = self.figures.of(one) if skeleton is not None else None
            if pose is None or skeleton is None or figure is None:
                continue
            rotations, positions = skeleton.globals(pose)
            if one.stand is not None:
                rotations, positions = one.stand.placed(rotations, positions)
            own = self.performance.is_documents(one)
            now = self.performance.document.project.props if own else None
            props += make_prop_actors(one, meshes, (rotations, positions), now)
            seats += make_stools(one, kind, figure, meshes, now)
            if one is shown:
                self._last = (figure, rotations, positions)
            morphs = figure.morph_weights(one.morphs(seconds)) if figure.morphs else None
            marks = mask_marks(self.performance, self.session) if one is shown else {}
            self._marks = marks if one is shown else self._marks
            actors.append(Actor(figure, rotations, positions, morphs, marks, self.bones))
            if one is shown:
                actors += self.overlays.made(figure, seconds)
        behind = self.reference.picture if self.reference.behind else None
        scene = Scene((*actors, *props, *seats), picture=behind)
        shape = round(self.view.width() / max(1, self.view.height()), 1)  # frame it again for another size
        solid = Scene(tuple(actor for actor in actors if actor.opacity >= 1))  # ghosts do not move the camera
        framed = (*(actor.figure for actor in solid.actors), *(one.stand for one in shown.everyone), shape)
        lamp = self.directing.follow(shown, seconds)
        if lamp is not None:  # a cut has the camera
            self.composed = replace(scene, lamp=lamp)
            return self.composed
        if actors and self._framed != framed and not self.view.moved_by_hand:
            self._framed = framed
            first = solid.actors[0]
            turn = 0.0 if shown.others else turn_to_face(first.figure, first.positions)
            self._turn = turn
            aside = ASIDE if shown.others else turn
            self.view.camera = make_whole_figure_camera(
                solid.drawn_bounds(), self.view.width() / max(1, self.view.height()), aside
            )
        elif self._last is not None:
            self.looking.keep_in_picture(shown, self._last[0])
        self.composed = replace(scene, lamp=self._find_lamp(alone=not shown.others))
        return self.composed

    def _find_lamp(self, alone: bool) -> LampTurn | None:
        """Return how the lamp is turned: the studio's follows the camera, all follow who faces elsewhere."""
        if alone and has_studio_lamp(self.view.theme):
            return find_lamp_turn(self.view.camera.yaw, self._turn)
        return LampTurn(self._turn) if self._turn else None

    def _run_or_rest(self) -> None:
        """Count the time while it plays; what is paused costs nothing."""
        frame = SOFT_FRAME if isinstance(self.view, ImageView) else FRAME
        self._timer.setInterval(round(frame * self.panes.slower))
        if not self.session.transport.playing:
            self._timer.stop()
        elif not self._timer.isActive():
            self._clock.restart()
            self._timer.start()

    def _tick(self) -> None:
        elapsed = self._clock.restart() / 1000
        if self.session.transport.playing and (self.isVisible() or self.shown_elsewhere):
            self.playhead.advance(min(elapsed, 0.25))

    def _painted(self, _: float) -> None:
        self.frames += 1
        seconds = self.session.transport.seconds
        self.time.setText(f"{int(seconds // 60)}:{format_number(seconds % 60, '04.1f')}")
        length = max(1e-6, self.performance.shown.length)
        if not self.scrub.isSliderDown():
            self.scrub.setValue(round(10000 * min(1.0, seconds / length)))
        self.caption.say(self._words())
        self.watch_button.move(self.view.width() - self.watch_button.width() - 8, 8)
        self.directing.tell(seconds)
        self._tell_mesh()

    def _tell_mesh(self) -> None:
        """Say over the view why no mesh of a character is drawn, where none is."""
        figure = self._last[0] if self._last is not None else None
        empty = self.performance.document.project.skeleton is None
        bare = figure is not None and not empty and not isinstance(figure, SkinnedFigure)
        self.no_mesh.tell(_why(figure.instead) if figure is not None and bare else None)

    def _words(self) -> str:
        """Say what plays: the clip alone, or each layer's action and when the next begins."""
        shown = self.performance.shown
        if shown.clip is not None:
            return tr("{name}, clip only", name=make_readable_name(shown.project.clips[shown.clip].name))
        seconds, out = self.session.transport.seconds, []
        for layer in LAYERS:
            cue = shown.plan.layers[layer].cue_at(seconds)
            if cue is not None:
                out.append(f"{get_vocabulary_word(layer)}: {make_readable_name(cue.action.name)}")
        if self.session.transport.show == "context":
            out.append(tr("in context"))
        return "   ".join(out)

    def stop(self) -> None:
        """Draw no more by itself; at closing."""
        self._timer.stop()
        self.looking.set_turning(False)
        self.reference.stop()

    # --- commands

    def set_bare(self, on: bool) -> None:
        """Show the character and nothing else, or its transport and captions, too."""
        if on == self.bare:
            return
        self.bare = on
        for layout in (self._above, self._row, self._lines):
            if on:  # margins round nothing would be an edge beneath the view
                self._margins.append(layout.contentsMargins())
                layout.setContentsMargins(0, 0, 0, 0)
            elif self._margins:
                layout.setContentsMargins(self._margins.pop(0))
            for n in range(layout.count()):
                item = layout.itemAt(n)
                part = item.widget() if item is not None else None
                if part is not None:
                    part.setVisible(not on)
        self.overlays.set_bare()
        self.reference.changed.emit()
        self.watch_button.setVisible(not on)
        self.hint.setVisible(on)
        if on:
            self.hint.adjustSize()
            self.hint.move(12, 12)
            self._hint_goes.start()
        else:
            self._hint_goes.stop()

    @property
    def drawn(self) -> tuple[MeshFigure, np.ndarray, np.ndarray] | None:
        """Figure, rotations `[J, 4]` and positions `[J, 3]` of what was drawn last."""
        return self._last

    @property
    def active_view(self) -> GLView | ImageView:
        """The view that was touched last, of several: commands look from there."""
        return self.panes.active

    def put_below_view(self, widget: QWidget) -> None:
        """Show a widget directly below the view."""
        self._layout.insertWidget(1, widget)

    def frame_all(self) -> None:
        self.panes.frame()
        self.view.moved_by_hand = False
        self.view.camera = self.view.camera.deepened()
        self._framed = ()
        self.view.update()

    def frame_face(self) -> None:
        view = self.panes.active
        camera = self.face_camera(view.width() / max(1, view.height()))
        if camera is not None:
            view.camera, view.moved_by_hand = camera, True
            view.update()

    def face_camera(self, aspect: float) -> Camera | None:
        """Return what looks at the face, None while nobody is drawn."""
        if self._last is None:
            return None
        figure, rotations, positions = self._last
        return close_up(figure.head(rotations, positions), figure.height, aspect, self.looking.heading)

    def _scrubbed(self, value: int) -> None:
        self.session.transport.set_playing(False)
        self.session.transport.seek(value / 10000 * self.performance.shown.length)

    def _set_loop(self, on: bool) -> None:
        self.session.transport.loop = on
        self.loop_button.setChecked(on)

    def toggle_loop(self) -> None:
        self._set_loop(not self.session.transport.loop)

    def _set_bones(self, on: bool) -> None:
        self.bones = on
        self.bones_button.setChecked(on)
        self.view.update()

    def toggle_bones(self) -> None:
        self._set_bones(not self.bones)

    # --- following

    def _show_state(self) -> None:
        look = get_theme(self.session.look.name)
        self.play_button.setIcon(
            icons.make_icon("pause" if self.session.transport.playing else "play", look.text)
        )
        self._clock.restart()

    def _edited(self, before: Project, after: Project) -> None:
        base, entry = after.base, after.clips.get(after.base.clip or "")
        if after.skeleton is None:
            self.base.say("")
        elif entry is None:
            self.base.say(tr("Base pose: rest pose"))
        else:
            self.base.say(
                tr("Base pose: {name}, frame {frame}", name=make_readable_name(entry.name), frame=base.frame)
            )
        if after.skeleton is None:
            self._tell_mesh()
        # What plays follows when it is planned again; the marks of a mask are the project's own.
        if before.skeleton is not after.skeleton or mask_marks(self.performance, self.session) != self._marks:
            self.view.update()


def _why(instead: str) -> str:
    """Say why no mesh of a character is drawn."""
    return f"{instead[0].upper()}{instead[1:]}." if instead else ""
