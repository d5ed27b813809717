import pytest
from metagraph.formats.store import open_project
from metagraph.study.by_hand import Way
from metagraph.study.counted_hand import try_way
from tests.app.expert import Expert
from tests.app.participant import bare, task
import os
pytestmark = [pytest.mark.window, pytest.mark.gl]
from tests.app.conftest import *
N=int(os.environ.get("N","20"))
@pytest.mark.parametrize("way",[Way("many at once","from aliases","words","many at once"),Way("one by one","from aliases","rubber bands","many at once",False),Way("many at once","from any state","words","many at once")])
def test_it(drive, way):
    from app.project.files import SAMPLE
    given=task(open_project(SAMPLE).project,N)
    bare(drive, given, "manual")
    e=Expert(drive, given)
    e.act=lambda c: e.draw(way)
    r=e.do("x")
    c=try_way(way, given.reference)
    print(way); print(dict(r.operators), r.predicted, r.ours, len(r.score.mistakes), r.score.right); print(dict(c.operators), c.seconds)
    assert not r.score.mistakes
