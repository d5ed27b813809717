"""VRM's expression presets, made of whatever morph targets a face has.

What reads a GLB of ours knows from them how to make a face happy or its mouth say "ah", whatever the targets
are called. The presets are those of VRM 1.0.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from metagraph.graph.face.names import find_morphs, simplify_curve_name

# Preset -> ((channel of a face, how much of it), ...); the amounts are ours.
PRESETS: dict[str, tuple[tuple[str, float], ...]] = {
    "happy": (("smile", 1.0), ("cheeks", 1.0)),
    "angry": (("brow_down", 1.0), ("frown", 0.3)),
    "sad": (("frown", 1.0), ("brow_up", 1.0)),
    "relaxed": (("smile", 0.4),),
    "surprised": (("brows", 1.0), ("wide_left", 0.7), ("wide_right", 0.7), ("jaw_open", 0.3)),
    "aa": (("viseme_aa", 1.0),),
    "ih": (("viseme_I", 1.0),),
    "ou": (("viseme_U", 1.0),),
    "ee": (("viseme_E", 1.0),),
    "oh": (("viseme_O", 1.0),),
    "blink": (("blink", 1.0), ("blink_left", 1.0), ("blink_right", 1.0)),
    "blinkLeft": (("blink_left", 1.0),),
    "blinkRight": (("blink_right", 1.0),),
    "lookUp": (("look_up_left", 1.0), ("look_up_right", 1.0)),
    "lookDown": (("look_down_left", 1.0), ("look_down_right", 1.0)),
    "lookLeft": (("look_left_left", 1.0), ("look_left_right", 1.0)),
    "lookRight": (("look_right_left", 1.0), ("look_right_right", 1.0)),
}


def make_presets(names: Iterable[str], bound: Mapping[str, str] | None = None) -> dict[str, dict[str, float]]:
    """Return preset -> morph target -> weight, 0..1, without presets that the face cannot make.

    A target that is called like a preset is that preset. bound: as for `find_morphs`.
    """
    targets = list(names)
    channels = find_morphs(targets, bound)
    own = {simplify_curve_name(name): name for name in reversed(targets)}
    out: dict[str, dict[str, float]] = {}
    for preset, parts in PRESETS.items():
        if preset.lower() in own:
            out[preset] = {own[preset.lower()]: 1.0}
            continue
        made: dict[str, float] = {}
        for channel, amount in parts:
            for name, weight in channels.get(channel, ()):
                made[name] = min(1.0, round(made.get(name, 0.0) + amount * weight, 6))
        if made:
            out[preset] = made
    return out


ROUNDS = 6  # presets that a face is taken for at once


def measure_presets(mixes: Mapping[str, Mapping[str, float]], weights: Mapping[str, Any]) -> dict[str, Any]:
    """Return preset -> value, 0..1, of those that together come near to some weights of morph targets: the
    preset that explains most comes first, and the next explains what is left (matching pursuit). Of two that
    explain as much, it is the simpler one: an open jaw is "aa" rather than surprise.

    mixes: as `make_presets` returns them. weights: numbers, or arrays of one shape, by morph target; values
    have the same shape.
    """
    targets = sorted({target for mix in mixes.values() for target in mix if target in weights})
    if not targets:
        return {}
    mixes = {preset: mixes[preset] for preset in sorted(mixes, key=lambda p: len(PRESETS.get(p, ())))}
    shape = np.shape(weights[targets[0]])
    left = np.stack([np.reshape(weights[t], -1) for t in targets], 1).astype(float)
    made = np.array([[mix.get(t, 0.0) for t in targets] for mix in mixes.values()])
    size = np.maximum((made * made).sum(1), 1e-12)
    held, rows = np.zeros((len(left), len(made))), np.arange(len(left))
    for _ in range(ROUNDS):
        more = np.clip(left @ made.T / size, 0.0, 1.0 - held)
        best = (more * (2 * left @ made.T - more * size)).argmax(1)  # by how much the rest becomes less
        held[rows, best] += more[rows, best]
        left -= more[rows, best, None] * made[best]
    return {preset: held[:, n].reshape(shape) for n, preset in enumerate(mixes)}
