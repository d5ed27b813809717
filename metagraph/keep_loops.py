"""Compiles the loops of playback and of readers of clips, where that is not done yet, and keeps their object
code, so that other processes need no compiler: python -m metagraph.keep_loops

Ends with 1 where they could not be kept, neither so nor by numba.
"""

from __future__ import annotations

import os
import sys

from metagraph.compiling import Loops, kept_by_numba, there, unkept
from metagraph.formats import bvh, gltf_loops, stray_poses
from metagraph.playback import loops
from metagraph.programs import python, run

BY_NUMBA = "by-numba"
ALL = (*loops.LOOPS, bvh.COMPILED, stray_poses.COMPILED, gltf_loops.TEXT, gltf_loops.KEYS)


def keep() -> bool:
    """Return whether loops are kept: as object code or, where that is not to be had, by numba. numba is not
    installed for them.
    """
    if not there():
        return False
    if all([_kept(known) for known in ALL]):  # noqa: C419 - as many as can be
        return True
    if kept_by_numba[0]:
        return loops.load() and not unkept
    # What was compiled here is not kept by numba, but what another process compiles.
    return run(python("metagraph.keep_loops", BY_NUMBA))[0] == 0


def _kept(known: Loops) -> bool:
    try:
        return known.keep()
    except Exception:  # numba's inner ways change: then its own cache has to do
        return False


if __name__ == "__main__":
    if hasattr(os, "nice"):
        os.nice(10)  # nobody waits for it
    done = loops.load() and not unkept if sys.argv[1:] == [BY_NUMBA] else keep()
    sys.exit(0 if done else 1)
