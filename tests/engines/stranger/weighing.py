"""How a body answers its arms, written from docs/reference, "The arms' weight" and "Contacts and the guard",
alone; each function names the bold words it follows.
"""

from math import floor, sqrt
from typing import Any

import numpy as np

from tests.engines.stranger.posing import (
    Pose,
    cue_second,
    cue_weight,
    ease,
    loop_seconds,
    playing,
    resting,
    seam_left,
)
from tests.engines.stranger.reading import Character
from tests.engines.stranger.rotating import Numbers, about, inverse, times, turned, unit

NONE = np.zeros(8)


def row(character: Character, action: dict[str, Any], second: float) -> Numbers:
    """ "Rows"."""
    clip = next(c for c in character.data["clips"] if c["id"] == action["clip"])
    rows = clip.get("arms", [])
    if not rows:
        return NONE
    at = min(max(10.0 * second, 0.0), len(rows) - 1.0)
    low = int(at)
    a, b = np.array(rows[low], float), np.array(rows[min(low + 1, len(rows) - 1)], float)
    return np.asarray(a + (at - low) * (b - a))


def stance(character: Character, rests: list[list[Any]], t: float) -> Numbers:
    """ "What the arms do at a moment": the stance under a cue."""

    def loop(rest: list[Any]) -> Numbers:
        action = character.actions[rest[1]]
        second, other, share = loop_seconds(action, t - rest[2])
        shown = row(character, action, second)
        return shown + share * (row(character, action, other) - shown) if share > 0.0 else shown

    current = resting(rests, t)
    shown = loop(rests[current])
    if current > 0 and t < rests[current][3] + rests[current][4]:
        before = loop(rests[current - 1])
        shown = before + ease((t - rests[current][3]) / rests[current][4]) * (shown - before)
    return shown


def same(character: Character, plan: dict[str, Any], clip: str, t: float) -> float:
    """ "What the arms do at a moment": how much the body's layer shows of a clip."""
    out, left = 0.0, 1.0
    cue, rests = playing(plan, t), plan["rests"]

    def of(action: str) -> bool:
        return bool(character.actions[action]["clip"] == clip)

    if cue is not None:
        left = 1.0 - cue_weight(cue, t)
        out += (1.0 - left) * of(cue["action"])
    if rests:
        current = resting(rests, t)
        _, action, _, fade_start, fade = rests[current]
        over = ease((t - fade_start) / fade) if current > 0 and t < fade_start + fade else 1.0
        out += left * over * of(action)
        if over < 1.0:
            out += left * (1.0 - over) * of(rests[current - 1][1])
    return min(out, 1.0)


def moment(character: Character, layers: dict[str, Any], hands: list[str], t: float) -> Numbers:
    """ "What the arms do at a moment"."""
    plan = layers["arms"]
    cue = playing(plan, t)
    if cue is None:
        return NONE
    action, w = character.actions[cue["action"]], cue_weight(cue, t)
    clip = next(c for c in character.data["clips"] if c["id"] == action["clip"])
    if not clip.get("arms") or w <= 0.0:
        return NONE
    r = stance(character, plan["rests"], t) if plan["rests"] else NONE
    out = row(character, action, cue_second(cue, t)) - r
    entering = t < cue["start"] + cue["blend_in"]
    if "cycle_to" in cue:
        ends = [row(character, action, cue[name]) for name in ("cycle_to", "cycle_from")]
        out = w * (out + seam_left(cue, t) * (ends[0] - ends[1]))
    elif entering or t >= cue["end"] - cue["blend_out"]:
        edge = cue["entry"] if entering else cue_second(cue, cue["end"])
        out = out + (1.0 - w) * (r - row(character, action, edge))
    moves = [
        action["limb"] in ("both", side) and (not action["joints"] or hand in action["joints"])
        for side, hand in zip(("left", "right"), hands, strict=True)
    ]
    mine = np.array([moves[0]] * 3 + [moves[1]] * 3 + moves, float)
    return (
        out
        * mine
        * 0.00001
        * cue.get("extent", 1.0)
        * (1.0 - same(character, layers["body"], action["clip"], t))
    )


def late(character: Character, layers: dict[str, Any], hands: list[str], t: float) -> tuple[Numbers, Numbers]:
    """ "Late and smooth"."""
    k = floor((t - 0.0111) / 0.08)
    u = (t - 0.0111) / 0.08 - k
    n = [moment(character, layers, hands, 0.08 * (k - 3 + i) + 0.0111) for i in range(4)]
    d = (
        (1 - u) ** 3 * n[0]
        + (3 * u**3 - 6 * u**2 + 4) * n[1]
        + (1 + 3 * u + 3 * u**2 - 3 * u**3) * n[2]
        + u**3 * n[3]
    ) / 6
    slope = -((1 - u) ** 2) * n[0] + (3 * u**2 - 4 * u) * n[1] + (1 + 2 * u - 3 * u**2) * n[2] + u**2 * n[3]
    return d, slope / 2 / 0.08


def soft(x: float, a: float) -> float:
    """ "Hips"."""
    return x / sqrt(1 + (x / a) ** 2)


def between(a: Numbers, b: Numbers) -> Numbers:
    """The shortest turn from one direction to another."""
    return unit(np.array([*np.cross(a, b), 1.0 + a @ b]))


def answered(character: Character, layers: dict[str, Any], made: Pose, t: float) -> Pose:
    """ "The arms' weight"."""
    rig, dials = character.data.get("weight_rig"), character.data.get("life", {})
    calm = 1.0 - dials.get("stillness", 0.0)
    if rig is None or not dials.get("on", True) or calm <= 0.0:
        return made
    d, slope = late(character, layers, rig["hands"], t)
    f = dials.get("follow_through", 1.0) * calm * rig["strength"]
    lift = dials.get("shoulder_lift", 1.0) * calm * rig["strength"]
    if not (d.any() or slope.any()):
        return made
    joints = rig["joints"]
    rotations, translations = np.array(made[0]), np.array(made[1])
    for collar in rig["collars"]:
        q = about(np.array(collar["axis"]) * lift * d[6 + collar["side"]])
        joint, upper = joints[collar["place"]], joints[collar["upper"]]
        rotations[joint] = times(rotations[joint], q)
        rotations[upper] = times(inverse(q), rotations[upper])
    legs = [[joints[p] for p in leg] for leg in rig["legs"]]

    def far(places: Numbers, a: int, b: int) -> float:
        return float(np.linalg.norm(places[a] - places[b]))

    worlds, places = worlds_of(character, rotations, translations)
    bones = [far(places, a, b) + far(places, b, c) for a, b, c in legs]
    apart = [far(places, a, c) for a, _, c in legs]
    heights = [float((places[a] - places[c]) @ np.array(rig["up"])) for a, _, c in legs]
    f *= ease((min(n / whole for n, whole in zip(heights, bones, strict=True)) - 0.75) / 0.15)
    if f <= 0.0:
        return rotations, translations
    feet = [(np.array(places[c]), np.array(worlds[c])) for _, _, c in legs]
    m, v, h = d[:3] + d[3:6], slope[:3] + slope[3:6], rig["height"]
    spin = sum(
        ahead * slope[3 * n] - left * slope[3 * n + 2] for n, (left, ahead) in enumerate(rig["levers"])
    )
    x = soft(-1.4 * f * (m[0] + 0.12 * v[0]), 0.02 * h)
    y = soft(-0.05 * f * v[1], 0.01 * h)
    z = soft(-1.4 * f * (m[2] + 0.12 * v[2]), 0.02 * h)
    yaw, roll, pitch = soft(-30 * f * spin / h**2, 0.1), 3 * x / h, -2 * z / h
    first = rig["bends"][0]
    hips = joints[first["place"]]
    above = worlds[character.parents[hips]] if character.parents[hips] >= 0 else np.array([0.0, 0, 0, 1])
    way = x * np.array(first["left"]) + y * np.array(first["up"]) + z * np.array(first["ahead"])
    translations[hips] += turned(inverse(above), turned(worlds[hips], way))
    for bend in rig["bends"]:
        left, up, ahead = (np.array(bend[name]) for name in ("left", "up", "ahead"))
        joint = joints[bend["place"]]
        turn = about(bend["share"] * (pitch * left + yaw * up + roll * ahead))
        rotations[joint] = times(rotations[joint], turn)
    worlds, places = worlds_of(character, rotations, translations)
    s = 0.5 * (np.linalg.norm([x, y, z]) + 0.1 * h * np.linalg.norm([yaw, roll, pitch]))
    reaches = [max(0.995 * whole, n) for whole, n in zip(bones, apart, strict=True)]
    translations[hips] += turned(
        inverse(above), -sunk(places, legs, feet, reaches, np.array(rig["up"]), s) * np.array(rig["up"])
    )
    for leg, foot, knee in zip(legs, feet, rig["knees"], strict=True):
        worlds, places = worlds_of(character, rotations, translations)
        bring(character, rotations, worlds, places, leg, foot, np.array(knee))
    return rotations, translations


def worlds_of(character: Character, rotations: Numbers, translations: Numbers) -> tuple[Numbers, Numbers]:
    """Turns and places in the character's space."""
    worlds, places = np.zeros_like(rotations), np.zeros_like(translations)
    for joint, parent in enumerate(character.parents):
        worlds[joint], places[joint] = rotations[joint], translations[joint]
        if parent >= 0:
            worlds[joint] = times(worlds[parent], rotations[joint])
            places[joint] = places[parent] + turned(worlds[parent], translations[joint])
    return worlds, places


def sunk(
    places: Numbers,
    legs: list[list[int]],
    feet: list[tuple[Numbers, Numbers]],
    reaches: list[float],
    up: Numbers,
    s: float,
) -> float:
    """ "Legs": by how much the hips sink."""
    sinks = [0.0]
    for (a, _, _), (foot, _), reach in zip(legs, feet, reaches, strict=True):
        high = float((places[a] - foot) @ up)
        beside = float((places[a] - foot) @ (places[a] - foot)) - high * high
        if high > 0.0 and beside < reach * reach and s > 0.0:
            over = high - sqrt(reach * reach - beside)
            sinks.append(over if over >= s else 0.0 if over <= -s else (over + s) ** 2 / (4 * s))
    return max(sinks)


def bring(
    character: Character,
    rotations: Numbers,
    worlds: Numbers,
    places: Numbers,
    limb: list[int],
    goal: tuple[Numbers, Numbers],
    spare: Numbers,
) -> None:
    """ "The arm", of "Hands to goals"."""
    upper, lower, hand = limb
    root, elbow, wrist = places[upper], places[lower], places[hand]
    bone, fore, line = elbow - root, wrist - elbow, wrist - root
    u, v, n = (float(np.linalg.norm(one)) for one in (bone, fore, line))
    way = goal[0] - root
    least = min(sqrt(u * u + v * v - 2 * 0.906 * u * v), n)
    distance = min(max(float(np.linalg.norm(way)), least), max(0.995 * (u + v), n))
    before, ahead = line / n, way / np.linalg.norm(way)
    side = bone - (bone @ before) * before
    spare = turned(worlds[upper], spare)
    spare = spare - (spare @ before) * before
    side = side + max(0.0, 0.01 * u - float(np.linalg.norm(side))) * spare
    side = unit(turned(between(before, ahead), side))
    along = (u * u + distance * distance - v * v) / (2 * distance)
    bent = along * ahead + sqrt(max(0.0, u * u - along * along)) * side
    swing = between(bone / u, unit(bent))
    fold = times(between(unit(turned(swing, fore)), unit(distance * ahead - bent)), swing)
    new = {upper: times(swing, worlds[upper]), hand: goal[1]}
    for joint in range(upper + 1, len(character.parents)):
        if joint != hand and joint in below(character, lower):
            new[joint] = times(fold, worlds[joint])
        elif joint != hand and joint in below(character, upper):
            new[joint] = times(swing, worlds[joint])
    for joint in (upper, lower, hand):
        parent = character.parents[joint]
        turn = new.get(parent, worlds[parent]) if parent >= 0 else np.array([0.0, 0, 0, 1])
        rotations[joint] = times(inverse(turn), new[joint])


def below(character: Character, joint: int) -> set[int]:
    """A joint and all below it."""
    out = {joint}
    for n, parent in enumerate(character.parents):
        if parent in out:
            out.add(n)
    return out
