import numpy as np

from app.project.files import SAMPLE
from app.project.opening import open_whole
from metagraph.playback.faces import faces_at
from metagraph.playback.planner import make_plan
from metagraph.playback.player import morphs_at


def test_faces_in_a_row_are_those_made_one_by_one_to_the_bit():
    project = open_whole(SAMPLE).project  # its character says which shapes its face has
    plan = make_plan(project, 4.0, seed=7)
    times = np.arange(-0.5, 5.0, 0.37)
    alone = [morphs_at(plan, project, float(at)) for at in times]
    assert faces_at(plan, project, times) == alone
    assert faces_at(plan, project, times[:0]) == []
