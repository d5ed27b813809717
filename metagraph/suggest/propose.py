"""Propose what clips are, from their names, their motion and existing labels together. `accept` is the edit
that places them.

Stances come first: those of the project, those found in the motion, those in names. A word in names belongs
to the stance in which the clips with that word begin. Then each clip is assigned to a stance.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np

from metagraph.common.wording import phrase
from metagraph.graph.model import KINDS, LAYERS, LIMBS, Action, Kind, Layer, Limb, Project
from metagraph.suggest.accept import AcceptedProposals, accept
from metagraph.suggest.alike import Alike, LabelledExample
from metagraph.suggest.clip_measures import guess_layer, is_cycle, with_tremble
from metagraph.suggest.details import (
    find_rest_moment,
    with_likelihoods,
    with_moved_joints,
    with_rare_lying,
    with_stroke,
    with_timing,
)
from metagraph.suggest.estimate import Belief
from metagraph.suggest.folder_tags import join_tags, read_folder_tags
from metagraph.suggest.left_aside import FAR, MANY, explain_skipping
from metagraph.suggest.motion_guess import MotionGuess, guess
from metagraph.suggest.proposal import (
    Proposal,
    Proposals,
    RestMoment,
    Spare,
    StancePlace,
    name_words,
    simplify_stance_name,
)
from metagraph.suggest.stances.known import (
    SAME,
    Shape,
    discover,
    discover_stances,
    join_surplus_stances,
    list_known_stances,
    measure_distance_from_stance,
    rank_stances,
    settle_stances,
    split_stances,
)
from metagraph.suggest.stances.most_used import assign_most_used
from metagraph.suggest.stances.places import ClipEvidence, StancePlaces
from metagraph.suggest.traits import Traits, measure_all_traits
from metagraph.suggest.vote_fusion import Agreed, combine
from metagraph.suggest.whole_body import (
    CARRIER,
    are_whole_body_recordings,
    is_whole_body_carried,
    with_whole_body,
)
from metagraph.suggest.words.names import NameGuess, Patterns, read_names

__all__ = [
    "SOURCES",
    "AcceptedProposals",
    "Proposal",
    "Proposals",
    "RestMoment",
    "Source",
    "StancePlace",
    "accept",
    "list_examples",
    "measure_motion",
    "propose",
    "simplify_stance_name",
]

Source = Literal["name", "motion", "learned"]
SOURCES: tuple[Source, ...] = ("name", "motion", "learned")
CALLED = 0.9  # confidence of a name that says a gesture itself, not a variation of a stance
AWAY = 0.5  # chance that a clip begins in a stance, below which it begins in none
TAUGHT = 0.5  # confidence of a kind learned from labelled clips, from which on no clip is skipped
TOLD = 0.7  # confidence of a name's stance, below which it does not define stances
LEADS = 0.8  # confidence of the motion that a clip named after a stance goes there
FACE_MOVES = 0.3  # of `Traits.face`, from which on a clip of a face alone is no pose that is held
NAMED = 1.5  # times as far from a stance that a clip may rest which is named after it
LENT = 0.5  # of a clip that a stance plays, below which it only borrows a moment of it


def list_examples(project: Project, traits: Mapping[str, Traits]) -> list[LabelledExample]:
    """Return the examples that a project's labelled clips give."""
    out = []
    for action in project.actions():
        entry = project.clips.get(action.clip)
        if entry is None:
            continue
        labels: dict[str, str] = {"kind": action.kind, "layer": action.layer, "limb": action.limb}
        out.append(LabelledExample(name_words(entry.name), measure_motion(traits.get(action.clip)), labels))
    return out


def measure_motion(traits: Traits | None) -> Any:
    """Return a clip's motion as numbers that are comparable between characters."""
    if traits is None:
        return np.zeros(0)
    rows: list[float] = [
        np.log1p(traits.duration),
        traits.travel,
        traits.symmetry,
        traits.mirrored,
        traits.out,
        traits.near,
        traits.touch,
    ]
    for layer in LAYERS:
        x = traits.layers[layer]
        rows += [np.log1p(x.energy), np.log1p(x.peak), x.extent, x.loop_error, x.rest, float(x.bouts)]
    return np.array(rows, float)


def list_waiting_clips(project: Project) -> list[str]:
    """Return the clips that are not placed yet, including those that only lend a stance a still moment."""
    return [
        clip
        for clip in project.clips
        if all(_lends(project, action) for action in project.uses.get(clip, ()))
    ]


def _lends(project: Project, action: Action) -> bool:
    motion, end = project.clips[action.clip].motion, action.timing.end
    return (
        action.kind == "stance"
        and motion is not None
        and end is not None
        and end - action.timing.start < LENT * motion.duration
    )


def propose(
    project: Project,
    clips: Sequence[str] | None = None,
    patterns: Patterns | None = None,
    examples: Iterable[LabelledExample] = (),
    sources: Collection[Source] = SOURCES,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Proposals:
    """Return proposals for clips; None means those that are not placed yet. `examples` are from earlier
    projects. `sources` are those that may be used.

    Never raises because of a clip's content; a clip of which nothing is known is left out.
    """
    chosen = list_waiting_clips(project) if clips is None else [c for c in clips if c in project.clips]
    seen = measure_all_traits(project, cancelled, progress) if {"motion", "learned"} & set(sources) else {}
    traits = with_tremble(seen)
    # All names together give the stances, also those of placed clips, so that the meaning of a number is not
    # forgotten while a person goes through the proposals.
    told = _read_names(project, patterns) if "name" in sources else {}
    said = {c: told.get(c, NameGuess()) for c in chosen}
    moving = "motion" in sources
    mine = {c: traits[c] for c in chosen if c in traits}
    called = {c: said[c] for c in mine}
    begun = {
        c: name_said.stance.value
        for c, name_said in called.items()
        if name_said.stance is not None and name_said.stance.confidence >= TOLD
    }
    fresh = not any(True for _ in project.actions())
    whole = moving and (is_whole_body_carried(project) or (fresh and are_whole_body_recordings(mine, begun)))
    cycles = {c for c, t in mine.items() if _is_cycle(t, called[c])} if moving else set()
    standing = {c: t for c, t in mine.items() if called[c].other is None}  # nobody stands where fights begin
    still = {c: t for c, t in standing.items() if not (moving and _is_cycle(t, called[c], True))}
    standing = still or standing  # nor in the middle of a wave
    shapes = _shapes(project, traits, standing, whole, called) if moving else {}
    alike = Alike([*list_examples(project, traits), *examples]) if "learned" in sources else Alike([])
    odd = sum(1 for c in chosen if said[c].other is not None)
    heard, others, aside = list[ClipEvidence](), list[ClipEvidence](), dict[str, str]()
    for c in chosen:
        each = ClipEvidence(c, project.clips[c].name, said[c], traits.get(c))
        if whole and each.traits is not None and each.traits.face == 0:
            each.posture = with_whole_body(each.traits).layers[CARRIER]
        if each.traits is not None and moving:
            each.cycle = c in cycles
            on = CARRIER if each.posture else None
            each.motion = guess(each.traits, shapes, on, each.posture, each.cycle)
            in_stance = sum(chance for chance, _ in each.motion.begins)
            away = each.motion.stance is not None and in_stance < AWAY
            if away and not each.cycle and _is_cycle(each.traits, each.said, away):
                each.cycle = True
                each.motion = guess(each.traits, shapes, on, each.posture, True)
        if alike.examples:
            each.learned = alike.guess(name_words(each.name), measure_motion(each.traits))
        each.said = _leading(each.said, each.motion)
        usual, apart = odd >= MANY * len(chosen), shapes if each.posture is None else None
        why = explain_skipping(each.said, each.traits, each.motion, usual, apart)
        layer = _layer_of(each)
        each.layer = layer.belief.value if layer is not None else "arms"
        each.beside = each.motion
        if each.traits is not None and each.motion is not None and each.motion.layer.value != each.layer:
            each.beside = guess(each.traits, shapes, each.layer, each.posture, each.cycle)
        each.away = _away_from(shapes, each)
        taught = each.learned.get("kind")
        if why and (taught is None or taught.confidence < TAUGHT):
            aside[c] = why
            others.append(each)
        else:
            heard.append(each)
    places, out = _placed(project, heard, shapes)
    if going := _going_away(out, traits):
        aside |= going
        others += [each for each in heard if each.clip in going]
        heard = [each for each in heard if each.clip not in going]
        places, out = _placed(project, heard, shapes)
    spare = _spare(out, others, places)
    if moving:
        out = with_timing(project, out, cancelled)
        motions = {each.clip: each for each in heard}
        out = {
            c: with_stroke(project, with_moved_joints(project, p, motions[c].traits), motions[c].beside)
            for c, p in out.items()
        }
    return Proposals(
        with_rare_lying(with_likelihoods(project, out), traits),
        _with_rests(project, places.by_key, out, traits),
        aside,
        whole,
        spare,
    )


def _placed(
    project: Project, heard: Sequence[ClipEvidence], shapes: Mapping[Layer, Sequence[Shape]]
) -> tuple[StancePlaces, dict[str, Proposal]]:
    """Return the stances there are, and what is proposed for each clip."""
    places = StancePlaces(project, heard, shapes)
    out = {each.clip: p for each in heard if (p := _proposal(each, places)) is not None}
    disputed = sum(1 for p in out.values() if p.conflicts) / max(1, len(out))
    out = {clip: replace(p, disputed=disputed) for clip, p in out.items()}
    return places, assign_most_used(out, places.by_key, _astray(heard))


def _away_from(shapes: Mapping[Layer, Sequence[Shape]], each: ClipEvidence) -> float:
    """Return how far a clip that does not rest begins from the nearest stance of its layer, heights; 0 if
    that is not known.
    """
    kind = each.agreed("kind", len(KINDS))
    if each.traits is None or each.beside is None or kind is None or kind.belief.value == "stance":
        return 0.0
    posed = each.posture or each.traits.layers[each.layer]
    return next((away for away, _ in rank_stances(shapes.get(each.layer, ()), posed.names, posed.first)), 0.0)


def _astray(heard: Iterable[ClipEvidence]) -> dict[str, float]:
    """Return how many metres from the nearest stance those clips begin that begin in none."""
    return {x.clip: x.away * x.traits.height for x in heard if x.traits is not None and x.is_astray}


def _going_away(out: Mapping[str, Proposal], traits: Mapping[str, Traits]) -> dict[str, str]:
    """Return why transitions are skipped that travel and end where no other clip plays: the character would
    have to slide back.
    """
    far = {
        c: p
        for c, p in out.items()
        if p.kind.value == "transition" and c in traits and traits[c].travel > FAR
    }
    played = {p.stance.value for c, p in out.items() if p.stance is not None and c not in far}
    return {
        c: phrase(
            "travels {length:.1f} m and ends where no other clip begins",
            length=traits[c].height * traits[c].travel,
        )
        for c, p in far.items()
        if p.end_stance is None or p.end_stance.value not in played
    }


def _read_names(project: Project, patterns: Patterns | None) -> dict[str, NameGuess]:
    """Return what the name of each clip says, and its folders, by clip id."""
    names = read_names([x.name for x in project.clips.values()], patterns)
    folders = read_folder_tags({c: x.path for c, x in project.clips.items()}, patterns)
    return {
        c: replace(found, tags=join_tags(found.tags, folders.get(c)))
        for c, x in project.clips.items()
        if (found := names.get(x.name)) is not None
    }


def _is_cycle(traits: Traits, said: NameGuess, away: bool = False) -> bool:
    """Return whether a clip is one cycle of a gesture, as its name allows: an idle is none, nor a small
    movement that is named after one.
    """
    kind = said.kind.value if said.kind is not None else None
    named = kind == "gesture" and said.kind is not None and said.kind.confidence >= CALLED
    return kind != "stance" and is_cycle(traits, named, away)


def _leading(said: NameGuess, motion: MotionGuess | None) -> NameGuess:
    """Return the name's guess for a clip that is named only after a stance and yet goes from one pose to
    another: the stance is its end, so "Sitting" means sitting down.
    """
    named = said.kind is not None and said.kind.value == "stance" and said.end_stance is None
    if not named or said.stance is None or motion is None:
        return said
    if motion.kind.value != "transition" or motion.kind.confidence < LEADS:
        return said
    why = phrase("{words}, and the motion arrives there from elsewhere", words=said.stance.reason)
    return replace(said, kind=None, stance=None, end_stance=replace(said.stance, reason=why))


def _shapes(
    project: Project,
    traits: Mapping[str, Traits],
    mine: Mapping[str, Traits],
    whole: bool,
    called: Mapping[str, NameGuess],
) -> Mapping[Layer, Sequence[Shape]]:
    """Return the stances of each layer as the project's clips show them, else those found among `mine`,
    divided where names and poses both divide.
    """
    if whole:
        every = {c: with_whole_body(t) if t.face == 0 else t for c, t in traits.items()}
        there = list_known_stances(project, every)
        found = discover_stances({c: t for c, t in mine.items() if t.face > 0})
        found[CARRIER] = discover({c: every[c] for c in mine}, CARRIER, together=True)
    else:
        every = dict(traits)
        there, found = list_known_stances(project, traits), discover_stances(mine)
    for layer, shapes in found.items():
        if shapes:
            moves = [every[c].layers[layer] for c in mine if whole or guess_layer(every[c]).value == layer]
            shapes = join_surplus_stances(shapes, len(moves))
            ends = _ends({c: every[c] for c in mine}, layer, called, whole)
            if len({word for *_, word in ends}) < 2:
                shapes = settle_stances(
                    shapes, [(x.names, pose) for x in moves for pose in (x.first, x.last)]
                )
            found[layer] = split_stances(shapes, ends)
    return {
        layer: (*there.get(layer, ()), *_unknown(there.get(layer, ()), found.get(layer, ())))
        for layer in LAYERS
    }


def _unknown(there: Sequence[Shape], found: Sequence[Shape]) -> list[Shape]:
    """Return the discovered stances that the project does not have yet."""
    return [
        shape
        for shape in found
        if not any(away <= known_.scale for away, known_ in rank_stances(there, shape.names, shape.poses[0]))
    ]


def _ends(
    traits: Mapping[str, Traits], layer: Layer, called: Mapping[str, NameGuess], whole: bool
) -> list[tuple[str, float, Any, str]]:
    """Return the ends of a layer's clips that are named."""
    out = []
    for clip, t in traits.items():
        said, x = called[clip], t.layers[layer]
        if not whole and guess_layer(t).value != layer:
            continue
        kind = said.kind.value if said.kind is not None else None
        if said.stance is not None:
            out.append((clip, 0.0, x.first, said.stance.value))
            if kind in ("gesture", "fidget"):
                out.append((clip, t.duration, x.last, said.stance.value))
        if said.end_stance is not None:
            out.append((clip, t.duration, x.last, said.end_stance.value))
    return out


def _layer_of(each: ClipEvidence) -> Agreed[Layer] | None:
    """Return which layer a clip is for: the carrier's if the whole body was recorded together."""
    if each.posture is not None:
        why = phrase("the whole body was recorded together, so this layer plays all of it")
        return Agreed(Belief(CARRIER, 0.95, why))
    return each.agreed("layer", len(LAYERS))


def _spare(
    proposals: Mapping[str, Proposal], others: Collection[ClipEvidence], places: StancePlaces
) -> dict[str, Spare]:
    """Return what skipped clips would be. They do not define stances."""
    by_key = dict(places.by_key)
    mine = {each.clip: _proposal(each, places, True) for each in others}
    known = {clip: p for clip, p in mine.items() if p is not None}
    found = assign_most_used({**proposals, **known}, by_key, _astray(others))
    out = {}
    for clip in known:
        p = found[clip]
        keys = [b.value for b in (p.stance, p.end_stance) if b is not None]
        out[clip] = Spare(p, {key: by_key[key] for key in keys})
    return out


def _with_rests(
    project: Project,
    places: Mapping[str, StancePlace],
    proposals: Mapping[str, Proposal],
    traits: Mapping[str, Traits],
) -> dict[str, StancePlace]:
    """Return the stances. Those in which no clip of their layer rests get a clip of another layer that rests
    in them, else a moment of a clip that shows them.
    """
    resting = {p.clip: p for p in proposals.values() if p.kind.value == "stance" and p.stance is not None}
    shown = {p.stance.value for p in resting.values() if p.stance is not None}
    out = {}
    for key, place in places.items():
        if not place.there and key not in shown:
            loop = _loop_elsewhere(place, places, resting, traits)
            place = replace(
                place, loop=loop, rest=find_rest_moment(project, place, proposals) if loop is None else None
            )
        out[key] = place
    return out


def _loop_elsewhere(
    place: StancePlace,
    places: Mapping[str, StancePlace],
    resting: Mapping[str, Proposal],
    traits: Mapping[str, Traits],
) -> str | None:
    """Return the clip of another layer that rests in a stance: the one whose pose there is nearest, if it is
    near, else, if nobody knows what the stance looks like, one whose stance has the same name.
    """
    name, found = simplify_stance_name(place.name), list[tuple[float, str]]()
    for clip, p in resting.items():
        assert p.stance is not None
        named = simplify_stance_name(places[p.stance.value].name) == name
        if place.shape is None or clip not in traits:
            found += [(0.0, clip)] if named else []
            continue
        posed = traits[clip].layers[place.layer]
        away = measure_distance_from_stance(place.shape, posed.names, posed.first)
        if away <= SAME[place.layer][1] * (NAMED if named else 1.0):
            found.append((away, clip))
    return min(found)[1] if found else None


def _proposal(each: ClipEvidence, places: StancePlaces, anyway: bool = False) -> Proposal | None:
    """Return what is proposed for a clip; None if neither its kind nor its layer is known, unless
    `anyway`.
    """
    kind, layer = each.agreed("kind", len(KINDS)), _layer_of(each)
    if kind is None and layer is None and not anyway:
        return None
    unsure: Agreed[Any] = Agreed(Belief("gesture", 0.3, phrase("nothing says what it is")))
    kind = kind or unsure
    if kind.belief.value == "stance" and each.traits is not None and each.traits.face > FACE_MOVES:
        kind = Agreed(Belief("gesture", 0.6, phrase("only its face moves, so nothing rests in it")))
    layer = layer or Agreed(Belief(each.layer, 0.34, phrase("nothing says which layer it is for")))
    where: Layer = layer.belief.value
    stance = combine(places.vote(each, "stance", where), places.count(where))
    end = None
    if kind.belief.value == "transition":
        start = stance.belief.value if stance is not None else ""
        ends = [b for b in places.vote(each, "end_stance", where) if b.value != start]
        end = combine(ends, places.count(where))
    limb = each.agreed("limb", len(LIMBS)) if where == "arms" and kind.belief.value != "stance" else None
    both: Belief[Limb] = Belief(
        "both", 0.9, phrase("only arms have sides") if where != "arms" else phrase("nothing names a side")
    )
    found = [x for x in (kind, layer, stance, end) if x is not None]
    return Proposal(
        each.clip,
        kind.belief,
        layer.belief,
        stance.belief if stance is not None else None,
        end.belief if end is not None else None,
        limb.belief if limb is not None else both,
        each.said.tags,
        tuple(x.conflict for x in found if x.conflict),
        said=each.said.kind is not None and each.said.kind.value == kind.belief.value,
        cycle=each.cycle,
        seen=_seen_as(each, kind.belief.value),
    )


def _seen_as(each: ClipEvidence, kind: Kind) -> float | None:
    """Return how likely a clip's motion alone makes it this kind, None if nobody looked at it."""
    if each.beside is None:
        return None
    own = each.beside.kind
    return own.confidence if own.value == kind else 1 - max(own.confidence, 0.5)
