"""How faces name things: morph targets after ARKit, VRM, Oculus and others; clips that show blinks and mouth
shapes.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Mapping

from metagraph.graph.model import Project

# The 15 mouth shapes most rigs and lip-sync tools share (Oculus), silence first.
VISEMES: tuple[str, ...] = (
    "sil",
    "PP",
    "FF",
    "TH",
    "DD",
    "kk",
    "CH",
    "SS",
    "nn",
    "RR",
    "aa",
    "E",
    "I",
    "O",
    "U",
)
Weights = tuple[tuple[str, float], ...]
# What moods and expressions show, on morph targets alone.
MOOD_FACE = ("smile", "frown", "brow_down", "brow_up", "brows", "cheeks")
# ARKit's targets for these, else the expressions of VRM and its kin.
_MOODS: dict[str, tuple[Weights, tuple[str, ...]]] = {
    "smile": ((("mouthsmile#", 0.9),), ("happy", "joy", "fun", "smile")),
    "frown": ((("mouthfrown#", 1.0), ("mouthshruglower", 0.3)), ("sad", "sorrow", "frown")),
    "brow_down": (
        (("browdown#", 1.0), ("eyesquint#", 0.35), ("nosesneer#", 0.25), ("mouthpress#", 0.4)),
        ("angry", "browdown", "browsdown"),
    ),
    "brow_up": ((("browinnerup", 1.0),), ("browinnerup", "browsup", "browup")),
    "brows": ((("browinnerup", 0.9), ("browouterup#", 0.9)), ("browsup", "browup", "browraise")),
    "cheeks": ((("cheeksquint#", 0.7), ("eyesquint#", 0.3)), ("cheeksquint", "cheekraise")),
}
_WHOLE = 0.5  # of an expression of the whole face

_SIDES = {"left": ("left", "l"), "right": ("right", "r")}
_PREFIX = re.compile(
    r"^(blendshapes?|blendshape\d+|morph(target)?s?|shapes?|bs|expressions?|exp|face|head|vrc|mth|fcl|[a-z]?\d+)"
)


def simplify_curve_name(name: str) -> str:
    """Return a name without what differs from tool to tool: case, separators, what stands before a dot
    ("eyeBlink.L" is whole).
    """
    before, _, last = name.lower().rpartition(".")
    if last in ("l", "r", "left", "right") or last.isdigit():
        last = before.rsplit(".", 1)[-1] + last
    return re.sub(r"[^a-z0-9]", "", last)


def _keys(name: str) -> list[str]:
    """Return the words a name may be known by: itself, then without its prefixes."""
    out = [simplify_curve_name(name)]
    while (found := _PREFIX.match(out[-1])) and len(out[-1]) > found.end():
        out.append(out[-1][found.end() :])
    return out


# ARKit's targets that make each shape, with weights; "#" stands for both sides.
_ARKIT: dict[str, tuple[tuple[str, float], ...]] = {
    "PP": (("mouthpress#", 0.45), ("mouthrolllower", 0.25), ("mouthrollupper", 0.2)),
    "FF": (("mouthrolllower", 0.6), ("mouthupperup#", 0.25), ("jawopen", 0.06)),
    "TH": (("jawopen", 0.16), ("mouthlowerdown#", 0.25), ("tongueout", 0.35)),
    "DD": (("jawopen", 0.12), ("mouthlowerdown#", 0.3), ("mouthupperup#", 0.1)),
    "kk": (("jawopen", 0.2), ("mouthlowerdown#", 0.2)),
    "CH": (("mouthfunnel", 0.55), ("jawopen", 0.1), ("mouthpucker", 0.15)),
    "SS": (("mouthstretch#", 0.3), ("mouthlowerdown#", 0.25), ("mouthupperup#", 0.1), ("jawopen", 0.04)),
    "nn": (("jawopen", 0.14), ("mouthlowerdown#", 0.2)),
    "RR": (("mouthfunnel", 0.4), ("jawopen", 0.14)),
    "aa": (("jawopen", 0.6), ("mouthlowerdown#", 0.25), ("mouthupperup#", 0.15)),
    "E": (("jawopen", 0.34), ("mouthstretch#", 0.3), ("mouthlowerdown#", 0.2)),
    "I": (("jawopen", 0.18), ("mouthstretch#", 0.4), ("mouthsmile#", 0.15)),
    "O": (("jawopen", 0.4), ("mouthfunnel", 0.6)),
    "U": (("jawopen", 0.16), ("mouthpucker", 0.75), ("mouthfunnel", 0.2)),
}  # fmt: skip
# The five vowels of VRM and its kin that make each shape.
_VOWELS: dict[str, tuple[tuple[str, float], ...]] = {
    "PP": (),
    "FF": (("u", 0.15),),
    "TH": (("e", 0.25),),
    "DD": (("i", 0.25),),
    "kk": (("e", 0.3),),
    "CH": (("u", 0.45),),
    "SS": (("i", 0.35),),
    "nn": (("i", 0.2),),
    "RR": (("o", 0.3),),
    "aa": (("a", 1.0),),
    "E": (("e", 1.0),),
    "I": (("i", 1.0),),
    "O": (("o", 1.0),),
    "U": (("u", 1.0),),
}
_VOWEL_NAMES = {"a": ("a", "aa"), "i": ("i", "ih"), "u": ("u", "ou"), "e": ("e", "ee"), "o": ("o", "oh")}
_OCULUS = {v: (v.lower(),) for v in VISEMES[1:]} | {
    "E": ("e", "ee", "eh"),
    "I": ("i", "ih"),
    "O": ("o", "oh"),
    "U": ("u", "ou"),
}
# Shares of one opening for mouths that can do no more.
_OPEN = {
    "FF": 0.08,
    "TH": 0.3,
    "DD": 0.25,
    "kk": 0.35,
    "CH": 0.2,
    "SS": 0.15,
    "nn": 0.25,
    "RR": 0.3,
    "aa": 1.0,
    "E": 0.6,
    "I": 0.35,
    "O": 0.7,
    "U": 0.35,
}


class _Names:
    def __init__(self, names: Iterable[str]) -> None:
        self.by_key: dict[str, str] = {}
        everything = list(dict.fromkeys(names))
        for depth in range(4):  # a name as it stands goes before one that has lost its prefix
            for name in everything:
                keys = _keys(name)
                if depth < len(keys):
                    self.by_key.setdefault(keys[depth], name)

    def one(self, *keys: str) -> str | None:
        return next((self.by_key[k] for k in keys if k in self.by_key), None)

    def sided(self, side: str, *keys: str) -> str | None:
        return self.one(*(form for k in keys for s in _SIDES[side] for form in (k + s, s + k)))

    def mixed(self, recipe: Iterable[tuple[str, float]]) -> Weights:
        out: list[tuple[str, float]] = []
        for key, weight in recipe:
            found = [self.sided(s, key[:-1]) for s in _SIDES] if key.endswith("#") else [self.one(key)]
            out += [(name, weight) for name in found if name is not None]
        return tuple(out)


def find_morphs(names: Iterable[str], bound: Mapping[str, str] | None = None) -> dict[str, Weights]:
    """Return channel -> ((morph target, weight at 1), ...) for a face's morph targets; bound: the user's
    corrections.
    """
    bound = bound or {}
    all_names = tuple(names)
    have = _Names(all_names)
    out: dict[str, Weights] = {}

    def take(channel: str, name: str | None) -> None:
        if name is not None:
            out[channel] = ((name, 1.0),)

    shut = ("eyeblink", "blink", "eyeclose", "eyeclosed", "eyesclosed")
    for side in _SIDES:
        take(f"blink_{side}", have.sided(side, *shut))
        take(f"wide_{side}", have.sided(side, "eyewide", "eyeswide"))
        for way, word in (("up", "up"), ("down", "down"), ("in", "in"), ("out", "out")):
            # "in" is towards the nose: to the right for the left eye.
            where = (
                way if way in ("up", "down") else ("right" if (side == "left") == (way == "in") else "left")
            )
            take(f"look_{where}_{side}", have.sided(side, f"eyelook{word}"))
        for way in ("up", "down", "left", "right"):
            if f"look_{way}_{side}" not in out and side == "left":  # one target for both eyes
                take(f"look_{way}_{side}", have.one(f"look{way}", f"eyelook{way}", f"eyeslook{way}"))
    if "blink_left" not in out and "blink_right" not in out:
        take("blink", have.one(*shut))
    for channel, (recipe, words) in _MOODS.items():
        mix = have.mixed(recipe)
        if not mix and (name := have.one(*words)) is not None:
            mix = ((name, _WHOLE),)
        if mix:
            out[channel] = mix
    known = set(all_names)
    own = bound.get("jaw_open")
    out |= _mouth(have, own if own in known else None)
    for channel, name in bound.items():
        if not name:
            out.pop(channel, None)
        elif name in known:
            out[channel] = ((name, 1.0),)
    return out


def _mouth(have: _Names, bound: str | None = None) -> dict[str, Weights]:
    """Return the mouth's shapes from targets made for them, else from ARKit's, VRM's vowels, or a mouth that
    opens.

    bound: the target that opens the mouth, where the user says so.
    """
    out: dict[str, Weights] = {}
    for viseme, forms in _OCULUS.items():
        name = have.one(*(p + f for p in ("viseme", "vis", "v") for f in forms))
        if name is not None:
            out[f"viseme_{viseme}"] = ((name, 1.0),)
    if len(out) >= 6:
        return out
    jaw = bound or have.one("jawopen", "jawdrop", "mouthopen", "openmouth")
    out = {"jaw_open": ((jaw, 1.0),)} if jaw is not None else {}
    if have.one("jawopen") and have.one("mouthfunnel", "mouthpucker"):
        return out | {f"viseme_{v}": mix for v, recipe in _ARKIT.items() if (mix := have.mixed(recipe))}
    vowels = {k: have.one(*forms) for k, forms in _VOWEL_NAMES.items()}
    if sum(name is not None for name in vowels.values()) >= 3:
        for viseme, recipe in _VOWELS.items():
            mix = tuple((name, w) for k, w in recipe if (name := vowels[k]) is not None)
            if mix:
                out[f"viseme_{viseme}"] = mix
        return out
    return out | ({f"viseme_{v}": ((jaw, w),) for v, w in _OPEN.items()} if jaw is not None else {})


# --- clips

# Mouth shapes of speech services' marks; several may stand for one, the best first.
_MARKS = {
    "PP": ("p",),
    "FF": ("f",),
    "TH": ("T",),
    "DD": ("t",),
    "kk": ("k",),
    "CH": ("S",),
    "SS": ("s",),
    "nn": ("n", "t"),
    "RR": ("r",),
    "aa": ("a",),
    "E": ("E", "e"),
    "I": ("i",),
    "O": ("o", "O"),
    "U": ("u", "w"),
}
_SHORT = 0.6  # seconds; a clip that shows one shape is no longer
_BLINK = 1.5


def find_clip_shapes(project: Project) -> dict[str, str]:
    """Return channel -> id of the clip that shows it, told by the clips' names.

    A clip called like a mouth shape counts only among others of the same file, or with "viseme" or the like
    before it.
    """
    blinks: list[tuple[int, str, str]] = []
    named: dict[str, str] = {}
    files: dict[str, dict[str, str]] = defaultdict(dict)
    for entry in project.clips.values():
        if entry.motion is None or entry.duration > _BLINK:
            continue
        key = simplify_curve_name(entry.name)
        if re.match(r"^(eyes?)?(blink|eyesclosed?|lidsclosed?)", key):
            blinks.append((len(key), entry.name, entry.id))
        if entry.duration > _SHORT:
            continue
        found = re.match(r"^(visemes?|vis|mouth|lips?|lipsync|phoneme)(.+)$", key)
        if found:
            for viseme, forms in _OCULUS.items():
                if found[2] in forms:
                    named.setdefault(f"viseme_{viseme}", entry.id)
        elif key in ("jawopen", "mouthopen", "openmouth"):
            named.setdefault("jaw_open", entry.id)
        files[entry.path].setdefault(entry.name.strip(), entry.id)
    for clips in files.values():
        marks = {
            f"viseme_{v}": clips[m]
            for v, forms in _MARKS.items()
            if (m := next((f for f in forms if f in clips), None))
        }
        oculus = {f"viseme_{v}": clips[v] for v in VISEMES[1:] if v in clips}
        best = max(marks, oculus, key=len)
        if len(best) >= 6:
            named = {**best, **named}
    if blinks:
        named["blink"] = min(blinks)[2]
    return named
