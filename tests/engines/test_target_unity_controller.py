"""Unity's text assets. There is no Unity here: what is checked is that the files are whole, that all they
refer to is there, and that they say what the machine says.
"""

from __future__ import annotations

import re
import tarfile
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from numpy.typing import NDArray

from metagraph.engines.engine_machine import EngineState, Machine, list_machines, make_animations
from metagraph.engines.targets.target import Contents, ExportedFiles, ExportOrder
from metagraph.engines.targets.unity_controller import TARGETS
from metagraph.engines.targets.unity_yaml import format_yaml_text
from metagraph.graph import edits
from metagraph.graph.expand import find_end_stance
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton
from metagraph.playback.planner import make_plan
from tests.posing import pose_at

Array = NDArray[Any]
MIRROR = {4: np.array([1, -1, -1, 1]), 3: np.array([-1, 1, 1])}
(TARGET,) = TARGETS


class Loader(getattr(yaml, "CBaseLoader", yaml.BaseLoader)):  # type: ignore[misc]
    """Reads every scalar as text, as Unity, which knows each field's type."""


Loader.add_multi_constructor(
    "tag:unity3d.com,2011:", lambda loader, klass, node: (klass, loader.construct_mapping(node, deep=True))
)


KEY = r"      - serializedVersion: 2\n"
ALL_BUT_LAST = re.compile(rf"(?:{KEY}(?:        .*\n)+)+(?={KEY})")


class Objects(dict[str, tuple[str, dict[str, Any]]]):
    """The objects of a file: id -> class and fields."""

    def __init__(self, path: Path, ends: bool = False) -> None:
        """ends: of curves only the last keys, which is read many times as fast."""
        words = path.read_text("utf-8")
        head, *documents = re.split(
            r"^--- ", ALL_BUT_LAST.sub("", words) if ends else words, flags=re.MULTILINE
        )
        assert head == "%YAML 1.1\n%TAG !u! tag:unity3d.com,2011:\n"
        for document in documents:
            match = re.match(r"!u!(\d+) &(\d+)\n", document)
            assert match is not None and match[2] not in self
            klass, fields = yaml.load(f"{head}--- {document}", Loader)
            assert klass == match[1] and len(fields) == 1
            self[match[2]] = klass, next(iter(fields.values()))

    def of(self, klass: int) -> list[dict[str, Any]]:
        return [fields for kind, fields in self.values() if kind == str(klass)]

    def at(self, reference: dict[str, str]) -> dict[str, Any]:
        return self[reference["fileID"]][1]


def write(project: Project, folder: Path, stem: str = "talk", body: Path | None = None) -> ExportedFiles:
    made = TARGET.write(ExportOrder(project, folder, stem, Contents(body)))
    return ExportedFiles(
        (*made.files, *unpack(folder / f"{stem}.unitypackage", folder / "unpacked")), made.notes
    )


def unpack(package: Path, folder: Path) -> list[Path]:
    """Put the assets of a package where Unity would, as far as their names; return them and their `.meta`."""
    folder.mkdir()
    with tarfile.open(package) as archive:
        parts = {entry.name: archive.extractfile(entry).read() for entry in archive}  # type: ignore[union-attr]
    out = []
    for guid in dict.fromkeys(name.split("/")[0] for name in parts):
        path = folder / Path(parts[f"{guid}/pathname"].decode()).name
        assert not path.exists() and f"guid: {guid}\n" in parts[f"{guid}/asset.meta"].decode()
        for end, part in (("", "asset"), (".meta", "asset.meta")):
            out.append(path.with_name(path.name + end))
            out[-1].write_bytes(parts[f"{guid}/{part}"])
    return out


@pytest.fixture(scope="module")
def made(sample: Project, tmp_path_factory: pytest.TempPathFactory) -> ExportedFiles:
    return write(sample, tmp_path_factory.mktemp("unity"))


@pytest.fixture(scope="module")
def controller(made: ExportedFiles) -> Objects:
    return Objects(named(made, ".controller"))


def named(made: ExportedFiles, ending: str) -> Path:
    return next(path for path in made.files if path.name.endswith(ending))


def guids(made: ExportedFiles) -> dict[str, Path]:
    """The guid in each `.meta` -> its file."""
    found = {
        re.findall(r"^guid: (\w{32})$", p.read_text(), re.M)[0]: p.with_suffix("")
        for p in made.files
        if p.suffix == ".meta"
    }
    assert len(found) == sum(p.suffix == ".meta" for p in made.files)
    return found


def states_of(controller: Objects, layer: str) -> dict[str, dict[str, Any]]:
    return {
        state["m_Name"]: state
        for within in subs_of(controller, layer)
        for state in (controller.at(child["m_State"]) for child in within["m_ChildStates"])
    }


def subs_of(controller: Objects, layer: str) -> list[dict[str, Any]]:
    """The sub-state machines of a layer; the layer's own where it has none."""
    found = next(fields for fields in controller.of(1107) if fields["m_Name"] == layer)
    return [controller.at(child["m_StateMachine"]) for child in found["m_ChildStateMachines"]] or [found]


def motion_of(made: ExportedFiles, state: dict[str, Any], ends: bool = False) -> dict[str, Any]:
    (fields,) = Objects(guids(made)[state["m_Motion"]["guid"]], ends).of(74)
    return fields


def evaluated(curves: list[dict[str, Any]], times: Array) -> dict[str, Array]:
    """Path -> a curve at some times, mirrored back; cubics between keys, clamped, as Unity has them."""
    out = {}
    for one in curves:
        keys = one["curve"]["m_Curve"]
        at = np.array([float(key["time"]) for key in keys])
        values, into, away = (
            np.array([[float(v) for v in key[f].values()] for key in keys])
            for f in ("value", "inSlope", "outSlope")
        )
        assert (np.diff(at) > 0).all()
        low = np.clip(np.searchsorted(at, times, side="right") - 1, 0, max(0, len(at) - 2))
        high = np.minimum(low + 1, len(at) - 1)
        long = np.maximum(at[high] - at[low], 1e-9)[:, None]
        u = np.clip((times - at[low])[:, None] / long, 0, 1)
        value = (2 * u**3 - 3 * u**2 + 1) * values[low] + (3 * u**2 - 2 * u**3) * values[high]
        value = value + ((u**3 - 2 * u**2 + u) * away[low] + (u**3 - u**2) * into[high]) * long
        assert one["path"] not in out
        out[one["path"]] = value * MIRROR[value.shape[1]]
    return out


def paths(skeleton: Skeleton) -> dict[str, str]:
    """Joint -> its path."""
    return {
        name: "/".join(skeleton.names[at] for at in skeleton.chain(j))
        for j, name in enumerate(skeleton.names)
    }


# --- whole files


@pytest.mark.nightly
def test_every_file_has_a_meta_of_its_kind_and_all_there_is_is_said(made: ExportedFiles) -> None:
    folder = made.files[0].parent
    assert {*folder.iterdir(), *(folder / "unpacked").iterdir()} - {folder / "unpacked"} == {*made.files}
    assert sum(path.stat().st_size for path in folder.iterdir() if path.is_file()) < 8e6
    kinds = {".anim": 7400000, ".controller": 9100000, ".mask": 31900000}
    for path in made.files:
        if path.suffix in kinds:
            assert (
                f"NativeFormatImporter:\n  externalObjects: {{}}\n  mainObjectFileID: {kinds[path.suffix]}\n"
                in (path.with_name(path.name + ".meta").read_text())
            )
            assert f"--- !u!{kinds[path.suffix] // 100000} &{kinds[path.suffix]}\n" in path.read_text()
            assert (
                f"\n  m_Name: {path.stem}\n" in path.read_text()
            )  # Unity wants assets called as their files are


@pytest.mark.nightly
def test_whatever_is_referred_to_is_there(made: ExportedFiles, controller: Objects) -> None:
    known = guids(made)
    for path in (p for p in made.files if p.parent.name == "unpacked"):
        words = path.read_text()
        if path.suffix in (".controller", ".mask", ".anim"):
            for ident, guid in re.findall(r"\{fileID: (\d+)(?:, guid: (\w+), type: 2)?\}", words):
                if guid:
                    assert f" &{ident}\n" in known[guid].read_text()[:200]
                else:
                    assert ident == "0" or f" &{ident}\n" in words
        assert words.count("guid: ") == len(re.findall(r"guid: [0-9a-f]{32}\b", words))
    assert "0" not in controller


@pytest.mark.nightly
def test_two_exports_are_equal_to_the_byte(sample: Project, made: ExportedFiles, tmp_path: Path) -> None:
    again = write(sample, tmp_path)
    assert [p.name for p in again.files] == [p.name for p in made.files]
    assert all(a.read_bytes() == b.read_bytes() for a, b in zip(again.files, made.files, strict=True))


@pytest.mark.nightly
def test_there_is_a_clip_for_each_state_and_one_of_the_base_pose_and_they_are_small(
    sample: Project, made: ExportedFiles
) -> None:
    clips = [path for path in made.files if path.suffix == ".anim"]
    assert len(clips) == sum(len(machine.states) for machine in list_machines(sample)) + 1
    assert sum(path.stat().st_size for path in clips) / len(clips) < 0.15e6


# --- the machine


def test_layers_have_parameters_masks_and_ways_to_blend(
    sample: Project, made: ExportedFiles, controller: Objects
) -> None:
    (whole,) = controller.of(91)
    found = {p["m_Name"]: p["m_Type"] for p in whole["m_AnimatorParameters"]}
    layers = ("body", "arms", "head")
    assert found == {
        f"{la}_{w}": t for la in layers for w, t in (("stance", "3"), ("action", "3"), ("play", "9"))
    }
    assert [(la["m_Name"], la["m_BlendingMode"]) for la in whole["m_AnimatorLayers"]] == [
        ("base", "0"), ("body", "0"), ("arms", "1"), ("head", "1"),
    ]  # fmt: skip
    known = guids(made)
    for layer, machine in zip(whole["m_AnimatorLayers"][1:], list_machines(sample), strict=True):
        assert known[layer["m_Mask"]["guid"]].name == f"{machine.layer}.mask"
        assert layer["m_DefaultWeight"] == "1"
        start = controller.at(controller.at(layer["m_StateMachine"])["m_DefaultState"])
        assert start["m_Name"] == machine.start.name


class Animator:
    """What Unity does at the exit of a state, as its manual has it: the first transition whose conditions hold."""

    def __init__(self, controller: Objects, layer: str) -> None:
        self.controller, self.states = controller, states_of(controller, layer)

    def holds(self, transition: dict[str, Any], numbers: dict[str, int], pulled: bool) -> bool:
        for one in transition["m_Conditions"]:
            value, mode = int(one["m_EventTreshold"]), int(one["m_ConditionMode"])
            here = numbers.get(one["m_ConditionEvent"], 0)
            if not {1: pulled, 6: here == value, 7: here != value}[mode]:
                return False
        return True

    def goes(self, name: str, numbers: dict[str, int], pulled: bool) -> tuple[str, float | None] | None:
        """Return where a state goes, and at which share of it; None if it stays."""
        for one in map(self.controller.at, self.states[name]["m_Transitions"]):
            if self.holds(one, numbers, pulled):
                exits = float(one["m_ExitTime"]) if one["m_HasExitTime"] == "1" else None
                return self.entered(one, numbers, pulled), exits
        return None

    def entered(self, transition: dict[str, Any], numbers: dict[str, int], pulled: bool) -> str:
        if transition["m_DstState"]["fileID"] != "0":
            return str(self.controller.at(transition["m_DstState"])["m_Name"])
        within = self.controller.at(transition["m_DstStateMachine"])
        for one in map(self.controller.at, within["m_EntryTransitions"]):
            if self.holds(one, numbers, pulled):
                return self.entered(one, numbers, pulled)
        return str(self.controller.at(within["m_DefaultState"])["m_Name"])


def test_every_request_leads_where_the_machine_says_and_no_earlier(
    sample: Project, made: ExportedFiles, controller: Objects
) -> None:
    built = list_machines(sample)
    seconds = {clip.name: clip.duration for clip in make_animations(sample, built)}
    assert len(controller.of(1102)) == len(seconds) + 1  # with the base pose
    for machine in built:
        assert {*states_of(controller, machine.layer)} == {state.name for state in machine.states}
        animator = Animator(controller, machine.layer)
        for arrow in machine.arrows:
            name = arrow.source.name
            numbers = {f"{machine.layer}_stance": machine.stances[str(find_end_stance(arrow.source.action))]}
            for value in arrow.values or (0,):
                if arrow.on != "done":
                    numbers[f"{machine.layer}_{arrow.on}"] = value
                found = animator.goes(name, numbers, arrow.on == "action")
                assert found is not None and found[0] == arrow.target.name, (name, arrow)
                least = (arrow.leave or 0.0) / seconds[name]
                assert (found[1] or 0.0) >= least - 2e-5 and (found[1] is None) == arrow.source.loop


def test_stances_are_sub_state_machines_with_few_transitions(
    sample: Project, made: ExportedFiles, controller: Objects
) -> None:
    """One to each other state would be 2828, and as many as there are pairs."""
    assert len(controller.of(1101)) + len(controller.of(1109)) < 850
    for machine in list_machines(sample):
        subs = subs_of(controller, machine.layer)
        assert [sub["m_Name"] for sub in subs] == [machine.graph.stances[s].name for s in machine.stances]
        for stance, sub in zip(machine.stances, subs, strict=True):
            within = [controller.at(child["m_State"])["m_Name"] for child in sub["m_ChildStates"]]
            assert within == [s.name for s in machine.states if s.action.stance == stance]
            assert controller.at(sub["m_DefaultState"])["m_Name"] == machine.rest(stance).name


def test_a_state_that_nothing_is_asked_of_ends_in_the_loop_of_its_stance_and_a_loop_stays(
    sample: Project, controller: Objects
) -> None:
    for machine in list_machines(sample):
        animator = Animator(controller, machine.layer)
        for state in machine.states:
            end = str(find_end_stance(state.action))
            found = animator.goes(state.name, {f"{machine.layer}_stance": machine.stances[end]}, False)
            assert (
                (found is None) if state.loop else (found is not None and found[0] == machine.rest(end).name)
            )


def test_an_action_that_ends_while_it_blends_in_is_left_all_the_same(toy: Any, tmp_path: Path) -> None:
    project = toy.project()
    short = toy.id(project, "rest short")
    timing = next(a.timing for a in project.actions() if a.id == short)
    project = edits.update_actions(project, [short], timing=replace(timing, blend_in=0.5, blend_out=0.5))
    write(project, tmp_path)
    controller = Objects(tmp_path / "unpacked" / "talk.controller")
    state = states_of(controller, "arms")["arms_rest_short"]
    (back,) = (one for one in map(controller.at, state["m_Transitions"]) if not one["m_Conditions"])
    assert float(back["m_ExitTime"]) * 0.6 > 0.5


# --- masks and clips


def test_masks_list_every_joint_once_and_have_those_of_the_layer_on(
    sample: Project, made: ExportedFiles
) -> None:
    assert sample.skeleton is not None
    path = paths(sample.skeleton)
    for machine in list_machines(sample):
        (fields,) = Objects(named(made, f"{machine.layer}.mask")).of(319)
        assert fields["m_Mask"] == "01000000" * 13
        root, *rows = ((row["m_Path"], row["m_Weight"]) for row in fields["m_Elements"])
        assert root == ("", "1")
        assert Counter(p for p, _ in rows) == Counter(path.values())
        assert {p for p, weight in rows if weight == "1"} == {path[joint] for joint in machine.joints}


def pairs(project: Project) -> list[tuple[Machine, EngineState, Clip]]:
    built = list_machines(project)
    states = [(machine, state) for machine in built for state in machine.states]
    return [(m, s, clip) for (m, s), clip in zip(states, make_animations(project, built), strict=True)]


@pytest.mark.nightly
def test_curves_mirrored_back_are_the_machines_clips(
    sample: Project, made: ExportedFiles, controller: Objects
) -> None:
    skeleton = sample.skeleton
    assert skeleton is not None
    path = paths(skeleton)
    for machine, state, clip in pairs(sample)[::7]:
        fields = motion_of(made, states_of(controller, machine.layer)[state.name])
        times = np.linspace(0, clip.duration, 37)
        pose = clip.pose_at(times)
        turns = evaluated(fields["m_RotationCurves"], times)
        assert {*turns} == {path[joint] for joint in machine.joints}
        for joint in machine.joints:
            there = rotation.normalize(turns[path[joint]])
            assert (
                np.degrees(
                    rotation.measure_angle_between(there, pose.rotations[:, skeleton.index(joint)])
                ).max()
                < 0.1
            ), (state.name, joint)
        for joint, shift in evaluated(fields["m_PositionCurves"], times).items():
            place = skeleton.index(joint.split("/")[-1])
            assert np.abs(shift - pose.translations[:, place]).max() < 0.001
        assert (path["Hips"] in {c["path"] for c in fields["m_PositionCurves"]}) == ("Hips" in machine.joints)


@pytest.mark.nightly
def test_clips_have_their_lengths_loop_where_they_loop_and_are_additive_to_the_base_pose(
    sample: Project, made: ExportedFiles, controller: Objects
) -> None:
    known = guids(made)
    for machine, state, clip in pairs(sample)[::3]:
        fields = motion_of(made, states_of(controller, machine.layer)[state.name], ends=True)
        settings = fields["m_AnimationClipSettings"]
        assert settings["m_LoopTime"] == str(int(state.loop)) and fields["m_Legacy"] == "0"
        assert float(settings["m_StopTime"]) == pytest.approx(clip.duration, abs=1e-5)
        ends = {one["curve"]["m_Curve"][-1]["time"] for one in fields["m_RotationCurves"]}
        assert max(map(float, ends)) == pytest.approx(clip.duration, abs=1e-5)
        bound = fields["m_ClipBindingConstant"]["genericBindings"]
        assert len(bound) == len(fields["m_RotationCurves"]) + len(fields["m_PositionCurves"])
        assert (settings["m_HasAdditiveReferencePose"] == "1") == (machine.layer != "body")
        if machine.layer != "body":
            assert known[settings["m_AdditiveReferencePoseClip"]["guid"]].name == "base.anim"


def test_layers_put_together_as_unity_does_are_the_previews_pose(
    sample: Project, made: ExportedFiles, controller: Objects
) -> None:
    skeleton, at = sample.skeleton, np.array([1.0])
    assert skeleton is not None
    joint = {path: name for name, path in paths(skeleton).items()}

    def pose(layer: str, name: str) -> tuple[dict[str, Array], dict[str, Array]]:
        fields = motion_of(made, states_of(controller, layer)[name])
        turns, shifts = (evaluated(fields[f"m_{kind}Curves"], at) for kind in ("Rotation", "Position"))
        return {joint[p]: q[0] for p, q in turns.items()}, {joint[p]: t[0] for p, t in shifts.items()}

    base, moved = pose("base", "base")
    assert {*base} == {*skeleton.names}
    turns, shifts = dict(base), dict(moved)
    for machine in list_machines(sample):
        own, shifted = pose(machine.layer, machine.start.name)
        for name, q in own.items():
            apart = rotation.multiply(rotation.conjugate(base[name]), q)
            turns[name] = q if machine.layer == "body" else rotation.multiply(turns[name], apart)
        for name, t in shifted.items():
            shifts[name] = t if machine.layer == "body" else shifts[name] + t - moved[name]
    rotations = rotation.normalize(np.stack([turns[name] for name in skeleton.names]))
    translations = np.stack(
        [shifts.get(name, skeleton.rest_translations[j]) for j, name in enumerate(skeleton.names)]
    )
    wanted = pose_at(make_plan(sample, 5.0, idle=False), sample, 1.0, alive=False)
    _, mine = skeleton.globals(replace(wanted, rotations=rotations, translations=translations))
    _, theirs = skeleton.globals(wanted)
    assert np.linalg.norm(mine - theirs, axis=1).max() < 0.003


# --- names


@pytest.mark.parametrize(
    "name",
    [
        "plain",
        "",
        "two words",
        'a "quoted" one',
        "it's",
        "a: b",
        "mixamorig:Hips",
        "- dash",
        "# no",
        "é ß",
        "手",
        "🙂",
        "a\nb",
        "{x}",
    ],
)
def test_names_survive_yaml(name: str) -> None:
    assert yaml.load(f"m_Name: {format_yaml_text(name)}\nm_Next: 1", Loader) == {
        "m_Name": name,
        "m_Next": "1",
    }
    assert yaml.load(f"- m_Path: {format_yaml_text(name)}\n  m_Weight: 1", Loader)[0]["m_Path"] == name
    assert format_yaml_text(name).isascii() and "\n" not in format_yaml_text(name)


def test_joints_of_any_name_are_found_by_path(toy: Any, tmp_path: Path) -> None:
    skeleton = toy.skeleton
    odd = tuple(f"rig:{name} “é” #{j}: 'x'" for j, name in enumerate(skeleton.names))
    renamed = Skeleton(odd, skeleton.parents, skeleton.rest_rotations, skeleton.rest_translations)
    project = edits.add_clips(
        Project('odd "name": é'), [("a.glb", 0, "", replace(toy.clip("rest loop"), skeleton=renamed))]
    )
    clip = next(iter(project.clips))
    project = edits.set_base(edits.add_stance(project, "arms", "rest: 'é'", [clip]), clip)
    made = write(project, tmp_path, "naïve_talk")
    (fields,) = Objects(named(made, "arms.mask")).of(319)
    assert {row["m_Path"] for row in fields["m_Elements"]} == {"", *paths(renamed).values()}
    (whole,) = Objects(named(made, ".controller")).of(91)
    assert whole["m_Name"] == "naïve_talk" and "rest: 'é'" in named(made, ".md").read_text("utf-8")


def test_clips_whose_names_differ_by_case_alone_have_files_of_their_own(toy: Any, tmp_path: Path) -> None:
    project = toy.project()
    for name, new in (("rest short", "wave"), ("rest long", "Wave")):
        project = edits.update_actions(project, [toy.id(project, name)], name=new)
    made = write(project, tmp_path)
    names = [path.name.lower() for path in made.files]
    assert len({*names}) == len(names)
    states = states_of(Objects(tmp_path / "unpacked" / "talk.controller"), "arms")
    assert states["arms_wave"]["m_Motion"]["guid"] != states["arms_Wave"]["m_Motion"]["guid"]


def test_the_mesh_goes_along_where_there_is_one(sample: Project, tmp_path: Path) -> None:
    few = edits.remove_actions(sample, [a.id for a in sample.actions() if a.kind != "stance"])
    made = write(few, tmp_path, body=Path(__file__).parents[2] / "sample_clips" / "mannequin.glb")
    assert (tmp_path / "talk.glb") in made.files and not made.notes
