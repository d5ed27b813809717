"""Who answered what in a perceptual study, and who counts."""

from __future__ import annotations

from dataclasses import dataclass, field
from statistics import median

from metagraph.errors import FileError
from metagraph.research.study.logs.log import StudyLog, read_log
from metagraph.research.study.logs.withdrawal import read_deleted
from metagraph.research.study.perceive.answers import is_answer, list_answers
from metagraph.research.study.perceive.design import Trial
from metagraph.research.study.perceive.folder import Perceived

HASTY = 0.3  # seconds: who decides faster than this has hardly looked (told, not excluded)
SIMULATED = "simulated"  # a file beside the answers that says that nobody gave them


@dataclass(frozen=True)
class Rater:
    """standing: how far they came. missed: of `told` checks. seconds: median time of a decision after the
    last video's end. why: why they do not count, "" for those who do.
    """

    participant: str
    standing: str
    answered: int
    told: int
    missed: int
    replays: int
    seconds: float | None
    why: str


@dataclass(frozen=True)
class RaterChoice:
    """A choice. pair: as the plan names it; first: whether its first condition was chosen; left: whether that
    one was on the left. place: 0, 1, 2 ... among the person's choices.
    """

    participant: str
    pair: tuple[str, str]
    item: str
    first: bool
    left: bool
    place: int
    seconds: float
    replays: int


@dataclass(frozen=True)
class Rated:
    """A rating of one question. place: 0, 1, 2 ... among the person's videos."""

    participant: str
    question: str
    condition: str
    item: str
    value: float
    place: int
    seconds: float
    replays: int


@dataclass(frozen=True)
class Answers:
    """What counts, and what was left out: `all_choices` has those of the excluded, too, but of nobody who
    withdrew. same: of pairs of the same video, whether the left one was chosen. odd: in words, what is not as
    it should be.
    """

    study: Perceived
    people: tuple[Rater, ...] = ()
    choices: tuple[RaterChoice, ...] = ()
    ratings: tuple[Rated, ...] = ()
    same: tuple[bool, ...] = ()
    all_choices: tuple[RaterChoice, ...] = ()
    odd: tuple[str, ...] = ()
    simulated: bool = False

    @property
    def counting(self) -> tuple[str, ...]:
        return tuple(p.participant for p in self.people if not p.why)


@dataclass
class _Read:
    """What one person's log says."""

    choices: list[RaterChoice] = field(default_factory=list)
    ratings: list[Rated] = field(default_factory=list)
    same: list[bool] = field(default_factory=list)
    told: int = 0
    missed: int = 0
    seconds: list[float] = field(default_factory=list)
    replays: int = 0
    answered: int = 0


def collect_answers(study: Perceived) -> Answers:
    """Return everybody's answers. A log that cannot be read leaves its person out and is reported. Raises
    FileError if the study itself is damaged.
    """
    gone = read_deleted(study)
    people, odd = [], study.differences()
    every: list[_Read] = []
    counted: list[_Read] = []
    for who, session in study.key.sessions.items():
        path = study.log(who)
        if who in gone or not path.is_file():
            standing = "deleted" if who in gone else "not begun"
            people.append(Rater(who, standing, 0, 0, 0, 0, None, standing))
            continue
        try:
            log = read_log(path)
        except FileError as error:
            odd.append(str(error))
            people.append(Rater(who, "not readable", 0, 0, 0, 0, None, "not readable"))
            continue
        odd += [f"{who}: {words}" for words in log.problems]
        standing = log.standing
        found = _Read() if standing in ("withdrawn", "declined") else _read(study, session.trials, log)
        why = _why(study, standing, found)
        if standing not in ("withdrawn", "declined"):
            every.append(found)
        if not why:
            counted.append(found)
        middle = median(found.seconds) if found.seconds else None
        if middle is not None and middle < HASTY and not why:
            odd.append(f"{who} decided within {middle:.2f} s of a video's end, in the middle; they count.")
        people.append(
            Rater(who, standing, found.answered, found.told, found.missed, found.replays, middle, why)
        )
    return Answers(
        study,
        tuple(people),
        tuple(c for f in counted for c in f.choices),
        tuple(r for f in counted for r in f.ratings),
        tuple(s for f in counted for s in f.same),
        tuple(c for f in every for c in f.choices),
        tuple(odd),
        (study.folder / SIMULATED).is_file(),
    )


def _why(study: Perceived, standing: str, found: _Read) -> str:
    """Return why somebody does not count."""
    if standing != "done":
        return standing
    return "missed checks" if found.missed > study.plan.checks.allow else ""


def _read(study: Perceived, trials: tuple[Trial, ...], log: StudyLog) -> _Read:
    out = _Read()
    answers = list_answers(list(log.events))
    pairs = {frozenset(p): p for p in study.plan.pairs}
    places = {"choice": 0, "rating": 0}
    for trial in trials:
        event = answers.get(trial.id)
        value = event.get("value") if event is not None else None
        place = places.get(trial.kind, 0)
        if trial.kind in places:
            places[trial.kind] += 1
        if event is None or not is_answer(study, bool(trial.right), value):
            continue
        out.answered += 1
        seconds, replays = _number(event.get("seconds")), int(_number(event.get("replays")))
        out.replays += replays
        if trial.kind in places:
            out.seconds.append(seconds)
        if trial.kind == "told":
            out.told += 1
            right = value == trial.told if trial.right else {*value.values()} == {trial.told}  # type: ignore[union-attr]
            out.missed += not right
        elif trial.kind == "same":
            out.same.append(value == "left")
        elif trial.kind == "choice":
            pair = pairs[frozenset((trial.a, trial.b))]
            chosen = trial.a if value == "left" else trial.b
            out.choices.append(
                RaterChoice(
                    log.participant,
                    pair,
                    trial.item,
                    chosen == pair[0],
                    trial.a == pair[0],
                    place,
                    seconds,
                    replays,
                )
            )
        elif trial.kind == "rating" and isinstance(value, dict):
            out.ratings += [
                Rated(log.participant, k, trial.a, trial.item, float(v), place, seconds, replays)
                for k, v in value.items()
            ]
    return out


def _number(value: object) -> float:
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else 0.0
