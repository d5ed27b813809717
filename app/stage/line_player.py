"""Play spoken lines in step with the picture.

A thread of the sound library requests samples, which are mixed from the lines in the plan. Without a sound
device, or without the library, everything else works and the status bar says why it is silent.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from PySide6.QtCore import QObject, Signal

from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.performance import StagePerformance
from app.stage.session import StageSession
from app.translation import tr, tr_error
from metagraph.graph.model import Project
from metagraph.graph.requests import Line

RATE = 44100  # as in speech.soundtrack, which is not imported before something is said
LATENCY = 0.08  # seconds of sound on its way to the ear: enough to avoid gaps on a busy machine
DRIFT = 0.08  # seconds the sound may differ from the picture before it is corrected
EMPTY: list[tuple[float, np.ndarray]] = []


class Sound(QObject):
    """Plays the lines of what is on stage while the playhead runs at normal speed. `told` says why it is
    silent.
    """

    told = Signal(str)

    def __init__(
        self,
        document: Document,
        session: StageSession,
        performance: StagePerformance,
        jobs: Jobs,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.performance, self.jobs = document, session, performance, jobs
        self.muted = False
        self.sounds: dict[str, np.ndarray] = {}
        self.parts = EMPTY  # what sounds when; replaced, never changed, because another thread reads it
        self.place = 0  # the next sample to play
        self._stream: Any = None
        self._silent = False  # there is no way to play sound; this was reported
        self._files: dict[str, tuple[str, int | None]] = {}
        document.changed.connect(self._edited)
        document.state_changed.connect(lambda: self._edited(document.project, document.project))
        performance.changed.connect(self._planned)
        session.transport.moved.connect(self._moved)
        session.transport.playing_changed.connect(self._moved)
        session.transport.show_changed.connect(self._moved)

    # --- the lines' files

    def _edited(self, before: Project, after: Project) -> None:
        self._want({**after.lines, **self._said()})

    def _said(self) -> dict[str, Line]:
        """Return the lines of a conversation on stage, which are in no project."""
        talking = self.performance.shown.everyone if self.performance.shown.others else ()
        return {
            s.line: one.project.lines[s.line]
            for one in talking
            for s in one.plan.track.speeches
            if s.line is not None and s.line in one.project.lines
        }

    def _want(self, lines: Mapping[str, Line]) -> None:
        files = {i: (x.audio, x.channel) for i, x in lines.items() if x.audio}
        if files == self._files:
            return
        self._files = files
        if not files:
            self.sounds = {}
            self._planned()
            return
        folder = self.document.folder or Path()

        def work(_: object) -> Any:
            from metagraph.speech.soundtrack import place_line_sounds

            return place_line_sounds(lines, folder)

        self.jobs.start(
            tr("Reading sounds"), work, self._read, lambda error: self.told.emit(tr_error(error)), quick=True
        )

    def _read(self, made: tuple[dict[str, np.ndarray], tuple[str, ...]]) -> None:
        self.sounds, notes = made
        for note in notes[:1]:
            self.told.emit(note)
        self._planned()

    # --- what sounds when

    def _planned(self) -> None:
        shown = self.performance.shown
        if not set(said := self._said()) <= set(self._files):
            self._want({**self.document.project.lines, **said})
        if (
            not self.sounds
            or shown.clip is not None
            or not any(one.plan.track.speeches for one in shown.everyone)
        ):
            self.parts = EMPTY
            return
        from metagraph.speech.soundtrack import place_lines

        self.parts = [part for one in shown.everyone for part in place_lines(one.plan, self.sounds)]
        self._moved()

    @property
    def audible(self) -> bool:
        """Return whether there is anything to hear now."""
        s = self.session
        return (
            bool(self.parts)
            and s.transport.playing
            and s.transport.speed == 1.0
            and s.transport.show == "plan"
            and not self.muted
        )

    def _moved(self, *_: object) -> None:
        """Follow the playhead: begin, continue, jump or fall silent with it."""
        if not self.audible:
            if self._stream is not None and self._stream.active:
                self._stream.stop()
            return
        if self._stream is None and not self._open():
            return
        at = round(
            (self.session.transport.seconds + self._stream.latency) * RATE
        )  # what is mixed now is heard that much later
        if not self._stream.active:
            self.place = at
            self._stream.start()
        elif abs(self.place - at) > DRIFT * RATE:
            self.place = at

    def _open(self) -> bool:
        if self._silent:
            return False
        try:
            import sounddevice

            self._stream = sounddevice.OutputStream(
                samplerate=RATE, channels=1, dtype="float32", callback=self.fill, latency=LATENCY
            )
        except (
            Exception
        ) as error:  # the library has errors of its own, and OSError where PortAudio is missing
            self._silent = True
            cause = tr_error(error).splitlines()[0].rstrip(".")
            missing = (
                isinstance(error, OSError) and "PortAudio" in cause
            )  # the library itself; an own kind of error otherwise
            self.told.emit(
                tr("No sound: {cause}. On Debian and Ubuntu: apt install libportaudio2", cause=cause)
                if missing
                else tr("No sound: {cause}. Check that a sound device is connected.", cause=cause)
            )
            return False
        return True

    def fill(self, out: np.ndarray, frames: int, time: object, status: object) -> None:
        """Write the next samples `[frames, 1]`; called on the sound library's thread."""
        from metagraph.speech.soundtrack import mix_track

        out[:, 0] = mix_track(self.parts, self.place, frames)
        self.place += frames

    def set_muted(self, muted: bool) -> None:
        self.muted = muted
        self._moved()

    def stop(self) -> None:
        """Stop all sound, because the window closes."""
        self.parts = EMPTY
        if self._stream is not None:
            self._stream.close()
            self._stream = None
