"""Plans of single steps, written from docs/reference, "The planner", "The models",
"To the last boundary" and "Phases", alone: models, gestures with their strokes and holds, fidgets, certain
actions and ways to stances. Words, modes and what lasts are left out.
"""

from bisect import insort
from dataclasses import dataclass, replace
from math import cos, exp, floor, inf, log, pi, sqrt
from typing import Any

from tests.engines.stranger.drawing import begins_in, pick, uniform
from tests.engines.stranger.reading import Character

NEAR = 1e-6
WRITTEN = -inf
PLANNED = {
    "gesture": {
        "do", "id", "at", "layer", "tags", "limb", "duration", "priority", "resume",
        "stroke", "hold", "prepare",
    },
    "fidget": {"do", "id", "at", "layer", "tags", "limb", "duration", "priority", "resume"},
    "action": {"do", "id", "at", "action", "duration", "priority", "stroke", "hold", "prepare"},
    "stance": {"do", "id", "at", "layer", "stance", "priority"},
}  # fmt: skip


def can_plan(character: Character, case: dict[str, Any]) -> bool:
    """Whether a case has one step and asks only what this planner knows."""
    asks = [ask for step in case["steps"] for ask in step["asks"]]
    stances = {s["id"] for layer in character.data["layers"].values() for s in layer["stances"]}
    return (
        len(case["steps"]) == 1
        and len({ask["id"] for ask in asks}) == len(asks)
        and all(ask.keys() <= PLANNED.get(ask["do"], set()) for ask in asks)
        and all(ask["action"] in character.actions for ask in asks if ask["do"] == "action")
        and all(ask["stance"] in stances for ask in asks if ask["do"] == "stance")
    )


@dataclass(frozen=True)
class Meta:
    """ "Meta actions": asked is when it was wanted, rank its priority."""

    id: str
    kind: str
    start: float
    end: float
    rank: float
    asked: float
    timed: bool = True
    tags: tuple[str, ...] = ()
    limb: str | None = None
    goal: str | None = None
    action: str | None = None
    resume: bool = False
    part: int = 0
    stroke: float | None = None
    hold: float | None = None
    prepare: bool = True
    seconds: float = 0.0

    @property
    def key(self) -> str:
        return f"{self.id}+{self.part}" if self.part else self.id


def order(meta: Meta) -> tuple[float, float, str, int]:
    return meta.start, -meta.rank, meta.id, meta.part


def asked(character: Character, layer: str, case: dict[str, Any]) -> list[Meta]:
    """ "Meta actions"."""
    out = []
    for ask in case["steps"][0]["asks"]:
        action = character.actions.get(ask.get("action", ""))
        stances = {name: {s["id"] for s in of["stances"]} for name, of in character.data["layers"].items()}
        if action is not None:
            where = next(name for name, of in character.data["layers"].items() if action in of["actions"])
        elif ask["do"] == "stance":
            where = next(name for name, ids in stances.items() if ask["stance"] in ids)
        else:
            where = ask.get("layer", "arms")
        if where != layer:
            continue
        start, timed = ask.get("at", 0.0), ask.get("duration") is not None
        timed = timed and (action is None or action.get("repeat", 0.0) > 0.0)
        seconds = ask["duration"] if timed else character.data["planner"]["window"]
        stroke, tags = ask.get("stroke"), tuple(ask.get("tags", ()))
        if stroke is not None:
            every = character.data["layers"][layer]["actions"]
            gestures = [a for a in every if a["kind"] == "gesture" and set(tags) <= set(a["tags"])]
            start = max(0.0, stroke - max((lead(a) for a in ([action] if action else gestures)), default=0.0))
            seconds = max(seconds, stroke - start + NEAR)
        kind = action["kind"] if action else "transition" if ask["do"] == "stance" else ask["do"]
        out.append(
            Meta(
                ask["id"], kind, start, start + seconds, ask.get("priority", 1), start, timed,
                tags, ask.get("limb"), ask.get("stance"), ask.get("action"), ask.get("resume", False), 0,
                stroke, ask.get("hold"), ask.get("prepare", True), ask.get("duration") or 0.0,
            )
        )  # fmt: skip
    return out


def lead(action: dict[str, Any]) -> float:
    """Seconds from an action's start to its stroke; "Phases"."""
    if action["kind"] == "gesture":
        return float(action["phases"][1] - action["start"])
    middle = (action["start"] + action["end"]) / 2.0
    stroke = middle if action["stroke"] is None else action["stroke"]
    return float(min(max(stroke, action["start"]), action["end"]) - action["start"])


@dataclass(frozen=True)
class Shape:
    """How an action would play: when, from which clip second, how long, how long at least, and its hold."""

    begin: float
    entry: float
    length: float
    least: float
    hold_from: float = 0.0
    hold_to: float = 0.0
    hold: float = 0.0


def cycle(action: dict[str, Any]) -> float:
    """ "Limits": p, 0 where an action plays once."""
    p = float(action["end"] - action["start"])
    repeats = action["kind"] in ("gesture", "fidget") and action.get("repeat", 0.0) > 0.0
    return p if repeats and p >= 0.1 else 0.0


def shape(planner: dict[str, Any], action: dict[str, Any], meta: Meta | None, now: float) -> Shape:
    """ "Phases" and "Limits"; meta: None for a hop on the way."""
    begin, entry, hold_from, hold_to, hold = now, action["start"], 0.0, 0.0, 0.0
    if meta is not None and action["kind"] == "gesture":
        ready, stroke, stroke_end, relax = action["phases"]
        latest = max(action["start"], ready - max(action["blend_in"], planner["least_blend"]))
        entry = entry if meta.prepare else latest
        if meta.stroke is not None:
            begin = max(now, meta.stroke - (stroke - entry))
            entry = min(max(entry, stroke - max(0.0, meta.stroke - begin)), max(entry, latest))
        if meta.hold is not None and not cycle(action):
            hold = max(meta.hold, (relax - stroke_end) / planner["hurry"])
            hold_from, hold_to = (stroke_end, relax) if hold > 0.0 else (0.0, 0.0)
    longer = hold - (hold_to - hold_from)
    length = least = action["end"] - entry + longer
    leave, p = action["earliest_exit"], cycle(action)
    if p > 0.0:
        s = min(action["repeat"], 60.0)
        if meta is not None and meta.timed and meta.rank != WRITTEN:
            s = meta.end - now if meta.part else meta.seconds
        length += (max(1.0, floor(min(s / p, 1e6) + 0.5)) - 1.0) * p
        leave = action["end"] if leave is None else leave
    if leave is not None:
        left = leave - entry + (longer if leave >= hold_to else 0.0)
        least = min(length, max(0.0, left) + action["blend_out"])
    return Shape(begin, entry, length, least, hold_from, hold_to, hold)


def written(character: Character, layer: str, seed: int, end: float) -> list[Meta]:
    """ "The models"."""
    graph = character.data["layers"][layer]
    model, out, state, time = graph["markov"], [], -1, 0.0
    had = {kind for kinds in graph["index"].values() for kind in kinds}
    may = [1.0 if kind in had else 0.0 for _, kind in model["states"]]
    while any(may):
        key = f"auto/{layer}/{len(out)}"
        gap = model["gap"]
        rest = log_normal(gap, 0.9 * gap, uniform(seed, key, "gap"), uniform(seed, key, "gap2"))
        start = time + min(5.0 * gap, max(gap / 5.0, rest))
        if start >= end:
            break
        row = [p * m for p, m in zip(model["matrix"][state], may, strict=True)] if state >= 0 else may
        row = row if any(row) else may
        state = int(pick(seed, key, "state", {str(n): p for n, p in enumerate(row)}))
        limb, kind = model["states"][state]
        u = uniform(seed, key, "length")
        seconds = 1.0 + 2.0 * u
        if model["lengths"]:
            seconds = log_normal(*model["lengths"][state], u, uniform(seed, key, "length2"))
        tags: tuple[str, ...] = tuple(model["tags"][state].split()) if model["tags"] else ()
        if kind == "gesture" and not model["tags"]:
            draw = uniform(seed, key, "tag")
            both = model["positive"] + model["negative"]
            tags = ("positive",) if draw < model["positive"] else ("negative",) if draw < both else ()
        out.append(Meta(key, kind, start, start + seconds, WRITTEN, start, True, tags, limb))
        time = start + seconds
    return out


def log_normal(mean: float, deviation: float, u: float, v: float) -> float:
    """ "Models"."""
    a = log(1.0 + (deviation / mean) ** 2)
    return mean * exp(sqrt(a) * sqrt(-2.0 * log(u)) * cos(2.0 * pi * v) - a / 2.0)


def performed(character: Character, layer: str, seed: int, meta: Meta) -> bool:
    """ "Meta actions": nobody said a mode and nothing is said, so the character idles."""
    modes = character.data["layers"][layer]["markov"].get("modes") or []
    if meta.rank != WRITTEN or not modes:
        return True
    share = modes[0][("gesture", "fidget", "transition").index(meta.kind)]
    return bool(share >= 1.0 or uniform(seed, meta.key, "mode") < share)


def replanned(metas: list[Meta], models: list[Meta], planner: dict[str, Any]) -> list[Meta]:
    """ "Temporal replanning"."""
    queue, placed = sorted(metas, key=order), list[Meta]()
    while queue:
        meta = queue.pop(0)
        last = placed[-1] if placed else None
        if last is None or last.end <= meta.start:
            placed.append(meta)
        elif meta.rank > last.rank:
            placed.pop()
            begun = meta.start - last.start >= planner["shortest"]
            if begun:
                placed.append(replace(last, end=meta.start))
            if last.resume and last.end - meta.end >= planner["shortest"]:
                insort(queue, replace(last, start=meta.end, part=last.part + begun), key=order)
            insort(queue, meta, key=order)
        elif last.end - meta.asked <= planner["wait"]:
            insort(queue, replace(meta, start=last.end, end=last.end + meta.end - meta.start), key=order)
    fitted: list[Meta] = []
    for meta in models:
        start, end = max(meta.start, fitted[-1].end if fitted else -inf), meta.end
        for other in placed:
            if other.start >= end or other.end <= start:
                continue
            if other.start - start >= planner["shortest"]:
                end = other.start
                break
            start = other.end
        if (start, end) == (meta.start, meta.end) or end - start >= planner["shortest"]:
            fitted.append(replace(meta, start=start, end=end))
    return sorted([*placed, *fitted], key=lambda m: (m.start, m.end))


class Sampler:
    """ "Sampling", on one layer."""

    def __init__(self, character: Character, layer: str, case: dict[str, Any]) -> None:
        self.graph, self.planner = character.data["layers"][layer], character.data["planner"]
        self.actions, self.seed = character.actions, case["seed"]
        self.layer, self.stance = layer, begins_in(character, layer, case)
        self.cues: list[dict[str, Any]] = []

    def of(self, stance: str, kind: str) -> list[dict[str, Any]]:
        """What can be drawn."""
        found = [self.actions[ident] for ident in self.graph["index"].get(stance, {}).get(kind, [])]
        return [a for a in found if a["likelihood"] > 0.0 and self.arrives(a)]

    def arrives(self, action: dict[str, Any]) -> bool:
        ends = action["end_stance"] if action["kind"] == "transition" else action["stance"]
        return bool(self.graph["index"].get(ends, {}).get("stance"))

    def way(self, goal: str) -> list[tuple[str, list[dict[str, Any]]]] | None:
        before, queue = {self.stance: self.stance}, [self.stance]
        for stance in queue:
            for action in self.of(stance, "transition"):
                if action["end_stance"] not in before:
                    before[action["end_stance"]] = stance
                    queue.append(action["end_stance"])
        if goal not in before or goal == self.stance:
            return None
        way = [goal]
        while before[way[0]] != self.stance:
            way.insert(0, before[way[0]])
        return [(to, [a for a in self.of(before[to], "transition") if a["end_stance"] == to]) for to in way]

    def drawn(self, stance: str, kind: str) -> list[str]:
        return [
            c["action"]
            for c in self.cues
            if (c["stance"], self.actions[c["action"]]["kind"]) == (stance, kind)
        ]

    def ended(self, ident: str) -> float:
        return max((cue["end"] for cue in self.cues if cue["action"] == ident), default=-inf)

    def time(self, action: dict[str, Any]) -> float:
        """ "Variety": after how long it may be done again."""
        p, variety = action.get("prominence", 0.0), self.planner["variety"]
        gestures = sum(a["kind"] == "gesture" for a in self.graph["actions"])
        b = min(180.0, max(18.0, 7.0 * gestures)) if self.layer == "arms" else 18.0
        return float(variety * (b * (360.0 / b) ** p if action["kind"] == "gesture" else 300.0 * 2.0**p))

    def acted(self) -> float:
        return float(self.cues[-1]["end"]) if self.cues else 0.0

    def rests(self, now: float) -> bool:
        """ "Bursts and rests"; nobody said a mode, so there are rests alone."""
        variety = self.planner["variety"]
        if self.layer != "arms" or variety <= 0.0 or not self.cues:
            return False
        seed, key = self.seed, self.cues[-1]["meta"]
        drawn = log_normal(8.0, 14.0, uniform(seed, key, "lull"), uniform(seed, key, "lull2"))
        return now < self.acted() + min(30.0, max(5.0, drawn) * variety)

    def rested(self, meta: Meta, every: list[dict[str, Any]], now: float) -> list[dict[str, Any]]:
        """ "Variety": what the model may do; nobody said a mode, so it idles."""
        variety = self.planner["variety"]
        if meta.kind == "transition":
            moves = [c["end"] for c in self.cues if self.actions[c["action"]]["kind"] == "transition"]
            if (
                now
                < max(moves, default=-inf) + variety * {"body": 25.0, "arms": 10.0, "head": 8.0}[self.layer]
            ):
                return []
            if self.layer == "arms" and now < self.acted() + 5.0 * variety:
                return []
            if self.layer != "head":
                return every
            start = self.graph["start"]
            if self.stance == start:
                return every if uniform(self.seed, meta.key, "leaves") < 0.2 else []
            home = [a for a in every if a["end_stance"] == start]
            return home if home and uniform(self.seed, meta.key, "home") < 0.7 else every
        long = now >= self.acted() + 30.0 * variety
        acts = [c for c in self.cues if self.actions[c["action"]]["kind"] != "transition"]
        shown = any(
            c["end"] >= now - 30.0 * variety and self.actions[c["action"]].get("prominence", 0.0) >= 0.65
            for c in acts
        )
        return [
            a
            for a in every
            if now >= self.ended(a["id"]) + self.time(a) * (0.3 if long else 1.0)
            and not (shown and a.get("prominence", 0.0) >= 0.65)
        ]

    def moves_on(self, meta: Meta, now: float) -> list[dict[str, Any]]:
        """ "Variety": what plays for a gesture if none is rested."""
        moves = [c["end"] for c in self.cues if self.actions[c["action"]]["kind"] == "transition"]
        kept = now < max(moves, default=-inf) + 10.0 * self.planner["variety"]
        kept = kept or now < self.acted() + 5.0 * self.planner["variety"]
        if self.layer != "arms" or meta.kind != "gesture" or kept:
            return []

        def has_rested(stance: str) -> bool:
            gestures = [self.actions[i] for i in self.graph["index"].get(stance, {}).get("gesture", [])]
            return any(now >= self.ended(a["id"]) + self.time(a) for a in gestures)

        return [a for a in self.of(self.stance, "transition") if has_rested(a["end_stance"])]

    def steps(self, meta: Meta, now: float) -> list[tuple[str, list[dict[str, Any]]]] | None:
        """ "Candidates": each hop with the stance it leads to, then the action itself."""
        if meta.action is not None:
            action = self.actions[meta.action]
            if action["kind"] == "stance":
                return self.way(action["stance"])
            if not self.arrives(action):
                return None
            way = [] if action["stance"] == self.stance else self.way(action["stance"])
            return None if way is None else [*way, ("", [action])]
        if meta.goal is not None:
            return self.way(meta.goal)
        every = self.of(self.stance, meta.kind)
        found = [a for a in every if set(meta.tags) <= set(a["tags"])]
        exact = [a for a in found if meta.limb in (None, a["limb"])]
        if meta.rank == WRITTEN and self.planner["variety"] > 0.0:
            rested = self.rested(meta, every, now)
            wider = ([a for a in some if a in rested] for some in (exact, found, every))
            exact, found = next((some for some in wider if some), self.moves_on(meta, now)), []
        elif meta.rank == WRITTEN:
            last = self.drawn(self.stance, meta.kind)[-1:]
            wider = (exact, found, every)
            exact = next((some for some in wider if any(a["id"] not in last for a in some)), every)
        exact = exact or found
        return [("", exact)] if exact else None

    def perform(self, metas: list[Meta], end: float) -> list[dict[str, Any]]:
        for n, meta in enumerate(metas):
            if meta.start >= end:
                break
            behind = metas[n + 1 :]
            limit = min((m.start for m in behind if m.rank > meta.rank), default=inf)
            wish = min((m.start for m in behind if m.rank >= meta.rank and m.rank > WRITTEN), default=inf)
            free = self.cues[-1]["end"] + self.planner["rest"] if self.cues else 0.0
            late = meta.timed or free - meta.asked > self.planner["wait"]
            if meta.end <= free + NEAR and meta.start < free and late:
                continue
            now = max(free, meta.start)
            if meta.rank == WRITTEN and self.rests(now):
                continue
            steps = self.steps(meta, now)
            cues = self.realised(meta, steps, now, limit, wish) if steps else []
            self.cues += cues
            self.stance = cues[-1]["then"] if cues else self.stance
        return self.cues

    def realised(
        self, meta: Meta, steps: list[tuple[str, Any]], now: float, limit: float, wish: float
    ) -> list[dict[str, Any]]:
        """The cues of a meta action, none where it cannot be."""
        cues: list[dict[str, Any]] = []
        stance = self.stance
        for hop, candidates in steps:
            shapes = {a["id"]: shape(self.planner, a, None if hop else meta, now) for a in candidates}
            left = [a for a in candidates if self.fits(shapes[a["id"]], limit)]
            if not hop and meta.action is None:
                left = [a for a in left if self.cooled(a) <= shapes[a["id"]].begin + NEAR]
            if not left:
                return []
            action = self.draw(left, f"{meta.key}/{hop}" if hop else meta.key, now)
            of = shapes[action["id"]]
            length = of.length
            if action["earliest_exit"] is not None or cycle(action) > 0.0:
                until = min(limit, inf if hop else wish)
                length = min(length, max(of.least, until - of.begin))
            into = action["blend_in"]
            if of.entry > action["start"]:
                into = max(into, self.planner["least_blend"])
            blends = into + action["blend_out"]
            squeeze = min(1.0, length / blends) if blends > 0.0 else 1.0
            then = action["end_stance"] or stance
            ends = {"cycle_from": action["start"], "cycle_to": action["end"]}
            around = ends if cycle(action) > 0.0 else {}
            cues.append(
                {
                    "action": action["id"], "start": of.begin, "end": of.begin + length, "entry": of.entry,
                    "blend_in": into * squeeze, "blend_out": action["blend_out"] * squeeze,
                    "stance": stance, "then": then, "meta": meta.key,
                    "hold_from": of.hold_from, "hold_to": of.hold_to, "hold": of.hold,
                    **around,
                }
            )  # fmt: skip
            now, stance = of.begin + length, then
        return cues

    @staticmethod
    def fits(of: Shape, limit: float) -> bool:
        """ "Limits"."""
        return of.begin + of.least <= limit + NEAR

    def cooled(self, action: dict[str, Any]) -> float:
        ends = [cue["end"] for cue in self.cues if cue["action"] == action["id"]]
        return float(ends[-1] + action["cooldown"]) if ends and action["cooldown"] > 0.0 else -inf

    def draw(self, candidates: list[dict[str, Any]], key: str, now: float) -> dict[str, Any]:
        """ "Spacing" and "Draw"."""
        before = self.drawn(candidates[0]["stance"], candidates[0]["kind"])[-32:]
        if len(candidates) > 1 and before:
            usual = 1 if self.planner["never_twice"] else 0
            needs = [usual if a["spacing"] is None else a["spacing"] for a in candidates]
            others = [before[::-1].index(a["id"]) if a["id"] in before else 32 for a in candidates]
            for less in range(max(needs) + 1):
                left = [a for a, n, o in zip(candidates, needs, others, strict=True) if o >= n - less]
                if left:
                    candidates = left
                    break
        memory = self.planner["memory"]
        since = now - memory if memory > 0.0 else -inf
        weights = {}
        for a in candidates:
            uses = sum(cue["action"] == a["id"] and cue["start"] >= since for cue in self.cues)
            weights[a["id"]] = a["likelihood"] / max(self.planner["alpha"] * uses, 1.0)
            if self.planner["variety"] > 0.0 and a["kind"] != "transition":
                weights[a["id"]] *= min(1.0, max(0.05, (now - self.ended(a["id"])) / self.time(a)))
        return self.actions[pick(self.seed, key, "action", weights)]


def cues_of(character: Character, layer: str, case: dict[str, Any]) -> list[dict[str, Any]]:
    """The cues of a layer in a case that `can_plan`."""
    sampler = Sampler(character, layer, case)
    if sampler.stance is None:
        return []
    end = case["steps"][0]["end"]
    models = written(character, layer, case["seed"], end) if case["idle"] else []
    metas = replanned(asked(character, layer, case), models, character.data["planner"])
    return sampler.perform([m for m in metas if performed(character, layer, case["seed"], m)], end)
