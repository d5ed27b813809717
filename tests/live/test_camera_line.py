"""A camera of this computer: the character mimics the person before it."""

from __future__ import annotations

import asyncio
import time
from pathlib import Path

import pytest

from metagraph.formats.filmed.camera import CameraError
from metagraph.formats.filmed.estimator import EstimatorMissingError
from metagraph.graph.model import Project
from metagraph.live.camera_line import read_message
from metagraph.live.live_session import LiveSession
from metagraph.live.server import Options, Server
from metagraph.live.wire import exchange
from tests.films import install_stand_in, make_film, remove_stand_in


def play(project: Project, device: str, seconds: float) -> tuple[LiveSession, Server]:
    """Return the session after so many seconds, of real time, of a person before a camera."""
    session = LiveSession(project, idle=False)

    async def run() -> Server:
        begin = time.monotonic()
        server = Server(
            Options(port=None, osc=None, camera=device, mirror=False), lambda: time.monotonic() - begin
        )
        await server.open()
        while time.monotonic() < begin + seconds:
            server.hub.give(exchange(session, server.clock(), server.hub.take()))
            await asyncio.sleep(1 / 30)
        await server.close()
        return server

    return session, asyncio.run(run())


def test_the_character_takes_the_stance_of_the_person_before_the_camera(
    sample: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The stand-in sees the sample's person of 7.5 s on, with hands on the hips.
    (install_stand_in(tmp_path, monkeypatch) / "from").write_text("7.5")
    film = make_film(tmp_path / "a.mp4", [n / 20 for n in range(80)])
    session, server = play(sample, str(film), 4.5)
    assert server.camera is not None and server.camera.pictures > 20
    found = [session.project.stance(request.stance or "") for request in session.plan.requests]
    assert "on hips" in {stance.name for stance in found if stance is not None}


def test_a_camera_that_is_not_there_or_mediapipe_that_is_missing_ends_it_with_a_remedy(
    sample: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    install_stand_in(tmp_path, monkeypatch)
    with pytest.raises(CameraError, match="plugged in"):
        play(sample, "/dev/video98", 1.0)
    remove_stand_in(tmp_path, monkeypatch)
    with pytest.raises(EstimatorMissingError, match="extras add camera"):
        play(sample, "0", 1.0)


def test_nobody_before_the_camera_asks_for_nothing() -> None:
    assert read_message({"time": 1.0}, True) is None
    marks = [[float(n), 2.0, 3.0, 0.5] for n in range(33)]
    message = read_message({"time": 1.0, "landmarks": marks, "worldLandmarks": marks}, True)
    assert message is not None and message.points[1] == (1.0, 2.0) and message.confidence == (0.5,) * 33
