"""The live stage without lines: how busy it says it is."""

from __future__ import annotations

import time
from dataclasses import replace

import pytest

from app.stage.live_stage import TAKES, WINDOW, LiveStage
from metagraph.graph import edits
from metagraph.graph.conversation.model import Conversation, Side
from metagraph.graph.model import Project
from metagraph.live.graph_motion import list_recorded_takes
from metagraph.live.messages import Generate
from tests.synthesis.talking import talkers


def test_requests_are_counted_whether_they_are_taken_on_or_refused(qapp, toy):
    stage = LiveStage(toy.project())
    stage._clock.start()
    stage.tick()
    for n in range(30):
        stage.session.receive(
            WINDOW, f'{{"do": "line", "id": "{n}", "line": "none"}}' if n % 2 else '{"do": "nothing known"}'
        )
    time.sleep(0.02)
    stage.tick()
    assert stage.session.answered == 30 and stage.tape.count == 0
    assert stage.rate > 0
    assert stage.asks is stage.asks, "the same requests are the same tuple, so that they are painted once"


@pytest.fixture
def recorded() -> Project:
    """A project with two takes that were recorded along with conversations."""
    takes, said = talkers()
    project = edits.add_clips(Project(), [(f"{take.name}.glb", 0, "", take) for take in takes[:2]])
    talks = {}
    for n, ident in enumerate(project.clips):
        own = tuple(s for s in said[n] if s.kind != "hesitation")
        sides = (Side(take=ident, segments=own), Side())
        talks[f"talk{n}"] = Conversation(name=f"talk{n}", length=20.0, sides=sides)
    return replace(project, conversations=talks)


def made(stage: LiveStage) -> LiveStage:
    """Begin to make the graph; wait until it is made."""
    stage._make_graph()
    until = time.monotonic() + 120
    while stage._graph is not None and time.monotonic() < until:
        stage.tick()
        time.sleep(0.01)
    return stage


def test_the_motion_graph_of_the_projects_own_takes_is_offered_once_it_is_made(qapp, recorded):
    clips, speech = list_recorded_takes(recorded)
    assert len(clips) == len(speech) == 2
    stage = LiveStage(recorded)
    stage.session.offer(TAKES, None)
    wish = Generate(model=TAKES, side="speaker")
    assert "is being made" in stage.session.generating.generate(WINDOW, wish, recorded, 0.0).why
    made(stage)
    reply = stage.session.generating.generate(WINDOW, wish, recorded, stage.session.now)
    assert reply.state == "planned" and not stage.graph_error
    stage.session.tick(stage.session.now + 0.5)
    assert stage.session.overlay(stage.session.now) is not None  # what the window lays over its plan


def test_a_project_without_takes_has_no_graph_and_one_that_cannot_be_made_says_why(
    qapp, toy, recorded, monkeypatch
):
    assert made(LiveStage(toy.project())).session.generating.graphs == {}

    def fails(*_: object) -> None:
        raise ValueError("no two states are connected")

    monkeypatch.setattr("app.stage.live_stage.make_live_graph", fails)
    stage = made(LiveStage(recorded))
    assert stage.session.generating.graphs == {} and stage.graph_error == "no two states are connected"


def test_takes_nobody_said_anything_during_are_left_out(recorded):
    silent = {
        ident: Conversation(name=ident, length=20.0, sides=(Side(take=talk.sides[0].take), Side()))
        for ident, talk in recorded.conversations.items()
    }
    assert list_recorded_takes(replace(recorded, conversations=silent)) == ([], [])
