"""Where feet stay, written from docs/reference, "Planted feet", alone; each function names the bold words it
follows.
"""

from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from tests.engines.stranger.posing import Pose, cue_second, ease, loop_seconds, playing, resting
from tests.engines.stranger.reading import Character
from tests.engines.stranger.rotating import Numbers, inverse, times, turned, unit
from tests.engines.stranger.weighing import bring, sunk, worlds_of


class Foot(NamedTuple):
    place: Numbers
    turn: Numbers
    stands: float
    lift: float


Feet = tuple[Foot, Foot]


def row(character: Character, action: dict[str, Any], second: float) -> Feet | None:
    """ "Rows"."""
    clip = next(c for c in character.data["clips"] if c["id"] == action["clip"])
    rows = clip.get("feet", [])
    if not rows:
        return None
    at = min(max(10.0 * second, 0.0), len(rows) - 1.0)
    low = int(at)
    a, b = np.array(rows[low], float), np.array(rows[min(low + 1, len(rows) - 1)], float)
    left, right = 0.00001 * (a + (at - low) * (b - a)).reshape(2, 8)
    made = [Foot(v[1:4], unit(v[4:8]), float(v[0]), 0.0) for v in (left, right)]
    return made[0], made[1]


def way(a: Foot, b: Foot) -> float:
    """ "Steps", of A0 and B1."""
    distance = float(np.linalg.norm(b.place - a.place))
    turn = 0.3 * sqrt(max(0.0, 2.0 - 2.0 * abs(float(a.turn @ b.turn))))
    return a.stands * b.stands * (distance + turn)


def step(height: float, seconds: float, *feet: Any) -> Feet | None:
    """ "Steps": A, B, A0, B1, u."""
    a, b, first, last, u = feet
    if any(one is None for one in (a, b, first, last)):
        return None
    ways = [way(first[n], last[n]) for n in (0, 1)]
    p = min(max(ways[0] / sum(ways), 0.15), 0.85) if sum(ways) > 0.0 else 0.5
    shift = last[0].place - first[0].place + last[1].place - first[1].place
    leads = 0 if shift @ (first[0].place - first[1].place) >= -1e-9 else 1
    far, apart = 1.0 - ease((max(ways) / height - 0.25) / 0.1), ease(max(ways) / 0.015)
    shares = 1.0 - apart * (1.0 - p), 1.0 - apart * p
    most = max(ways[n] / (shares[n] * max(seconds, 0.001)) for n in (0, 1))
    far *= 1.0 - ease((most / height - 0.65) / 0.2)
    out = []
    for n, share in enumerate(shares):
        x = min(max((u - (0.0 if n == leads else 1.0 - share)) / share, 0.0), 1.0)
        g, v = ease((x - 0.12) / 0.76), 0.25 * ways[n]
        air = 16.0 * x * x * (1.0 - x) ** 2 * v / (1.0 + v / 0.08)
        other = b[n].turn if a[n].turn @ b[n].turn >= 0.0 else -b[n].turn
        turn = unit((1.0 - g) * a[n].turn + g * other)
        place = a[n].place + g * (b[n].place - a[n].place)
        lift = a[n].lift + g * (b[n].lift - a[n].lift) + air
        out.append(Foot(place, turn, far * a[n].stands * b[n].stands, lift))
    return out[0], out[1]


def loop(character: Character, height: float, rest: list[Any], t: float) -> Feet | None:
    """ "Where feet should be": a loop."""
    action = character.actions[rest[1]]
    second, other, share = loop_seconds(action, t - rest[2])
    here = row(character, action, second)
    if share <= 0.0:
        return here
    start, length = action["start"], action["end"] - action["start"]
    s = min(action["blend_in"], length / 2.0)
    ends = row(character, action, start + length - s), row(character, action, start + s)
    return step(height, s, row(character, action, other), here, *ends, (second - start) / s)


def fades(rests: list[list[Any]], n: int, t: float) -> bool:
    return n > 0 and t < rests[n][3] + rests[n][4]


def stance(character: Character, height: float, rests: list[list[Any]], t: float) -> Feet | None:
    """ "Where feet should be": the stance at T."""
    n = resting(rests, t)
    shown = loop(character, height, rests[n], t)
    if not fades(rests, n, t):
        return shown
    old, (begin, fade) = rests[n - 1], rests[n][3:5]
    ends = loop(character, height, old, begin), loop(character, height, rests[n], begin + fade)
    return step(height, fade, loop(character, height, old, t), shown, *ends, (t - begin) / fade)


def lasting(character: Character, cue: dict[str, Any], into: bool) -> float:
    """ "Where feet should be": I and O."""
    blend, spare = cue["blend_in" if into else "blend_out"], cue["end"] - cue["start"]
    if blend <= 0.0:
        return 0.0
    most = min(0.5, blend + max(0.0, spare - cue["blend_in"] - cue["blend_out"]) / 2.0)
    out = float(blend)
    while out < most:
        after = min(out + 0.1, most)
        at = cue["start"] + after if into else cue["end"] - after
        feet = row(character, character.actions[cue["action"]], cue_second(cue, at))
        if feet is None or min(feet[0].stands, feet[1].stands) < 1.0:
            break
        out = after
    return out


def wanted(character: Character, plan: dict[str, Any], height: float, t: float) -> Feet | None:
    """ "Where feet should be"."""
    rests, cue = plan["rests"], playing(plan, t)
    if not rests:
        return None
    if cue is None:
        n = resting(rests, t)
        seam = loop_seconds(character.actions[rests[n][1]], t - rests[n][2])[2] > 0.0
        return stance(character, height, rests, t) if seam or fades(rests, n, t) else None
    action = character.actions[cue["action"]]
    if action["joints"] or action.get("joint_weights"):
        return None
    came, goes = lasting(character, cue, True), lasting(character, cue, False)
    here = row(character, action, cue_second(cue, t))
    if t < cue["start"] + came:
        before = stance(character, height, rests, min(t, cue["start"] + cue["blend_in"]))
        first = stance(character, height, rests, cue["start"])
        last = row(character, action, cue_second(cue, cue["start"] + came))
        return step(height, came, before, here, first, last, (t - cue["start"]) / came)
    if t >= cue["end"] - goes:
        after = stance(character, height, rests, max(t, cue["end"] - cue["blend_out"]))
        first = row(character, action, cue_second(cue, cue["end"] - goes))
        last = stance(character, height, rests, cue["end"])
        return step(height, goes, here, after, first, last, (t - cue["end"] + goes) / goes)
    return None


def planted(character: Character, layers: dict[str, Any], made: Pose, t: float) -> Pose:
    """ "Legs"."""
    rig, dials = character.data.get("weight_rig"), character.data.get("life", {})
    strength = dials.get("planted_feet", 1.0)
    if rig is None or not dials.get("on", True) or strength <= 0.0:
        return made
    goals = wanted(character, layers[rig.get("feet_layer", "body")], rig["height"], t)
    if goals is None:
        return made
    joints, up = rig["joints"], np.array(rig["up"])
    legs, hips = [[joints[p] for p in leg] for leg in rig["legs"]], joints[rig["bends"][0]["place"]]
    rotations, translations = np.array(made[0]), np.array(made[1])
    worlds, places = worlds_of(character, rotations, translations)
    bones = [
        float(np.linalg.norm(places[a] - places[b]) + np.linalg.norm(places[b] - places[c]))
        for a, b, c in legs
    ]
    upright = min((places[a] - places[c]) @ up / whole for (a, _, c), whole in zip(legs, bones, strict=True))
    strength *= ease((upright - 0.75) / 0.15)
    reaches = [
        max(0.995 * whole, float(np.linalg.norm(places[a] - places[c])))
        for (a, _, c), whole in zip(legs, bones, strict=True)
    ]
    feet = [(np.array(places[c]), np.array(worlds[c])) for _, _, c in legs]
    shift, size, changed = np.zeros(3), 0.0, False
    for n, goal in enumerate(goals):
        k, (place, turn) = strength * goal.stands, feet[n]
        w = goal.place + goal.lift * up - place
        far = float(np.linalg.norm(w))
        if far > 0.0001 and k > 0.0:
            w = w * (k * (far - 0.0001) / far)
            shift = shift + 0.35 * w + 0.1 * k * goal.lift / 0.05 * (feet[1 - n][0] - places[hips])
            place, size, changed = place + w, size + float(np.linalg.norm(w)), True
        r = times(goal.turn, inverse(turn))
        r = r if r[3] >= 0.0 else -r
        a = 2.0 * float(np.linalg.norm(r[:3]))
        if a > 0.001 and k > 0.0:
            share = k * (a - 0.001) / a
            turn, changed = times(unit(share * r + (1.0 - share) * np.array([0.0, 0, 0, 1])), turn), True
        feet[n] = place, turn
    if not changed:
        return made
    shift = shift - (shift @ up) * up
    above = worlds[character.parents[hips]] if character.parents[hips] >= 0 else np.array([0.0, 0, 0, 1])
    translations[hips] += turned(inverse(above), shift)
    _, places = worlds_of(character, rotations, translations)
    s = 0.5 * (size + float(np.linalg.norm(shift)))
    translations[hips] += turned(inverse(above), -sunk(places, legs, feet, reaches, up, s) * up)
    for leg, foot, knee in zip(legs, feet, rig["knees"], strict=True):
        worlds, places = worlds_of(character, rotations, translations)
        bring(character, rotations, worlds, places, leg, foot, np.array(knee))
    return rotations, translations
