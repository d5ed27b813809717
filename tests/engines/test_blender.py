"""The add-on for Blender: what needs no Blender here; the rest in Blender itself, where it is at hand."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from websockets.sync.server import ServerConnection, serve

from app.cli.parser import main
from metagraph.engines.export import export_project
from metagraph.engines.runtimes.blender.metagraph_blender import glb, labels, link, space
from metagraph.engines.targets import registry
from metagraph.engines.targets.blender import ADDON
from metagraph.engines.targets.runtimes import RUNTIMES
from metagraph.formats.gltf.reader import read_gltf_clips
from metagraph.formats.store import open_project, save_project
from metagraph.graph.model import Project
from metagraph.motion import rotation
from tests.engines.blender_python import find_blender

HERE = Path(__file__).parent
SAMPLE = HERE.parents[1] / "sample_clips" / "sample.metagraph.yaml"


@pytest.fixture(scope="module")
def exported(sample: Project, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sample's export: its JSON, the GLB with Ada beside it."""
    return export_project(
        sample, tmp_path_factory.mktemp("export"), character=SAMPLE.with_name("ada.glb")
    ).json


@pytest.fixture(scope="module")
def document(exported: Path) -> dict[str, Any]:
    return labels.read_export(exported)


@pytest.fixture(scope="module")
def figure(document: dict[str, Any]) -> space.Figure:
    return space.Figure(document["joints"])


def posed(figure: space.Figure, frames: int = 5) -> tuple[Any, Any]:
    rng = np.random.default_rng(3)
    turns = rotation.normalize(rng.normal(size=(frames, len(figure.names), 4)))
    return turns, figure.rest_translations + rng.normal(size=(frames, len(figure.names), 3)) * 0.1


def apart(a: Any, b: Any) -> float:
    """Return the largest angle between rotations, degrees; by their distance, since a cosine near 1 has no
    digits left.
    """
    a, b = rotation.normalize(np.asarray(a, float)), rotation.normalize(np.asarray(b, float))
    chord = np.minimum(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1))
    return float(np.degrees(4 * np.arcsin(chord.max() / 2)))


@pytest.mark.nightly
def test_poses_go_to_bones_of_any_axes_and_come_back(figure: space.Figure) -> None:
    rotations, translations = posed(figure)
    axes = rotation.normalize(np.random.default_rng(5).normal(size=(len(figure.names), 4)))
    _, places = figure.globals(rotations, translations)
    rest, _ = figure.globals(figure.rest_rotations, figure.rest_translations)
    bones_at_rest = rotation.multiply(rotation.multiply(space.UP, rest), axes)
    assert np.abs(np.abs((figure.corrections(bones_at_rest) * axes).sum(-1)) - 1).max() < 1e-12
    # What Blender does with what a bone adds: parent's pose, its rest beside the parent's, the addition.
    added, moved = figure.to_bones(axes, rotations, translations)
    posed_bones, heads = np.zeros_like(added), np.zeros_like(moved)
    _, rest_places = figure.globals(figure.rest_rotations, figure.rest_translations)
    rest_heads = rotation.rotate_vectors(space.UP, rest_places)
    for joint, parent in enumerate(figure.parents):
        own, at = bones_at_rest[joint], rest_heads[joint]
        if parent >= 0:
            back = rotation.conjugate(bones_at_rest[parent])
            own, at = rotation.multiply(back, own), rotation.rotate_vectors(back, at - rest_heads[parent])
            at = heads[:, parent] + rotation.rotate_vectors(posed_bones[:, parent], at)
            own = rotation.multiply(posed_bones[:, parent], own)
        heads[:, joint] = at + rotation.rotate_vectors(own, moved[:, joint])
        posed_bones[:, joint] = rotation.multiply(own, added[:, joint])
    assert np.abs(heads - rotation.rotate_vectors(space.UP, places)).max() < 1e-9
    read, read_places = figure.from_bones(axes, posed_bones, heads)
    assert np.abs(np.abs((read * rotations).sum(-1)) - 1).max() < 1e-9
    assert np.abs(read_places - translations).max() < 1e-9


def test_clips_it_writes_are_read_back_with_their_morph_targets(
    document: dict[str, Any], tmp_path: Path
) -> None:
    turned = rotation.normalize(np.random.default_rng(9).normal(size=(len(document["joints"]), 4)))
    joints = zip(document["joints"], turned.tolist(), strict=True)
    figure = space.Figure([{**joint, "rotation": turn} for joint, turn in joints])
    rotations, translations = posed(figure, 7)
    weights = np.linspace(0, 1, 14).reshape(7, 2)
    path = tmp_path / "back.glb"
    path.write_bytes(
        glb.glb(
            figure,
            [
                glb.Take("Gruß", 24.0, space.continuous(rotations), translations, ("a", "b"), weights),
                glb.Take("still", 30.0, rotations[:1], translations[:1]),
            ],
        )
    )
    first = read_gltf_clips(path)[0]
    assert (first.name, first.fps, first.frames) == ("Gruß", 24.0, 7)
    assert first.skeleton.names == tuple(figure.names)
    assert np.abs(first.skeleton.rest_translations - figure.rest_translations).max() < 1e-6
    assert apart(first.skeleton.rest_rotations, figure.rest_rotations) < 1e-4
    assert np.abs(np.abs((first.rotations * rotations).sum(-1)) - 1).max() < 1e-6
    assert np.abs(first.poses().translations - translations).max() < 1e-6
    assert first.weights is not None and np.abs(first.weights - weights).max() < 1e-6


def test_labels_are_what_the_export_says_and_rows_tell_what_changed(document: dict[str, Any]) -> None:
    known = labels.labels_of(document)
    assert len(known) == sum(len(layer["actions"]) for layer in document["layers"].values())
    assert all(not labels.faults(label, 1e3) for label in known)
    before = next(label for label in known if label["kind"] == "gesture")
    after = {**before, "tags": ["mine"], "stroke": 0.25, "start": before["start"] + 1e-8, "repeat": 2.0}
    assert labels.row_of("c", before, after) == {
        "clip": "c", "action": before["action"], "tags": ["mine"], "stroke": 0.25, "repeat": 2.0
    }  # fmt: skip
    wrong = {**before, "kind": "transition", "end_stance": before["stance"], "start": 9.0, "likelihood": 0}
    assert len(labels.faults(wrong, 3.0)) >= 3
    with pytest.raises(ValueError, match="no export"):
        labels.read_export(HERE.parents[1] / "metagraph" / "engines" / "metagraph.schema.json")
    assert labels.split_tags(" a, b,,a ") == ["a", "b"]


@pytest.mark.nightly
def test_rows_place_and_change_actions_of_a_project_and_say_what_cannot_be(
    sample: Project,
    figure: space.Figure,
    document: dict[str, Any],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    project = tmp_path / "sample.metagraph.yaml"
    save_project(sample, project, SAMPLE)
    known = next(a for a in labels.labels_of(document) if a["kind"] == "gesture")
    rows = [
        {"clip": "Gruß", "action": known["action"], "tags": ["mine"], "stroke": 0.1, "end": 0.2},
        {"clip": "Gruß", "name": "hello", "kind": "gesture", "layer": "arms", "stance": "new one"},
        {"clip": "nobody's", "action": known["action"]},
        {"clip": "Gruß", "action": "a999999"},
    ]
    rotations, translations = posed(figure, 9)
    (tmp_path / "b.glb").write_bytes(glb.glb(figure, [glb.Take("Gruß", 30.0, rotations, translations)]))
    (tmp_path / "b.json").write_text(labels.label_file(rows), encoding="utf-8")
    order = ["import", str(project), str(tmp_path / "b.glb"), "--labels", str(tmp_path / "b.json")]
    for _ in range(2):  # taking the same in twice changes nothing more
        assert main(order) == 3
        told = capsys.readouterr()
        assert "Labelled 2 of 4" in told.out and "no clip 'nobody's'" in told.err and "'a999999'" in told.err
    made = open_project(project).project
    changed = made.action(known["action"])
    assert changed is not None and made.clips[changed.clip].name == "Gruß"
    assert (changed.tags, changed.timing.stroke, changed.timing.end) == (("mine",), 0.1, 0.2)
    assert changed.name == known["name"]
    [new] = [a for a in made.actions() if a.name == "hello"]
    stance = made.stance(new.stance)
    assert stance is not None and stance.name == "new one" and new.clip == changed.clip
    (tmp_path / "b.json").write_text('{"labels": 1, "actions": [{"clip": "x", "kind": "walk"}]}')
    assert main(order) == 1
    assert "actions[0].kind" in capsys.readouterr().err
    assert main(["import", str(project)]) == 2


@pytest.fixture
def session() -> Iterator[tuple[str, list[Any]]]:
    """A session as the library for WebSockets serves it: pings, long and split messages, then a goodbye."""
    heard: list[Any] = []

    def talk(line: ServerConnection) -> None:
        heard.append(json.loads(line.recv()))
        poses = {"joints": ["a"], "morphs": ["m"], "rate": 30}
        if heard[-1].get("token") == "wrong":
            line.send(json.dumps({"state": "refused", "why": "that is not the token"}))
            return
        line.send(json.dumps({"state": "done", "poses": poses}))
        line.ping().wait(5)
        line.send(json.dumps({"event": "x" * 70_000}))
        pose = json.dumps({"t": 1, "root": [0, 1, 0], "rotations": [[0, 0, 0, 1]], "weights": {"m": 0.5}})
        line.send(iter([pose[:10], pose[10:]]))

    with serve(talk, "127.0.0.1", 0) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield f"ws://127.0.0.1:{server.socket.getsockname()[1]}", heard
        server.shutdown()
        thread.join(5)


def test_poses_of_a_session_are_followed_without_a_library(session: tuple[str, list[Any]]) -> None:
    address, heard = session
    poses = link.Poses(address, 25, "secret")
    poses._thread.join(5)
    assert heard[0]["token"] == "secret" and heard[0]["poses"] == {"rate": 25}
    pose = poses.newest()
    assert pose is not None and pose["weights"] == {"m": 0.5} and poses.newest() is None
    assert poses.ended and (poses.joints, poses.morphs) == (["a"], ["m"])
    poses.close()
    with pytest.raises(link.LinkError, match="not the token"):
        link.Poses(address, token="wrong")
    with pytest.raises(link.LinkError, match="nobody answers"):
        link.Poses("ws://127.0.0.1:9")
    with pytest.raises(link.LinkError, match="no address"):
        link.Poses("http://127.0.0.1:9")


def test_the_archive_is_what_blender_installs(sample: Project, tmp_path: Path) -> None:
    import tomllib

    report = registry.write_for_target(sample, "blender", tmp_path)
    with zipfile.ZipFile(tmp_path / f"{ADDON}.zip") as archive:
        names = set(archive.namelist())
        manifest = tomllib.loads(archive.read(f"{ADDON}/blender_manifest.toml").decode())
    there = {f"{ADDON}/{p.name}" for p in (RUNTIMES / "blender" / ADDON).iterdir() if p.is_file()}
    assert names == there and f"{ADDON}/__init__.py" in names
    assert manifest["id"] == ADDON and len(manifest["tagline"]) <= 64
    assert {"sample.json", "sample.glb", "README.md"} <= {p.name for p in report.files}


# --- in Blender


@pytest.fixture(scope="module")
def driven(exported: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    """What `run/blender_drive.py` found, and its folder."""
    out, count = tmp_path_factory.mktemp("blender"), os.environ.get("METAGRAPH_BPY_ACTIONS", "12")
    python = find_blender()
    live = subprocess.Popen(
        [sys.executable, "-m", "app.cli", "live", str(SAMPLE), "--json", "--port", "0", "--osc-port", "0", "--no-stdin"],
        stdout=subprocess.PIPE, text=True, cwd=HERE.parents[1],
    )  # fmt: skip
    try:
        assert live.stdout is not None
        address = json.loads(live.stdout.readline())
        done = subprocess.run(
            [python, str(HERE / "run" / "blender_drive.py"), str(RUNTIMES / "blender"),
             str(exported), str(out), count, address["websocket"]],
            capture_output=True, text=True, timeout=300, env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"},
        )  # fmt: skip
    finally:
        live.terminate()
        live.communicate(timeout=20)
    assert done.returncode == 0, done.stdout[-1500:] + done.stderr[-3000:]
    return out, json.loads((out / "noted.json").read_text())


def test_blender_shows_clips_and_labels_as_they_are(
    driven: tuple[Path, dict[str, Any]], sample: Project, document: dict[str, Any]
) -> None:
    folder, noted = driven
    told = {label["action"]: label for label in noted["labels"]}
    known = {label["action"]: label for label in labels.labels_of(document)}
    assert told.keys() == known.keys()
    for ident, label in known.items():
        assert not labels.changed(label, told[ident]) and told[ident]["clip"] == label["clip"]
    tracks: dict[str, int] = {}
    for label in known.values():
        key = f"{label['layer']}: {label['stance']}"
        tracks[key] = tracks.get(key, 0) + 1
    assert noted["tracks"] == tracks
    assert noted["sets"] == 1  # all key the same bones: none stays as the action before left it
    rates = {clip["name"]: clip["fps"] for clip in document["clips"]}
    poses, degrees, metres = np.load(folder / "poses.npz"), 0.0, 0.0
    for ident, (frame, heads) in noted["heads"].items():
        action = sample.action(ident)
        assert action is not None
        clip = sample.clips[action.clip].motion
        assert clip is not None
        read, places = poses[f"{ident} rotations"], poses[f"{ident} translations"]
        rate = rates[told[ident]["clip"]]
        between = round(rate / clip.fps)  # the export's frames for one of the clip
        assert len(read) == (clip.frames - 1) * between + 1
        degrees = max(degrees, apart(read[::between], clip.rotations))
        metres = max(metres, float(np.abs(places[::between] - clip.poses().translations).max()))
        _, positions = clip.skeleton.globals(clip.pose_at(frame / rate))
        up = positions[:, [0, 2, 1]] * [1, -1, 1]
        metres = max(metres, float(np.abs(np.array(heads) - up).max()))
    print(f"{len(noted['heads'])} actions: {degrees:.4f} degrees, {metres * 1000:.4f} mm")
    assert degrees < 0.02 and metres < 1e-4  # the export's own integers and thinned keys


def test_what_is_edited_there_comes_back_into_the_project(
    sample: Project, driven: tuple[Path, dict[str, Any]], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, noted = driven
    assert noted["nothing"] == ["CANCELLED"] and noted["kept"] == len(noted["labels"]) + 2
    assert noted["files"] == ["blender.glb", "blender.labels.json", "blender_2.glb", "blender_2.labels.json"]
    assert "metagraph import PROJECT" in noted["command"] and "--labels" in noted["command"]
    project = tmp_path / "sample.metagraph.yaml"
    save_project(sample, project, SAMPLE)
    back = folder / "back"
    assert (
        main(
            ["import", str(project), str(back / "blender.glb"), "--labels", str(back / "blender.labels.json")]
        )
        == 0
    )
    assert "Labelled 3 of 3" in capsys.readouterr().out
    made = open_project(project).project
    first, second = (made.action(ident) for ident in noted["edited"])
    assert first is not None and second is not None
    before = sample.action(first.id)
    assert before is not None and first.clip == before.clip and first.tags == ("beat", "mine")
    assert first.timing.stroke == pytest.approx(0.4)
    assert second.clip not in sample.clips
    edited, motion = np.load(folder / "edited.npz"), made.clips[second.clip].motion
    if motion is None:
        [motion] = [
            c for c in read_gltf_clips(back / "blender.glb") if c.name == made.clips[second.clip].name
        ]
    assert apart(motion.rotations, edited["rotations"]) < 1e-3
    [greeting] = [a for a in made.actions() if a.name == "Mein Gruß"]
    assert greeting.layer == "arms" and greeting.tags == ("greeting",)
    smile = made.clips[greeting.clip].motion
    assert smile is not None and smile.weights is not None and smile.morphs == (noted["shape"],)
    assert smile.weights[[0, -1], 0] == pytest.approx([0.0, 0.7], abs=1e-5)
    stance = made.stance(greeting.stance)
    assert stance is not None and stance.name == "a stance of my own"


def test_the_panel_and_the_live_link_work_in_blender(driven: tuple[Path, dict[str, Any]]) -> None:
    _, noted = driven
    words = [str(word) for row in noted["panel"] for word in row]
    assert {"kind", "layer", "stance", "tags", "start", "Send back…", "Live"} <= set(words)
    assert "Import an export, or choose its armature" in str(noted["before"])
    assert noted["live"]["poses"] == 20 and noted["live"]["degrees"] < 0.02
    assert "nobody answers" in noted["nobody"]
    print(noted["live"], noted["load_seconds"])
