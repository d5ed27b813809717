"""Compute how far the arms of a plan have moved their mass away from its stance at a time.

The body reacts with a delay. So it does not follow the arms at one moment, but a cubic B-spline through their
places at four earlier fixed times. This is smooth, and depends only on plan and time.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import floor

from metagraph.graph.model import Action, Project
from metagraph.playback.plan import Cue, LayerPlan, Rest
from metagraph.playback.posing.cue_times import cue_seconds, cue_weight, ease, loop_spot, seam_left

STEP = 0.08  # seconds between the sampled times; the answer comes two of them late
OFFSET = 0.0111  # seconds by which they are shifted from whole steps, where cues begin and end
KNOTS = 4
RATE = 10.0  # rows of a track in a second of its clip
UNIT = 1e-5  # metres, or radians, of 1 in a row
NUMBERS = 8  # in a row


@dataclass(frozen=True, slots=True)
class ArmTrack:
    """How the arms of a clip move their mass.

    `clip` is its id. `rows` has a row for each tenth of a second, relative to the base pose: how far the left
    arm shifts the centre of mass of the whole body to the left, up and ahead, the same for the right arm, and
    how far each collar bone lags behind its arm; in units of `UNIT`.
    """

    clip: str
    rows: Sequence[Sequence[float]]


def knot_before(time: float) -> int:
    """Return the number of the last sampled time for a pose at `time`."""
    return floor((time - OFFSET) / STEP)


def knot_time(number: int) -> float:
    """Return the time of a sample, in seconds."""
    return number * STEP + OFFSET


def arm_sway(
    project: Project,
    tracks: Mapping[str, ArmTrack],
    hands: Sequence[str],
    arms: LayerPlan,
    cue: Cue | None,
    place: int,
    body: LayerPlan,
    body_cue: Cue | None,
    body_place: int,
    time: float,
) -> list[float]:
    """Return how far the arms are from their stance at a time, as a row of a track, in metres and radians.

    `tracks` are by action. `hands` names the joints of the hands. `cue` is that of the arms' layer, if it has
    motion, and `place` the index of the rest in force, -1 for none; `body_cue` and `body_place` are the same
    for the body's layer. A cue whose clip the body's layer also shows moves the hips itself and does not
    count.
    """
    out = [0.0 for n in range(NUMBERS)]
    if cue is None:
        return out
    track = tracks.get(cue.action.id)
    if track is None or len(track.rows) == 0:
        return out
    weight = cue_weight(cue, time)
    share = cue.extent * (1.0 - _shown(tracks, body, body_cue, body_place, track.clip, time))
    if weight <= 0.0 or share <= 0.0:
        return out
    row = _row(track, cue_seconds(cue, time))
    rest = _stance(project, tracks, arms, place, time)
    entering = time < cue.start + cue.blend_in
    if cue.repeats:
        back = seam_left(cue, time)
        ends, begins = _row(track, cue.cycle_to), _row(track, cue.cycle_from)
        row = [row[n] + back * (ends[n] - begins[n]) for n in range(NUMBERS)]
        row = [rest[n] + weight * (row[n] - rest[n]) for n in range(NUMBERS)]
    elif entering or time >= cue.end - cue.blend_out:
        edge = _row(track, cue.entry if entering else cue_seconds(cue, cue.end))
        row = [row[n] + (1.0 - weight) * (rest[n] - edge[n]) for n in range(NUMBERS)]
    left = share * UNIT if _moves(cue.action, "left", hands[0]) else 0.0
    right = share * UNIT if _moves(cue.action, "right", hands[1]) else 0.0
    for n in range(NUMBERS):
        out[n] = (row[n] - rest[n]) * (left if n < 3 or n == 6 else right)
    return out


def driven(sways: Sequence[Sequence[float]], time: float) -> list[float]:
    """Return the eight numbers that move the body at a time, and their change per second. `sways` has the
    rows of the last `KNOTS` times before it.
    """
    u = (time - OFFSET) / STEP
    u = u - floor(u)
    back = 1.0 - u
    weights = [
        back * back * back / 6.0,
        (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0,
        (3.0 * u + 3.0 * u * u - 3.0 * u * u * u + 1.0) / 6.0,
        u * u * u / 6.0,
    ]
    slopes = [
        -back * back / 2.0,
        (3.0 * u * u - 4.0 * u) / 2.0,
        (1.0 + 2.0 * u - 3.0 * u * u) / 2.0,
        u * u / 2.0,
    ]
    out = [0.0 for n in range(2 * NUMBERS)]
    for n in range(NUMBERS):
        for k in range(KNOTS):
            out[n] += weights[k] * sways[k][n]
            out[NUMBERS + n] += slopes[k] * sways[k][n] / STEP
    return out


def _moves(action: Action, side: str, hand: str) -> bool:
    """Return whether an action moves an arm, instead of leaving it in the stance."""
    if action.limb not in ("both", side):
        return False
    return len(action.joints) == 0 or hand in action.joints


def _shown(
    tracks: Mapping[str, ArmTrack], plan: LayerPlan, cue: Cue | None, place: int, clip: str, time: float
) -> float:
    """Return how much a layer shows of a clip, 0..1."""
    left = 1.0
    out = 0.0
    if cue is not None:
        weight = cue_weight(cue, time)
        left = 1.0 - weight
        if _is_of(tracks, cue.action, clip):
            out += weight
    if place >= 0:
        rest = plan.rests[place]
        over = 1.0
        if place > 0 and rest.fade_start + rest.fade > time:
            over = ease((time - rest.fade_start) / rest.fade)
            if _is_of(tracks, plan.rests[place - 1].action, clip):
                out += left * (1.0 - over)
        if _is_of(tracks, rest.action, clip):
            out += left * over
    return min(1.0, out)


def _is_of(tracks: Mapping[str, ArmTrack], action: Action, clip: str) -> bool:
    track = tracks.get(action.id)
    return track is not None and track.clip == clip


def _stance(
    project: Project, tracks: Mapping[str, ArmTrack], plan: LayerPlan, place: int, time: float
) -> list[float]:
    """Return the row of the stance under the cues."""
    if place < 0:
        return [0.0 for n in range(NUMBERS)]
    rest = plan.rests[place]
    row = _loop(project, tracks, rest, time)
    if place > 0 and rest.fade_start + rest.fade > time:
        over = ease((time - rest.fade_start) / rest.fade)
        before = _loop(project, tracks, plan.rests[place - 1], time)
        row = [before[n] + (row[n] - before[n]) * over for n in range(NUMBERS)]
    return row


def _loop(project: Project, tracks: Mapping[str, ArmTrack], rest: Rest, time: float) -> list[float]:
    """Return the row of a loop, with its end blended into its beginning."""
    track = tracks.get(rest.action.id)
    if track is None or len(track.rows) == 0:
        return [0.0 for n in range(NUMBERS)]
    spot = loop_spot(project, rest, time)
    row = _row(track, spot.seconds)
    if spot.over < 1.0:
        old = 1.0 - ease(spot.over)
        before = _row(track, spot.other)
        row = [row[n] + (before[n] - row[n]) * old for n in range(NUMBERS)]
    return row


def _row(track: ArmTrack, seconds: float) -> list[float]:
    """Return a track's row at a second of the clip, interpolated linearly."""
    last = len(track.rows) - 1
    at = min(max(seconds * RATE, 0.0), float(last))
    low = min(floor(at), max(0, last - 1))
    part = at - low
    a = track.rows[low]
    b = track.rows[min(low + 1, last)]
    return [a[n] + (b[n] - a[n]) * part for n in range(NUMBERS)]
