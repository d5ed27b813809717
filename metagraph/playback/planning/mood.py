"""How a mood shows: which actions become likelier, how large and fast they are played, and what it makes of
breath, blinks, gaze, posture and face.

A mood is a point in Russell's circumplex (1980): valence, how pleasant, and arousal, how excited, both -1..1;
with it, an intensity, 0..2; 1 is normal. Neutral (0, 0, 1) changes nothing, to the last digit: every factor
is 1 and every offset is 0.

What is known and followed here: arousal goes with the speed, acceleration and jerk of movements (Pollick et
al. 2001, of arms that knock and drink); elated joy and hot anger are expansive and full of movement, sadness
and boredom neither (Wallbott 1998); the sad walk slowly, with small movements and bowed heads (Roether et al.
2009). Anger and fear lie close together here, at 99 and 116 degrees; people tell them apart by power
(Fontaine et al. 2007). So here, mild unpleasant excitement is anger and strong unpleasant excitement is fear:
the body draws back (Coulson 2004), with the shoulders up and the arms close. Faces follow the prototypes of
FACS (Ekman and Friesen 1978): fear 1+2+4+5+20, anger 4+5+7+23, joy 6+12, sadness 1+4+15. The amounts (the
numbers below) are ours, chosen so that every clip still looks natural.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt

from metagraph.playback.planning.choice import uniform
from metagraph.playback.planning.hashing import Bits

FADE = 1.5  # seconds in which posture and face go from one mood to the next
LEAST_EXTENT = 0.6
MOST_EXTENT = 1.25
LEAST_TEMPO = 0.75
MOST_TEMPO = 1.25
CLOSE = 0.5  # an action that is tagged with a mood no farther away than this was made for it
PLEASANT = "positive"  # tags
UNPLEASANT = "negative"
ANGRY_FROM = 0.02  # unpleasantness from which an excited mood is angry
ANGRY_WIDE = 0.1  # and by how much more it is altogether
FEAR_FROM = 0.15  # the same of fear
FEAR_WIDE = 0.18
HELD = "contact"  # tag of actions that touch something: smaller or larger they would miss it

# Named moods: valence, arousal. Directions are Russell's (1980, table of 28 words, by circular scaling): calm
# 316.2, content 323, happy 7.8, excited 48.6, tense 92.8, angry 99, afraid 116, sad 207.5, bored 242 and
# tired 267.7 degrees, at 0.8 from the middle, which is ours. "warm" is ours.
MOODS: dict[str, tuple[float, float]] = {
    "neutral": (0.0, 0.0),
    "calm": (0.58, -0.55),
    "content": (0.64, -0.48),
    "warm": (0.6, 0.1),
    "happy": (0.79, 0.11),
    "excited": (0.53, 0.6),
    "tense": (-0.04, 0.8),
    "angry": (-0.13, 0.79),
    "afraid": (-0.35, 0.72),
    "sad": (-0.71, -0.37),
    "bored": (-0.38, -0.71),
    "tired": (-0.03, -0.8),
}


@dataclass(frozen=True, slots=True)
class Mood:
    """valence, arousal: -1..1. intensity: 0..2, 1 is normal."""

    valence: float = 0.0
    arousal: float = 0.0
    intensity: float = 1.0

    @property
    def neutral(self) -> bool:
        """Whether it changes nothing."""
        return self.valence == 0 and self.arousal == 0 and self.intensity == 1

    def like(self, other: Mood) -> bool:
        """Whether it is the same."""
        return (
            self.valence == other.valence
            and self.arousal == other.arousal
            and self.intensity == other.intensity
        )


@dataclass(frozen=True, slots=True)
class MoodFrom:
    """A mood that holds from `start` until `end`; a field that it leaves out stays as it is without it. If
    two hold at once, the one that began later counts. When it is over, the other counts again.
    """

    id: str
    start: float
    valence: float | None = None
    arousal: float | None = None
    intensity: float | None = None
    end: float = float("inf")


@dataclass(frozen=True)
class Moods:
    """The mood over time. base: the mood where no other holds; told: the others, by start."""

    base: Mood = Mood()
    told: Sequence[MoodFrom] = ()


@dataclass(frozen=True, slots=True)
class LifeMood:
    """The factors by which a mood changes the amounts and rates of the life layers, as those of a manner."""

    breathing: float
    breath_rate: float
    aversion_rate: float
    saccade_rate: float
    blinks: float


@dataclass(frozen=True, slots=True)
class Bearing:
    """Posture and face of a mood. droop: -0.4 upright .. 1 bowed. lift: of the shoulders, in breaths. lids:
    how far they hang, 0..1, or are open wide, below 0. smile, frown, brow_down, brow_up, brows: weights of
    the face, 0..1. thrust: how far the body leans forward, 0..1, or draws back, below 0. tension: of
    shoulders, arms and hands, 0..1. closed: how close the arms are kept, 0..1.
    """

    droop: float = 0.0
    lift: float = 0.0
    lids: float = 0.0
    smile: float = 0.0
    frown: float = 0.0
    brow_down: float = 0.0
    brow_up: float = 0.0
    thrust: float = 0.0
    tension: float = 0.0
    brows: float = 0.0
    closed: float = 0.0


def changed(mood: Mood, valence: float | None, arousal: float | None, intensity: float | None) -> Mood:
    """Return a mood with the given fields changed, each limited to its range."""
    return Mood(
        mood.valence if valence is None else within(valence, -1.0, 1.0),
        mood.arousal if arousal is None else within(arousal, -1.0, 1.0),
        mood.intensity if intensity is None else within(intensity, 0.0, 2.0),
    )


def mood_at(moods: Moods, seconds: float) -> Mood:
    """Return the mood that holds at a time; posture and face follow it slowly (`shown`)."""
    out = moods.base
    for told in moods.told:
        if told.start > seconds:
            break
        if seconds < told.end:
            out = changed(out, told.valence, told.arousal, told.intensity)
    return out


def lasting(told: Sequence[MoodFrom], seconds: float) -> list[MoodFrom]:
    """Return the moods that may still show at `seconds` or later: without those that are over and have faded,
    and without those that a mood without an end has replaced.
    """
    out: list[MoodFrom] = []
    for place, one in enumerate(told):
        if one.end <= seconds - FADE:
            continue
        if not any(_replaces(other, one, seconds) for other in told[place + 1 :]):
            out.append(one)
    return out


def _replaces(later: MoodFrom, one: MoodFrom, seconds: float) -> bool:
    return (
        later.end == float("inf")
        and later.start <= seconds - FADE
        and (one.valence is None or later.valence is not None)
        and (one.arousal is None or later.arousal is not None)
        and (one.intensity is None or later.intensity is not None)
    )


def mood_edges(moods: Moods, start: float, end: float) -> list[float]:
    """Return the times from `start` to before `end` at which the mood may change, ascending, `start`
    first.
    """
    edges = [start]
    for told in moods.told:
        for edge in (told.start, told.end):
            if start < edge < end and edge not in edges:
                edges.append(edge)
    return sorted(edges)


def faded(x: float) -> float:
    """Return how much of a change shows after `x` of its fade: 3x^2 - 2x^3 of x clamped to 0..1."""
    y = within(x, 0.0, 1.0)
    return y * y * (3 - 2 * y)


def shown(starts: Sequence[float], values: Sequence[Sequence[float]], seconds: float) -> Mood:
    """Return the mood that shows at a time, while it fades from the previous ones. starts: when each begins,
    ascending; values: valence, arousal, intensity of each. Before the first it is the first.
    """
    place = len(starts) - 1
    while place > 0 and starts[place] > seconds:
        place -= 1
    if place < 0:
        return Mood()
    valence, arousal, intensity, left = 0.0, 0.0, 0.0, 1.0
    while left > 0:
        share = left
        if place > 0:
            share = min(left, faded((seconds - starts[place]) / FADE) - (1 - left))
        valence += share * values[place][0]
        arousal += share * values[place][1]
        intensity += share * values[place][2]
        left -= share
        place -= 1
    return Mood(valence, arousal, intensity)


def within(x: float, low: float, high: float) -> float:
    """Return a number clamped to a range."""
    return min(max(x, low), high)


def leaning(x: float, most: float) -> float:
    """Return 1 at 0, `most` at 1 and 1 / `most` at -1, and beyond as there; smooth and rising."""
    y = within(x, -1.0, 1.0) * (most - 1) / (most + 1)
    return (1 + y) / (1 - y)


def liveliness(mood: Mood) -> float:
    """Return how lively a mood is, -1..1: its arousal, plus some if it is pleasant, less if it is unpleasant
    and not exciting.
    """
    well, ill = max(0.0, mood.valence), max(0.0, -mood.valence)
    calm = 1 - max(0.0, mood.arousal)
    return within(mood.arousal + 0.5 * well - 0.6 * ill * calm, -1.0, 1.0)


def fear(mood: Mood) -> float:
    """Return how afraid a mood is, 0..1."""
    much = min(1.0, 1.25 * max(0.0, mood.arousal))
    return much * faded((-mood.valence - FEAR_FROM) / FEAR_WIDE)


def anger(mood: Mood) -> float:
    """Return how angry a mood is, 0..1."""
    much = min(1.0, 1.25 * max(0.0, mood.arousal))
    return much * faded((-mood.valence - ANGRY_FROM) / ANGRY_WIDE) - fear(mood)


def extent(mood: Mood) -> float:
    """Return how large gestures and fidgets of arms and head are played: a factor of their turns away from
    the stance.
    """
    size = within(liveliness(mood) - 1.5 * fear(mood), -1.0, 1.0)
    by_mood = 1 + 0.25 * size if size > 0 else 1 + 0.4 * size
    dial = mood.intensity - 1
    by_dial = 1 + 0.25 * dial if dial > 0 else 1 + 0.4 * dial
    return within(by_mood * by_dial, LEAST_EXTENT, MOST_EXTENT)


def tempo(mood: Mood) -> float:
    """Return how fast actions are played: a factor of their own speed."""
    return within(1 + 0.25 * liveliness(mood), LEAST_TEMPO, MOST_TEMPO)


def drag(seconds: float, speed: float) -> float:
    """Return how much longer clip seconds take at a speed than at their own speed, exactly 0 at
    that speed.
    """
    return seconds * (1 / speed - 1)


def turn_extent(factor: float, real: float) -> float:
    """Return how far a joint turns away from its stance, a factor, for that of a cue. real: the real part of
    the original rotation, a unit quaternion. Rotations of nearly half a circle, whose short way changes
    sides, stay as they are.
    """
    return 1 + (factor - 1) * faded((abs(real) - 0.1) / 0.4)


def made_for(mood: Mood, tags: Sequence[str]) -> bool:
    """Return whether an action was made for a mood: whether it has the tag of a mood that is near."""
    return any(tag in MOODS and distance(mood, tag) <= CLOSE for tag in tags)


def distance(mood: Mood, name: str) -> float:
    """Return how far a mood is from a named one, 0..2.8."""
    valence, arousal = MOODS[name]
    x = mood.valence - valence
    y = mood.arousal - arousal
    return sqrt(x * x + y * y)


def favour(mood: Mood, tags: Sequence[str], vigour: float) -> float:
    """Return the factor of an action's likelihood. vigour: how energetic it is compared with others of its
    layer and kind, -1..1. The factor is up to 4 for vigour, 4 for a tag of valence and 9 for a tag that names
    a mood, and the inverse if they contradict the mood.
    """
    out = leaning(vigour * within(liveliness(mood) + (mood.intensity - 1), -1.0, 1.0), 4.0)
    if PLEASANT in tags:
        out *= leaning(mood.valence, 4.0)
    if UNPLEASANT in tags:
        out *= leaning(-mood.valence, 4.0)
    strength = min(1.0, sqrt(mood.valence * mood.valence + mood.arousal * mood.arousal) / CLOSE)
    for tag in tags:
        if tag in MOODS:
            out *= leaning(strength * (1 - distance(mood, tag) / CLOSE), 9.0)
    return out


def stirs(mood: Mood, seed: Bits, key: str) -> bool:
    """Return whether something that a model wrote is performed in a mood: less of it in a less lively mood,
    down to 0.6.
    """
    lively = liveliness(mood)
    return lively >= 0 or uniform(seed, key, "mood") < 1 + 0.4 * lively


def life_of(mood: Mood) -> LifeMood:
    """Return how a mood changes the life layers. With arousal, breath is quicker and deeper, and eyes dart
    and blink more. In an unpleasant mood the character looks away more, in a pleasant one less. The amounts
    are ours.
    """
    a, v = mood.arousal, mood.valence
    return LifeMood(
        1 + 0.25 * a,
        1 + 0.4 * a if a > 0 else 1 + 0.25 * a,
        1 - 0.4 * v if v < 0 else 1 - 0.25 * v,
        1 + 0.4 * a,
        1 + 0.4 * a if a > 0 else 1 + 0.25 * a,
    )


def bearing(mood: Mood) -> Bearing:
    """Return posture and face of a mood, stronger with its intensity. The head bows with sadness (Roether et
    al. 2009); shoulders rise, fists close and the body leans forward with arousal that is not joy; fear draws
    back (Coulson 2004); the amounts are ours.
    """
    v, a, i = mood.valence, mood.arousal, mood.intensity
    up, down = max(0.0, a), max(0.0, -a)
    well, ill = max(0.0, v), max(0.0, -v)
    scared, cross = fear(mood), anger(mood)
    return Bearing(
        within(i * (-0.7 * v - 0.5 * a), -0.4, 1.0),
        within(i * (2.0 * up * (1 - well) + 4.5 * scared - 1.5 * down - ill * (1 - up)), -2.0, 6.0),
        within(i * (0.5 * down - 0.5 * scared - 0.15 * cross - 1.1 * up * well), -0.6, 0.5),
        within(i * well * (1.2 + 0.3 * up - 0.6 * down), 0.0, 1.0),
        within(i * (1.4 * ill * (1 - up) * (1 - 0.6 * down) + 0.35 * cross + 0.4 * scared), 0.0, 1.0),
        within(i * (0.5 * up * max(0.0, 0.4 - v) + 0.8 * cross) * (1 - scared), 0.0, 1.0),
        within(i * (2.0 * ill * (1 - up) * (1 - down) + 0.9 * scared), 0.0, 1.0),
        within(i * (0.3 * up * max(0.0, 0.3 - v) + 0.9 * cross - 0.7 * scared), -1.0, 1.0),
        within(i * 1.2 * up * max(0.0, 1.0 - 2.0 * well) * (1 - 0.8 * scared), 0.0, 1.0),
        within(i * (0.6 * scared + 1.6 * up * well), 0.0, 1.0),
        within(i * (0.5 * scared + 0.4 * ill * (1 - up)), 0.0, 1.0),
    )


def shut_in(blink: float, lids: float) -> float:
    """Return how far lids are shut: as far as a blink shuts them or, if they hang farther, as far as they do;
    below 0 where they are open wide.
    """
    return max(blink, lids) if lids > 0 else blink + lids * (1 - blink)
