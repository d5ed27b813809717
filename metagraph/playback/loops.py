"""Loading the compiled loops that poses are worked out with: forward kinematics, the layers of a plan,
contacts, weight and life. Until they are there, and where numba is not, NumPy gives the same poses to 1e-5.
"""

from __future__ import annotations

from contextlib import suppress
from threading import Lock, Thread

from metagraph.compiling import there
from metagraph.motion import forward
from metagraph.playback import laid_plan, solving
from metagraph.playback.life import living
from metagraph.programs import python, run

LOOPS = (forward.COMPILED, solving.COMPILED, laid_plan.COMPILED, living.COMPILED)

_one = Lock()
_begun: list[Thread] = []


def loaded() -> bool:
    """Whether poses are worked out by compiled loops."""
    return all(loops.now is not None for loops in LOOPS)


def load() -> bool:
    """Load the loops, and return whether they are there: numba is not installed for them. Milliseconds where
    their object code is kept; else a second, and the first time ever, when they are compiled, half a minute.
    """
    with _one:
        if not loaded() and there():
            for loops in LOOPS:
                loops.load()
    return loaded()


def load_kept() -> bool:
    """Load those loops whose object code is kept, in milliseconds; return whether all are loaded."""
    with _one:
        for loops in LOOPS:
            loops.load_kept()
    return loaded()


def load_soon() -> None:
    """Load the loops on a thread, once a process. Another process compiles them first, where that has to be
    done, so that this one keeps its breath; where what it makes cannot be kept, they are not loaded.
    """
    if not _begun and there() and not loaded():
        _begun.append(Thread(target=_beside, name="loops", daemon=True))
        _begun[0].start()


def _beside() -> None:
    with suppress(OSError):
        if run(python("metagraph.keep_loops"))[0] == 0:
            load()
