"""`metagraph generate` from the command line: takes and speech in, models, motion and tables out; what is wrong
in words.
"""

from __future__ import annotations

import importlib.util
import json
import signal
import zipfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
import soundfile

from app.cli import generate_training
from app.cli.parser import main
from metagraph.common.extras import describe_missing_extra
from metagraph.formats.clips import read_clips
from metagraph.formats.gltf.writer import write_glb
from metagraph.formats.store import open_project, save_project
from metagraph.generation import train_process
from metagraph.generation.chunks import GUIDANCE
from metagraph.generation.features import RATE
from metagraph.generation.stored import read_model, write_model
from metagraph.generation.take_files import find_takes, read_take_batch
from metagraph.generation.train_plan import make_take_card
from metagraph.graph.conversation.model import Conversation
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton
from metagraph.research.generation.planted import perform_planted as perform
from tests.generation.makers import babble, moving, stance, tiny, untrained

SAMPLES = Path(__file__).resolve().parents[3] / "sample_clips"
WHOLE = SAMPLES / "conversation" / "talk.ogg"
SHIPPED = SAMPLES / "models" / "own.mgmodel"
TORCH = importlib.util.find_spec("torch") is not None


def run(capsys: pytest.CaptureFixture[str], *words: object, code: int = 0) -> str:
    found = main(["generate", *map(str, words)])
    told = capsys.readouterr()
    assert found == code, told.err
    assert "Traceback" not in told.err
    return told.out if code != 1 else told.err


@pytest.fixture(scope="module", autouse=True)
def performed_once() -> Iterator[None]:
    """The same conversation, performed by the same side, is baked once in this file."""
    known: dict[tuple[bytes, int, str], Clip] = {}

    def performed(project: Project, conversation: Conversation, side: int) -> Clip:
        assert project.skeleton is not None
        key = (msgspec.json.encode(conversation), side, project.skeleton.fingerprint)
        if key not in known:
            known[key] = perform(project, conversation, side)
        return known[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("metagraph.research.generation.planted.perform_planted", performed)
        yield


@pytest.fixture(scope="module")
def takes(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("planted")
    assert main(["generate", "planted", "-o", str(out), "--count", "2", "-s", "20", "--json"]) == 0
    return out


@pytest.fixture(scope="module")
def model(takes: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One that has learned nothing, but says it was made of the first conversation."""
    found = untrained("matching")
    first, second = (read_take_batch(find_takes([takes])[0]).takes[n : n + 2] for n in (0, 2))
    card = msgspec.structs.replace(
        found.card,
        takes=tuple(map(make_take_card, first)),
        held_out=tuple(map(make_take_card, second)),
        loss="matching",
    )
    out = tmp_path_factory.mktemp("models") / "plain.mgmodel"
    write_model(replace(found, card=card), out)
    return out


@pytest.fixture(scope="module")
def talk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The first eight seconds of the sample's conversation."""
    samples, rate = soundfile.read(str(WHOLE), stop=8 * soundfile.info(str(WHOLE)).samplerate)
    out = tmp_path_factory.mktemp("talk") / "talk.wav"
    soundfile.write(str(out), samples, rate)
    return out


# --- planted, info


def test_help_tells_the_guidance_in_use(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["generate", "evaluate", "--help"])
    assert f"default: {GUIDANCE:g})" in " ".join(capsys.readouterr().out.split())


@pytest.mark.nightly
def test_planted_takes_are_made_once(takes: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = run(capsys, "planted", "-o", takes, "--count", 2, "-s", 20)
    assert "2 conversations, 4 takes" in text and "(0 new, 2 made earlier)" in text
    assert "planted otherwise" in run(capsys, "planted", "-o", takes, "--seed", 9, code=1)
    assert "0 or more" in run(capsys, "planted", "-o", takes, "--moves", -1, code=1)


@pytest.mark.nightly
def test_a_model_is_told_of_in_words(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = run(capsys, "info", model)
    assert "plain.mgmodel: matching, " in text and "13 joints of 61" in text
    assert "learned from 2 takes" in text and "held out 2 takes" in text
    assert "licence: LICENSE.txt: MIT" in text
    data = json.loads(run(capsys, "info", model, "--json"))
    assert data["kind"] == "matching" and data["parameters"] > 1000 and len(data["takes"]) == 2


def _flipped(path: Path) -> None:
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 0xFF
    path.write_bytes(data)


def _cut(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:-2000])


def _told(path: Path, **changes: object) -> None:
    with zipfile.ZipFile(path) as old:
        members = {n: old.read(n) for n in old.namelist()}
    told = json.loads(members["model.json"])
    for name, value in changes.items():
        told[name] = value
    members["model.json"] = json.dumps(told).encode()
    with zipfile.ZipFile(path, "w") as new:
        for name, content in members.items():
            new.writestr(name, content)


def _future(path: Path) -> None:
    _told(path, format=99)


def _huge(path: Path) -> None:
    with zipfile.ZipFile(path) as old:
        sizes = json.loads(old.read("model.json"))["sizes"]
    _told(path, sizes={**sizes, "hidden": 8192, "ratio": 16})


def _pickled(path: Path) -> None:
    with zipfile.ZipFile(path) as old:
        members = {n: old.read(n) for n in old.namelist()}
    weight = next(n for n in members if n.endswith(".npy"))
    array = Path(path.parent / "object.npy")
    np.save(array, np.array([{"a": 1}], object), allow_pickle=True)
    members[weight] = array.read_bytes()
    with zipfile.ZipFile(path, "w") as new:
        for name, content in members.items():
            new.writestr(name, content)


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (_flipped, "plain.mgmodel"),
        (_cut, "plain.mgmodel"),
        (_future, "format 99"),
        (_huge, "MiB"),
        (_pickled, "plain.mgmodel"),
    ],
)
@pytest.mark.parametrize("action", ["info", "sample"])
def test_a_damaged_model_is_refused_in_words(
    damage,
    words: str,
    action: str,
    model: Path,
    talk: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    bad = tmp_path / model.name
    bad.write_bytes(model.read_bytes())
    damage(bad)
    more = ["--speech", talk, "-o", tmp_path / "out.bvh"] if action == "sample" else []
    assert words in run(capsys, action, bad, *more, code=1)
    assert not (tmp_path / "out.bvh").exists()


def test_a_model_that_is_not_there_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "No such file" in run(capsys, "info", tmp_path / "none.mgmodel", code=1)


# --- sample, cut


def test_what_is_written_is_alive_unless_it_is_to_be_bare(
    talk: Path, toy: Any, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    moved = {}
    for how in ([], ["--bare"]):
        out = tmp_path / f"{len(how)}.glb"
        run(capsys, "sample", SHIPPED, "--speech", talk, "-o", out, *how)
        clip = read_clips(out)[0]
        turned = np.ptp(clip.rotations, axis=0).max(1) > 1e-4
        moved[bool(how)] = {clip.skeleton.names[j] for j in np.flatnonzero(turned)}
        assert bool(clip.morphs) != bool(how)
        assert (np.ptp(clip.translations[:, 0], axis=0).max() > 1e-3) != bool(how)  # the hips
    assert {"LeftUpperLeg", "RightThumb1", "LeftEye"} <= moved[False] - moved[True]
    save_project(toy.project(), tmp_path / "toy.metagraph.yaml")
    words = [
        "--speech",
        str(talk),
        "-o",
        str(tmp_path / "b.bvh"),
        "--project",
        str(tmp_path / "toy.metagraph.yaml"),
    ]
    assert main(["generate", "sample", str(SHIPPED), *words]) == 0
    assert "the motion is bare" in capsys.readouterr().err  # the project's skeleton is another


def test_a_person_alone_counts_as_speaking(
    talk: Path, model: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    samples, rate = soundfile.read(str(talk))
    soundfile.write(str(tmp_path / "alone.wav"), samples.mean(1), rate)
    words = ("--speech", tmp_path / "alone.wav", "-o", tmp_path / "o.bvh", "--json")
    shares = json.loads(run(capsys, "sample", model, *words))["activity"]
    assert shares["speaking"] > 0.4 and shares["listening"] == shares["both"] == 0


@pytest.mark.nightly
def test_motion_is_sampled_and_the_same_seed_gives_the_same(
    model: Path, talk: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, seed in (("a.bvh", 3), ("b.bvh", 3), ("c.bvh", 4)):
        run(capsys, "sample", model, "--speech", talk, "--seed", seed, "-o", tmp_path / name)
    a, b, c = ((tmp_path / n).read_bytes() for n in ("a.bvh", "b.bvh", "c.bvh"))
    assert a == b != c
    data = json.loads(
        run(capsys, "sample", model, "--speech", talk, "--side", 2, "-o", tmp_path / "d.glb", "--json")
    )
    clip = read_clips(tmp_path / "d.glb")[0]
    assert clip.frames == data["frames"] and data["activity"]["speaking"] > 0.2


@pytest.mark.nightly
def test_a_role_can_be_set_by_hand(
    model: Path, talk: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shares = {}
    for role in ("speaking", "listening"):
        words = ("--activity", role, "-o", tmp_path / f"{role}.bvh", "--json")
        shares[role] = json.loads(run(capsys, "sample", model, "--speech", talk, *words))["activity"]
    assert shares["speaking"]["listening"] == shares["listening"]["speaking"] == 0
    assert shares["speaking"]["speaking"] == shares["listening"]["listening"] > 0.5
    assert (tmp_path / "speaking.bvh").read_bytes() != (tmp_path / "listening.bvh").read_bytes()


@pytest.mark.nightly
def test_sampling_goes_on_from_a_clip_of_the_same_skeleton(
    model: Path, talk: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_glb(tmp_path / "stance.glb", [stance()])
    words = ("sample", model, "--speech", talk, "-o", tmp_path / "out.bvh")
    run(capsys, *words, "--from", tmp_path / "stance.glb")
    other = stance()
    narrow = Skeleton(
        tuple(f"x{n}" for n in other.skeleton.names),
        other.skeleton.parents,
        other.skeleton.rest_rotations,
        other.skeleton.rest_translations,
    )
    write_glb(tmp_path / "other.glb", [replace(other, skeleton=narrow)])
    assert "another skeleton" in run(capsys, *words, "--from", tmp_path / "other.glb", code=1)


def sound(path: Path, samples: np.ndarray, subtype: str = "PCM_16") -> Path:
    soundfile.write(str(path), samples.T, RATE, subtype=subtype)
    return path


@pytest.mark.nightly
def test_sounds_that_nobody_can_move_to_are_refused_in_words(
    model: Path, talk: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = ("-o", tmp_path / "out.bvh")
    voice = np.stack([babble(3.0, 1), babble(3.0, 2)])
    bad = {
        "is silent": sound(tmp_path / "silent.wav", 0 * voice),
        "lasts 0.50 s": sound(tmp_path / "short.wav", voice[:, : RATE // 2]),
        "3 channels": sound(tmp_path / "three.wav", np.stack([voice[0]] * 3)),
        "sound file does not exist": tmp_path / "none.wav",
        "is not a sound file": model,
    }
    for words, path in bad.items():
        assert words in run(capsys, "sample", model, "--speech", path, *out, code=1), words
    assert "temperature" in run(capsys, "sample", model, "--speech", talk, "--temperature", 9, *out, code=1)
    assert "written as" in run(capsys, "sample", model, "--speech", talk, "-o", tmp_path / "x.mp4", code=1)
    assert not (tmp_path / "out.bvh").exists()


def _sampled(model: Path, speech: Path) -> Path:
    out = speech.with_suffix(".bvh")
    assert main(["generate", "sample", str(model), "--speech", str(speech), "-o", str(out)]) == 0
    return out


@pytest.mark.nightly
def test_what_is_odd_about_a_sound_is_told_and_it_is_used(
    model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    alone = sound(tmp_path / "alone.wav", babble(3.0)[None])
    loud = sound(tmp_path / "loud.wav", np.clip(20 * np.stack([babble(3.0), babble(3.0, 2)]), -1, 1))
    holed = np.stack([babble(3.0), babble(3.0, 2)])
    holed[0, 100] = np.nan  # read as silence, as everywhere
    assert np.isfinite(
        read_clips(_sampled(model, sound(tmp_path / "h.wav", holed, "FLOAT")))[0].rotations
    ).all()
    for path, words in ((alone, "only the speaker's voice"), (loud, "of the sound clips")):
        assert (
            main(["generate", "sample", str(model), "--speech", str(path), "-o", str(tmp_path / "o.bvh")])
            == 0
        )
        assert words in capsys.readouterr().err


@pytest.mark.nightly
def test_two_files_are_a_side_each(model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    one, two = (sound(tmp_path / f"{n}.wav", babble(4.0, n)[None]) for n in (1, 2))
    both = sound(tmp_path / "both.wav", np.stack([babble(4.0, 1), babble(4.0, 2)]))
    for side in (1, 2):
        run(capsys, "sample", model, "--speech", one, two, "--side", side, "-o", tmp_path / "a.bvh")
        run(capsys, "sample", model, "--speech", both, "--side", side, "-o", tmp_path / "b.bvh")
        assert (tmp_path / "a.bvh").read_bytes() == (tmp_path / "b.bvh").read_bytes()


@pytest.mark.nightly
def test_pieces_are_cut_and_know_model_and_seed(
    model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from metagraph.synthesis import cut

    monkeypatch.setattr(cut, "find_candidates", lambda clip, *_: ((1.0, 3.0, 0.9), (3.0, 5.0, 0.5)))
    save_project(Project("mine"), tmp_path / "mine.metagraph.yaml")
    words = ("--minutes", 0.5, "--seed", 7, "-o", tmp_path / "clips")
    project = ("--project", tmp_path / "mine.metagraph.yaml")
    data = json.loads(run(capsys, "cut", model, *words, *project, "--json"))
    assert [p["seed"] for p in data["pieces"]] == [7, 7] and data["added"] == 2
    entries = json.loads((tmp_path / "clips" / "pieces.json").read_text())
    assert {e["model"] for e in entries} == {"plain.mgmodel"} and entries == data["pieces"]
    found = read_clips(tmp_path / "clips" / entries[0]["file"])[0]
    assert found.duration == pytest.approx(2.0, abs=0.05)
    names = [e.name for e in open_project(tmp_path / "mine.metagraph.yaml").project.clips.values()]
    assert all("plain_seed7" in n for n in names) and len(names) == 2


def test_motion_that_never_rests_gives_no_pieces_and_says_so(
    model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = run(
        capsys, "cut", model, "--minutes", 0.2, "-o", tmp_path / "clips", "--least", 9, "--most", 9.5, code=3
    )
    assert "0 pieces" in text and "it never rests" in text and "Ask for more minutes" in text
    assert "--minutes" in run(capsys, "cut", model, "--minutes", 0, "-o", tmp_path / "c", code=1)


# --- evaluate


@pytest.mark.nightly
def test_models_are_judged_on_what_was_held_out(
    model: Path, takes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ("evaluate", model, takes, "--seeds", 2, "--draws", 3, "-o", tmp_path / "report")
    text = run(capsys, *words)
    assert "2 takes, 0.67 min, 2 seeds" in text
    for name in ("true", "floor", "mismatched", "mean pose", "plain", "perfect"):
        assert f"\n{name}" in text
    assert "too short to judge a model well" in text
    data = json.loads((tmp_path / "report" / "report.json").read_text())
    rows = {r["name"]: r["values"] for r in data["rows"]}
    assert rows["true"]["speed"] == pytest.approx(1) and rows["mean pose"]["profile"] is None
    page = (tmp_path / "report" / "report.html").read_text()
    assert page.count("<svg") == 2 + 1 + 1 + 2 and "http" not in page.replace(
        "http://www.w3.org/2000/svg", ""
    )
    assert "true,speed,1,1,1" in (tmp_path / "report" / "report.csv").read_text()


@pytest.mark.nightly
def test_a_floor_of_ones_own_stands_beside(
    model: Path, takes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run(capsys, "planted", "-o", tmp_path / "other", "--count", 2, "-s", 20, "--moves", 5)
    words = ("evaluate", model, takes, "--seeds", 1, "--draws", 2, "--json")
    own = json.loads(run(capsys, *words, "--floor", tmp_path / "other"))
    planted = json.loads(run(capsys, *words))
    floors = [next(r for r in d["rows"] if r["name"] == "floor")["values"] for d in (own, planted)]
    assert floors[0] != floors[1] and all(f["distance"] > 0 for f in floors)
    (tmp_path / "empty").mkdir()
    assert "no other motion" in run(capsys, *words[:-1], "--floor", tmp_path / "empty", code=1)


@pytest.mark.nightly
def test_a_model_is_not_judged_on_what_it_has_learned(
    model: Path, takes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for path in takes.glob("planted-001*"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    assert "says nothing" in run(capsys, "evaluate", model, tmp_path, code=1)


def test_what_cannot_be_judged_is_told(model: Path, takes: Path, tmp_path: Path, capsys) -> None:
    assert "takes are missing" in run(capsys, "evaluate", model, code=1)
    assert "is missing" in run(capsys, "evaluate", takes, code=1)
    assert "no such file" in run(capsys, "evaluate", model, tmp_path / "none", code=1)
    assert "--seeds" in run(capsys, "evaluate", model, takes, "--seeds", 0, code=1)
    (tmp_path / "plain.mgmodel").write_bytes(model.read_bytes())
    assert "rename one" in run(capsys, "evaluate", model, tmp_path / "plain.mgmodel", takes, code=1)


# --- takes that are no good


def _take(folder: Path, name: str, clip: Clip, samples: np.ndarray) -> None:
    write_glb(folder / f"{name}.glb", [clip])
    sound(folder / f"{name}.wav", samples)


@pytest.mark.nightly
def test_each_bad_take_fails_alone_and_in_words(
    model: Path, takes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for path in takes.glob("planted-002*"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    voice = np.stack([babble(6.0, 1), babble(6.0, 2)])
    _take(tmp_path, "short", moving(2.0), voice)
    _take(tmp_path, "silent", moving(6.0, 2), 0 * voice)
    _take(tmp_path, "clipped", moving(6.0, 3), np.clip(40 * voice, -1, 1))
    _take(tmp_path, "still", replace(moving(6.0), rotations=moving(6.0).rotations[:1].repeat(181, 0)), voice)
    other = stance().skeleton
    renamed = Skeleton(
        tuple(f"x_{n}" for n in other.names), other.parents, other.rest_rotations, other.rest_translations
    )
    _take(
        tmp_path,
        "other",
        replace(moving(6.0, 4), skeleton=renamed),
        voice,
    )
    write_glb(tmp_path / "mute.glb", [moving(6.0, 5)])
    _take(tmp_path, "alone", moving(6.0, 6), voice[:1])
    assert main(["generate", "evaluate", str(model), str(tmp_path), "--seeds", "1", "--draws", "1"]) == 0
    told = capsys.readouterr()
    for words in (
        "'short': its motion lasts",
        "'silent': its sound is silent",
        "'clipped'",
        "'still' does not move above the hips",
        "another skeleton",
        "mute.glb: there is no sound beside it",
    ):
        assert words in told.err, words
    assert "'alone'" in told.err
    assert "one half of the takes with the other" in told.out
    assert "\n3 takes, " in f"\n{told.out}"


def test_takes_none_of_which_can_be_used_are_an_error(
    tmp_path: Path, model: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert "has no takes" in run(capsys, "evaluate", model, tmp_path, code=1)
    _take(tmp_path, "short", moving(2.0), np.stack([babble(2.0), babble(2.0, 2)]))
    assert "cannot use any of the 1 takes" in run(capsys, "evaluate", model, tmp_path, code=1)


# --- train, ablate


def test_without_torch_it_is_said_what_to_install(
    takes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    missing = describe_missing_extra("train", "Training")
    monkeypatch.setattr(train_process, "find_missing_tools", lambda: missing)
    text = run(capsys, "train", takes, "-o", tmp_path / "m.mgmodel", code=1)
    assert "pip install" in text and "750 MB" in text
    assert not [p for p in tmp_path.iterdir() if p.name != "data"]


def test_what_cannot_be_trained_is_told_before_anything_is_read(
    takes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(train_process, "find_missing_tools", lambda: None)
    out = ("-o", tmp_path / "m.mgmodel")
    assert "written as .mgmodel" in run(capsys, "train", takes, "-o", tmp_path / "m.pt", code=1)
    assert "--minutes must be more than 0" in run(capsys, "train", takes, *out, "--minutes", 0, code=1)
    assert "give takes" in run(capsys, "train", *out, code=1)
    assert "training to go on" in run(capsys, "train", *out, "--resume", code=1)
    (tmp_path / "m.mgmodel").write_bytes(b"mine")
    assert "exists already" in run(capsys, "train", takes, *out, code=1)
    assert (tmp_path / "m.mgmodel").read_bytes() == b"mine"


@pytest.mark.skipif(not TORCH, reason="training needs torch")
def test_a_model_is_trained_judged_and_gone_on_with(
    takes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "m.mgmodel"
    words = ("--threads", 1, "--json")
    data = json.loads(run(capsys, "train", takes, "-o", out, "--seconds", 0.2, *words))
    assert data["learned"] == data["held_out"] == 2 and data["steps"] > 0 and not data["stopped"]
    more = json.loads(run(capsys, "train", "-o", out, "--resume", "--seconds", data["seconds"] + 0.2, *words))
    assert more["steps"] > data["steps"]
    rows = json.loads(run(capsys, "evaluate", out, takes, "--seeds", 1, "--draws", 1, "--json"))["rows"]
    assert rows[-1]["name"] == "m" and read_model(out).card.steps == more["steps"]


@pytest.mark.nightly
def test_stopping_a_training_keeps_what_was_learned(
    takes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    class Process:
        """Writes its model once it is asked to stop, as `TrainingProcess` does."""

        running = False
        last = train_process.TrainingEvent(event="end", minutes=0.5, seconds=20.0, stopped=True)

        def __init__(self, out: Path, heard: object) -> None:
            self.out, self.asked = out, False

        def stop(self) -> None:
            self.asked = True

        def wait(self) -> Path:
            signal.raise_signal(signal.SIGINT)
            assert self.asked
            write_model(untrained("matching"), self.out)
            return self.out

    monkeypatch.setattr(train_process, "find_missing_tools", lambda: None)
    monkeypatch.setattr(train_process, "TrainingProcess", Process)
    before = signal.getsignal(signal.SIGINT)
    text = run(capsys, "train", takes, "-o", tmp_path / "m.mgmodel")
    assert "stopped" in text and "--resume" in text
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.nightly
def test_an_ablation_is_a_table_and_is_taken_up_again(
    takes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    done = []

    def trained(options, rig, tracks, job):
        done.append(job.out.name)
        write_model(untrained(job.kind, sizes=tiny(job.kind)), job.out)

    monkeypatch.setattr(train_process, "find_missing_tools", lambda: None)
    monkeypatch.setattr(generate_training, "_train_one", trained)
    words = (
        "ablate",
        takes,
        "-o",
        tmp_path / "a",
        "--seconds",
        1,
        "--seeds",
        1,
        "--draws",
        1,
        "--model",
        "flow-vae",
    )
    some = ("--change", "no activity", "--change", "no vae")
    text = run(capsys, *words, *some)
    assert "2 trained now" not in text and "3 trained now, 0 kept" in text
    assert "the flow on poses themselves" in text and done == [
        "whole-1.mgmodel",
        "no-vae-1.mgmodel",
        "no-activity-1.mgmodel",
    ]
    data = json.loads(run(capsys, *words, *some, "--json"))
    assert data["trained_now"] == [] and len(data["kept"]) == 3 and len(done) == 3
    assert json.loads((tmp_path / "a" / "table.json").read_text())["rows"] == data["rows"]
    assert "no change 'no hope'" in run(capsys, *words, "--change", "no hope", code=1)
    assert "other seconds" in run(capsys, *words[:4], *some, "--model", "flow-vae", "--seconds", 2, code=1)
