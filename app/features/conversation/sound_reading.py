"""The sounds of the conversation on stage, read on a thread: waveform and pitch of each side, or why there
are none.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, Qt, Signal

from app.features.conversation.segment_hits import find_pitch_maxima
from app.project.document import Document
from app.project.jobs import Jobs, WindowJob
from app.stage.session import StageSession
from app.translation import tr, tr_noop
from app.widgets.waveforms import Envelope, measure_bins
from metagraph.errors import FileError
from metagraph.graph.conversation.model import Conversation

LONGEST = 36000.0  # seconds of a conversation
KEPT = 16000  # samples a second that waveform and pitch need
BLOCK = 60  # seconds of the waveform at a time
HOPS = 100.0  # pitches a second
ANEW = tr_noop("To choose another sound, open the menu “…” above and choose Sounds and names.")
Key = tuple[str, int | None]  # a sound's path, and the channel


@dataclass
class SideSound:
    """One side's sound, filled on the window's thread while another reads it. told: how far it is, in words;
    "" when all is there. missing: why there is none. loudest: of its samples, 0..1. maxima: seconds at which
    the pitch is highest. length: seconds.
    """

    wave: Envelope | None = None
    pitch: Envelope | None = None
    told: str = field(default_factory=lambda: tr("Reading the sound…"))
    part: float = 0.0
    missing: str = ""
    loudest: float = 0.0
    maxima: Any = ()
    length: float = 0.0


class Sounds(QObject):
    """changed: a sound has come, has come further, or is known to be missing."""

    changed = Signal()
    _read = Signal(object)  # from the thread that reads: what to do here with what it has

    def __init__(
        self, document: Document, session: StageSession, jobs: Jobs, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.jobs = document, session, jobs
        self.heard: dict[Key, SideSound] = {}
        self._job: WindowJob | None = None
        self._read.connect(_do, Qt.ConnectionType.QueuedConnection)
        document.changed.connect(
            lambda before, after: self._follow() if before.conversations is not after.conversations else None
        )
        document.loaded.connect(self.forget)
        session.onstage.conversation_changed.connect(self._staged)
        self._follow()  # the conversation may be on stage before its panel is opened

    def of(self, conversation: Conversation, side: int) -> SideSound | None:
        """Return a side's sound as far as it is read; None if the side has none."""
        key = self._key(conversation, side)
        return self.heard.get(key) if key is not None else None

    def forget(self) -> None:
        """Read everything again when it is wanted next: files may be there now that were missing."""
        if self._job is not None:
            self._job.cancel()
        self._job = None
        self.heard = {}
        self._follow()

    def _staged(self) -> None:
        """Another conversation is on stage; what was missing may be there by now."""
        self.heard = {k: h for k, h in self.heard.items() if not h.missing}
        self._follow()

    def _left(self) -> bool:
        """Whether something was to be read that nobody reads."""
        return self._job is None and any(h.told for h in self.heard.values())

    def _key(self, conversation: Conversation, side: int) -> Key | None:
        of = conversation.sides[side]
        return (
            None
            if of.audio is None
            else (os.path.normpath((self.document.folder or Path()) / of.audio), of.channel)
        )

    def _follow(self) -> None:
        """Read what the conversation on stage needs and is not there yet; what others needed is forgotten."""
        on = self.document.project.conversations.get(self.session.onstage.conversation or "")
        keys = dict.fromkeys(
            k
            for side in range(len(on.sides) if on is not None else 0)
            if on is not None and (k := self._key(on, side)) is not None
        )
        if set(keys) == set(self.heard) and not self._left():
            return
        if self._job is not None:
            self._job.cancel()
            self._job = None
        # What a job before has only begun is begun again: its thread may still be at it.
        self.heard = {
            k: h if (h := self.heard.get(k)) is not None and not h.told else SideSound() for k in keys
        }
        wanted = {k: h for k, h in self.heard.items() if h.told}
        if wanted:
            work = _Work(wanted, self._read.emit)
            self._job = self.jobs.start(tr("Reading the conversation"), work)
            for signal in (self._job.progress, self._job.ended):
                signal.connect(self._came)
        self.changed.emit()

    def _came(self, *_: object) -> None:
        for heard in self.heard.values():
            if (
                heard.told
                and self._job is not None
                and self._job.cancelled
                and self._job not in self.jobs.running
            ):
                heard.told, heard.missing = (
                    "",
                    tr("Reading was cancelled. To read the sound, choose the conversation again."),
                )
        self.changed.emit()


class _Work:
    """Reads sounds: each file once, then what is seen of its channels, then their pitch, which takes
    longest.
    """

    def __init__(self, wanted: dict[Key, SideSound], hand_over: Callable[[Callable[[], None]], None]) -> None:
        self.wanted, self.hand_over = wanted, hand_over

    def set(self, heard: SideSound, **values: Any) -> None:
        """Set fields of what is painted, on the window's thread."""
        self.hand_over(partial(_set, heard, values))

    def __call__(self, job: WindowJob) -> None:
        samples: dict[Key, tuple[Any, int]] = {}
        steps, done = 3 * len(self.wanted), 0
        for path in dict.fromkeys(path for path, _ in self.wanted):
            job.tell(done, steps, Path(path).name)
            mine = {k: h for k, h in self.wanted.items() if k[0] == path}
            done += len(mine)
            try:
                samples |= self._read(path, mine)
            except FileError as error:
                for heard in mine.values():
                    self.set(heard, told="", missing=f"{error} {tr(ANEW)}")
            if job.cancelled:
                return
        for key, (sound, rate) in samples.items():
            self._draw(job, self.wanted[key], sound, rate, (done, steps))
            done += 1
        for key, (sound, rate) in samples.items():
            if job.cancelled:
                return
            job.tell(done, steps, tr("pitch"))
            self._sing(self.wanted[key], sound, rate)
            done += 1
        job.tell(steps, steps)

    def _read(self, path: str, wanted: dict[Key, SideSound]) -> dict[Key, tuple[Any, int]]:
        """Return the samples `[N]` of each wanted channel, and how many a second. Raises FileError."""
        from metagraph.speech.sound import read_recording

        read = read_recording(path, LONGEST, KEPT)
        out: dict[Key, tuple[Any, int]] = {}
        for key, heard in wanted.items():
            channel = key[1]
            if channel is not None and channel >= len(read.samples):
                self.set(
                    heard,
                    told="",
                    missing=tr(
                        "{name} has no channel {number}. {anew}",
                        name=Path(path).name,
                        number=channel + 1,
                        anew=tr(ANEW),
                    ),
                )
                continue
            out[key] = (read.samples.mean(0) if channel is None else read.samples[channel], read.rate)
            self.set(heard, length=read.duration)
        return out

    def _draw(
        self, job: WindowJob, heard: SideSound, samples: Any, rate: int, progress: tuple[int, int]
    ) -> None:
        """Fill the waveform, a minute at a time."""
        wave, loudest = Envelope(len(samples) / rate), 0.0
        self.set(heard, wave=wave)
        each, step = rate / wave.rate, round(BLOCK * wave.rate)
        for first in range(0, len(wave.lows[0]), step):
            begin = round(first * each)
            if begin >= len(samples) or job.cancelled:
                break
            piece = samples[begin : round((first + step) * each)]
            self.hand_over(partial(wave.put, first, *measure_bins(piece, each)))
            loudest = max(loudest, float(abs(piece).max()))
            self.set(heard, loudest=loudest, part=0.5 * begin / len(samples))
            job.tell(*progress, tr("waveform"))
        self.set(heard, part=0.5, told=tr("Finding the pitch…"))

    def _sing(self, heard: SideSound, samples: Any, rate: int) -> None:
        """Find the pitch."""
        from metagraph.speech.pitch import measure_pitch

        found = measure_pitch(samples, rate)
        curve = Envelope(len(samples) / rate, HOPS)
        curve.fill(0, found.hertz)
        self.set(heard, maxima=find_pitch_maxima(found.times, found.hertz), pitch=curve, part=1.0, told="")


def _set(heard: SideSound, values: dict[str, Any]) -> None:
    for name, value in values.items():
        setattr(heard, name, value)


def _do(what: Callable[[], None]) -> None:
    what()
