"""The mismatched-speech protocol: the same motion with the sound it belongs to and with that of another
stretch, one after the other; which sound belongs to it?

It asks how well motion goes with speech and not how real it looks, as the image is the same in both. Half of
the answers are right by chance. Faces are still, as lips would give the answer away.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import deepcopy

import yaml

from metagraph.research.study.perceive.perceive_plan import PerceivePlan

OWN, OTHER = "own", "other"  # ends of the names of a system's two conditions
QUESTION = "In which of the two does the sound belong to the motion?"
LEAST = 2  # stretches, as the sound of another one is needed


def list_stretches(length: float, seconds: float, most: int) -> list[tuple[float, float]]:
    """Return (start, seconds) of stretches that do not overlap, evenly over a length. Raises ValueError if
    there are fewer than two.
    """
    count = min(most, int(length / seconds + 1e-9))
    if count < LEAST:
        raise ValueError(
            f"{length:.1f} s have no {LEAST} stretches of {seconds:g} s: take shorter ones, or longer speech"
        )
    room = (length - count * seconds) / count
    return [(round(n * (seconds + room) + room / 2, 3), seconds) for n in range(count)]


def list_mismatched_systems(plan: PerceivePlan) -> dict[str, tuple[str, str]]:
    """Return system -> its pair of conditions, of which the second has another's sound; none in a plan that
    asks something else.
    """
    return {
        pair[0].removesuffix(f"-{OWN}"): pair
        for pair in plan.pairs
        if plan.conditions[pair[0]].sound != "mismatched" and plan.conditions[pair[1]].sound == "mismatched"
    }


def make_mismatched_plan(
    title: str,
    participants: int,
    systems: Mapping[str, Mapping[str, object]],
    stretches: Sequence[tuple[float, float]],
    project: str | None = None,
    each: int | None = None,
) -> str:
    """Return the text of a plan. systems: name -> what its condition shows, as a plan has it. each: answers
    of a person, None for one about every stretch of every system. Raises ValueError without a system.
    """
    if not systems:
        raise ValueError("there is no system to ask about")
    conditions: dict[str, object] = {}
    for name, shown in systems.items():
        shows = {**shown, "face": "still"}  # or lips would tell
        conditions[f"{name}-{OWN}"] = {"title": f"{name}, its own sound", **deepcopy(shows)}
        other = {"title": f"{name}, another sound", **deepcopy(shows), "sound": "mismatched"}
        conditions[f"{name}-{OTHER}"] = other
    plan: dict[str, object] = {
        "perceive": 1,
        "title": title,
        "participants": participants,
        **({"project": project} if project is not None else {}),
        "consent": "You take part of your own free will, and can stop at any time. Put the text of your "
        "ethics board here.",
        "instructions": "You see the same motion twice, each time with another sound. Watch and listen "
        "to both to their ends, then choose the one whose sound belongs to the motion. Use headphones.",
        "conditions": conditions,
        "compare": [[f"{name}-{OWN}", f"{name}-{OTHER}"] for name in systems],
        "items": [
            {"id": f"s{n:02d}", "start": start, "seconds": seconds}
            for n, (start, seconds) in enumerate(stretches, 1)
        ],
        "choice": {"question": QUESTION, "present": "after", **({"each": each} if each is not None else {})},
        "checks": {"told": 2},
    }
    words = "# The same motion with its own sound and with another's: which belongs? Half is chance.\n"
    return words + yaml.safe_dump(plan, sort_keys=False, allow_unicode=True, width=110)
