"""Draw scenes into memory shared with `preview.drawing_apart`, which runs this module as a process of its
own.

It receives what all scenes have in common (figures, size, theme, the shared file, how many pictures it
holds), then one scene after the other, pickled by the parent. It sends an empty message when it has started,
and one for each picture drawn.
"""

from __future__ import annotations

import os
import pickle
from dataclasses import replace

import numpy as np

from metagraph.common.child_channel import connect_to_parent
from preview.offscreen import Offscreen


def main() -> None:
    os.environ["LP_NUM_THREADS"] = "1"  # each process uses one core
    channel = connect_to_parent()
    try:
        figures, size, theme, path, slots = pickle.loads(channel.receive())
        pool = np.memmap(path, np.uint8, "r+", shape=(slots, size[1], size[0], 4))
        with Offscreen(*size) as offscreen:
            channel.send(b"")
            while True:
                slot, scene, actors, numbers, camera = pickle.loads(channel.receive())
                there = (replace(a, figure=figures[n]) for a, n in zip(actors, numbers, strict=True))
                offscreen.render(replace(scene, actors=tuple(there)), camera, theme, into=pool[slot])
                channel.send(b"")
    except (EOFError, OSError):
        return  # the parent has all it wanted, or has ended


if __name__ == "__main__":
    main()
