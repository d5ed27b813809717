"""The expanded machine in an export: its text reads as the connections that are counted one by one."""

from __future__ import annotations

import msgspec
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from metagraph.engines import contract as c
from metagraph.engines.export_listing import list_machine
from metagraph.graph.expand import list_connections
from metagraph.graph.model import LAYERS, Action, MetaGraph, Project, Stance, Timing
from tests.benchmarks import bench_export_size
from tests.projects import projects
from tests.thorough import many


def same(project: Project, graph: MetaGraph) -> int:
    """Hold a layer's text to its connections; return how many there are."""
    found = msgspec.json.decode(msgspec.json.encode(list_machine(project, graph)), type=c.Expanded)
    idents = list(graph.actions)
    assert found.states == idents
    rows = zip(found.sources, found.targets, found.leave, found.blend, strict=True)
    expected = [
        (x.source, x.target, -1.0 if x.leave is None else x.leave, x.blend)
        for x in list_connections(project, graph)
    ]
    assert [(idents[s], idents[t], -1.0 if leave < 0 else leave, b) for s, t, leave, b in rows] == expected
    return len(expected)


@settings(max_examples=many(30, 1000), deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(projects(14))
def test_the_text_of_any_machine_reads_as_its_connections(project: Project) -> None:
    for layer in LAYERS:
        same(project, project.graphs[layer])


@settings(max_examples=many(20, 200), deadline=None)
@given(st.integers(1, 60), st.data())
def test_sources_loops_and_what_leads_to_itself_have_their_own_numbers(
    count: int, data: st.DataObject
) -> None:
    stances = {name: Stance(name, "arms", name) for name in ("s1", "s2")}
    seconds = st.sampled_from((0.0, 0.1, 1 / 3, 1e-9, 12.0))
    actions = {}
    for n in range(count):
        kind = data.draw(st.sampled_from(("stance", "gesture", "fidget", "transition")))
        timing = Timing(0.0, None, data.draw(seconds), data.draw(seconds), earliest_exit=data.draw(seconds))
        end = data.draw(st.sampled_from(("s1", "s2", "gone", None))) if kind == "transition" else None
        actions[f"a{n}"] = Action(
            f"a{n}", "c", kind, "arms", data.draw(st.sampled_from(("s1", "s2"))), f"a{n}", end, timing
        )
    same(Project(), MetaGraph("arms", stances, actions))


def test_a_large_machine_is_whole() -> None:
    project = bench_export_size.project(300)
    assert sum(same(project, project.graphs[layer]) for layer in LAYERS) > 3000


def test_a_layer_without_connections_has_empty_columns() -> None:
    found = list_machine(Project(), MetaGraph("arms"))
    assert msgspec.json.encode(found) == b'{"states":[],"from":[],"to":[],"leave":[],"blend":[]}'
