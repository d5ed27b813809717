"""Stances in which one arm alone moves."""

from __future__ import annotations

import pytest

from metagraph.formats.store import open_project
from metagraph.graph.check import check_project
from metagraph.graph.editing.fitting_twins import fit_twins
from metagraph.graph.editing.one_sided import describe_one_sided, list_one_sided
from metagraph.graph.model import Project
from metagraph.playback.planner import make_plan
from metagraph.research.exhibits.keeping_rates import HOUR, SEED
from metagraph.research.exhibits.paper_planner import plan_as_in_paper
from tests.graph.editing.test_mirroring import new_actions, with_twins


def test_the_samples_one_sided_stances_are_counted() -> None:
    from app.project.files import SAMPLE

    found = list_one_sided(open_project(SAMPLE).project)
    assert {one.name: (one.lacks, len(one.actions)) for one in found} == {
        "arms crossed": ("left", 5),
        "hand to chin": ("left", 6),
        "hands clasped": ("left", 2),
    }
    assert (
        describe_one_sided(found[0]) == "'arms crossed' has 5 actions of the right arm and none of the left"
    )
    assert list_one_sided(Project()) == []


def share_met(project: Project) -> float:
    """The share of what a model writes in an hour for the arms that has the limb that was written."""
    paper = plan_as_in_paper(project)
    plan = make_plan(paper, HOUR, (), SEED).layers["arms"]
    last = {cue.meta: cue for cue in plan.cues}
    done = [(m.request.limb, last[m.key].action.limb) for m in plan.metas if m.written and m.key in last]
    return sum(wanted == limb for wanted, limb in done) / len(done)


def far_ends(project: Project) -> list[str]:
    return [p.message for p in check_project(project) if p.code in ("far-start", "far-end")]


@pytest.mark.nightly
def test_twins_fit_their_stances_and_more_limbs_are_met(sample: Project) -> None:
    lacking = [action for one in list_one_sided(sample) for action in one.actions]
    placed = with_twins(sample, lacking)
    twins = [a for a in new_actions(sample, placed) if a.limb == "left"]
    assert len(twins) == 13 and len(far_ends(placed)) == 22, "hand to chin is not the same on both sides"
    fitted = fit_twins(placed, [twin.id for twin in twins])
    assert not far_ends(fitted) and not list_one_sided(fitted)
    for twin in twins:
        after = fitted.action(twin.id)
        assert after is not None
        name = "" if (stance := fitted.stance(after.stance)) is None else stance.name
        assert after == twin if name == "hands clasped" else {j[:4] for j in after.joints} == {"Left"}
    assert (round(share_met(sample), 2), round(share_met(fitted), 2)) == (0.58, 0.72)
