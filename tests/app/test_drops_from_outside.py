"""Files dragged in from another program, truly: its window, the X server's protocol for drags, this window."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint

from metagraph.formats.gltf.writer import write_glb
from metagraph.graph.requests import Play
from tests.app.conftest import real_pointer
from tests.processes import started

SOURCE = Path(__file__).with_name("file_source.py")


@pytest.fixture
def drop(toys, toy, tmp_path):
    """Drag files named so from the other program onto a place; until something has come of it."""
    if not real_pointer():
        pytest.skip("a real drag needs X11 and xdotool")

    def go(names, place, until) -> None:
        paths = [tmp_path / name for name in names]
        for path in paths:
            if path.suffix == ".glb":
                write_glb(path, [toy.clip(path.stem)])
        corner = toys.window.mapToGlobal(QPoint(300, 0))
        words = (sys.executable, str(SOURCE), str(corner.x()), str(corner.y()), *map(str, paths))
        with started(*words, longest=60, stdout=subprocess.PIPE) as process:
            assert process.stdout.readline().strip() == "ready"
            toys.pause(50)
            start = toys.window, QPoint(330, 20)
            toys.drag(start, place, until)
            process.terminate()

    return go


@pytest.mark.nightly
@pytest.mark.gl
def test_files_are_dropped_on_the_library(toys, drop):
    toys.workspaces.choose("label")
    toys.pause(50)
    view = toys.library.list.viewport()
    count = len(toys.document.project.clips)
    drop(
        ["nod ä.glb", "shake it.glb"],
        (view, view.rect().center()),
        lambda: len(toys.document.project.clips) == count + 2,
    )
    names = [e.name for e in toys.document.project.clips.values()]
    assert names[-2:] == ["nod ä", "shake it"]


@pytest.mark.nightly
@pytest.mark.gl
def test_files_are_dropped_on_a_node(toys, drop):
    drop(["point.glb"], toys.node("gesture"), lambda: "point" in toys.names("gesture"))
    assert "point" not in toys.names("fidget")


@pytest.mark.nightly
@pytest.mark.gl
def test_files_are_dropped_on_a_lane_and_are_asked_for_there(toys, drop):
    toys.workspaces.choose("perform")
    toys.session.transport.show_plan()
    toys.session.transport.set_playing(False)
    toys.pause(100)
    lanes = toys.timeline.lanes
    from app.widgets.lane_geometry import place_lanes as places

    y = round(places(lanes.height())["arms"].center().y())
    at = QPoint(round(lanes.scale().x(4.0)), y)
    asks = lambda: [x for p in toys.document.project.performances.values() for x in p.asks]  # noqa: E731
    drop(["wave.glb"], (lanes, at), lambda: bool(asks()))
    (ask,) = asks()
    assert isinstance(ask, Play) and ask.at == pytest.approx(4.0, abs=0.1)
    action = toys.document.project.action(ask.action)
    assert (action.name, action.kind, action.layer) == ("wave", "gesture", "arms")
