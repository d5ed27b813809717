"""LSL in: markers that ask, and keypoints of a person who is mimicked."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.graph.model import Project
from metagraph.live.hub import Hub
from metagraph.live.live_session import LiveSession
from metagraph.live.lsl_in import LslInLine, describe_stream, find_use, parse_wish, read_marker
from metagraph.live.server import LiveError, Options, Server, check_live_options
from metagraph.live.wire import exchange
from tests.lab_streams import StreamInfo, require_lsl
from tests.live.test_vmc_person import COCO, on_hips, seen, stances


def test_streams_are_looked_for_by_name_type_or_source() -> None:
    assert parse_wish("Keyboard") == ("name", "Keyboard")
    assert parse_wish("type=Markers") == ("type", "Markers")
    assert parse_wish("source_id=a=b") == ("source_id", "a=b")
    assert parse_wish("my=stream") == ("name", "my=stream")
    for wrong in ("", "type=", "it's"):
        with pytest.raises(ValueError, match=r"type=Markers"):
            parse_wish(wrong)


def test_a_marker_is_a_request_or_names_an_action_or_a_stance(sample: Project) -> None:
    assert read_marker(' {"do": "nod"}', sample) == b'{"do": "nod"}'
    assert json.loads(read_marker("nod", sample) or b"") == {"do": "nod"}
    assert json.loads(read_marker("bow_01", sample) or b"") == {"do": "action", "action": "bow_01"}
    assert json.loads(read_marker("on hips", sample) or b"") == {"do": "stance", "stance": "on hips"}
    assert read_marker("S  1", sample) is None


def hear(project: Project, info: StreamInfo, samples: list[list[Any]]) -> tuple[LiveSession, list[str]]:
    """Pass samples of a stream to a session, one each other tick; return it and what is told to people."""
    told: list[str] = []
    hub, session, now = Hub(), LiveSession(project, idle=False), 0.0
    line = LslInLine(hub, lambda: now, find_use(describe_stream(info)), project, told.append)
    line.join()
    for sample in samples:
        line.hear(sample)
        for _ in range(2):
            hub.give(exchange(session, now, hub.take()))
            now += 1 / 60
    return session, told


def markers() -> StreamInfo:
    return StreamInfo("Keys", "Markers", 1, 0, "string", "keys")


def test_what_markers_ask_is_done(sample: Project) -> None:
    session, told = hear(sample, markers(), [["nod"], ['[{"do": "stance", "stance": "on hips"}]']])
    assert "on hips" in stances(session) and not told
    assert any(cue.action.name.startswith("nod") for cue in session.plan.layers["head"].cues)


def test_what_cannot_be_used_is_said_once_by_the_name_of_the_stream(sample: Project) -> None:
    bad = [["S  1"], [""], ["S  2"], ['{"do": "dance"}'], ['{"do": "dance"}'], ['[{"do": "dance"}]']]
    refused = [['{"do": "action", "action": "no such"}']] * 2
    _, told = hear(sample, markers(), bad + refused)
    assert len(told) == 3 and all(words.startswith("LSL stream 'Keys': ") for words in told)
    assert "'S  1' is no request and names no action or stance" in told[0]
    assert "dance" in told[1] and "refused" in told[2] and "no such" in told[2]


@pytest.mark.parametrize(
    ("info", "why"),
    [
        (StreamInfo("A", "Markers", 1, 0, "int32", "a"), "markers are numbers"),
        (StreamInfo("A", "Audio", 1, 16000, "float32", "a"), "sound is not read from LSL"),
        (StreamInfo("A", "Markers", 2, 0, "string", "a"), "2 texts"),
        (StreamInfo("A", "EEG", 32, 500, "float32", "a"), "32 channels are no keypoints"),
    ],
)
def test_a_stream_that_is_of_no_use_says_why(info: StreamInfo, why: str) -> None:
    with pytest.raises(ValueError, match=why):
        find_use(describe_stream(info))


def test_a_person_in_a_stream_of_17_points_is_mimicked(sample: Project) -> None:
    points = seen(sample, on_hips(sample))
    numbers = np.concatenate([points[name] for name in COCO]).tolist()
    session, told = hear(sample, StreamInfo("Pose", "MoCap", 51, 30, "float32", "p"), [numbers] * 60)
    assert "on hips" in stances(session) and not told


def test_what_is_missing_or_malformed_is_said_before_anything_opens(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "pylsl", None)
    with pytest.raises(LiveError, match=r"pylsl.*leave --lsl out"):
        check_live_options(Options(lsl=True))
    with pytest.raises(LiveError, match=r"leave --lsl-in out"):
        check_live_options(Options(lsl_in=("Keys",)))
    with pytest.raises(LiveError, match="without quotes"):
        check_live_options(Options(lsl_in=("it's",)))


class Room:
    """A session that listens to LSL, played in real time."""

    def __init__(self, project: Project, options: Options) -> None:
        self.project, self.options, self.told = project, options, list[str]()
        self.session = LiveSession(project, idle=False)
        self.slowest = 0.0

    def play(self, script: Callable[[], None]) -> None:
        """Play while a script runs in a thread of its own."""

        async def run() -> None:
            server = Server(self.options, time.monotonic, project=self.project, tell=self.told.append)
            await server.open()
            server.begin = begin = time.monotonic()

            def step(batch: Any) -> Any:
                return exchange(self.session, time.monotonic() - begin, batch)

            playing = asyncio.create_task(server.run(step))
            try:
                await asyncio.get_running_loop().run_in_executor(None, script)
            finally:
                server.stopped.set()
                await playing
                closing = time.monotonic()
                await server.close()
                self.slowest = time.monotonic() - closing

        asyncio.run(run())

    def stance(self) -> str:
        """Return the name of the stance that the arms are in."""
        lane = self.session.plan.layers["arms"]
        found = self.project.stance(lane.stance_at(self.session.now))
        return "" if found is None else found.name

    def wait(self, what: Callable[[], Any], seconds: float = 20.0) -> None:
        end = time.monotonic() + seconds
        while not what():
            assert time.monotonic() < end, self.told
            time.sleep(0.05)


def test_a_stream_of_markers_is_found_heard_lost_and_heard_again(sample: Project, tmp_path: Path) -> None:
    pylsl = require_lsl(tmp_path)
    name = f"Keys {time.time()}"
    room = Room(sample, Options(port=None, osc=None, lsl=True, lsl_in=(name, "type=MetagraphNone")))

    def press(text: str) -> None:
        outlet = pylsl.StreamOutlet(pylsl.StreamInfo(name, "Markers", 1, 0, "string", name))
        assert outlet.wait_for_consumers(20.0)
        outlet.push_sample([text])
        room.wait(lambda: room.stance() == text)

    def script() -> None:
        press("on hips")
        room.wait(lambda: any("ended" in words for words in room.told))
        press("arms crossed")
        room.wait(lambda: sum("ended" in words for words in room.told) == 2)

    room.play(script)
    assert f"'{name}' of " in room.told[0] and room.told[0].endswith(" is heard: markers.")
    assert "It is heard again when it comes back." in room.told[1]
    assert "is heard again: markers." in room.told[2]
    assert room.slowest < 5.0


def test_the_characters_own_events_are_not_heard_as_requests(sample: Project, tmp_path: Path) -> None:
    require_lsl(tmp_path)
    name = sample.name
    room = Room(
        sample, Options(port=None, osc=None, lsl=True, lsl_in=(f"source_id=metagraph-live-{name}-events",))
    )
    room.play(lambda: time.sleep(2.0))
    assert not room.told


def test_a_person_whom_another_character_shows_is_mimicked(sample: Project, tmp_path: Path) -> None:
    pylsl = require_lsl(tmp_path)
    name = f"Person {time.time()}"
    points = seen(sample, on_hips(sample))
    numbers = np.concatenate([points[each] for each in COCO]).astype(np.float32)
    room = Room(sample, Options(port=None, osc=None, lsl_in=(name,)))

    def script() -> None:
        outlet = pylsl.StreamOutlet(pylsl.StreamInfo(name, "MoCap", 51, 60, "float32", name))
        assert outlet.wait_for_consumers(20.0)
        end = time.monotonic() + 20
        while room.stance() != "on hips" and time.monotonic() < end:
            outlet.push_sample(numbers.tolist())
            time.sleep(1 / 60)

    room.play(script)
    assert room.stance() == "on hips"


def test_a_stream_of_no_use_is_named_with_the_reason(sample: Project, tmp_path: Path) -> None:
    pylsl = require_lsl(tmp_path)
    name = f"Brain {time.time()}"
    room = Room(sample, Options(port=None, osc=None, lsl_in=(name,)))
    outlet = pylsl.StreamOutlet(pylsl.StreamInfo(name, "EEG", 32, 500, "float32", name))
    room.play(lambda: room.wait(lambda: room.told))
    time.sleep(0.1)
    del outlet
    assert len(room.told) == 1
    assert room.told[0].startswith(f"LSL stream '{name}' is not used: its 32 channels are no keypoints")


def test_without_a_project_nothing_is_opened(tmp_path: Path) -> None:
    require_lsl(tmp_path)

    async def run() -> None:
        await Server(Options(port=None, osc=None, lsl=True), time.monotonic).open()

    with pytest.raises(LiveError, match="needs a project"):
        asyncio.run(run())
