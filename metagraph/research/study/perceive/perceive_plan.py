"""Plans of perceptual studies: what is shown, what is asked, and of how many. `perceive.yaml` is read here
and checked to the last field. Paths in it are relative to it.
"""

from __future__ import annotations

from itertools import combinations
from pathlib import Path
from typing import Annotated, Literal

from msgspec import Meta, Struct

from metagraph.common.budgets import TEXT_FILE
from metagraph.common.files import read_file
from metagraph.errors import FileError
from metagraph.research.study.plan.study_fields import MOST
from metagraph.research.study.questionnaires import Item, Name
from metagraph.research.study.study_plan import plan_from

VERSION = 1
FILE = "perceive.yaml"
MOST_TRIALS = 500  # of one session: hours
_CORRECT = "Correct it; docs/researchers/perceptual-plan.md describes every field."

Text = Annotated[str, Meta(max_length=20_000)]
Where = Annotated[str, Meta(min_length=1, max_length=1000)]
Spoken = Literal["clause", "response", "hesitation"]
SOURCES = ("conversation", "performance", "clip", "motion", "video")


class Condition(Struct, frozen=True, forbid_unknown_fields=True):
    """Where a condition's videos come from, one for each item. One of conversation, performance and clip
    (names of the project's; a clip's may hold {item}), motion (a file of plain motion), video (a file, drawn
    by something else); paths with {item} begin where the item does, others with what they are of. With a
    conversation, motion is both sides' files. project: None for the study's. taken: both sides of the
    conversation move as was recorded. without: of a conversation, what nobody moves with. seed: other draws.
    sound: its own; none; or `mismatched`, that of the next item. audio: a sound file for motion and clips.
    face: `still` keeps mouth, brows and blinks from saying which sound belongs to the motion.
    """

    title: Annotated[str, Meta(max_length=200)] = ""
    project: Where | None = None
    conversation: Where | None = None
    performance: Where | None = None
    clip: Where | None = None
    motion: Where | Annotated[tuple[Where, ...], Meta(min_length=2, max_length=2)] | None = None
    video: Where | None = None
    taken: bool = False
    without: tuple[Spoken, ...] = ()
    seed: Annotated[int, Meta(ge=0, le=0xFFFFFFFF)] | None = None
    sound: Literal["own", "none", "mismatched"] = "own"
    audio: Where | None = None
    face: Literal["own", "still"] = "own"


class Stretch(Struct, frozen=True, forbid_unknown_fields=True):
    """An item: a stretch of what is shown, the same in every condition. start, seconds: of the whole."""

    id: Name
    seconds: Annotated[float, Meta(gt=0, le=600)]
    start: Annotated[float, Meta(ge=0, le=36000)] = 0.0


class Picture(Struct, frozen=True, forbid_unknown_fields=True):
    """How all videos look. loudness: of the sound, LUFS (ITU-R BS.1770)."""

    width: Annotated[int, Meta(ge=64, le=3840)] = 480
    height: Annotated[int, Meta(ge=64, le=2160)] = 480
    fps: Annotated[float, Meta(ge=5, le=120)] = 30.0
    theme: Literal["light", "dark"] = "light"
    loudness: Annotated[float, Meta(ge=-40, le=-10)] = -23.0


class Choice(Struct, frozen=True, forbid_unknown_fields=True):
    """Two videos side by side, of which one is chosen. each: trials of a person, None for one of every item
    and comparison. present: both at once, with one sound, or one after the other.
    """

    question: Annotated[str, Meta(min_length=1, max_length=1000)]
    each: Annotated[int, Meta(ge=1, le=MOST_TRIALS)] | None = None
    present: Literal["together", "after"] = "together"


class Rating(Struct, frozen=True, forbid_unknown_fields=True):
    """One video, rated by questions with scales. each: items of a person, each in every condition; None for
    all.
    """

    questions: Annotated[tuple[Item, ...], Meta(min_length=1, max_length=20)]
    each: Annotated[int, Meta(ge=1, le=MOST_TRIALS)] | None = None


class Checks(Struct, frozen=True, forbid_unknown_fields=True):
    """Trials that show whether people attend. told: in how many of each block it is said what to answer;
    same: in how many both videos are the same one. allow: how many of the first may be missed by somebody who
    counts.
    """

    told: Annotated[int, Meta(ge=0, le=50)] = 2
    same: Annotated[int, Meta(ge=0, le=50)] = 0
    allow: Annotated[int, Meta(ge=0, le=50)] = 0


class PerceivePlan(Struct, frozen=True, forbid_unknown_fields=True):
    """perceive: the version of the format. participants: how many codes, or the codes. compare: pairs of
    conditions; none for all. training: trials before the others that do not count. smallest: the smallest
    share of choices that would matter, above a half.
    """

    perceive: int
    title: Annotated[str, Meta(min_length=1, max_length=200)]
    participants: (
        Annotated[int, Meta(ge=1, le=MOST)] | Annotated[tuple[Name, ...], Meta(min_length=1, max_length=MOST)]
    )
    conditions: Annotated[dict[Name, Condition], Meta(min_length=1, max_length=50)]
    items: Annotated[tuple[Stretch, ...], Meta(min_length=1, max_length=1000)]
    project: Where | None = None
    consent: Text = ""
    instructions: Text = ""
    thanks: Text = ""
    compare: tuple[Annotated[tuple[Name, ...], Meta(min_length=2, max_length=2)], ...] = ()
    choice: Choice | None = None
    rating: Rating | None = None
    checks: Checks = Checks()
    training: Annotated[int, Meta(ge=0, le=20)] = 1
    video: Picture = Picture()
    smallest: Annotated[float, Meta(gt=0.5, lt=1)] | None = None

    @property
    def ids(self) -> tuple[str, ...]:
        """Return the participants' codes, in the order of their numbers."""
        if not isinstance(self.participants, int):
            return self.participants
        width = max(2, len(str(self.participants)))
        return tuple(f"P{n:0{width}}" for n in range(1, self.participants + 1))

    @property
    def pairs(self) -> tuple[tuple[str, str], ...]:
        """Return the pairs of conditions that are compared."""
        if self.compare:
            return tuple((a, b) for a, b in self.compare)
        return tuple(combinations(self.conditions, 2))

    def name(self, condition: str) -> str:
        """Return what a condition is called."""
        return self.conditions[condition].title or condition


def read_perceive_plan(path: str | Path) -> PerceivePlan:
    """Read a plan, or the one in a folder. Raises FileError with the line, the cause and the remedy."""
    path = Path(path)
    path = path / FILE if path.is_dir() else path
    try:
        text = read_file(path, TEXT_FILE).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise FileError(path, "is not text", f"byte {error.start}", "Choose a plan of a study.") from None
    return parse_perceive_plan(text, path)


def parse_perceive_plan(text: str, path: Path = Path(FILE)) -> PerceivePlan:
    """Return the plan of a text. Raises FileError."""
    return plan_from(
        text, path, PerceivePlan, "perceive", "no perceptual study", VERSION, find_perceive_faults, _CORRECT
    )


def find_perceive_faults(plan: PerceivePlan) -> list[tuple[str, str]]:
    """Return what is wrong that the fields' types do not say: (field, cause)."""
    out = _twice(plan)
    for name, condition in plan.conditions.items():
        out += [(f"conditions.{name}", cause) for cause in _condition_faults(plan, condition)]
    out += _compare_faults(plan)
    if plan.choice is None and plan.rating is None:
        out.append(("", "nothing is asked: give 'choice', 'rating', or both"))
    if plan.choice is not None:
        out += _choice_faults(plan, plan.choice)
    if plan.rating is not None:
        out += _rating_faults(plan, plan.rating)
    if plan.checks.allow >= plan.checks.told > 0:
        out.append(("checks.allow", "nobody would ever be excluded: allow fewer than are told"))
    return out


def _twice(plan: PerceivePlan) -> list[tuple[str, str]]:
    out: list[tuple[str, str]] = []
    for field, names in (("participants", plan.ids), ("items", [i.id for i in plan.items])):
        folded = [n.casefold() for n in names]
        if len(set(folded)) == len(folded):
            continue
        twice = next(n for n in names if folded.count(n.casefold()) > 1)
        out.append((field, f"'{twice}' is there twice, large and small letters being the same"))
    return out


def _compare_faults(plan: PerceivePlan) -> list[tuple[str, str]]:
    out: list[tuple[str, str]] = []
    for n, (a, b) in enumerate(plan.compare):
        where = f"compare[{n}]"
        odd = next((c for c in (a, b) if c not in plan.conditions), None)
        if odd is not None:
            out.append((where, f"there is no condition '{odd}'"))
        elif a == b:
            out.append((where, "a condition is not compared with itself; 'checks' has 'same' for that"))
        elif any({a, b} == {*other} for other in plan.compare[:n]):
            out.append((where, f"'{a}' and '{b}' are compared twice"))
    return out


def _rating_faults(plan: PerceivePlan, rating: Rating) -> list[tuple[str, str]]:
    out: list[tuple[str, str]] = []
    for n, item in enumerate(rating.questions):
        if item.scale is None or item.choices or item.words:
            out.append((f"rating.questions[{n}]", "a question is answered on a scale: give 'scale'"))
        elif not 2 <= len(item.scale.points) <= 11:
            out.append((f"rating.questions[{n}].scale", "a scale has 2 to 11 points"))
    if len({q.id for q in rating.questions}) < len(rating.questions):
        out.append(("rating.questions", "two questions have the same id"))
    if rating.each is not None and rating.each > len(plan.items):
        out.append(("rating.each", f"there are only {len(plan.items)} items"))
    if (rating.each or len(plan.items)) * len(plan.conditions) > MOST_TRIALS:
        out.append(("rating", f"a person would rate more than {MOST_TRIALS} videos: give 'each'"))
    return out


def _condition_faults(plan: PerceivePlan, made: Condition) -> list[str]:
    given = [s for s in SOURCES if getattr(made, s) is not None]
    if given not in (["conversation"], ["performance"], ["clip"], ["motion"], ["video"]) and given != [
        "conversation",
        "motion",
    ]:
        return ["give one of conversation, performance, clip, motion and video (or conversation and motion)"]
    kind, out = given[0], []
    if (kind == "conversation") != isinstance(made.motion, tuple) and made.motion is not None:
        out.append("motion is one file; of a conversation one for each side")
    if kind in ("conversation", "performance", "clip") and not (made.project or plan.project):
        out.append("say which project it is of: 'project', here or for all")
    if kind != "conversation" and (made.without or made.taken):
        out.append("'without' and 'taken' are of conversations")
    if made.taken and (made.motion is not None or made.without):
        out.append("what was taken moves as it did: neither with 'motion' nor 'without'")
    if made.audio is not None and kind not in ("motion", "clip"):
        out.append("'audio' goes with motion and clips; others have their own sound")
    if made.seed is not None and kind not in ("conversation", "performance"):
        out.append("'seed' draws conversations and performances anew; nothing is drawn here")
    if made.sound == "mismatched" and len(plan.items) < 2:
        out.append("a mismatched sound is the next item's, and there is only one item")
    for name in SOURCES[3:]:
        found = getattr(made, name)
        for path in (found,) if isinstance(found, str) else found or ():
            if "{item}" not in path and any(c in path for c in "{}"):
                out.append(f"'{path}' has braces, and only {{item}} is filled in")
    return out


def _choice_faults(plan: PerceivePlan, choice: Choice) -> list[tuple[str, str]]:
    out: list[tuple[str, str]] = []
    if len(plan.conditions) < 2:
        return [("conditions", "there is nothing to choose between: give two conditions")]
    most = len(plan.pairs) * len(plan.items)
    if choice.each is not None and choice.each > most:
        out.append(("choice.each", f"there are only {most} pairs of videos"))
    if (choice.each or most) > MOST_TRIALS:
        out.append(("choice", f"a person would choose more than {MOST_TRIALS} times: give 'each'"))
    if choice.present == "together":
        for n, (a, b) in enumerate(plan.pairs):
            one, other = plan.conditions.get(a), plan.conditions.get(b)
            if one is not None and other is not None and one.sound != other.sound:
                out.append(
                    (
                        f"compare[{n}]" if plan.compare else "choice.present",
                        f"'{a}' and '{b}' sound different, and only one is heard of two at once: "
                        "'present: after' shows them one after the other",
                    )
                )
    return out
