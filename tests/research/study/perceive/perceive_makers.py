"""Studies that tests answer: plans as text, folders with small videos, or with none."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from metagraph.research.study.perceive.answers import PageEvent, Sheet
from metagraph.research.study.perceive.design import make_design
from metagraph.research.study.perceive.folder import Perceived, write_folder
from metagraph.research.study.perceive.perceive_plan import PerceivePlan, parse_perceive_plan

SECRET = "a secret of tests"
CHOICE = "choice: {question: Which one?}\n"
RATING = """rating:
  questions:
  - {id: natural, text: How natural?, scale: {from: 1, to: 7, left: Not at all, right: Entirely}}
"""


def text(
    people: int | str = 4,
    items: int = 3,
    asked: str = CHOICE,
    conditions: str = "{all: {conversation: Office}, deaf: {conversation: Office, without: [response]}}",
    more: str = "",
) -> str:
    listed = "".join(f"- {{id: i{n}, start: {n}, seconds: 1}}\n" for n in range(items))
    return (
        f"perceive: 1\ntitle: A study\nparticipants: {people}\nproject: sample.metagraph.yaml\n"
        f"conditions: {conditions}\nitems:\n{listed}{asked}{more}"
    )


def plan(*args: object, **options: object) -> PerceivePlan:
    return parse_perceive_plan(text(*args, **options))  # type: ignore[arg-type]


def study(folder: Path, words: str, secret: str = SECRET) -> Perceived:
    """Write a study without videos."""
    made = parse_perceive_plan(words)
    return write_folder(folder, made, words.encode(), make_design(made, secret))


def shown(folder: Path, words: str, seconds: float = 1.0) -> Perceived:
    """Write a study with a small video for each stimulus."""
    from preview.video import write_video

    made = parse_perceive_plan(words)
    drawn = make_design(made, SECRET)
    (folder / "show" / "videos").mkdir(parents=True)
    for n, name in enumerate(drawn.key.stimuli):
        frames = [
            np.full((64, 64, 3), (40 * n % 256, 8 * k % 256, 90), np.uint8)
            for k in range(round(10 * seconds))
        ]
        write_video(folder / "show" / "videos" / f"{name}.mp4", frames, 10)
    return write_folder(folder, made, words.encode(), drawn)


def sheet(
    made: Perceived, who: str = "P01", side: str = "left", end: bool = True, run: str = "abcdef0123"
) -> Sheet:
    """Answer all of somebody's trials as told, others with one side or the middle of the scale."""
    events = [PageEvent(0, "begin", agent="tests")]
    for trial in made.key.sessions[who].trials:
        value: object = side if trial.kind != "told" else trial.told
        if not trial.right:
            assert made.plan.rating is not None
            number = trial.told if trial.kind == "told" else 4
            value = {q.id: number for q in made.plan.rating.questions}
        events.append(PageEvent(len(events), "answer", trial=trial.id, value=value, seconds=1.5, first=1.5))  # type: ignore[arg-type]
    if end:
        events.append(PageEvent(len(events), "end"))
    return Sheet(1, made.key.design, who, run, tuple(events))
