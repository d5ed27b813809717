"""Problems: one test for each code; each says where it is, what is wrong and what to do."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.editing import retiming
from metagraph.graph.model import BasePose, Project
from metagraph.graph.problem import Problem
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.contact_spans import ContactKey, ContactSpan
from metagraph.motion.skeleton import Skeleton

pytestmark = pytest.mark.usefixtures("numbered_ids")


def codes(project: Project) -> list[str]:
    return [p.code for p in check_project(project)]


def only(project: Project, code: str) -> Problem:
    found = [p for p in check_project(project) if p.code == code]
    assert len(found) == 1, [(p.code, p.message) for p in check_project(project)]
    assert found[0].message and found[0].remedy.endswith(".")
    return found[0]


def entry(project: Project, name: str) -> str:
    return next(e.id for e in project.clips.values() if e.name == name)


@pytest.fixture
def healthy(toy: Any) -> Project:
    """The toy project with its one missing part: something to fidget and gesture with in "far"."""
    project = toy.project()
    project = edits.add_clips(
        project,
        [
            ("far.glb", 0, "", toy.clip("far beat", 1.0, 1.4)),
            ("f.glb", 0, "", toy.clip("far fidget", 1.0, 1.4)),
        ],
    )
    far = toy.id(project, "far")
    project = edits.place_clips(project, [entry(project, "far beat")], "arms", "gesture", far)
    return edits.place_clips(project, [entry(project, "far fidget")], "arms", "fidget", far)


def test_an_empty_project_has_no_problems() -> None:
    assert check_project(Project()) == []


def test_a_healthy_project_has_no_problems(healthy: Project, sample: Project) -> None:
    assert check_project(healthy) == []
    assert {(p.severity, p.code) for p in check_project(sample)} == {("hint", "one-arm")}


def test_checking_changes_nothing(healthy: Project) -> None:
    before = repr(healthy)
    check_project(healthy)
    assert repr(healthy) == before


def test_errors_come_first_hints_last(healthy: Project, toy: Any) -> None:
    project = edits.add_stance(healthy, "arms", "bare")
    project = edits.update_actions(project, [toy.id(project, "far beat")], likelihood=0)
    severities = [p.severity for p in check_project(project)]
    assert severities == sorted(severities, key=["error", "warning", "hint"].index) and set(severities) == {
        "error",
        "warning",
        "hint",
    }


def test_no_stance(toy: Any) -> None:
    problem = only(edits.add_clips(Project(), [("a.glb", 0, "", toy.clip("a"))]), "no-stance")
    assert problem.severity == "hint" and "first stance" in problem.remedy


@pytest.mark.parametrize(("name", "severity"), [("rest short", "error"), ("spare", "warning")])
def test_file_missing(healthy: Project, toy: Any, name: str, severity: str) -> None:
    project = edits.add_clips(healthy, [("spare.glb", 0, "", toy.clip("spare"))])
    ident = entry(project, name)
    project = replace(project, clips={**project.clips, ident: replace(project.clips[ident], motion=None)})
    problem = only(project, "file-missing")
    assert (problem.severity, problem.clip) == (severity, ident) and project.clips[
        ident
    ].path in problem.message


def test_other_skeleton(healthy: Project, toy: Any) -> None:
    s = toy.skeleton
    other = replace(
        toy.clip("big"), skeleton=Skeleton(s.names, s.parents, s.rest_rotations, s.rest_translations * 2)
    )
    project = edits.add_clips(healthy, [("big.glb", 0, "", other)])
    problem = only(project, "other-skeleton")
    assert (
        problem.severity == "warning" and problem.clip == entry(project, "big") and "'big'" in problem.message
    )
    used = edits.with_motions(healthy, {entry(healthy, "rest short"): other})
    assert only(used, "other-skeleton").severity == "error"


def test_base_missing(healthy: Project) -> None:
    assert only(replace(healthy, base=BasePose("c999")), "base-missing").severity == "error"


def test_base_frame(healthy: Project) -> None:
    problem = only(replace(healthy, base=BasePose(healthy.base.clip, 61)), "base-frame")
    assert "frame 61 of 'rest loop'" in problem.message and "60" in problem.message
    assert "base-frame" not in codes(replace(healthy, base=BasePose(healthy.base.clip, 60)))


def lying(toy: Any, turn: float, up: float = 0.0, facing: float = 0.0) -> Clip:
    """One frame with the arms turned, the hips lifted, or the whole body facing elsewhere."""
    s = toy.skeleton
    rotations = s.rest_rotations.copy()[None]
    for name in ("LeftUpperArm", "RightUpperArm"):
        rotations[:, s.index(name)] = rotation.from_axis_angle(np.array([0, 0, 1.0]), turn)
    rotations[:, 0] = rotation.from_axis_angle(np.array([0, 1.0, 0]), facing)
    translations = s.rest_translations[None, :1] + np.array([0, up, 0])
    return Clip("base", s, 30.0, rotations, translations)


def test_base_rest(healthy: Project, toy: Any) -> None:
    far = edits.set_start_stance(edits.set_base(healthy, None), toy.id(healthy, "far"))
    assert only(far, "base-rest").severity == "warning"
    assert "base-rest" not in codes(edits.set_base(healthy, None))  # this character stands as it rests


@pytest.mark.parametrize(("up", "way"), [(0.3, "above"), (-0.3, "below")])
def test_base_floats(healthy: Project, toy: Any, up: float, way: str) -> None:
    project = edits.add_stance(healthy, "body", "stand", [healthy.base.clip])
    project = edits.add_clips(project, [("base.glb", 0, "", lying(toy, 0, up))])
    problem = only(edits.set_base(project, entry(project, "base")), "base-floats")
    assert f"30 cm {way} stance 'stand'" in problem.message


def test_base_twisted(healthy: Project, toy: Any) -> None:
    project = edits.add_stance(healthy, "body", "stand", [healthy.base.clip])
    project = edits.add_clips(project, [("base.glb", 0, "", lying(toy, 0, 0, np.radians(90)))])
    problem = only(edits.set_base(project, entry(project, "base")), "base-twisted")
    assert "90°" in problem.message and "'stand'" in problem.message


def test_no_part(healthy: Project) -> None:
    project = edits.set_part(healthy, healthy.skeleton.names, "spine")
    found = [p for p in check_project(project) if p.code == "no-part"]
    assert [p.message.split()[-1] for p in found] == ["arms", "head", "legs"]


def test_no_loop(healthy: Project, toy: Any) -> None:
    problem = only(edits.remove_actions(healthy, [toy.id(healthy, "far loop")]), "no-loop")
    assert (problem.severity, problem.layer, problem.stance) == ("error", "arms", toy.id(healthy, "far"))


@pytest.mark.parametrize(("name", "code"), [("far beat", "no-gestures"), ("far fidget", "no-fidgets")])
def test_no_gestures_and_no_fidgets(healthy: Project, toy: Any, name: str, code: str) -> None:
    problem = only(edits.remove_actions(healthy, [toy.id(healthy, name)]), code)
    assert problem.severity == "hint" and "'far'" in problem.message


def test_dead_end_and_unreachable(healthy: Project, toy: Any) -> None:
    problem = only(edits.remove_actions(healthy, [toy.id(healthy, "far to up")]), "dead-end")
    assert problem.stance == toy.id(healthy, "far") and problem.severity == "warning"
    problem = only(edits.remove_actions(healthy, [toy.id(healthy, "up to far")]), "unreachable")
    assert problem.stance == toy.id(healthy, "far")


def test_a_single_stance_is_no_dead_end(toy: Any) -> None:
    project = edits.add_stance(
        edits.add_clips(Project(), [("a.glb", 0, "", toy.clip("a", swing=0.1))]), "head", "still", ["c1"]
    )
    assert set(codes(project)) == {"no-gestures", "no-fidgets"}


def test_no_start(healthy: Project) -> None:
    graph = healthy.graphs["arms"]
    assert only(healthy.with_graph(graph.but(start=None)), "no-start").layer == "arms"
    assert only(healthy.with_graph(graph.but(start="s999")), "no-start").severity == "error"


@pytest.mark.parametrize("weight", [-0.1, 2.1, float("nan")])
def test_weight(healthy: Project, weight: float) -> None:
    problem = only(healthy.with_graph(healthy.graphs["arms"].but(weights={"spine": weight})), "weight")
    assert "arms layer" in problem.message and "spine" in problem.message


def test_lost_stance(healthy: Project, toy: Any) -> None:
    ident = toy.id(healthy, "far beat")
    problem = only(edits.update_actions(healthy, [ident], stance="s999"), "lost-stance")
    assert (problem.action, problem.severity) == (ident, "error")


def test_no_end_lost_end_and_circle(healthy: Project, toy: Any) -> None:
    project = edits.place_clips(
        healthy,
        [entry(healthy, "rest to up")],
        "arms",
        "transition",
        toy.id(healthy, "rest"),
        toy.id(healthy, "up"),
    )
    ident = [*project.actions()][-1].id
    assert only(edits.update_actions(project, [ident], end_stance=None), "no-end").action == ident
    assert only(edits.update_actions(project, [ident], end_stance="s999"), "lost-end").action == ident
    assert (
        only(edits.update_actions(project, [ident], end_stance=toy.id(healthy, "rest")), "circle").severity
        == "warning"
    )


@pytest.mark.parametrize("likelihood", [0.0, -1.0, float("nan"), float("inf")])
def test_likelihood(healthy: Project, toy: Any, likelihood: float) -> None:
    problem = only(
        edits.update_actions(healthy, [toy.id(healthy, "far beat")], likelihood=likelihood), "likelihood"
    )
    assert problem.action == toy.id(healthy, "far beat")


def test_mask(healthy: Project, toy: Any) -> None:
    assert (
        "'Tail'"
        in only(
            edits.update_actions(healthy, [toy.id(healthy, "far beat")], joints=("Head", "Tail")), "mask"
        ).message
    )
    soft = edits.update_actions(healthy, [toy.id(healthy, "far beat")], joint_weights=(("Fin", 0.5),))
    assert "'Fin'" in only(soft, "mask").message


def test_lost_clip(healthy: Project, toy: Any) -> None:
    assert (
        only(edits.update_actions(healthy, [toy.id(healthy, "far beat")], clip="c999"), "lost-clip").clip
        == "c999"
    )


@pytest.mark.parametrize(
    ("timing", "code"),
    [
        ({"start": -0.1}, "trim"),
        ({"end": 1.1}, "trim"),
        ({"start": 1.2}, "trim"),
        ({"start": 0.5, "end": 0.5, "blend_in": 0.0, "blend_out": 0.0}, "empty"),
        ({"start": 0.8, "end": 0.2}, "empty"),
        ({"blend_in": 0.6, "blend_out": 0.6}, "blend"),
        ({"blend_in": -0.1}, "blend"),
        ({"blend_out": float("nan")}, "blend"),
        ({"earliest_exit": 1.2}, "exit"),
        ({"earliest_exit": 0.1, "start": 0.2}, "exit"),
        ({"start": float("nan")}, "trim"),
        ({"end": float("nan")}, "trim"),
    ],
)
def test_trim_empty_blend_and_exit(healthy: Project, toy: Any, timing: dict[str, float], code: str) -> None:
    ident = toy.id(healthy, "far beat")
    found = [
        p
        for p in check_project(edits.update_actions(healthy, [ident], timing=timing))
        if not p.code.startswith("far")
    ]
    assert [(p.code, p.action) for p in found] == [(code, ident)]


@pytest.mark.parametrize("blend", [-0.5, float("inf"), float("nan")])
@pytest.mark.parametrize("side", ["blend_in", "blend_out"])
def test_a_blend_that_cannot_be_is_told_of_a_loop_and_beside_another_fault(
    healthy: Project, toy: Any, side: str, blend: float
) -> None:
    loop = next(a.id for a in healthy.actions() if a.kind == "stance")
    found = only(edits.update_actions(healthy, [loop], timing={side: blend}), "blend")
    assert (
        found.action == loop
        and found.severity == ("error" if abs(blend) != 0.5 else "warning")
        and side[6:] in found.message
    )
    ident = toy.id(healthy, "far beat")
    both = check_project(edits.update_actions(healthy, [ident], timing={side: blend, "start": -1.0}))
    assert {"trim", "blend"} <= {p.code for p in both}


def test_half_a_frame_beyond_the_end_is_rounding(healthy: Project, toy: Any) -> None:
    assert codes(edits.update_actions(healthy, [toy.id(healthy, "far beat")], timing={"end": 1.01})) == []


def test_open_loop(healthy: Project, toy: Any) -> None:
    project = edits.add_clips(healthy, [("open.glb", 0, "", toy.clip("open", 2.0, 0.0, 0.5))])
    project = edits.place_clips(project, [entry(project, "open")], "arms", "stance", toy.id(project, "rest"))
    ident = [*project.actions()][-1].id
    assert codes(project) == []  # its seam is blended
    assert only(edits.update_actions(project, [ident], timing={"blend_in": 0.0}), "open-loop").action == ident


def test_far_start_and_far_end(healthy: Project, toy: Any) -> None:
    project = edits.move_actions(healthy, [toy.id(healthy, "up beat")], "gesture", toy.id(healthy, "rest"))
    found = [p for p in check_project(project) if p.code.startswith("far")]
    assert [p.code for p in found] == ["far-start", "far-end"]
    assert "cm from stance 'rest'" in found[0].message and found[0].severity == "warning"


@pytest.mark.parametrize(("blend", "pops"), [(0.0, True), (0.39, True), (0.4, False), (0.9, False)])
def test_a_long_slow_blend_is_no_pop(healthy: Project, toy: Any, blend: float, pops: bool) -> None:
    """Its hands are some 40 cm away: too far for a seam, and an unhurried way for half a second."""
    clip = toy.clip("from afar", 2.4, 0.4, 0.0, swing=0.0)
    project = edits.add_clips(healthy, [("from afar.glb", 0, "", clip)])
    project = edits.place_clips(
        project, [toy.id(project, "from afar")], "arms", "gesture", toy.id(project, "rest")
    )
    ident = [*project.actions()][-1].id
    project = edits.update_actions(project, [ident], timing={"blend_in": blend, "blend_out": 0.0})
    assert codes(project) == (["far-start"] if pops else [])


def test_a_long_way_in_a_long_blend_still_pops_and_so_does_the_other_end(healthy: Project, toy: Any) -> None:
    project = edits.move_actions(healthy, [toy.id(healthy, "far beat")], "gesture", toy.id(healthy, "rest"))
    ident = toy.id(project, "far beat")
    slow = edits.update_actions(project, [ident], timing={"blend_in": 0.5, "blend_out": 0.1})
    assert [c for c in codes(slow) if c.startswith("far")] == ["far-start", "far-end"]


def test_joints_an_action_leaves_alone_may_be_far_from_the_stance(healthy: Project, toy: Any) -> None:
    ident = toy.id(healthy, "up beat")
    project = edits.move_actions(healthy, [ident], "gesture", toy.id(healthy, "rest"))
    assert codes(edits.update_actions(project, [ident], joints=("Head",))) == []


@pytest.mark.parametrize(("blends", "seen"), [((0.5, 0.4), False), ((0.3, 0.3), True)])
def test_a_gesture_that_is_almost_all_blends_is_hardly_seen(
    toy: Any, blends: tuple[float, float], seen: bool
) -> None:
    project = toy.project()
    wave = toy.id(project, "rest beat lf")  # 0.9 s
    timing = {"blend_in": blends[0] - 0.05, "blend_out": blends[1]}
    found = check_project(edits.update_actions(project, [wave], timing=timing))
    assert [p.code for p in found if p.action == wave] == ([] if seen else ["hardly-seen"])


def test_a_gesture_that_is_hardly_seen_repeats_by_its_button_and_is_seen(toy: Any) -> None:
    from app.stage.remedies import fix_clips

    project = toy.project()
    wave = toy.id(project, "rest beat lf")  # 0.9 s
    project = edits.update_actions(project, [wave], timing={"blend_in": 0.4, "blend_out": 0.4})
    (found,) = [p for p in check_project(project) if p.code == "hardly-seen"]
    after = fix_clips(project, [found])[found](project)
    assert after.action(wave).timing.repeat == pytest.approx(2.7)  # three times
    assert not [p for p in check_project(after) if p.action == wave]


def test_what_repeats_may_blend_for_longer_than_its_part(toy: Any) -> None:
    project = toy.project()
    wave = toy.id(project, "rest beat lf")  # 0.9 s
    timing = {"blend_in": 1.0, "blend_out": 1.0, "repeat": 2.7}
    assert not [
        p for p in check_project(edits.update_actions(project, [wave], timing=timing)) if p.action == wave
    ]
    timing["repeat"] = 1.8
    found = check_project(edits.update_actions(project, [wave], timing=timing))
    assert [p.message for p in found if p.action == wave] == [
        "'rest beat lf' blends for 2.00 s but is only 1.80 s long"
    ]


@pytest.mark.parametrize(
    ("name", "metres", "words"),
    [
        ("rest loop", 0.5, "in each loop"),
        ("rest wave rt", 0.5, "slides back"),
        ("rest to up", 2.0, "slides back"),
        ("rest to up", 0.3, ""),
        ("rest wave rt", 0.1, ""),
    ],
)
def test_what_travels_is_reported_and_keeping_it_in_place_helps(
    toy: Any, name: str, metres: float, words: str
) -> None:
    from app.stage.remedies import fix_clips
    from tests.motion.test_in_place import going

    project = toy.project("body")
    clip = next(i for i, e in project.clips.items() if e.name == name)
    entry = project.clips[clip]
    project = replace(
        project, clips={**project.clips, clip: replace(entry, motion=going(entry.motion, metres, 0))}
    )
    found = [p for p in check_project(project) if p.code == "travels"]
    assert [words in p.message for p in found] == ([True] if words else [])
    for fix in fix_clips(project, found).values():
        assert fix.words == "Keep in place"
        after = fix(project)
        assert not [p for p in check_project(after) if p.code == "travels"]
        assert after.clips[clip].in_place and after.clips[clip].source is project.clips[clip].motion


def test_travel_counts_on_layers_that_move_the_legs_and_by_the_figure_s_height(toy: Any) -> None:
    from tests.motion.test_in_place import going

    def travels(layer: str, metres: float, size: float = 1.0) -> bool:
        project = toy.project(layer)
        bones = project.skeleton
        bones = Skeleton(bones.names, bones.parents, bones.rest_rotations, bones.rest_translations * size)
        clips = {
            i: replace(
                e,
                motion=going(
                    replace(e.motion, skeleton=bones, translations=e.motion.translations * size), metres, 0
                ),
            )
            for i, e in project.clips.items()
        }
        project = replace(project, skeleton=bones, clips=clips)
        return "travels" in {p.code for p in check_project(project)}

    assert travels("body", 3.0) and not travels("arms", 3.0) and not travels("head", 3.0)
    assert travels("body", 0.3, 0.2) and not travels("body", 0.3, 5.0)


@pytest.mark.parametrize(("seconds", "reported"), [(2.4, True), (0.6, True), (1.2, False)])
def test_a_file_that_is_longer_or_shorter_since_is_reported_and_times_can_be_scaled_or_kept(
    toy: Any, seconds: float, reported: bool
) -> None:
    from app.stage.remedies import fix_clips

    project = toy.project()
    wave = toy.id(project, "rest wave rt")  # 1.2 s
    project = edits.update_actions(project, [wave], timing={"start": 0.2, "end": 1.0, "stroke": 0.5})
    entry = project.clips[project.action(wave).clip]
    first = edits.add_clips(project, [(entry.path, entry.take, "old", entry.motion)])
    again = edits.add_clips(first, [(entry.path, entry.take, "new", toy.clip(entry.name, seconds))])
    found = [p for p in check_project(again) if p.code == "other-length"]
    assert [p.action for p in found] == ([wave] if reported else [])
    for fix in fix_clips(again, found).values():
        timing = fix(again).action(wave).timing
        assert (timing.start, timing.end, timing.stroke) == pytest.approx(
            tuple(x * seconds / 1.2 for x in (0.2, 1.0, 0.5)), abs=2e-3
        )
        assert not [p for p in check_project(fix(again)) if p.code == "other-length"]
        assert fix.instead is not None
        kept = fix.instead(again)
        assert kept.action(wave) is again.action(wave) and not kept.clips[entry.id].timed_on


def test_base_pose_and_contacts_are_scaled_too_and_a_speed_keeps_what_was_timed(toy: Any) -> None:
    project = toy.project()
    wave = toy.id(project, "rest wave rt")  # 1.2 s
    entry = project.clips[project.action(wave).clip]
    span = ContactSpan("left", "palm", "Spine", 0.3, 0.6, (ContactKey(0.3, (0, 0, 0), (0, 0, 0, 1)),))
    project = edits.update_actions(project, [wave], timing={"stroke": 0.5}, contacts=(span,))
    project = replace(project, base=BasePose(entry.id, 18))
    again = edits.add_clips(project, [(entry.path, entry.take, "old", entry.motion)])
    again = edits.add_clips(again, [(entry.path, entry.take, "new", toy.clip(entry.name, 2.4))])
    scaled = retiming.scale_times(again, entry.id)
    assert scaled.base.frame == 36
    (moved,) = scaled.action(wave).contacts
    assert (moved.start, moved.end, moved.keys[0].time) == pytest.approx((0.6, 1.2, 0.6), abs=2e-3)
    fast = retiming.set_speed(again, entry.id, 2.0)
    assert fast.clips[entry.id].timed_on == pytest.approx(0.6, abs=0.02)
    assert retiming.scale_times(fast, entry.id).action(wave).timing.stroke == pytest.approx(0.5, abs=0.02)


def test_a_stroke_that_does_not_play_is_an_error_and_can_be_cleared(toy: Any) -> None:
    from app.stage.remedies import fix_clips

    project = toy.project()
    wave = toy.id(project, "rest wave rt")
    project = edits.update_actions(project, [wave], timing={"end": 0.8, "stroke": 1.0})
    (problem,) = [p for p in check_project(project) if p.code == "moment"]
    assert problem.severity == "error" and problem.action == wave and "its stroke" in problem.message
    for phase in ("ready", "stroke_end", "relax"):
        late = edits.update_actions(toy.project(), [wave], timing={"end": 0.8, phase: 1.0})
        (other,) = [p for p in check_project(late) if p.code == "moment"]
        assert "a phase of its stroke at 1.00 s" in other.message
    (fix,) = fix_clips(project, [problem]).values()
    assert fix(project).action(wave).timing.stroke is None
    assert not [p for p in check_project(fix(project)) if p.code == "moment"]
