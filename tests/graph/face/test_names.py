"""Faces by their names: ARKit, VRM, Oculus, and clips that show blinks and mouth shapes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph import edits
from metagraph.graph.face.names import VISEMES, find_clip_shapes, find_morphs
from metagraph.graph.model import Project

ARKIT = [
    "eyeBlinkLeft",
    "eyeBlinkRight",
    "eyeWideLeft",
    "eyeWideRight",
    "eyeLookUpLeft",
    "eyeLookUpRight",
    "eyeLookDownLeft",
    "eyeLookDownRight",
    "eyeLookInLeft",
    "eyeLookInRight",
    "eyeLookOutLeft",
    "eyeLookOutRight",
    "jawOpen",
    "mouthFunnel",
    "mouthPucker",
    "mouthPressLeft",
    "mouthPressRight",
    "mouthRollLower",
    "mouthRollUpper",
    "mouthStretchLeft",
    "mouthStretchRight",
    "mouthSmileLeft",
    "mouthSmileRight",
    "mouthLowerDownLeft",
    "mouthLowerDownRight",
    "mouthUpperUpLeft",
    "mouthUpperUpRight",
    "tongueOut",
    "browInnerUp",
]


def test_a_mesh_without_morph_targets_has_no_channels() -> None:
    assert find_morphs([]) == {}


def test_targets_that_mean_nothing_to_a_face_are_left_alone() -> None:
    assert find_morphs(["Surprised", "muscle_01", ""]) == {}


def test_a_mood_shows_on_arkits_targets_or_on_expressions_of_the_whole_face() -> None:
    assert find_morphs(["Angry", "Sad", "Joy"]) == {
        "smile": (("Joy", 0.5),),
        "frown": (("Sad", 0.5),),
        "brow_down": (("Angry", 0.5),),
    }
    found = find_morphs(["mouthSmileLeft", "mouthSmileRight", "browInnerUp", "Joy"])
    assert found["smile"] == (("mouthSmileLeft", 0.9), ("mouthSmileRight", 0.9))
    assert found["brow_up"] == (("browInnerUp", 1.0),)
    assert found["brows"] == (("browInnerUp", 0.9),)


def spellings(name: str) -> list[str]:
    snake = "".join("_" + c.lower() if c.isupper() else c for c in name)
    short = name.replace("Left", "_L").replace("Right", "_R")
    return [
        name,
        name.upper(),
        snake,
        f"blendShape1.{name}",
        f"Face.{short}",
        f"BS_{name}",
        short.replace("_", "."),
    ]


@pytest.mark.parametrize("style", range(7))
def test_arkit_is_known_however_it_is_spelled(style: int) -> None:
    names = [spellings(n)[style] for n in ARKIT]
    found = find_morphs(names)
    of = dict(zip(names, ARKIT, strict=True))
    assert [of[n] for n, _ in found["blink_left"]] == ["eyeBlinkLeft"]
    assert [of[n] for n, _ in found["blink_right"]] == ["eyeBlinkRight"]
    assert {f"viseme_{v}" for v in VISEMES[1:]} <= found.keys()
    assert {of[n]: w for n, w in found["viseme_aa"]}["jawOpen"] > 0.4
    assert {of[n] for n, _ in found["viseme_PP"]} >= {"mouthPressLeft", "mouthPressRight"}


def test_towards_the_nose_is_to_the_right_for_the_left_eye() -> None:
    found = find_morphs(ARKIT)
    assert found["look_right_left"] == (("eyeLookInLeft", 1.0),) and found["look_left_left"] == (
        ("eyeLookOutLeft", 1.0),
    )
    assert found["look_left_right"] == (("eyeLookInRight", 1.0),) and found["look_right_right"] == (
        ("eyeLookOutRight", 1.0),
    )


@pytest.mark.parametrize(
    "names",
    [
        ["A", "I", "U", "E", "O", "Blink", "Blink_L", "Blink_R"],
        ["aa", "ih", "ou", "ee", "oh", "blink", "blinkLeft", "blinkRight"],
        [
            "Fcl_MTH_A",
            "Fcl_MTH_I",
            "Fcl_MTH_U",
            "Fcl_MTH_E",
            "Fcl_MTH_O",
            "Fcl_EYE_Close",
            "Fcl_EYE_Close_L",
            "Fcl_EYE_Close_R",
        ],
    ],
)
def test_the_five_vowels_of_vrm_make_all_shapes_but_closed_lips(names: list[str]) -> None:
    found = find_morphs(names)
    assert found["viseme_aa"] == ((names[0], 1.0),) and found["viseme_U"] == ((names[2], 1.0),)
    assert {f"viseme_{v}" for v in VISEMES[1:]} - found.keys() == {"viseme_PP"}
    assert found["blink_left"] == ((names[6], 1.0),) and found["blink_right"] == ((names[7], 1.0),)


def test_a_letter_alone_is_no_vowel() -> None:
    assert find_morphs(["a", "b", "c"]) == {}


def test_a_single_blink_is_for_both_eyes() -> None:
    assert find_morphs(["eyesClosed"]) == {"blink": (("eyesClosed", 1.0),)}


def test_visemes_made_for_the_purpose_go_before_all_else() -> None:
    found = find_morphs([*ARKIT, *(f"viseme_{v}" for v in VISEMES)])
    assert all(found[f"viseme_{v}"] == ((f"viseme_{v}", 1.0),) for v in VISEMES[1:])


def test_a_mouth_that_only_opens_speaks_by_opening() -> None:
    found = find_morphs(["MouthOpen"])
    assert found["viseme_aa"] == (("MouthOpen", 1.0),) and "viseme_PP" not in found


def test_corrections_bind_and_unbind() -> None:
    found = find_morphs([*ARKIT, "Grimace"], {"viseme_E": "Grimace", "blink_left": "", "viseme_O": "Nowhere"})
    assert found["viseme_E"] == (("Grimace", 1.0),) and "blink_left" not in found
    assert found["viseme_O"] == find_morphs(ARKIT)["viseme_O"], "an unknown target changes nothing"


def test_a_target_bound_to_the_jaw_speaks() -> None:
    assert find_morphs(["Gape"], {"jaw_open": "Gape"})["viseme_aa"] == (("Gape", 1.0),)


@given(st.lists(st.text(max_size=20), max_size=30))
def test_any_names_are_survived(names: list[str]) -> None:
    for targets in find_morphs(names).values():
        assert {name for name, _ in targets} <= set(names)
        assert all(0 < weight <= 1 for _, weight in targets)


# --- clips


def named(toy: Any, *names: str, path: str = "face.glb", seconds: float = 0.1) -> Project:
    return edits.add_clips(
        Project(), [(path, n, "", toy.clip(name, seconds)) for n, name in enumerate(names)]
    )


def shapes(project: Project) -> dict[str, str]:
    return {channel: project.clips[clip].name for channel, clip in find_clip_shapes(project).items()}


def test_one_clip_called_a_is_no_mouth_shape(toy: Any) -> None:
    assert shapes(named(toy, "a", "i", "stand")) == {}


def test_a_family_of_marks_is_a_mouth(toy: Any) -> None:
    found = shapes(
        named(toy, "@", "a", "e", "E", "f", "i", "k", "o", "O", "p", "r", "s", "S", "sil", "t", "T", "u")
    )
    assert (
        found["viseme_PP"] == "p"
        and found["viseme_CH"] == "S"
        and found["viseme_SS"] == "s"
        and found["viseme_TH"] == "T"
    )
    assert (
        found["viseme_E"] == "E"
        and found["viseme_O"] == "o"
        and found["viseme_DD"] == found["viseme_nn"] == "t"
    )


def test_shapes_by_their_full_names_need_no_family(toy: Any) -> None:
    assert shapes(named(toy, "viseme_aa", "Viseme-PP", "jaw_open")) == {
        "viseme_aa": "viseme_aa", "viseme_PP": "Viseme-PP", "jaw_open": "jaw_open",
    }  # fmt: skip


def test_the_plainest_of_several_blinks_is_taken_and_a_long_one_is_not(toy: Any) -> None:
    assert shapes(named(toy, "blink_slow", "blink_med", "eyes_closed_pose"))["blink"] == "blink_med"
    assert "blink" not in shapes(named(toy, "blinking around", seconds=3.0))


def test_a_clip_whose_file_is_missing_shows_nothing(toy: Any) -> None:
    project = named(toy, "blink")
    gone = replace(project, clips={i: replace(c, motion=None) for i, c in project.clips.items()})
    assert find_clip_shapes(project) and not find_clip_shapes(gone)
