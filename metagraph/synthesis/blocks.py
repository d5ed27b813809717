"""The transitions of a motion graph block by block: on all cores of a machine or on a cluster, kept in a
folder to take up again.

A block is some key states beside all others. Blocks need nothing of each other: whoever makes them, in
whatever order, makes the same.
"""

from __future__ import annotations

import hashlib
import os
import zipfile
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from importlib import import_module
from itertools import islice
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.synthesis.states import States, SynthesisError, compute_cost_terms

Array = NDArray[Any]
Block = tuple[
    Array, Array, Array
]  # how many transitions each key state has `[R]`, where they go `[E]`, what they cost `[E]`

BLOCK = 512  # key states of a block
ROWS = 64  # key states compared with all others at once
FORMAT = 2  # of what is kept in folders
SAMPLE = 20_000  # key states that tell which terms differ most
FAR = np.float32(1e18)
CANCELLED = "the motion graph was cancelled"


@dataclass(frozen=True, eq=False)
class BlockWork:
    """What all blocks are made from. rows `[K, 3, T]`: the terms of key states, those that differ most first;
    keys `[K]`: which states they are. blocks `[B, T, 3, 64]`: the terms of the frames before `into [N]`, the
    states transitions may enter, filled up with what is far from everything. middles `[B, 3, T]`: the means
    of blocks; reach `[B]`: what is farther from a block's than that is farther than the limit from all of the
    block. limit: what a transition may cost; most: how many of a state's cheapest are kept, all when None.
    """

    rows: Array
    keys: Array
    blocks: Array
    middles: Array
    reach: Array
    into: Array
    limit: float
    most: int | None

    @property
    def firsts(self) -> range:
        """Where blocks begin among the key states."""
        return range(0, len(self.keys), BLOCK)

    @property
    def digest(self) -> str:
        """Report work apart: the same for the same inputs alone."""
        told = hashlib.blake2b(f"{FORMAT} {BLOCK} {self.limit!r} {self.most}".encode(), digest_size=12)
        for array in (self.rows, self.keys, self.blocks, self.into):
            told.update(f"{array.shape} {array.dtype}".encode())
            told.update(np.ascontiguousarray(array).reshape(-1).view(np.uint8).data)
        return told.hexdigest()


def prepare_blocks(states: States, keys: Array, limit: float, most: int | None) -> BlockWork:
    """Return what the blocks of a graph are made from. Only key states are copied, whatever the number of
    frames.

    To go from i to j costs as much as i differs from j - 1, so a state that is entered has a frame before it
    in its take.
    """
    from metagraph.synthesis.kernels import LANES, lay

    first = np.zeros(len(states), bool)
    first[states.starts[:-1]] = True
    into = keys[~first[keys]]
    rows = compute_cost_terms(states, keys)
    order = _order(rows[:: max(1, len(keys) // SAMPLE)])
    rows = _planes(rows, order)
    count = -(-len(into) // LANES)
    blocks = np.empty((count, len(order), 3, LANES), np.float32)
    middles, spread = np.empty((count, 3, len(order)), np.float32), np.empty(count, np.float32)
    for n in range(0, count, LANES):
        some, part = into[n * LANES : (n + LANES) * LANES] - 1, slice(n, n + LANES)
        lay(_planes(compute_cost_terms(states, some), order), FAR, blocks[part], middles[part], spread[part])
    # Costs are a metric: what is farther from a middle is farther than the limit from whatever is round it.
    # Sums in 32 bits may be off by some of the last of them.
    largest = float(np.abs(rows).max(initial=0.0) + spread.max(initial=0.0))
    slack = 4e-6 * len(order) * largest
    return BlockWork(rows, keys, blocks, middles, spread + np.float32(limit + slack), into, limit, most)


def _planes(terms: Array, order: Array) -> Array:
    """Return terms `[N, T, 3]` in another order, as `[N, 3, T]`."""
    return np.take(terms.transpose(0, 2, 1), order, axis=2)


def _order(terms: Array) -> Array:
    """Return terms with those that differ most first, so that most pairs are over the limit after a few."""
    x, y, z = (terms - terms.mean(0)).transpose(2, 0, 1)
    return np.argsort(-np.sqrt(x * x + y * y + z * z).mean(0), kind="stable")


def make_block(work: BlockWork, first: int, cancelled: Callable[[], bool] | None = None) -> Block:
    """Return the transitions of the key states from the `first` on, one after another, targets ascending.
    Raises SynthesisError when it was cancelled.
    """
    from metagraph.synthesis.kernels import find_near, pack_rows, thin

    count = len(work.into)
    size = min(ROWS, len(work.keys) - first)
    places, price = np.empty((size, count), np.int32), np.empty((size, count), np.float32)
    out: list[Block] = []
    for begin in range(first, min(first + BLOCK, len(work.keys)), ROWS):
        if cancelled is not None and cancelled():
            raise SynthesisError(CANCELLED)
        rows = work.keys[begin : min(begin + ROWS, first + BLOCK)]
        found = np.empty(len(rows), np.int64)
        find_near(
            work.rows[begin : begin + len(rows)],
            work.blocks,
            work.middles,
            work.reach,
            count,
            np.float32(work.limit),
            places,
            price,
            found,
        )
        counts = found.copy()
        targets, costs = pack_rows(places, price, found, work.into, rows, counts)
        if work.most is not None:
            targets, costs = thin(counts, targets, costs, work.most)
        out.append((counts, targets, costs))
    counts, targets, costs = (np.concatenate(parts) for parts in zip(*out, strict=True))
    return counts, targets, costs


@dataclass(frozen=True)
class BlockMakers:
    """Who makes blocks. threads: of this machine, else as many as it has cores. folder: where finished blocks
    are kept and taken up from, so that a build that was ended goes on where it was; those of each work are in
    a folder of its own: other inputs, other blocks. cluster: a `distributed.Client`; its workers make the
    blocks, else the threads do.
    """

    threads: int | None = None
    folder: Path | None = None
    cluster: Any = None


THIS_MACHINE = BlockMakers()


def compute_transitions(
    work: BlockWork,
    makers: BlockMakers = THIS_MACHINE,
    progress: Callable[[int, int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Block:
    """Return the transitions of all key states. Raises SynthesisError when it was cancelled."""
    kept = _Kept(None if makers.folder is None else makers.folder / work.digest)
    rows = {first: len(b[0]) for first in work.firsts if (b := kept.get(first)) is not None}
    so_far, total = sum(rows.values()), len(work.keys)
    if progress is not None and so_far:
        progress(so_far, total)
    missing = [first for first in work.firsts if first not in rows]
    made = (
        _here(work, missing, cancelled, makers.threads)
        if makers.cluster is None
        else _there(work, missing, cancelled, makers.cluster)
    )
    for first, new in made:
        kept.put(first, new)
        so_far += len(new[0])
        if progress is not None:
            progress(so_far, total)
    return kept.joined(work.firsts)


class _Kept:
    """Finished blocks, in a folder, or in memory if there is none. A file is there as a whole or
    not at all.
    """

    def __init__(self, folder: Path | None) -> None:
        self.folder = folder
        self.blocks: dict[int, Block] = {}
        self.counts: dict[int, Array] = {}  # of all that are there
        if folder is not None:
            folder.mkdir(parents=True, exist_ok=True)

    def get(self, first: int) -> Block | None:
        if self.folder is None:
            return self.blocks.get(first)
        try:
            with self._place(first).open("rb") as file, np.load(file, allow_pickle=False) as held:
                found = held["counts"], held["targets"], held["costs"]
        except (FileNotFoundError, KeyError, ValueError, EOFError, zipfile.BadZipFile):
            return None  # not made yet, or spoiled: it is made again
        self.counts[first] = found[0]
        return found

    def put(self, first: int, block: Block) -> None:
        self.counts[first] = block[0]
        if self.folder is None:
            self.blocks[first] = block
            return
        counts, targets, costs = block
        place = self._place(first)
        part = place.with_suffix(f".{os.getpid()}.part")
        with part.open("wb") as file:
            np.savez(file, counts=counts, targets=targets, costs=costs)
        part.replace(place)

    def joined(self, firsts: range) -> Block:
        """Return all blocks as one, letting go of one after another, so that there are never two of
        everything.
        """
        counts = np.concatenate([self.counts[first] for first in firsts])
        size = int(counts.sum())
        targets, costs, at = np.empty(size, np.int32), np.empty(size, np.float32), 0
        for first in firsts:
            found = self.get(first)
            if found is None:
                raise SynthesisError(
                    f"{self._place(first)} is gone: leave the folder alone while a graph is built, and build "
                    "again"
                )
            _, some, price = found
            targets[at : at + len(some)], costs[at : at + len(some)] = some, price
            at += len(some)
            self.blocks.pop(first, None)
        return counts, targets, costs

    def _place(self, first: int) -> Path:
        assert self.folder is not None
        return self.folder / f"{first:09d}.npz"


def _here(
    work: BlockWork, firsts: list[int], cancelled: Callable[[], bool] | None, threads: int | None
) -> Iterator[tuple[int, Block]]:
    """Make blocks on this machine's cores; a few are under way at a time, so that what was made does not wait
    in memory.
    """
    count = threads or os.cpu_count() or 1
    stop = Event()

    def cancel() -> bool:
        return stop.is_set() or (cancelled is not None and cancelled())

    with ThreadPoolExecutor(count) as pool:
        under_way: dict[Future[Block], int] = {}
        waiting = iter(firsts)
        try:
            while True:
                for first in islice(waiting, 2 * count - len(under_way)):
                    under_way[pool.submit(make_block, work, first, cancel)] = first
                if not under_way:
                    return
                for future in wait(under_way, return_when=FIRST_COMPLETED).done:
                    yield under_way.pop(future), future.result()
        finally:  # whoever gave up, or failed: the others need not go on
            stop.set()


def _there(
    work: BlockWork, firsts: list[int], cancelled: Callable[[], bool] | None, cluster: Any
) -> Iterator[tuple[int, Block]]:
    """Make blocks on a Dask cluster, which is sent the work once."""
    distributed: Any = import_module("distributed")
    if cancelled is not None and cancelled():
        raise SynthesisError(CANCELLED)
    sent = cluster.scatter(work, broadcast=True, hash=False)
    futures = {cluster.submit(make_block, sent, first, pure=False): first for first in firsts}
    try:
        for future in distributed.as_completed(list(futures)):
            yield futures.pop(future), future.result()
            if cancelled is not None and cancelled():
                raise SynthesisError(CANCELLED)
    finally:
        cluster.cancel(list(futures))
