"""The examples of agents in the manual, each beside a session: what an agent's pipeline or model would send
comes from here.
"""

from __future__ import annotations

import base64
import importlib
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.graph.model import Project
from metagraph.live.live_session import LiveSession
from metagraph.live.server import Server
from metagraph.live.wire import Ready
from tests.live.serving import play

CLIENTS = Path(__file__).resolve().parents[2] / "docs" / "clients"
RATE = 24_000
STEP = RATE // 5 * 2  # bytes of 0.2 s


@pytest.fixture
def clients(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Returns a module of the examples; they import each other as one who copied them would."""
    monkeypatch.syspath_prepend(str(CLIENTS))
    return importlib.import_module


def sound(seconds: float) -> bytes:
    """Return a voice-like hum in 16 bits, three swells a second."""
    n = np.arange(int(RATE * seconds))
    swell = 0.5 - 0.5 * np.cos(2 * np.pi * 3 * n / RATE)
    return (8000 * np.sin(2 * np.pi * 180 * n / RATE) * swell).astype("<i2").tobytes()


def tags_of(project: Project) -> dict[str, set[str]]:
    return {k: {t for x in g.actions.values() for t in x.tags} for k, g in project.graphs.items()}


class Told:
    """The events that a body heard, and when."""

    def __init__(self) -> None:
        self.events: list[tuple[float, Any]] = []

    def __call__(self, event: Any) -> None:
        self.events.append((time.monotonic(), event))

    def of(self, event: str, ident: str) -> list[tuple[float, Any]]:
        return [(at, x) for at, x in self.events if x.get("event") == event and x["id"] == ident]


async def until(found: Any, seconds: float = 10) -> None:
    import asyncio

    end = time.monotonic() + seconds
    while not found() and time.monotonic() < end:
        await asyncio.sleep(0.02)
    assert found()


def test_a_body_hears_replies_and_events_together(clients: Any, sample: Project) -> None:
    told = Told()

    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        body = clients("body")
        async with body.Body(ready.websocket, on_event=told) as one:
            reply = await one.ask(do="say", id="answer", text="It rains all day, so take a coat with you.")
            assert reply["state"] == "planned"
            await until(lambda: told.of("started", "answer"))
            with pytest.raises(ValueError, match="dance"):
                await one.ask(do="dance")
            assert any("error" in event for _, event in told.events), "also for whoever does not wait for it"
            cut = await one.ask(do="interrupt", what="answer")
            assert cut["state"] == "done" and cut["spoken"] in "It rains all day, so take a coat with you."
            await until(lambda: told.of("ended", "answer"))

    play(sample, work)
    assert [x["reason"] for _, x in told.of("ended", "answer")] == ["interrupted"]


def test_a_realtime_model_moves_a_body_and_is_told_what_nobody_heard(clients: Any, sample: Project) -> None:
    told = Told()

    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        body, realtime = clients("body"), clients("realtime_agent")
        voice = sound(4.0)
        async with body.Body(ready.websocket, on_event=told) as one:
            agent = realtime.RealtimeBody(one)

            async def take(kind: str, **fields: Any) -> Any:
                return await agent.take({"type": kind, "item_id": "item", **fields})

            for n in range(0, len(voice), STEP):
                delta = base64.b64encode(voice[n : n + STEP]).decode()
                assert await take("response.output_audio.delta", delta=delta) == []
            await take("response.output_audio_transcript.delta", delta=" It rains.")
            await take("response.output_audio.done")
            await until(lambda: told.of("started", "item") and told.of("started", "item/0"))
            stop, cut = await agent.take({"type": "input_audio_buffer.speech_started"})
            assert stop == {"type": "response.cancel"}
            assert cut["type"] == "conversation.item.truncate" and cut["item_id"] == "item"
            assert await agent.take({"type": "output_audio_buffer.cleared"}) == [], "it is cut off already"
            await until(lambda: told.of("ended", "item") and told.of("ended", "item/0"))
            speech = told.of("ended", "item")[0][1]
            assert cut["audio_end_ms"] / 1000 == pytest.approx(speech["until"] - speech["at"], abs=0.05)

    play(sample, work)
    for ident in ("item", "item/0"):
        assert [x["reason"] for _, x in told.of("ended", ident)] == ["interrupted"]


@dataclass
class TTSStartedFrame:
    """Named as pipecat's, as are those below."""


@dataclass
class TTSAudioRawFrame:
    audio: bytes
    sample_rate: int = RATE
    num_channels: int = 1


@dataclass
class TTSTextFrame:
    text: str


@dataclass
class TTSStoppedFrame:
    """The voice has made all of a text's sound."""


@dataclass
class InterruptionFrame:
    """The user speaks."""


@pytest.mark.parametrize("channels", [1, 2])
def test_a_pipeline_of_frames_moves_a_body(clients: Any, sample: Project, channels: int) -> None:
    told = Told()
    text = "Hello, it is a really big idea, but maybe we should think about it first."

    async def work(server: Server, ready: Ready, session: LiveSession) -> None:
        body, pipeline = clients("body"), clients("pipeline_agent")
        voice = np.repeat(np.frombuffer(sound(5.0), "<i2"), channels).tobytes()
        async with body.Body(ready.websocket, on_event=told) as one:
            agent = pipeline.PipelineBody(one, tags_of(sample))
            await agent.take(TTSStartedFrame())
            for n in range(0, len(voice), STEP * channels):
                await agent.take(TTSAudioRawFrame(voice[n : n + STEP * channels], RATE, channels))
            await agent.take(TTSTextFrame(text))
            assert agent.told == pytest.approx(5.0), "the text is as long as its sound"
            await agent.take(TTSStoppedFrame())
            gestures = [f"said1/{n}" for n in range(6)]
            await until(lambda: any(told.of("started", ident) for ident in gestures))
            await agent.take(InterruptionFrame())
            await until(lambda: told.of("ended", "said1"))
            assert agent.said != "said1", "what follows is another utterance"

    play(sample, work)
    ends = [event for _, event in told.events if event.get("event") == "ended"]
    assert len({event["id"] for event in ends}) == len(ends), "one end each"
    assert told.of("ended", "said1")[0][1]["reason"] == "interrupted"
    assert not [event for _, event in told.events if "error" in event]
