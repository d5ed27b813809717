"""What a study file says, field for field."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Literal

from msgspec import Meta, Struct

from metagraph.research.study.machines.klm import OperatorTimes
from metagraph.research.study.plan.hidden_names import has_hidden_names
from metagraph.research.study.plan.order import make_williams_design, order_conditions
from metagraph.research.study.questionnaires import BUILT_IN, Name, Questionnaire, When

MOST = 1000  # participants
ConditionName = Literal["meta", "manual"]
Minutes = Annotated[float, Meta(gt=0, le=1440)]


class Task(Struct, frozen=True, forbid_unknown_fields=True):
    """clips: a folder, or files. reference: the project that is the right answer. minutes: the limit, null
    for none. instructions: Markdown.
    """

    id: Name
    clips: str | tuple[str, ...]
    title: str = ""
    instructions: str = ""
    reference: str | None = None
    minutes: Minutes | None = None

    @property
    def name(self) -> str:
        return self.title or self.id


class Training(Struct, frozen=True, forbid_unknown_fields=True):
    """Practice with one condition's editor, before its tasks; it is logged and not counted."""

    condition: ConditionName
    clips: str | tuple[str, ...]
    instructions: str = ""
    minutes: Minutes | None = None


class Given(Struct, frozen=True, forbid_unknown_fields=True):
    """given: for each participant the conditions in order ("meta"), or conditions with a task each
    ("meta/ten").
    """

    given: dict[str, tuple[str, ...]]


class Plan(Struct, frozen=True, forbid_unknown_fields=True):
    """study: the version of the format. participants: how many, or their pseudonyms. order: `latin`
    counterbalances conditions and tasks, `fixed` keeps to the file, `concealed` draws who gets which of the
    counterbalanced orders when they begin. smallest: the smallest ratio of times that would matter. site:
    where this copy of the study is run. claps: each task begins with a flash and a sound, so that
    recordings of screen, voice and eyes can be brought into the log's time. lsl: its events are sent as
    markers of the Lab Streaming Layer. breaks: minutes after each
    condition but the last. when: what questionnaires are about that do not say it themselves. tolerance:
    seconds by which a timing may differ from the reference. allow: `labels` lets proposals be asked for.
    operators: seconds each operator of the keystroke-level model takes these participants, where it is not
    as `klm.OperatorTimes` has it. names: whether clips have their names, numbers instead (`hidden`), or
    every participant has names in one half of the tasks and numbers in the other (`both`). hidden: what a
    task with numbers says besides.
    """

    study: int
    title: str
    participants: (
        Annotated[int, Meta(ge=1, le=MOST)] | Annotated[tuple[Name, ...], Meta(min_length=1, max_length=MOST)]
    )
    conditions: Annotated[tuple[ConditionName, ...], Meta(min_length=1)]
    tasks: Annotated[tuple[Task, ...], Meta(min_length=1)]
    consent: str = ""
    instructions: str = ""
    training: tuple[Training, ...] = ()
    order: Literal["latin", "fixed", "concealed"] | Given = "latin"
    breaks: Annotated[float, Meta(ge=0, le=1440)] = 0
    questionnaires: tuple[str | Questionnaire, ...] = ()
    when: When = "after_condition"
    seed: Annotated[int, Meta(ge=0, le=0xFFFFFFFF)] = 0
    tolerance: Annotated[float, Meta(ge=0, le=60)] = 0.1
    operators: dict[Literal["K", "P", "B", "H", "M"], Annotated[float, Meta(ge=0, le=60)]] = {}
    allow: tuple[Literal["labels"], ...] = ()
    thanks: str = ""
    smallest: Annotated[float, Meta(gt=1, le=100)] | None = None
    site: str = ""
    claps: bool = False
    lsl: bool = False
    names: Literal["shown", "hidden", "both"] = "shown"
    hidden: str = "The clips of this task have numbers instead of names. Watch them to see what they are."

    @property
    def times(self) -> OperatorTimes:
        """Return what the operators take."""
        return replace(OperatorTimes(), **self.operators)

    @property
    def ids(self) -> tuple[str, ...]:
        """Return the participants' pseudonyms, in the order of their numbers."""
        if not isinstance(self.participants, int):
            return self.participants
        width = max(2, len(str(self.participants)))
        return tuple(f"P{n:0{width}}" for n in range(1, self.participants + 1))

    def task(self, ident: str) -> Task:
        """Return a task. Raises KeyError."""
        return {t.id: t for t in self.tasks}[ident]

    def questions(self) -> tuple[Questionnaire, ...]:
        """Return all questionnaires, those that are built in written out."""
        return tuple(BUILT_IN[q] if isinstance(q, str) else q for q in self.questionnaires)

    def known(self, participant: str) -> None:
        """Raises ValueError for a stranger."""
        if participant not in self.ids:
            raise ValueError(f"'{participant}' does not take part; there are {list_few(self.ids)}")

    def hides(self, participant: str, task: str, drawn: int | None = None) -> bool:
        """Return whether a participant sees the clips of a task under numbers. drawn: as `blocks` has it.
        Raises ValueError for a stranger, and for one for whom no order was drawn yet.
        """
        if self.names != "both":
            return self.names == "hidden"
        self.known(participant)
        if self.order == "concealed" and drawn is None:
            raise ValueError(f"the order of '{participant}' is concealed, and drawn when they begin")
        number = self.ids.index(participant) if drawn is None else drawn
        orders = [len(make_williams_design(len(x))) for x in (self.conditions, self.tasks)]
        if isinstance(self.order, Given) or self.order == "fixed":
            orders[1] = 1  # tasks have one order
        return has_hidden_names([t.id for t in self.tasks].index(task), number, *orders)

    def blocks(self, participant: str, drawn: int | None = None) -> tuple[tuple[str, tuple[str, ...]], ...]:
        """Return a participant's conditions in order, each with the ids of its tasks in order. drawn: the
        number of the order that was drawn for them, where the order is concealed. Raises ValueError for a
        stranger, and for one for whom none was drawn yet.
        """
        self.known(participant)
        tasks = tuple(t.id for t in self.tasks)
        if self.order == "fixed":
            return tuple((c, tasks) for c in self.conditions)
        if self.order == "concealed" and drawn is None:
            raise ValueError(f"the order of '{participant}' is concealed, and drawn when they begin")
        if isinstance(self.order, str):
            number = self.ids.index(participant) if drawn is None else drawn
            return order_conditions(self.conditions, tasks, number, self.seed)
        out: list[tuple[str, tuple[str, ...]]] = []
        for step in self.order.given[participant]:
            condition, _, task = step.partition("/")
            if task and out and out[-1][0] == condition:
                out[-1] = condition, (*out[-1][1], task)
            else:
                out.append((condition, (task,) if task else tasks))
        return tuple(out)


def list_few(names: tuple[str, ...]) -> str:
    """Return the first names in words, and how many more there are."""
    return ", ".join(names[:4]) + (f" and {len(names) - 4} more" if len(names) > 4 else "")
