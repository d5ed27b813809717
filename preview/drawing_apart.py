"""Draw the pictures of a video in several processes if the processor draws. One process uses one core,
however many the machine has, because most of the work is placing triangles.
"""

from __future__ import annotations

import itertools
import os
import pickle
import queue
import tempfile
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.child_channel import Child
from preview.camera import Camera
from preview.figure import MeshFigure
from preview.offscreen import Offscreen
from preview.scene import Scene, SceneTheme

Array = NDArray[Any]
Seen = tuple[Scene, Camera]

MOST = 4  # processes; more of them would wait for the encoder
# The number of pictures from which starting processes saves time. Each start takes a second of one core, so
# two cores gain a seventh in a video of a minute and nothing in one of ten seconds.
WORTH, LEAST = 900, 300
WORTH_LEVELS = 90  # pictures; from this number on, making meshes with fewer triangles saves time
PATIENCE = 2.0  # seconds for a process to end by itself
WAITING = 4  # pictures in progress for each process


def draw_scenes(
    scenes: Iterable[Seen],
    count: int,
    size: tuple[int, int],
    theme: SceneTheme,
    into: Array | None = None,
    processes: int | None = None,
) -> Iterator[Array]:
    """Yield a picture `[H, W, 4]` uint8 for each scene, in order; see `Offscreen.render`.

    `count` is about how many pictures there will be. `into` is an array that pictures may be written to, for
    callers that are done with one picture before they take the next; without it each picture is a new array.
    `processes` is how many processes draw beside this one: by default as many as there are cores, at most 4,
    and none if a graphics card draws or if there are few pictures. Pictures are the same wherever they are
    drawn.
    """
    scenes = iter(scenes)
    with Offscreen(*size) as here:
        if processes is None:
            cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
            apart = cores > 1 and count >= max(LEAST, WORTH // (cores - 1)) and here.renderer.software
            processes = min(MOST, cores) if apart else 0
        first = next(scenes, None)
        if first is None:
            return
        scenes = itertools.chain([first], scenes)
        if count >= WORTH_LEVELS:
            for actor in first[0].actors:
                actor.figure.simplify()
        if not processes:
            for scene, camera in scenes:
                yield here.render(scene, camera, theme, into=into)
            return
        with tempfile.TemporaryDirectory(prefix="metagraph-pictures-") as folder:
            yield from _drawn_apart(scenes, first[0], here, theme, into, processes, Path(folder) / "pictures")


def _drawn_apart(
    scenes: Iterator[Seen],
    first: Scene,
    here: Offscreen,
    theme: SceneTheme,
    into: Array | None,
    processes: int,
    path: Path,
) -> Iterator[Array]:
    """Draw here until the other processes have started, then collect what they draw. If one fails, its
    pictures are drawn here.
    """
    figures = list({id(a.figure): a.figure for a in first.actors}.values())
    for figure in figures:
        _ = figure.boxes  # computed once here, not in each process
    width, height = here.size
    slots = processes * WAITING + 1  # one more for the picture that the caller looks at
    pool = np.memmap(path, np.uint8, "w+", shape=(slots, height, width, 4))
    begin = pickle.dumps((figures, here.size, theme, str(path), slots))
    drawers = [Child("preview.drawing_child") for _ in range(processes)]
    free: queue.SimpleQueue[Child] = queue.SimpleQueue()
    executor = ThreadPoolExecutor(processes)  # one thread waits for each process
    come = [executor.submit(_begin, drawer, begin, free) for drawer in drawers]
    waiting: deque[tuple[Future[int] | None, Seen]] = deque()
    broken = False
    number = 0
    try:
        while True:
            while len(waiting) < slots - 1 and (seen := next(scenes, None)) is not None:
                ready = any(one.done() for one in come)
                task = (
                    _submitted(executor, free, figures, seen, number % slots)
                    if ready and not broken
                    else None
                )
                waiting.append((task, seen))
                number += 1
                if not ready:
                    break  # so that the processes find some left to draw when they have started
            if not waiting:
                return
            task, (scene, camera) = waiting.popleft()
            picture: Array | None = None
            if task is not None:
                try:
                    picture = pool[task.result()]
                except (OSError, EOFError):  # it has ended
                    broken = True
            if picture is None:
                yield here.render(scene, camera, theme, into=into)
            elif into is None:
                yield np.array(picture)
            else:
                into[...] = picture
                yield into
    finally:
        for task, _ in waiting:
            if task is not None:
                task.cancel()
        executor.shutdown(wait=True, cancel_futures=True)
        for drawer in drawers:
            drawer.close(PATIENCE)
        del pool


def _begin(drawer: Child, begin: bytes, free: queue.SimpleQueue[Child]) -> None:
    """Send a process what it will draw, and wait until it has started."""
    try:
        drawer.send(begin)
        drawer.receive()
    finally:
        free.put(drawer)  # one that has ended raises at its next use


def _submitted(
    executor: ThreadPoolExecutor,
    free: queue.SimpleQueue[Child],
    figures: Sequence[MeshFigure],
    seen: Seen,
    slot: int,
) -> Future[int] | None:
    """Give a scene to a process. Return None if it has a figure that the processes do not know."""
    scene, camera = seen
    numbers = [n for a in scene.actors for n, f in enumerate(figures) if f is a.figure]
    if len(numbers) < len(scene.actors):
        return None
    # The processes know figures by their number, because a mesh is kept by its identity.
    actors = [replace(a, figure=None) for a in scene.actors]  # type: ignore[arg-type]
    order = pickle.dumps((slot, replace(scene, actors=()), actors, numbers, camera))

    def draw() -> int:
        drawer = free.get()
        try:
            drawer.send(order)
            drawer.receive()
        finally:
            free.put(drawer)
        return slot

    return executor.submit(draw)
