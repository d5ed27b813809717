"""Says, appends, interrupts, pauses, comes back and withdraws at random, beside the model of
`tests/live/test_utterance_machine.py`: python tests/reliability/random_utterances.py [sequences] [seed]

Each sequence (10,000) is a session of its own with up to 25 steps of two agents, then all is said to its end.
The first that is not as the model says is printed with its steps, and ends the run with code 1.
"""

from __future__ import annotations

import random
import sys
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.store import open_project  # noqa: E402
from tests.live.test_utterance_machine import AGENTS, UTTERANCES, WORDS, Utterances  # noqa: E402

STEERED = ("interrupt", "pause", "resume", "finish", "withdraw")
SHOWN = 500  # sequences between two lines of progress


def choose_step(r: random.Random) -> tuple[str, tuple[Any, ...]]:
    """Return the name of a step of the machine, and its arguments."""
    key = r.choice(UTTERANCES)
    steps: list[tuple[str, tuple[Any, ...]]] = [
        ("say", (key, r.choices(WORDS, k=r.randint(1, 6)))),
        ("append", (key, r.choice(WORDS))),
        ("append_words", (key, r.randint(1, 4))),
        ("steer", (key, r.choice(STEERED), r.random() < 0.3)),
        ("wait", (r.choice((1, 3, 20, 90)),)),
        ("come_back", (r.choice(AGENTS),)),
    ]
    return r.choices(steps, (2, 3, 2, 4, 3, 1))[0]


def play(seed: int) -> list[tuple[str, tuple[Any, ...]]]:
    """Play one sequence; return its steps if it is not as the model says."""
    r, machine = random.Random(seed), Utterances()
    steps: list[tuple[str, tuple[Any, ...]]] = []
    try:
        for _ in range(r.randint(3, 25)):
            steps.append(choose_step(r))
            getattr(machine, steps[-1][0])(*steps[-1][1])
            machine.what_is_over_owes_nothing()
        machine.teardown()
    except AssertionError as error:
        return [*steps, ("failed", (error,))]
    return []


def main(count: int, first: int) -> int:
    """Play many; return the exit code."""
    Utterances.project = open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project
    begin = time.monotonic()
    for n in range(count):
        wrong = play(first + n)
        if wrong:
            print(f"seed {first + n}:", *wrong, sep="\n  ")
            return 1
        if (n + 1) % SHOWN == 0 or n + 1 == count:
            print(f"{n + 1} sequences right, {time.monotonic() - begin:.0f} s", flush=True)
    return 0


if __name__ == "__main__":
    numbers = [int(word) for word in sys.argv[1:]]
    raise SystemExit(main(numbers[0] if numbers else 10_000, numbers[1] if len(numbers) > 1 else 1))
