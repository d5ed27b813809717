"""`metagraph study perceive plan` and `simulate`: how many people a forced choice needs, and a study to
try.
"""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.research.study.perceive.simulated import Raters

Action = Callable[[str, str, Callable[[Namespace], int]], ArgumentParser]


def add_arguments(action: Action) -> None:
    """Add the actions."""
    planned = action(
        "plan", "compute how many answers and people a forced choice needs", write_perceptual_plan
    )
    planned.add_argument("--share", type=float, required=True, help="expected share of choices, 0.5 to 1")
    planned.add_argument("--smallest", type=float, help="the smallest share that matters")
    planned.add_argument("--items", type=int, default=10, help="number of items (default: 10)")
    planned.add_argument(
        "--each", type=int, help="answers of each person about the pair (default: one for each item)"
    )
    planned.add_argument(
        "--people-differ",
        type=float,
        default=0.5,
        metavar="SD",
        help="standard deviation between people, in log odds (default: 0.5)",
    )
    planned.add_argument(
        "--items-differ",
        type=float,
        default=0.3,
        metavar="SD",
        help="standard deviation between items, in log odds (default: 0.3)",
    )
    planned.add_argument(
        "--chance", type=float, default=0.8, help="power: the chance to show the effect (default: 0.8)"
    )
    planned.add_argument(
        "--tests", type=int, default=1, help="number of tests that share the level of 0.05 (default: 1)"
    )
    planned.add_argument(
        "--participants", type=int, help="compute the power with this many participants instead"
    )
    planned.add_argument(
        "--studies", type=int, default=200, help="number of simulated studies (default: 200)"
    )
    planned.add_argument("--seed", type=int, default=1)
    faked = action(
        "simulate",
        "write a study without videos, answered by simulated people",
        simulate_perceptual_study,
    )
    faked.add_argument("out", type=Path, help="the folder to make; it must not exist yet")
    faked.add_argument("--like", type=Path, metavar="PLAN", help="use this perceive.yaml")
    faked.add_argument("--participants", type=int, help="number of participants (default: the plan's)")
    faked.add_argument(
        "--liked",
        action="append",
        default=[],
        metavar="CONDITION=LOGODDS",
        help="how much people prefer a condition, in log odds",
    )
    faked.add_argument(
        "--people-differ",
        type=float,
        default=0.4,
        metavar="SD",
        help="standard deviation between people, in log odds (default: 0.4)",
    )
    faked.add_argument(
        "--items-differ",
        type=float,
        default=0.3,
        metavar="SD",
        help="standard deviation between items, in log odds (default: 0.3)",
    )
    faked.add_argument(
        "--left", type=float, default=0.0, help="bias towards the left side, in log odds (default: 0)"
    )
    faked.add_argument(
        "--lapses", type=float, default=0.02, help="share of answers given without looking (default: 0.02)"
    )
    faked.add_argument(
        "--careless", type=float, default=0.0, help="share of people who never look (default: 0)"
    )
    faked.add_argument(
        "--unfinished", type=float, default=0.0, help="share of people who break off (default: 0)"
    )
    faked.add_argument(
        "--seed", type=int, default=1, help="random seed; another seed gives other people (default: 1)"
    )


def require_empty(folder: Path) -> None:
    """Raise ValueError for a folder with a study in it: its answers must not get another key."""
    from metagraph.research.study.perceive.folder import KEY

    if (folder / KEY).exists() or (folder / "answers").exists():
        raise ValueError(f"{folder} has a study already, perhaps with answers: give another folder")
    if folder.exists() and not folder.is_dir():
        raise ValueError(f"{folder} is a file: give a folder")


def write_perceptual_plan(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.research.study.perceive import binomial
    from metagraph.research.study.perceive.perceive_power import (
        Expected,
        compute_design_effect,
        count_raters_needed,
        simulate_power,
    )

    if options.tests < 1 or options.items < 1:
        raise ValueError("--tests and --items must be at least 1")
    if not 0.5 < options.share < 1:
        raise ValueError(f"--share must be more than 0.5 and less than 1, not {options.share:g}")
    if not 0 < options.chance < 1:
        raise ValueError(f"--chance must be between 0 and 1, not {options.chance:g}")
    if options.smallest is not None and not 0.5 < options.smallest < 1:
        raise ValueError(f"--smallest must be more than 0.5 and less than 1, not {options.smallest:g}")
    alpha, each = 0.05 / options.tests, options.each or options.items
    expected = Expected(options.share, options.people_differ, options.items_differ)
    answers = binomial.count_needed_answers(options.share, options.chance, alpha)
    data: dict[str, Any] = {
        "answers": answers,
        "alpha": alpha,
        "design_effect": compute_design_effect(expected, each),
    }
    lines = [
        f"for a chance of {options.chance:.0%}"
        + (f", {options.tests} tests" if options.tests > 1 else "")
        + ":",
        f"  independent answers to show a share of {options.share:.0%}: {_count(answers)} (exact binomial)",
    ]
    if options.smallest is not None:
        data["smallest"] = binomial.count_needed_answers(options.smallest, options.chance, alpha)
        data["equivalent"] = binomial.count_answers_for_equivalence(
            options.smallest - 0.5, options.chance, alpha
        )
        lines += [
            f"  to show the smallest share that matters, {options.smallest:.0%}: {_count(data['smallest'])}",
            f"  to show that a half is within {1 - options.smallest:.0%} and {options.smallest:.0%}: "
            f"{_count(data['equivalent'])}",
        ]
    lines.append(
        f"answers of one person are similar: {data['design_effect']:.2f} times as many for {each} of each"
    )
    rest = (options.items, each)
    if options.participants is not None:
        found = simulate_power(expected, options.participants, *rest, alpha, options.studies, options.seed)
        data["power"] = {
            "people": options.participants,
            "chance": found.value,
            "low": found.low,
            "high": found.high,
        }
        lines.append(f"{options.participants} people: {_chance(found)}")
    else:
        people, best = count_raters_needed(
            expected, *rest, options.chance, alpha, options.studies, options.seed
        )
        data["people"] = people
        if best is not None:
            data["power"] = {"chance": best.value, "low": best.low, "high": best.high}
        told = _chance(best) if best is not None else ""
        lines.append(
            f"people, from {options.studies} simulated studies with the mixed model: {people}: {told}"
            if people is not None
            else f"even 400 people are too few with {options.items} items and these differences: {told}"
        )
    say(options, "\n".join(lines), data)
    return 0


def _count(value: int | None) -> str:
    return "more than 100,000" if value is None else f"{value:,}"


def _chance(found: Any) -> str:
    return f"shown in {found.value:.0%} of simulated studies ({found.low:.0%} to {found.high:.0%})"


EXAMPLE = """\
perceive: 1
title: A simulated study
participants: 24
project: sample.metagraph.yaml
conditions:
  all: {title: All responses, conversation: Office}
  deaf: {title: Without the listener, conversation: Office, without: [response, hesitation]}
  other: {title: Another draw, conversation: Office, seed: 7}
compare: [[all, deaf], [all, other]]
items:
- {id: one, start: 0, seconds: 3}
- {id: two, start: 3, seconds: 3}
- {id: three, start: 6, seconds: 3}
- {id: four, start: 9, seconds: 3}
- {id: five, start: 12, seconds: 3}
- {id: six, start: 15, seconds: 3}
- {id: seven, start: 18, seconds: 3}
- {id: eight, start: 21, seconds: 3}
choice: {question: Which of the two seems more natural?}
"""


def simulate_perceptual_study(options: Namespace) -> int:
    from dataclasses import replace

    from msgspec.structs import replace as changed

    from app.cli.command_output import say
    from metagraph.research.study.perceive.perceive_plan import FILE, parse_perceive_plan, read_perceive_plan
    from metagraph.research.study.perceive.simulated import write_simulated

    require_empty(options.out)
    text = EXAMPLE.encode()
    mine = parse_perceive_plan(EXAMPLE)
    raters = _raters(options)
    if options.like is not None:
        path = options.like / FILE if options.like.is_dir() else options.like
        mine, text = read_perceive_plan(path), path.read_bytes()
    elif not raters.liked:
        raters = replace(raters, liked={"deaf": -0.8})
    if options.participants is not None:
        if not 1 <= options.participants <= 1000:
            raise ValueError("--participants must be 1 to 1000")
        mine = changed(mine, participants=options.participants)
    strange = set(raters.liked) - set(mine.conditions)
    if strange:
        raise ValueError(
            f"there is no condition '{sorted(strange)[0]}'; there are {', '.join(mine.conditions)}"
        )
    study = write_simulated(options.out, mine, text, f"simulated {options.seed}", raters)
    count = len(study.key.sessions)
    say(options, f"{study.folder}: {count} simulated raters", {"study": str(study.folder), "raters": count})
    return 0


def _raters(options: Namespace) -> Raters:
    from metagraph.research.study.perceive.simulated import Raters

    liked = {}
    for words in options.liked:
        name, found, value = words.partition("=")
        try:
            liked[name] = float(value)
        except ValueError:
            found = ""
        if not found:
            raise ValueError(f"--liked takes CONDITION=LOGODDS, not {words!r}")
    return Raters(
        liked,
        options.people_differ,
        options.items_differ,
        options.left,
        options.lapses,
        options.careless,
        options.unfinished,
        options.seed,
    )
