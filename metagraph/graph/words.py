"""The keys of the domain: layers, kinds, limbs, body parts, modes."""

from __future__ import annotations

from typing import Literal, get_args

Layer = Literal["body", "arms", "head"]
Kind = Literal["stance", "gesture", "fidget", "transition"]
Limb = Literal["left", "right", "both"]
Part = Literal["legs", "spine", "arms", "head", "face"]
Mode = Literal["idle", "listening", "talking", "thinking", "reacting"]

LAYERS: tuple[Layer, ...] = get_args(Layer)
KINDS: tuple[Kind, ...] = get_args(Kind)
LIMBS: tuple[Limb, ...] = get_args(Limb)
PARTS: tuple[Part, ...] = get_args(Part)
MODES: tuple[Mode, ...] = get_args(Mode)
LASTING_MODES: tuple[Mode, ...] = MODES[:3]  # the others last for moments

Feeling = Literal[
    "neutral",
    "calm",
    "content",
    "warm",
    "happy",
    "excited",
    "tense",
    "angry",
    "afraid",
    "sad",
    "bored",
    "tired",
]  # moods that have names; where they lie says `playback.planning.mood`
FEELINGS: tuple[Feeling, ...] = get_args(Feeling)
