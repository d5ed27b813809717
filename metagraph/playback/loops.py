"""Loading the compiled loops that poses are worked out with: forward kinematics, the layers of a plan,
contacts, weight and life. Until they are there, and where numba is not, NumPy gives the same poses to 1e-5.
"""

from __future__ import annotations

import os
import subprocess
import sys
from threading import Lock, Thread

from metagraph.compiling import ROOT, there, unkept
from metagraph.motion import forward
from metagraph.playback import laid_plan, solving
from metagraph.playback.life import living

LOOPS = (forward.COMPILED, solving.COMPILED, laid_plan.COMPILED, living.COMPILED)

_one = Lock()
_begun: list[Thread] = []


def loaded() -> bool:
    """Whether poses are worked out by compiled loops."""
    return all(loops.now is not None for loops in LOOPS)


def load() -> bool:
    """Load the loops, and return whether they are there: numba is not installed for them. A second; the first
    time ever they are compiled, half a minute.
    """
    with _one:
        if not loaded() and there():
            for loops in LOOPS:
                loops.load()
    return loaded()


def load_soon() -> None:
    """Load the loops on a thread, once a process. Another process compiles them first, where that has to be
    done, so that this one keeps its breath; where what it makes cannot be kept, they are not loaded.
    """
    if not _begun and there() and not loaded():
        _begun.append(Thread(target=_beside, name="loops", daemon=True))
        _begun[0].start()


def _beside() -> None:
    if subprocess.run([sys.executable, "-m", __name__], cwd=ROOT, capture_output=True).returncode == 0:
        load()


if __name__ == "__main__":
    if hasattr(os, "nice"):
        os.nice(10)  # nobody waits for it
    sys.exit(0 if load() and not unkept else 1)
