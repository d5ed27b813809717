"""What the editor is about: the selected actions, what of them is shown, and as what they are compared."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QImage

from app.features.timing_editor.axis import Axis
from app.features.timing_editor.line_heard import (
    Said,
    Waves,
    find_line_heard,
    find_line_stresses,
    find_requested_line,
    lay_line,
)
from app.features.timing_editor.since import Since
from app.features.timing_editor.track import Facts, TimingTrack
from app.project.document import Document
from app.stage.compatibility_state import Compatibility
from app.stage.line_player import Sound
from app.stage.onion import OnionSkin
from app.stage.performance import StagePerformance
from app.stage.playback_source import LEAD
from app.stage.session import StageSession
from app.stage.thumbnails import Thumbnails
from app.translation import tr
from app.widgets.memo import Once
from metagraph.graph import anatomy, edits
from metagraph.graph.clip_source import get_clip_course
from metagraph.graph.editing.retiming import keep_hand, set_hold, set_retime, set_speed
from metagraph.graph.model import Project
from metagraph.graph.repeating import seconds_played
from metagraph.motion.dope import DopeSheet, make_dope_sheet
from metagraph.playback.timing.handles import move_handle

Array = NDArray[Any]

HELD = 0.4  # seconds of a new hold
KEPT = 0.5  # seconds for which a hand is kept at least
BEFORE = 0.5  # seconds that are seen before a blend that is played
MOST = 12  # actions below each other
EMPTY = DopeSheet((), np.zeros((0, 0)), np.zeros((0, 0)))
GHOSTS = {"start": 0.22, "stroke": 0.34, "end": 0.22}  # how much of each is seen


@dataclass(frozen=True)
class Shows:
    """joint: whose speed, "" for what the action moves. poses, dope, line: whether these rows are wanted.
    whole: the sheet has a line for each joint, not for each part of the body. heard: the line that is laid on
    it, "" for the one that is spoken over it.
    """

    joint: str = ""
    poses: bool = True
    line: bool = True
    dope: bool = False
    whole: bool = False
    heard: str = ""
    onion: bool = False


class Subject(QObject):
    """changed: what is to be drawn, except for the playhead. before: the state that is compared with, None
    while nothing is. marked: the state the present one would be compared with.
    """

    changed = Signal()

    def __init__(
        self,
        document: Document,
        session: StageSession,
        performance: StagePerformance,
        compatibility: Compatibility,
        thumbnails: Thumbnails,
        sound: Sound,
        since: Since,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.performance = document, session, performance
        self.compatibility, self.thumbnails, self.sound = compatibility, thumbnails, sound
        self.since = since
        self.shows = Shows()
        self.idents: tuple[str, ...] = ()
        self.said: Said | None = None
        self.marked: Project | None = None
        self.before: Project | None = None
        self._tracks: dict[str, TimingTrack] = {}
        self._old: dict[str, TimingTrack] = {}
        self._waves = Waves()
        self._sheets: dict[str, Once[DopeSheet]] = {}
        document.loaded.connect(self._loaded)
        document.changed.connect(self._edited)
        session.selection.changed.connect(self._selected)
        performance.changed.connect(self._planned)
        compatibility.changed.connect(self.changed)
        compatibility.seen.connect(lambda ident: self.changed.emit() if ident in self.idents else None)
        thumbnails.ready.connect(self._drawn)
        self.changed.connect(self._skin)
        self._selected()

    # --- following

    def _loaded(self) -> None:
        """Another project: nothing is remembered of the one before."""
        self.shows, self.said, self.marked = Shows(), None, None
        self.idents, self._tracks, self._old, self._sheets = (), {}, {}, {}
        self._waves = Waves()
        self.session.transport.set_part(None)
        self._compare(None)
        self.changed.emit()

    def _selected(self) -> None:
        chosen = self.session.selection.actions[:MOST]
        if chosen != self.idents:
            self.idents = chosen
            self.marked = self.since.project
            self._compare(None)
            self._hear()
        self.changed.emit()

    def _edited(self, before: Project, after: Project) -> None:
        same = ("graphs", "clips", "roles", "parts", "skeleton", "lines", "voices", "performances")
        if any(getattr(before, name) is not getattr(after, name) for name in same):
            self._hear()
            self.changed.emit()

    def _planned(self) -> None:
        self._hear()
        self.changed.emit()

    def _drawn(self, clip: str) -> None:
        if self.shows.poses and any(f.action.clip == clip for f in self.facts().values()):
            self.changed.emit()

    def _hear(self) -> None:
        """Find what is said over the first of the actions: as laid on it by hand, else as it is performed on
        stage, else the line that asks for it.
        """
        action = self.document.project.action(self.idents[0]) if self.idents else None
        if action is None:
            self.said = None
            return
        if self.shows.heard:
            stroke = next((f.handle("stroke") for f in self.facts().values()), None)
            at = stroke.at if stroke is not None else self.document.project.span(action)[0]
            self.said = lay_line(self.document.project, self.shows.heard, action, at)
            return
        project, staged = self.document.project, self.performance.staged
        said = find_line_heard(staged, action) if staged is not None else None
        self.said = said if said is not None else find_requested_line(project, action)

    def show(self, **changes: Any) -> None:
        """Show something else of the actions; fields of `Shows`."""
        self.shows = replace(self.shows, **changes)
        self._hear()
        self.changed.emit()

    # --- what is computed

    def facts(self) -> dict[str, Facts]:
        """Return what is shown of each action that is still there, in the order they were selected."""
        project, out = self.document.project, {}
        for ident in self.idents:
            track = self._tracks.setdefault(ident, TimingTrack(ident))
            found = track.facts(project, self.shows.joint, self.compatibility.curves)
            if found is not None:
                out[ident] = found
        return out

    def before_facts(self) -> dict[str, Facts]:
        """Return the same of the state that is compared with; nothing while none is."""
        if self.before is None:
            return {}
        out = {}
        for ident in self.idents:
            track = self._old.setdefault(ident, TimingTrack(ident))
            found = track.facts(self.before, self.shows.joint, lambda _: None)
            if found is not None:
                out[ident] = found
        return out

    def row_names(self, place: int) -> tuple[str, ...]:
        """Return the rows of the action at a place among those selected."""
        one = len(self.idents) == 1
        first = [
            *(["poses"] if self.shows.poses and one else []),
            *(["line"] if self.shows.line and self.said is not None and place == 0 else []),
        ]
        hands = [f"hand {n}" for n in range(len(tuple(self.facts().values())[place].hands))]
        return (*first, "phases", "speed", "numbers", *hands, "stance")

    def film(self, ident: str) -> Sequence[QImage]:
        action = self.document.project.action(ident)
        wanted = self.shows.poses and len(self.idents) == 1 and action is not None
        return self.thumbnails.strip(action.clip) if wanted and action is not None else []

    def sheet(self, ident: str) -> DopeSheet:
        """Return what moves when in an action's clip; nothing if that is not wanted."""
        project = self.document.project
        action = project.action(ident)
        entry = project.clips.get(action.clip) if action is not None else None
        if not self.shows.dope or entry is None or entry.motion is None:
            return EMPTY
        motion = entry.motion
        groups: Mapping[str, str] | None = None
        if not self.shows.whole and motion.skeleton == project.skeleton:
            groups = dict(zip(motion.skeleton.names, anatomy.project_parts(project), strict=True))
        once = self._sheets.setdefault(ident, Once())
        key = (tuple(groups.items()) if groups is not None else (),)
        return once.of(key, (motion,), lambda: make_dope_sheet(motion, groups))

    def clip_axis(self, axis: Axis, facts: Facts) -> Axis:
        """Return the axis as it is for one clip of several."""
        return replace(axis, length=facts.entry.duration)

    def wave(self, axis: Axis, facts: Facts) -> tuple[Array, Array]:
        """Return the line that is heard in columns of pixels."""
        if self.said is None:
            return np.zeros(0), np.zeros(0)
        return self._waves.columns(self.document.project, self.said, self.sound.sounds, axis)

    def stresses(self, facts: Facts) -> tuple[float, ...]:
        if not self.idents or facts.action.id != self.idents[0]:
            return ()
        return find_line_stresses(self.document.project, self.said)

    def playhead(self) -> float | None:
        """Return the moment of the first action's clip that plays; None while it does not."""
        action = self.document.project.action(self.idents[0]) if self.idents else None
        if action is None:
            return None
        return self.performance.shown.clip_seconds(action, self.session.transport.seconds)

    # --- what is done

    def move_here(self, facts: Facts, handle: str) -> None:
        """Move a handle of all the actions to the playhead."""
        now = self.playhead()
        if now is not None:
            self.set_number(dict.fromkeys(self.idents, now), handle)

    def set_number(self, at: Mapping[str, float], handle: str) -> None:
        """Move a handle of actions to moments of their clips, in one step."""
        project = self.document.project
        changes = {
            ident: {"timing": move_handle(project, action, handle, seconds)}
            for ident, seconds in at.items()
            if (action := project.action(ident)) is not None and action.clip in project.clips
        }
        self.document.edit(tr("Change timing"), lambda p: edits.update_each(p, changes))

    def set_speed(self, speed: float) -> None:
        """Play the clips of all the actions at a speed, in one step. Raises EditError."""
        clips = tuple(dict.fromkeys(f.action.clip for f in self.facts().values()))

        def all_of(project: Project) -> Project:
            for clip in clips:
                project = set_speed(project, clip, speed)
            return project

        self.document.edit(tr("Change speed"), all_of)

    def hold_here(self, seconds: float = HELD) -> None:
        """Hold the first action's clip at the playhead for a while longer. Raises EditError."""
        facts, now = next(iter(self.facts().values()), None), self.playhead()
        course = get_clip_course(facts.entry) if facts is not None else None
        if facts is None or course is None:
            return
        clip = facts.action.clip
        at = round(float(course.moments(np.array(facts.span[0] if now is None else now))), 3)
        had = next((h.seconds for h in facts.entry.retime.holds if h.at == at), 0.0)
        self.document.edit(tr("Insert hold"), lambda p: set_hold(p, clip, at, had + seconds))

    def keep_hand(self, side: str) -> None:
        """Keep a hand where it is on the body: during the part that is looped, where one is, else from the
        playhead to the end of its hold, at least for `KEPT` seconds. Raises EditError.
        """
        facts, now = next(iter(self.facts().values()), None), self.playhead()
        course = get_clip_course(facts.entry) if facts is not None else None
        if facts is None or course is None:
            return
        clip, part = facts.action.clip, self.session.transport.part
        first = facts.span[0] if now is None else now
        relax = next((b.last for b in facts.blocks if b.name == "hold"), 0.0)
        last = max(first + KEPT, relax)
        if part is not None and part[0] == clip:
            first, last = part[1:]
        a, b = course.moments(np.array([first, last])).tolist()
        self.document.edit(tr("Pin hand"), lambda p: keep_hand(p, clip, side, round(a, 3), round(b, 3)))

    def let_go(self) -> None:
        """Let all hands of the first action's clip go where they went in the file."""
        facts = next(iter(self.facts().values()), None)
        if facts is not None:
            clip, plain = facts.action.clip, replace(facts.entry.retime, contacts=())
            self.document.edit(tr("Release hands"), lambda p: set_retime(p, clip, plain))

    def compare(self, on: bool) -> None:
        """Show the actions as they were when they were selected, or marked, or as they are."""
        if on and self.idents and self.session.transport.show == "clip":
            self.session.show_context(self.idents[0])  # a clip alone is the same before and after
        self._compare(self.marked if on else None)
        self.changed.emit()

    def mark(self) -> None:
        """From now on compare with what is there now."""
        self.marked = self.document.project
        self._compare(None)
        self.changed.emit()

    def _compare(self, before: Project | None) -> None:
        self.before = before
        self._old = {}
        self.performance.compare(before)

    def play_blend(self, ident: str, handle: str) -> None:
        """Play an action between its stances, from just before the blend whose handle is "in" or "out"."""
        action, project = self.document.project.action(ident), self.document.project
        if action is None or handle not in ("in", "out"):
            return
        self.session.show_context(ident)
        if handle == "out" and action.kind != "stance":
            start, end = project.span(action)
            played = seconds_played(action.kind, action.timing, start, end)
            self.session.transport.seek(max(0.0, LEAD + played - action.timing.blend_out - BEFORE))

    def loop_action(self) -> None:
        """Play the part of the clip that the action plays again and again, or all of it again."""
        facts = next(iter(self.facts().values()), None)
        transport = self.session.transport
        if facts is None:
            return
        if transport.part is not None and transport.part[0] == facts.action.clip:
            transport.set_part(None)
            return
        transport.scrub(facts.action.clip, facts.span[0])
        first, last = facts.span
        transport.set_part((facts.action.clip, round(first, 3), round(last, 3)))
        transport.set_playing(True)

    def _skin(self) -> None:
        """Show start, stroke and end of the first action beside the character, if that is wanted."""
        facts = next(iter(self.facts().values()), None) if self.shows.onion else None
        if facts is None:
            self.session.onion.show(None)
            return
        found = [(h.at, GHOSTS[h.name]) for h in facts.handles if h.name in GHOSTS]
        self.session.onion.show(OnionSkin(facts.action, tuple(found)))
