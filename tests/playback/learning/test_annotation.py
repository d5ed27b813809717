"""What tiers and labels are taken for: guessed from the words people use, and remembered as they corrected
it.
"""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest

from metagraph.formats.elan import read_elan
from metagraph.playback.learning.annotation import (
    MEANINGS,
    ROLES,
    Annotation,
    AnnotationInterval,
    AnnotationTier,
    Label,
    find_annotated_again,
    guess_meaning,
    guess_role,
    guess_roles,
    is_covering,
    is_meaning,
    label_notes,
    list_labels,
    read_other_annotator,
    split_meaning,
    split_tier_names,
)

SAMPLE = Path(__file__).resolve().parents[3] / "sample_clips" / "annotation" / "conversation.eaf"

NAMES = {
    "left arm": [
        "LH",
        "Left hand",
        "left_arm",
        "LeftArm",
        "Left",
        "L-Hand",
        "Gesture L",
        "GesturePhase_L",
        "linke Hand",
        "Hand links",
        "main gauche",
        "mano izquierda",
        "LH@speaker2",
        "LH-Phase",
    ],
    "right arm": ["RH", "right hand", "rechte Hand", "RightHandGesture", "R_Arm", "main droite", "Right"],
    "arms": ["Gestures", "gesture phase", "Hands", "both hands", "BH", "arms", "Gesten", "phases"],
    "head action": [
        "Head",
        "head movement",
        "Kopf",
        "Kopfbewegung Kopf",
        "Nods",
        "HeadAction",
        "head_nod",
        "tête",
    ],
    "head stance": ["Head stance", "head tilt", "Kopf Haltung", "Head-Position", "HeadPose"],
    "body": [
        "Body",
        "Torso",
        "posture",
        "Legs",
        "weight shift",
        "Körper",
        "Rumpf",
        "Körperhaltung",
        "Oberkörper",
    ],
    "ignore": [
        "default",
        "text",
        "words-pos",
        "Utterance",
        "speech left",
        "Right eye",
        "gaze head",
        "hand gesture meaning",
        "A1",
        "Left hand handshape",
        "notes",
        "12",
        "",
        "___",
        "gest-comments",
        "facial expression",
        "language",
    ],
}


def of(
    name: str, *texts: str, length: float = 0.5, step: float = 1.0, participant: str = ""
) -> AnnotationTier:
    """A tier of intervals `step` seconds apart."""
    return AnnotationTier(
        name,
        tuple(AnnotationInterval(n * step, n * step + length, t) for n, t in enumerate(texts)),
        participant,
    )


@pytest.mark.parametrize(("role", "name"), [(role, name) for role, names in NAMES.items() for name in names])
def test_a_role_is_guessed_from_a_tiers_name(role: str, name: str) -> None:
    assert guess_role(AnnotationTier(name)) == role


def test_a_name_that_says_nothing_leaves_it_to_the_labels() -> None:
    assert guess_role(of("tier 1", "prep", "stroke", "hold", "what?")) == "arms"
    assert guess_role(of("tier 1", "nod", "nodding", "shake")) == "head action"
    assert guess_role(of("tier 1", "well", "I see", "nod")) == "ignore"
    assert guess_role(of("tier 1", "rest", "prep", "rest", "rest")) == "arms"
    assert guess_role(of("tier 1", "x", "rest", "")) == "ignore"
    assert guess_role(of("tier 1")) == "ignore"


def test_of_several_people_the_one_with_most_intervals_is_taken() -> None:
    tiers = (
        of("LH", "gesture", participant="A"),
        of("LH@B", "gesture", "gesture"),
        of("RH@B", "gesture"),
        of("Body@B"),
    )
    assert guess_roles(Annotation(tiers)) == {
        "LH": "ignore",
        "LH@B": "left arm",
        "RH@B": "right arm",
        "Body@B": "body",
    }


def test_of_several_tiers_for_one_arm_the_one_with_the_best_known_labels_is_taken() -> None:
    tiers = (
        of("LH name", "cup", "box"),
        of("LH phases", "prep", "stroke"),
        of("LH", "gesture", "fidget"),
        of("LH more", "beat", "beat"),
    )
    assert guess_roles(Annotation(tiers)) == {
        "LH name": "ignore",
        "LH phases": "ignore",
        "LH": "left arm",
        "LH more": "ignore",
    }


def annotated(by: str, name: str, *texts: str) -> AnnotationTier:
    return dataclasses.replace(of(name, *texts), annotator=by)


def test_one_annotators_tiers_are_read_and_those_who_annotated_the_same_again_are_found() -> None:
    annotation = Annotation(
        (
            annotated("AK", "LH", "prep", "stroke", "retraction"),
            annotated("AK", "RH", "gesture"),
            annotated("BM", "LH 2nd", "gesture", "gesture"),
            annotated("BM", "RH 2nd", "gesture"),
            annotated("BM", "Head", "nod"),
        )
    )
    roles = guess_roles(annotation)
    assert roles == {
        "LH": "left arm", "RH": "right arm", "LH 2nd": "ignore", "RH 2nd": "ignore", "Head": "head action",
    }, "the arms of one annotator, though the other's labels are clearer"  # fmt: skip
    again = find_annotated_again(annotation, roles)
    assert [(x.tier, x.annotator, x.role, x.read) for x in again] == [
        ("LH 2nd", "BM", "left arm", "LH"),
        ("RH 2nd", "BM", "right arm", "RH"),
    ]
    other = read_other_annotator(annotation, roles, "BM")
    assert other == {
        "LH": "ignore", "RH": "ignore", "LH 2nd": "left arm", "RH 2nd": "right arm", "Head": "head action",
    }  # fmt: skip
    assert read_other_annotator(annotation, other, "AK") == roles, "and back"
    with pytest.raises(ValueError, match="no tier of annotator 'BM'"):
        read_other_annotator(annotation, other, "BM")


@pytest.mark.parametrize(
    ("names", "who"),
    [
        (("LH rater 1", "LH rater 2"), ("1", "2")),
        (("LH (coder A)", "LH (coder B)"), ("A", "B")),
        (("LH_annotatorAK", "LH"), ("AK", "")),
        (("LH_R1", "LH_R2"), ("R1", "R2")),
        (("LH_R1", "RH_R2"), ("", "")),
        (("rater 1", "rater 2"), ("", "")),
    ],
)
def test_who_annotated_is_known_from_the_end_of_a_name(names: tuple[str, str], who: tuple[str, str]) -> None:
    annotation = Annotation(tuple(of(name, "gesture") for name in names))
    found = split_tier_names(annotation)
    assert tuple(found[name].annotator for name in names) == who
    if who[0]:
        assert {found[name].stem for name in names} == {"LH"}
        assert list(guess_roles(annotation).values()) == ["left arm", "ignore"]


def test_what_is_remembered_comes_before_every_guess_and_the_earlier_memory_first() -> None:
    tiers = (of("LH", "gesture"), of("words", "gesture"), of("RH", "gesture"))
    roles = guess_roles(
        Annotation(tiers), {"words": "left arm", "RH": "nonsense"}, {"words": "body", "RH": "ignore"}
    )
    assert roles == {"LH": "ignore", "words": "left arm", "RH": "ignore"}, (
        "what is said to be the left arm leaves no other one"
    )


MEANT = {
    ("left arm", ""): "ignore",
    ("left arm", "rest"): "ignore",
    ("left arm", "Rest Position"): "ignore",
    ("left arm", "stance"): "ignore",
    ("left arm", "N/A"): "ignore",
    ("left arm", "no gesture"): "ignore",
    ("left arm", "gesture"): "gesture",
    ("left arm", "positive gesture"): "gesture positive",
    ("left arm", "G_neg_gesture"): "gesture negative",
    ("left arm", "beat"): "gesture",
    ("left arm", "deictic-pointing"): "gesture",
    ("left arm", "cup"): "gesture",
    ("left arm", "and then he went up the hill again"): "ignore",
    ("left arm", "I point at it over there and wave"): "ignore",
    ("left arm", "fidget"): "fidget",
    ("left arm", "self-touch"): "fidget",
    ("left arm", "Adaptor"): "fidget",
    ("left arm", "scratching"): "fidget",
    ("left arm", "stance-transition"): "transition",
    ("left arm", "stance change"): "transition",
    ("left arm", "Transition"): "transition",
    ("arms", "prep"): "preparation",
    ("arms", "Preparation"): "preparation",
    ("arms", "gesture prep"): "preparation",
    ("arms", "stroke"): "stroke",
    ("arms", "pre-stroke hold"): "hold",
    ("arms", "post-stroke-hold"): "hold",
    ("arms", "retr"): "retraction",
    ("left arm", "phasic"): "gesture",  # NEUROGES, as the next ones
    ("left arm", "repetitive"): "gesture",
    ("left arm", "irregular"): "fidget",
    ("left arm", "no movement"): "ignore",
    ("left arm", "shift"): "transition",
    ("arms", "spatial relation presentation"): "gesture",
    ("arms", "partial retraction"): "retraction",  # LASG, as the next ones
    ("arms", "rest position"): "ignore",
    ("head action", "nodding"): "gesture positive",
    ("head action", "Nod"): "gesture positive",
    ("head action", "yes"): "gesture positive",
    ("head action", "shaking"): "gesture negative",
    ("head action", "no"): "gesture negative",
    ("head action", "head shake"): "gesture negative",
    ("head action", "tilt"): "transition",
    ("head action", "rest"): "ignore",
    ("head action", "jerk"): "gesture",
    ("head stance", "tilt left"): "transition",
    ("head stance", "stance-transition"): "transition",
    ("head stance", ""): "ignore",
    ("body", "weight left"): "transition",
    ("body", "fidget"): "fidget",
    ("body", "nod"): "transition",
}


@pytest.mark.parametrize(("role", "label"), MEANT)
def test_a_meaning_is_guessed_from_a_label(role: str, label: str) -> None:
    assert guess_meaning(label, role) == MEANT[role, label]
    assert is_meaning(guess_meaning(label, role))


def test_a_tier_that_is_mostly_covered_by_different_labels_names_the_stances_themselves() -> None:
    stances = of("Head stance", "left", "neutral", "left", "right", length=0.9)
    assert is_covering(stances)
    assert not is_covering(of("Head stance", "left", "left", length=0.9)), "one and the same is no change"
    assert not is_covering(of("Head stance", "left", "right", length=0.3))
    assert not is_covering(AnnotationTier("Head stance"))
    found = list_labels(Annotation((stances,)), {"Head stance": "head stance"})
    assert {x.text: x.meaning for x in found} == {"left": "stance", "neutral": "stance", "right": "stance"}


def test_labels_are_counted_by_layer_however_they_are_spelled_the_most_frequent_first() -> None:
    tiers = (
        of("LH", "Gesture", "rest"),
        of("RH", "gesture ", "GESTURE", "beat"),
        of("Head", "nod", "gesture"),
        of("text", "gesture"),
    )
    found = list_labels(Annotation(tiers), guess_roles(Annotation(tiers)))
    assert found == (
        Label("arms", "gesture", 3, "gesture"),
        Label("arms", "rest", 1, "ignore"),
        Label("arms", "beat", 1, "gesture"),
        Label("head", "nod", 1, "gesture positive"),
        Label("head", "gesture", 1, "gesture"),
    )


def test_labels_are_remembered_for_their_layer_or_for_all() -> None:
    tiers = (of("LH", "x", "y"), of("Head", "x"))
    roles = guess_roles(Annotation(tiers))
    found = list_labels(
        Annotation(tiers),
        roles,
        {"x": "fidget calm", "arms: y": "no such meaning"},
        {"head: x": "transition", "y": "hold"},
    )
    assert {x.key: x.meaning for x in found} == {
        "arms: x": "fidget calm",
        "arms: y": "hold",
        "head: x": "fidget calm",
    }
    assert list_labels(Annotation(tiers), roles, label_notes(found)) == found, "what is told comes back"


def test_meanings_are_a_word_and_tags() -> None:
    assert split_meaning("gesture positive strong") == ("gesture", ("positive", "strong"))
    assert split_meaning("ignore") == ("ignore", ())
    assert all(is_meaning(m) for m in MEANINGS) and not is_meaning("") and not is_meaning("dance")


def test_the_sample_annotation_is_understood_without_being_told() -> None:
    annotation = read_elan(SAMPLE)
    roles = guess_roles(annotation)
    assert {r for r in roles.values() if r != "ignore"} == {*ROLES, "speech"} - {"arms"}
    assert {x.key: x.meaning for x in list_labels(annotation, roles)} == {
        "arms: gesture": "gesture",
        "arms: fidget": "fidget",
        "arms: stance-transition": "transition",
        "head: nodding": "gesture positive",
        "head: shaking": "gesture negative",
        "head: stance-transition": "transition",
        "body: stance-transition": "transition",
    }


def test_gesture_phases_of_others_are_found_and_speech_is_not_taken_for_gestures(shared_data: Path) -> None:
    for path in sorted((shared_data / "elan").glob("*.eaf")):
        annotation = read_elan(path)
        roles = {tier: role for tier, role in guess_roles(annotation).items() if role != "ignore"}
        assert roles == ({"gestures": "arms"} if path.stem == "sample_3.0" else {})
        meant = {x.text: x.meaning for x in list_labels(annotation, roles)}
        assert meant == (
            {"prep": "preparation", "hold": "hold", "stroke": "stroke", "retr": "retraction"} if roles else {}
        )
