"""Keys of many channels and takes that are evaluated at once give what each gives by itself, to the bit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.formats.gltf.reader import read_gltf_clips
from metagraph.formats.gltf.sampling import FrameGrid, KeyTable, sample_channels, sample_turns
from metagraph.motion import rotation

Array = Any
JOINTS = 9


def table_of(numbers: Array, width: int, groups: list[tuple[int, Array, list[int], list[int]]]) -> KeyTable:
    """Keys of groups of channels: take, key times, joints and where in the numbers each one's keys begin."""
    takes, times, joints, starts = zip(*groups, strict=True)
    which = np.repeat(np.arange(len(groups)), [len(own) for own in joints])
    whole = np.array(takes), which, np.concatenate(joints), np.concatenate(starts)
    return KeyTable(numbers, width, times, *whole)


def key_times(chance: np.random.Generator, grid: FrameGrid, kind: str) -> Array:
    """Key times as they come: those of the frames, some of them, any, one alone, some twice."""
    if kind == "frames":
        return grid.times
    if kind == "some":
        return grid.times[
            np.sort(chance.choice(len(grid.times), max(1, len(grid.times) // 3), replace=False))
        ]
    if kind == "one":
        return grid.times[:1] + 0.1
    times = np.sort(chance.uniform(-0.1, grid.times[-1] + 0.2, 7))
    return np.repeat(times, 2) if kind == "twice" else times


@given(st.integers(0, 10_000), st.lists(st.lists(st.sampled_from(["frames", "some", "any", "one", "twice"]))))
@settings(max_examples=60, deadline=None)
def test_turns_of_several_takes_at_once_are_those_of_each_group(seed: int, takes: list[list[str]]) -> None:
    chance = np.random.default_rng(seed)
    grids = [FrameGrid(1.5 + np.arange(frames) / 30, 30.0) for frames in chance.integers(1, 25, len(takes))]
    begins = np.cumsum([0, *(len(grid.times) for grid in grids)])
    expected = np.zeros((begins[-1], JOINTS, 4), np.float32)
    numbers, groups, at = [np.zeros(3, np.float32)], [], 3
    for take, kinds in enumerate(takes):
        free = chance.permutation(JOINTS)
        for kind in kinds[:4]:
            times = key_times(chance, grids[take], kind)
            joints, free = free[:2], free[2:]
            keys = rotation.normalize(chance.normal(size=(2, len(times), 4)).astype(np.float32))
            if chance.random() < 0.3:
                keys[:] = keys[:, :1]
            numbers.append(keys.reshape(-1))
            groups.append((take, times, joints.tolist(), [at, at + 4 * len(times)]))
            at += keys.size
            own = expected[begins[take] : begins[take + 1]]
            own[:, joints] = sample_channels(times, keys, grids[take], "LINEAR", True).transpose(1, 0, 2)
    out = np.zeros_like(expected)
    if groups:
        sample_turns(table_of(np.concatenate(numbers), 4, groups), grids, begins[:-1], out)
    assert out.tobytes() == expected.tobytes()


def test_a_table_can_be_had_of_some_of_its_channels() -> None:
    numbers = np.arange(40, dtype=np.float32)
    table = table_of(numbers, 3, [(0, np.arange(2.0), [4, 5], [0, 6]), (1, np.arange(3.0), [1], [12])])
    assert table.only(np.zeros(3, bool)) is None
    some = table.only(np.array([False, True, True]))
    assert some is not None and some.joints.tolist() == [5, 1] and some.takes[some.groups].tolist() == [0, 1]
    assert some.values.reshape(-1).tolist() == list(range(6, 21))
    assert some.some(1) == (slice(1, 2), slice(2, 5)) and some.most(some.values).tolist() == [11, 20]


def test_takes_made_together_are_those_made_one_by_one(
    shared_data: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = shared_data / "kaykit-rogue" / "Rogue.glb"
    together = read_gltf_clips(file)
    monkeypatch.setattr("metagraph.formats.gltf.clips.AT_ONCE", 0)
    monkeypatch.setattr("metagraph.formats.stray_poses.AT_ONCE", 0)
    for clip, alone in zip(together, read_gltf_clips(file), strict=True):
        assert (clip.name, clip.fps, clip.translated) == (alone.name, alone.fps, alone.translated)
        assert (clip.notes, clip.repairs) == (alone.notes, alone.repairs)
        assert clip.rotations.tobytes() == alone.rotations.tobytes()
        assert clip.translations.tobytes() == alone.translations.tobytes()
