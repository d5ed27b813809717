"""Tools that look at a project: its clips with measures and pictures, and its graph."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from msgspec import Meta, Struct

from app.authoring.finding import find_clips, find_named_stance, name_stance
from app.authoring.pictures import draw_clips
from app.authoring.tool import AuthorTool, ToolOutcome, ToolWork
from metagraph.graph import anatomy
from metagraph.graph.model import LAYERS, Action, Kind, Layer, Limb, Project
from metagraph.suggest.propose import list_waiting_clips
from metagraph.suggest.traits import Traits, measure_traits

MOST_PICTURES = 24  # of one call
MOST_ROWS = 500  # of one call


class ListClips(Struct, forbid_unknown_fields=True, omit_defaults=True):
    """only: clips that have a label, or those that wait for one. clips: only these, by id or name. first,
    count: which of them, from 0. pictures: also draw each in its clearest pose, at most 24.
    """

    only: Literal["all", "unlabelled", "labelled"] = "all"
    clips: list[str] = []
    first: Annotated[int, Meta(ge=0)] = 0
    count: Annotated[int, Meta(ge=1, le=MOST_ROWS)] = 100
    measures: bool = True
    pictures: bool = False


class ClipMeasures(Struct, omit_defaults=True):
    """How a clip moves. speeds: metres a second of each part of the body, the root of the mean square.
    travel: metres over the ground. turned: degrees. ends_apart: metres between the first and the last pose,
    of the farthest point. reach: metres that a point of the arms goes away from its ends. resting: share of
    the time in which nothing moves, 0 to 1. side: -1 if only the right arm moves, 0 for both, 1 for the left.
    """

    speeds: dict[str, float]
    travel: float
    turned: float
    ends_apart: float
    reach: float
    resting: float
    side: float


class ClipRow(Struct, omit_defaults=True):
    """A clip. actions: its uses, in words. picture: the number of its picture among those of the result, from
    0. measures: none for a clip whose file is missing.
    """

    id: str
    name: str
    seconds: float
    file: str
    actions: list[str] = []
    measures: ClipMeasures | None = None
    picture: int | None = None


class ClipsReport(Struct, omit_defaults=True):
    """total: how many there are, of which these are some. notes: what could not be done."""

    total: int
    clips: list[ClipRow]
    notes: list[str] = []


def _list_clips(work: ToolWork, given: ListClips) -> ToolOutcome:
    """Return clips with their measures and, if wanted, pictures."""
    project = work.project
    wanted = find_clips(project, given.clips) if given.clips else list(project.clips)
    if given.only != "all":
        waiting = set(list_waiting_clips(project))
        wanted = [clip for clip in wanted if (clip in waiting) == (given.only == "unlabelled")]
    shown = wanted[given.first : given.first + given.count]
    roles = anatomy.project_roles(project) if project.skeleton is not None else None
    rows = []
    for number, clip in enumerate(shown):
        work.report(number, len(shown), f"measuring clip {number + 1} of {len(shown)}")
        entry = project.clips[clip]
        row = ClipRow(clip, entry.name, round(entry.duration, 3), entry.path, _describe_uses(project, clip))
        if given.measures and entry.motion is not None and project.skeleton is not None:
            row.measures = _measure(measure_traits(project.skeleton, roles, entry.motion))
        rows.append(row)
    notes: list[str] = []
    pictures: tuple[bytes, ...] = ()
    if given.pictures:
        drawn, notes = draw_clips(work, [row.id for row in rows[:MOST_PICTURES]])
        pictures = tuple(drawn.values())
        for number, clip in enumerate(drawn):
            next(row for row in rows if row.id == clip).picture = number
        if len(rows) > MOST_PICTURES:
            notes.append(f"only the first {MOST_PICTURES} have pictures; ask for the others with `first`")
    return ToolOutcome(ClipsReport(len(wanted), rows, notes), pictures=pictures)


def _describe_uses(project: Project, clip: str) -> list[str]:
    return [
        f"{a.kind} '{a.name}' ({a.id}) in {a.layer}, '{name_stance(project, a.stance)}'"
        for a in project.uses.get(clip, ())
    ]


def _measure(t: Traits) -> ClipMeasures:
    layers = t.layers.values()
    return ClipMeasures(
        {part: round(speed * t.height, 3) for part, speed in t.energy.items()},
        round(t.travel * t.height, 3),
        round(t.turned, 1),
        round(max((x.loop_error for x in layers), default=0.0) * t.height, 3),
        round(t.layers["arms"].extent * t.height, 3),
        round(float(np.mean([x.rest for x in layers])) if t.layers else 0.0, 3),
        round(t.symmetry, 2),
    )


class ShowGraph(Struct, forbid_unknown_fields=True, omit_defaults=True):
    """layer, stance, kind: show only these. first, count: which of the actions, from 0."""

    layer: Layer | None = None
    stance: str | None = None
    kind: Kind | None = None
    first: Annotated[int, Meta(ge=0)] = 0
    count: Annotated[int, Meta(ge=1, le=MOST_ROWS)] = 200


class StanceRow(Struct, omit_defaults=True):
    """A stance. counts: its actions by kind. start: whether performances begin in it."""

    id: str
    name: str
    layer: Layer
    counts: dict[str, int]
    start: bool = False


class ActionView(Struct, omit_defaults=True):
    """An action. Times are seconds of its clip, which lasts `clip_seconds`; null is as it is found, for `end`
    the clip's end.
    """

    id: str
    name: str
    kind: Kind
    layer: Layer
    stance: str
    clip: str
    clip_seconds: float
    start: float
    end: float | None
    blend_in: float
    blend_out: float
    end_stance: str = ""
    limb: Limb = "both"
    tags: tuple[str, ...] = ()
    likelihood: float = 1.0
    cooldown: float = 0.0
    loop: bool = False
    stroke: float | None = None
    earliest_exit: float | None = None
    repeat: float = 0.0


class GraphView(Struct, omit_defaults=True):
    """The graph. unlabelled: how many clips wait for a label. total: how many actions there are, of which
    these are some.
    """

    project: str
    clips: int
    unlabelled: int
    stances: list[StanceRow]
    total: int
    actions: list[ActionView]


def _show_graph(work: ToolWork, given: ShowGraph) -> ToolOutcome:
    """Return stances and actions with their settings."""
    project = work.project
    stance = find_named_stance(project, given.stance, given.layer).id if given.stance is not None else None
    layers = LAYERS if given.layer is None else (given.layer,)
    stances = [
        StanceRow(
            s.id,
            s.name,
            layer,
            {kind: len(found) for kind in _KINDS if (found := graph.of(s.id, kind))},
            graph.start == s.id,
        )
        for layer in layers
        for graph in (project.graphs[layer],)
        for s in graph.stances.values()
        if stance in (None, s.id)
    ]
    actions = [
        action
        for layer in layers
        for action in project.graphs[layer].actions.values()
        if stance in (None, action.stance) and given.kind in (None, action.kind)
    ]
    some = actions[given.first : given.first + given.count]
    rows = [_make_action_row(project, action) for action in some]
    waiting = len(list_waiting_clips(project))
    return ToolOutcome(GraphView(project.name, len(project.clips), waiting, stances, len(actions), rows))


_KINDS: tuple[Kind, ...] = ("stance", "gesture", "fidget", "transition")


def _make_action_row(project: Project, action: Action) -> ActionView:
    """Return an action as it is shown."""
    entry, timing = project.clips.get(action.clip), action.timing
    return ActionView(
        action.id,
        action.name,
        action.kind,
        action.layer,
        name_stance(project, action.stance),
        entry.name if entry is not None else "",
        round(entry.duration, 3) if entry is not None else 0.0,
        timing.start,
        timing.end,
        timing.blend_in,
        timing.blend_out,
        name_stance(project, action.end_stance),
        action.limb,
        action.tags,
        action.likelihood,
        action.cooldown,
        timing.loop,
        timing.stroke,
        timing.earliest_exit,
        timing.repeat,
    )


TOOLS = (
    AuthorTool(
        "list_clips",
        "List the clips with what their motion measures, what they are used for and, on request, a picture "
        "of each.",
        ListClips,
        ClipsReport,
        _list_clips,
        long=True,
    ),
    AuthorTool(
        "show_graph",
        "Show the stances and actions with their timing, tags and likelihoods.",
        ShowGraph,
        GraphView,
        _show_graph,
    ),
)
