"""Random projects for tests: built by the edits an animator makes, so that whatever can be made is made."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import strategies as st

from metagraph.common.network_paths import explain_refusal
from metagraph.formats.store import open_project, save_project
from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.manual import edits as manual_edits
from metagraph.graph.manual import groups as manual_groups
from metagraph.graph.manual.machine import ANY, WHENS
from metagraph.graph.model import KINDS, LAYERS, LIMBS, PARTS, Markov, Project
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton

NASTY = (
    "yes",
    "no",
    "Off",
    "null",
    "~",
    "1e3",
    "1_000",
    "0x1F",
    "12:30:00",
    "2024-01-01",
    ".inf",
    "NaN",
    "=",
    "<<",
    "true",
    "y",
    "None",
    "#hash",
    "a #b",
    "a: b",
    "a:b",
    "- a",
    "-",
    "?",
    "[x]",
    "{x}",
    "*a",
    "&a",
    "!tag",
    "!!python/object",
    "%d",
    "@a",
    "`a",
    "a\tb",
    "'single'",
    '"double"',
    "back\\slash",
    "new\nline",
    "\r\n",
    "trailing ",
    " leading",
    "Größe",
    "日本語",
    "🙂",
    "a\u2028b",
    "\u0085",
    "\x7f",
    "\ufeff",
    "\x00",
    "...",
    "---",
    "|",
    ">",
    "a,b",
    "nod_01 (v2)",
    "e1",
    "x" * 300,
    "\ud83d",
)

times = st.floats(0, 30).map(lambda x: round(x, 3))
words = st.one_of(
    st.sampled_from([n for n in NASTY if n != "\ud83d"]),
    st.text(st.characters(exclude_categories=["Cs"]), min_size=1, max_size=12),
)


def named(text: str) -> bool:
    return bool(text.split())


names = words.filter(named)

SKELETON = Skeleton(
    ("Hips", "Spine", "Head", "LeftArm"),
    np.array([-1, 0, 1, 1]),
    np.array([[0, 0, 0, 1.0], [0.1, 0.2, 0.3, 0.4], [0, 0.7071, 0, 0.7071], [0, 0, 0, 1]]),
    np.array([[0, 1, 0], [0, 0.12345, 1 / 3], [0, 0.1, 0], [0.2, 0, 1e-9]]),
)
_STILL = np.tile(SKELETON.rest_rotations, (2, 1, 1))


def clip(name: str, frames: int = 31) -> Clip:
    """A clip that does not move."""
    still = np.broadcast_to(SKELETON.rest_rotations, (frames, 4, 4))
    return Clip(name, SKELETON, 30, still, np.broadcast_to(SKELETON.rest_translations[:1], (frames, 1, 3)))


# Those that may be opened: COM0.glb is a device.
_clip_paths = names.map(lambda name: f"clips/{name}.glb").filter(lambda path: explain_refusal(path) is None)


def _import(draw: Any, project: Project) -> Project:
    count = draw(st.integers(1, 3))
    return edits.add_clips(
        project,
        [
            (
                draw(_clip_paths),
                n,
                draw(st.sampled_from(["", "ab" * 32])),
                clip(draw(names), draw(st.integers(1, 90))),
            )
            for n in range(count)
        ],
    )


def _stance(draw: Any, project: Project) -> Project:
    return edits.add_stance(
        project,
        draw(st.sampled_from(LAYERS)),
        draw(names),
        draw(st.lists(st.sampled_from([*project.clips]), max_size=2)) if project.clips else (),
    )


def _place(draw: Any, project: Project) -> Project:
    layer = draw(st.sampled_from(LAYERS))
    stances = [*project.graphs[layer].stances]
    if not project.clips or not stances:
        return project
    chosen = draw(st.lists(st.sampled_from([*project.clips]), min_size=1, max_size=3))
    try:
        return edits.place_clips(
            project,
            chosen,
            layer,
            draw(st.sampled_from(KINDS)),
            draw(st.sampled_from(stances)),
            draw(st.sampled_from(stances)),
        )
    except EditError:
        return project


def _update(draw: Any, project: Project) -> Project:
    ids = [a.id for a in project.actions()]
    if not ids:
        return project
    changes = draw(
        st.fixed_dictionaries(
            {},
            optional={
                "name": names,
                "likelihood": st.sampled_from([0.5, 2.0, 1e-7, 123456.789]),
                "limb": st.sampled_from(LIMBS),
                "tags": st.lists(words, max_size=3).map(tuple),
                "joints": st.lists(st.sampled_from(SKELETON.names), max_size=2).map(tuple),
                "joint_weights": st.sampled_from([(), (("Head", 0.25),), (("Head", 0.5), ("Hips", 0.75))]),
                "timing": st.fixed_dictionaries(
                    {},
                    optional={
                        "start": times,
                        "end": st.none() | times,
                        "blend_in": times,
                        "blend_out": times,
                        "loop": st.booleans(),
                        "earliest_exit": st.none() | times,
                        "stroke": st.none() | times,
                        "repeat": times,
                    },
                ),
            },
        )
    )
    return edits.update_actions(
        project, draw(st.lists(st.sampled_from(ids), min_size=1, max_size=3)), **changes
    )


def _remove(draw: Any, project: Project) -> Project:
    ids = [a.id for a in project.actions()]
    return edits.remove_actions(project, draw(st.lists(st.sampled_from(ids), max_size=3))) if ids else project


def _remove_stance(draw: Any, project: Project) -> Project:
    ids = [s for layer in LAYERS for s in project.graphs[layer].stances]
    return edits.remove_stance(project, draw(st.sampled_from(ids))) if ids else project


def _remove_clips(draw: Any, project: Project) -> Project:
    return (
        edits.remove_clips(project, [draw(st.sampled_from([*project.clips]))]) if project.clips else project
    )


def _move(draw: Any, project: Project) -> Project:
    ids = [a.id for a in project.actions()]
    stances = [s for layer in LAYERS for s in project.graphs[layer].stances]
    if not ids:
        return project
    try:
        return edits.move_actions(
            project,
            [draw(st.sampled_from(ids))],
            draw(st.sampled_from(KINDS)),
            draw(st.sampled_from(stances)),
            draw(st.sampled_from(stances)),
        )
    except EditError:
        return project


def _rest(draw: Any, project: Project) -> Project:
    layer = draw(st.sampled_from(LAYERS))
    third = 1 / 3
    return draw(
        st.sampled_from(
            [
                lambda p: edits.set_weight(
                    p, layer, draw(st.sampled_from(PARTS)), draw(st.sampled_from([0.0, 0.35, 2.0]))
                ),
                lambda p: edits.set_settings(
                    p, seed=draw(st.integers(0, 2**32 - 1)), alpha=draw(st.sampled_from([0.0, 2.5]))
                ),
                lambda p: edits.set_settings(p, never_twice=draw(st.booleans())),
                lambda p: edits.set_role(p, draw(names), draw(st.none() | st.sampled_from(SKELETON.names))),
                lambda p: edits.set_part(
                    p, [draw(st.sampled_from(SKELETON.names))], draw(st.none() | st.sampled_from(PARTS))
                ),
                lambda p: edits.set_character(p, draw(st.none() | words)),
                lambda p: edits.hide_meshes(p, draw(st.lists(names, max_size=3))),
                lambda p: edits.rename_project(p, draw(names)),
                lambda p: edits.set_base(
                    p, draw(st.sampled_from([None, *p.clips])), draw(st.integers(0, 40))
                ),
                lambda p: edits.set_markov(
                    p,
                    Markov(
                        layer,
                        (("left", "gesture"), ("both", "fidget"), ("both", "transition")),
                        ((third, third, third),) * 3,
                        1.5,
                        0.25,
                    ),
                ),
                lambda p: edits.set_markov(
                    p,
                    Markov(
                        layer,
                        (("left", "gesture"),) * 2,
                        ((0.1, 0.9), (third, 2 * third)),
                        0.8,
                        tags=draw(st.sampled_from([(), ("", "positive"), ("very negative", "")])),
                        lengths=draw(st.sampled_from([(), ((1.25, 0.0), (0.5, 2.125))])),
                    ),
                ),
                lambda p: replace(
                    p,
                    graphs={
                        **p.graphs,
                        layer: replace(p.graphs[layer], start=next(iter(p.graphs[layer].stances), None)),
                    },
                ),
            ]
        )
    )(project)


def _manual(draw: Any, project: Project) -> Project:
    layer = draw(st.sampled_from(LAYERS))
    found = manual_edits.get_machine(project, layer)
    states, links = [*found.states], [*found.links]
    if not states or (project.clips and draw(st.integers(0, 3)) == 0):
        chosen = (
            draw(st.lists(st.sampled_from([*project.clips]), min_size=1, max_size=3)) if project.clips else []
        )
        return (
            manual_edits.add_states(project, chosen, layer, draw(times), -draw(times)) if chosen else project
        )
    some = draw(st.lists(st.sampled_from(states), min_size=1, max_size=3))
    step = draw(st.integers(0, 9))
    aliases = list(project.manual[layer].aliases)
    if step > 7:
        if not aliases or step == 8:
            return manual_groups.add_alias(project, layer, some, draw(st.booleans()))
        changes = {"again": draw(st.booleans()), "entry": draw(st.none() | st.sampled_from(states))}
        after = manual_groups.update_aliases(project, aliases[-1:], name=draw(names), **changes)
        return manual_groups.set_alias_states(after, aliases[-1], some, draw(st.booleans()))
    if step < 3 or not links:
        entered = [a.id for a in project.manual[layer].aliases.values() if a.entry is not None]
        return manual_edits.add_link(
            project,
            layer,
            draw(st.sampled_from([*states, *aliases, ANY])),
            draw(st.sampled_from([*states, *entered])),
        )
    if step == 3:
        fields = {
            "loop": draw(st.booleans()),
            "start": draw(times),
            "end": draw(st.none() | times),
            "limb": draw(st.sampled_from(LIMBS)),
        }
        return manual_edits.update_states(
            project,
            some,
            name=draw(names),
            joints=draw(st.sampled_from([(), ("Head",)])),
            joint_weights=draw(st.sampled_from([(), (("Head", 0.25),)])),
            **fields,
        )
    if step == 4:
        condition = {
            "when": draw(st.sampled_from(WHENS)),
            "trigger": draw(names),
            "weight": draw(st.sampled_from([0.5, 3.0])),
        }
        fields = {
            "exit_time": draw(st.none() | times),
            "exit_part": draw(st.sampled_from([None, 0.5, 1.0])),
            "blend": draw(times),
        }
        return manual_edits.update_links(
            project, [draw(st.sampled_from(links))], condition=condition, **fields
        )
    if step == 5:
        return manual_edits.paste_states(
            project, layer, manual_edits.copy_states(project, some), draw(times), draw(times)
        )[0]
    if step == 6:
        return manual_edits.remove_states(project, [*some[:1], *aliases[:1]], [draw(st.sampled_from(links))])
    return manual_edits.set_start_state(
        manual_edits.move_nodes(project, layer, {some[0]: (draw(times), 0.5), ANY: (-3.0, 4.0)}), some[-1]
    )


EDITS: tuple[Callable[[Any, Project], Project], ...] = (
    _import,
    _stance,
    _stance,
    _place,
    _place,
    _place,
    _update,
    _update,
    _remove,
    _remove_stance,
    _remove_clips,
    _move,
    _rest,
    _manual,
    _manual,
)


@st.composite
def histories(draw: Any, most: int = 12, begin: Project | None = None) -> list[Project]:
    """Every state of a project that somebody edits, with some steps taken back and done again. begin: the
    first one; None: an empty project.
    """
    states = [begin if begin is not None else Project(draw(names))]
    for _ in range(draw(st.integers(0, most))):
        if len(states) > 1 and draw(st.integers(0, 5)) == 0:
            states.append(draw(st.sampled_from(states)))
        else:
            states.append(draw(st.sampled_from(EDITS))(draw, states[-1]))
    return states


def projects(most: int = 12) -> st.SearchStrategy[Project]:
    return histories(most).map(lambda states: states[-1])


FEW = (
    "hands_at_sides__stance", "hands_at_sides__beat_small_rt_01", "hands_at_sides__wave_hello_rt_01",
    "hands_at_sides__touch_neck_rt_01", "hands_at_sides__to__on_hips", "on_hips__stance",
    "on_hips__beat_small_rt_01", "on_hips__to__hands_at_sides", "body_weight_both__stance",
    "body_weight_both__sway_01", "head_straight__stance", "head_straight__nod_single_01",
    "head_straight__shake_01", "head_straight__glance_01",
)  # fmt: skip


def few_of_the_sample(folder: Path) -> Path:
    """Write the sample project with a tenth of its clips, and return its file: for what opens it in a process
    of its own, which takes a second with all of them.
    """
    source = Path(__file__).resolve().parents[1] / "sample_clips"
    for name in ("lines", "clips"):
        (folder / name).mkdir(parents=True)
    for path in (*source.glob("*.glb"), *(source / "lines").iterdir()):
        shutil.copy(path, folder / path.relative_to(source))
    for name in FEW:
        shutil.copy(source / "clips" / f"{name}.glb", folder / "clips")
    project = open_project(source / "sample.metagraph.yaml").project
    base = next(entry.id for entry in project.clips.values() if entry.name == "hands_at_sides__stance")
    project = edits.remove_clips(project, [e.id for e in project.clips.values() if e.name not in FEW])
    used = {action.stance for action in project.actions()}
    for stance in [s for g in project.graphs.values() for s in g.stances if s not in used]:
        project = edits.remove_stance(project, stance)
    path = folder / "sample.metagraph.yaml"
    save_project(edits.set_base(project, base), path)
    return path
