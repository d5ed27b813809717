"""A voice from a file that a session hears as it plays."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.graph.conversation.model import Segment
from metagraph.graph.model import Project
from metagraph.live.graph_motion import GraphMotion, LiveGraph
from metagraph.live.live_session import LiveSession
from metagraph.live.played_voice import CLIENT, PlayedVoice, read_played_voice
from tests.live.test_heard_voice import RATE, voice
from tests.synthesis.talking import talkers, talkers_graph
from tests.wavs import wav


@pytest.fixture
def session(sample: Project) -> LiveSession:
    return LiveSession(sample, idle=False, graphs={"takes": LiveGraph(talkers()[0], talkers_graph())})


def played(session: LiveSession, one: PlayedVoice, seconds: float) -> GraphMotion:
    for n in range(round(seconds * 60)):
        reply = one.play(session, n / 60)
        assert (reply is not None) == (n == 0) and (reply is None or reply.state == "planned")
        session.tick(n / 60)
    motion = session.generating.motion
    assert isinstance(motion, GraphMotion) and motion.client == CLIENT
    return motion


def test_it_is_heard_as_it_plays_and_not_before(session: LiveSession) -> None:
    one = PlayedVoice(voice(1.0, [0.5]), (), "takes")
    motion = played(session, one, 1.0)
    assert [n.what for _, n in motion.told] == ["begins"] and not one.over
    motion = played(session, PlayedVoice(voice(1.0, [0.5]), (), "takes"), 3.0)
    assert [n.what for _, n in motion.told][-1] == "ends"


def test_its_clauses_are_told_as_long_before_as_was_asked(session: LiveSession) -> None:
    segments = (Segment("clause", 1.0, 1.8, 1.3), Segment("response", 2.5, 2.51))
    motion = played(session, PlayedVoice(np.zeros(3 * RATE, "f4"), segments, "takes", 0.5), 3.0)
    told = [(frame, news) for frame, news in motion.told if news.what == "comes"]
    assert [frame / 30 for frame, _ in told] == pytest.approx([0.5, 2.0], abs=0.07)
    assert told[0][1].peak == pytest.approx(1.3) and told[1][1].kind == "response"


def test_files_are_read_at_any_rate_and_what_is_no_sound_is_said(tmp_path: Path) -> None:
    samples = np.clip(voice(1.0, [0.5])[::2] * 32768, -32768, 32767).astype("<i2")
    one = read_played_voice(wav(tmp_path / "a.wav", RATE // 2, samples.tobytes()), "takes", 1.0)
    assert abs(len(one.samples) - 2 * len(samples)) < 10 and [s.kind for s in one.segments] == ["clause"]
    assert not read_played_voice(tmp_path / "a.wav", "takes").segments
    (tmp_path / "b.wav").write_bytes(b"no sound")
    with pytest.raises(FileError):
        read_played_voice(tmp_path / "b.wav", "takes")
