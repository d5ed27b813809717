"""Single rules, asked with numbers and texts alone: what vectors ask beside plans and poses, so that each
rule of geometry, of the mouth, of moods and of times meets both sides of its boundaries.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor

from metagraph.graph.face.names import VISEMES
from metagraph.motion.contact_solve import (
    BodyCapsule,
    ContactArm,
    ContactPose,
    ContactRig,
    HandGoal,
    apart,
    bring,
    capsule_ends,
    solve_contacts,
    spread,
)
from metagraph.motion.contact_spans import ContactKey, ContactSpan, contact_key, contact_weight
from metagraph.motion.feet_solve import FootGoal, foot_way, plant_feet
from metagraph.motion.plain_vectors import Quaternion, Vector, between, unit, unit_turn
from metagraph.motion.weight_solve import (
    WeightBend,
    WeightCollar,
    WeightRig,
    answer_arms,
    hips_sink,
    stands_by,
)
from metagraph.playback.life.alphabet import Alphabet
from metagraph.playback.life.graphemes import (
    Spelled,
    measure_letter,
    read_aloud,
    spelled,
)
from metagraph.playback.life.line_timing import (
    LineTiming,
    SpokenWord,
    VisemeMark,
    alike_timings,
    comes_late,
    extended,
    join_letters,
    pace_text,
    place_told,
    restarts,
    set_of,
    shifted,
    tells_on,
    timed_seconds,
    timed_sounds,
    timing_of,
    wrong_in,
)
from metagraph.playback.life.mouth import MouthPiece, accents_of, mouth_track, soften
from metagraph.playback.planning.choice import log_normal
from metagraph.playback.planning.director import (
    beat_interval,
    find_lull,
    freshness,
    posture,
    repeat_interval,
)
from metagraph.playback.planning.hashing import Bits
from metagraph.playback.planning.mood import (
    Mood,
    MoodFrom,
    Moods,
    anger,
    bearing,
    changed,
    distance,
    drag,
    extent,
    faded,
    favour,
    fear,
    lasting,
    leaning,
    life_of,
    liveliness,
    made_for,
    mood_at,
    mood_edges,
    shown,
    shut_in,
    stirs,
    tempo,
    turn_extent,
)
from metagraph.playback.posing.cue_times import ease
from metagraph.playback.posing.follow_through import driven
from metagraph.playback.posing.planted_feet import FootTrack, foot_row, stepped

OPEN = 1e9  # in the place of an end that is not known


@dataclass
class RuleInput:
    """What a rule is asked with: numbers and texts, which are taken one after the other."""

    numbers: Sequence[float]
    texts: Sequence[str]
    at: int = 0
    told: int = 0

    def number(self) -> float:
        """Take the next number."""
        self.at += 1
        return self.numbers[self.at - 1]

    def text(self) -> str:
        """Take the next text."""
        self.told += 1
        return self.texts[self.told - 1]


def answer_rule(
    alphabet: Alphabet, seed: Bits, rule: str, numbers: Sequence[float], texts: Sequence[str]
) -> list[float]:
    """Return what a rule makes of numbers and texts; nothing for a rule that is not known."""
    given = RuleInput(numbers, texts)
    if rule in ("between", "apart", "unit", "contacts", "bring", "weight", "feet"):
        return _geometry(rule, given)
    if rule in ("way", "steps", "track", "driven", "span", "key"):
        return _places(rule, given)
    if rule in ("mouth", "soften", "accents", "spelled", "letters"):
        return _mouth(alphabet, rule, given)
    if rule in ("timing", "piece"):
        return _timing(alphabet, rule, given)
    if rule in ("mood", "moods", "shown", "lasting"):
        return _mood(seed, rule, given)
    return _times(seed, rule, given)


def _vector(given: RuleInput) -> Vector:
    x = given.number()
    y = given.number()
    z = given.number()
    return (x, y, z)


def _turn(given: RuleInput) -> Quaternion:
    x = given.number()
    y = given.number()
    z = given.number()
    w = given.number()
    return unit_turn((x, y, z, w))


def _count(given: RuleInput) -> int:
    return floor(given.number() + 0.5)


def _put(out: list[float], v: Vector) -> None:
    x, y, z = v
    out.extend([x, y, z])


def _put_turn(out: list[float], q: Quaternion) -> None:
    x, y, z, w = q
    out.extend([x, y, z, w])


# --- limbs


def _rig(given: RuleInput, pose: ContactPose) -> ContactRig:
    """Read a rig and a pose of it."""
    parents: list[int] = []
    joints: list[int] = []
    size = _count(given)
    for n in range(size):
        joints.append(n)
        parents.append(_count(given))
        pose.moved.append(_vector(given))
        pose.local.append(_turn(given))
    limbs: list[ContactArm] = []
    for _side in range(2):
        upper = _count(given)
        lower = _count(given)
        hand = _count(given)
        below: list[int] = []
        size = _count(given)
        for _n in range(size):
            below.append(_count(given))
        limbs.append(ContactArm(upper, lower, hand, tuple(below)))
    capsules: list[BodyCapsule] = []
    size = _count(given)
    for _n in range(size):
        joint = _count(given)
        a = _vector(given)
        to = _count(given)
        b = _vector(given)
        radius = given.number()
        arm = _count(given)
        capsules.append(BodyCapsule(joint, a, to, b, radius, arm, _count(given)))
    guard = given.number() > 0.0
    places: dict[str, int] = {}
    return ContactRig(
        tuple(joints), tuple(parents), places, tuple(limbs), ("left", "right"), tuple(capsules), True, guard
    )


def _weight_rig(given: RuleInput, body: ContactRig) -> WeightRig:
    bends: list[WeightBend] = []
    size = _count(given)
    for _n in range(size):
        place = _count(given)
        left = _vector(given)
        up = _vector(given)
        ahead = _vector(given)
        bends.append(WeightBend(place, left, up, ahead, given.number()))
    collars: list[WeightCollar] = []
    size = _count(given)
    for _n in range(size):
        place = _count(given)
        upper = _count(given)
        axis = _vector(given)
        collars.append(WeightCollar(place, upper, axis, _count(given)))
    knees: list[Vector] = []
    levers: list[tuple[float, float]] = []
    for _side in range(2):
        knees.append(_vector(given))
        aside = given.number()
        levers.append((aside, given.number()))
    height = given.number()
    return WeightRig(
        body,
        tuple(bends),
        tuple(collars),
        tuple(knees),
        tuple(levers),
        (0.0, 1.0, 0.0),
        height,
        given.number(),
    )


def _posed(pose: ContactPose) -> list[float]:
    out: list[float] = []
    for place in range(len(pose.local)):
        _put_turn(out, pose.local[place])
        _put(out, pose.at[place])
    return out


def _geometry(rule: str, given: RuleInput) -> list[float]:
    out: list[float] = []
    if rule == "between":
        a = unit(_vector(given))
        _put_turn(out, between(a, unit(_vector(given))))
    elif rule == "unit":
        _put(out, unit(_vector(given)))
        _put_turn(out, _turn(given))
    elif rule == "apart":
        ends: list[Vector] = []
        for _n in range(4):
            ends.append(_vector(given))
        _put_turn(out, apart(ends, 0, 2))
    else:
        pose = ContactPose()
        rig = _rig(given, pose)
        spread(rig, pose)
        moved = False
        if rule == "bring":
            side = _count(given)
            goal = _vector(given)
            turn = _turn(given)
            bring(rig, pose, side, goal, turn, _vector(given))
        elif rule == "contacts":
            goals: list[HandGoal] = []
            size = _count(given)
            for _n in range(size):
                arm = _count(given)
                to = _count(given)
                at = _vector(given)
                turn = _turn(given)
                goals.append(HandGoal(arm, to, at, turn, given.number()))
            moved = solve_contacts(rig, pose, goals)
            for end in capsule_ends(rig, pose):
                _put(out, end)
        else:
            body = _weight_rig(given, rig)
            out.append(stands_by(body, pose))
            if rule == "weight":
                drive: list[float] = []
                for _n in range(16):
                    drive.append(given.number())
                follow = given.number()
                moved = answer_arms(body, pose, drive, follow, given.number())
            else:
                for side in range(2):
                    foot = _vector(given)
                    reach = given.number()
                    out.append(hips_sink(body, pose, side, foot, reach, given.number()))
                feet: list[FootGoal] = []
                size = _count(given)
                for _n in range(size):
                    feet.append(_foot(given))
                moved = plant_feet(body, pose, feet, given.number())
        out.append(1.0 if moved else 0.0)
        spread(rig, pose)
        out.extend(_posed(pose))
    return out


# --- where hands and feet are


def _foot(given: RuleInput) -> FootGoal:
    at = _vector(given)
    turn = _turn(given)
    planted = given.number()
    return FootGoal(at, turn, planted, given.number())


def _feet(given: RuleInput) -> list[FootGoal]:
    out: list[FootGoal] = []
    size = _count(given)
    for _n in range(size):
        out.append(_foot(given))
    return out


def _put_feet(out: list[float], feet: Sequence[FootGoal]) -> None:
    for foot in feet:
        _put(out, foot.at)
        _put_turn(out, foot.turn)
        out.extend([foot.planted, foot.lift])


def _rows(given: RuleInput, count: int, width: int) -> list[list[float]]:
    out: list[list[float]] = []
    for _n in range(count):
        row: list[float] = []
        for _k in range(width):
            row.append(given.number())
        out.append(row)
    return out


def _span(given: RuleInput) -> ContactSpan:
    start = given.number()
    end = given.number()
    ease_in = given.number()
    ease_out = given.number()
    keys: list[ContactKey] = []
    size = _count(given)
    for _n in range(size):
        time = given.number()
        at = _vector(given)
        keys.append(ContactKey(time, at, _turn(given)))
    return ContactSpan("left", "palm", "Chest", start, end, tuple(keys), ease_in, ease_out)


def _places(rule: str, given: RuleInput) -> list[float]:
    out: list[float] = []
    if rule == "way":
        one = _foot(given)
        out.append(foot_way(one, _foot(given)))
    elif rule == "steps":
        height = given.number()
        before = _feet(given)
        after = _feet(given)
        first = _feet(given)
        last = _feet(given)
        passed = given.number()
        _put_feet(out, stepped(height, before, after, first, last, passed, given.number()))
    elif rule == "track":
        rows = _rows(given, _count(given), 16)
        _put_feet(out, foot_row(FootTrack(rows), given.number()))
    elif rule == "driven":
        sways = _rows(given, 4, 8)
        out.extend(driven(sways, given.number()))
    elif rule == "span":
        span = _span(given)
        first_ = given.number()
        last_ = given.number()
        size = _count(given)
        for _n in range(size):
            out.append(contact_weight(span, given.number(), first_, last_))
    else:
        span = _span(given)
        size = _count(given)
        for _n in range(size):
            key = contact_key(span, given.number())
            out.append(key.time)
            _put(out, key.at)
            _put_turn(out, key.turn)
    return out


# --- the mouth


def _put_spelled(out: list[float], found: Spelled) -> None:
    for piece in found.pieces:
        out.extend([piece.start, piece.end, float(VISEMES.index(piece.viseme)), piece.strength])
    out.extend(found.peaks)
    out.extend(found.strengths)


def _mouth(alphabet: Alphabet, rule: str, given: RuleInput) -> list[float]:
    out: list[float] = []
    if rule == "mouth":
        pieces: list[MouthPiece] = []
        size = _count(given)
        for _n in range(size):
            start = given.number()
            end = given.number()
            strength = given.number()
            pieces.append(MouthPiece(start, end, given.text(), strength))
        for row in mouth_track(pieces, given.number()):
            out.extend(row)
    elif rule == "soften":
        rows = _rows(given, 3, 14)
        out.extend(rows[1])
        soften(out, rows[0], rows[1], rows[2])
    elif rule == "accents":
        count = _count(given)
        rows = _rows(given, 2, count)
        out.extend(accents_of(rows[0], rows[1]))
    elif rule == "letters":
        size = _count(given)
        for _n in range(size):
            out.append(measure_letter(_count(given)))
    else:
        text = given.text()
        out.append(read_aloud(alphabet, text))
        _put_spelled(out, spelled(alphabet, text, given.number()))
    return out


# --- the times of lines


def _line(given: RuleInput) -> LineTiming:
    words: list[SpokenWord] = []
    size = _count(given)
    for _n in range(size):
        start = given.number()
        end = given.number()
        words.append(SpokenWord(given.text(), start, None if end >= OPEN else end))
    marks: list[VisemeMark] = []
    size = _count(given)
    for _n in range(size):
        at = given.number()
        weight = given.number()
        marks.append(VisemeMark(at, given.text(), weight))
    return LineTiming(tuple(words), tuple(marks), given.number())


def _put_line(alphabet: Alphabet, out: list[float], line: LineTiming) -> None:
    for word in line.words:
        out.extend(
            [word.start, OPEN if word.end is None else word.end, float(len(alphabet.letters(word.text)))]
        )
    for mark in line.marks:
        out.extend([mark.at, float(len(mark.viseme)), mark.weight])
    out.append(line.later)


def _yes(which: bool) -> float:
    return 1.0 if which else 0.0


def _timing(alphabet: Alphabet, rule: str, given: RuleInput) -> list[float]:
    out: list[float] = []
    if rule == "timing":
        name = given.text()
        duration = given.number()
        raw = _line(given)
        wrong = wrong_in(raw.words, raw.marks, name, None if duration >= OPEN else duration)
        out.extend([float(len(wrong)), float(len(set_of(raw.marks)))])
        _put_line(alphabet, out, LineTiming(tuple(join_letters(alphabet, raw.words))))
        paced = pace_text(alphabet, given.text(), None if duration >= OPEN else duration)
        _put_line(alphabet, out, paced)
        if wrong != "":
            return out
        line = timing_of(alphabet, raw.words, raw.marks, name)
        _put_line(alphabet, out, line)
        _put_line(alphabet, out, shifted(line, 0.5))
        out.append(timed_seconds(line, None if duration >= OPEN else duration))
        _put_spelled(out, timed_sounds(alphabet, line))
    else:
        old = _line(given)
        new = _line(given)
        said = given.number()
        out.append(_yes(alike_timings(old, new)))
        out.append(_yes(alike_timings(old, None)))
        out.append(_yes(alike_timings(None, None)))
        out.append(_yes(tells_on(old, new)))
        out.append(_yes(restarts(old, new, said)))
        first = given.number()
        last = given.number()
        out.append(_yes(comes_late(first, last, given.number(), said)))
        _put_line(alphabet, out, place_told(old, new, said))
        _put_line(alphabet, out, extended(old, new, said))
    return out


# --- moods


def _mood_of(given: RuleInput) -> Mood:
    valence = given.number()
    arousal = given.number()
    return Mood(valence, arousal, given.number())


def _told(given: RuleInput) -> list[MoodFrom]:
    """Read moods; numbers above 8 stand for what is not told."""
    out: list[MoodFrom] = []
    size = _count(given)
    for _n in range(size):
        start = given.number()
        valence = given.number()
        arousal = given.number()
        intensity = given.number()
        end = given.number()
        out.append(
            MoodFrom(
                "told",
                start,
                None if valence > 8 else valence,
                None if arousal > 8 else arousal,
                None if intensity > 8 else intensity,
                float("inf") if end >= OPEN else end,
            )
        )
    return out


def _put_mood(out: list[float], mood: Mood) -> None:
    out.extend([mood.valence, mood.arousal, mood.intensity])


def _mood(seed: Bits, rule: str, given: RuleInput) -> list[float]:
    out: list[float] = []
    if rule == "mood":
        mood = _mood_of(given)
        tags = [given.text(), given.text()]
        life = life_of(mood)
        how = bearing(mood)
        out.extend([liveliness(mood), fear(mood), anger(mood), extent(mood), tempo(mood)])
        out.extend([life.breathing, life.breath_rate, life.aversion_rate, life.saccade_rate, life.blinks])
        out.extend([how.droop, how.lift, how.lids, how.smile, how.frown, how.brow_down])
        out.extend([how.brow_up, how.thrust, how.tension, how.brows, how.closed])
        out.append(favour(mood, tags, given.number()))
        out.append(_yes(made_for(mood, tags)))
        out.append(distance(mood, "happy"))
        for n in range(4):
            out.append(_yes(stirs(mood, seed, f"{tags[0]}{n}")))
        valence = given.number()
        arousal = given.number()
        _put_mood(out, changed(mood, valence, arousal, given.number()))
    elif rule == "moods":
        base = _mood_of(given)
        moods = Moods(base, _told(given))
        start = given.number()
        edges = mood_edges(moods, start, given.number())
        out.extend(edges)
        for edge in edges:
            _put_mood(out, mood_at(moods, edge))
    elif rule == "shown":
        count = _count(given)
        starts = _rows(given, 1, count)
        values = _rows(given, count, 3)
        _put_mood(out, shown(starts[0], values, given.number()))
    else:
        told = _told(given)
        for one in lasting(told, given.number()):
            out.extend([one.start, OPEN if one.end > OPEN else one.end])
    return out


# --- times


def _times(seed: Bits, rule: str, given: RuleInput) -> list[float]:
    out: list[float] = []
    if rule == "lull":
        key = given.text()
        talks = given.number() > 0.0
        out.append(find_lull(seed, key, talks, given.number()))
    elif rule == "intervals":
        count = _count(given)
        share = given.number()
        beats = beat_interval("arms", count)
        out.extend([beats, beat_interval("head", count), posture("body"), posture("arms"), posture("head")])
        out.extend([repeat_interval("gesture", share, beats), repeat_interval("fidget", share, beats)])
        out.append(freshness(given.number(), beats))
    elif rule == "curves":
        x = given.number()
        out.extend([faded(x), ease(x), leaning(x, 4.0), turn_extent(1.25, x)])
        out.extend([shut_in(0.25, x), shut_in(0.75, x), drag(2.0, 1.0 + 0.5 * x * x)])
        out.append(log_normal(8.0, 14.0, 0.25 + 0.125 * x * x, 0.5))
    return out
