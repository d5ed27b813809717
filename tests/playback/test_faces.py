import numpy as np

from app.project.files import SAMPLE
from app.project.opening import open_whole
from metagraph.playback.planning.running_plan import list_kept_asks, plan_performance
from tests.posing import compute_morphs_at, faces_at


def test_faces_in_a_row_are_those_made_one_by_one_to_the_bit():
    project = open_whole(SAMPLE).project  # its character says which shapes its face has
    kept = next(iter(project.performances.values()))
    plan = plan_performance(project, list_kept_asks(kept), 6.0, 7, dict(kept.stances), kept.idle)
    times = np.arange(-0.5, 7.0, 0.37)
    alone = [compute_morphs_at(plan, project, float(at)) for at in times]
    assert faces_at(plan, project, times) == alone
    assert any(any(face.values()) for face in alone)
    assert faces_at(plan, project, times[:0]) == []
