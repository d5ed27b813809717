"""Read the channels of a glTF file's animations as columns of numbers, because a file has thousands
of them.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.gltf.columns import MODES, NO_MODE, SCALE, TRANSLATION, UNKNOWN, WEIGHTS, ChannelTable
from metagraph.formats.gltf.file import Gltf

Array = NDArray[Any]

_NAMES = tuple(MODES)


@dataclass(frozen=True, eq=False)
class JointChannels:
    """The channels that move joints, sorted into groups that share key times, mode and path. The groups are
    in the order of the animations.

    `begins` `[G + 1]` says where each group's channels are. `takes`, `sources`, `modes`, `paths` `[G]` have
    each group's animation, the accessor of its key times, its mode and its path. `joints` and `outputs` `[C]`
    are those of each channel. `doubled` has the animations and paths in which two channels move one joint.
    """

    begins: Array
    takes: Array
    sources: Array
    modes: Array
    paths: Array
    joints: Array
    outputs: Array
    doubled: frozenset[tuple[int, int]]

    @classmethod
    def of(cls, table: ChannelTable, places: dict[int, int], nodes: int, accessors: int) -> JointChannels:
        """Make the groups. `places` has the joint of each node. Channels of other nodes are left out: those
        nodes never move, and their transform is part of a joint's.
        """
        joint_of = np.full(nodes + 1, -1)  # the last one is for no node
        joint_of[list(places)] = list(places.values())
        node = table.nodes
        joints = joint_of[np.where((node < 0) | (node > nodes), nodes, node)]
        kept = np.flatnonzero((joints >= 0) & (table.paths <= SCALE) & (table.inputs >= 0))
        takes = np.repeat(np.arange(len(table.begins) - 1), np.diff(table.begins))[kept]
        joints, inputs, modes, paths = (a[kept] for a in (joints, table.inputs, table.modes, table.paths))
        key = ((takes * (accessors + 1) + np.minimum(inputs, accessors)) * 4 + modes) * 3 + paths
        _, first, group = np.unique(key, return_index=True, return_inverse=True)
        in_order = np.argsort(first)
        rank = np.empty_like(in_order)
        rank[in_order] = np.arange(len(first))
        group, first = rank[group.reshape(-1)], first[in_order]
        order = np.argsort(group, kind="stable")
        moved = np.sort((takes * 3 + paths) * nodes + joints)
        twice = np.unique(moved[1:][moved[1:] == moved[:-1]] // max(1, nodes)).tolist()
        return cls(
            np.searchsorted(group[order], np.arange(len(first) + 1)),
            takes[first],
            inputs[first],
            modes[first],
            paths[first],
            joints[order],
            table.outputs[kept][order],
            frozenset((code // 3, code % 3) for code in twice),
        )

    def targets(self, group: int) -> tuple[Array, Array]:
        """Return the joints and outputs of a group's channels."""
        own = slice(self.begins[group], self.begins[group + 1])
        return self.joints[own], self.outputs[own]

    def of_take(self, take: int) -> tuple[int, int]:
        """Return an animation's first group, and the one after its last."""
        first, after = np.searchsorted(self.takes, (take, take + 1)).tolist()
        return first, after


def check_channels(gltf: Gltf, table: ChannelTable, number: int, where: str) -> None:
    """Fail with a FileError for the first invalid channel of an animation."""
    if number not in table.odd:
        return
    own = slice(table.begins[number], table.begins[number + 1])
    inputs, modes = table.inputs[own], table.modes[own]
    for channel in np.flatnonzero((inputs < 0) | (modes == NO_MODE))[:1].tolist():
        animation = gltf.json.animations[number]
        sampler = animation.channels[channel].sampler
        if inputs[channel] < 0:
            gltf.fail(phrase("sampler {sampler} does not exist", sampler=sampler), where)
        mode = animation.samplers[sampler].interpolation
        gltf.fail(phrase("interpolation '{mode}' is unknown", mode=mode), where)


def note_unused_channels(gltf: Gltf, table: ChannelTable, number: int) -> list[str]:
    """Return notes on an animation's channels that move nothing known."""
    if number not in table.odd:
        return []
    own = slice(table.begins[number], table.begins[number + 1])
    unknown = np.flatnonzero((table.nodes[own] < 0) | (table.paths[own] == UNKNOWN)).tolist()
    channels = gltf.json.animations[number].channels if unknown else []
    paths = sorted({channels[channel].target.resolved.path for channel in unknown})
    return [f"channels for '{path[:40]}' were left out" for path in paths]


def list_morph_channels(
    table: ChannelTable, number: int, expressions: Collection[int] = ()
) -> list[tuple[int, str, int, int]]:
    """Return an animation's channels of weights: input, mode, node, output. `expressions` are nodes whose
    translation is a weight.
    """
    if number not in table.odd and not expressions:
        return []
    own = slice(table.begins[number], table.begins[number + 1])
    paths, nodes = table.paths[own], table.nodes[own]
    wanted = (paths == WEIGHTS) & (nodes >= 0)
    if expressions:
        wanted |= (paths == TRANSLATION) & np.isin(nodes, list(expressions))
    which = np.flatnonzero(wanted) + own.start
    columns = (table.inputs, table.modes, table.nodes, table.outputs)
    rows = np.array([some[which] for some in columns]).T.tolist()
    return [(source, _NAMES[mode], node, output) for source, mode, node, output in rows]


def read_plain_key_times(gltf: Gltf, inputs: Array) -> dict[int, Array]:
    """Return key times by accessor, as float64, if they are plain ascending scalars, as in almost all files.
    Others are read when they are needed, and refused there if they are invalid.
    """
    plain = gltf.plain
    some = np.unique(inputs[(inputs >= 0) & (inputs < len(plain.begins))])
    some = some[(plain.begins[some] >= 0) & (plain.counts[some] > 0)] if len(some) else some
    try:
        numbers = gltf.numbers("") if len(some) else np.zeros(0, np.float32)
    except FileError:
        return {}
    starts = plain.starts(some, plain.counts[some], 1, 4 * len(numbers))
    some, starts = some[starts >= 0], starts[starts >= 0]
    counts = plain.counts[some]
    ends = np.cumsum(counts)
    if not len(some) or ends[-1] > len(numbers):  # some share bytes; each is counted when it is read
        return {}
    begins = ends - counts
    times = numbers[np.repeat(starts - begins, counts) + np.arange(ends[-1])].astype(np.float64)
    worse = ~np.isfinite(times)
    worse[1:] |= np.diff(times) < 0
    worse[begins] = ~np.isfinite(times[begins])
    sound = ~np.logical_or.reduceat(worse, begins)
    bounds = zip(some[sound].tolist(), begins[sound].tolist(), ends[sound].tolist(), strict=True)
    return {accessor: times[begin:end] for accessor, begin, end in bounds}
