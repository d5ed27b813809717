"""What life adds to a pose, written alone from docs/reference, "What life adds to a pose" and the two pages
after it; each function names the headings it follows.
"""

from math import atan2, cos, exp, hypot, radians, sin, sqrt, tanh
from typing import Any

import numpy as np

from tests.engines.stranger.posing import Pose, ease, playing
from tests.engines.stranger.reading import Character
from tests.engines.stranger.rotating import Numbers, about, inverse, times, turned

USUAL = {
    "stillness": 0.0, "breathing": 1.0, "gaze": 1.0, "head_share": 0.6, "aversion_angle": 14.0,
    "saccades": 1.0, "lids": 1.0, "blink_close": 0.07, "blink_open": 0.10, "lips": 1.0, "lip_smoothing": 0.03,
    "expressions": 1.0,
}  # fmt: skip
LIDS = ("upper_lid_left", "upper_lid_right", "lower_lid_left", "lower_lid_right")
SHAPES = ("PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "I", "O", "U")
MOOD = (("valence", 0.0), ("arousal", 0.0), ("intensity", 1.0))
CHANNELS = (*LIDS, "blink", "jaw_open", *(f"viseme_{shape}" for shape in SHAPES))


def clamp(x: float, low: float, high: float) -> float:
    return min(max(x, low), high)


def sign(x: float) -> float:
    return -1.0 if x < 0.0 else 1.0


def turning(x: float, most: float, behind: float) -> float:
    """ "See the targets from the head"; the limits in degrees."""
    m, d = radians(most), radians(behind)
    return clamp(x, -m, m) * (1.0 - ease((abs(x) - d) / (np.pi - d)))


def over(a: float, m: float) -> float:
    """ "Turn the head"."""
    return sign(a) * max(abs(a) - m, 0.0)


def eyes_way(g: float, angle: float) -> float:
    """ "Share the gaze among targets"."""
    return ease(g / (0.021 + 0.0022 * angle))


def head_way(g: float, angle: float) -> float:
    """ "Share the gaze among targets"."""
    x = clamp((g - 0.04) / (0.55 + 0.006 * angle), 0.0, 1.0)
    return (1.0 - (1.0 + 8.0 * x) * exp(-8.0 * x)) / (1.0 - 9.0 * exp(-8.0))


def begun(events: list[list[Any]], t: float) -> int:
    return max((n for n, event in enumerate(events) if event[0] <= t), default=-1)


def along(row: list[float], q: Numbers) -> float:
    """ "Lids"."""
    return float(np.dot(row, q)) * (-1.0 if q[3] < 0.0 else 1.0)


# "Expressions": what a tag adds to smile, frown, brow_down, brow_up, brows.
FEELS = ("smile", "frown", "brow_down", "brow_up", "brows")
TAGGED = {
    "greeting": (0.6, 0.0, 0.0, 0.0, 0.1), "positive": (0.3, 0.0, 0.0, 0.0, 0.15),
    "agree": (0.1, 0.0, 0.0, 0.0, 0.1), "negative": (0.0, 0.2, 0.35, 0.0, 0.0),
    "surprise": (0.0, 0.0, 0.0, 0.0, 0.9),
    "question": (0.0, 0.0, 0.0, 0.0, 0.6), "unsure": (0.0, 0.3, 0.0, 0.2, 0.5),
    "thinking": (0.0, 0.1, 0.35, 0.0, 0.0),
}  # fmt: skip


def bump(x: float, rise: float, length: float) -> float:
    """ "Expressions"."""
    return ease(min(x / rise, (length - x) / (length - rise)))


class Life:
    """A character's life, with the events that were drawn for a case."""

    def __init__(self, character: Character, case: dict[str, Any]) -> None:
        self.character, self.events = character, case["life"]
        self.layers: dict[str, Any] = case["plan"]["layers"]
        self.rig: dict[str, Any] = character.data["rig"]
        self.dials: dict[str, Any] = USUAL | character.data.get("life", {})
        self.calm = 1.0 - self.dials["stillness"]
        self.left, self.up, self.ahead = (np.array(self.rig[name]) for name in ("left", "up", "ahead"))

    def breath(self, t: float) -> float:
        """ "Breath"."""
        n = begun(self.events["breaths"], t)
        if n < 0:
            return 0.0
        start, length, depth = self.events["breaths"][n]
        x = (t - start) / length
        return float(self.dials["breathing"] * self.calm * depth * ease(min(x / 0.4, (1.0 - x) / 0.6)))

    def mood(self, t: float) -> tuple[float, float, float]:
        """ "Moods", life: the mood that shows."""
        told = self.events.get("moods")
        if not told:
            return tuple(float(self.dials.get(*usual)) for usual in MOOD)  # type: ignore[return-value]
        begun_by = [1.0 if n == 0 else ease((t - start) / 1.5) for n, (start, *_) in enumerate(told)] + [0.0]
        shares = [begun_by[n] - begun_by[n + 1] for n in range(len(told))]
        v, a, i = (sum(share * row[k] for share, row in zip(shares, told, strict=True)) for k in (1, 2, 3))
        return v, a, i

    def met(self, place: int) -> tuple[Numbers, Numbers, float]:
        """Where a target is, its direction, its amount; "Share the gaze among targets"."""
        _, to, _, amount, _, _ = self.events["targets"][place]
        if isinstance(to, str):
            to = self.character.data.get("points", {}).get(to, self.rig["partner"] if to == "user" else None)
        if to is None:
            return np.array(self.rig["partner"]), self.ahead, 0.0
        return np.array(to), np.array(to) - self.rig["eyes_at_rest"], amount

    def shares(self, t: float) -> list[tuple[int, float, float]]:
        """The eyes' and the head's shares of targets, the newest first; "Share the gaze among targets"."""
        out: list[tuple[int, float, float]] = []
        came = headed = 0.0
        for place in range(begun(self.events["targets"], t), -1, -1):
            eyes = head = 1.0
            if place:
                a, b = self.met(place)[1], self.met(place - 1)[1]
                cosine = float(np.dot(a, b)) / sqrt(float(np.dot(a, a) * np.dot(b, b)))
                angle = float(np.degrees(np.arccos(clamp(cosine, -1.0, 1.0))))
                gone = t - self.events["targets"][place][0]
                eyes, head = eyes_way(gone, angle), head_way(gone, angle)
            out.append((place, eyes - came, head - headed))
            came, headed = eyes, head
            if came >= 1.0 and headed >= 1.0:
                break
        return out

    def wandering(self, t: float, shares: list[tuple[int, float, float]]) -> tuple[Numbers, Numbers]:
        """What eyes and head do besides; "Add looks away and jumps of the eyes"."""
        eyes, head = np.zeros(2), np.zeros(2)
        targets, angle = self.events["targets"], self.dials["aversion_angle"]
        n = begun(self.events["aversions"], t)
        if n >= 0:
            start, end, x, y = self.events["aversions"][n]
            k = radians(angle) * self.calm * self.dials["gaze"]
            k *= 1.0 - sum(came for place, came, _ in shares if targets[place][4])
            since = targets[shares[0][0]][2]
            if since > start:
                k *= 1.0 - ease((t - since) / 0.12)
            far = hypot(x, y) * angle
            if t - end < 0.04 + 0.55 + 0.006 * far:
                eyes += np.array([x, y]) * k * (eyes_way(t - start, far) - eyes_way(t - end, far))
                head += np.array([x, y]) * k * (head_way(t - start, far) - head_way(t - end, far))
        n = begun(self.events["saccades"], t)
        if n >= 0:
            q = np.array(self.events["saccades"][n][1:])
            p = np.array(self.events["saccades"][n - 1][1:]) if n else np.zeros(2)
            way = eyes_way(t - self.events["saccades"][n][0], float(np.linalg.norm(q - p)))
            eyes += radians(self.dials["saccades"]) * self.calm * (p + (q - p) * way)
        return eyes, head

    def look(self, t: float, chain: Numbers, places: Numbers) -> tuple[list[Numbers], list[Numbers]]:
        """Turns of the lookers, and of both eyes to the left and up. chain: its joints' rotations with
        breath, places: their translations; "See the targets from the head",
        "Turn the head", "Turn the eyes".
        """
        spun, at = [chain[0]], [places[0]]
        for q, place in zip(chain[1:], places[1:], strict=True):
            at.append(at[-1] + turned(spun[-1], place))
            spun.append(times(spun[-1], q))
        both = self.rig["eyes"]
        eye = at[-1] + turned(spun[-1], (np.array(both[0]["at"]) + both[1]["at"]) / 2.0)
        shares = self.shares(t)
        a_eyes, a_head = self.wandering(t, shares)
        total, way = np.zeros(4), a_head.copy()
        for place, came, headed in shares:
            point, _, amount = self.met(place)
            v = point - eye
            x, y, z = float(v @ self.left), float(v @ self.up), float(v @ self.ahead)
            side = turning(atan2(x, z), 110.0, 120.0)
            rise = clamp(atan2(y, hypot(x, z)), -radians(65.0), radians(65.0))
            near = 1.0 / max(float(np.linalg.norm(v)), 0.25)
            w = amount * self.dials["gaze"] * (1.0 if self.events["targets"][place][5] else self.calm)
            total += came * np.array([side, rise, near, w])
            way += headed * w * np.array([side, rise])
        turn = self.head_turn(float(way[0]), float(way[1]), float(total[3]), spun)
        lookers = self.rig["lookers"]
        turns = [looker["share"] * turned(inverse(spun[looker["place"]]), turn) for looker in lookers]
        moved, c = at[lookers[0]["place"]], 0.0
        for n, looker in enumerate(lookers):
            c += looker["share"]
            following = at[lookers[n + 1]["place"]] if n + 1 < len(lookers) else at[-1]
            moved = moved + turned(about(c * turn), following - at[looker["place"]])
        a, b = total[:2] + a_eyes
        point = self.left * sin(a) * cos(b) + self.up * sin(b) + self.ahead * cos(a) * cos(b)
        point = eye + point / max(total[2], 0.001)
        inside = turned(inverse(times(about(turn), spun[-1])), point - moved)
        out = []
        for each in both:
            v = inside - each["at"]
            xy = np.array([v @ each["left"], v @ each["up"]])
            size = float(np.linalg.norm(xy))
            away = turning(atan2(size, float(v @ each["ahead"])), 180.0, 100.0)
            ij = xy / max(size, 1e-12) * away * total[3]
            ij = ij + (1.0 - total[3]) * a_eyes
            r = hypot(ij[0] / radians(32.0), ij[1] / radians(26.0 if ij[1] > 0.0 else 30.0))
            out.append(ij if r <= 0.7 else ij * (0.7 + 0.3 * tanh((r - 0.7) / 0.3)) / r)
        return turns, out

    def head_turn(self, left: float, up: float, whole: float, spun: list[Numbers]) -> Numbers:
        """ "Turn the head"."""
        s = self.dials["head_share"]
        b = min(1.0, 2.0 * s)
        x, y = (s * a * abs(a) / (abs(a) + radians(15.0)) for a in (left, up))
        y *= 0.8
        x, y = x + b * over(left - x, radians(20.0)), y + b * over(up - y, radians(20.0))
        gaps = []
        for q, ahead in ((spun[self.rig["trunk"]], "trunk_ahead"), (spun[-1], "head_ahead")):
            f = turned(q, np.array(self.rig[ahead]))
            fx, fz = float(f @ self.left), float(f @ self.ahead)
            gap = (left - atan2(fx, fz) + np.pi) % (2.0 * np.pi) - np.pi
            gaps.append(turning(gap, 95.0, 85.0) * ease(2.0 * hypot(fx, fz)))
        apart = max(min(gaps), 0.0) + min(max(gaps), 0.0)
        x += b * whole * over(apart, max(radians(28.0), abs(left)))
        x, y = clamp(x, -radians(65.0), radians(65.0)), clamp(y, -radians(35.0), radians(30.0))
        cx, sx, cy, sy = cos(x / 2.0), sin(x / 2.0), cos(y / 2.0), -sin(y / 2.0)
        v = self.left * cx * sy + self.up * sx * cy - self.ahead * sx * sy
        size = float(np.linalg.norm(v))
        return v / max(size, 1e-12) * 2.0 * atan2(size, cx * cy)

    def blink(self, t: float) -> float:
        """ "Lids"."""
        close, opening = self.dials["blink_close"], self.dials["blink_open"]
        blinks = [(t - start, 0.6 if kind == 3.0 else 1.0) for start, kind in self.events["blinks"]]
        gone = [(x, far) for x, far in blinks if 0.0 <= x < close + opening]
        return max(
            (far * ease(min(x / close, (close + opening - x) / opening)) for x, far in gone), default=0.0
        )

    def lips(self, t: float, said: list[tuple[float, float, str]]) -> Numbers:
        """How much of each of SHAPES the mouth shows; said: start, end, line; "Lips"."""

        def shown(t: float, one: tuple[float, float, str]) -> Numbers:
            start, end, line = one
            if t < start:
                return np.zeros(len(SHAPES))
            voice = self.character.data["voices"][line]
            rows = np.array(voice["weights"])[:, 1:]
            keys = np.linspace(0.0, max(voice["duration"], 1e-3), len(rows))
            row = np.array([np.interp(min(t, end) - start, keys, each) for each in rows.T])
            return np.asarray(row * (1.0 - ease((t - end) / 0.12)))

        s = self.dials["lip_smoothing"]
        mouth = np.zeros(len(SHAPES))
        for each in said:
            now = shown(t, each)
            soft = now if s <= 0.0 else 0.25 * shown(t - s, each) + 0.5 * now + 0.25 * shown(t + s, each)
            closed = now[:2]
            room = 1.0 - soft[:2].sum()
            rest = min(1.0, max(0.0, 1.0 - closed.sum()) / room) if room > 1e-9 else 0.0
            mouth += np.concatenate([closed, rest * soft[2:]])
        return np.asarray(mouth / max(float(mouth.sum()), 1.0) * self.dials["lips"])

    def face(self, t: float, felt: dict[str, float]) -> dict[str, float]:
        """What shows beside lids and lips; felt: the mood's share; "Expressions"."""
        wide = self.dials["expressions"]
        k, s, listening = self.calm * wide, 0.0, 0.0
        n = begun(self.events["swells"], t)
        if n >= 0:
            start, length, amount, listening = self.events["swells"][n]
            s = amount * bump(t - start, 0.35 * length, length)
        out = {
            name: value * (1.0 - 0.25 * self.calm * min(1.0, wide) * (1.0 - s))
            for name, value in felt.items()
        }
        out["smile"] += 0.35 * k * listening * s * (1.0 - felt["frown"])
        recent = [each for each in self.events["emphases"] if 0.0 <= t - each[0] < 1.5]
        lifts = [amount * bump(t - start, rise, length) for start, length, amount, rise in recent]
        out["brows"] += k * max(lifts, default=0.0)
        for plan in self.layers.values():
            cue = playing(plan, t)
            if cue is None or not cue["start"] < t < min(cue["end"], cue["start"] + 1.8):
                continue
            gone, left = t - cue["start"], min(cue["end"], cue["start"] + 1.8) - t
            c = k * ease(min(gone / 0.25, left / 0.6))
            for tag in self.character.actions[cue["action"]].get("tags", []):
                for name, share in zip(FEELS, TAGGED.get(tag, (0.0,) * 5), strict=True):
                    out[name] += c * share
                if tag == "greeting":
                    out["brows"] += k * bump(gone - 0.1, 0.08, 0.4)
        out = {name: clamp(value, 0.0, 1.0) for name, value in out.items()}
        return out | {"cheeks": clamp((out["smile"] - 0.2) / 0.8, 0.0, 1.0)}

    def added(
        self, composed: Pose, t: float, said: list[tuple[float, float, str]]
    ) -> tuple[Pose, dict[str, float]]:
        """The pose with life, and what it adds to morph targets; "Breath", "Posture", "Turn the eyes",
        "Lids", "Joints of the face", "Morph targets".
        """
        rotations, translations = composed[0].copy(), composed[1].copy()
        chain, full = self.rig["chain"], self.breath(t)
        v, a, i = self.mood(t)
        up, down_, well, ill = max(0.0, a), max(0.0, -a), max(0.0, v), max(0.0, -v)
        droop = clamp(i * (-0.7 * v - 0.5 * a), -0.4, 1.0)
        bowed, thrusts = (self.rig.get(name) or [0.0] * len(chain) for name in ("bowed", "thrust"))
        excited = min(1.0, 1.25 * up)
        fear = excited * ease((-v - 0.15) / 0.18)
        anger = excited * ease((-v - 0.02) / 0.1) - fear
        thrust = clamp(i * (0.3 * up * max(0.0, 0.3 - v) + 0.9 * anger - 0.7 * fear), -1.0, 1.0)
        tension = clamp(i * 1.2 * up * max(0.0, 1.0 - 2.0 * well) * (1.0 - 0.8 * fear), 0.0, 1.0)
        close = clamp(i * (0.5 * fear + 0.4 * ill * (1.0 - up)), 0.0, 1.0)
        for joint, (*axis, angle), bow, lean in zip(chain, self.rig["breath"], bowed, thrusts, strict=True):
            turn = full * angle + droop * bow + thrust * lean
            rotations[joint] = times(rotations[joint], about(turn * np.array(axis)))
        lift = 2.0 * up * (1.0 - well) + 4.5 * fear - 1.5 * down_ - ill * (1.0 - up)
        full += clamp(i * lift, -2.0, 6.0)
        for shoulder in self.rig["shoulders"]:
            joint = shoulder["joint"]
            turn = full * np.array(shoulder["turn"])
            for name, much in (("tense", tension), ("closed", close)):
                turn = turn + much * np.array(shoulder.get(name) or [0.0, 0, 0])
            rotations[joint] = times(rotations[joint], about(turn))
        ij = [np.zeros(2), np.zeros(2)]
        if self.rig["lookers"] and self.events["targets"]:
            turns, ij = self.look(t, rotations[chain], translations[chain])
            for looker, turn in zip(self.rig["lookers"], turns, strict=True):
                joint = chain[looker["place"]]
                rotations[joint] = times(rotations[joint], about(turn))
        down = [-float(each[1]) for each in ij]
        for side, eye in enumerate(self.rig["eyes"]):
            if eye["joint"] >= 0:
                joint = eye["joint"]
                down[side] += along(eye["down"], composed[0][joint])
                turn = ij[side][0] * np.array(eye["turn_left"]) + ij[side][1] * np.array(eye["turn_up"])
                rotations[joint] = times(rotations[joint], about(turn))
        face, blink = self.rig["face"], self.blink(t)
        lids = clamp(i * (0.5 * down_ - 0.5 * fear - 0.15 * anger - 1.1 * up * well), -0.6, 0.5)
        blink = max(blink, lids) if lids > 0.0 else blink + lids * (1.0 - blink)
        any_lid = max(face["lid_joints"]) >= 0
        follows = face["follows"] if any_lid else [0.6 / radians(40.0)] * 2 + [0.0, 0.0]
        shut, own = [], []
        for n, joint in enumerate(face["lid_joints"]):
            already = along(face["shut_by"][n], composed[0][joint]) if joint >= 0 else 0.0
            closed = clamp(already + self.dials["lids"] * follows[n] * down[n % 2], -0.8, 1.0)
            closed += blink * (1.0 - closed)
            shut.append(closed)
            own.append(closed - already)
        lips = self.lips(t, said)
        values = np.array([*own, blink, 0.0, *lips])
        for place, joint in enumerate(face["joints"]):
            turn = values @ np.array(face["turns"])[:, place]
            rotations[joint] = times(rotations[joint], about(turn))
            translations[joint] += values @ np.array(face["shifts"])[:, place]
        feels = {
            "smile": i * well * (1.2 + 0.3 * up - 0.6 * down_),
            "frown": i * (1.4 * ill * (1.0 - up) * (1.0 - 0.6 * down_) + 0.35 * anger + 0.4 * fear),
            "brow_down": i * (0.5 * up * max(0.0, 0.4 - v) + 0.8 * anger) * (1.0 - fear),
            "brow_up": i * (2.0 * ill * (1.0 - up) * (1.0 - down_) + 0.9 * fear),
            "brows": i * (0.6 * fear + 1.6 * up * well),
        }
        named = self.face(t, {name: clamp(value, 0.0, 1.0) for name, value in feels.items()})
        named |= dict(zip(CHANNELS, values, strict=True)) | {"blink": max(blink, (shut[0] + shut[1]) / 2.0)}
        for n, side in enumerate(("left", "right")):
            left, high = ij[n] / radians(30.0)
            named |= {f"blink_{side}": shut[n], f"wide_{side}": -0.6 * shut[n]}
            named |= {f"look_left_{side}": left, f"look_right_{side}": -left}
            named |= {f"look_up_{side}": high, f"look_down_{side}": -high}
        morphs: dict[str, float] = {}
        for channel, targets in face["morphs"].items():
            value = float(named.get(channel, 0.0))
            for target, weight in targets.items() if value > 0.0001 else ():
                morphs[target] = morphs.get(target, 0.0) + value * weight
        return (rotations, translations), {name: min(value, 1.0) for name, value in morphs.items()}
