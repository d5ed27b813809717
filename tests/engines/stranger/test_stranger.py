"""docs/reference alone is enough: an evaluator written from its words, without a line of ours, poses
characters as the conformance vectors say.

`reading`, `posing`, `weighing`, `enlivening`, `drawing`, `planning` and `happening`, beside this file, are
that evaluator; each function names the heading or the bold words of the page whose rule it follows. Where a
case fails after a change of the page or the player, mend whichever is wrong; never teach the evaluator what
the page does not say.
"""

import ast
from dataclasses import replace
from pathlib import Path

import pytest

from metagraph.engines.export import write_project_files
from metagraph.engines.reading import read_export
from metagraph.engines.script import make_script_cases
from metagraph.engines.vectors import write_vectors
from metagraph.formats.imports import gather
from metagraph.graph import edits
from metagraph.graph.model import LAYERS, PARTS, Limb, Project
from tests.engines.stranger.comparing import NAMES, SHIPPED, Vectors, compared, read_vectors
from tests.engines.stranger.drawing import key32, rests_of
from tests.engines.stranger.happening import Happening, can_happen
from tests.engines.stranger.planning import can_plan, cues_of
from tests.engines.test_real_exports import project_of
from tests.thorough import some

# What must be among the poses that were compared, so that no rule goes unseen.
SEEN = {
    "stances", "a loop takes over", "a loop's seam", "blending in", "blending out", "between the blends",
    "a stretched hold", "limited to a limb", "limited to joints", "with life",
}  # fmt: skip
WEIGHT, FEET, SOFT = "the arms' weight", "planted feet", "joints that move in part"
CYCLES = "a cycle that repeats"
# Those whose life layers play.
ALIVE = (
    *(name for name in NAMES if name != "sparse"),
    *("calm", "quiet", "steady", "slow", "random1", "random2"),
)


@pytest.fixture(scope="module")
def shipped() -> dict[str, Vectors]:
    return {name: read_vectors(SHIPPED / name) for name in NAMES}


@pytest.mark.nightly
@pytest.mark.parametrize("name", NAMES)
def test_the_pages_words_pose_a_character_as_its_vectors_say(shipped: dict[str, Vectors], name: str) -> None:
    character, vectors = shipped[name]
    seen: set[str] = set()
    part = {**vectors, "cases": some(vectors["cases"], 2 if name in ("stick", "varied") else 1)}
    for plays, off in compared(character, part):
        seen |= plays
        assert {kind: off[kind] <= vectors["tolerance"][kind] for kind in off} == dict.fromkeys(off, True), (
            plays,
            off,
        )
    assert seen - {WEIGHT, SOFT} == SEEN or name in ("sparse", "stepping", "repeating")
    assert SOFT in seen or name not in ("stick", "varied", "standing", "repeating")
    assert (WEIGHT in seen) == (name in ("standing", "repeating"))
    assert (CYCLES in seen) == (name == "repeating")
    assert (FEET in seen) == (name == "stepping")


@pytest.mark.parametrize("name", NAMES)
def test_the_pages_words_say_when_a_new_loop_takes_over(shipped: dict[str, Vectors], name: str) -> None:
    character, vectors = shipped[name]
    for case in vectors["cases"]:
        if len(case["steps"]) > 1:
            continue
        for layer, plan in case["plan"]["layers"].items():
            ours = rests_of(character, layer, case)
            assert [rest[:2] for rest in ours] == [rest[:2] for rest in plan["rests"]], (case["name"], layer)
            for mine, wanted in zip(ours, plan["rests"], strict=True):
                assert mine[2:] == pytest.approx(wanted[2:], abs=vectors["tolerance"]["seconds"])


@pytest.mark.parametrize(("name", "least"), [*zip(NAMES, (49, 24, 49, 4, 0, 4), strict=True)])
def test_the_pages_words_plan_what_is_asked_once(shipped: dict[str, Vectors], name: str, least: int) -> None:
    character, vectors = shipped[name]
    planned = [case for case in vectors["cases"] if can_plan(character, case)]
    assert len(planned) >= least
    for case in planned:
        for layer, plan in case["plan"]["layers"].items():
            ours = cues_of(character, layer, case)
            assert [cue["action"] for cue in ours] == [cue["action"] for cue in plan["cues"]], case["name"]
            for mine, wanted in zip(ours, plan["cues"], strict=True):
                assert mine == {
                    key: value
                    if isinstance(value, str)
                    else pytest.approx(value, abs=vectors["tolerance"]["seconds"])
                    for key, value in wanted.items()
                }, case["name"]


@pytest.mark.parametrize(
    ("name", "least"),
    [
        pytest.param(name, least, marks=pytest.mark.nightly if least > 300 else ())
        for name, least in zip(ALIVE, (90, 93, 10, 5, 12, 5, 5, 5, 5, 320, 306), strict=True)
    ],
)
def test_the_pages_words_draw_the_events_of_life(name: str, least: int) -> None:
    character, vectors = read_vectors(SHIPPED / name)
    drawn = [case for case in vectors["cases"] if can_happen(character, case)]
    assert len(drawn) >= least
    for case in drawn:
        ours = Happening(character, case).lanes()
        assert ours.keys() == case["life"].keys(), case["name"]
        for lane, rows in ours.items():
            wanted = case["life"][lane]
            assert len(rows) == len(wanted), (case["name"], lane)
            for mine, theirs in zip(rows, wanted, strict=True):
                near = vectors["tolerance"]["seconds"]
                assert mine == [
                    value if isinstance(value, str | bool | list) else pytest.approx(value, abs=near)
                    for value in theirs
                ], (case["name"], lane)


def test_the_pages_words_hash_as_the_vectors_do(shipped: dict[str, Vectors]) -> None:
    for seed, words, wanted in shipped["stick"][1]["hashes"]:
        assert key32(seed, *words) == wanted


def test_the_stranger_knows_nothing_of_ours() -> None:
    known = {
        "bisect",
        "collections",
        "dataclasses",
        "json",
        "math",
        "numpy",
        "pathlib",
        "struct",
        "sys",
        "typing",
    }
    for path in Path(__file__).parent.glob("[!t]*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            for name in names:
                assert name.split(".")[0] in known or name.startswith("tests.engines.stranger."), path


def many_ways(project: Project) -> Project:
    """Return a project whose layers reach with weights from 0.3 to 2, whose loops have seams and whose
    actions are limited to a limb or to joints.
    """
    assert project.skeleton is not None
    names = project.skeleton.names
    for layer, weights in zip(LAYERS, ((0.3, 1.4), (2.0, 0.7), (0.6, 1.7)), strict=True):
        for n, part in enumerate(PARTS):
            project = edits.set_weight(project, layer, part, weights[n % 2])
        actions = {}
        for n, (ident, action) in enumerate(project.graphs[layer].actions.items()):
            start, end = project.span(action)
            if action.kind == "stance":
                seam = (0.3, 0.9)[n % 2] * (end - start)
                actions[ident] = replace(action, timing=replace(action.timing, blend_in=seam))
            else:
                limbs: tuple[Limb, ...] = ("left", "both", "right")
                actions[ident] = replace(action, limb=limbs[n % 3], joints=names[n % 2 :: 2] if n % 4 else ())
        project = project.with_graph(project.graphs[layer].but(actions=actions))
    return project


@pytest.mark.nightly
@pytest.mark.parametrize("name", ["biped", "japanese"])
def test_the_pages_words_pose_the_zoo(zoo_files: dict[str, Path], tmp_path: Path, name: str) -> None:
    poses_as_exported(project_of([zoo_files[name]], name), tmp_path)


@pytest.mark.nightly
def test_the_pages_words_pose_clips_nobody_here_made(shared_data: Path, tmp_path: Path) -> None:
    files = gather([shared_data / "bandai-namco-1"])[:4]
    poses_as_exported(project_of(files, "others"), tmp_path)


def poses_as_exported(project: Project, folder: Path) -> None:
    made = write_project_files(many_ways(project), folder)
    write_vectors(made.json, list(make_script_cases(read_export(made.json, resolved=True)))[::6])
    character, vectors = read_vectors(folder)
    seen: set[str] = set()
    for plays, off in compared(character, vectors):
        seen |= plays
        assert off["metres"] <= vectors["tolerance"]["metres"], plays
        assert off["degrees"] <= vectors["tolerance"]["degrees"], plays
    assert seen >= {"a loop's seam", "limited to a limb", "limited to joints", "blending in", "blending out"}
