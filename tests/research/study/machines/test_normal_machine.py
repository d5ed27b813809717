"""Machines in normal form: the same whether they were authored by meta-graph or drawn by hand."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given

from metagraph.graph import edits
from metagraph.graph.expand import count_machine_size
from metagraph.graph.manual import edits as manual_edits
from metagraph.graph.manual.machine import ANY
from metagraph.graph.model import Project
from metagraph.research.study.machines.normal_machine import is_manual, name_clips, normalize_machines
from metagraph.research.study.simulation.work import draw_every_connection
from tests.projects import clip, projects
from tests.research.study.makers import LAYER, small


def test_an_empty_project_has_no_machines() -> None:
    assert normalize_machines(Project()) == {}
    assert normalize_machines(Project(), manual=True) == {}
    assert not is_manual(Project())


def test_a_meta_graph_is_expanded_and_known_by_its_clips() -> None:
    found = normalize_machines(small())[LAYER]
    assert len(found.states) == 8 and len(found.connections) == count_machine_size(small()).connections == 28
    wave = found.states["sides_wave.glb"]
    assert (wave.kind, found.stances[wave.stance or ""], wave.start, wave.end, wave.loop) == (
        "gesture",
        "sides",
        0.0,
        2.0,
        False,
    )
    assert ("sides_wave.glb", "sides_idle.glb") in found.connections
    assert ("sides_wave.glb", "hips_idle.glb") not in found.connections
    assert found.connections["sides_idle.glb", "sides_wave.glb"].leave is None
    assert found.resting(wave.stance or "") == {"sides_idle.glb"}


def test_what_is_drawn_by_hand_comes_to_the_same() -> None:
    by_hand = draw_every_connection(small())
    assert is_manual(by_hand) and not is_manual(small())
    meta, manual = normalize_machines(small())[LAYER], normalize_machines(by_hand)[LAYER]
    assert manual.connections.keys() == meta.connections.keys()
    assert {k: s.kind for k, s in manual.states.items()} == {k: s.kind for k, s in meta.states.items()}
    for pair, c in meta.connections.items():
        if not meta.states[pair[0]].loop:
            assert manual.connections[pair] == c


def test_a_link_from_any_state_stands_for_one_from_every_other() -> None:
    project = edits.add_clips(Project(), [(f"{n}.glb", 0, "", clip(n)) for n in ("idle", "wave", "nod")])
    project = manual_edits.add_states(project, [*project.clips], LAYER)
    idle, wave, _ = project.manual[LAYER].states
    project = manual_edits.update_states(project, [idle], loop=True)
    project = manual_edits.add_link(project, LAYER, ANY, wave)
    project = manual_edits.add_link(project, LAYER, idle, wave)
    project = manual_edits.add_link(project, LAYER, idle, idle)
    own = [*project.manual[LAYER].links][1]
    project = manual_edits.update_links(project, [own], blend=0.7)
    found = normalize_machines(project)[LAYER]
    assert found.connections.keys() == {("idle.glb", "wave.glb"), ("nod.glb", "wave.glb")}, (
        "a loop follows itself anyway"
    )
    assert found.connections["idle.glb", "wave.glb"].blend == 0.7, (
        "a link of its own comes before one from any state"
    )
    assert found.connections["nod.glb", "wave.glb"].leave is None, "a request is answered at once"


def test_what_ends_with_its_blend_is_left_at_its_end() -> None:
    project = edits.add_clips(Project(), [(f"{n}.glb", 0, "", clip(n, 61)) for n in ("wave", "idle")])
    project = manual_edits.add_states(project, [*project.clips], LAYER)
    wave, idle = project.manual[LAYER].states
    project = manual_edits.add_link(project, LAYER, wave, idle)
    link = next(iter(project.manual[LAYER].links))
    for exit_time, blend, leave in ((None, 0.3, 2.0), (1.7, 0.3, 2.0), (1.9, 0.3, 2.0), (1.0, 0.3, 1.0)):
        made = manual_edits.update_links(project, [link], exit_time=exit_time, blend=blend)
        assert normalize_machines(made)[LAYER].connections["wave.glb", "idle.glb"].leave == leave, (
            exit_time,
            blend,
        )


def test_uses_takes_and_files_that_are_called_alike_are_told_apart() -> None:
    some = [
        ("a/x.glb", 0, "", clip("x")),
        ("b/x.glb", 0, "", clip("y")),
        ("b/x.glb", 1, "", clip("z")),
        ("b/w.glb", 0, "", clip("w")),
    ]
    project = edits.add_clips(Project(), some)
    assert [*name_clips(project).values()] == ["a/x.glb", "b/x.glb", "b/x.glb:1", "w.glb"]
    project = edits.add_stance(project, LAYER, "rest", [next(iter(project.clips))])
    stance = next(iter(project.graphs[LAYER].stances))
    project = edits.place_clips(project, [[*project.clips][3]] * 2, LAYER, "gesture", stance)
    assert [*normalize_machines(project)[LAYER].states] == ["a/x.glb", "w.glb", "w.glb#2"]


def test_a_clip_that_is_gone_has_no_length_but_a_place() -> None:
    project = small()
    wave = next(i for i, e in project.clips.items() if e.name == "sides_wave")
    project = replace(project, clips={i: e for i, e in project.clips.items() if i != wave})
    found = normalize_machines(project)[LAYER]
    assert wave in found.states and found.states[wave].end == 0.0


@given(projects())
def test_every_project_has_a_normal_form_as_large_as_its_machine(project: Project) -> None:
    found = normalize_machines(project, manual=False)
    assert sum(len(m.states) for m in found.values()) == count_machine_size(project).states
    assert sum(len(m.connections) for m in found.values()) == count_machine_size(project).connections
    by_hand = normalize_machines(draw_every_connection(project), manual=True)
    assert {x: m.connections.keys() for x, m in by_hand.items()} == {
        x: m.connections.keys() for x, m in found.items()
    }
