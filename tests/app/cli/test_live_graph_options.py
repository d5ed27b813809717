"""`metagraph live --takes`: a motion graph that moves the character, and a voice that it plays."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
from argparse import Namespace
from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.cli.live_graph_options import NAME, read_graphs
from app.cli.parser import main
from metagraph.formats.clips import read_clips
from metagraph.formats.conversations.writers import write_json
from metagraph.formats.gltf.writer import write_glb
from metagraph.graph.conversation.model import Conversation, Side
from metagraph.graph.model import Project
from metagraph.live.kept_motion import read_kept
from metagraph.motion.skeleton import Skeleton
from tests.live.test_heard_voice import RATE, voice
from tests.processes import started
from tests.synthesis.talking import talkers
from tests.wavs import wav

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two takes in a folder, and what was said in each beside it."""
    out = tmp_path_factory.mktemp("long")
    (out / "takes").mkdir()
    takes, said = talkers()
    for take, segments in zip(takes[:2], said[:2], strict=True):
        write_glb(out / "takes" / f"{take.name}.glb", [take])
        own = tuple(s for s in segments if s.kind != "hesitation")
        sides = (Side(name="Ann", segments=own), Side(name="Ben"))
        write_json(Conversation(name=take.name, length=20.0, sides=sides), out / f"{take.name}.json")
    return out


def words(folder: Path) -> list[str]:
    return ["--takes", str(folder / "takes"), "--speech", *map(str, sorted(folder.glob("*.json")))]


def options(folder: Path, **more: object) -> Namespace:
    speech = sorted(folder.glob("*.json"))
    return Namespace(takes=[folder / "takes"], speech=speech, side="1", retarget=False, **more)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (["--takes", "x"], "--takes needs --speech"),
        (["--voice", "x.wav"], "needs --takes"),
        (["--speech", "x.eaf"], "need --takes"),
        (["--takes", "x", "--speech", "x.eaf", "--announce", "1"], "--announce needs --voice"),
        (["--takes", "x", "--speech", "y", "--voice", "z", "--announce", "-1"], "0 to 60 seconds"),
        (["--takes", "/nowhere", "--speech", "y"], "no such file or folder"),
    ],
)
def test_options_that_do_not_go_together_are_said(
    given: list[str], told: str, few: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["live", str(few), *given]) == 1
    assert told in capsys.readouterr().err


@pytest.mark.nightly
def test_takes_of_another_skeleton_are_refused_or_brought_onto_the_characters(
    folder: Path, sample: Project, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert read_graphs(Namespace(takes=[]), sample) == {}  # no conversation of it has takes
    (tmp_path / "takes").mkdir()
    for path in sorted((folder / "takes").glob("*.glb")):
        take = read_clips(path)[0]
        s = take.skeleton
        tall = Skeleton(s.names, s.parents, s.rest_rotations, (1.2 * s.rest_translations).astype(np.float32))
        moved = np.asarray(1.2 * take.translations, np.float32)
        write_glb(tmp_path / "takes" / path.name, [replace(take, skeleton=tall, translations=moved)])
        shutil.copy(folder / f"{path.stem}.json", tmp_path)
    with pytest.raises(ValueError, match="--retarget"):
        read_graphs(options(tmp_path), sample)
    brought = options(tmp_path)
    brought.retarget = True
    graph = read_graphs(brought, sample)[NAME]
    assert graph.fits(sample) and "states and" in capsys.readouterr().err


@pytest.mark.nightly
@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGINT to send")
def test_a_file_is_moved_to_kept_and_made_again(few: Path, folder: Path, tmp_path: Path) -> None:
    project = tmp_path / "few.metagraph.yaml"
    shutil.copytree(few.parent, tmp_path, dirs_exist_ok=True)
    shutil.move(tmp_path / few.name, project)
    samples = np.clip(voice(1.5, [0.5, 1.0], 0.1) * 32768, -32768, 32767).astype("<i2")
    sound = wav(tmp_path / "voice.wav", RATE, samples.tobytes())
    command = [sys.executable, "-m", "app.cli", "live", str(project), *words(folder), "--keep", "talk"]
    more = ["--voice", str(sound), "--announce", "1", "--json", "--port", "0", "--no-osc"]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with started(*command, *more, cwd=ROOT, text=True, **pipes) as process:
        assert process.stdin is not None and process.stdout is not None
        assert json.loads(process.stdout.readline())["event"] == "ready"
        waits = True
        while waits:  # until it has moved for a while
            process.stdin.write('{"do": "status"}\n')
            process.stdin.flush()
            status = json.loads(process.stdout.readline())
            assert status["generating"]["model"] == NAME
            waits = status["t"] < 0.8
        process.send_signal(signal.SIGINT)
        told = process.communicate(timeout=60)[1]
    assert process.returncode == 0, told
    (kept,) = read_kept(tmp_path / "few - talk.motion.json")
    assert kept.frames > 10 and kept.told[0][1].what == "comes"
    out = tmp_path / "again.glb"
    again = ["--again", str(tmp_path / "few - talk.motion.json"), "-o", str(out)]
    takes = words(folder)[1:]
    assert main(["motion-graph", "synthesize", *takes, *again]) == 0
    assert read_clips(out)[0].frames == kept.frames
    assert msgspec.json.decode((tmp_path / "few - talk.motion.json").read_bytes())["version"] == 1
