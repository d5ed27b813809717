"""How well motion that is extended while it plays goes with speech: heard as it is said, or announced so long
before, beside the best path that knows all of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from time import process_time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.conversation.model import SOUNDS, Segment
from metagraph.motion.clip import Clip
from metagraph.research.motion_graph.search_evaluation import LEAST, WINDOW, cut_segments, hold_out_states
from metagraph.suggest.tracks import RATE
from metagraph.synthesis.constraints import STRESS, TOLERANCE, HeardStates, find_change_states, find_heard_at
from metagraph.synthesis.extending.path import DriverGraph, PathExtender, make_driver_graph
from metagraph.synthesis.extending.speech_so_far import LATE, SpeechNews
from metagraph.synthesis.graph import MotionGraph, build_graph, find_threshold
from metagraph.synthesis.search.path import Path
from metagraph.synthesis.search.path_quality import PathQuality, measure_quality
from metagraph.synthesis.search.relaxing import answer_speech
from metagraph.synthesis.states import KEYS, LEVEL, STEP, States, SynthesisError, key_states, read_states

Array = NDArray[Any]

HEARD = None  # instead of seconds ahead: it is only heard
AHEAD: tuple[float | None, ...] = (HEARD, 0.0, 0.5, 1.0, 2.0)
# Seconds after which `live.heard_voice` knows that somebody begins to speak, was stressed, has ended.
BEGUN, STRESSED, ENDED = 0.08, 0.14, 0.2
SHIFTS = 20  # times that speech is laid elsewhere, to tell what chance gives


@dataclass(frozen=True)
class LiveRow:
    """How it went with speech known in one way. how: in words. stresses: how many there were; strokes: how
    many were shown for each. met: the share that a stroke lies within TOLERANCE of, 0..1; answered: from
    there to LATE after it; chance: met by the same motion of speech laid elsewhere. off: median of how much
    later the nearest stroke is, of those answered, seconds. kinds: share of frames with the kind that is
    heard. jumps: a second; repeated: share of frames; rest, takes_rest: seconds, as `PathQuality` has them.
    searches: a second; work: frames looked at by the most laborious; middle, longest: milliseconds of the
    processor that a search takes.
    """

    how: str
    seconds: float
    stresses: int
    strokes: float
    met: float
    answered: float
    chance: float
    off: float
    kinds: float
    jumps: float
    repeated: float
    rest: float
    takes_rest: float
    searches: float = 0.0
    work: int = 0
    middle: float = 0.0
    longest: float = 0.0


LiveCase = tuple[States, HeardStates, Sequence[Segment], Path]  # of a graph; speech, and motion for it
Driven = tuple[MotionGraph, HeardStates, Sequence[Segment], float]  # a graph; speech, and its seconds


def list_speech_news(segments: Iterable[Segment], ahead: float | None) -> list[tuple[float, SpeechNews]]:
    """Return what becomes known of speech and when, seconds. ahead: seconds before a segment begins at which
    it is announced; None if it is only heard, as late as `live.heard_voice` hears it.
    """
    out: list[tuple[float, SpeechNews]] = []
    for s in segments:
        if ahead is not None:
            out.append((max(0.0, s.start - ahead), SpeechNews("comes", s.start, s.end, s.peak, s.kind)))
            continue
        out.append((s.start + BEGUN, SpeechNews("begins", s.start, kind=s.kind)))
        if s.kind == "clause" and s.peak is not None:
            out.append((s.peak + STRESSED, SpeechNews("stress", s.peak)))
        out.append((s.end + ENDED, SpeechNews("ends", s.end)))
    return sorted(out, key=lambda x: x[0])


def extend_by_windows(
    graph: DriverGraph, segments: Iterable[Segment], seconds: float, ahead: float | None, seed: int = 1
) -> tuple[Path, list[tuple[int, float]]]:
    """Return the path that is extended while speech goes on, and of each search the frames it looked at and
    the seconds of the processor it took.
    """
    extender, news, place = PathExtender(graph, seed), list_speech_news(segments, ahead), 0
    way, searches = np.empty(max(1, round(seconds * RATE)), np.int64), []
    for frame in range(len(way)):
        first = place
        while place < len(news) and news[place][0] * RATE <= frame:
            place += 1
        found, begun = extender.found, process_time()
        extender.step(one for _, one in news[first:place])
        if extender.found > found:
            searches.append((extender.spent, process_time() - begun))
        way[frame] = extender.at(frame)
    return Path(way, 0.0, np.flatnonzero(np.diff(way) != 1) + 1), searches


def score_paths(how: str, cases: Sequence[LiveCase], searches: Sequence[tuple[int, float]] = ()) -> LiveRow:
    """Return how paths go with the speech that each is for. searches: frames looked at, and seconds."""
    off: list[float] = []
    shifted: list[float] = []
    alike = frames = shown = 0
    looks: list[tuple[int, PathQuality]] = []
    for states, sound, segments, path in cases:
        length = len(path.states)
        strokes = np.flatnonzero(sound.happens(STRESS)[path.states]) / RATE
        shown += len(strokes)
        peaks = np.array([s.peak for s in segments if s.kind == "clause" and s.peak is not None])
        off += _nearest(strokes, peaks).tolist()
        for n in range(1, SHIFTS + 1):
            elsewhere = np.mod(peaks + n * length / RATE / (SHIFTS + 1), length / RATE)
            shifted += _nearest(strokes, elsewhere).tolist()
        kinds = np.ones(length, np.uint8)
        for s in segments:
            kinds[round(s.start * RATE) : round(s.end * RATE)] = 1 << SOUNDS.index(s.kind)
        alike += int((sound.kinds[path.states] == kinds).sum())
        frames += length
        looks.append((length, measure_quality(states, path)))
    slack = TOLERANCE + 0.5 / RATE
    away = np.array(off)
    near = away[(away >= -slack) & (away <= LATE)]
    took = sorted(seconds for _, seconds in searches)

    def mean(values: Sequence[float]) -> float:
        return float(np.average(values, weights=[n for n, _ in looks]))

    return LiveRow(
        how,
        frames / RATE,
        len(off),
        shown / max(1, len(off)),
        float((np.abs(away) <= slack).mean()) if off else 0.0,
        len(near) / len(off) if off else 0.0,
        float((np.abs(np.array(shifted)) <= slack).mean()) if shifted else 0.0,
        float(np.median(near)) if len(near) else 0.0,
        alike / max(1, frames),
        mean([q.jumps for _, q in looks]),
        mean([q.repeated for _, q in looks]),
        max(q.frozen for _, q in looks),
        max(q.source for _, q in looks),
        len(searches) / max(frames / RATE, 1e-9),
        max((work for work, _ in searches), default=0),
        1000 * took[len(took) // 2] if took else 0.0,
        1000 * took[-1] if took else 0.0,
    )


def _nearest(strokes: Array, peaks: Array) -> Array:
    """Return how much later the nearest stroke to each of these times is, seconds `[n]`; infinite without
    any.
    """
    if not len(strokes):
        return np.full(len(peaks), np.inf)
    away = strokes[None, :] - peaks[:, None]
    return np.asarray(away[np.arange(len(peaks)), np.abs(away).argmin(1)])


def find_best_paths(
    graph: MotionGraph, sound: HeardStates, said: Sequence[Segment], seconds: float
) -> list[LiveCase]:
    """Return the best paths for speech that is known whole, WINDOW by WINDOW."""
    out: list[LiveCase] = []
    for start in np.arange(0.0, seconds - LEAST, WINDOW).tolist():
        length = min(WINDOW, seconds - start)
        part = cut_segments(said, start, length)
        out.append((graph.states, sound, part, answer_speech(graph, sound, part, length).path))
    return out


def score_extending(
    graphs: Sequence[Driven],
    ahead: Sequence[float | None] = AHEAD,
    seed: int = 1,
    progress: Callable[[int, int], None] | None = None,
) -> Iterator[LiveRow]:
    """Yield how motion of these graphs goes with speech known in each of these ways, at last with all of it
    known.
    """
    ready = [make_driver_graph(graph, sound) for graph, sound, _, _ in graphs]
    for driver in ready[:1]:
        PathExtender(driver).step()  # compiles what is timed
    total, done = len(graphs) * (len(ahead) + 1), 0

    def told() -> None:
        nonlocal done
        done += 1
        if progress is not None:
            progress(done, total)

    for k in ahead:
        cases, searches = [], []
        for driver, (_, sound, said, seconds) in zip(ready, graphs, strict=True):
            path, took = extend_by_windows(driver, said, seconds, k, seed)
            cases.append((driver.states, sound, said, path))
            searches += took
            told()
        yield score_paths("heard" if k is None else f"announced {k:g} s ahead", cases, searches)
    cases = []
    for graph, sound, said, seconds in graphs:
        cases += find_best_paths(graph, sound, said, seconds)
        told()
    yield score_paths("all known", cases)


def hold_out_takes(
    takes: Sequence[Clip],
    speech: Sequence[Sequence[Segment]],
    k: int = STEP,
    level: float = LEVEL,
    keys: float = KEYS,
    most: int | None = None,
) -> list[Driven]:
    """Return, for each take longer than LEAST, the graph of all others and the speech of that one. Raises
    SynthesisError if there are not two.
    """
    pairs = [(t, s) for t, s in zip(takes, speech, strict=True) if t.frames >= 2]
    if len(pairs) < 2:
        raise SynthesisError(
            "holding one take out needs at least two takes of more than one frame: give more"
        )
    every = read_states([t for t, _ in pairs])
    out: list[Driven] = []
    for n, (take, said) in enumerate(pairs):
        if take.duration < LEAST:
            continue
        rest = hold_out_states(every, n)
        others = [s for m, (_, s) in enumerate(pairs) if m != n]
        places = key_states(rest, keys, find_change_states(rest, others))
        graph = build_graph(rest, find_threshold(rest, k, level), places, most)
        out.append(
            (graph, find_heard_at(rest, others), cut_segments(said, 0.0, take.duration), take.duration)
        )
    if not out:
        raise SynthesisError(f"no take is longer than {LEAST:g} s, so there is no case: give longer takes")
    return out


def format_rows_as_text(rows: Sequence[LiveRow]) -> str:
    """Return rows as a table in text."""
    names = ("strokes", "met", "chance", "answered", "later by", "kind", "jumps/s", "again", "rest", "takes")
    out = [f"{'speech is':<18}" + "".join(f"{name:>9}" for name in (*names, "search", "most"))]
    for r in rows:
        shares = f"{r.strokes:>9.2f}{r.met:>9.0%}{r.chance:>9.0%}{r.answered:>9.0%}{r.off:>7.2f} s"
        looks = f"{r.kinds:>9.0%}{r.jumps:>9.2f}{r.repeated:>9.1%}{r.rest:>7.1f} s{r.takes_rest:>7.1f} s"
        took = f"{r.middle:>6.1f} ms{r.longest:>6.0f} ms" if r.searches else ""
        out.append(f"{r.how:<18}{shares}{looks}{took}")
    return "\n".join(out)
