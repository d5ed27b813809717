"""Pictures of a video drawn in other processes, where the processor draws: one process draws on one core,
whatever the machine has, since most of the work is placing triangles.
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

MOST = 4  # processes; more would wait for whoever encodes
# Pictures from which on starting processes costs less than it saves: each takes a second of a core, so that
# two cores gain a seventh over a minute, and nothing over ten seconds.
WORTH, LEAST = 900, 300
WORTH_LEVELS = 90  # pictures that making meshes with fewer triangles pays for
PATIENCE = 2.0  # seconds for a process to end by itself
WAITING = 4  # pictures under way for each process


def draw_scenes(
    scenes: Iterable[Seen],
    count: int,
    size: tuple[int, int],
    theme: SceneTheme,
    into: Array | None = None,
    processes: int | None = None,
) -> Iterator[Array]:
    """Yield a picture `[H, W, 4]` uint8 for each scene, in order; see `Offscreen.render`.

    count: how many there will be, about. into: an array that pictures may come in, for who is done with one
    before asking for the next; without it each is a new one. processes: how many draw beside this one; by
    default as many as there are cores, 4 at most, and none where a graphics card draws or there are few
    pictures. Pictures are the same wherever they are drawn.
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
    """Draw here until the others have come up, then gather what they draw. Whatever goes wrong there is drawn
    here.
    """
    figures = list({id(a.figure): a.figure for a in first.actors}.values())
    for figure in figures:
        _ = figure.boxes  # once, for all
    width, height = here.size
    slots = processes * WAITING + 1  # one more, that is looked at
    pool = np.memmap(path, np.uint8, "w+", shape=(slots, height, width, 4))
    begin = pickle.dumps((figures, here.size, theme, str(path), slots))
    drawers = [Child("preview.drawing_child") for _ in range(processes)]
    free: queue.SimpleQueue[Child] = queue.SimpleQueue()
    executor = ThreadPoolExecutor(processes)  # a thread waits for each of them
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
                    break  # so that they find some to draw when they have come
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
    """Tell one what it will draw, and wait until it has come up."""
    try:
        drawer.send(begin)
        drawer.receive()
    finally:
        free.put(drawer)  # one that has ended says so to whoever asks it


def _submitted(
    executor: ThreadPoolExecutor,
    free: queue.SimpleQueue[Child],
    figures: Sequence[MeshFigure],
    seen: Seen,
    slot: int,
) -> Future[int] | None:
    """Hand a scene out; None where somebody is in it the others do not know."""
    scene, camera = seen
    numbers = [n for a in scene.actors for n, f in enumerate(figures) if f is a.figure]
    if len(numbers) < len(scene.actors):
        return None
    # Figures are known there by their number: a mesh is kept by who it is.
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
