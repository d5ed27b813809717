"""The zoo of made label sets: what is reported about a clip is what its motion does; a seed gives one set."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.formats.imports import gather, import_files
from metagraph.graph.model import KINDS, LAYERS, LIMBS, Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles, is_humanoid
from tests.label_zoo import bodies, rigs
from tests.label_zoo.bodies import Whole
from tests.label_zoo.catalogue import FEW, RECIPES, STANDING, drawn, made_sets, named
from tests.label_zoo.grammar import LANGUAGES, SIDES, Grammar, Namer, words
from tests.label_zoo.motions import Recording, recorded
from tests.label_zoo.rigs import Figure
from tests.label_zoo.sets import MadeSet, Recipe, make
from tests.label_zoo.source import Motion, clip_of, loop, skeleton, takes

SOME = (
    "proportions of a child",
    "biped with axes along bones",
    "random axes, a turned rest",
    "few joints",
    "a hundred times too large",
    "cameras at 120",
    "mirrored",
    "strewn over the floor",
    "standing talker by number",
    "sitting without legs",
    "sitting, leaning, standing",
    "arms tell the stances",
    "many wrong names",
)
WATCHED = ("hips", "head", "left_hand", "right_hand", "left_lower_arm", "right_lower_arm", "neck")
OF = {
    "body": ("left_upper_leg", "left_lower_leg", "left_foot", "right_foot", *WATCHED),
    "head": ("head", "neck"),
}


@cache
def found(name: str) -> MadeSet:
    return named(name)


pytestmark = pytest.mark.nightly


@pytest.fixture(scope="module", autouse=True)
def let_go() -> Iterator[None]:
    """A hundred sets are much for a process that goes on to test something else."""
    yield
    found.cache_clear()


def posed(clip: Clip, frames: Any = slice(None)) -> dict[str, Any]:
    """Return where joints are by role, as seen from the hips, in heights of the character."""
    roles = find_roles(clip.skeleton)
    turns, at = clip.skeleton.globals(clip.poses()[frames])
    hips = at[:, roles["hips"], None]
    arms = at[:, roles["left_upper_arm"]] - at[:, roles["right_upper_arm"]]
    yaw = np.arctan2(-arms[:, 2], arms[:, 0])
    back = rotation.from_axis_angle(np.array([0.0, 1, 0]), -yaw)[:, None]
    seen = rotation.rotate_vectors(np.broadcast_to(back, turns.shape), at - hips) / clip.skeleton.height
    return {role: seen[:, j] for role, j in roles.items()}


def vector(clip: Clip, frame: int, layer: str) -> Any:
    pose = posed(clip, [frame])
    if layer == "head":  # how the head is turned reports it; the rest sways
        head = find_roles(clip.skeleton)["head"]
        up = clip.skeleton.globals(clip.poses()[[frame]])[0][0, head]
        rest = clip.skeleton.globals(clip.skeleton.rest)[0][head]
        return rotation.rotate_vectors(
            rotation.multiply(up, rotation.conjugate(rest)), np.array([0.0, 0.1, 0])
        )
    names = OF.get(layer, WATCHED)
    return np.concatenate([pose[r][0] for r in names if r in pose])


def test_the_same_seed_gives_the_same_set_and_another_seed_another() -> None:
    recipe = Recipe(wholes=STANDING[:2], steps=1, recording=Recording(fps=25, noise=0.5, drift=0.03))
    one, two, other = make("a", recipe, 4), make("a", recipe, 4), make("a", recipe, 5)
    assert one.truth == two.truth and one.truth != other.truth
    for a, b in zip(one.project.clips.values(), two.project.clips.values(), strict=True):
        assert a.name == b.name and a.motion is not None and b.motion is not None
        np.testing.assert_array_equal(a.motion.rotations, b.motion.rotations)


def test_drawn_sets_do_not_depend_on_how_many_are_drawn() -> None:
    (first,), (same, _) = made_sets(1, 3), made_sets(2, 3)
    assert first.truth == same.truth and first.what == same.what


def test_every_trouble_has_a_named_set() -> None:
    have = {word for recipe in RECIPES.values() for word in recipe.what}
    wanted = {"layered", "whole body", "seated", "close stances", "unseen stances", "steps", "wrong names"}
    wanted |= {"opaque names", "numbered stances", "names without stances", "other languages", "proportions"}
    wanted |= {"other joints", "joints missing", "joints extra", "units", "rate", "noise", "drift", "warped"}
    wanted |= {"trimmed", "strewn", "bind keys", "mirrored", "synonyms"}
    wanted |= {f"language {x}" for x in LANGUAGES if x not in ("en", "synonym")}
    assert wanted <= have and len(RECIPES) >= 40


@pytest.mark.parametrize("name", SOME)
def test_the_truth_names_every_clip_and_says_only_what_there_is(name: str) -> None:
    made = found(name)
    assert {e.name for e in made.project.clips.values()} == set(made.truth)
    for row in made.truth.values():
        assert row["kind"] in (*KINDS, None) and row["layer"] in (*LAYERS, None)
        assert row["limb"] in (*LIMBS, None) and (row["limb"] is None or row["layer"] == "arms")
        assert (row["end_stance"] is not None) == (row["kind"] == "transition")
        assert row["end_stance"] != row["stance"] or row["kind"] is None
        assert row["kind"] is not None or not any(row.values())
    assert made.kinds["gesture"] >= 10 and made.kinds["transition"] >= 2


@pytest.mark.parametrize("name", SOME)
def test_clips_begin_and_end_in_the_stances_that_they_are_told_to(name: str) -> None:
    made = found(name)
    poses: dict[str, dict[str, list[tuple[Any, str]]]] = defaultdict(lambda: defaultdict(list))
    for entry in made.project.clips.values():
        row, clip = made.truth[entry.name], entry.motion
        assert clip is not None
        if row["kind"] is not None:
            layer = "body" if "whole body" in made.what else str(row["layer"])
            poses[layer][str(row["stance"])].append((vector(clip, 0, layer), entry.name))
            end = row["end_stance"] or row["stance"]
            poses[layer][str(end)].append((vector(clip, -1, layer), entry.name))
    right = count = 0
    for layer, stances in poses.items():
        middles = {s: np.median([v for v, _ in some], axis=0) for s, some in stances.items()}
        for stance, some in stances.items():
            for v, clip_name in some:
                near = min(middles, key=lambda s: float(np.linalg.norm(v - middles[s])))
                right, count = right + (near == stance), count + 1
                away = float(np.abs(v - middles[stance]).max())
                assert away < 0.09, (layer, clip_name, stance, away)
    assert right >= 0.97 * count, (right, count)


@pytest.mark.parametrize("name", SOME)
def test_the_hand_that_is_told_moves_the_most(name: str) -> None:
    made, right, count = found(name), 0, 0
    for entry in made.project.clips.values():
        limb, clip = made.truth[entry.name]["limb"], entry.motion
        if limb in ("left", "right") and clip is not None:
            at = posed(clip)
            far = {s: float(np.ptp(at[f"{s}_hand"], axis=0).max()) for s in ("left", "right")}
            right, count = right + (far[limb] == max(far.values())), count + 1
    assert count >= 3 and right >= 0.85 * count, (right, count)  # drift may outdo a tapping finger


@pytest.mark.parametrize("name", [n for n in SOME if n != "proportions of a child"])
def test_a_transition_goes_farther_than_an_action_comes_back(name: str) -> None:
    made = found(name)
    gaps: dict[bool, list[float]] = {True: [], False: []}
    for entry in made.project.clips.values():
        row, clip = made.truth[entry.name], entry.motion
        if clip is not None and row["kind"] is not None and row["layer"] != "head":
            layer = str(row["layer"] or "body")
            gap = float(np.abs(vector(clip, 0, layer) - vector(clip, -1, layer)).max())
            gaps[row["kind"] == "transition"].append(gap)
    assert np.median(gaps[True]) > 2 * np.median(gaps[False]), (gaps[True], np.median(gaps[False]))


@pytest.mark.parametrize(
    "figure",
    [
        Figure("mixamo", rest="T", axes="bones", extra=("root", "twist", "props")),
        Figure("lower", rest="I", axes="none", missing=("fingers", "face", "toes")),
        Figure("letters", rest="turned", axes="random", seed=8),
        Figure("numbers", rest="T", axes="none", extra=("root",)),
    ],
    ids=lambda f: f.names,
)
def test_another_rig_of_the_same_size_moves_alike(figure: Figure) -> None:
    take = next(t for t in takes() if t.source == "body_weight_left__to__lean_forward")
    clip = clip_of("x", take.motion)
    turned = rigs.on(clip, figure)
    _, before = clip.skeleton.globals(clip.poses())
    _, after = turned.skeleton.globals(turned.poses())
    names = {n: rigs.called(figure.names, n) for n in skeleton().names}
    kept = [n for n in skeleton().names if names[n] in turned.skeleton]
    assert len(kept) >= 20
    for n in kept:
        mine = after[:, turned.skeleton.index(names[n])]
        assert float(np.abs(mine - before[:, clip.skeleton.index(n)]).max()) < 2e-4, n


def test_rests_differ_between_rigs_of_the_same_motion() -> None:
    clip = clip_of("x", loop("hands_at_sides").motion)
    t, bare = (rigs.on(clip, Figure(rest="T", axes=axes)) for axes in ("world", "none"))
    assert (
        rotation.measure_angle_between(bare.skeleton.rest_rotations, rotation.make_identity_rotations()).max()
        < 1e-6
    )
    hand = skeleton().index("LeftHand")
    for other in (t, bare):  # in a T-pose both have the hand at the height of the shoulder
        _, at = other.skeleton.globals(other.skeleton.rest)
        assert abs(at[hand, 1] - at[skeleton().index("LeftUpperArm"), 1]) < 0.02
    assert not np.allclose(t.rotations, bare.rotations, atol=0.05)


@pytest.mark.parametrize("name", [n for n in RECIPES if RECIPES[n].figure != Figure()])
def test_the_figures_of_named_sets_are_people(name: str) -> None:
    rig = rigs.on(clip_of("x", loop("hands_at_sides").motion), RECIPES[name].figure)
    if "legs" in RECIPES[name].figure.missing:
        assert "left_hand" in find_roles(rig.skeleton) and "left_foot" not in find_roles(rig.skeleton)
    else:
        assert is_humanoid(find_roles(rig.skeleton))


def test_the_figures_of_drawn_sets_are_people() -> None:
    for recipe in (drawn(0, n) for n in range(40)):
        rig = rigs.on(clip_of("x", loop("hands_at_sides").motion), recipe.figure)
        assert is_humanoid(find_roles(rig.skeleton)) or "legs" in recipe.figure.missing, recipe.figure


def test_a_stance_that_trembles_hardly_moves() -> None:
    clip = clip_of("x", loop("hands_at_sides").motion)
    draw = np.random.default_rng(0)
    tremble = recorded(clip, Recording(noise=0.7), draw)
    hands = [bodies.hands(Motion(c.rotations.astype(float), c.root)) for c in (clip, tremble)]
    away = np.linalg.norm(hands[1] - hands[0], axis=-1)
    assert 0.002 < float(away.mean()) < 0.02
    speed = np.linalg.norm(np.diff(hands[1], axis=0), axis=-1) * clip.fps
    assert float(np.median(speed)) < 0.1


def test_variants_of_a_stance_are_as_far_apart_as_told() -> None:
    plain = bodies.hands(bodies.standing(Whole()))
    for near, apart in ((1, 0.05), (2, 0.065), (3, 0.08)):
        other = bodies.hands(bodies.standing(Whole(near=near, apart=apart)))
        assert float(np.linalg.norm(other - plain, axis=-1).max()) == pytest.approx(apart, abs=1e-3)


def test_who_sits_sits() -> None:
    standing, sitting = bodies.standing(Whole()), bodies.standing(Whole("sit"))
    assert sitting.root[0, 1] < standing.root[0, 1] - 0.35
    feet = [clip_of("x", m) for m in (standing, sitting)]
    ground = [float(c.skeleton.globals(c.poses())[1][0, skeleton().index("LeftFoot"), 1]) for c in feet]
    assert abs(ground[0] - ground[1]) < 0.08  # the feet stay on the ground


def test_steps_leave_turn_or_bend() -> None:
    draw = np.random.default_rng(1)
    made: dict[str, Motion] = {name: bodies.steps(name, Whole(), draw) for name in bodies.STEPS}
    turned = rotation.measure_angle_between(made["turn_place"].turns[0, 0], made["turn_place"].turns[-1, 0])
    assert float(np.degrees(turned)) > 80
    assert np.ptp(made["squat"].root[:, 1]) > 0.25 and np.ptp(made["jump"].root[:, 1]) > 0.3
    for name in ("walk", "run"):
        leg = made[name].turns[:, skeleton().index("LeftUpperLeg")]
        assert np.degrees(rotation.measure_angle_between(leg, leg[:1]).max()) > 15


def test_wrong_names_are_those_of_other_clips_and_all_else_stays() -> None:
    recipe = Recipe(wholes=STANDING)
    lying = make("w", Recipe(wholes=STANDING, wrong=0.2), 2)
    honest = make("w", recipe, 2)
    assert len(lying.misnamed) >= 6 and set(lying.truth) == set(honest.truth)
    differ = {n for n in lying.truth if lying.truth[n] != honest.truth[n]}
    assert differ == lying.misnamed


def test_unseen_stances_have_clips_but_no_loop() -> None:
    made = found("numbers of unseen stances")
    told = {row["stance"] for row in made.truth.values()}
    loops = {row["stance"] for row in made.truth.values() if row["kind"] == "stance"}
    assert len(told) == 3 and len(loops) == 1


def test_mirroring_swaps_the_hands_and_the_sides_of_stances() -> None:
    recipe = Recipe(FEW, clips=99, unlinked=0.0)
    plain, turned = (
        make("m", recipe, 1),
        make("m", Recipe(FEW, clips=99, unlinked=0.0, recording=Recording(mirrored=True)), 1),
    )
    count = [sum(r["limb"] == "left" for r in made.truth.values()) for made in (plain, turned)]
    rights = [sum(r["limb"] == "right" for r in made.truth.values()) for made in (plain, turned)]
    assert count == rights[::-1] and count[0] != count[1]
    assert {"weight right"} == {
        str(r["stance"]) for r in turned.truth.values() if "weight" in str(r["stance"])
    }


@pytest.mark.parametrize(
    ("how", "names"),
    [
        (
            Grammar("ChrX@", style="camel", numbered="IdleSeated", together=True),
            ("ChrX@IdleSeated01", "ChrX@IdleSeated01_ShrugBt01", "ChrX@IdleSeated01_ToIdleSeated02"),
        ),
        (
            Grammar("generic mle ", style="space", side="left", take="1", to="2"),
            ("generic mle sit", "generic mle sit shrug both 1", "generic mle sit2arms crossed"),
        ),
        (
            Grammar("A_", style="Snake", side="L", order="action first", to="from to", take="001"),
            ("A_Sit", "A_Shrug_LR_Sit_001", "A_From_Sit_To_Arms_Crossed"),
        ),
        (
            Grammar(language="fr", side="none", accents=False),
            ("assis", "assis_hausser_les_epaules_01", "assis_vers_bras_croises"),
        ),
        (
            Grammar("Hero|", style="camel", numbered="Idle{}", together=True),
            ("Hero|IdleSit01", "Hero|IdleSit01_ShrugBt01", "Hero|IdleSit01_ToIdleArmsCrossed01"),
        ),
        (Grammar(style="Snake", numbered="Sit_@", take="1"), ("Sit_A", "Sit_A_Shrug_Bt_1", "Sit_A_To_Sit_B")),
        (Grammar(style="camel", to="glued"), ("Sit", "SitShrugBt01", "SittoArmsCrossed")),
        (Grammar(language="zh", side="none", take=""), ("坐姿", "坐姿_耸肩", "坐姿_到_抱胸")),
    ],
    ids=lambda x: x.prefix or x.numbered or x.to + x.language if isinstance(x, Grammar) else "",
)  # fmt: skip
def test_names_follow_their_grammar(how: Grammar, names: tuple[str, str, str]) -> None:
    namer = Namer(how, {"0": "sit", "1": "arms_crossed"}, np.random.default_rng(0))
    assert namer.name("stance", "", "0") == names[0]
    assert namer.name("gesture", "shrug", "0", limb="both") == names[1]
    assert namer.name("transition", "", "0", "1") == names[2]
    assert namer.name("gesture", "shrug", "0", limb="both") != names[1]  # a second take


def test_every_language_has_a_word_for_every_action_and_stance() -> None:
    needed = {t.action for t in takes() if t.action} | {t.stance for t in takes()}
    needed |= {*bodies.MADE, *bodies.STEPS}
    for language in LANGUAGES:
        table = words(language)
        assert needed <= set(table) and all(table[key] for key in needed)
    assert all(len(sides) == 3 for sides in SIDES.values())


def test_bind_keys_are_taken_away_as_reading_takes_them_and_told() -> None:
    made = found("bind keys at both ends")
    for entry in made.project.clips.values():
        clip = entry.motion
        assert clip is not None and any("bind pose" in note for note in clip.notes), entry.name
        rest = clip.skeleton.rest_rotations
        ends = [rotation.measure_angle_between(clip.rotations[n], rest).max() for n in (0, -1)]
        assert min(np.degrees(ends)) > 1, entry.name


@pytest.mark.parametrize("bvh", [False, True], ids=["glb", "bvh"])
def test_a_set_that_is_written_is_read_as_it_was(tmp_path: Path, bvh: bool) -> None:
    recipe = Recipe(wholes=STANDING[:2], clips=2, grammar=Grammar("ChrX@", language="ja", side="ja"))
    made = make("written", recipe, 0)
    made.write(tmp_path / "set", bvh)
    read = import_files(Project(), None, gather([tmp_path / "set"])).into(Project())
    assert {e.name for e in read.clips.values()} == set(made.truth)
    before = {e.name: e.motion for e in made.project.clips.values()}
    for entry in read.clips.values():
        mine = before[entry.name]
        assert mine is not None and entry.motion is not None and abs(mine.frames - entry.motion.frames) <= 1
        assert np.abs(vector(mine, 0, "body") - vector(entry.motion, 0, "body")).max() < 0.005
