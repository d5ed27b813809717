"""Draws and rests of a plan, written from docs/reference alone."""

from math import log
from typing import Any

from tests.engines.stranger.reading import Character


def mixed(x: int) -> int:
    """docs/reference, "Randomness"."""
    x ^= x >> 16
    x = x * 0x85EBCA6B & 0xFFFFFFFF
    x ^= x >> 13
    x = x * 0xC2B2AE35 & 0xFFFFFFFF
    return x ^ x >> 16


def key32(seed: int, *words: str) -> int:
    """docs/reference, "Randomness"."""
    x = 0x811C9DC5 ^ mixed(seed)
    for word in words:
        for byte in word.encode() + b"\0":
            x = (x ^ byte) * 0x01000193 & 0xFFFFFFFF
    return mixed(x)


def uniform(seed: int, *words: str) -> float:
    """docs/reference, "Randomness"."""
    return (key32(seed, *words) + 0.5) / 2**32


def pick(seed: int, key: str, purpose: str, weights: dict[str, float]) -> str:
    """docs/reference, "Randomness"."""
    return min(
        (-log(uniform(seed, key, purpose, ident)) / weight, ident)
        for ident, weight in weights.items()
        if weight > 0.0
    )[1]


def loop_of(character: Character, layer: str, stance: str, seed: int, key: str) -> str | None:
    """docs/reference, "Randomness": the loop of a stance."""
    found = character.data["layers"][layer]["index"].get(stance, {}).get("stance", [])
    weights = {ident: character.actions[ident]["likelihood"] for ident in found}
    return pick(seed, key, "loop", weights) if found else None


def begins_in(character: Character, layer: str, case: dict[str, Any]) -> str | None:
    """The stance a layer begins in; docs/reference, "When a new loop takes over"."""
    graph = character.data["layers"][layer]
    wished = [case["stances"].get(layer), graph["start"], *(stance["id"] for stance in graph["stances"])]
    return next((s for s in wished if graph["index"].get(s, {}).get("stance")), None)


def rests_of(character: Character, layer: str, case: dict[str, Any]) -> list[list[Any]]:
    """The rests under a case's cues; docs/reference, "When a new loop takes over"."""
    cues, seed, end = case["plan"]["layers"][layer]["cues"], case["seed"], case["steps"][-1]["end"]
    longest = character.data["planner"]["loop_fade"]
    begin = begins_in(character, layer, case)
    first = loop_of(character, layer, begin, seed, f"rest/{layer}") if begin is not None else None
    if first is None:
        return []
    placed: list[list[Any]] = [[begin, first, 0.0, 0.0, 0.0]]
    for cue in cues:
        loop = loop_of(character, layer, cue["then"], seed, cue["meta"])
        if loop is None:
            continue
        start, length = cue["end"] - cue["blend_out"], cue["end"] - cue["start"]
        action = character.actions[cue["action"]]
        if action["limb"] == "both" and not action["joints"] and not action.get("joint_weights"):
            fade_start = cue["start"] + cue["blend_in"]
            fade = start - fade_start
        else:
            fade = length if cue["then"] != cue["stance"] else min(longest, length)
            fade_start = max(cue["start"], start - fade)
        placed.append([cue["then"], loop, start, fade_start, fade])
    out: list[list[Any]] = []
    for place, rest in enumerate(placed):
        out.append(rest)
        stance, loop, change, _, _ = rest
        until = placed[place + 1][3] if place + 1 < len(placed) else end
        if len(character.data["layers"][layer]["index"][stance]["stance"]) < 2:
            continue
        while True:
            action = character.actions[loop]
            change += max(1.0, action["end"] - action["start"] - action["blend_in"])
            if change > until:
                break
            other = loop_of(character, layer, stance, seed, f"{layer}/{change:.3f}")
            if other != loop:
                loop = other
                out.append([stance, loop, change, change - longest, longest])
    return out
