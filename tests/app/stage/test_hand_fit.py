"""What a desk needs so that hands rest on it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.stage.hand_fit import find_fitting_height, measure_hands_below
from app.stage.playback_source import ShownPlayback
from app.stage.prop_contacts import list_prop_tops, put_on_props
from app.stage.props import PropMeshes, read_prop_meshes
from app.stage.seat_fit import fit_prop_to_seat
from metagraph.formats.store import open_project
from metagraph.graph.editing.props import add_prop
from metagraph.graph.model import Project
from metagraph.graph.prop import Prop
from metagraph.playback.planner import make_plan
from metagraph.speech.duet import Stand

SAMPLES = Path(__file__).resolve().parents[3] / "sample_clips"
DESK = Prop(name="desk", path="props/desk.glb", at=(0, 0, 0.07))


def place(*props: Prop) -> tuple[Project, PropMeshes]:
    project = open_project(SAMPLES / "seated.metagraph.yaml").project
    for prop in props:
        project, _ = add_prop(project, prop)
    meshes, problems = read_prop_meshes(project, SAMPLES)
    assert problems == []
    return project, meshes


def change(prop: Prop, **more: object) -> Prop:
    import msgspec

    return msgspec.structs.replace(prop, **more)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("at", "scale"), [((0, 0.2, 0.07), 1.0), ((0, 0, 0.1), 1.25)], ids=["lifted", "large"]
)
def test_a_desk_that_is_too_high_is_told_and_fitted(at: tuple[float, float, float], scale: float) -> None:
    high = change(DESK, at=at, scale=scale)
    project, meshes = place(high)
    found = measure_hands_below(project, list_prop_tops(high, meshes))
    assert found is not None and 0.3 < found[0] < 0.5
    fitted = fit_prop_to_seat(high, found[1], find_fitting_height(*found))
    again = measure_hands_below(project, list_prop_tops(fitted, meshes))
    assert again is not None and again[0] == 0 and again[1] < found[1]


def test_a_desk_of_the_usual_height_needs_nothing_and_one_out_of_reach_says_nothing() -> None:
    project, meshes = place(DESK)
    found = measure_hands_below(project, list_prop_tops(DESK, meshes))
    assert found == (0.0, pytest.approx(0.74))
    for other in (change(DESK, at=(0, 0, 3)), change(DESK, scale=0.1), change(DESK, turn=(90, 0, 0))):
        assert measure_hands_below(project, list_prop_tops(other, meshes)) is None


def test_what_is_shown_rests_on_what_stands_and_no_longer_when_that_is_gone_or_carried() -> None:
    project, meshes = place(DESK)
    shown = ShownPlayback(project, make_plan(project, 5.0), 5.0)
    rested = put_on_props(shown, meshes)
    pose, plain = rested.pose(1.0), shown.pose(1.0)
    assert pose is not None and plain is not None
    assert not np.array_equal(pose.rotations, plain.rotations)
    assert put_on_props(rested, meshes) is rested
    (ident,) = project.props
    for props in ({}, {ident: change(DESK, joint="LeftHand")}):
        after = put_on_props(rested, meshes, props)
        pose = after.pose(1.0)
        assert pose is not None and np.array_equal(pose.rotations, plain.rotations)


def test_in_a_conversation_all_rest_on_what_the_first_has_each_from_where_it_stands() -> None:
    project, meshes = place(DESK)
    plan = make_plan(project, 5.0)
    first = ShownPlayback(project, plan, 5.0, stand=Stand(x=-1.0))
    stands = [Stand(x=-1.0, z=0.14, turn=np.pi), Stand(x=2.0)]
    others = tuple(
        ShownPlayback(replace(project, props={}), plan, 5.0, side=n + 1, stand=stand)
        for n, stand in enumerate(stands)
    )
    rested = put_on_props(replace(first, others=others), meshes)
    own, across, far = rested.everyone
    assert own.tops[0].height == across.tops[0].height == pytest.approx(0.74)
    # Who sits across the desk has it before the hands as well: it is as far from both.
    one, two, plain = own.pose(1.0), across.pose(1.0), first.pose(1.0)
    assert one is not None and two is not None and plain is not None
    assert np.abs(one.rotations - two.rotations).max() < 1e-3 < np.abs(one.rotations - plain.rotations).max()
    assert np.array_equal(far.pose(1.0).rotations, plain.rotations)  # type: ignore[union-attr]


def test_a_clip_alone_and_a_prop_whose_file_is_not_read_yet_change_nothing() -> None:
    project, _ = place(DESK)
    shown = ShownPlayback(project, make_plan(project, 5.0), 5.0)
    assert put_on_props(shown, PropMeshes(SAMPLES)) is shown
    alone = replace(shown, clip=next(iter(project.clips)))
    assert put_on_props(alone, place(DESK)[1]) is alone


def test_two_who_sit_at_a_desk_have_chairs_no_stools_and_hands_on_it() -> None:
    """The project that the manual films: cups stand on the desk, no hand is in it, nobody sits on nothing."""
    from app.stage.conversation_plans import ConversationPlans
    from app.stage.stools import make_stools
    from metagraph.motion.character_mesh import CharacterMesh
    from sample_clips.make.at_a_desk import make_desk_talk

    project = make_desk_talk()
    meshes, problems = read_prop_meshes(project, SAMPLES)
    assert problems == []
    shown = put_on_props(ConversationPlans().show(project, "talk", SAMPLES), meshes)
    assert len(shown.everyone) == 2 and shown.notes == ()
    times = np.arange(0, 32, 1 / 10)
    for one in shown.everyone:
        assert make_stools(one, meshes=meshes) == ()
        pose, skeleton = one.pose(times), one.skeleton
        assert pose is not None and skeleton is not None
        _, at = skeleton.globals(pose)
        (desk,) = (top for top in one.tops if 0.7 < top.height < 0.8)
        fingers = at[:, [j for j, name in enumerate(skeleton.names) if name[-1] in "123"]]
        low = desk.find_heights(fingers) - fingers[..., 1]
        in_board = desk.contains(fingers) & (low > 0.008) & (low < 0.03)
        assert in_board.any(1).mean() < 0.03  # on the way from the seat to the desk
        resting = np.abs(at[:, skeleton.index("RightHand"), 1] - 0.76) < 0.02
        assert resting.mean() > 0.2
    heights = {}
    for prop in project.props.values():
        mesh: CharacterMesh = meshes.meshes[meshes.locate(prop.path)]
        heights.setdefault(prop.name, prop.at[1] + float(mesh.positions[:, 1].min()))
    assert heights["cup"] == pytest.approx(0.74, abs=1e-3)
