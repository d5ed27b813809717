"""Names: what they say of kinds, stances, ends, layers and limbs, and what is learned from corrections."""

from __future__ import annotations

import importlib.util
import json
import sys
from dataclasses import fields
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph.words import KINDS, LAYERS, LIMBS
from metagraph.suggest.words.names import (
    NameGuess,
    Patterns,
    PatternsError,
    forget_learned,
    learn_correction,
    read_names,
)

ROOT = Path(__file__).resolve().parents[3]
SEATED = [
    "IdleSeatedBack01",
    "IdleSeatedBack01_Shrug01",
    "IdleSeatedBack01_KneeBounce01",
    "IdleSeatedBack01_PointLf02",
    "IdleSeatedForward01",
    "IdleSeatedBack01_ToIdleSeatedForward01",
    "IdleSeatedForward01_ToIdleSeatedBack01",
]


@pytest.fixture(scope="module")
def bench() -> ModuleType:
    spec = importlib.util.spec_from_file_location(
        "bench_names", ROOT / "tests" / "benchmarks" / "bench_names.py"
    )
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["bench_names"] = module
    spec.loader.exec_module(module)
    return module


def told(names: list[str], name: str | None = None, patterns: Patterns | None = None) -> dict[str, Any]:
    """What one name says in a batch, without confidences and reasons."""
    guess = read_names(names, patterns)[name or names[0]]
    return {f.name: b.value for f in fields(guess) if (b := getattr(guess, f.name)) is not None}


def kinds(names: list[str], patterns: Patterns | None = None) -> dict[str, str | None]:
    return {n: g.kind.value if g.kind else None for n, g in read_names(names, patterns).items()}


# --- edges


def test_no_names_give_nothing() -> None:
    assert read_names([]) == {}


@pytest.mark.parametrize(
    "name",
    [
        "",
        "   ",
        "___",
        "|",
        "...",
        "Armature|mixamo.com|Layer0",
        "mixamo.com",
        "Armature|",
        "Scene",
        "xqz",
        "ÄÖß",
        "動作",
    ],
)
def test_a_name_that_says_nothing_gives_no_guess(name: str) -> None:
    assert read_names([name])[name] == NameGuess()


@pytest.mark.parametrize(("name", "number"), [("007", 7), ("Take 001", 1), ("12", 12)])
def test_a_bare_number_is_only_a_number(name: str, number: int) -> None:
    assert told([name]) == {"number": number}


def test_a_number_too_large_for_a_count_is_left_alone() -> None:
    assert told(["Shrug" + "9" * 40]).get("number") is None


def test_a_very_long_name_is_read() -> None:
    assert told(["Shrug_" * 50])["kind"] == "gesture"
    assert told(["x" * 300]) == {}


def test_letters_beyond_ascii_do_not_hide_the_words() -> None:
    assert told(["Мария_Shrug_Lf_01"]) == {
        "kind": "gesture",
        "layer": "arms",
        "limb": "left",
        "tags": ("unsure",),
        "number": 1,
    }


def test_equal_names_are_read_once() -> None:
    assert list(read_names(["Idle", "Idle", "Idle"])) == ["Idle"]
    assert told(["Idle", "Idle"]) == told(["Idle"])


def test_conflicting_words_lower_the_confidence_and_are_both_quoted() -> None:
    clear, torn = (read_names([n])[n].kind for n in ("Scratch_01", "Scratch_Point_01"))
    assert clear is not None and torn is not None
    assert torn.confidence < 0.6 < clear.confidence
    assert "'Scratch'" in torn.reason and "'Point'" in torn.reason


def test_left_and_right_together_are_both_hands_with_doubt() -> None:
    limb = read_names(["Wave_Left_Right"])["Wave_Left_Right"].limb
    assert limb is not None and limb.value == "both" and limb.confidence <= 0.5


@pytest.mark.parametrize(
    "name", ["Walking_A", "Running_Strafe_Left", "Death_A_Pose", "T-Pose", "walk", "BindPose"]
)
def test_what_is_no_conversation_gets_no_kind(name: str) -> None:
    assert read_names([name])[name].kind is None


# --- what names say


def test_a_shared_beginning_that_is_a_clip_is_a_stance() -> None:
    assert kinds(SEATED) == dict(
        zip(
            SEATED,
            ["stance", "gesture", "fidget", "gesture", "stance", "transition", "transition"],
            strict=True,
        )
    )
    assert told(SEATED, "IdleSeatedBack01_Shrug01") == {
        "kind": "gesture",
        "stance": "idle seated back",
        "layer": "arms",
        "limb": "both",
        "tags": ("unsure",),
        "number": 1,
    }
    passing = told(SEATED, "IdleSeatedBack01_ToIdleSeatedForward01")
    assert (passing["stance"], passing["end_stance"]) == ("idle seated back", "idle seated forward")


@pytest.mark.parametrize(
    "name",
    [
        "idle_to_crossed",
        "IdleToCrossed",
        "Idle2Crossed",
        "Idle_ToCrossed",
        "idle__to__crossed",
        "from_idle_to_crossed",
    ],
)
def test_every_way_to_write_a_transition(name: str) -> None:
    said = told(["Idle", "crossed_idle", "crossed_nod", name], name)
    assert (said["kind"], said["stance"], said["end_stance"]) == ("transition", "idle", "crossed")


def test_a_transition_between_stances_without_clips_of_their_own() -> None:
    assert told(["SitToStand"])["kind"] == "transition"
    assert told(["Sit2Stand"])["end_stance"] == "stand"


def test_to_inside_a_stance_or_a_gesture_is_no_transition() -> None:
    names = [
        "hand_to_chin__stance",
        "hand_to_chin__nod_01",
        "hand_to_chin__to__on_hips",
        "point_to_you_01",
        "on_hips__stance",
    ]
    assert list(kinds(names).values()) == ["stance", "gesture", "transition", "gesture", "stance"]
    assert told(names, "hand_to_chin__to__on_hips")["stance"] == "hand to chin"


def test_sitting_down_and_standing_up_go_between_the_stances_there_are() -> None:
    names = ["Sit_Idle", "Stand_Idle", "Sit_Down", "Stand_Up"]
    down, up = told(names, "Sit_Down"), told(names, "Stand_Up")
    assert (down["kind"], down["stance"], down["end_stance"]) == ("transition", "stand", "sit")
    assert (up["kind"], up["stance"], up["end_stance"]) == ("transition", "sit", "stand")


def test_entering_and_leaving_a_stance() -> None:
    names = ["Idle", "crouch_idle", "crouch_in", "crouch_out"]
    assert told(names, "crouch_in")["end_stance"] == "crouch"
    assert (told(names, "crouch_out")["stance"], told(names, "crouch_out")["end_stance"]) == (
        "crouch",
        "idle",
    )


def test_stances_that_differ_by_number_only_stay_apart() -> None:
    names = ["Idle01", "Idle02", "Idle01_Shrug01", "Idle02_Shrug01"]
    assert [told(names, n)["stance"] for n in names] == ["idle 1", "idle 2", "idle 1", "idle 2"]
    assert (
        told(["Idle01", "Idle02", "Idle03"])["stance"] == "idle"
    )  # variants of one, with nothing of their own


def test_a_number_that_a_transition_ends_in_is_a_stance_beside_the_plain_one() -> None:
    names = ["idle", "idle02", "settle_to_idle02", "wave"]
    assert told(names, "settle_to_idle02")["end_stance"] == "idle 2"
    assert [told(names, n)["stance"] for n in ("idle", "idle02", "wave")] == ["idle", "idle 2", "idle"]
    assert told(["idle", "idle02", "wave"], "idle02")["stance"] == "idle"


@pytest.mark.parametrize(
    ("name", "word"),
    [
        ("idle_to_walk", "walk"),
        ("idle_toRun_fast", "Run"),
        ("Falling_Idle", "Falling"),
        ("Hanging Idle", "Hanging"),
        ("emote_float", "float"),
        ("Swimming", "Swimming"),
        ("side_step_left", "side_step"),
    ],
)
def test_stances_that_no_talker_is_ever_in_are_none_and_the_word_is_named(name: str, word: str) -> None:
    guess = read_names(["idle", "idle_wave", name])[name]
    assert guess.kind is None and guess.other is not None and f"'{word}'" in guess.other.reason


@pytest.mark.parametrize("name", ["arms_hanging", "ArmsHanging_Idle", "sword_idle", "stand_to_sit"])
def test_stances_that_only_sound_like_it_stay(name: str) -> None:
    assert read_names(["stand_idle", "sit_idle", name])[name].other is None


def test_one_stance_spelled_in_several_ways_is_one() -> None:
    names = ["Seated Idle", "Sitting Clap", "Sitting Talking", "Sit To Stand"]
    assert {told(names, n)["stance"] for n in names} == {"seated"}


def test_words_written_as_one_are_found() -> None:
    assert told(["crossarms"]) == {"kind": "stance", "stance": "cross arms", "layer": "arms"}


@pytest.mark.parametrize(
    ("name", "limb"),
    [
        ("Wave_Lf", "left"),
        ("Wave.R", "right"),
        ("wave_lh_02", "left"),
        ("WaveBt01", "both"),
        ("Wave_Both", "both"),
        ("RightWave", "right"),
        ("Clap", "both"),
    ],
)
def test_sides(name: str, limb: str) -> None:
    assert told([name])["limb"] == limb


def test_a_hand_is_told_from_where_it_points() -> None:
    assert told(["PointRight_L"])["limb"] == "left"


def test_stances_that_only_transitions_name_are_stances() -> None:
    names = ["foo_to_bar", "bar_to_foo", "bar_nod"]
    assert told(names, "bar_nod")["stance"] == "bar" and told(names, "foo_to_bar")["end_stance"] == "bar"


def test_loops_are_stances_and_looping_gestures_are_gestures() -> None:
    names = ["Idle_Loop", "Sitting_Idle_Loop", "Idle_Talking_Loop", "Wave_Loop", "Loop"]
    assert list(kinds(names).values()) == ["stance", "stance", "gesture", "gesture", None]
    assert told(names, "Sitting_Idle_Loop")["stance"] == "sitting"


def test_a_side_in_a_stance_is_no_limb() -> None:
    names = [
        "body_weight_left__stance",
        "body_weight_left__sway_01",
        "body_weight_left__to__weight_right",
        "body_weight_right__stance",
    ]
    assert not any("limb" in told(names, n) for n in names)
    assert told(names, names[2])["end_stance"] == "weight right"


def test_exporters_and_characters_names_are_left_out() -> None:
    names = ["Armature|Hero|Idle", "Armature|Hero|Wave.L", "Armature|Hero|Nod"]
    assert told(names, "Armature|Hero|Idle") == told(["Idle", "Wave.L", "Nod"], "Idle")
    assert told(["Shrug_Take2"])["number"] == 2 and told(["double_take_01"])["kind"] == "gesture"


def test_reasons_quote_the_words() -> None:
    guess = read_names(SEATED)["IdleSeatedBack01_ToIdleSeatedForward01"]
    assert guess.kind is not None and guess.kind.reason == "name says 'ToIdleSeatedForward'"
    assert guess.stance is not None and '"idle seated back"' in guess.stance.reason
    spelled = read_names(["Seated Idle", "Sitting Clap"])["Sitting Clap"].stance
    assert (
        spelled is not None and spelled.value == "seated" and spelled.reason == "name begins with 'Sitting'"
    )


# --- accuracy

FLOORS: dict[str, dict[str, float]] = {
    "sample_clips": {"kind": 0.98, "stance": 0.98, "end_stance": 1.0, "layer": 0.98, "limb": 0.93},
    "kaykit-rogue": {"kind": 1.0, "stance": 1.0, "end_stance": 1.0, "layer": 1.0},
    "fbx-pab": {"kind": 1.0, "stance": 1.0, "layer": 1.0},
    "smartbody-rachel": {"kind": 0.95, "stance": 0.95, "end_stance": 1.0, "layer": 0.9, "limb": 0.98},
    "rocketbox": {"kind": 0.98, "stance": 0.98, "layer": 0.98, "limb": 1.0},
    "mixamo-names": {"kind": 0.95, "stance": 1.0, "end_stance": 1.0, "layer": 1.0, "limb": 1.0},
    "smartbody-names": {"kind": 0.98, "stance": 1.0, "layer": 0.95, "limb": 0.93},
    "smartbody-brad": {"kind": 0.9, "layer": 0.93, "limb": 0.83},  # four clips move the other hand
    "robot-names": {"kind": 0.87, "stance": 1.0, "layer": 0.6},  # no word was ever added for it
    "bandai-namco-1": {"kind": 1.0, "layer": 0.98},
    "sumerian-hosts": {"kind": 0.85, "stance": 0.85, "layer": 0.93},  # "in" and "one" say nothing
    "robot-expressive": {
        "kind": 0.71,
        "stance": 0.71,
        "layer": 1.0,
    },  # "Sitting" sits down, "Standing" stands up
}


@pytest.mark.parametrize("name", FLOORS)
def test_a_set_is_read_as_well_as_its_floors(bench: ModuleType, name: str) -> None:
    scores = bench.measure(next(t for t in bench.truths() if t["set"] == name))
    for field, floor in FLOORS[name].items():
        assert scores[field].accuracy >= floor, "\n".join(scores[field].wrong)


def test_every_truth_table_has_floors_and_known_labels(bench: ModuleType) -> None:
    allowed = {"kind": KINDS, "layer": LAYERS, "limb": LIMBS}
    for table in bench.truths():
        assert table["set"] in FLOORS and table["source"] and isinstance(table["looked_at"], bool)
        for clip, truth in table["clips"].items():
            assert set(truth) == {"kind", "layer", "stance", "end_stance", "limb"}, clip
            assert all(truth[f] is None or truth[f] in of for f, of in allowed.items()), clip


def test_confidence_is_no_boast(bench: ModuleType) -> None:
    # Numbers that tell stances apart are lost where hardly a stance has a clip of its own: said too surely.
    tables = [table for table in bench.truths() if table["set"] != "smartbody-brad"]
    scores = [s for table in tables for s in bench.measure(table).values()]
    for low, high, count, mean, right in bench.calibration(scores):
        assert right >= mean - 0.05, f"{count} guesses of {low}..{high}"


# --- properties

PIECES = [
    "Idle",
    "Seated",
    "Crossed",
    "Shrug",
    "Nod",
    "To",
    "to",
    "2",
    "Lf",
    "01",
    "02",
    "_",
    "__",
    ".",
    " ",
    "|",
    "Foo",
    "Sit",
    "Stand",
    "Down",
    "a",
]
NAMES = st.one_of(st.text(max_size=20), st.lists(st.sampled_from(PIECES), max_size=8).map("".join))


@settings(max_examples=200, deadline=None)
@given(st.lists(NAMES, max_size=8))
def test_any_names_are_read_with_values_that_are_allowed(names: list[str]) -> None:
    for guess in read_names(names).values():
        for field in fields(guess):
            belief = getattr(guess, field.name)
            assert belief is None or (
                0 < belief.confidence <= 1 and belief.reason and belief.value not in ("", ())
            )
        assert guess.kind is None or guess.kind.value in KINDS
        assert guess.layer is None or guess.layer.value in LAYERS
        assert guess.limb is None or guess.limb.value in LIMBS


@settings(max_examples=100, deadline=None)
@given(st.lists(NAMES, max_size=8), st.randoms(use_true_random=False))
def test_the_order_of_names_does_not_matter(names: list[str], random: Any) -> None:
    mixed = random.sample(names, len(names))
    assert read_names(mixed) == read_names(names) == read_names(names)


@pytest.mark.parametrize("prefix", ["Hero_", "chr07_", "Maria@", "proj|Zed_", "ACME__"])
@pytest.mark.parametrize("name", ["sample_clips", "kaykit-rogue", "mixamo-names", "smartbody-names"])
def test_a_common_beginning_changes_nothing(bench: ModuleType, name: str, prefix: str) -> None:
    names = list(next(t for t in bench.truths() if t["set"] == name)["clips"])
    plain, renamed = read_names(names), read_names([prefix + n for n in names])
    assert [renamed[prefix + n] for n in names] == [plain[n] for n in names]


# --- patterns and learning


def test_patterns_are_changed_and_changed_back() -> None:
    plain = Patterns()
    assert told(["Gawk_01"]).get("kind") is None
    taught = plain.with_pattern("kinds", "Gawk", "fidget")
    assert told(["Gawk_01"], patterns=taught)["kind"] == "fidget"
    assert taught.with_pattern("kinds", "gawk", None).meanings == plain.meanings
    mute = plain.with_pattern("kinds", "shrug", None)
    assert told(["Shrug_01"], patterns=mute).get("kind") is None
    assert mute.with_pattern("kinds", "shrug", "gesture").to_json() == plain.to_json()


def test_words_of_other_languages_can_be_taught() -> None:
    finnish = (
        Patterns()
        .with_pattern("joins", "kohti", "to")
        .with_pattern("limbs", "vasen", "left")
        .with_pattern("kinds", "vilkutus", "gesture")
    )
    assert told(["crossed_kohti_idle", "crossed_idle", "idle"], patterns=finnish)["end_stance"] == "idle"
    assert told(["vilkutus_vasen"], patterns=finnish) == {"kind": "gesture", "limb": "left", "layer": "arms"}


def test_patterns_survive_a_file() -> None:
    patterns = Patterns().with_pattern("kinds", "gawk", "fidget").with_pattern("tags", "shrug", None)
    patterns = learn_correction(patterns, "Shrug_01", "kind", "fidget")
    assert Patterns.from_json(json.loads(json.dumps(patterns.to_json()))) == patterns
    assert Patterns.from_json(Patterns().to_json()) == Patterns()


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (None, "are nothing, expected an object"),
        ([], "a list"),
        ({}, "version None"),
        ({"patterns": 9}, "version 9"),
        ({"patterns": 1, "colours": {}}, "unknown part 'colours'"),
        ({"patterns": 1, "kinds": []}, "'kinds' is a list"),
        ({"patterns": 1, "kinds": {"gawk": "dance"}}, "'kinds', 'gawk' means 'dance'"),
        ({"patterns": 1, "limbs": {"": "left"}}, "has no words"),
        ({"patterns": 1, "learned": {"mood": {}}}, "unknown field 'mood'"),
        ({"patterns": 1, "learned": {"kind": {"shrug": {"fidget": -1}}}}, "is -1"),
        ({"patterns": 1, "learned": {"kind": {"shrug": {"fidget": True}}}}, "is True"),
        ({"patterns": 1, "learned": {"kind": {"shrug": {"dance": 1}}}}, "none of stance"),
    ],
)
def test_a_broken_file_says_what_and_where(data: Any, message: str) -> None:
    with pytest.raises(PatternsError, match=message.replace("(", r"\(")):
        Patterns.from_json(data)


def test_nonsense_cannot_be_taught_or_learned() -> None:
    with pytest.raises(PatternsError, match="one of stance"):
        Patterns().with_pattern("kinds", "gawk", "dance")
    with pytest.raises(PatternsError, match="'mood'"):
        learn_correction(Patterns(), "Shrug", "mood", "glad")
    with pytest.raises(PatternsError, match="cannot be 'dance'"):
        learn_correction(Patterns(), "Shrug", "kind", "dance")


def test_one_correction_changes_its_words_and_nothing_else(bench: ModuleType) -> None:
    names = list(next(t for t in bench.truths() if t["set"] == "sample_clips")["clips"])
    before = read_names(names)
    patterns = learn_correction(Patterns(), "arms_crossed__tap_fingers_rt_01", "kind", "gesture", names)
    after = read_names(names, patterns)
    changed = {n for n in names if after[n] != before[n]}
    assert changed == {"arms_crossed__tap_fingers_rt_01", "on_hips__tap_fingers_rt_01"}
    for name in changed:
        guess = after[name]
        assert (
            guess.kind is not None and guess.kind.value == "gesture" and "'tap_fingers'" in guess.kind.reason
        )
        assert all(
            getattr(guess, f.name) == getattr(before[name], f.name) for f in fields(guess) if f.name != "kind"
        )
    assert read_names(names, forget_learned(patterns)) == before
    assert read_names(names, forget_learned(patterns, "kind")) == before
    assert read_names(names, forget_learned(patterns, "limb")) == after


def test_two_corrections_that_agree_teach_a_word() -> None:
    patterns = learn_correction(
        learn_correction(Patterns(), "shrug_dx_01", "limb", "right"), "point_dx_01", "limb", "right"
    )
    assert told(["offer_dx_03"], patterns=patterns)["limb"] == "right"
    assert told(["offer_sx_03"], patterns=patterns).get("limb") is None
    torn = learn_correction(patterns, "wave_dx_01", "limb", "left")
    assert told(["offer_dx_03"], patterns=torn).get("limb") is None
    assert told(["wave_dx_02"], patterns=torn)["limb"] == "left"  # the very words that were corrected


def test_corrections_that_contradict_each_other_teach_nothing() -> None:
    patterns = learn_correction(
        learn_correction(Patterns(), "Shrug_01", "kind", "fidget"), "Shrug_02", "kind", "gesture"
    )
    guess = read_names(["Shrug_03"], patterns)["Shrug_03"].kind
    assert guess is not None and guess.reason == "name says 'Shrug'"


def test_a_side_in_the_name_outweighs_what_another_clip_taught() -> None:
    patterns = learn_correction(Patterns(), "Wave_01", "limb", "left")
    assert told(["Wave_02"], patterns=patterns)["limb"] == "left"
    assert told(["Wave_Rt_01"], patterns=patterns)["limb"] == "right"


def test_a_stance_renamed_once_is_renamed_everywhere() -> None:
    patterns = learn_correction(Patterns(), "IdleSeatedBack01_Shrug01", "stance", "leaning back", SEATED)
    assert told(SEATED, "IdleSeatedBack01", patterns)["stance"] == "leaning back"
    assert told(SEATED, "IdleSeatedForward01_ToIdleSeatedBack01", patterns)["end_stance"] == "leaning back"
    assert told(SEATED, "IdleSeatedForward01", patterns) == told(SEATED, "IdleSeatedForward01")


@settings(max_examples=100, deadline=None)
@given(NAMES, st.sampled_from(["kind", "layer", "limb"]), st.data())
def test_a_corrected_name_is_read_as_corrected_or_teaches_nothing(
    name: str, field: str, data: st.DataObject
) -> None:
    value = data.draw(st.sampled_from({"kind": KINDS, "layer": LAYERS, "limb": LIMBS}[field]))
    patterns = learn_correction(Patterns(), name, field, value)
    assert Patterns.from_json(patterns.to_json()) == patterns
    if patterns.learned and field != "limb":
        assert told([name], patterns=patterns)[field] == value
    assert (
        learn_correction(patterns, name, "tags", ["a", "b"]).learned.get("tags") is not None
        or not patterns.learned
    )


# --- numbers and letters that tell stances apart


NUMBERED = ["ChrX@Idle01_Shrug01", "ChrX@Idle02_PointLf01", "ChrX@Idle03", "ChrX@Idle02_ToIdle01"]


@pytest.mark.parametrize(
    ("name", "stance"), [*zip(NUMBERED, ("idle 1", "idle 2", "idle 3", "idle 2"), strict=True)]
)
def test_a_stances_number_stays_though_no_clip_of_its_own_is_there(name: str, stance: str) -> None:
    assert told(NUMBERED, name)["stance"] == stance


def test_a_transition_ends_in_the_stance_of_the_number_it_names() -> None:
    assert told(NUMBERED, NUMBERED[3])["end_stance"] == "idle 1"
    names = ["Sit_A", "Sit_B", "Sit_A_To_Sit_B", "Sit_B_To_Sit_A_02"]
    assert told(names, names[2])["end_stance"] == "sit b"
    assert told(names, names[3])["end_stance"] == "sit a"


def test_numbers_from_which_nothing_goes_on_are_takes_of_one_stance() -> None:
    names = ["idle_01", "idle_02", "idle_scratch_01", "wave_01"]
    assert {told(names, n)["stance"] for n in names} == {"idle"}


@pytest.mark.parametrize("spelled", ["Idle1_Nod", "Idle_01_Nod", "idle 001 nod"])
def test_leading_zeros_make_no_other_stance(spelled: str) -> None:
    assert told([*NUMBERED, f"ChrX@{spelled}"], f"ChrX@{spelled}")["stance"] == "idle 1"


# --- what all names begin with


def test_words_all_names_begin_with_are_left_out_though_they_mean_something_elsewhere() -> None:
    rest = ("idle standing upright 1", "idle standing upright 1 off screen reveal", "sitting idle", "nod yes")
    names = [f"generic mle adult {x}" for x in rest] + ["T-Pose"]
    assert told(names, names[0]) == {
        "kind": "stance",
        "stance": "idle standing upright",
        "layer": "body",
        "number": 1,
    }
    assert told(names, names[3])["layer"] == "head"


def test_what_all_clips_are_is_not_left_out() -> None:
    names = [f"wave_{n:02}" for n in range(12)]
    assert {told(names, n)["kind"] for n in names} == {"gesture"}


def test_a_stance_may_be_told_after_what_is_done() -> None:
    names = ["Sitting_Idle", "Standing_Idle", "Talk_Sitting_01", "Shrug_Standing", "Trans_Sitting_Standing"]
    assert told(names, names[2])["stance"] == "sitting"
    assert told(names, names[3])["stance"] == "standing"
    both = told(names, names[4])
    assert (both["kind"], both["stance"], both["end_stance"]) == ("transition", "sitting", "standing")
