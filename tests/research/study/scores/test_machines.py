"""How right a machine is: every mistake is found, once, and told in words."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest
from hypothesis import given

from metagraph.graph import edits
from metagraph.graph.manual import edits as manual_edits
from metagraph.graph.model import Project
from metagraph.research.study.machines.normal_machine import normalize_machines
from metagraph.research.study.scores.machines import Score, align_machine, are_equivalent, score
from metagraph.research.study.simulation.work import draw_every_connection
from tests.projects import projects
from tests.research.study.makers import LAYER, small


def action(project: Project, name: str) -> str:
    return next(a.id for a in project.actions() if a.name == name)


def stance(project: Project, name: str) -> str:
    return next(s.id for s in project.graphs[LAYER].stances.values() if s.name == name)


def scored(project: Project, reference: Project | None = None, tolerance: float = 0.1) -> Score:
    return score(normalize_machines(project), normalize_machines(reference or small()), tolerance)


def words(found: Score) -> list[str]:
    return [m.words for m in found.mistakes]


def named(found: Score) -> list[tuple[str, str]]:
    """Each mistake's sort and clip."""
    return [(m.what, m.clip) for m in found.mistakes]


def told(found: Score, what: str, clip: str) -> str:
    """The words of the one mistake of a sort about a clip."""
    (one,) = (m.words for m in found.mistakes if (m.what, m.clip) == (what, clip))
    return one


def linked(project: Project, source: str, target: str) -> str:
    machine = project.manual[LAYER]
    names = {i: s.name for i, s in machine.states.items()}
    return next(
        x.id for x in machine.links.values() if (names[x.source], names[x.target]) == (source, target)
    )


def test_nothing_beside_nothing_is_neither_right_nor_wrong() -> None:
    found = score({}, {})
    assert (found.precision, found.recall, found.f1, found.mistakes) == (None, None, None, ())


def test_nothing_made_lacks_everything() -> None:
    found = scored(Project())
    assert (found.right, found.missing, found.extra) == (0, 28, 0)
    assert (found.precision, found.recall, found.f1) == (None, 0.0, 0.0)
    assert (found.states, found.placed, found.count("absent"), found.count("missing")) == (8, 0, 8, 28)
    assert named(found)[0] == ("absent", "hips_idle.glb")


def test_what_is_not_wanted_is_extra() -> None:
    found = score(normalize_machines(small()), {})
    assert (found.right, found.extra, found.precision, found.recall, found.f1) == (0, 28, 0.0, None, 0.0)
    assert found.count("unwanted") == 8


def test_the_same_is_right_in_both_conditions() -> None:
    for project in (small(), draw_every_connection(small())):
        found = scored(project)
        assert (found.precision, found.recall, found.f1) == (1.0, 1.0, 1.0)
        assert (found.placed, found.states, words(found)) == (8, 8, [])
        assert found.essential == found.essential_right == 12, (
            "six actions, each entered from rest and left to it"
        )


def test_names_of_stances_and_the_order_of_placing_do_not_matter() -> None:
    project = small()
    sides = stance(project, "sides")
    project = edits.rename_stance(edits.rename_stance(project, stance(project, "hips"), "?"), sides, "hips")
    wave = action(project, "sides_wave")
    project = edits.remove_actions(project, [wave])
    clip = next(i for i, e in project.clips.items() if e.name == "sides_wave")
    assert are_equivalent(
        normalize_machines(edits.place_clips(project, [clip], LAYER, "gesture", sides)),
        normalize_machines(small()),
    )


def test_a_forgotten_link_is_one_mistake() -> None:
    project = draw_every_connection(small())
    found = scored(manual_edits.remove_states(project, links=[linked(project, "sides_idle", "sides_wave")]))
    assert (found.missing, found.extra, found.recall, found.precision) == (1, 0, 27 / 28, 1.0)
    assert named(found) == [("missing", "sides_idle.glb")] and "sides_wave.glb" in words(found)[0]
    assert (found.essential_right, found.essential) == (11, 12)


def test_a_link_to_the_wrong_state_is_missing_extra_and_wrong() -> None:
    project = draw_every_connection(small())
    machine = project.manual[LAYER]
    ident = linked(project, "sides_wave", "sides_idle")
    hips = next(i for i, s in machine.states.items() if s.name == "hips_idle")
    found = scored(
        project.with_manual(
            replace(machine, links={**machine.links, ident: replace(machine.links[ident], target=hips)})
        )
    )
    assert (found.missing, found.extra, found.wrong) == (1, 1, 1)
    assert "hips_idle.glb" in told(found, "extra", "sides_wave.glb")
    assert named(found)[0] == ("kind", "sides_wave.glb")
    assert re.search("transition.*gesture", words(found)[0]), "it is now on its way to the other stance"


def test_a_clip_on_the_wrong_stance_is_named_with_both() -> None:
    project = small()
    found = scored(
        edits.move_actions(project, [action(project, "sides_wave")], "gesture", stance(project, "hips"))
    )
    assert named(found)[0] == ("stance", "sides_wave.glb") and re.search("hips .*sides", words(found)[0])
    # To and from its stance's loop, two more actions and its transitions in and out: 4 + 4 are lost, 3 + 3
    # too many.
    assert (found.count("stance"), found.missing, found.extra) == (1, 8, 6)
    assert found.placed == 7


def test_a_transition_to_the_wrong_stance_is_named_with_its_ends() -> None:
    project = small()
    found = scored(
        edits.move_actions(
            project,
            [action(project, "sides_to_hips")],
            "transition",
            stance(project, "hips"),
            stance(project, "sides"),
        )
    )
    assert named(found)[0] == ("stance", "sides_to_hips.glb")
    assert re.search("hips to sides.*sides to hips", words(found)[0])


def test_a_wrong_kind_layer_and_limb_are_named() -> None:
    project = small()
    wave = action(project, "sides_wave")
    joints = ("Head", "LeftArm")
    for other, what, pieces in (
        (edits.move_actions(project, [wave], "fidget", stance(project, "sides")), "kind", "fidget.*gesture"),
        (edits.update_actions(project, [wave], limb="left"), "mask", "left arm.*everything"),
        (edits.update_actions(project, [wave], limb="left", joints=joints), "mask", "2 joints .*left arm"),
    ):
        found = scored(other)
        assert named(found) == [(what, "sides_wave.glb")] and re.search(pieces, words(found)[0])
    clip = next(i for i, e in project.clips.items() if e.name == "sides_wave")
    elsewhere = edits.place_clips(edits.remove_actions(project, [wave]), [clip], "head", "stance", None)
    found = scored(elsewhere)
    assert named(found)[:2] == [("unwanted", "sides_wave.glb"), ("layer", "sides_wave.glb")]
    assert "head" in words(found)[0] and re.search("head.*arms", words(found)[1])
    assert found.count("layer") == 1


def test_how_far_joints_move_is_compared_to_a_notch_of_the_wheel() -> None:
    project = small()
    wave = action(project, "sides_wave")

    def weighed(weight: float) -> Project:
        return edits.update_actions(project, [wave], joint_weights=(("Head", weight), ("LeftArm", 0.5)))

    assert words(scored(weighed(0.5), weighed(0.55))) == []
    found = scored(weighed(0.3), weighed(0.6))
    assert named(found) == [("mask", "sides_wave.glb")]
    assert re.search("2 joints .*30 to 50 %.*2 joints .*50 to 60 %", words(found)[0])
    assert found.placed == found.states - 1
    found = scored(project, weighed(0.5))
    assert named(found) == [("mask", "sides_wave.glb")] and re.search("2 joints .*50 %", words(found)[0])
    assert scored(draw_every_connection(weighed(0.3)), weighed(0.6)).count("mask") == 1


def test_a_requested_link_makes_a_gesture_of_a_fidget() -> None:
    project = draw_every_connection(small())
    fidgets = [
        x.id for x in project.manual[LAYER].links.values() if project.state(x.target).name == "sides_scratch"
    ]
    found = scored(manual_edits.update_links(project, fidgets, condition={"when": "request"}))
    assert named(found) == [("kind", "sides_scratch.glb")] and re.search("gesture.*fidget", words(found)[0])


def test_times_count_beyond_the_tolerance_only() -> None:
    project = small()
    wave = action(project, "sides_wave")
    near = edits.update_actions(
        project, [wave], timing={"start": 0.1, "end": 1.9, "blend_in": 0.3, "blend_out": 0.15}
    )
    assert words(scored(near)) == []
    assert len(words(scored(near, tolerance=0.05))) == 5, "start, end, when it may be left, and both blends"
    far = edits.update_actions(project, [wave], timing={"start": 0.5, "earliest_exit": 1.0, "blend_out": 0.5})
    found = scored(far)
    assert [(m.what, m.clip, m.count) for m in found.mistakes] == [
        ("timing", "sides_wave.glb", count) for count in (1, 4, 1)
    ]
    times = ("out .*0.50 s.*0.25 s", "left .*1.00 s.*2.00 s.*4", "starts .*0.50 s.*0.00 s")
    assert all(re.search(said, line) for said, line in zip(times, words(found), strict=True))


def test_a_link_that_is_taken_at_once_is_told() -> None:
    project = draw_every_connection(small())
    ident = linked(project, "sides_wave", "sides_to_hips")
    found = scored(manual_edits.update_links(project, [ident], exit_time=None))
    assert named(found) == [("timing", "sides_wave.glb")] and re.search("any time.*2.00 s", words(found)[0])


def test_several_uses_of_one_clip_are_matched_by_what_they_are() -> None:
    project = small()
    clip = next(i for i, e in project.clips.items() if e.name == "sides_wave")
    twice = edits.place_clips(project, [clip], LAYER, "gesture", stance(project, "hips"))
    other = edits.remove_actions(twice, [action(twice, "sides_wave")])
    first = next(a.id for a in other.actions() if a.clip == clip)
    other = edits.place_clips(
        other, [clip], LAYER, "gesture", stance(project, "sides")
    )  # now that on the hips came first
    assert next(a.id for a in other.actions() if a.clip == clip) == first
    assert are_equivalent(normalize_machines(other), normalize_machines(twice))
    assert named(scored(twice))[0] == ("unwanted", "sides_wave.glb#2")
    assert scored(small(), twice).count("absent") == 1


def test_many_uses_of_one_clip_are_matched_one_by_one() -> None:
    project = small()
    clip = next(i for i, e in project.clips.items() if e.name == "sides_wave")
    many = edits.place_clips(project, [clip] * 9, LAYER, "fidget", stance(project, "hips"))
    assert (
        align_machine(normalize_machines(many)[LAYER], normalize_machines(many)[LAYER]).states.keys()
        == normalize_machines(many)[LAYER].states.keys()
    )
    assert are_equivalent(normalize_machines(many), normalize_machines(many))


def test_long_lists_are_cut() -> None:
    project = draw_every_connection(small())
    wave = next(s.id for s in project.manual[LAYER].states.values() if s.name == "sides_idle")
    found = scored(
        manual_edits.remove_states(
            project, links=[x.id for x in project.manual[LAYER].links.values() if x.source == wave]
        )
    )
    (missing,) = (m for m in found.mistakes if m.what == "missing")
    assert (missing.clip, missing.count) == ("sides_idle.glb", 4)
    assert all(f"sides_{name}.glb" in missing.words for name in ("scratch", "shrug", "to_hips", "wave"))
    cut = told(scored(Project()), "missing", "hips_to_sides.glb")
    assert cut.count(".glb") == 4 and "2 more" in cut


def test_shares_by_hand() -> None:
    found = Score(right=6, missing=2, extra=4)
    assert (found.precision, found.recall, found.f1) == (0.6, 0.75, pytest.approx(2 / 3))


@given(projects())
def test_whatever_is_made_is_right_beside_itself(project: Project) -> None:
    found = normalize_machines(project, manual=False)
    assert are_equivalent(found, found)
    assert score(found, found).placed == sum(len(m.states) for m in found.values())
