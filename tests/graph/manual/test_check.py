"""Problems of manual machines: each is found, and a sound machine has none."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.manual import edits as m
from metagraph.graph.manual.machine import ANY, Link
from metagraph.graph.model import Project
from tests.projects import clip

pytestmark = pytest.mark.usefixtures("numbered_ids")


def sound() -> Project:
    """stand (m4, a loop) -> wave (m5) -> stand; links l7, l8."""
    project = edits.add_clips(
        Project("sound"), [(f"{n}.glb", 0, "", clip(n)) for n in ("stand", "wave", "nod")]
    )
    project = m.update_states(m.add_states(project, ["c1", "c2"], "arms"), ["m4"], loop=True)
    project = m.add_link(m.add_link(project, "arms", "m4", "m5"), "arms", "m5", "m4")
    return m.update_links(project, ["l6"], condition={"when": "request"})


def found(project: Project) -> list[str]:
    return [
        p.code for p in check_project(project) if p.state or p.link or p.code in ("no-start", "file-missing")
    ]


def test_a_sound_machine_has_no_problems() -> None:
    assert found(sound()) == []
    assert "no-stance" not in [p.code for p in check_project(sound())]


def test_one_state_alone_is_no_dead_end() -> None:
    assert found(m.remove_states(sound(), ["m5"])) == []


def with_link(project: Project, **fields: object) -> Project:
    manual = project.manual["arms"]
    return project.with_manual(
        replace(manual, links={**manual.links, "l6": replace(manual.links["l6"], **fields)})
    )


WRONG: list[tuple[str, Callable[[Project], Project]]] = [
    ("no-start", lambda p: p.with_manual(replace(p.manual["arms"], start=None))),
    ("unreachable", lambda p: m.add_link(m.add_states(p, ["c3"], "arms"), "arms", "m8", "m4")),
    ("dead-end", lambda p: m.remove_states(p, (), ["l7"])),
    ("no-exit", lambda p: m.update_states(m.remove_states(p, (), ["l7"]), ["m5"], loop=True)),
    ("waits", lambda p: m.update_links(p, ["l7"], condition={"when": "request"})),
    ("twice", lambda p: m.add_link(p, "arms", "m5", "m4")),
    ("trim", lambda p: m.update_states(p, ["m5"], end=5.0)),
    ("trim", lambda p: m.update_states(p, ["m5"], start=float("nan"))),
    ("empty", lambda p: m.update_states(p, ["m5"], start=0.8, end=0.5)),
    ("mask", lambda p: m.update_states(p, ["m5"], joints=("Tail",))),
    ("mask", lambda p: m.update_states(p, ["m5"], joint_weights=(("Tail", 0.5),))),
    ("lost-clip", lambda p: replace(p, clips={i: e for i, e in p.clips.items() if i != "c2"})),
    ("file-missing", lambda p: replace(p, clips={**p.clips, "c2": replace(p.clips["c2"], motion=None)})),
    ("weight", lambda p: m.update_links(p, ["l6"], condition={"weight": 0.0})),
    ("no-trigger", lambda p: with_link(p, condition=replace(p.link("l6").condition, trigger=" "))),  # type: ignore[union-attr]
    ("blend", lambda p: m.update_links(p, ["l6"], blend=-0.1)),
    ("blend", lambda p: m.update_links(p, ["l7"], blend=3.0)),
    ("exit", lambda p: m.update_links(p, ["l7"], exit_time=3.0)),
    ("any-finished", lambda p: with_link(p, source=ANY, condition=Link("", "", "").condition)),
]


@pytest.mark.parametrize(("code", "spoil"), WRONG, ids=[f"{n}-{code}" for n, (code, _) in enumerate(WRONG)])
def test_each_problem_is_found_says_what_to_do_and_where(
    code: str, spoil: Callable[[Project], Project]
) -> None:
    problems = {p.code: p for p in check_project(spoil(sound()))}
    assert code in problems
    assert problems[code].message
    assert problems[code].remedy.endswith(".")
    assert problems[code].state or problems[code].link or code in ("no-start", "file-missing")
