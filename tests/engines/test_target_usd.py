"""USD: what is written by hand is read back by Pixar's own library, equal to the clips and to our skinning."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.engines.targets import registry
from metagraph.engines.targets.target import Contents
from metagraph.formats.gltf.reader import read_character, read_gltf_clips
from metagraph.formats.usd import usda
from metagraph.formats.usd.writer import list_joint_paths, write_usd
from metagraph.graph.edits import add_clips, add_stance, place_clips, update_actions
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton

SAMPLES = Path(__file__).parents[2] / "sample_clips"
STRANGE = 'Überraschung "7" \\ 挨拶\n{now}'
WHY = "needs Pixar's USD (pip install usd-core)"


@pytest.fixture(scope="module")
def ada() -> CharacterMesh:
    return read_character(SAMPLES / "ada.glb")


@pytest.fixture(scope="module")
def still(ada: CharacterMesh) -> Clip:
    """Ten frames in which everything turns and smiles a little, at a rate that is not the usual one."""
    [clip] = read_gltf_clips(SAMPLES / "clips" / "hands_at_sides__stance.glb")
    clip, t = clip.trimmed(0, 10), np.linspace(0, 1, 10)
    bend = rotation.from_axis_angle(np.array([0.3, 0.5, 0.8]), t * 0.9)[:, None]
    return replace(
        clip,
        skeleton=ada.skeleton,
        fps=24.0,
        rotations=rotation.make_continuous(rotation.multiply(clip.rotations, bend)),
        morphs=("jawOpen", "nobody's"),
        weights=np.stack([t, 1 - t], 1),
    )


@pytest.fixture(scope="module")
def project(still: Clip) -> Project:
    [wave] = read_gltf_clips(SAMPLES / "clips" / "hands_at_sides__stance.glb")
    made = add_clips(
        Project(name="Somebody"), [("a.glb", 0, "", still), ("b.glb", 0, "", wave.renamed(STRANGE))]
    )
    first, second = made.clips
    made = add_stance(made, "arms", "rest", [first])
    made = add_stance(made, "arms", "rest!", [second])
    stance, other = made.graphs["arms"].stances
    made = place_clips(made, [second], "arms", "gesture", stance)
    made = place_clips(made, [first], "arms", "transition", stance, other)
    [gesture] = made.graphs["arms"].of(stance, "gesture")
    weights = (("LeftHand", 0.5), ("RightHand", 0.25))
    return update_actions(made, [gesture.id], name=STRANGE, tags=("greeting", STRANGE), joint_weights=weights)


@pytest.fixture(scope="module")
def written(project: Project, tmp_path_factory: pytest.TempPathFactory) -> Path:
    report = registry.write_for_target(
        project, "usd", tmp_path_factory.mktemp("usd"), Contents(SAMPLES / "ada.glb")
    )
    return report.files[0]


def opened(path: Path) -> Any:
    usd = pytest.importorskip("pxr.Usd", reason=WHY)
    stage = usd.Stage.Open(str(path))
    assert not stage.GetCompositionErrors()
    return stage


def skinned(body: CharacterMesh, clip: Clip, frame: int) -> Any:
    """Return where the mesh is, `[V, 3]`, by the rule that the preview draws by."""
    points = body.positions.astype(float)
    if body.morph_positions is not None and clip.weights is not None:
        for name, weight in zip(clip.morphs, clip.weights[frame], strict=True):
            if name in body.morphs:
                points = points + weight * body.morph_positions[body.morphs.index(name)]
    turns, places = body.skeleton.globals(clip.poses()[frame])
    rest_r, rest_p = body.skeleton.globals(body.skeleton.rest)
    way = rotation.multiply(turns, rotation.conjugate(rest_r))
    shift = places - rotation.rotate_vectors(way, rest_p)
    each = rotation.rotate_vectors(way[body.joints], points[:, None]) + shift[body.joints]
    return (body.weights[..., None] * each).sum(1) / body.weights.sum(1)[:, None]


def test_clips_read_back_equal_whatever_their_rate(project: Project, written: Path) -> None:
    stage = opened(written)
    assert (stage.GetMetadata("upAxis"), stage.GetMetadata("metersPerUnit")) == ("Y", 1.0)
    rate = stage.GetTimeCodesPerSecond()
    prims = stage.GetPrimAtPath("/Character/Clips").GetChildren()
    motions = [entry.motion for entry in project.clips.values() if entry.motion is not None]
    assert [p.GetTypeName() for p in prims] == ["SkelAnimation"] * len(motions)
    worst = 0.0
    for prim, clip in zip(prims, motions, strict=True):
        assert prim.GetAttribute("metagraph:fps").Get() == clip.fps
        turns, places = prim.GetAttribute("rotations"), prim.GetAttribute("translations")
        times = turns.GetTimeSamples()
        assert np.allclose(np.array(times) / rate, np.arange(clip.frames) / clip.fps, atol=1e-6)
        for time, frame in zip(times, range(clip.frames), strict=True):
            read = np.array([[*q.GetImaginary(), q.GetReal()] for q in turns.Get(time)])
            worst = max(worst, float(np.abs(read - clip.rotations[frame]).max()))
            moved = np.array(places.Get(time)) - clip.poses().translations[frame]
            worst = max(worst, float(np.abs(moved).max()))
    assert worst < 5e-7
    assert prims[1].GetMetadata("displayName") == STRANGE
    [smile] = [p for p in prims if p.GetAttribute("blendShapes").Get()]
    assert list(smile.GetAttribute("blendShapes").Get()) == ["jawOpen", "nobody's"]
    assert smile.GetAttribute("blendShapeWeights").Get(times[-1])[0] == pytest.approx(1)


def test_the_skinned_mesh_is_where_the_preview_draws_it(
    ada: CharacterMesh, still: Clip, written: Path
) -> None:
    stage = opened(written)
    from pxr import Usd, UsdGeom, UsdSkel

    cache, root = UsdSkel.Cache(), UsdSkel.Root(stage.GetDefaultPrim())
    assert cache.Populate(root, Usd.PrimDefaultPredicate)
    [binding] = cache.ComputeSkelBindings(root, Usd.PrimDefaultPredicate)
    [target] = binding.GetSkinningTargets()
    query = cache.GetSkelQuery(binding.GetSkeleton())
    assert query and query.HasBindPose() and query.HasRestPose()
    assert UsdSkel.Topology(query.GetJointOrder()).Validate()[0]
    assert list(query.GetSkeleton().GetJointNamesAttr().Get()) == list(ada.skeleton.names)
    mesh = UsdGeom.Mesh(target.GetPrim())
    valid, why = UsdGeom.Mesh.ValidateTopology(
        mesh.GetFaceVertexIndicesAttr().Get(), mesh.GetFaceVertexCountsAttr().Get(), len(ada.positions)
    )
    assert valid, why
    shapes = UsdSkel.BlendShapeQuery(UsdSkel.BindingAPI(target.GetPrim()))
    time = stage.GetTimeCodesPerSecond() * 9 / still.fps
    animation = query.GetAnimQuery()
    held = dict(zip(animation.GetBlendShapeOrder(), animation.ComputeBlendShapeWeights(time), strict=True))
    order = [str(name) for name in UsdSkel.BindingAPI(target.GetPrim()).GetBlendShapesAttr().Get()]
    assert order == list(ada.morphs)
    weights, indices, subs = shapes.ComputeSubShapeWeights([held.get(name, 0.0) for name in order])
    points = mesh.GetPointsAttr().Get()
    assert shapes.ComputeDeformedPoints(
        weights, indices, subs, shapes.ComputeBlendShapePointIndices(),
        shapes.ComputeSubShapePointOffsets(), points,
    )  # fmt: skip
    moves = query.ComputeSkinningTransforms(time)
    assert target.ComputeSkinnedPoints(moves, points, time)
    off = np.abs(np.array(points) - skinned(ada, still, 9)).max()
    assert off < 2e-5  # metres
    plain = np.abs(np.array(points) - skinned(ada, replace(still, morphs=(), weights=None), 9)).max()
    assert plain > 0.005  # and the face did move


def test_the_graph_stands_in_the_stage_and_leads_to_its_clips(written: Path) -> None:
    stage, said = opened(written), json.loads(written.with_suffix(".json").read_text())
    root = stage.GetDefaultPrim()
    assert root.GetCustomDataByKey("metagraph:export").path == f"./{written.stem}.json"
    for layer in said["order"]:
        own = said["layers"][layer]
        for scope, rows in (("Stances", own["stances"]), ("Actions", own["actions"])):
            prims = stage.GetPrimAtPath(f"/Character/Graph/{layer}/{scope}").GetChildren()
            assert [p.GetDisplayName() or p.GetName() for p in prims] == [row["name"] for row in rows]
            for prim, row in zip(prims, rows, strict=True):
                for key, value in row.items():
                    if key in ("clip", "stance", "end_stance") and value is not None:
                        [to] = prim.GetRelationship(f"metagraph:{key}").GetTargets()
                        assert stage.GetPrimAtPath(to)
                    elif value in (None, [], {}):
                        assert not prim.GetAttribute(f"metagraph:{key}")
                    elif isinstance(value, dict):
                        assert json.loads(prim.GetAttribute(f"metagraph:{key}").Get()) == value
                    else:
                        read = prim.GetAttribute(f"metagraph:{key}").Get()
                        assert (list(read) if isinstance(value, list) else read) == pytest.approx(value)
        ways = stage.GetPrimAtPath(f"/Character/Graph/{layer}/Transitions").GetChildren()
        assert len(ways) == len(own["transitions"])
    assert stage.GetPrimAtPath("/Character/Graph/arms/Transitions").GetChildren()
    chosen = root.GetVariantSet("clip")
    assert len(chosen.GetVariantNames()) == len(said["clips"])
    for name in chosen.GetVariantNames():
        chosen.SetVariantSelection(name)
        skeleton = stage.GetPrimAtPath("/Character/Skeleton")
        assert skeleton.GetRelationship("skel:animationSource").GetTargets()[0].name == name


def test_fields_that_say_nothing_are_left_out_and_nested_ones_are_their_json(written: Path) -> None:
    said, text = json.loads(written.with_suffix(".json").read_text()), written.read_text()
    actions = [a for layer in said["layers"].values() for a in layer["actions"]]
    weighted = [a["joint_weights"] for a in actions if a["joint_weights"]]
    assert len(actions) > len(weighted) == 1
    assert text.count("metagraph:joint_weights") == 1
    assert r"{\"LeftHand\": 0.5, \"RightHand\": 0.25}" in text


def test_names_that_are_no_identifiers_become_ones_and_none_is_twice() -> None:
    names = ("hips", "hips!", "左手", "7", STRANGE)
    rest = np.zeros((5, 3))
    turns = np.tile([0, 0, 0, 1.0], (5, 1))
    skeleton = Skeleton(names, np.array([-1, 0, 0, 2, -1]), turns, rest)
    paths = list_joint_paths(skeleton)
    assert (
        paths[:4] == ["hips", "hips/hips_", "hips/joint_358277399", "hips/joint_358277399/_7"]
        and len(set(paths)) == 5
    )
    assert all(part.isidentifier() and part.isascii() for path in paths for part in path.split("/"))
    assert usda.format_usda_string('a"\\\n\x01é') == '"a\\"\\\\\\n\\x01é"'


def test_a_skeleton_alone_and_a_clip_of_one_frame_are_stages_too(tmp_path: Path, still: Clip) -> None:
    [alone] = write_usd(tmp_path / "alone.usda", still.skeleton, [])
    [brief] = write_usd(tmp_path / "brief.usda", still.skeleton, [still.trimmed(0, 1)])
    with pytest.raises(ValueError, match="another skeleton"):
        other = Skeleton(("a",), np.array([-1]), np.array([[0, 0, 0, 1.0]]), np.zeros((1, 3)))
        write_usd(tmp_path / "no.usda", other, [still])
    assert not (tmp_path / "no.usda").exists()
    assert not opened(alone).GetPrimAtPath("/Character/Clips").GetChildren()
    from pxr import UsdSkel

    for path in (alone, brief):
        stage, cache = opened(path), UsdSkel.Cache()
        query = cache.GetSkelQuery(UsdSkel.Skeleton(stage.GetPrimAtPath("/Character/Skeleton")))
        assert query and len(query.ComputeJointLocalTransforms(0)) == len(still.skeleton)


def test_pixars_own_validators_find_no_fault(written: Path) -> None:
    stage = opened(written)
    from pxr import UsdValidation

    registry_ = UsdValidation.ValidationRegistry()
    validators = registry_.GetOrLoadAllValidators()
    assert len(validators) > 10
    found = UsdValidation.ValidationContext(validators).Validate(stage)
    told = [e.GetMessage() for e in found if e.GetType() != UsdValidation.ValidationErrorType.Info]
    assert not told


def test_the_text_holds_every_frame_where_pixars_library_is_not_at_hand(still: Clip, tmp_path: Path) -> None:
    [path] = write_usd(tmp_path / "x.usda", still.skeleton, [still])
    content = path.read_text(encoding="utf-8")
    assert content.startswith("#usda 1.0\n") and content.count("{") == content.count("}")
    [row] = re.findall(r"quatf\[\] rotations.timeSamples = \{(.*)\}", content)
    read = np.array(re.findall(r"[-.e\d]+(?=[,)])", row.replace("[", "")), float).reshape(10, -1, 4)
    assert np.abs(read - still.rotations[..., [3, 0, 1, 2]]).max() < 5e-7


@pytest.mark.nightly
def test_a_performance_is_baked_as_one_animation(tmp_path: Path) -> None:
    from app.cli.parser import main

    out = tmp_path / "show.usda"
    assert main(["render", str(SAMPLES / "sample.metagraph.yaml"), "-o", str(out), "-s", "1"]) == 0
    assert (
        main(
            ["render", str(SAMPLES / "sample.metagraph.yaml"), "-o", str(out.with_suffix(".glb")), "-s", "1"]
        )
        == 0
    )
    [clip] = read_gltf_clips(out.with_suffix(".glb"))
    stage = opened(out)
    [prim] = stage.GetPrimAtPath("/Character/Clips").GetChildren()
    turns = prim.GetAttribute("rotations")
    times = turns.GetTimeSamples()
    assert len(times) == clip.frames == 31 and stage.GetPrimAtPath("/Character/Mesh")
    read = np.array([[[*q.GetImaginary(), q.GetReal()] for q in turns.Get(t)] for t in times])
    cosines = np.abs((read * clip.rotations).sum(-1)).clip(0, 1)
    assert np.degrees(2 * np.arccos(cosines)).max() < 0.1  # the GLB's integers
