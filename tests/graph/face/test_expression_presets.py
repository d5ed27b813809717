"""VRM's presets of faces that name their targets otherwise."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.graph.face.expression_presets import PRESETS, make_presets, measure_presets
from sample_clips.make.face_targets import TARGETS

EYES = ("eyeBlinkLeft", "eyeBlinkRight", "eyeWideLeft", "eyeLookUpLeft", "eyeLookUpRight", "eyeLookInLeft")


def test_a_face_without_targets_has_no_presets() -> None:
    assert make_presets([]) == {} and make_presets(["muscle_07"]) == {}


def test_our_characters_make_every_preset() -> None:
    made = make_presets(TARGETS)
    assert made.keys() == PRESETS.keys()
    assert all(0 < weight <= 1 and name in TARGETS for mix in made.values() for name, weight in mix.items())
    assert made["happy"]["mouthSmileLeft"] > made["relaxed"]["mouthSmileLeft"] > 0
    assert made["aa"]["jawOpen"] > made["ih"]["jawOpen"]


def test_arkits_eyes_make_the_presets_of_the_eyes() -> None:
    made = make_presets(EYES)
    assert made["blink"] == {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}
    assert made["blinkLeft"] == {"eyeBlinkLeft": 1.0}
    assert made["lookUp"] == {"eyeLookUpLeft": 1.0, "eyeLookUpRight": 1.0}
    assert made["lookRight"] == {"eyeLookInLeft": 1.0}


def test_what_is_called_like_a_preset_is_it() -> None:
    made = make_presets(["Fcl.Happy", "blink_L", "Blink", "A", "I", "U", "E", "O", "Angry"])
    assert made["happy"] == {"Fcl.Happy": 1.0} and made["angry"] == {"Angry": 1.0}
    assert made["blink"] == {"Blink": 1.0} and made["aa"] == {"A": 1.0}
    assert "sad" not in made


def test_what_the_user_bound_counts() -> None:
    assert make_presets(["mouth_wide_open", "x"], {"viseme_aa": "x"})["aa"] == {"x": 1.0}


def test_a_face_is_taken_for_as_few_presets_as_explain_it():
    mixes = make_presets(("eyeBlinkLeft", "eyeBlinkRight", "jawOpen", "mouthSmileLeft", "mouthSmileRight"))
    held = measure_presets(mixes, {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0, "jawOpen": 0.0})
    assert held["blink"] == pytest.approx(1.0)
    assert held["blinkLeft"] == held["blinkRight"] == 0.0
    left = measure_presets(mixes, {"eyeBlinkLeft": 0.5, "eyeBlinkRight": 0.0})
    assert left["blinkLeft"] == pytest.approx(0.5) and left["blinkRight"] == 0.0


def test_an_open_jaw_is_a_vowel_and_not_surprise():
    held = measure_presets(make_presets(("jawOpen",)), {"jawOpen": np.array([0.0, 0.3])})
    assert held["aa"][1] > 0 and held["aa"][0] == 0.0
    assert not held["surprised"].any()


def test_a_face_that_makes_no_preset_holds_none():
    assert measure_presets({}, {"jawOpen": 1.0}) == {}
    assert measure_presets(make_presets(("jawOpen",)), {"tail": 1.0}) == {}
