"""The poses of a plan, written from docs/reference alone; each function names the words it follows."""

from typing import Any

import numpy as np

from tests.engines.stranger.reading import Character, Clip
from tests.engines.stranger.rotating import Numbers, inverse, nlerp, power, times, turned

Pose = tuple[Numbers, Numbers]  # rotations [J, 4], translations [J, 3]; also what a layer adds to the base
STILL = np.array([0.0, 0.0, 0.0, 1.0])


def ease(x: float) -> float:
    """docs/reference, "Blending"."""
    x = min(max(x, 0.0), 1.0)
    return 3.0 * x * x - 2.0 * x * x * x


def mix(a: Pose, b: Pose, share: float) -> Pose:
    """docs/reference, "Composing poses"."""
    return nlerp(a[0], b[0], share), a[1] + share * (b[1] - a[1])


def sampled(clip: Clip, second: float) -> Pose:
    """docs/reference, "Sampling"."""
    last = len(clip.rotations) - 1
    frame = min(max(second * clip.fps, 0.0), last)
    low = int(frame)
    high, share = min(low + 1, last), frame - low
    here = clip.rotations[low], clip.translations[low]
    return mix(here, (clip.rotations[high], clip.translations[high]), share) if share > 0.0 else here


def cue_second(cue: dict[str, Any], t: float) -> float:
    """docs/reference, "Time in a cue"."""
    x, tempo = t - cue["start"], cue.get("tempo", 1.0)
    if "cycle_to" in cue:
        y = cue["entry"] - cue["cycle_from"] + x * tempo
        return float(cue["cycle_from"] + y % (cue["cycle_to"] - cue["cycle_from"]))
    if cue["hold"] <= 0.0:
        return float(cue["entry"] + x * tempo)
    h = min(max(x - (cue["hold_from"] - cue["entry"]) / tempo, 0.0), cue["hold"])
    return float(cue["entry"] + (x - h) * tempo + h * (cue["hold_to"] - cue["hold_from"]) / cue["hold"])


def cue_weight(cue: dict[str, Any], t: float) -> float:
    """docs/reference, "Blending"."""
    rise = ease((t - cue["start"]) / cue["blend_in"]) if cue["blend_in"] > 0.0 else 1.0
    fall = ease((cue["end"] - t) / cue["blend_out"]) if cue["blend_out"] > 0.0 else 1.0
    return rise * fall


def playing(plan: dict[str, Any], t: float) -> dict[str, Any] | None:
    """The cue that shows; docs/reference, "Blending"."""
    return next((cue for cue in plan["cues"] if cue["start"] <= t < cue["end"]), None)


def moves(character: Character, action: dict[str, Any]) -> Any:
    """How far [J] an action moves joints, 0..1; docs/reference, "Joints an action does not move"."""
    other = {"left": "right", "right": "left", "both": None}[action["limb"]]
    weights = action.get("joint_weights", {})
    return np.array(
        [
            weights.get(name, 1.0)
            if not (part == "arms" and side == other) and (not action["joints"] or name in action["joints"])
            else 0.0
            for name, part, side in zip(character.names, character.parts, character.sides, strict=True)
        ]
    )


def offset(character: Character, action: dict[str, Any], second: float) -> Pose:
    """What a clip adds to the base pose; docs/reference, "Composing poses"."""
    rotations, translations = sampled(character.clips[action["clip"]], second)
    return times(inverse(character.rotations), rotations), translations - character.translations


def loop_seconds(action: dict[str, Any], x: float) -> tuple[float, float, float]:
    """The clip second that a loop shows x seconds after its beginning, the one on the other side of its seam
    and the share of that; docs/reference, "Loops".
    """
    start, length = action["start"], action["end"] - action["start"]
    seam = min(action["blend_in"], length / 2.0)
    period = length - seam
    if period <= 0.0:
        return start, start, 0.0
    if seam <= 0.0:
        return start + x % period, start, 0.0
    y = max(x, 0.0)
    p = y % period
    return start + p, start + period + p, 1.0 - ease(p / seam) if y >= period and p < seam else 0.0


def loop(character: Character, action: dict[str, Any], x: float) -> Pose:
    """docs/reference, "Loops"."""
    second, other, share = loop_seconds(action, x)
    shown = offset(character, action, second)
    return mix(shown, offset(character, action, other), share) if share > 0.0 else shown


def resting(rests: list[list[Any]], t: float) -> int:
    """Which rest is the current one; docs/reference, "Stances"."""
    return max((n for n, rest in enumerate(rests) if rest[3] <= t), default=0)


def stance(character: Character, rests: list[list[Any]], t: float) -> Pose:
    """docs/reference, "Stances"."""
    current = resting(rests, t)
    _, action, start, fade_start, fade = rests[current]
    shown = loop(character, character.actions[action], t - start)
    if current > 0 and t < fade_start + fade:
        _, action, start, _, _ = rests[current - 1]
        before = loop(character, character.actions[action], t - start)
        shown = mix(before, shown, ease((t - fade_start) / fade))
    return shown


def layer(character: Character, plan: dict[str, Any], reached: Any, t: float) -> Pose:
    """docs/reference, "Blending". reached: which joints [J] the layer moves."""
    rest, cue = stance(character, plan["rests"], t), playing(plan, t)
    if cue is None:
        return rest
    action = character.actions[cue["action"]]
    d, e = offset(character, action, cue_second(cue, t))
    if "cycle_to" in cue:
        return repeated(character, cue, (d, e), rest, t)
    if t < cue["start"] + cue["blend_in"]:
        edge = cue["entry"]
    elif t >= cue["end"] - cue["blend_out"]:
        edge = cue_second(cue, cue["end"])
    else:
        edge = None
    if edge is not None:
        weight = cue_weight(cue, t)
        since = offset(character, action, edge)
        least = min(1.0, float(np.abs((since[0] * rest[0]).sum(-1))[reached].min(initial=1.0)))
        far = ease((0.966 - least) / (0.966 - 0.866))
        d, e = mix(led((d, e), rest, since, 1.0 - weight), mix(rest, (d, e), weight), far)
    return masked(character, cue, (d, e), rest)


def led(shown: Pose, to: Pose, since: Pose, left: float) -> Pose:
    """docs/reference, "Blending"."""
    still = np.broadcast_to(STILL, shown[0].shape)
    d = times(shown[0], nlerp(still, times(inverse(since[0]), to[0]), left))
    return d, shown[1] + left * (to[1] - since[1])


def seam_left(cue: dict[str, Any], t: float) -> float:
    """docs/reference, "Time in a cue": z, 0 in the first cycle."""
    p = cue["cycle_to"] - cue["cycle_from"]
    y = cue["entry"] - cue["cycle_from"] + (t - cue["start"]) * cue.get("tempo", 1.0)
    return 1.0 - float(ease(y % p / min(0.4, p / 2.0))) if y >= p else 0.0


def repeated(character: Character, cue: dict[str, Any], shown: Pose, rest: Pose, t: float) -> Pose:
    """docs/reference, "Time in a cue" and "Blending"."""
    action = character.actions[cue["action"]]
    if z := seam_left(cue, t):
        ends = [offset(character, action, cue[name]) for name in ("cycle_to", "cycle_from")]
        shown = led(shown, *ends, z)
    if t < cue["start"] + cue["blend_in"] or t >= cue["end"] - cue["blend_out"]:
        shown = mix(rest, shown, cue_weight(cue, t))
    return masked(character, cue, shown, rest)


def masked(character: Character, cue: dict[str, Any], shown: Pose, rest: Pose) -> Pose:
    """docs/reference, "Joints an action does not move"."""
    action = character.actions[cue["action"]]
    d, e = sized(character, shown, rest, cue.get("extent", 1.0))
    moved = moves(character, action)[:, None]
    some = (moved > 0.0) & (moved < 1.0)
    d = np.where(some, nlerp(rest[0], d, moved), d)
    e = np.where(some, rest[1] + moved * (e - rest[1]), e)
    return np.where(moved > 0.0, d, rest[0]), np.where(moved > 0.0, e, rest[1])


def sized(character: Character, shown: Pose, rest: Pose, extent: float) -> Pose:
    """docs/reference, "Moods", how large."""
    takes_part = ("both",) if extent > 1.0 else ("both", "smaller")
    part = np.array([joint.get("scales", "both") in takes_part for joint in character.data["joints"]])
    away = times(inverse(rest[0]), shown[0])
    f = [1.0 + (extent - 1.0) * ease((abs(w) - 0.1) / 0.4) * p for w, p in zip(away[:, 3], part, strict=True)]
    d = times(rest[0], power(away, np.array(f)))
    return np.where(part[:, None], d, shown[0]), rest[1] + (shown[1] - rest[1]) * np.where(
        part[:, None], extent, 1.0
    )


def pose(character: Character, layers: dict[str, Any], t: float) -> Pose:
    """docs/reference, "Composing poses". layers: a plan's, as in the vectors."""
    rotations, translations = character.rotations, character.translations
    for name in character.data["order"]:
        if not layers[name]["rests"]:
            continue
        weights = character.data["layers"][name]["weights"]
        w = np.array([weights.get(part, 0.0) for part in character.parts])  # not listed: not moved
        d, e = layer(character, layers[name], w > 0.0, t)
        rotations = times(rotations, power(d, w))
        translations = translations + w[:, None] * e
    return rotations, translations


def positions(character: Character, rotations: Numbers, translations: Numbers) -> Numbers:
    """Where joints are in the character's space [..., J, 3]; docs/reference, "Composing poses"."""
    worlds, places = np.empty_like(rotations), np.empty_like(translations)
    for joint, parent in enumerate(character.parents):
        q, t = rotations[..., joint, :], translations[..., joint, :]
        if parent >= 0:
            t = places[..., parent, :] + turned(worlds[..., parent, :], t)
            q = times(worlds[..., parent, :], q)
        worlds[..., joint, :], places[..., joint, :] = q, t
    return places


def morphs(character: Character, layers: dict[str, Any], t: float) -> dict[str, float]:
    """docs/reference, "Morph targets"."""
    out: dict[str, float] = {}
    for plan in layers.values():
        if not plan["rests"]:
            continue
        cue = playing(plan, t)
        weight = cue_weight(cue, t) if cue is not None else 0.0
        rest = plan["rests"][resting(plan["rests"], t)]
        action = character.actions[rest[1]]
        second, other, old = loop_seconds(action, t - rest[2])
        shares = [(action, second, (1.0 - weight) * (1.0 - old)), (action, other, (1.0 - weight) * old)]
        if cue is not None:
            shares.append((character.actions[cue["action"]], cue_second(cue, t), weight))
        for action, second, share in shares:
            clip = character.clips[action["clip"]]
            frame = min(max(second * clip.fps, 0.0), len(clip.rotations) - 1)
            for name, values in clip.morphs.items():
                value = float(np.interp(frame, np.arange(len(values)), values))
                out[name] = out.get(name, 0.0) + share * value
    return {name: min(max(value, 0.0), 1.0) for name, value in out.items()}
