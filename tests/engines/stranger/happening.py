"""The events of life of plans of single steps, written alone from docs/reference, "Drawing the events of
life"; each function names the headings it follows. Lines without a voice are left out.
"""

from bisect import bisect_left, bisect_right
from dataclasses import dataclass
from math import ceil, inf, log, pi, sin
from typing import Any

from tests.engines.stranger.drawing import uniform
from tests.engines.stranger.enlivening import USUAL
from tests.engines.stranger.planning import log_normal
from tests.engines.stranger.reading import Character

MODES = ("idle", "listening", "talking", "thinking", "reacting")
RATES = {
    "breath_rate": 14.0, "aversion_rate": 12.0, "aversion_length": 0.93, "saccade_rate": 60.0, "blinks": 17.0,
    "accent_blinks": 0.7, "accent_brows": 0.4, "valence": 0.0, "arousal": 0.0, "intensity": 1.0,
}  # fmt: skip
MANNERS: dict[str, dict[str, float]] = {
    "idle": {
        "aversion_rate": 1.1, "aversion_length": 2.4, "aversion_angle": 1.4, "saccade_rate": 0.85,
    },
    "listening": {
        "aversion_length": 1.5, "aversion_angle": 1.1, "saccades": 0.9, "blinks": 1.45,
    },
    "talking": {
        "breathing": 1.15, "breath_rate": 1.1, "aversion_rate": 1.35, "aversion_length": 2.3,
        "aversion_angle": 1.3, "blinks": 0.65,
    },
    "thinking": {
        "breathing": 0.8, "aversion_rate": 1.1, "aversion_length": 3.8, "aversion_angle": 1.3,
        "saccades": 0.7, "saccade_rate": 0.6,
    },
    "reacting": {
        "breathing": 1.2, "aversion_rate": 0.2, "aversion_angle": 0.6, "saccades": 0.7, "blinks": 1.6,
    },
}  # fmt: skip
NAMED = {
    "neutral": (0.0, 0.0), "calm": (0.58, -0.55), "content": (0.64, -0.48), "warm": (0.6, 0.1),
    "happy": (0.79, 0.11), "excited": (0.53, 0.6), "tense": (-0.04, 0.8), "angry": (-0.13, 0.79),
    "afraid": (-0.35, 0.72), "sad": (-0.71, -0.37), "bored": (-0.38, -0.71), "tired": (-0.03, -0.8),
}  # fmt: skip
LASTING = {"look", "mode", "mood", "blink", "place", "say"}
OTHERS = {"gesture", "fidget", "action", "stance", "change", "nod", "shake"}


@dataclass(frozen=True)
class Said:
    id: str
    start: float
    end: float
    accents: list[float]
    text: str


def can_happen(character: Character, case: dict[str, Any]) -> bool:
    """Whether a case has one step and asks only what this module knows."""
    asks = [ask for step in case["steps"] for ask in step["asks"]]
    lines = character.data.get("lines", {})
    return (
        len(case["steps"]) == 1
        and "rig" in character.data
        and character.data.get("life", {}).get("on", True)
        and all("do" in ask and "id" in ask and ask["do"] in LASTING | OTHERS for ask in asks)
        and len({ask["id"] for ask in asks}) == len(asks)
        and all(
            ask.get("line") in character.data.get("voices", {})
            and not ({"duration", "words", "visemes", "characters", "more", "mood"} & ask.keys())
            and not lines[ask["line"]].get("mood")
            and all(inner["do"] in OTHERS for inner in lines[ask["line"]].get("asks", []))
            for ask in asks
            if ask["do"] == "say"
        )
    )


class Happening:
    """The events of a case."""

    def __init__(self, character: Character, case: dict[str, Any]) -> None:
        self.seed, data = case["seed"], character.data
        self.dials: dict[str, Any] = USUAL | RATES | data.get("life", {})
        self.calm = 1.0 - self.dials["stillness"]
        self.drawn = max(8.0, ceil(case["steps"][0]["end"] / 8.0) * 8.0)
        asks = sorted(case["steps"][0]["asks"], key=lambda ask: (ask.get("at") or 0.0, ask["id"]))
        self.asks = {do: [ask for ask in asks if ask["do"] == do] for do in LASTING}
        self.said = self.speeches(data)
        edges = [0.0]
        edges += [ask.get("at") or 0.0 for ask in self.asks["mode"]]
        edges += [edge for one in self.said for edge in (one.start, one.end)]
        self.modes = self.changes(edges, self.mode_at)
        edges = [0.0]
        for ask in self.asks["mood"]:
            at = ask.get("at") or 0.0
            edges += [at, at + ask.get("duration", inf)]
        self.moods = self.changes(edges, self.mood_at)
        self.targets = self.looked_at()
        self.segments()

    def changes(self, edges: list[float], at: Any) -> list[tuple[float, Any]]:
        """ "Modes, moods and targets"."""
        out: list[tuple[float, Any]] = []
        for edge in sorted({edge for edge in edges if 0.0 <= edge < self.drawn}):
            value = at(edge)
            if not out or out[-1][1] != value:
                out.append((edge, value))
        return out

    def speeches(self, data: dict[str, Any]) -> list[Said]:
        out: list[Said] = []
        for ask in self.asks["say"]:
            voice, line = data["voices"][ask["line"]], data["lines"][ask["line"]]
            start = ask.get("at") or 0.0
            end = start + voice["duration"]
            out.append(Said(ask["id"], start, end, voice["accents"], line.get("text", "")))
        return out

    def wanted_mode(self, t: float) -> str | None:
        asked = [ask for ask in self.asks["mode"] if (ask.get("at") or 0.0) <= t]
        if asked and asked[-1].get("mode"):
            return str(asked[-1]["mode"])
        said = [one for one in self.said if one.start <= t]
        return "talking" if said and t < said[-1].end else None

    def mode_at(self, t: float) -> int:
        return MODES.index(self.wanted_mode(t) or "idle")

    def mood_at(self, t: float) -> tuple[float, float, float]:
        v, a, i = (float(self.dials[name]) for name in ("valence", "arousal", "intensity"))
        for ask in self.asks["mood"]:
            at = ask.get("at") or 0.0
            if at <= t < at + ask.get("duration", inf):
                if "mood" in ask:
                    v, a = NAMED[ask["mood"]] if isinstance(ask["mood"], str) else ask["mood"]
                i = ask.get("intensity", i)
        return v, a, i

    def looked_at(self) -> list[list[Any]]:
        """ "Modes, moods and targets"."""
        looks = [
            (ask.get("at") or 0.0, ask.get("duration", inf), ask.get("priority", 1), ask)
            for ask in self.asks["look"]
        ]
        places = [(ask.get("at") or 0.0, ask["name"], ask["point"]) for ask in self.asks["place"]]
        edges = {0.0, *(at for at, *_ in looks), *(at + lasts for at, lasts, *_ in looks)}
        edges |= {at for at, *_ in places}
        since, chosen = 0.0, None
        out: list[list[Any]] = []
        for edge in sorted(edge for edge in edges if edge < self.drawn):
            kept: list[tuple[float, float, int, Any]] = []
            for look in looks:
                if look[0] <= edge:
                    kept = [*(other for other in kept if other[2] > look[2]), look]
            kept = [look for look in kept if edge < look[0] + look[1]]
            first = kept[0] if kept else None
            if first is not chosen:
                chosen, since = first, edge
            put = {name: point for at, name, point in places if at <= edge}
            to = "user" if first is None else first[3].get("to", "user")
            to = put.get(to, to) if isinstance(to, str) else to
            ask = {} if first is None else first[3]
            target = [to, since, ask.get("amount", 1.0), ask.get("strict", False), first is not None]
            if not out or [*out[-1][1:2], *out[-1][3:]] != [*target[:1], *target[2:]]:
                out.append([edge, *target])
        return out

    def segments(self) -> None:
        """ "Segments"."""
        edges = [start for start, _ in self.modes] + [start for start, _ in self.moods]
        strict = [target[4] for target in self.targets]
        edges += [target[0] for n, target in enumerate(self.targets) if n == 0 or strict[n] != strict[n - 1]]
        self.edges = sorted(set(edges))
        self.ways: list[dict[str, float]] = []
        self.strict: list[bool] = []
        for edge in self.edges:
            mode = MODES[[value for start, value in self.modes if start <= edge][-1]]
            own = self.dials.get("modes", {}).get(mode, MANNERS[mode])
            ways = {name: own.get(name, 1.0) for name in (
                "breathing", "breath_rate", "aversion_rate", "aversion_length", "aversion_angle",
                "saccades", "saccade_rate", "blinks",
            )}  # fmt: skip
            v, a, i = [value for start, value in self.moods if start <= edge][-1]
            if (v, a, i) != (0.0, 0.0, 1.0):
                quick = 1.0 + (0.4 if a > 0.0 else 0.25) * a
                ways["breathing"] *= 1.0 + 0.25 * a
                ways["breath_rate"] *= quick
                ways["blinks"] *= quick
                ways["saccade_rate"] *= 1.0 + 0.4 * a
                ways["aversion_rate"] *= 1.0 - (0.4 if v < 0.0 else 0.25) * v
            self.ways.append(ways)
            self.strict.append([target[4] for target in self.targets if target[0] <= edge][-1])

    def way(self, t: float) -> dict[str, float]:
        return self.ways[max(0, bisect_right(self.edges, t) - 1)]

    def after(self, t: float, need: float, rates: list[float]) -> float:
        """ "The clock"."""
        place = max(0, bisect_right(self.edges, t) - 1)
        while t < self.drawn:
            end = self.edges[place + 1] if place + 1 < len(self.edges) else self.drawn
            rate = rates[place]
            if rate > 0.0 and t + need / rate < end:
                return t + need / rate
            need -= rate * max(0.0, end - t)
            t, place = end, place + 1
        return inf

    def u(self, what: str, number: int, purpose: str) -> float:
        return uniform(self.seed, what, str(number), purpose)

    def breaths(self) -> list[list[float]]:
        """ "Breaths"."""
        out: list[list[float]] = []
        phrases = sorted(
            [one.start for one in self.said]
            + [ask.get("at") or 0.0 for ask in self.asks["mode"] if ask.get("mode") == "talking"]
        )
        at, begun = 0.0, False
        while True:
            rate = self.dials["breath_rate"] * self.way(at)["breath_rate"] / 60.0
            if rate <= 0.0:
                later = bisect_right(self.edges, at)
                if self.dials["breath_rate"] <= 0.0 or later == len(self.edges):
                    return out
                at, begun = self.edges[later], True
                continue
            n = len(out)
            length = (
                (0.85 + 0.3 * self.u("breath", n, "length")) / rate * (1.0 + 2.0 * self.dials["stillness"])
            )
            depth = self.way(at)["breathing"] * (0.85 + 0.3 * self.u("breath", n, "depth"))
            if begun:
                place = bisect_left(phrases, at + 0.5 * length + 0.55)
                if place < len(phrases) and phrases[place] - 0.55 - at <= 1.5 * length:
                    length = phrases[place] - 0.55 - at
            else:
                at, begun = -length * uniform(self.seed, "breath", "first"), True
            if at >= self.drawn:
                return out
            out.append([at, length, depth])
            at += length

    def saccades(self) -> list[list[float]]:
        """ "Jumps of the eyes"."""
        out: list[list[float]] = []
        if self.dials["saccade_rate"] <= 0.0 or self.calm <= 0.0:
            return out
        mean = max(60.0 / self.dials["saccade_rate"], 0.21)
        rates = [ways["saccade_rate"] * self.calm for ways in self.ways]
        at = 0.0
        while True:
            n = len(out)
            at = self.after(at, 0.2 + (mean - 0.2) * min(4.0, -log(self.u("saccade", n, "gap"))), rates)
            if at >= self.drawn:
                return out
            size = min(4.0, -1.2 * log(self.u("saccade", n, "size"))) * self.way(at)["saccades"]
            turn = 2.0 * pi * self.u("saccade", n, "way")
            out.append([at, size * sin(turn + pi / 2.0), 0.6 * size * sin(turn)])

    def aversions(self) -> list[list[float]]:
        """ "Looks away"."""
        out: list[list[float]] = []
        d = self.dials
        if min(d["aversion_rate"], d["aversion_length"], d["aversion_angle"], self.calm) <= 0.0:
            return out
        rates = []
        for ways, strict in zip(self.ways, self.strict, strict=True):
            rate = d["aversion_rate"] * ways["aversion_rate"]
            mean = (
                max(0.6, 60.0 / rate - d["aversion_length"] * ways["aversion_length"]) if rate > 0.0 else inf
            )
            rates.append(0.0 if strict else self.calm / mean)
        last = 0.0
        while True:
            n = len(out)
            at = max(last + 0.6, self.after(last, 0.6 + 0.8 * self.u("aversion", n, "gap"), rates))
            if at >= self.drawn:
                return out
            ways = self.way(at)
            length = (
                d["aversion_length"] * ways["aversion_length"] * (0.6 + 0.8 * self.u("aversion", n, "length"))
            )
            last = at + max(0.25, length)
            size = ways["aversion_angle"] * (0.7 + 0.6 * self.u("aversion", n, "size"))
            turn = 2.0 * pi * self.u("aversion", n, "way")
            up = 0.6 * size * sin(turn)
            thinks = MODES[[value for start, value in self.modes if start <= at][-1]] == "thinking"
            out.append([at, last, size * sin(turn + pi / 2.0), abs(up) if thinks else up])

    def blinks(self) -> list[list[float]]:
        """ "Blinks"."""
        d, out = self.dials, list[list[float]]()
        shut = d["blink_close"] + d["blink_open"]
        mean = 60.0 / d["blinks"] if d["blinks"] > 0.0 and self.calm > 0.0 else inf
        rates = [ways["blinks"] * self.calm for ways in self.ways]
        accents = [
            (one.start + accent, n == 0)
            for one in self.said
            for n, accent in enumerate(one.accents)
            if one.start <= one.start + accent < min(one.end, self.drawn)
            and (n == 0 or uniform(self.seed, one.id, "accent", str(n)) < d["accent_blinks"])
        ]
        if self.calm <= 0.0 or d["accent_blinks"] <= 0.0:
            accents = []
        asked = [ask.get("at") or 0.0 for ask in self.asks["blink"]]
        last = -0.5 * min(mean, 10.0) * uniform(self.seed, "blink", "first")
        while True:
            n, own = len(out), inf
            if mean < inf:
                gap = log_normal(mean, 0.7 * mean, self.u("blink", n, "gap"), self.u("blink", n, "gap2"))
                need = 0.4 if self.u("blink", n, "double") < 0.06 else max(0.4, gap)
                own = max(0.0, self.after(last, need, rates))
            heard = next(
                (at for at, first in accents if at >= last + (shut + 0.1 if first else 1.0 / self.calm)), inf
            )
            accents = [accent for accent in accents if accent[0] >= heard]
            wish = next((at for at in asked if at >= max(0.0, last + shut)), inf)
            at = min(own, heard, wish)
            if at >= self.drawn:
                return out
            alone = 3.0 if self.u("blink", n, "half") < 0.12 else 0.0
            out.append([at, 2.0 if at == wish else 1.0 if at == heard else alone])
            last = at

    def swells(self) -> list[list[float]]:
        """ "Swells and emphases"."""
        out, over = list[list[float]](), 0.0
        while True:
            n = len(out)
            at = over + 3.5 * (0.3 + 1.4 * self.u("swell", n, "gap"))
            if at >= self.drawn:
                return out
            length = 0.9 + 3.1 * self.u("swell", n, "length")
            listens = self.wanted_mode(at) == "listening"
            out.append([at, length, 0.6 + 0.4 * self.u("swell", n, "amount"), float(listens)])
            over = at + length

    def emphases(self) -> list[list[float]]:
        """ "Swells and emphases"."""
        out = []
        for one in self.said:
            for n, accent in enumerate(one.accents):
                at = max(one.start, one.start + accent - 0.06)
                if at < one.end and uniform(self.seed, one.id, "brows", str(n)) < self.dials["accent_brows"]:
                    chance = uniform(self.seed, one.id, "raise", str(n))
                    out.append([at, 0.35 + 0.3 * chance, 0.5 + 0.5 * chance, 0.12])
            if one.text.strip().endswith(("?", "？", "؟")):
                lead = min(0.8, 0.5 * (one.end - one.start))
                out.append([one.end - lead, lead + 0.5, 0.8, lead])
        for ask in self.asks["mode"]:
            if ask.get("mode") == "reacting" and self.dials["accent_brows"] > 0.0:
                chance = uniform(self.seed, ask["id"], "raise")
                out.append([ask.get("at") or 0.0, 1.2, 0.6 + 0.4 * chance, 0.12])
        return sorted(
            (each for each in out if 0.0 <= each[0] < self.drawn), key=lambda each: (each[0], each[3])
        )

    def lanes(self) -> dict[str, list[list[Any]]]:
        lanes = {
            "modes": [[start, float(mode)] for start, mode in self.modes], "breaths": self.breaths(),
            "aversions": self.aversions(), "saccades": self.saccades(), "blinks": self.blinks(),
            "swells": self.swells(), "emphases": self.emphases(), "targets": self.targets,
        }  # fmt: skip
        moods = [[start, *mood] for start, mood in self.moods]
        return lanes | ({"moods": moods} if any(mood[1:] != [0.0, 0.0, 1.0] for mood in moods) else {})
