"""Exports: they validate, they come back equal, their GLB holds every clip, and broken ones are refused with
a path.
"""

from __future__ import annotations

import copy
import hashlib
import json
import random
import shutil
import struct
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import msgspec
import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from metagraph.engines.contract import FORMAT, export_schema
from metagraph.engines.export import export_project, export_schema_text
from metagraph.engines.export_document import list_used_clips, to_document
from metagraph.engines.export_error import ExportError
from metagraph.engines.export_rig import list_export_voices, read_voices
from metagraph.engines.reading import read_export
from metagraph.engines.targets import registry
from metagraph.engines.targets.target import Contents
from metagraph.errors import FileError
from metagraph.formats.gltf.reader import read_character, read_gltf_clips
from metagraph.formats.imports import gather, import_files
from metagraph.formats.store import open_project, save_project
from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.expand import count_machine_size, list_connections
from metagraph.graph.model import LAYERS, Markov, Project
from metagraph.graph.repeating import cycle_of
from metagraph.graph.requests import Line
from metagraph.motion.skeleton import make_names_unique
from metagraph.playback.life.voice import make_silent_voice
from metagraph.playback.planner import make_plan
from metagraph.playback.planning import choice, hashing, markov
from metagraph.playback.posing.layers import ease_blend
from sample_clips.make.conformance_projects import stick
from tests.posing import pose_at
from tests.projects import clip, projects
from tests.thorough import many

pytestmark = pytest.mark.usefixtures("numbered_ids")

ROOT = Path(__file__).resolve().parents[2]
SCHEMA = ROOT / "metagraph" / "engines" / "metagraph.schema.json"
VALIDATOR = jsonschema.Draft202012Validator(json.loads(SCHEMA.read_bytes()))


def valid(document: Any) -> None:
    errors = [f"{e.json_path}: {e.message}" for e in VALIDATOR.iter_errors(document)]
    assert not errors, errors[:3]


def same(back: Project, project: Project) -> None:
    """Assert that the graph came back whole. Times that lie outside a clip come back as they play."""
    for layer in LAYERS:
        graph = project.graphs[layer]
        shown = {}
        for action in graph.actions.values():
            start, end = project.span(action)
            timing = replace(action.timing, start=start, end=None if action.timing.end is None else end)
            if not cycle_of(action.kind, action.timing, start, end):  # loops and moments do not repeat
                timing = replace(timing, repeat=0.0)
            shown[action.id] = replace(action, timing=timing)
        assert back.graphs[layer].actions == shown
        assert list(back.graphs[layer].actions) == list(shown)
        assert back.graphs[layer].stances == graph.stances
        assert back.graphs[layer].start == graph.start
        assert back.graphs[layer].weights == graph.weights
        assert back.graphs[layer].index == back.graphs[layer].with_actions({}).index
    base, clip = project.base, project.clips.get(project.base.clip or "")
    steps = 1 if clip is None else round(back.clips[clip.id].fps / clip.fps)  # an export has dense keys
    assert back.base == replace(base, frame=base.frame * steps)
    for field in ("name", "settings", "markov", "roles", "parts", "skeleton"):
        assert getattr(back, field) == getattr(project, field), field


def gltf(path: Path) -> dict[str, Any]:
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + length])


JUDGED: dict[str, dict[str, Any]] = {}


def khronos(*files: Path, warnings: bool = True) -> None:
    """Assert that the Khronos validator finds no error; nor, unless they are allowed, a warning. It looks once
    at what has the same bytes: a dozen targets write the same file.
    """
    if shutil.which("node") is None or not (ROOT / "tests" / "node_modules" / "gltf-validator").is_dir():
        pytest.skip("needs Node and the Khronos glTF validator (python3 run.py test fetches it where npm is)")
    known = {file: hashlib.sha256(file.read_bytes()).hexdigest() for file in files}
    if fresh := {name: file for file, name in known.items() if name not in JUDGED}:
        out = subprocess.run(
            ["node", str(Path(__file__).with_name("validate.mjs")), *map(str, fresh.values())],
            capture_output=True,
            text=True,
            check=True,
            timeout=300,
        )
        JUDGED.update(zip(fresh, map(json.loads, out.stdout.splitlines()), strict=True))
    for report in (JUDGED[name] for name in known.values()):
        assert report["errors"] == 0, report["messages"][:5]
        assert warnings or report["warnings"] == 0, report["messages"][:5]


# --- the schema


def test_the_published_schema_is_the_one_in_the_code() -> None:
    assert SCHEMA.read_bytes() == export_schema_text()


@pytest.mark.nightly
def test_the_schema_is_one_by_its_own_rules() -> None:
    jsonschema.Draft202012Validator.check_schema(export_schema())


# --- the sample project


@pytest.fixture(scope="module")
def exported(sample: Project, tmp_path_factory: pytest.TempPathFactory) -> Any:
    folder = tmp_path_factory.mktemp("export")
    return export_project(sample, folder, expanded=True, character=ROOT / "sample_clips" / "mannequin.glb")


def test_the_sample_validates_and_comes_back_equal(sample: Project, exported: Any) -> None:
    valid(json.loads(exported.json.read_bytes()))
    back = read_export(exported.json)
    same(back, sample)
    assert exported.clips == len(sample.uses.keys() | {sample.base.clip})
    assert check_project(back) == [p for p in check_project(sample) if p.clip in (None, *back.clips)]


@pytest.mark.nightly
def test_an_export_of_what_was_read_back_says_the_same(exported: Any, tmp_path: Path) -> None:
    again = export_project(read_export(exported.json), tmp_path, expanded=True)
    ours, theirs = json.loads(again.json.read_bytes()), json.loads(exported.json.read_bytes())
    for field in ("rotations", "translations"):  # taken from clips that were stored in 16 bits meanwhile
        assert np.allclose(ours["base"].pop(field), theirs["base"].pop(field), atol=1e-4)
    for mine, other in zip(ours["clips"], theirs["clips"], strict=True):
        assert np.allclose(mine.pop("arms", []), other.pop("arms", []), atol=10)
        feet, were = np.array(mine.pop("feet", [])), np.array(other.pop("feet", []))
        assert np.allclose(feet[:1], were[:1], atol=25)  # one row for all where they hardly move
    for mine, other in zip(ours["rig"]["shoulders"], theirs["rig"]["shoulders"], strict=True):
        for field in ("tense", "closed"):
            assert np.allclose(mine.pop(field), other.pop(field), atol=1e-3)
    mine, other = (data.pop("weight_rig") for data in (ours, theirs))
    for field in ("levers", "knees"):
        assert np.allclose(mine.pop(field), other.pop(field), atol=1e-4)
    for name in ("bends", "collars"):
        for a, b in zip(mine.pop(name), other.pop(name), strict=True):
            assert a.keys() == b.keys()
            assert all(np.allclose(a[field], b[field], atol=1e-4) for field in a)
    assert mine == other
    for field in ("glb_bytes", "glb_sha256"):  # of keys that were chosen again
        ours.pop(field), theirs.pop(field)
    for layer in LAYERS:  # found in twice as many frames
        both = (data["layers"][layer]["actions"] for data in (ours, theirs))
        for a, b in zip(*both, strict=True):
            assert len(a.pop("phases", [])) == len(b.pop("phases", []))
            for field in ("vigour", "prominence"):
                assert a.pop(field, 0.0) == pytest.approx(b.pop(field, 0.0), abs=0.05)
    assert ours == theirs


@pytest.mark.nightly
def test_the_mesh_says_how_its_targets_make_vrms_presets(sample: Project, tmp_path: Path) -> None:
    made = export_project(sample, tmp_path, character=ROOT / "sample_clips" / "ada.glb")
    khronos(made.glb)
    extras = gltf(made.glb)["meshes"][0]["extras"]
    assert {"happy", "angry", "sad", "surprised", "aa", "ou"} <= extras["expressions"].keys()
    assert all(mix.keys() <= set(extras["targetNames"]) for mix in extras["expressions"].values())
    assert extras["expressions"]["aa"]["jawOpen"] == 0.6


@pytest.mark.nightly
def test_the_glb_holds_every_used_clip_under_its_name_and_the_mesh(sample: Project, exported: Any) -> None:
    document, content = json.loads(exported.json.read_bytes()), gltf(exported.glb)
    names = [a["name"] for a in content["animations"]]
    assert [(c["animation"], c["name"]) for c in document["clips"]] == list(enumerate(names))
    assert names == [sample.clips[c["id"]].name for c in document["clips"]]
    assert content["meshes"] and content["skins"]
    khronos(exported.glb)


@pytest.mark.nightly
def test_motion_in_the_glb_is_the_clips_motion(sample: Project, exported: Any) -> None:
    for made, entry in zip(
        read_gltf_clips(exported.glb),
        (sample.clips[c] for c in read_export(exported.json, motions=False).clips),
        strict=True,
    ):
        assert entry.motion is not None
        dense = entry.motion.dense
        assert (made.frames, made.fps) == (dense.frames, dense.fps) and dense.fps >= 60
        at = np.linspace(0, entry.duration, 7)
        a, b = made.pose_at(at), entry.motion.pose_at(at)
        assert np.abs(np.einsum("...i,...i->...", a.rotations, b.rotations)).min() > 1 - 1e-6
        assert np.abs(a.translations - b.translations).max() < 2e-4


def test_a_bind_pose_that_was_exported_is_read_back(toy: Any, tmp_path: Path) -> None:
    whole = toy.clip("wave", 1.0, 1.3)
    rotations = whole.rotations.copy()
    rotations[0] = toy.skeleton.rest_rotations
    project = edits.add_clips(Project("bound"), [("wave.glb", 0, "", replace(whole, rotations=rotations))])
    project = edits.add_stance(project, "arms", "up", list(project.clips))
    made = export_project(project, tmp_path)
    assert "bind pose" in read_gltf_clips(made.glb)[0].notes[-1], "a file that somebody imports is mended"
    for entry in read_export(made.json, resolved=True).clips.values():
        assert entry.motion is not None and entry.motion.frames == entry.frames


@pytest.mark.nightly
def test_a_plan_of_what_was_read_back_is_the_same_and_looks_the_same(sample: Project, exported: Any) -> None:
    back = read_export(exported.json)
    ours, theirs = make_plan(sample, 20), make_plan(back, 20)
    for layer in LAYERS:
        assert [(c.action.id, round(c.start, 6)) for c in ours.layers[layer].cues] == [
            (c.action.id, round(c.start, 6)) for c in theirs.layers[layer].cues
        ]
    at = np.linspace(0, 20, 40)
    a, b = pose_at(ours, sample, at), pose_at(theirs, back, at)
    assert np.abs(np.einsum("...i,...i->...", a.rotations, b.rotations)).min() > 1 - 1e-5


def test_the_expanded_columns_are_the_connections_of_the_machine(sample: Project, exported: Any) -> None:
    document = json.loads(exported.json.read_bytes())
    total = 0
    for layer in LAYERS:
        columns = document["expanded"][layer]
        rows = [
            (columns["states"][s], columns["states"][t], leave, blend)
            for s, t, leave, blend in zip(
                columns["from"], columns["to"], columns["leave"], columns["blend"], strict=True
            )
        ]
        expected = [
            (x.source, x.target, -1 if x.leave is None else x.leave, x.blend)
            for x in list_connections(sample, sample.graphs[layer])
        ]
        assert rows == expected
        total += len(rows)
    assert total == count_machine_size(sample).connections


def test_the_index_and_the_transitions_say_what_the_graph_says(sample: Project, exported: Any) -> None:
    document = json.loads(exported.json.read_bytes())
    for layer in LAYERS:
        graph, out = sample.graphs[layer], document["layers"][layer]
        flat = {(s, k): ids for s, kinds in out["index"].items() for k, ids in kinds.items()}
        assert flat == {key: [a.id for a in actions] for key, actions in graph.index.items()}
        ways = {(t["from"], t["to"]): t["actions"] for t in out["transitions"]}
        assert sum(map(len, ways.values())) == sum(a.kind == "transition" for a in graph.actions.values())
        assert all(graph.actions[i].end_stance == to for (_, to), ids in ways.items() for i in ids)
        model = markov.model(sample, layer)
        assert [tuple(s) for s in out["markov"]["states"]] == list(model.states)
        assert np.allclose(out["markov"]["matrix"], model.matrix)


def test_the_constants_are_those_the_planner_uses(exported: Any) -> None:
    document = json.loads(exported.json.read_bytes())
    numbers = document["randomness"]
    assert (numbers["offset"], numbers["prime"], numbers["test"]) == (
        hashing.OFFSET,
        hashing.PRIME,
        choice.key32(1, "a", "b"),
    )
    assert document["planner"]["blend"] == "3x^2-2x^3"
    assert np.allclose(ease_blend(np.array([0.25])), 3 * 0.25**2 - 2 * 0.25**3)


@pytest.mark.nightly
def test_the_same_project_gives_the_same_bytes(sample: Project, exported: Any, tmp_path: Path) -> None:
    again = export_project(sample, tmp_path, expanded=True, character=ROOT / "sample_clips" / "mannequin.glb")
    assert again.json.read_bytes() == exported.json.read_bytes()
    assert again.glb.read_bytes() == exported.glb.read_bytes()


@pytest.mark.nightly
def test_a_project_read_back_is_saved_and_opened_with_its_clips(sample: Project, exported: Any) -> None:
    path = exported.json.with_name("again.metagraph.yaml")
    save_project(read_export(exported.json), path)
    opened = open_project(path)
    assert all(e.motion is not None for e in opened.project.clips.values())
    same(opened.project, sample)


# --- any project


def document_of(project: Project, expanded: bool = False) -> bytes:
    used = list_used_clips(project)
    return msgspec.json.encode(
        to_document(project, "x.glb", make_names_unique([e.name for e in used]), expanded)
    )


# Many random projects have no clips yet, and are passed over.
@pytest.mark.nightly
@settings(
    max_examples=many(30, 1000),
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.filter_too_much],
)
@given(projects(14), st.booleans())
def test_any_graph_validates_and_comes_back(tmp_path: Path, project: Project, expanded: bool) -> None:
    assume(project.skeleton is not None)
    text = document_of(project, expanded)
    valid(json.loads(text))
    (tmp_path / "x.json").write_bytes(text)
    same(read_export(tmp_path / "x.json", motions=False), project)


def small() -> Project:
    project = edits.add_clips(
        Project("a/b: ü*"), [(f"{n}.glb", 0, "", clip(n)) for n in ("idle", "wave", "idle")]
    )
    project = edits.add_stance(project, "arms", "rest", ["c1"])
    return edits.place_clips(project, ["c2"], "arms", "gesture", "s4")


def test_only_clips_that_are_placed_or_hold_the_base_pose_are_written(tmp_path: Path) -> None:
    made = export_project(small(), tmp_path)
    assert [a["name"] for a in gltf(made.glb)["animations"]] == ["idle", "wave"]
    made = export_project(edits.set_base(small(), "c3", 2), tmp_path)
    assert [a["name"] for a in gltf(made.glb)["animations"]] == ["idle", "wave", "idle_2"]
    khronos(made.glb)


def test_the_files_are_named_after_the_project_in_letters_every_system_takes(tmp_path: Path) -> None:
    made = export_project(small(), tmp_path / "new" / "folder")
    assert (made.json.name, made.glb.name) == ("a_b_ü.json", "a_b_ü.glb")
    assert export_project(replace(small(), name="../.."), tmp_path).json == tmp_path / "metagraph.json"


def test_clips_of_one_frame_and_long_ones_come_back_as_themselves(tmp_path: Path) -> None:
    project = edits.add_clips(
        Project("p"),
        [("a", 0, "", clip("still", 1)), ("b", 0, "", clip("wave", 9)), ("c", 0, "", clip("nod", 12))],
    )
    project = edits.add_stance(project, "arms", "rest", ["c1"])
    project = edits.place_clips(project, ["c2", "c3"], "arms", "gesture", "s4")
    back = read_export(export_project(project, tmp_path).json)
    assert [e.motion.frames for e in back.clips.values() if e.motion] == [1, 17, 23]
    save_project(back, tmp_path / "p.metagraph.yaml")
    again = open_project(tmp_path / "p.metagraph.yaml").project
    assert [e.motion.frames for e in again.clips.values() if e.motion] == [1, 17, 23]


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda p: Project(), "nothing to export"),
        (lambda p: edits.remove_actions(p, ["a5", "a6"]), "has no loop"),
        (lambda p: edits.remove_stance(p, "s4"), "nothing to export"),
        (lambda p: edits.update_actions(p, ["a6"], timing={"end": 99.0}), "'wave' plays 0.00 to 99.00 s"),
        (lambda p: edits.update_actions(p, ["a6"], likelihood=0.0), "never plays"),
        (
            lambda p: replace(p, clips={**p.clips, "c2": replace(p.clips["c2"], motion=None)}),
            "the file of clip 'wave' is missing",
        ),
    ],
)
def test_errors_stop_an_export_with_the_words_of_the_problem(tmp_path: Path, spoil: Any, words: str) -> None:
    with pytest.raises(ExportError, match=words):
        export_project(spoil(small()), tmp_path)
    assert not list(tmp_path.iterdir())


def test_blends_that_are_only_warned_of_are_exported_as_they_play(tmp_path: Path) -> None:
    made = export_project(edits.update_actions(small(), ["a6"], timing={"blend_in": -1.0}), tmp_path)
    assert any("blend in" in w for w in made.warnings)
    document = json.loads(made.json.read_bytes())
    valid(document)
    assert document["layers"]["arms"]["actions"][1]["blend_in"] == 0


@pytest.mark.nightly
def test_a_mesh_on_another_skeleton_is_bound_where_joints_match(sample: Project, tmp_path: Path) -> None:
    """Fewer joints than the mannequin has, all at rest in other rotations."""
    project = stick()
    made = export_project(project, tmp_path / "bound", character=ROOT / "sample_clips" / "mannequin.glb")
    (told,) = (w for w in made.warnings if "mannequin.glb" in w)
    assert "another skeleton" in told and "bound by the names" in told
    document = gltf(made.glb)
    assert len(document["skins"][0]["joints"]) == len(project.skeleton or ()) and document["meshes"]
    khronos(made.glb)
    names = [f"other{n}" for n in range(len(sample.skeleton or ()))]
    assert sample.skeleton is not None
    strange = replace(read_character(ROOT / "sample_clips" / "mannequin.glb"), name="strange")
    strange = replace(strange, skeleton=replace(strange.skeleton, names=tuple(names)))
    made = export_project(project, tmp_path / "left", character=strange)
    assert any("'strange'" in w and "joints" in w for w in made.warnings)
    assert "meshes" not in gltf(made.glb)


def test_a_mesh_that_is_not_there_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"none\.glb"):
        export_project(small(), tmp_path, character=tmp_path / "none.glb")


def test_a_folder_that_cannot_be_made_is_an_error_in_words(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="cannot be created"):
        export_project(small(), tmp_path / "file" / "x")


# --- broken exports


WRONG: list[tuple[tuple[Any, ...], Any, str, str]] = [
    (("metagraph",), FORMAT + 1, "$.metagraph", "Update Metagraph"),
    (("joints",), [], "$.joints", ""),
    (("joints", 1, "parent"), "nobody", "$.joints[1].parent", ""),
    (("joints", 1, "translation"), [0, 1], "$.joints[1].translation", ""),
    (("joints", 1, "translation"), [0, 1, 1e300], "$.joints[1].translation[2]", ""),
    (("joints", 1, "rotation"), [0, 0, 0, 0], "$.joints[1].rotation", ""),
    (("joints", 1, "part"), "tail", "$.joints[1].part", ""),
    (("layers",), {}, "$.layers", ""),
    (("layers", "legs"), {}, "key` in `$.layers", ""),
    (("layers", "arms", "actions", 0, "kind"), "dance", "$.layers[...].actions[0].kind", ""),
    (("layers", "arms", "actions", 0, "likelihood"), 0, "$.layers[...].actions[0].likelihood", ""),
    (("layers", "arms", "actions", 1, "id"), "a5", "$.layers.arms.actions[1].id", ""),
    (("layers", "arms", "actions", 0, "speed"), 1, "$.layers[...].actions[0]", ""),
    (("layers", "arms", "stances"), [{"id": "s", "name": "x"}] * 2, "$.layers.arms.stances[1].id", ""),
    (("layers", "arms", "own_weights"), ["face", "legs"], "", ""),
    (("layers", "arms", "weights"), {}, "", ""),
    (("layers", "arms", "markov", "matrix"), [[1]], "$.layers.arms.markov.matrix", ""),
    (("layers", "arms", "markov", "matrix", 0, 0), 0.9, "$.layers.arms.markov.matrix[0]", ""),
    (("layers", "arms", "markov", "tags"), ["positive"], "$.layers.arms.markov.tags", ""),
    (("layers", "arms", "markov", "lengths"), [[1, 1]], "$.layers.arms.markov.lengths", ""),
    (("layers", "arms", "markov", "lengths"), [[1], [1]], "$.layers[...].markov.lengths[0]", ""),
    (("clips", 0, "animation"), 99, "$.clips[0].animation", ""),
    (("clips", 0, "fps"), 0, "$.clips[0].fps", ""),
    (("clips", 1, "id"), "c1", "$.clips[1].id", ""),
    (("planner", "seed"), -1, "$.planner.seed", ""),
    (("glb",), "../x.glb", "$.glb", ""),
    (("base", "frame"), -1, "$.base.frame", ""),
    (("name",), None, "$.name", ""),
]


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Path:
    project = edits.set_markov(
        small(), Markov("arms", (("both", "gesture"), ("both", "fidget")), ((0.5, 0.5), (1.0, 0.0)))
    )
    return export_project(
        edits.set_weight(project, "arms", "face", 0.5), tmp_path_factory.mktemp("plain")
    ).json


@pytest.mark.parametrize(
    ("where", "value", "path", "remedy"),
    WRONG,
    ids=lambda x: ".".join(map(str, x)) if isinstance(x, tuple) else "",
)
def test_a_wrong_field_is_named_by_its_path(
    plain: Path, where: tuple[Any, ...], value: Any, path: str, remedy: str
) -> None:
    document = json.loads(plain.read_bytes())
    inside = document
    for key in where[:-1]:
        inside = inside[key]
    inside[where[-1]] = value
    if where[-1] == "own_weights":
        document["layers"]["arms"]["weights"].pop("legs")
        path = "$.layers.arms.own_weights"
    elif where[-1] == "weights":
        path = "$.layers.arms.own_weights"
    broken = plain.with_name("broken.json")
    broken.write_text(json.dumps(document))
    with pytest.raises(FileError) as caught:
        read_export(broken)
    assert caught.value.where == path
    assert caught.value.cause
    assert remedy in caught.value.remedy and caught.value.remedy


@pytest.mark.parametrize(
    "content", [b"", b"{", b"[]", b"null", b"\xff\xfe", b"[" * 100_000, b'{"metagraph": 1}', b"glTF"]
)
def test_other_files_are_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "x.json").write_bytes(content)
    with pytest.raises(FileError) as caught:
        read_export(tmp_path / "x.json")
    assert caught.value.where and caught.value.remedy


def test_a_file_that_is_not_there_and_a_glb_that_is_not_there_are_told(plain: Path, tmp_path: Path) -> None:
    with pytest.raises(FileError, match="cannot be read"):
        read_export(tmp_path / "none.json")
    alone = tmp_path / plain.name
    shutil.copy(plain, alone)
    with pytest.raises(FileError, match=r"\.glb"):
        read_export(alone)
    assert read_export(alone, motions=False).clips["c1"].motion is None


JUNK = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-3, 10**20),
    st.floats(allow_nan=False, allow_infinity=False),
    st.text(max_size=4),
    st.just([]),
    st.just({}),
    st.just([[]]),
)


@pytest.mark.nightly
@settings(
    max_examples=many(80, 1000), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(st.randoms(use_true_random=False), JUNK)
def test_whatever_stands_in_a_field_an_export_is_read_or_refused(
    plain: Path, chance: random.Random, junk: Any
) -> None:
    document: Any = copy.deepcopy(json.loads(plain.read_bytes()))
    inside = document
    while True:
        key = chance.choice(list(inside) if isinstance(inside, dict) else list(range(len(inside))))
        if isinstance(inside[key], dict | list) and inside[key] and chance.random() < 0.85:
            inside = inside[key]
            continue
        inside[key] = junk
        break
    broken = plain.with_name("junk.json")
    broken.write_text(json.dumps(document))
    try:
        project = read_export(broken, motions=False)
    except FileError as error:
        assert error.where and error.cause and error.remedy
    else:
        check_project(project)


# --- clips made by others


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("folder", "pattern", "idle", "gestures"),
    [
        ("bandai-namco-1", "", 0, 6),
        ("sumerian-hosts", "alien", 0, 6),
        ("kaykit-rogue", "", 0, 6),
    ],
)
def test_projects_of_real_clips_are_exported_and_validate(
    shared_data: Path, tmp_path: Path, folder: str, pattern: str, idle: int, gestures: int
) -> None:
    files = [p for p in gather([shared_data / folder]) if pattern in p.as_posix()]
    project = import_files(Project(folder), None, files).into(Project(folder))
    exported_and_valid(project, list(project.clips), tmp_path, idle, gestures)


@pytest.mark.nightly
def test_a_project_of_the_zoo_is_exported_and_validates(zoo_files: dict[str, Path], tmp_path: Path) -> None:
    """Everybody comes onto the first one's skeleton."""
    project = import_files(Project("zoo"), None, [zoo_files["mixamo"]]).into(Project("zoo"))
    others = [path for name, path in zoo_files.items() if name != "mixamo"]
    project = import_files(project, None, others, retarget="yes").into(project)
    assert len(project.clips) == 2 * 1 + 3 * 5
    exported_and_valid(project, list(project.clips), tmp_path, 0, 6)


def exported_and_valid(project: Project, ids: list[str], tmp_path: Path, idle: int, gestures: int) -> None:
    project = edits.add_stance(project, "body", "rest", [ids[idle]])
    project = edits.add_stance(project, "body", "other", [ids[idle + 1]])
    stances = list(project.graphs["body"].stances)
    project = edits.place_clips(project, ids[2 : 2 + gestures], "body", "gesture", stances[0])
    project = edits.place_clips(project, ids[10:11], "body", "transition", stances[0], stances[1])
    made = export_project(project, tmp_path, expanded=True)
    valid(json.loads(made.json.read_bytes()))
    back = read_export(made.json)
    same(back, project)
    assert all(e.motion is not None and e.motion.skeleton == project.skeleton for e in back.clips.values())
    assert len(gltf(made.glb)["animations"]) == 3 + gestures
    khronos(made.glb)


def test_stresses_of_a_voice_come_back_however_near_each_other() -> None:
    """A conversation's are the peaks of its clauses: blinks would come elsewhere without some of them."""
    spoken = replace(make_silent_voice(4.0), stresses=np.array([0.5, 1.2, 3.0]))
    project = Project(lines={"said": Line(text="so")}, voices={"said": spoken})
    (back,) = read_voices(list_export_voices(project)).values()
    assert back.accents.tolist() == [0.5, 1.2, 3.0]


def test_the_json_is_on_one_line_unless_people_are_to_read_it(tmp_path: Path) -> None:
    plain = registry.write_for_target(small(), "metagraph", tmp_path / "plain").files[0]
    pretty = registry.write_for_target(
        small(), "metagraph", tmp_path / "pretty", Contents(pretty=True)
    ).files[0]
    assert plain.read_text("utf-8").count("\n") == 1
    assert pretty.read_text("utf-8").count("\n") > 100
    assert json.loads(plain.read_bytes()) == json.loads(pretty.read_bytes())
