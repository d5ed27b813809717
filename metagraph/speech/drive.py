"""Make requests for the characters from a conversation's segments: gestures with clauses, nods with responses
and hesitations.

Which segments get one is drawn with observed rates (Yang et al., table 1), each by a key of its own: changing
one segment leaves the draws of the others unchanged. A gesture's stroke is requested at its clause's F0 peak,
and the gestures are chosen together (`gesture_choice`), so that as many are performed as are drawn.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence

from metagraph.graph.conversation.model import Conversation, Segment, list_other_sides, list_segments_heard_by
from metagraph.graph.model import Action, Layer, Project
from metagraph.graph.requests import (
    AnyRequest,
    Behave,
    Blink,
    Change,
    Fidget,
    Gesture,
    Go,
    Look,
    Nod,
    Performance,
    Place,
    Play,
    Point,
    Say,
)
from metagraph.playback.life.wanted import PARTNER as USER
from metagraph.playback.plan import Cue, Plan
from metagraph.playback.planning.choice import uniform
from metagraph.playback.planning.running_plan import plan_performance
from metagraph.playback.timing.phases import find_phases
from metagraph.speech.addressing import TURN, find_speaking_spans
from metagraph.speech.arm_stances import ArmStances, place_arm_stances
from metagraph.speech.gesture_choice import GestureClause, choose_gestures, find_gesture_family
from metagraph.speech.group_gaze import list_looks
from metagraph.speech.mode_spans import list_modes
from metagraph.speech.peak_blinks import place_peak_blinks
from metagraph.speech.turn_cues import LISTEN, look_at_turns, place_clause_nods

PARTNER = "partner"  # named point of the other's head; if there are several, with a number from 1
TOLERANCE = 0.1  # seconds by which a stroke may miss its peak (section 7.2)
ROUNDS = 12  # rounds in which requests that would be late are removed
CLAUSE, ANSWER, FILL = 3, 2, 1  # priorities: own clauses, then answers, then fillers
HEAD: Point = (0.0, 1.6, 1.3)  # metres: where a partner's head is if its height is unknown
PLAIN = ("beat", "explain", "open")  # tags of gestures that go with any words
REST = 3.5  # seconds without requests after which a character may fidget
FIDGETS = 0.5  # how often it does
# Seconds before and after a gesture of another side in which others of its family are chosen less: the less
# the nearer, not at all within 6 s if there is another.
ECHO = 30.0
NEAR_ECHO = 6.0
# how often the body changes its stance when its side begins to speak, where most shifts of posture are
# (Cassell et al. 2001)
SHIFTS = 0.4


def drive_side(
    conversation: Conversation,
    side: int,
    project: Project,
    line: str | None = None,
    heads: Sequence[Point] = (HEAD,),
    together: bool = True,
    others: Sequence[Plan] = (),
) -> list[AnyRequest]:
    """Return the requests for a side. `project` has the graph that moves it. `line` is the project's line
    with its voice. `heads` says where the others' heads are, in metres in this side's space, in the order of
    their numbers; the last is used for missing ones. With `together`, gestures are chosen so that all have
    room; otherwise each is requested on its own, and many cannot be played. `others` are plans of other sides
    whose gestures are not echoed.
    """
    out = list(_looks(conversation, side, heads))
    if line is not None:
        out.append(Say(id="voice", at=0.0, line=line, gestures=False))
    out += [
        Behave(id=f"mode {n}", at=at, mode=mode)
        for n, (at, mode) in enumerate(list_modes(conversation, side))
    ]
    if conversation.blinks == "peaks":
        peaks = [s.peak for s in conversation.sides[side].segments if s.peak is not None]
        found = place_peak_blinks(peaks, conversation.length, conversation.seed, str(side))
        out += [Blink(id=f"blink {n}", at=at) for n, at in enumerate(found)]
    kinds = {layer: {kind for _, kind in project.graphs[layer].index} for layer in project.graphs}
    nods = "gesture" in kinds["head"]
    heard = list_segments_heard_by(conversation, side)
    arms = place_arm_stances(conversation, side, project.graphs["arms"])
    meanings = {stance: _meanings(project, stance) for stance in dict.fromkeys(arms.stances)}
    busy = [(s.start, s.end) for s in conversation.sides[side].segments]
    drawn = draw_segments(conversation, side)
    tags = {
        key: _tags(meanings[arms.at(s.start)], s.text, uniform(conversation.seed, str(side), key, "tags"))
        for key, s in key_segments(heard)
        if s.kind == "clause"
    }
    if together and "gesture" in kinds["arms"]:
        out += _chosen(conversation, side, project, arms, drawn, tags, others)
    for key, s in key_segments(heard):
        if key not in drawn:
            continue
        if s.kind == "clause" and "gesture" in kinds["arms"] and not together:
            out.append(
                Gesture(id=key, at=s.start, stroke=find_clause_peak(s), tags=tags[key], priority=CLAUSE)
            )
        elif s.kind != "clause" and nods:
            out.append(Nod(id=key, at=s.start, priority=ANSWER))
            busy.append((s.start, s.end + 1.0))
    if nods:
        head = project.graphs["head"]
        small = any(LISTEN in a.tags for a in head.of(head.start or "", "gesture"))
        listened = list(place_clause_nods(conversation, side, small))
        out += listened
        busy += [(nod.at or 0.0, (nod.at or 0.0) + 1.0) for nod in listened]
    if "transition" in kinds["body"]:
        own = find_speaking_spans(conversation.sides[side].segments)
        for n, (start, end) in enumerate(own):
            if end - start > TURN and uniform(conversation.seed, str(side), f"shift {n}") < SHIFTS:
                out.append(
                    Change(id=f"shift {n}", at=max(0.0, round(start - 0.3, 3)), layer="body", priority=FILL)
                )
    for n, (at, stance) in enumerate(zip(arms.starts, arms.stances, strict=True)):
        if n > 0:
            out.append(Go(id=f"arms {n}", at=at, layer="arms", stance=stance, priority=FILL))
            busy.append((at, at + REST))
    layer: Layer = "arms" if "fidget" in kinds["arms"] else "body"
    return [*out, *(_fidgets(conversation, side, busy, layer) if "fidget" in kinds[layer] else ())]


def _fidgets(
    conversation: Conversation, side: int, busy: Sequence[tuple[float, float]], layer: Layer
) -> Iterator[Fidget]:
    """Yield fidgets of a side where nothing else is requested."""
    for n, (start, end) in enumerate(_gaps(sorted(busy), conversation.length)):
        if uniform(conversation.seed, str(side), f"fidget {n}") < FIDGETS:
            at = start + (0.2 + 0.5 * uniform(conversation.seed, str(side), f"when {n}")) * (
                end - start - 2.0
            )
            yield Fidget(id=f"fidget {n}", at=round(at, 3), layer=layer, priority=FILL)


def _looks(conversation: Conversation, side: int, heads: Sequence[Point]) -> Iterator[AnyRequest]:
    """Yield where the others' heads are, and who is looked at when."""
    others = list_other_sides(conversation, side)
    if len(others) == 1:
        yield Place(id=PARTNER, at=0.0, name=PARTNER, point=heads[0])
        # After a timed look, the gaze comes back to whom the character talks with: there, too.
        yield Place(id=USER, at=0.0, name=USER, point=heads[0])
        yield Look(id="look", at=0.0, to=PARTNER)
        yield from look_at_turns(conversation, side, PARTNER, heads[0])
        return
    for n, other in enumerate(others):
        name = f"{PARTNER} {other + 1}"
        yield Place(id=name, at=0.0, name=name, point=heads[min(n, len(heads) - 1)])
    for n, look in enumerate(list_looks(conversation, side)):
        yield Look(id=f"look {n}", at=look.at, to=f"{PARTNER} {look.side + 1}")


def find_partner_points(plan: Plan) -> dict[int, Point]:
    """Return where the others' heads are in the plan of one of three or more, by the others' numbers."""
    named = ((p.name.removeprefix(f"{PARTNER} "), p.point) for p in plan.track.places)
    return {int(number) - 1: point for number, point in named if number.isdecimal()}


def draw_segments(conversation: Conversation, side: int) -> frozenset[str]:
    """Return the keys of the segments that are drawn to get a movement, by the side's rates."""
    rates = conversation.sides[side].rates
    return frozenset(
        key
        for key, s in key_segments(list_segments_heard_by(conversation, side))
        if s.kind != "idle" and uniform(conversation.seed, str(side), key) < getattr(rates, s.kind)
    )


def find_clause_peak(segment: Segment) -> float:
    """Return where a clause's stress is, its middle if that is unknown."""
    return (segment.start + segment.end) / 2 if segment.peak is None else segment.peak


def _chosen(
    conversation: Conversation,
    side: int,
    project: Project,
    arms: ArmStances,
    drawn: Collection[str],
    tags: Mapping[str, tuple[str, ...]],
    others: Sequence[Plan],
) -> Iterator[AnyRequest]:
    """Yield the gestures that go with a side's clauses: by what they should mean if any such gesture has
    room, else by name.
    """
    graph = project.graphs["arms"]
    usable: dict[str, list[Action]] = {}
    for stance in arms.stances:
        every = [a for a in graph.of(stance, "gesture") if a.likelihood > 0]
        usable[stance] = [a for a in every if a.cooldown <= 0] or every
    theirs = [c for plan in others for c in plan.layers["arms"].cues if c.action.kind == "gesture"]
    said = [
        (key, s) for key, s in key_segments(list_segments_heard_by(conversation, side)) if s.kind == "clause"
    ]
    clauses = [
        GestureClause(
            key,
            find_clause_peak(s),
            key in drawn,
            _fitting(usable[arms.at(s.start)], tags[key]),
            _echoes(theirs, find_clause_peak(s)),
        )
        for key, s in said
    ]
    for one in choose_gestures(project, clauses, conversation.seed, conversation.length):
        (key, s), clause = said[one.clause], clauses[one.clause]
        if one.free and clause.wanted and not any(near >= 1 for near in clause.echoes.values()):
            meant = tags[key] if set(tags[key]) - set(PLAIN) else one.action.tags
            meant = tuple(tag for tag in meant if tag in (*PLAIN, *tags[key]))[:1]
            yield Gesture(id=key, at=s.start, stroke=clause.peak, tags=meant, priority=CLAUSE)
        else:
            yield Play(
                id=key, at=s.start, layer="arms", action=one.action.id, stroke=clause.peak, hold=one.hold,
                priority=CLAUSE,
            )  # fmt: skip


def _echoes(theirs: Sequence[Cue], at: float) -> dict[str, float]:
    """Return how near others' gestures are to a time, 0..1, by family; 1 within NEAR_ECHO seconds."""
    out: dict[str, float] = {}
    for cue in theirs:
        away = max(cue.start - at, at - cue.end, 0.0)
        near = min(1.0, (ECHO - away) / (ECHO - NEAR_ECHO))
        family = find_gesture_family(cue.action.name)
        if near > out.get(family, 0.0):
            out[family] = near
    return out


def _fitting(every: Sequence[Action], tags: Collection[str]) -> Sequence[Action]:
    """Return the gestures with a meaning; for plain tags, all plain gestures."""
    if set(tags) <= set(PLAIN):
        return [a for a in every if set(PLAIN) & set(a.tags)] or every
    return [a for a in every if set(tags) <= set(a.tags)] or every


def _meanings(project: Project, stance: str) -> Counter[str]:
    """Return the tags of the gestures in a stance of the arms, and how many have each."""
    graph = project.graphs["arms"]
    return Counter(tag for action in graph.of(stance, "gesture") for tag in action.tags)


def _tags(meanings: Counter[str], text: str, drawn: float) -> tuple[str, ...]:
    """Return what a clause's gesture should mean: what one of its words says, else nothing in particular: a
    beat, or an explanation.

    Otherwise gestures with a meaning of their own would say what the words do not.
    """
    words = [
        word
        for word in (w.strip(".,;:!?\"'").casefold() for w in text.split())
        if word in meanings and word not in PLAIN
    ]
    if words:
        return (words[-1],)
    plain = [tag for tag in PLAIN for _ in range(meanings[tag])]
    return (plain[int(drawn * len(plain))],) if plain else ()


def drive(
    conversation: Conversation,
    side: int,
    project: Project,
    line: str | None = None,
    heads: Sequence[Point] = (HEAD,),
    together: bool = True,
    more: Sequence[AnyRequest] = (),
    others: Sequence[Plan] = (),
) -> tuple[Performance, Plan]:
    """Return what a side performs, and its plan. Gestures whose stroke would miss its peak because another
    still plays are removed. The arguments are as for `drive_side`; `more` are additional requests.

    Performing the same requests again gives the same plan.
    """
    asks = [*drive_side(conversation, side, project, line, heads, together, others), *more]
    plan = Plan(conversation.seed, 0.0)
    for _ in range(ROUNDS):
        plan = plan_performance(project, asks, conversation.length, conversation.seed, idle=False)
        late = _missed(project, plan, asks)
        if not late:
            break
        asks = [ask for ask in asks if ask.id not in late]
    name = f"{conversation.name}, {conversation.sides[side].name or f'side {side + 1}'}"[:200]
    return Performance(
        name=name, asks=tuple(asks), seed=conversation.seed, length=conversation.length, idle=False
    ), plan


def find_stroke_times(project: Project, plan: Plan) -> dict[str, float]:
    """Return the time of each requested gesture's stroke, in seconds, by the request's id."""
    out: dict[str, float] = {}
    for cue in plan.layers["arms"].cues:
        if cue.action.kind == "gesture":
            out[cue.meta.partition("+")[0]] = (
                cue.start + (find_phases(project, cue.action).stroke - cue.entry) / cue.tempo
            )
    return out


def _missed(project: Project, plan: Plan, asks: list[AnyRequest]) -> set[str]:
    """Return requests for gestures that are not played or miss their peak; of several in a row every second
    one, because without it the next may fit.
    """
    found = find_stroke_times(project, plan)
    out: set[str] = set()
    before = False
    for ask in sorted((a for a in asks if isinstance(a, Gesture | Play)), key=lambda a: a.stroke or 0.0):
        at = found.get(ask.id)
        missed = at is None or abs(at - (ask.stroke or 0.0)) > TOLERANCE
        if missed and not before:
            out.add(ask.id)
        before = missed and not before
    return out


def key_segments(segments: tuple[Segment, ...]) -> list[tuple[str, Segment]]:
    """Return segments with a key for each that stays when others change: its kind and words, and how many
    equal ones came before.
    """
    seen: Counter[str] = Counter()
    out = []
    for s in segments:
        word = f"{s.kind} {s.text[:60]}".strip()
        seen[word] += 1
        out.append((f"{word} {seen[word]}" if seen[word] > 1 or not s.text else word, s))
    return out


def _gaps(busy: list[tuple[float, float]], length: float) -> Iterator[tuple[float, float]]:
    """Yield stretches without requests, at least REST long."""
    at = 0.0
    for start, end in (*busy, (length, length)):
        if start - at >= REST:
            yield at, start
        at = max(at, end)
