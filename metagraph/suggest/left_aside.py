"""Find clips that are none of the four kinds: walks, turns in place, exercises, fights. They are skipped with
a reason, not forced into what a talking character does.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace

from metagraph.common.wording import phrase
from metagraph.suggest.clip_measures import has_no_measures, is_walk
from metagraph.suggest.estimate import Belief
from metagraph.suggest.motion_guess import MotionGuess
from metagraph.suggest.proposal import Proposals, StancePlace, simplify_stance_name
from metagraph.suggest.stances.known import Stances, rank_likely_stances
from metagraph.suggest.traits import Traits
from metagraph.suggest.words.names import NEVER, NameGuess

# Words with no other meaning; other words may mean a beat in another language, or to another person.
SURELY = NEVER | {"dance", "dancing", "turn in place"}
MANY = 0.2  # of a set's names that say so, from which on it is a game's
POSE = 0.2  # seconds: a shorter clip is a pose and no movement
TAKE, MOVEMENTS = 20.0, 8  # seconds and movements from which on a clip is a recording to be cut up
FAR = 0.5  # heights over the ground: a clip that goes farther and to no other stance goes away
ROUND = 50.0  # degrees that a clip turns round without going to another stance
EXERCISE = 0.14  # heights the hips go up and down while the legs move fast
FAST = 0.25  # heights a second the legs move
_NUMBER = re.compile(r"\d+(?:\.\d+)?")
PASSES = 0.8  # probability that a clip passes between two stances, from which on that explains its movement


def _talks(traits: Traits | None, motion: MotionGuess | None) -> bool:
    """Return whether a clip moves as in conversation: from a stance and back, in place."""
    if traits is None or motion is None or not motion.begins or not motion.ends:
        return False
    (begins, one), (ends, other) = motion.begins[0], motion.ends[0]
    stays = one is other and min(begins, ends) > 0.5
    return stays and traits.travel < FAR and traits.turned < ROUND and not is_walk(traits)


def _shared(traits: Traits, motion: MotionGuess | None, shapes: Stances | None) -> bool:
    """Return whether other clips begin or end in a pose, so that it may be a stance; in each layer that has
    such poses, if the layers were recorded separately. Without motion this is unknown, and True.
    """
    if motion is None:
        return True
    if not has_no_measures(traits) or traits.face > 0:
        return False
    told = [motion.begins]
    if shapes is not None:
        told = [
            rank_likely_stances(some, x.names, x.first)
            for layer, x in traits.layers.items()
            if x.names and (some := [s for s in shapes.get(layer, ()) if s.id or len(s.members) > 1])
        ]
    firsts = [next(iter(some), (0.0, None)) for some in told]
    return bool(firsts) and all(
        shape is not None and chance > 0.5 and (shape.id != "" or len(shape.members) > 1)
        for chance, shape in firsts
    )


def explain_skipping(
    said: NameGuess,
    traits: Traits | None,
    motion: MotionGuess | None,
    usual: bool = True,
    shapes: Stances | None = None,
) -> str:
    """Return why a clip is none of the four kinds, "" if it may be one. `usual` says whether many names of
    the set mean things that no one does while talking, as in a game. `shapes` are the stances, if each layer
    was recorded on its own.
    """
    if traits is not None and traits.duration < POSE and not _shared(traits, motion, shapes):
        if traits.frames == 1:
            return phrase("is a single frame: a pose in which no other clip begins or ends, not a movement")
        return phrase(
            "is only {seconds:.2f} s long: a pose in which no other clip begins or ends, not a movement",
            seconds=traits.duration,
        )
    if said.kind is not None:  # a name may call an exercise a pose: "squat"
        return _explain_exercise(traits, motion, 0.0) if said.kind.value == "stance" else ""
    if said.other is not None and (usual or said.other.value in SURELY or not _talks(traits, motion)):
        return said.other.reason
    if traits is None or motion is None or motion.chances is None:
        return ""
    if traits.duration > TAKE and traits.layers["arms"].bouts >= MOVEMENTS:
        return phrase(
            "is a recording of {seconds:.0f} s with {count:,} movements of the arms, to be cut into clips "
            "(Motion graph of takes)",
            seconds=traits.duration,
            count=traits.layers["arms"].bouts,
        )
    if is_walk(traits):
        return phrase(
            "walks or runs: its feet pass each other by {stride:.0f} cm, and its end flows into its start",
            stride=100 * traits.height * traits.stride,
        )
    begins, ends = motion.begins[:1], motion.ends[:1]
    if begins and ends and begins[0][1] is not ends[0][1] and min(begins[0][0], ends[0][0]) > PASSES:
        return ""
    if traits.travel > FAR:
        return phrase(
            "travels {length:.1f} m and ends in no other stance", length=traits.height * traits.travel
        )
    if traits.turned > ROUND:
        return phrase("turns by {degrees:.0f} degrees and ends in no other stance", degrees=traits.turned)
    return _explain_exercise(traits, motion, FAST)


def _explain_exercise(traits: Traits | None, motion: MotionGuess | None, fast: float) -> str:
    """Return that a clip goes up and down and comes back to its stance, with legs faster than so many heights
    a second; "" if it does not.
    """
    if traits is None or motion is None or not motion.begins or not motion.ends:
        return ""
    if motion.begins[0][1] is not motion.ends[0][1]:
        return ""
    if traits.rise <= EXERCISE or traits.energy["legs"] <= fast:
        return ""
    return phrase(
        "moves up and down by {length:.0f} cm: an exercise", length=100 * traits.height * traits.rise
    )


def take_up_skipped(found: Proposals, clip: str) -> Proposals:
    """Return the proposals with one skipped clip among them. Its stances are those that have the same names
    now.
    """
    spare = found.spare[clip]
    places: dict[str, StancePlace] = dict(found.places)

    def moved(belief: Belief[str] | None) -> Belief[str] | None:
        if belief is None:
            return None
        old = spare.places[belief.value]
        same = [
            k
            for k, x in places.items()
            if (x.layer, simplify_stance_name(x.name)) == (old.layer, simplify_stance_name(old.name))
        ]
        key = (
            belief.value
            if belief.value in same
            else next(iter(same), f"new {old.layer} {simplify_stance_name(old.name)}")
        )
        places.setdefault(key, replace(old, key=key, there=False))
        return replace(belief, value=key)

    p = spare.proposal
    p = replace(p, stance=moved(p.stance), end_stance=moved(p.end_stance))
    return replace(
        found,
        proposals={**found.proposals, clip: p},
        places=places,
        aside={c: why for c, why in found.aside.items() if c != clip},
        spare={c: x for c, x in found.spare.items() if c != clip},
    )


def group_reasons(aside: Mapping[str, str]) -> list[tuple[str, list[str]]]:
    """Return reasons in words with their clips, the most frequent first. Reasons that differ only in numbers
    are one, with the least and the greatest number.
    """
    groups: dict[str, list[str]] = {}
    for clip, why in aside.items():
        groups.setdefault(_NUMBER.sub("#", why), []).append(clip)
    out = []
    for clips in groups.values():
        found = zip(*(_NUMBER.findall(aside[c]) for c in clips), strict=True)
        ranges = iter([(min(x, key=float), max(x, key=float)) for x in found])

        def spoken(_: re.Match[str], ranges: Iterator[tuple[str, str]] = ranges) -> str:
            least, most = next(ranges)
            return least if least == most else f"{least} to {most}"

        out.append((_NUMBER.sub(spoken, aside[clips[0]]), clips))
    return sorted(out, key=lambda x: -len(x[1]))
