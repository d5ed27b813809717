"""Accept proposals: the edit that places clips and makes the stances they need."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from typing import Any

from metagraph.common.wording import phrase
from metagraph.errors import describe_error
from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import LAYERS, Kind, Layer, Project
from metagraph.playback.timing.phases import find_phases
from metagraph.suggest.flags import is_unlikely
from metagraph.suggest.gather import gather_clips
from metagraph.suggest.jumps.cut_swings import begin_at_turns
from metagraph.suggest.jumps.soft_blends import soften_blends
from metagraph.suggest.proposal import Proposal, Proposals, RestMoment, StancePlace, simplify_stance_name
from metagraph.suggest.whole_body import CARRIER


@dataclass(frozen=True)
class AcceptedProposals:
    """The project with proposals accepted.

    `placed` has the ids of placed clips. `left` says for each other clip why it was not placed. `held` has
    the stances that are held in a moment of a clip because no clip rests in them.
    """

    project: Project
    placed: tuple[str, ...]
    left: Mapping[str, str]
    held: Mapping[str, RestMoment] = field(default_factory=dict)


def accept(
    project: Project, found: Proposals, above: float = 0.0, clips: Collection[str] | None = None
) -> AcceptedProposals:
    """Return the project with all proposals placed that have at least the confidence `above`, of some clips
    or all. Stances are made of the clips that rest in them, else held in a still moment of another clip.
    Clips of a stance that nothing shows are left out, with the reason; so are, where `clips` does not name
    them, those whose stance is unlikely.
    """
    wanted = [
        p for p in found.proposals.values() if (clips is None or p.clip in clips) and p.clip in project.clips
    ]
    left: dict[str, str] = {
        p.clip: phrase("only {sure:.0f} % certain", sure=100 * p.confidence)
        for p in wanted
        if p.confidence < above
    }
    if clips is None:
        left |= {p.clip: _why_unlikely(p) for p in wanted if is_unlikely(p) and p.clip not in left}
    wanted = [p for p in wanted if p.clip not in left]
    keys = {
        key: key for key, place in found.places.items() if place.there and project.stance(key) is not None
    }
    loops = {
        simplify_stance_name(s.name): g.of(i, "stance")[0].clip
        for g in project.graphs.values()
        for i, s in g.stances.items()
        if g.of(i, "stance")
    }
    loops |= {
        simplify_stance_name(found.places[p.stance.value].name): p.clip
        for p in wanted
        if p.kind.value == "stance" and p.stance is not None
    }
    before, placed, held = project, list[str](), dict[str, RestMoment]()
    if found.whole and wanted:
        project = edits.set_weight(project, CARRIER, "legs", 1.0)
    for p in sorted(wanted, key=lambda p: (p.kind.value != "stance", -p.confidence)):
        try:
            project = _place(project, p, found.places, keys, loops, held)
            placed.append(p.clip)
        except EditError as error:
            left[p.clip] = describe_error(error)
    known = {action.id for action in before.actions()}
    used = {action.clip for action in before.actions()}
    project = begin_at_turns(_begun(before, project), known)
    project = soften_blends(gather_clips(project, [clip for clip in placed if clip not in used]), known)
    return AcceptedProposals(project, tuple(placed), left, held)


def _why_unlikely(p: Proposal) -> str:
    """Return why nobody but a person can say where a clip belongs."""
    ends = [b for b in (p.stance, p.end_stance if p.kind.value == "transition" else None) if b is not None]
    if not ends:
        return phrase("nothing says which stance it belongs to")
    least = min(ends, key=lambda b: b.confidence)
    return phrase("no stance is likely: {reason}", reason=least.reason)


def _begun(before: Project, project: Project) -> Project:
    """Return the project with layers that had no stance beginning in their most used one and, if no base pose
    was chosen, with that of the arms' or else the body's stance, because offsets are smallest relative to
    where a character usually is.
    """
    for layer in LAYERS:
        graph = project.graphs[layer]
        if graph.stances and not before.graphs[layer].stances:
            used = Counter(a.stance for a in graph.actions.values())
            project = edits.set_start_stance(project, max(graph.stances, key=lambda s: used[s]))
    if before.base.clip is None:
        starts = [
            (g, g.start)
            for layer in ("arms", "body", "head")
            if (g := project.graphs[layer]).start is not None
        ]
        loops = [loop for graph, start in starts for loop in graph.of(str(start), "stance")]
        if loops:
            entry = project.clips[loops[0].clip]
            frame = min(round(loops[0].timing.start * entry.fps), max(0, entry.frames - 1))
            project = edits.set_base(project, entry.id, frame)
    return project


def _place(
    project: Project,
    p: Proposal,
    places: Mapping[str, StancePlace],
    keys: dict[str, str],
    loops: Mapping[str, str],
    held: dict[str, RestMoment],
) -> Project:
    """Place one clip. `keys` maps places to the stance ids that exist by now. `loops` maps a stance's name to
    a clip that rests in it, on any layer, because clips of the whole body rest on all. `held` gets the
    stances that are held in a moment of a clip. Raises EditError.
    """
    if p.stance is None:
        raise EditError(phrase("nothing says which stance it belongs to"))
    layer: Layer = p.layer.value
    kind: Kind = p.kind.value
    if kind == "transition" and p.end_stance is None:
        raise EditError(phrase("nothing says where it ends"))
    for belief in (p.stance, p.end_stance if kind == "transition" else None):
        if belief is None or belief.value in keys or (belief is p.stance and kind == "stance"):
            continue
        place = places[belief.value]
        rest = place.rest if place.rest is not None and place.rest.clip in project.clips else None
        loop = place.loop if place.loop in project.clips else None
        if loop is None and place.shape is None:
            loop = loops.get(simplify_stance_name(place.name))
        moment = rest if loop is None else None
        if loop is None:
            loop = rest.clip if rest is not None else loops.get(simplify_stance_name(place.name))
        if loop is None:
            raise EditError(
                phrase(
                    "no resting clip shows its stance, '{name}'"
                    if belief is p.stance
                    else "no resting clip shows the stance it ends in, '{name}'",
                    name=place.name,
                )
            )
        project = edits.add_stance(project, layer, place.name, [loop])
        made = list(project.graphs[layer].stances)[-1]
        keys[place.key] = made
        if moment is not None:
            held[made] = moment
            still = {
                "start": moment.start,
                "end": moment.end,
                "loop": True,
                "blend_in": (moment.end - moment.start) / 3,
            }
            project = edits.update_actions(project, [list(project.graphs[layer].actions)[-1]], timing=still)
    if p.stance.value not in keys:
        project = edits.add_stance(project, layer, places[p.stance.value].name, [p.clip])
        keys[p.stance.value] = list(project.graphs[layer].stances)[-1]
    else:
        end = keys[p.end_stance.value] if kind == "transition" and p.end_stance is not None else None
        project = edits.place_clips(project, [p.clip], layer, kind, keys[p.stance.value], end)
    action = list(project.graphs[layer].actions.values())[-1]
    changes: dict[str, Any] = {
        "limb": p.limb.value,
        "tags": p.tags.value if p.tags is not None else action.tags,
    }
    for name, field_of in (("joints", "mask"), ("likelihood", "likelihood")):
        if (belief := p.details.get(field_of)) is not None:
            changes[name] = belief.value
    timing = {key: value for key, value in p.timing.items() if key != "stroke" or kind == "gesture"}
    if timing:
        changes["timing"] = timing
    project = edits.update_actions(project, [action.id], **changes)
    if kind == "gesture" and "stroke" not in timing and (after := project.action(action.id)) is not None:
        project = edits.update_actions(
            project, [action.id], timing={"stroke": round(find_phases(project, after).stroke, 3)}
        )
    return project
