"""LSL in: markers of the Lab Streaming Layer that ask for something, and keypoints of a person whom the
character mimics.

A thread looks for the streams, and one reads each of them, since pylsl waits; what they find is passed to the
session's loop, where each stream is a client.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from typing import Any

import msgspec
import numpy as np

from metagraph.common.lab_streaming import StreamChannel
from metagraph.graph.model import LAYERS, Project
from metagraph.live.hub import GOING, Hub
from metagraph.live.lsl_points import PointChannels, Upright, find_point_channels
from metagraph.live.messages import Hello, Keypoints, encode

PROPERTIES = ("name", "type", "source_id")
STREAMS = 16  # read at once
LOOKS = 0.5  # seconds between looks for streams that came or went
FORGETS = 2.0  # seconds for which LSL remembers a stream that is no longer there
OPENS = 5.0  # seconds at most until a stream is open
WAITS = 0.2  # seconds for which a thread waits for a sample, before it looks whether to end
KEEPS = 2  # seconds of samples that LSL keeps for us; of markers, so many hundreds
RATE = 30.0  # frames of keypoints a second that are looked at, at most
LARGEST = 1e7  # of a coordinate
STRINGS = 3  # LSL's number of the format of texts
WORDS = ("nod", "shake", "blink", "withdraw", "interrupt", "pause", "resume", "finish")


def parse_wish(text: str) -> tuple[str, str]:
    """Return the property and the value by which streams are looked for: `type=Markers`, or a name alone.
    Raises ValueError with what would be right.
    """
    head, equals, value = text.partition("=")
    kind = head if equals and head in PROPERTIES else "name"
    value = value if equals and head in PROPERTIES else text
    if not value or "'" in value or '"' in value:
        raise ValueError(
            f"--lsl-in: '{text}' is no stream; give a name without quotes, or {' or '.join(PROPERTIES[1:])} "
            "and its value, such as type=Markers"
        )
    return kind, value


def read_marker(text: str, project: Project) -> bytes | None:
    """Return the request that a marker makes: JSON as it is, a word such as `nod`, or the name of a stance or
    an action; None for any other text.
    """
    text = text.strip()
    if text[:1] in ("{", "["):
        return text.encode("utf-8", "replace")
    if text in WORDS:
        return encode({"do": text})
    graphs = [project.graphs[layer] for layer in LAYERS]
    if any(text in (x.id, x.name) for graph in graphs for x in graph.stances.values()):
        return encode({"do": "stance", "stance": text})
    if any(text in (x.id, x.name) for graph in graphs for x in graph.actions.values()):
        return encode({"do": "action", "action": text})
    return None


@dataclass(frozen=True)
class HeardStream:
    """A stream that was found. format: LSL's number of its samples' format. channels: as it describes them,
    none where it does not. reads: what its numbers are, None for markers.
    """

    name: str
    kind: str
    host: str
    count: int
    format: int
    channels: tuple[StreamChannel, ...]
    reads: PointChannels | None = None


def describe_stream(info: Any) -> HeardStream:
    """Return what a stream of pylsl says about itself."""
    channels: list[StreamChannel] = []
    place = info.desc().child("channels").child("channel")
    while not place.empty() and len(channels) <= info.channel_count():
        label, kind, unit, owner = (place.child_value(x) for x in ("label", "type", "unit", "object"))
        channels.append(StreamChannel(label, kind, unit, owner or place.child_value("marker")))
        place = place.next_sibling("channel")
    return HeardStream(
        info.name(),
        info.type(),
        info.hostname(),
        info.channel_count(),
        info.channel_format(),
        tuple(channels),
    )


def find_use(stream: HeardStream) -> HeardStream:
    """Return a stream with what its numbers are. Raises ValueError with why it cannot be used."""
    if stream.format == STRINGS:
        if stream.count != 1:
            raise ValueError(f"it has {stream.count} texts in a sample; a stream of markers has one")
        return stream
    if stream.kind.lower() == "audio":
        raise ValueError("sound is not read from LSL; send it with `hear`")
    if stream.kind.lower() == "markers":
        raise ValueError("its markers are numbers; send requests or names of actions as texts")
    return replace(stream, reads=find_point_channels(stream.channels, stream.count))


class LslInLine:
    """One stream as a client of a session: what its samples ask for. clock: seconds, of any beginning. tell:
    takes a sentence for people.
    """

    formats = ()

    def __init__(
        self,
        hub: Hub,
        clock: Callable[[], float],
        stream: HeardStream,
        project: Project,
        tell: Callable[[str], None],
    ) -> None:
        self.hub, self.clock, self.stream, self.project, self._tell = hub, clock, stream, project, tell
        self.number, self._upright = 0, Upright()
        self._told: set[str] = set()

    def join(self) -> None:
        """Become a client."""
        self.number = self.hub.open(self, self.clock(), proven=True)
        if self.number:
            self.hub.message(self.number, encode(Hello(name=f"LSL {self.stream.name}"[:200])))

    def hear(self, sample: Sequence[Any]) -> None:
        """Ask as a sample says."""
        if not self.number:
            return
        if self.stream.reads is None:
            self._hear_marker(str(sample[0]))
        else:
            self._hear_points(self.stream.reads, sample)

    def _hear_marker(self, text: str) -> None:
        asked = read_marker(text, self.project) if text.strip() else None
        if asked is not None:
            self.hub.message(self.number, asked)
        elif text.strip():
            self._tell_once("word", f"'{text.strip()[:60]}' is no request and names no action or stance")

    def _hear_points(self, reads: PointChannels, sample: Sequence[float]) -> None:
        points, sure = reads.read(sample)
        points = np.clip(self._upright.turn(points, sure), -LARGEST, LARGEST)
        asked = Keypoints(
            points=tuple(tuple(map(float, point)) for point in points), confidence=tuple(map(float, sure))
        )
        self.hub.message(self.number, encode(asked))

    def _tell_once(self, what: str, why: str) -> None:
        if what not in self._told:
            self._told.add(what)
            self._tell(f"LSL stream '{self.stream.name}': {why} (said once)")

    def send(self, messages: list[tuple[bytes, bool]]) -> None:
        """Say the first request that was not understood, and the first that was refused."""
        for data, binary in messages:
            told = None if binary or {"error", "refused"} <= self._told else msgspec.json.decode(data)
            for reply in told if isinstance(told, list) else [told] if told else []:
                if "error" in reply:
                    self._tell_once("error", reply["error"])
                elif reply.get("state") == "refused":
                    self._tell_once("refused", f"a request is refused: {reply.get('why', '')}")

    def answered(self, messages: int) -> None:
        """Nothing depends on it."""

    def backlog(self) -> int:
        """Nothing waits."""
        return 0

    def close(self, code: int, reason: str) -> None:
        """Hear nothing more."""
        self.number = 0
        if code != GOING:
            self._tell_once("close", f"it is no longer heard: {reason}")

    def leave(self) -> None:
        """Stop being a client, because the stream ended."""
        number, self.number = self.number, 0
        self.hub.gone(number)


class LslListener:
    """Finds and reads streams. lsl: the module pylsl. wishes: by which properties and values streams are
    looked for. own: LSL's ids of streams that are not heard, because they are the character's. call: passes a
    function to the session's loop.
    """

    def __init__(
        self,
        lsl: Any,
        wishes: Sequence[tuple[str, str]],
        own: Collection[str],
        call: Callable[..., object],
        open_line: Callable[[HeardStream], LslInLine],
        tell: Callable[[str], None],
    ) -> None:
        self._lsl, self._wishes, self._tell = lsl, wishes, tell
        self._call, self._open_line = call, open_line
        self._known = set(own)  # ids of streams that were looked at
        self._names: set[str] = set()  # of streams that were heard
        self._stop = threading.Event()
        self._readers: list[threading.Thread] = []
        self._finder = threading.Thread(target=self._find, daemon=True, name="LSL finder")

    def start(self) -> None:
        """Begin to look for streams."""
        self._finder.start()

    def finish(self, seconds: float = 2.0) -> None:
        """Stop, and wait for the threads, but not for longer than some seconds each."""
        self._stop.set()
        for thread in (self._finder, *self._readers):
            thread.join(seconds)

    def _pass(self, what: Callable[..., object], *values: Any) -> None:
        try:
            self._call(what, *values)
        except RuntimeError:
            self._stop.set()  # the loop has ended

    def _find(self) -> None:
        finders = [
            self._lsl.ContinuousResolver(prop=prop, value=value, forget_after=FORGETS)
            for prop, value in self._wishes
        ]
        while not self._stop.wait(LOOKS):
            self._readers = [reader for reader in self._readers if reader.is_alive()]
            for info in [info for finder in finders for info in finder.results()]:
                if info.uid() in self._known or len(self._readers) >= STREAMS:
                    continue
                self._known.add(info.uid())
                reader = threading.Thread(target=self._read, args=(info,), daemon=True, name="LSL reader")
                self._readers.append(reader)
                reader.start()

    def _read(self, info: Any) -> None:
        """Read one stream until it ends."""
        name = info.name()
        try:
            inlet = self._lsl.StreamInlet(info, max_buflen=KEEPS, recover=False)
            stream = find_use(describe_stream(inlet.info(timeout=OPENS)))
            inlet.open_stream(timeout=OPENS)
        except (ValueError, RuntimeError) as error:  # pylsl's errors are RuntimeErrors
            self._pass(self._tell, f"LSL stream '{name}' is not used: {error or 'it does not answer'}")
            return
        line = self._open_line(stream)
        self._pass(line.join)
        again = " again" if name in self._names else ""
        self._names.add(name)
        what = "markers" if stream.reads is None else "a person who is mimicked"
        self._pass(self._tell, f"LSL stream '{name}' of {stream.host} is heard{again}: {what}.")
        try:
            while not self._stop.is_set():
                self._read_some(inlet, stream, line)
        except RuntimeError:  # it is lost
            self._pass(line.leave)
            self._pass(self._tell, f"LSL stream '{name}' ended. It is heard again when it comes back.")

    def _read_some(self, inlet: Any, stream: HeardStream, line: LslInLine) -> None:
        sample, _ = inlet.pull_sample(timeout=WAITS)
        if sample is None:
            return
        if stream.reads is None:
            self._pass(line.hear, sample)
            return
        waiting, _ = inlet.pull_chunk(timeout=0.0)
        self._pass(line.hear, waiting[-1] if waiting else sample)
        self._stop.wait(1 / RATE)
