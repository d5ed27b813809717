"""Edits: pure functions of projects, and the words with which they refuse."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import BasePose, ClipEntry, Limb, Markov, Project, Timing
from metagraph.motion.clip import Clip

pytestmark = pytest.mark.usefixtures("numbered_ids")

EVERY: dict[str, Callable[[Project, Any], Project]] = {
    "add_clips": lambda p, t: edits.add_clips(p, [("new.glb", 0, "d", t.clip("new"))]),
    "with_motions": lambda p, t: edits.with_motions(p, {"c1": t.clip("again")}),
    "rename_clip": lambda p, t: edits.rename_clip(p, "c1", "  other   name "),
    "remove_clips": lambda p, t: edits.remove_clips(p, ["c1", "c5"]),
    "add_stance": lambda p, t: edits.add_stance(p, "head", "still", ["c1"]),
    "rename_stance": lambda p, t: edits.rename_stance(p, t.id(p, "up"), "arms up"),
    "remove_stance": lambda p, t: edits.remove_stance(p, t.id(p, "up")),
    "set_start": lambda p, t: edits.set_start_stance(p, t.id(p, "far")),
    "place": lambda p, t: edits.place_clips(p, ["c5", "c6"], "arms", "fidget", t.id(p, "far")),
    "update_actions": lambda p, t: edits.update_actions(
        p, [t.id(p, "up yawn")], timing={"start": 0.1}, tags=("bored",)
    ),
    "move_actions": lambda p, t: edits.move_actions(p, [t.id(p, "up yawn")], "gesture", t.id(p, "rest")),
    "update_each": lambda p, t: edits.update_each(
        p, {t.id(p, "up yawn"): {"likelihood": 2.0}, t.id(p, "up beat"): {"timing": {"end": 0.5}}}
    ),
    "to_stance": lambda p, t: edits.to_stance(p, [t.id(p, "up yawn"), t.id(p, "up beat")], t.id(p, "rest")),
    "set_kind": lambda p, t: edits.set_kind(p, [t.id(p, "up yawn"), t.id(p, "rest beat lf")], "gesture"),
    "set_ends": lambda p, t: edits.set_ends(p, [t.id(p, "rest to up"), t.id(p, "up yawn")], t.id(p, "far")),
    "remove_actions": lambda p, t: edits.remove_actions(p, [t.id(p, "up yawn")]),
    "set_base": lambda p, t: edits.set_base(p, "c2", 7),
    "set_weight": lambda p, t: edits.set_weight(p, "arms", "spine", 0.4),
    "set_role": lambda p, t: edits.set_role(p, "head", "Neck"),
    "set_part": lambda p, t: edits.set_part(p, ["Neck"], "spine"),
    "set_settings": lambda p, t: edits.set_settings(p, alpha=2.0),
    "set_markov": lambda p, t: edits.set_markov(p, Markov("arms", (("both", "gesture"),), ((1.0,),))),
    "set_character": lambda p, t: edits.set_character(p, "me.glb"),
    "rename_project": lambda p, t: edits.rename_project(p, "mine"),
}


@pytest.mark.parametrize("name", EVERY)
def test_an_edit_leaves_the_given_project_as_it_was_and_undo_is_to_keep_it(name: str, toy: Any) -> None:
    project, twin = toy.project(), toy.project()
    before = (project.clips, project.graphs, dict(project.graphs), dict(project.clips))
    after = EVERY[name](project, toy)
    assert after != project or name == "with_motions"
    assert project == twin
    assert (
        (project.clips, project.graphs) == before[:2]
        and project.graphs == before[2]
        and project.clips == before[3]
    )
    assert EVERY[name](project, toy) == after, "the same edit gives the same project"


# --- clips


def test_the_first_clip_brings_the_skeleton_and_the_last_takes_it_away(toy: Any) -> None:
    project = edits.add_clips(Project(), [("a.glb", 0, "", toy.clip("a"))])
    assert project.skeleton is toy.skeleton and project.clips["c1"] == ClipEntry(
        "c1", "a", "a.glb", 0, "", 31, 30.0
    )
    assert edits.remove_clips(project, ["c1"]).skeleton is None
    assert edits.add_clips(project, []) == project


def test_a_clip_read_again_keeps_its_id_and_name(toy: Any) -> None:
    project = edits.add_clips(
        Project(), [("a.glb", 0, "old", toy.clip("a")), ("a.glb", 1, "old", toy.clip("b"))]
    )
    project = edits.rename_clip(project, "c2", "mine")
    again = edits.add_clips(project, [("a.glb", 1, "new", toy.clip("b", 2.0))])
    assert list(again.clips) == ["c1", "c2"]
    assert (again.clips["c2"].name, again.clips["c2"].frames, again.clips["c2"].digest) == ("mine", 61, "new")


def test_removing_a_clip_removes_its_actions_and_a_base_pose_taken_from_it(toy: Any) -> None:
    project = toy.project()
    base = project.base.clip
    after = edits.remove_clips(project, [base, "unknown"])
    assert base not in after.clips and after.base == BasePose()
    assert not [a for a in after.actions() if a.clip == base]
    assert len(list(after.actions())) == len(list(project.actions())) - 1


@pytest.mark.parametrize(
    ("name", "limb"),
    [
        ("wave_lf_01", "left"), ("wave_rt", "right"), ("beat_bt", "both"), ("LeftWave", "left"),
        ("waveRight", "right"), ("nod", "both"),
        ("L_wave", "left"), ("wave-R", "right"), ("wave.l", "left"), ("beat both left", "both"),
        ("later", "both"), ("alert", "both"),
        ("wave_left2", "left"), ("2h_wave", "both"), ("", "both"), ("right", "right"), ("Lift", "both"),
        ("LR_clap", "both"),
    ],
)  # fmt: skip
def test_the_limb_is_guessed_from_the_name(name: str, limb: Limb) -> None:
    assert edits.guess_limb(name) == limb


# --- stances


def test_the_first_stance_is_where_a_performance_starts_and_the_next_takes_its_place(toy: Any) -> None:
    project = toy.project()
    rest, up = toy.id(project, "rest"), toy.id(project, "up")
    assert project.graphs["arms"].start == rest
    project = edits.remove_stance(project, rest)
    assert project.graphs["arms"].start == up
    project = edits.remove_stance(edits.remove_stance(project, up), toy.id(project, "far"))
    assert project.graphs["arms"].start is None and not project.graphs["arms"].actions


def test_removing_a_stance_takes_transitions_into_it_along(toy: Any) -> None:
    project = toy.project()
    after = edits.remove_stance(project, toy.id(project, "up"))
    assert {a.name for a in project.actions()} - {a.name for a in after.actions()} == {
        "up loop", "up beat", "up point", "up yawn", "up to rest", "up to far", "rest to up", "far to up",
    }  # fmt: skip


def test_names_of_stances_are_made_different_and_never_empty(toy: Any) -> None:
    project = edits.add_stance(edits.add_stance(toy.project(), "arms", " up "), "arms", "up")
    assert [s.name for s in project.graphs["arms"].stances.values()] == ["rest", "up", "far", "up 2", "up 3"]
    with pytest.raises(EditError, match="at least one letter"):
        edits.add_stance(project, "arms", "  ")
    with pytest.raises(EditError, match="at least one letter"):
        edits.rename_project(project, "\t")


@pytest.mark.parametrize(
    "edit", [edits.remove_stance, edits.set_start_stance, lambda p, s: edits.rename_stance(p, s, "x")]
)
def test_a_stance_that_is_gone_is_said_to_be_gone(edit: Any, toy: Any) -> None:
    with pytest.raises(EditError, match="no longer"):
        edit(toy.project(), "s999")


def test_a_clip_that_is_gone_is_said_to_be_gone(toy: Any) -> None:
    with pytest.raises(EditError, match="no longer"):
        edits.rename_clip(toy.project(), "c999", "x")
    with pytest.raises(EditError, match="not in this project"):
        edits.set_base(toy.project(), "c999")


# --- actions


def test_dropped_on_the_middle_of_an_empty_layer_a_clip_makes_a_stance(toy: Any) -> None:
    project = edits.place_clips(toy.project(), ["c5", "c6"], "head", "stance", None)
    [stance] = project.graphs["head"].stances.values()
    assert stance.name == "rest beat lf" and len(project.graphs["head"].of(stance.id, "stance")) == 2


def test_refusals_say_what_to_do(toy: Any) -> None:
    project = toy.project()
    rest, up = toy.id(project, "rest"), toy.id(project, "up")
    assert edits.find_placing_refusal(project, [], "arms", "gesture", rest) == "nothing to place"
    for clip, layer, kind, stance, end, piece in (
        ("c999", "arms", "gesture", rest, None, "not in this project"),
        ("c1", "head", "gesture", None, None, "the head layer"),
        ("c1", "head", "gesture", rest, None, "the head layer"),
        ("c1", "arms", "transition", rest, None, "ends in"),
        ("c1", "arms", "transition", rest, rest, "another stance"),
    ):
        assert piece in (edits.find_placing_refusal(project, [clip], layer, kind, stance, end) or ""), (
            clip,
            kind,
            end,
        )
    assert edits.find_placing_refusal(project, ["c1"], "arms", "transition", rest, up) is None
    assert edits.find_placing_refusal(project, ["c1"], "arms", "stance", None) is None
    with pytest.raises(EditError, match="choose the stance"):
        edits.place_clips(project, ["c1"], "arms", "transition", rest)


def test_a_clip_of_another_skeleton_is_refused(toy: Any) -> None:
    from dataclasses import replace

    from metagraph.motion.skeleton import Skeleton

    s = toy.skeleton
    other = Skeleton(s.names, s.parents, s.rest_rotations, s.rest_translations * 2)
    clip = replace(toy.clip("big"), skeleton=other)
    project = edits.add_clips(toy.project(), [("big.glb", 0, "", clip)])
    words = edits.find_placing_refusal(
        project, [list(project.clips)[-1]], "arms", "gesture", toy.id(project, "rest")
    )
    assert "'big'" in words and "skeleton" in words


def test_a_dropped_clip_gets_blends_of_at_most_a_quarter_and_its_limb_from_its_name(toy: Any) -> None:
    project = toy.project()
    short, lf = (project.action(toy.id(project, name)) for name in ("rest short", "rest beat lf"))
    assert (short.timing.blend_in, short.timing.blend_out, short.timing.loop) == (0.15, 0.15, False)
    assert (short.limb, lf.limb) == ("both", "left")
    loop = project.action(toy.id(project, "rest loop"))
    assert loop.timing == Timing(blend_in=0.0, blend_out=0.0, loop=True)


def test_an_open_loop_gets_a_blended_seam(toy: Any) -> None:
    project = edits.add_clips(
        Project(),
        [("open.glb", 0, "", toy.clip("open", 2.0, 0.0, 0.5)), ("one.glb", 0, "", toy.clip("one", 0.0))],
    )
    assert edits.make_default_timing(project.clips["c1"], "stance").blend_in == 0.4
    assert edits.make_default_timing(project.clips["c2"], "stance").blend_in == 0.0
    assert edits.make_default_timing(project.clips["c2"], "gesture") == Timing(blend_in=0.0, blend_out=0.0)


def test_updating_many_actions_changes_only_what_is_named(toy: Any) -> None:
    project = toy.project()
    both = [toy.id(project, "rest short"), toy.id(project, "up beat"), "a999"]
    after = edits.update_actions(project, both, timing={"blend_in": 0.05}, likelihood=3.0)
    for ident in both[:2]:
        old, new = project.action(ident), after.action(ident)
        assert (new.timing.blend_in, new.timing.blend_out, new.likelihood) == (
            0.05,
            old.timing.blend_out,
            3.0,
        )
    assert after.graphs["head"] is project.graphs["head"]
    assert edits.update_actions(project, both, timing=Timing(0.1)).action(both[0]).timing == Timing(0.1)


def test_an_update_that_changes_nothing_is_the_same_project(toy: Any) -> None:
    project = toy.project()
    ident = toy.id(project, "rest short")
    assert edits.update_actions(project, [ident], likelihood=1.0) is project
    assert edits.update_actions(project, [], likelihood=2.0) is project
    assert edits.remove_actions(project, ["a999"]) is project


def test_moved_actions_keep_their_settings_and_a_moved_gesture_becomes_a_proper_loop(toy: Any) -> None:
    project = toy.project()
    ident, up = toy.id(project, "rest short"), toy.id(project, "up")
    project = edits.update_actions(project, [ident], tags=("beat",), timing={"start": 0.1})
    moved = edits.move_actions(project, [ident], "fidget", up).action(ident)
    assert (moved.kind, moved.stance, moved.tags, moved.timing.start) == ("fidget", up, ("beat",), 0.1)
    assert edits.move_actions(project, [ident], "stance", up).action(ident).timing.loop
    way = edits.move_actions(project, [ident], "transition", up, toy.id(project, "far")).action(ident)
    assert way.end_stance == toy.id(project, "far")
    assert (
        edits.move_actions(project, [toy.id(project, "rest to up")], "gesture", up)
        .action(toy.id(project, "rest to up"))
        .end_stance
        is None
    )
    with pytest.raises(EditError, match="first choose the stance"):
        edits.move_actions(project, [ident], "transition", up)
    with pytest.raises(EditError, match="nothing to place"):
        edits.move_actions(project, ["a999"], "gesture", up)


def test_each_action_can_get_values_of_its_own(toy: Any) -> None:
    project = toy.project()
    beat, yawn = toy.id(project, "up beat"), toy.id(project, "up yawn")
    after = edits.update_each(
        project, {beat: {"likelihood": 2.0}, yawn: {"tags": ("tired",)}, "a999": {"likelihood": 3.0}}
    )
    assert (after.action(beat).likelihood, after.action(yawn).tags, after.action(yawn).likelihood) == (
        2.0,
        ("tired",),
        1.0,
    )
    assert edits.update_each(project, {beat: {"likelihood": 1.0}}) is project


def test_actions_go_to_another_stance_each_keeping_its_kind_and_end(toy: Any) -> None:
    project = toy.project()
    names = ("rest short", "rest cough", "rest to up")
    after = edits.to_stance(project, [*(toy.id(project, n) for n in names), "a999"], toy.id(project, "far"))
    far = toy.id(project, "far")
    assert [(a.kind, a.stance, a.end_stance) for n in names if (a := after.action(toy.id(project, n)))] == [
        ("gesture", far, None), ("fidget", far, None), ("transition", far, toy.id(project, "up")),
    ]  # fmt: skip
    with pytest.raises(EditError, match="another stance"):
        edits.to_stance(project, [toy.id(project, "rest to up")], toy.id(project, "up"))


def test_another_kind_leaves_every_action_on_its_own_stance(toy: Any) -> None:
    project = toy.project()
    names = ("up yawn", "rest beat lf", "rest to up")
    chosen = [toy.id(project, name) for name in names]
    after = edits.set_kind(project, [*chosen, "a999"], "fidget")
    for ident in chosen:
        was, now = project.action(ident), after.action(ident)
        assert now.kind == "fidget" and now.end_stance is None
        assert (now.stance, now.layer, now.name, now.timing) == (was.stance, was.layer, was.name, was.timing)
    assert edits.set_kind(after, chosen, "fidget") is after, "nothing changes"


def test_what_becomes_a_transition_ends_where_it_is_told_and_never_where_it_starts(toy: Any) -> None:
    project = toy.project()
    far, up = toy.id(project, "far"), toy.id(project, "up")
    chosen = [toy.id(project, name) for name in ("up yawn", "rest to up")]
    after = edits.set_kind(project, chosen, "transition", far)
    assert [after.action(i).end_stance for i in chosen] == [far, up], "a transition keeps its own end"
    with pytest.raises(EditError, match="another stance"):
        edits.set_kind(project, chosen, "transition", up)
    with pytest.raises(EditError, match="choose the stance"):
        edits.set_kind(project, chosen, "transition")


def test_transitions_get_another_end_and_other_kinds_stay(toy: Any) -> None:
    project = toy.project()
    rest, up, far = (toy.id(project, n) for n in ("rest", "up", "far"))
    after = edits.set_ends(project, [toy.id(project, "rest to up"), toy.id(project, "up yawn")], far)
    assert (
        after.action(toy.id(project, "rest to up")).end_stance == far
        and after.action(toy.id(project, "up yawn")).end_stance is None
    )
    with pytest.raises(EditError, match="another stance"):
        edits.set_ends(project, [toy.id(project, "up to far"), toy.id(project, "rest to up")], up)
    assert (
        edits.set_ends(project, [toy.id(project, "up to far")], rest)
        .action(toy.id(project, "up to far"))
        .end_stance
        == rest
    )


def test_the_first_loop_of_all_gives_the_base_pose_unless_one_was_chosen(toy: Any) -> None:
    project = edits.add_clips(Project(), [("a.glb", 0, "", toy.clip("a")), ("b.glb", 0, "", toy.clip("b"))])
    first = edits.add_stance(project, "head", "still", ["c2"])
    assert first.base == BasePose("c2", 0)
    assert edits.add_stance(first, "arms", "rest", ["c1"]).base == BasePose("c2", 0)
    assert edits.add_stance(edits.set_base(project, "c1", 3), "head", "still", ["c2"]).base == BasePose(
        "c1", 3
    )
    with_stance = edits.set_base(first, None)
    assert edits.add_stance(with_stance, "arms", "rest", ["c1"]).base == BasePose(), (
        "the rest pose was chosen after all"
    )


def test_actions_move_across_layers(toy: Any) -> None:
    project = edits.add_stance(toy.project(), "head", "still")
    ident, still = toy.id(project, "rest short"), toy.id(project, "still")
    after = edits.move_actions(project, [ident], "gesture", still)
    assert (
        ident not in after.graphs["arms"].actions
        and after.graphs["head"].of(still, "gesture")[0].layer == "head"
    )


def test_an_action_moved_between_nodes_keeps_its_place_among_those_placed_before_and_after(toy: Any) -> None:
    project = toy.project()
    rest = toy.id(project, "rest")
    after = edits.move_actions(project, [toy.id(project, "up beat")], "gesture", rest)
    assert [a.name for a in after.graphs["arms"].of(rest, "gesture")] == [
        "rest short",
        "rest beat lf",
        "rest wave rt",
        "rest long",
        "up beat",
    ]
    back = edits.move_actions(after, [toy.id(project, "up beat")], "gesture", toy.id(project, "up"))
    assert back.graphs["arms"].index == project.graphs["arms"].index


# --- the rest


def test_weights_and_frames_are_kept_in_range(toy: Any) -> None:
    project = toy.project()
    assert edits.set_weight(project, "arms", "spine", 7).graphs["arms"].weight("spine") == 2
    assert edits.set_weight(project, "arms", "spine", -1).graphs["arms"].weight("spine") == 0
    assert edits.set_base(project, "c1", 999).base == BasePose("c1", 60)
    assert edits.set_base(project, "c1", -5).base == BasePose("c1", 0)
    assert edits.set_base(project, None, 5).base == BasePose(None, 0)
    with pytest.raises(EditError, match=r"'tail'.*legs, spine"):
        edits.set_weight(project, "arms", "tail", 1)  # type: ignore[arg-type]


def test_corrections_can_be_taken_back(toy: Any) -> None:
    project = toy.project()
    assert edits.set_role(edits.set_role(project, "head", "Neck"), "head", None) == project
    assert (
        edits.set_part(edits.set_part(project, ["Neck", "Head"], "spine"), ["Neck", "Head"], None) == project
    )


def test_motion_that_is_filled_in_does_not_count_as_a_change(toy: Any) -> None:
    project = toy.project()
    loaded = edits.with_motions(project, {"c1": toy.clip("c")})
    assert loaded == project and isinstance(loaded.clips["c1"].motion, Clip)
