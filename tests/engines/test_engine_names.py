"""Names and numbers by which engines call actions: letters of any script, and nobody else's business."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from metagraph.common.file_names import fold_file_name
from metagraph.engines.engine_machine import list_machines
from metagraph.engines.engine_names import MOST, assign_numbers, name_apart, write_word
from metagraph.engines.targets import registry
from metagraph.engines.targets.godot_tree import spell_for_godot
from metagraph.graph import edits
from metagraph.graph.model import Project

NAMED = {
    "rest short": "махнуть рукой",
    "rest beat lf": "नमस्ते",
    "rest wave rt": "手招き！",
    "rest long": "Grüßen",
    "up beat": "👋🏽",
    "up point": "→",
}
MACHINES = (
    "xstate",
    "scxml",
    "godot-tree",
    "unity-controller",
    "playcanvas",
    "interactivity",
    "sumerian",
    "smartbody",
)


@pytest.fixture
def named(toy: Any) -> Project:
    project: Project = toy.project()
    for name, own in NAMED.items():
        project = edits.update_actions(project, [toy.id(project, name)], name=own)
    return edits.rename_stance(project, toy.id(project, "far"), "далеко")


def named_states(project: Project) -> dict[str, tuple[str, int]]:
    return {s.action.id: (s.name, s.number) for m in list_machines(project) for s in m.states}


@pytest.mark.parametrize(
    ("text", "word"),
    [("to  on-hips", "to_on_hips"), ("ｗａｖｅ １", "wave_1"), ("e\u0301tude", "étude"), ("½ turn", "1_2_turn"),
     ("نعم، لا", "نعم_لا"), ("✌️", ""), ("\ud800", ""), ("नमस्ते", "नमस्ते"), ("_x_", "x")],
)  # fmt: skip
def test_words_keep_letters_marks_and_digits_of_every_script(text: str, word: str) -> None:
    assert write_word(text) == word


def test_an_id_stands_behind_a_name_that_is_there_already_and_files_are_apart_on_every_system() -> None:
    assert name_apart({"a1": "wave", "a2": "wave", "a3": "nod"}) == {
        "a1": "wave",
        "a2": "wave_a2",
        "a3": "nod",
    }
    assert name_apart({"a1": "wave", "a2": "Wave"}, fold_file_name) == {"a1": "wave", "a2": "Wave_a2"}


def test_numbers_derive_from_ids_and_are_exact_in_single_precision() -> None:
    idents = ["a7", "b7", "a123456789", "指"]
    numbers = assign_numbers(idents)
    assert numbers["a7"] == 7
    assert len({*numbers.values()}) == len(idents) and all(0 < n < MOST for n in numbers.values())
    assert assign_numbers(idents[2:]) == {i: numbers[i] for i in idents[2:]}


def test_states_have_the_letters_of_their_names_else_their_ids(named: Project, toy: Any) -> None:
    names = {toy.id(named, own): own for own in NAMED.values()}
    states = {names[i]: name for i, (name, _) in named_states(named).items() if i in names}
    assert [states[own] for own in list(NAMED.values())[:4]] == [
        "arms_махнуть_рукой", "arms_नमस्ते", "arms_手招き", "arms_Grüßen"
    ]  # fmt: skip
    assert all(states[own] == f"arms_{toy.id(named, own)}" for own in ("👋🏽", "→"))
    (arms,) = list_machines(named)
    assert arms.stance_words[toy.id(named, "далеко")] == "далеко"


def test_removing_an_action_changes_neither_name_nor_number_of_another(named: Project) -> None:
    whole = named_states(named)
    for action in [a for a in named.actions() if a.kind != "stance"]:
        left = named_states(edits.remove_actions(named, [action.id]))
        assert left == {i: state for i, state in whole.items() if i in left}
        assert len(left) == len(whole) - 1


def test_actions_of_one_name_are_told_apart_by_their_stances_and_no_name_passes_to_another(
    sample: Project,
) -> None:
    """A program that asks for what was removed hears that there is no such state; it never plays another."""
    whole, actions = named_states(sample), {action.id: action for action in sample.actions()}
    by_stance = {
        sample.graphs["arms"].stances[actions[ident].stance].name: name
        for ident, (name, _) in whole.items()
        if actions[ident].name == "shrug_bt_01"
    }
    assert by_stance["on hips"] == "arms_shrug_bt_01_on_hips"
    assert by_stance["hands at sides"] == "arms_shrug_bt_01_hands_at_sides"
    assert "arms_to_on_hips_from_arms_crossed" in {name for name, _ in whole.values()}
    twin = edits.update_actions(sample, [_of_name(sample, "air_quotes_bt_01")], name="heart_rt_01")
    states = named_states(twin)
    alike = [action.id for action in twin.actions() if action.name == "heart_rt_01"]
    assert [states[i][0] for i in alike] == [f"arms_heart_rt_01_hands_at_sides_{i}" for i in alike]
    for action in [a for a in sample.actions() if a.kind == "gesture"][::7]:
        left = named_states(edits.remove_actions(sample, [action.id]))
        others = {name for ident, (name, _) in whole.items() if ident != action.id}
        assert whole[action.id][0] not in {name for name, _ in left.values()}
        assert len({name for name, _ in left.values()} - others) <= 1  # the last of a name needs no stance


def _of_name(project: Project, name: str) -> str:
    return next(action.id for action in project.actions() if action.name == name)


@pytest.mark.parametrize("target", MACHINES)
def test_every_target_has_the_real_name_beside_the_id_that_stands_for_it(
    named: Project, tmp_path: Path, toy: Any, target: str
) -> None:
    made = registry.write_for_target(named, target, tmp_path)
    texts = [p.read_text(errors="replace") for p in made.files if p.suffix not in (".anim", ".bvh", ".meta")]
    text = re.sub(r"\\[uU]([0-9a-fA-F]{8}|[0-9a-fA-F]{4})", _character, "\n".join(texts))
    assert f"arms_{toy.id(named, '→')}" in text
    assert "arms_махнуть_рукой" in text
    if target != "sumerian":  # whose table knows no other field
        assert "→" in text and "махнуть рукой" in text


def _character(escape: re.Match[str]) -> str:
    return chr(int(escape[1], 16))


@pytest.mark.parametrize("target", [*MACHINES, "usd"])
def test_no_file_of_a_target_is_called_otherwise_when_an_action_is_removed(
    named: Project, tmp_path: Path, toy: Any, target: str
) -> None:
    few = edits.remove_actions(named, [toy.id(named, "махнуть рукой")])
    whole, left = (
        {p.name for p in registry.write_for_target(project, target, tmp_path / name).files}
        for name, project in (("whole", named), ("left", few))
    )
    assert left <= whole


def test_usd_calls_actions_of_other_letters_by_their_ids(named: Project, tmp_path: Path, toy: Any) -> None:
    text = next(
        p for p in registry.write_for_target(named, "usd", tmp_path).files if p.suffix == ".usda"
    ).read_text()
    assert re.search(rf'def "\w*_{toy.id(named, "नमस्ते")}" \(\s+displayName = "नमस्ते"', text)


@pytest.mark.parametrize(
    ("name", "spelt"),
    [("idle loop", "idle_loop_gesture"), ("Idle-Cycle 2", "Idle_Cycle_2_gesture"), ("motorcycle", "motorcycle_gesture"),
     ("loop mode", "loop_mode_gesture"), ("loops.001", "loops_001_gesture"), ("cycle", "cycle_gesture"),
     ("loop around", "loop_around"), ("cyclist", "cyclist")],
)  # fmt: skip
def test_godots_importers_neither_rename_an_animation_nor_make_a_loop_of_it(
    toy: Any, name: str, spelt: str
) -> None:
    project = edits.update_actions(toy.project(), [toy.id(toy.project(), "rest short")], name=name)
    names = [s.name for m in list_machines(project, spell_for_godot) for s in m.states]
    assert f"arms_{spelt}" in names
    assert not [n for n in names if _godot_loops(n) or _godot_renames(n)]


def _godot_loops(name: str) -> bool:
    """Whether Godot's reader of glTF makes a loop of an animation."""
    low = name.lower()
    return low.startswith(("loop", "cycle")) or low.endswith(("loop", "cycle"))


def _godot_renames(name: str) -> bool:
    """Whether the importer of scenes of some Godot takes the end of a name off."""
    low = name.lower().rstrip("0123456789_. ")
    return any(
        low.endswith((f"-{end}", f"_{end}")) or f"${end}" in low
        for end in ("loop", "loops", "loop_mode", "cycle")
    )


def test_names_of_stances_that_are_the_same_are_told_apart_by_their_ids(toy: Any) -> None:
    project = toy.project()
    arms = project.graphs["arms"]
    stances = {i: replace(s, name="same") for i, s in arms.stances.items()}
    project = replace(project, graphs={**project.graphs, "arms": replace(arms, stances=stances)})
    (machine,) = list_machines(project)
    first, *rest = stances
    assert machine.stance_words == {first: "same", **{i: f"same_{i}" for i in rest}}
    numbers = json.loads(json.dumps(machine.stances))
    assert numbers == assign_numbers(stances)
