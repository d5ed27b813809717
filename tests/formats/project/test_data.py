"""A project as plain data and back."""

from __future__ import annotations

import copy
import random
import re
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.formats.project.data import decode_skeleton, encode_skeleton, from_data, to_data
from metagraph.formats.project.fields import DataError
from metagraph.graph import edits
from metagraph.graph.conversation.edits import add_conversation
from metagraph.graph.conversation.model import EVERYBODY, Conversation, Segment, Side
from metagraph.graph.manual import edits as manual_edits
from metagraph.graph.manual.machine import ANY
from metagraph.graph.model import LAYERS, Project
from tests.projects import SKELETON, clip, projects
from tests.thorough import many

pytestmark = pytest.mark.usefixtures("numbered_ids")


def small() -> Project:
    """One of everything."""
    project = edits.add_clips(
        Project("small"), [(f"{n}.glb", 0, "ab" * 32, clip(n)) for n in ("idle", "wave", "sit", "down")]
    )
    project = edits.add_stance(project, "arms", "rest", ["c1"])
    project = edits.add_stance(project, "arms", "seated", ["c3"])
    project = edits.place_clips(project, ["c2"], "arms", "gesture", "s5")
    project = edits.place_clips(project, ["c4"], "arms", "transition", "s5", "s7")
    project = edits.set_weight(project, "arms", "head", 0.5)
    project = edits.set_part(edits.set_role(project, "hips", "Hips"), ["Head"], "spine")
    project = manual_edits.add_states(project, ["c1", "c2"], "arms", 10, 20)
    project = manual_edits.add_link(manual_edits.add_link(project, "arms", "m11", "m12"), "arms", ANY, "m11")
    return edits.set_base(project, "c1", 3)


@pytest.mark.nightly
@settings(max_examples=80, deadline=None)
@given(projects())
def test_a_project_comes_back_from_its_data(project: Project) -> None:
    assert from_data(to_data(project)) == project


def test_an_empty_project_comes_back() -> None:
    assert from_data(to_data(Project())) == Project()


def test_what_is_at_its_default_is_left_out() -> None:
    action = to_data(small())["layers"]["arms"]["actions"][2]
    assert action == {
        "id": "a9",
        "clip": "c2",
        "kind": "gesture",
        "stance": "s5",
        "name": "wave",
        "blend_out": 0.25,
    }


def test_times_are_rounded_to_a_microsecond_but_nothing_becomes_zero() -> None:
    project = edits.update_actions(
        small(), ["a9"], likelihood=1.23456789e-9, timing={"start": 0.1 + 0.2, "end": 1 / 3}
    )
    action = to_data(project)["layers"]["arms"]["actions"][2]
    assert (action["start"], action["end"], action["likelihood"]) == (0.3, 0.333333, 1.23457e-9)


def test_only_weights_of_joints_that_move_in_part_are_written_and_come_back() -> None:
    project = edits.update_actions(small(), ["a9"], joint_weights=(("Head", 0.25), ("Hips", 1 / 3)))
    data = to_data(project)
    first, soft = (data["layers"]["arms"]["actions"][n] for n in (0, 2))
    assert "joint_weights" not in first and soft["joint_weights"] == {"Head": 0.25, "Hips": 0.333333}
    soft["joint_weights"]["Tail"] = 1
    back = from_data(data).action("a9")
    assert back is not None and back.joint_weights == (("Head", 0.25), ("Hips", 0.333333))


@pytest.mark.parametrize("value", [float("nan"), float("inf"), 1e300])
def test_a_number_that_could_not_be_read_back_is_not_written(value: float) -> None:
    project = edits.update_actions(small(), ["a9"], likelihood=value)
    with pytest.raises(DataError, match="not a number") as caught:
        to_data(project)
    assert "wave" in caught.value.where
    assert "likelihood" in caught.value.where


def test_a_skeleton_comes_back_to_the_bit() -> None:
    back = decode_skeleton(encode_skeleton(SKELETON))
    assert back == SKELETON
    assert (back.rest_rotations == SKELETON.rest_rotations).all()
    assert (back.rest_translations == SKELETON.rest_translations).all()


WRONG: list[tuple[tuple[Any, ...], Any, str]] = [
    # where, what stands there instead, what the error says
    (("clips",), 3, "clips should be a list"),
    (("clips", 0), [], r"clips\[0\] should be fields, found a list"),
    (("clips", 0, "id"), 7, r"clips\[0\].id should be text, found 7"),
    (("clips", 0, "id"), "", r"clips\[0\].id should not be empty"),
    (("clips", 1, "id"), "c1", r"clips\[1\].id 'c1' is used twice"),
    (("clips", 0, "fps"), 0, r"clips\[0\].fps should be between"),
    (("clips", 0, "fps"), "30", r"clips\[0\].fps should be a number, found '30'"),
    (("clips", 0, "take"), -1, r"clips\[0\].take should be between"),
    (("clips", 0, "take"), 0.5, r"clips\[0\].take should be a whole number"),
    (("clips", 0, "frames"), 10**400, r"clips\[0\].frames should be a finite number, found a huge number"),
    (("clips", 0, "path"), None, r"clips\[0\].path should be text, found nothing"),
    (("clips", 0, "sha256"), [], r"clips\[0\].sha256 should be text"),
    (("clips", 0, "colour"), "red", r"clips\[0\].colour is not a field known here"),
    (("layers",), [], "layers should be fields"),
    (("layers", "legs"), {}, "layers.legs is not a field"),
    (("layers", "arms"), 1, "layers.arms should be fields"),
    (("layers", "arms", "start"), 5, "layers.arms.start should be text"),
    (("layers", "arms", "weights"), {"tail": 1}, "layers.arms.weights should be one of legs"),
    (("layers", "arms", "weights"), {"head": "much"}, "layers.arms.weights.head should be a number"),
    (("layers", "arms", "weights"), {1: 1}, "layers.arms.weights should be fields with names"),
    (("layers", "arms", "stances", 0), {"id": "s5"}, r"stances\[0\].name is missing"),
    (("layers", "arms", "stances", 1, "id"), "s5", "'s5' is used twice"),
    (("layers", "head", "stances"), [{"id": "s5", "name": "x"}], "'s5' is used twice"),
    (
        ("layers", "arms", "actions", 2, "kind"),
        "dance",
        r"actions\[2\].kind should be one of stance, gesture",
    ),
    (("layers", "arms", "actions", 2, "kind"), ["gesture"], "kind should be text"),
    (("layers", "arms", "actions", 2, "limb"), "tail", "limb should be one of left"),
    (("layers", "arms", "actions", 2, "likelyhood"), 2, "did you mean 'likelihood'"),
    (("layers", "arms", "actions", 2, "likelihood"), float("nan"), "should be a finite number"),
    (("layers", "arms", "actions", 2, "likelihood"), float("inf"), "should be a finite number"),
    (("layers", "arms", "actions", 2, "likelihood"), True, "likelihood should be a number, found True"),
    (("layers", "arms", "actions", 2, "start"), "soon", "start should be a number, found 'soon'"),
    (("layers", "arms", "actions", 2, "loop"), "yes", "loop should be true or false"),
    (("layers", "arms", "actions", 2, "tags"), ["a", 1], "tags should be a list of texts"),
    (("layers", "arms", "actions", 2, "tags"), "a", "tags should be a list, found 'a'"),
    (("layers", "arms", "actions", 2, "name"), {}, "name should be text, found fields"),
    (("parts",), {"Head": "tail"}, "parts.Head should be one of"),
    (("roles",), {"hips": 3}, "roles.hips should be text"),
    (("base", "frame"), -1, "base.frame should be 0 or more"),
    (("base", "clip"), 3, "base.clip should be text"),
    (("settings",), {"seed": 2**32}, "settings.seed should be between"),
    (("settings",), {"seed": -1}, "settings.seed should be between"),
    (("settings",), {"alpha": "four"}, "settings.alpha should be a number"),
    (("settings",), {"speed": 1}, "settings.speed is not a field"),
    (("markov",), {"tail": {}}, "markov.tail is not a field"),
    (
        ("markov",),
        {"arms": {"states": ["left dance"], "matrix": [[1]]}},
        "markov.arms.states should be one of",
    ),
    (("markov",), {"arms": {"states": [3], "matrix": [[1]]}}, "markov.arms.states should be one of"),
    (("markov",), {"arms": {"states": ["left gesture"], "matrix": []}}, "matrix should have 1 rows"),
    (("markov",), {"arms": {"states": [], "matrix": []}}, "matrix should have 1 rows"),
    (("markov",), {"arms": {"states": ["left gesture"], "matrix": [[0.5]]}}, "probabilities that sum to 1"),
    (("markov",), {"arms": {"states": ["left gesture"], "matrix": [1]}}, "should be 1 numbers"),
    (
        ("markov",),
        {"arms": {"states": ["left gesture"], "matrix": [[1]], "gap": 0}},
        "markov.arms.gap should be",
    ),
    (
        ("markov",),
        {"arms": {"states": ["left gesture"], "matrix": [[1]], "tags": ["x"]}},
        "markov.arms.tags is not a field",
    ),
    (
        ("markov",),
        {"arms": {"states": ["left gesture"], "matrix": [[1]], "lengths": [[1, 1], [1, 1]]}},
        "lengths should be 1 pairs",
    ),
    (
        ("markov",),
        {"arms": {"states": ["left gesture"], "matrix": [[1]], "lengths": [1]}},
        "lengths should be 2 numbers",
    ),
    (
        ("markov",),
        {"arms": {"states": ["left gesture"], "matrix": [[1]], "lengths": [[0, 1]]}},
        "means above 0",
    ),
    (
        ("markov",),
        {"arms": {"states": ["left gesture"], "matrix": [[1]], "lengths": [[1, -1]]}},
        "deviations of 0 or more",
    ),
    (
        ("markov",),
        {"arms": {"states": ["left gesture"], "matrix": [[1]], "lengths": [[1, float("nan")]]}},
        "lengths should be 2 numbers",
    ),
    (("skeleton", 0, "parent"), "Head", "'Head' does not come before joint 'Hips'"),
    (("layers", "arms", "actions", 2, "joint_weights"), [], "joint_weights should be fields"),
    (("layers", "arms", "actions", 2, "joint_weights"), {"Head": "half"}, "joint_weights.Head should be a"),
    (("layers", "arms", "actions", 2, "joint_weights"), {"Head": 0}, "joint_weights.Head should be above 0"),
    (("layers", "arms", "actions", 2, "joint_weights"), {"Head": 1.5}, "and at most 1, found 1.5"),
    (
        ("manual", "arms", "states", 0, "joint_weights"),
        {"Head": -1},
        r"states\[0\].joint_weights.Head should",
    ),
    (("skeleton", 1, "name"), "Hips", "'Hips' is used twice"),
    (("skeleton", 1, "at"), [0, 1], r"skeleton\[1\].at should be 3 numbers"),
    (("skeleton", 1, "at"), [0, 1, 1e300], "should be 3 numbers"),
    (("skeleton", 1, "turn"), [0, 0, 0, 0], "quaternion of length 1"),
    (("name",), 3, "name should be text"),
    (("character",), 3, "character should be text"),
    (("colour",), "red", "colour is not a field"),
    (("manual",), [], "manual should be fields"),
    (("manual", "legs"), {}, "manual.legs is not a field"),
    (("manual", "arms"), None, "manual.arms should be fields"),
    (("manual", "arms", "start"), "m99", "manual.arms.start 'm99' is not a state of the arms layer"),
    (("manual", "arms", "any_x"), "left", "manual.arms.any_x should be a number"),
    (("manual", "arms", "states", 1, "id"), "m11", "'m11' is used twice"),
    (("manual", "arms", "states", 0, "limb"), "tail", r"states\[0\].limb should be one of left"),
    (("manual", "arms", "states", 0, "weight"), 1, r"states\[0\].weight is not a field"),
    (("manual", "arms", "states", 0, "x"), float("nan"), r"states\[0\].x should be a finite number"),
    (("manual", "arms", "links", 0, "when"), "soon", r"links\[0\].when should be one of finished, request"),
    (("manual", "arms", "links", 0, "target"), "any", r"links\[0\].target 'any' is not a state"),
    (("manual", "arms", "links", 0, "source"), "m99", r"links\[0\].source 'm99' is not a state"),
    (("manual", "arms", "links", 1, "blend"), "long", r"links\[1\].blend should be a number"),
    (("manual", "head"), {"states": [{"id": "m11", "clip": "c1", "name": "x"}]}, "'m11' is used twice"),
    (
        ("manual", "head"),
        {"states": [{"id": "m90", "clip": "c1"}]},
        r"manual.head.states\[0\].name is missing",
    ),
]


def broken(data: Any, where: tuple[Any, ...], value: Any) -> Any:
    data = copy.deepcopy(data)
    inside = data
    for key in where[:-1]:
        inside = inside[key]
    inside[where[-1]] = value
    return data


@pytest.mark.parametrize(
    ("where", "value", "message"),
    WRONG,
    ids=lambda x: str(x)[:40] if not isinstance(x, tuple) else ".".join(map(str, x)),
)
def test_a_wrong_field_is_named_with_what_is_wrong(where: tuple[Any, ...], value: Any, message: str) -> None:
    with pytest.raises(DataError) as caught:
        from_data(broken(to_data(small()), where, value))
    assert re.search(message, f"{caught.value.where} {caught.value}"), f"{caught.value.where} {caught.value}"


@pytest.mark.parametrize("data", [None, 3, "x", [], [1], {}, {"name": "x"}, {"metagraph": None}])
def test_other_data_is_no_project(data: Any) -> None:
    if data == {"metagraph": None}:
        assert from_data(data) == Project()  # the version is for the file's reader to judge
        return
    with pytest.raises(DataError, match="not a Metagraph project"):
        from_data(data)


def test_fields_left_empty_are_as_if_they_were_not_there() -> None:
    assert (
        from_data(
            {
                "metagraph": 1,
                "clips": None,
                "layers": None,
                "roles": None,
                "parts": None,
                "settings": None,
                "skeleton": None,
            }
        )
        == Project()
    )


JUNK = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(max_size=5),
    st.just(10**400),
    st.just(-(10**20)),
    st.lists(st.integers(), max_size=3),
    st.dictionaries(st.text(max_size=3), st.integers(), max_size=2),
    st.just({1: 2}),
    st.just([[[]]]),
)


@pytest.mark.nightly
@settings(max_examples=many(120, 1000), deadline=None)
@given(st.randoms(use_true_random=False), JUNK)
def test_whatever_stands_in_a_field_the_error_says_where(chance: random.Random, junk: Any) -> None:
    data = copy.deepcopy(to_data(small()))
    inside: Any = data
    while True:
        keys = list(inside) if isinstance(inside, dict) else list(range(len(inside)))
        key = chance.choice(keys)
        if isinstance(inside[key], dict | list) and inside[key] and chance.random() < 0.8:
            inside = inside[key]
            continue
        inside[key] = junk
        break
    try:
        project = from_data(data)
    except DataError as error:
        assert error.where
        assert len(str(error)) < 300
    else:
        assert to_data(from_data(to_data(project))) == to_data(
            project
        )  # except for what lies below a microsecond


def test_every_layer_is_there_whatever_the_data_holds() -> None:
    assert set(from_data({"metagraph": 1}).graphs) == set(LAYERS)
    assert replace(from_data({"metagraph": 1}), name="untitled") == Project()


def test_what_three_say_to_whom_and_where_they_stand_is_kept_and_of_two_nothing_is_added() -> None:
    three = Conversation(
        name="three",
        length=9.0,
        sides=(
            Side(name="a", place=(0.5, -1.0), segments=(Segment("clause", 0, 1, 0.5, "", 2),)),
            Side(name="b", segments=(Segment("clause", 2, 3, None, "", EVERYBODY),)),
            Side(name="c", segments=(Segment("clause", 4, 5),)),
        ),
    )
    project = add_conversation(Project(), three)[0]
    data = to_data(project)
    assert from_data(data) == project
    (kept,) = data["conversations"].values()
    first, second, third = kept["sides"]
    assert first["place"] == [0.5, -1.0] and first["segments"][0]["to"] == 2
    assert second["segments"][0]["to"] == -1 and "place" not in second
    assert set(third["segments"][0]) == {"kind", "start", "end"}


def test_a_segment_said_to_who_is_not_there_is_told_by_its_place() -> None:
    side = {"name": "a", "segments": [{"kind": "clause", "start": 0, "end": 1, "to": 3}]}
    data = {"metagraph": 1, "conversations": {"v1": {"name": "t", "length": 2.0, "sides": [side, {}, {}]}}}
    with pytest.raises(DataError, match="side 3") as caught:
        from_data({**to_data(Project()), **data})
    assert caught.value.where.startswith("conversations")
