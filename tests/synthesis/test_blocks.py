"""Graphs made block by block: whoever makes the blocks, and however often it was ended on the way, edges are
the same.
"""

from __future__ import annotations

import itertools
import multiprocessing
import os
import signal
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from metagraph.synthesis import blocks, kernels
from metagraph.synthesis.blocks import BlockMakers
from metagraph.synthesis.graph import MotionGraph, Threshold, build_graph
from metagraph.synthesis.states import States, SynthesisError, key_states, with_velocity

LIMIT = Threshold(3, 0.95, np.zeros(0), None, 0.6, 0.6)


def made(frames: int = 6000, joints: int = 4, seed: int = 1) -> States:
    chance = np.random.default_rng(seed)
    t = np.arange(frames)[:, None, None] / 30
    places = sum(
        chance.normal(0, 0.2, (1, joints, 3)) * np.sin(t * w + chance.uniform(0, 6, (1, joints, 3)))
        for w in (0.7, 1.9, 3.1)
    )
    places = np.asarray(places, np.float32)
    starts = np.linspace(0, frames, 4).astype(int)
    velocities = np.concatenate(
        [np.gradient(places[a:b], 1 / 30, axis=0) for a, b in itertools.pairwise(starts)]
    )
    return with_velocity(
        States(places, velocities.astype(np.float32), np.ones(joints, np.float32), starts, 0.0), 1 / 30
    )


def line(frames: int, scale: float = 1.0) -> States:
    """Return states that move straight on, so that what is on the other side of a middle is just as much
    farther as it can be.
    """
    places = np.zeros((frames, 1, 3), np.float32)
    places[:, 0, 0] = scale * np.arange(frames)
    return States(places, np.zeros_like(places), np.ones(1, np.float32), np.array([0, frames]), 1 / 30)


def same(one: MotionGraph, other: MotionGraph) -> None:
    for field in ("starts", "targets", "costs", "kept"):
        assert_array_equal(getattr(one, field), getattr(other, field))


def files(folder: Path) -> dict[str, int]:
    return {p.name: p.stat().st_mtime_ns for p in folder.rglob("*.npz")}


def test_a_build_that_is_ended_takes_up_where_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(blocks, "BLOCK", 128)
    states = made()
    keys = key_states(states)
    whole = build_graph(states, LIMIT, keys, most=60)
    seen: list[int] = []
    with pytest.raises(SynthesisError, match="cancelled"):
        build_graph(
            states,
            LIMIT,
            keys,
            most=60,
            makers=BlockMakers(threads=1, folder=tmp_path),
            progress=lambda n, _: seen.append(n),
            cancelled=lambda: len(seen) >= 3,
        )
    kept = files(tmp_path)
    assert 3 <= len(kept) < len(keys) // 128
    told: list[tuple[int, int]] = []
    same(
        build_graph(
            states,
            LIMIT,
            keys,
            most=60,
            makers=BlockMakers(folder=tmp_path),
            progress=lambda n, total: told.append((n, total)),
        ),
        whole,
    )
    assert told[0][0] >= 3 * 128 and told[-1] == (len(keys), len(keys))
    after = files(tmp_path)
    assert all(after[name] == at for name, at in kept.items()), "what was there is not made again"
    same(build_graph(states, LIMIT, keys, most=60, makers=BlockMakers(folder=tmp_path)), whole)
    assert files(tmp_path) == after


def _slowly(folder: Path) -> None:
    blocks.BLOCK = 128
    states = made()
    build_graph(
        states,
        LIMIT,
        key_states(states),
        most=60,
        makers=BlockMakers(threads=1, folder=folder),
        progress=lambda n, total: time.sleep(0.2),
    )


def test_a_process_that_is_killed_leaves_whole_blocks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    child = multiprocessing.get_context("spawn").Process(target=_slowly, args=(tmp_path,))
    child.start()
    assert child.pid is not None
    while len(files(tmp_path)) < 2 and child.is_alive():
        time.sleep(0.01)
    os.kill(child.pid, signal.SIGTERM if os.name == "nt" else signal.SIGKILL)
    child.join()
    kept = files(tmp_path)
    monkeypatch.setattr(blocks, "BLOCK", 128)
    states = made()
    keys = key_states(states)
    assert 2 <= len(kept) < len(keys) // 128
    same(
        build_graph(states, LIMIT, keys, most=60, makers=BlockMakers(folder=tmp_path)),
        build_graph(states, LIMIT, keys, most=60),
    )
    assert all(files(tmp_path)[name] == at for name, at in kept.items())


def test_blocks_of_other_inputs_are_not_taken(tmp_path: Path) -> None:
    states = made(1500)
    keys = key_states(states)
    build_graph(states, LIMIT, keys, makers=BlockMakers(folder=tmp_path))
    other = made(1500, seed=2)
    changed = (
        (other, LIMIT, key_states(other), None),
        (states, replace(LIMIT, limit=0.5), keys, None),
        (states, LIMIT, keys[::2], None),
        (states, LIMIT, keys, 7),
        (with_velocity(states, 0.05), LIMIT, keys, None),
    )
    for some, limit, which, most in changed:
        same(
            build_graph(some, limit, which, most, makers=BlockMakers(folder=tmp_path)),
            build_graph(some, limit, which, most),
        )
    assert len(list(tmp_path.iterdir())) == 6, "each in a folder of its own"


def test_a_spoiled_block_is_made_again(tmp_path: Path) -> None:
    states = made(3000)
    keys = key_states(states)
    whole = build_graph(states, LIMIT, keys, makers=BlockMakers(folder=tmp_path))
    some = sorted(tmp_path.rglob("*.npz"))
    some[0].write_bytes(some[0].read_bytes()[:100])
    some[-1].write_bytes(b"")
    same(build_graph(states, LIMIT, keys, makers=BlockMakers(folder=tmp_path)), whole)


def test_one_thread_and_many_make_the_same() -> None:
    states = made(3000)
    same(
        build_graph(states, LIMIT, makers=BlockMakers(threads=1)),
        build_graph(states, LIMIT, makers=BlockMakers(threads=4)),
    )


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("straight", [True, False])
def test_only_what_is_too_far_is_passed_over(straight: bool, scale: float) -> None:
    """Whole blocks are, by their middles; whatever the units, and at limits that a pair just keeps to."""
    states = line(700, scale) if straight else made(700)
    if not straight:
        states = replace(states, places=states.places * np.float32(scale))
    keys = np.arange(len(states))
    costs = np.sort(blocks.make_block(blocks.prepare_blocks(states, keys, 1e9, None), 0)[2])
    for limit in costs[np.linspace(0, len(costs) - 1, 25).astype(int)]:
        work = blocks.prepare_blocks(states, keys, float(limit), None)
        unbounded = replace(work, reach=np.full_like(work.reach, np.inf))
        for some, whole in zip(blocks.make_block(work, 0), blocks.make_block(unbounded, 0), strict=True):
            assert_array_equal(some, whole)


def test_blocks_whose_middles_are_far_are_not_looked_at() -> None:
    work = blocks.prepare_blocks(line(6000), np.arange(6000), 0.3, None)
    row, every = work.rows[700], np.empty_like(work.blocks)
    every[:] = row.T[None, :, :, None]  # whatever is looked at is found
    count, found = every.shape[0] * kernels.LANES, np.empty(1, np.int64)
    kernels.find_near(
        row[None],
        every,
        work.middles,
        work.reach,
        count,
        np.float32(0.3),
        np.empty((1, count), np.int32),
        np.empty((1, count), np.float32),
        found,
    )
    near = np.linalg.norm(row - work.middles, axis=1).sum(-1) <= work.reach
    assert found[0] == near.sum() * kernels.LANES and 0 < near.mean() < 0.5


def test_what_fails_in_a_block_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> object:
        raise MemoryError("no room")

    monkeypatch.setattr(blocks, "make_block", broken)
    with pytest.raises(MemoryError, match="no room"):
        build_graph(made(1500), LIMIT)


@pytest.mark.nightly
@pytest.mark.filterwarnings("ignore")  # of Dask, about its own parts
def test_a_cluster_makes_the_same_edges(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed", reason="needs the extra 'cluster' (Dask)")
    states = made(3000)
    keys = key_states(states)
    whole = build_graph(states, LIMIT, keys, most=40)
    told: list[tuple[int, int]] = []
    with (
        distributed.LocalCluster(
            n_workers=1,
            threads_per_worker=2,
            processes=False,
            protocol="tcp",
            host="127.0.0.1",
            dashboard_address=None,
            local_directory=str(tmp_path),
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        same(
            build_graph(
                states,
                LIMIT,
                keys,
                most=40,
                makers=BlockMakers(cluster=client),
                progress=lambda n, total: told.append((n, total)),
            ),
            whole,
        )
        assert told[-1] == (len(keys), len(keys))
        same(
            build_graph(
                states, LIMIT, keys, most=40, makers=BlockMakers(folder=tmp_path / "kept", cluster=client)
            ),
            whole,
        )
        with pytest.raises(SynthesisError, match="cancelled"):
            build_graph(states, LIMIT, keys, makers=BlockMakers(cluster=client), cancelled=lambda: True)
    kept = files(tmp_path / "kept")
    same(build_graph(states, LIMIT, keys, most=40, makers=BlockMakers(folder=tmp_path / "kept")), whole)
    assert files(tmp_path / "kept") == kept, "a cluster's blocks are this machine's"
