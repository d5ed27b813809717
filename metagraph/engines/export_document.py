"""What the JSON of an export holds, made of a project."""

from __future__ import annotations

from typing import Any, Literal

from metagraph.engines import contract as c
from metagraph.engines.export_actions import NONE, list_exported_actions
from metagraph.engines.export_contacts import export_contact_rig
from metagraph.engines.export_listing import ListedExport, list_machine
from metagraph.engines.export_parameters import export_parameters
from metagraph.engines.export_rig import export_rig, list_export_voices
from metagraph.engines.export_weight import export_weight_rig, find_arm_rows, find_planted_feet
from metagraph.graph import anatomy
from metagraph.graph.model import KINDS, LAYERS, REACH, ClipEntry, MetaGraph, Project, Settings
from metagraph.motion.dense_keys import count_steps
from metagraph.playback.planning import choice, hashing, markov
from metagraph.playback.planning.cue_shapes import HURRY
from metagraph.playback.planning.layer_planning import WINDOW
from metagraph.playback.planning.sampling import LOOP_FADE
from metagraph.playback.timing.phase_times import LEAST_BLEND

_SCALES: tuple[Literal["neither", "smaller", "both"], ...] = ("neither", "smaller", "both")


def list_used_clips(project: Project) -> list[ClipEntry]:
    """Return the clips that are placed, and the base pose's, in the project's order."""
    placed = {*project.uses, project.base.clip}
    return [e for e in project.clips.values() if e.id in placed]


def to_document(project: Project, glb: str, names: tuple[str, ...], expanded: bool = False) -> c.Export:
    """Return the JSON's content, to be written. names: of the used clips' animations in the GLB. expanded:
    list the state machine, too, as text (`ListedExport`).
    """
    skeleton = project.skeleton
    assert skeleton is not None
    parts, sides, scales = (
        anatomy.project_parts(project),
        anatomy.project_sides(project),
        anatomy.find_joint_scales(project),
    )
    joints = [
        c.Joint(
            name,
            skeleton.names[skeleton.parents[i]] if skeleton.parents[i] >= 0 else None,
            parts[i],
            sides[i],  # type: ignore[arg-type]
            [float(x) for x in skeleton.rest_translations[i]],
            [float(x) for x in skeleton.rest_rotations[i]],
            _SCALES[int(scales[:, i].sum())],
        )
        for i, name in enumerate(skeleton.names)
    ]
    pose = anatomy.get_base_pose(project)
    steps = {e.id: _steps(e) for e in list_used_clips(project)}
    frame = project.base.frame * steps.get(project.base.clip or "", 1)
    base = c.Base(project.base.clip, frame, pose.rotations.tolist(), pose.translations.tolist())
    arms, feet = find_arm_rows(project), find_planted_feet(project)
    clips = [
        c.ExportedClip(
            e.id,
            name,
            n,
            e.fps * steps[e.id],
            (e.frames - 1) * steps[e.id] + 1 if e.frames else 0,
            e.duration,
            e.digest,
            e.made_by,
            e.made_seed if e.made_by else 0,
            arms.get(e.id, NONE),
            feet.get(e.id, NONE),
        )
        for n, (e, name) in enumerate(zip(list_used_clips(project), names, strict=True))
    ]
    kind: type[Any] = ListedExport if expanded else c.Export
    out: c.Export = kind(
        metagraph=c.FORMAT,
        name=project.name,
        glb=glb,
        height=skeleton.height,
        order=list(LAYERS),
        joints=joints,
        base=base,
        clips=clips,
        layers={layer: _layer(project, project.graphs[layer]) for layer in LAYERS},
        planner=_planner(project.settings),
        randomness=c.Randomness(
            "fnv1a32-mix",
            hashing.OFFSET,
            hashing.PRIME,
            [16, hashing.MIX[0], 13, hashing.MIX[1], 16],
            choice.key32(1, "a", "b"),
        ),
        roles=dict(project.roles),
        parts=dict(project.parts),
        expanded={layer: list_machine(project, project.graphs[layer]) for layer in LAYERS}
        if expanded
        else None,
        life=project.life,
        face=project.face,
        points=dict(project.points),
        lines=dict(project.lines),
        performances=dict(project.performances),
        rig=export_rig(project),
        voices=list_export_voices(project),
        touch=project.touch,
        contact_rig=export_contact_rig(project),
        weight_rig=export_weight_rig(project),
        parameters=export_parameters(project),
    )
    return out


def _steps(entry: ClipEntry) -> int:
    """Return the number of steps between dense keys that each step between a clip's keys becomes."""
    motion = entry.motion
    return round(motion.dense.fps / motion.fps) if motion is not None else count_steps(entry.fps)


def _planner(s: Settings) -> c.Planner:
    return c.Planner(
        s.seed & 0xFFFFFFFF, s.alpha, s.never_twice, s.shortest, s.wait, WINDOW, LOOP_FADE, "3x^2-2x^3",
        s.memory, s.rest, s.lookahead, HURRY, LEAST_BLEND, s.variety,
    )  # fmt: skip


def _layer(project: Project, graph: MetaGraph) -> c.ExportedLayer:
    index: dict[str, dict[c.KindName, list[str]]] = {}
    for stance in graph.stances:
        for kind in KINDS:
            if actions := graph.of(stance, kind):
                index.setdefault(stance, {})[kind] = [a.id for a in actions]
    ways: dict[tuple[str, str], list[str]] = {}
    for action in graph.actions.values():
        if action.kind == "transition" and action.end_stance is not None:
            ways.setdefault((action.stance, action.end_stance), []).append(action.id)
    model = markov.model(project, graph.layer)
    return c.ExportedLayer(
        start=graph.start,
        weights={part: graph.weight(part) for part in REACH[graph.layer]},
        own_weights=list(graph.weights),
        stances=[c.ExportedStance(s.id, s.name) for s in graph.stances.values()],
        actions=list_exported_actions(project, graph),
        index=index,
        transitions=[c.Transition(a, b, ids) for (a, b), ids in ways.items()],
        markov=c.ExportedMarkov(
            list(model.states),
            [list(row) for row in model.matrix],
            model.gap,
            model.positive,
            model.negative,
            list(model.tags),
            [list(pair) for pair in model.lengths],
            [list(row) for row in model.modes],
        ),
        own_markov=graph.layer in project.markov,
    )
