"""Packed buffer views are read as the extension's own library packs them, and what is damaged is reported."""

from __future__ import annotations

import base64
import json
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from metagraph.formats.gltf.meshopt import MeshoptError, count_block_elements, unpack_buffer
from metagraph.formats.gltf.meshopt_encoding import (
    encode_exponential,
    encode_octahedral,
    encode_quaternions,
    pack_attributes,
    pack_indices,
)

REFERENCE: dict[str, Any] = json.loads(Path(__file__).with_name("meshopt_reference.json").read_bytes())


def turned(indices: Any) -> list[tuple[int, ...]]:
    """Triangles, each from its least index on: which corner is first is not kept."""
    rows = np.reshape(indices, (-1, 3)).tolist()
    return [tuple(row[(k + row.index(min(row))) % 3] for k in range(3)) for row in rows]


@pytest.mark.parametrize("name", REFERENCE["triangles"])
def test_triangles_are_those_that_were_packed(name: str) -> None:
    of = REFERENCE["triangles"][name]
    for stride, form in ((2, "<u2"), (4, "<u4")):
        raw = unpack_buffer(base64.b64decode(of["packed"]), len(of["indices"]), stride, "TRIANGLES")
        assert turned(np.frombuffer(raw, form)) == turned(of["indices"])


def test_indices_and_attributes_are_those_that_were_packed() -> None:
    of = REFERENCE["indices"]
    raw = unpack_buffer(base64.b64decode(of["packed"]), len(of["indices"]), 4, "INDICES")
    assert np.frombuffer(raw, "<u4").tolist() == of["indices"]
    of, wanted = REFERENCE["attributes"], base64.b64decode(REFERENCE["attributes"]["bytes"])
    assert unpack_buffer(base64.b64decode(of["packed"]), len(wanted) // 8, 8, "ATTRIBUTES") == wanted


def test_the_example_of_the_specification_is_read_so() -> None:
    """Sixteen deltas in 10 bytes; here as the first byte of elements whose other bytes stay 0."""
    group = bytes((0x17, 0x5F, 0xF0, 0xBC, 0x77, 0xA9, 0x21, 0x00, 0x34, 0xB5))
    data = b"\xa0" + bytes((2,)) + group + bytes(3) + bytes(32)
    found = np.frombuffer(unpack_buffer(data, 16, 4, "ATTRIBUTES"), np.uint8).reshape(16, 4)
    wanted = np.cumsum([-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0]).astype(np.uint8)
    assert (found[:, 0] == wanted).all() and not found[:, 1:].any()


@pytest.mark.parametrize("stride", [4, 8, 12, 64, 256])
@pytest.mark.parametrize("count", [0, 1, 15, 16, 17, 256, 257, 600])
def test_bytes_come_back_exactly(stride: int, count: int) -> None:
    random = np.random.default_rng(count + stride)
    for reach in (0, 1, 3, 20, 256):  # of deltas: none, of two bits, of four, of all
        steps = random.integers(-reach, reach + 1, (count, stride))
        raw = np.cumsum(steps, 0).astype(np.uint8).tobytes()
        assert unpack_buffer(pack_attributes(raw, stride), count, stride, "ATTRIBUTES") == raw


@settings(max_examples=50)
@given(st.lists(st.integers(0, 2**30 - 1), max_size=60))
def test_indices_come_back_exactly(indices: list[int]) -> None:
    raw = unpack_buffer(pack_indices(np.array(indices, np.int64)), len(indices), 4, "INDICES")
    assert np.frombuffer(raw, "<u4").tolist() == indices


def test_blocks_hold_as_many_elements_as_fit() -> None:
    assert [count_block_elements(stride) for stride in (4, 32, 64, 256)] == [256, 256, 128, 32]


def unit(width: int) -> NDArray[np.float64]:
    """Vectors of all directions, the axes among them."""
    drawn = np.random.default_rng(width).normal(size=(3000, width))
    every = np.concatenate([np.eye(width), -np.eye(width), np.ones((1, width)), drawn])
    return np.asarray(every / np.linalg.norm(every, axis=1, keepdims=True))


@pytest.mark.parametrize(("bits", "off"), [(16, 0.006), (15, 0.01), (12, 0.08)])
def test_turns_are_as_near_as_their_bits_allow(bits: int, off: float) -> None:
    wanted = unit(4)
    raw = unpack_buffer(
        pack_attributes(encode_quaternions(wanted, bits), 8), len(wanted), 8, "ATTRIBUTES", "QUATERNION"
    )
    found = np.frombuffer(raw, "<i2").reshape(-1, 4) / 32767
    apart = np.minimum(np.linalg.norm(found - wanted, axis=1), np.linalg.norm(found + wanted, axis=1))
    assert np.degrees(2 * apart).max() < off


def test_normals_are_within_a_degree_or_so() -> None:
    wanted = unit(3)
    raw = unpack_buffer(
        pack_attributes(encode_octahedral(wanted, 8), 4), len(wanted), 4, "ATTRIBUTES", "OCTAHEDRAL"
    )
    found = np.frombuffer(raw, "<i1").reshape(-1, 4)[:, :3].astype(float)
    assert np.abs(np.linalg.norm(found, axis=1) / 127 - 1).max() < 0.01
    cosines = (found * wanted).sum(1) / np.linalg.norm(found, axis=1)
    assert np.degrees(np.arccos(cosines.clip(-1, 1))).max() < 1.2


def test_floats_are_whole_numbers_of_their_exponent_and_large_ones_keep_their_digits() -> None:
    wanted = np.array([0, -0.0, 1, -1, 1e-9, 0.3, -2.25, 300, 1e6, -3.3e8, 3e20])
    raw = unpack_buffer(
        pack_attributes(encode_exponential(wanted, -15), 4), len(wanted), 4, "ATTRIBUTES", "EXPONENTIAL"
    )
    found = np.frombuffer(raw, "<f4")
    assert (np.abs(found - wanted) <= np.maximum(2.0**-16, np.abs(wanted) * 2.0**-22)).all()


@pytest.mark.parametrize(
    ("data", "count", "stride", "mode", "kind"),
    [
        (b"", 1, 4, "ATTRIBUTES", "NONE"),
        (pack_attributes(bytes(range(64)), 4)[:-1], 16, 4, "ATTRIBUTES", "NONE"),
        (pack_attributes(bytes(range(64)), 4), 300, 4, "ATTRIBUTES", "NONE"),
        (b"\xa1" + pack_attributes(bytes(64), 4)[1:], 16, 4, "ATTRIBUTES", "NONE"),
        (pack_attributes(bytes(64), 4), 16, 5, "ATTRIBUTES", "NONE"),
        (pack_attributes(bytes(64), 4), 16, 4, "ATTRIBUTES", "QUATERNION"),
        (pack_attributes(bytes(64), 4), 16, 4, "ATTRIBUTES", "WAVELET"),
        (pack_indices(np.arange(9)), 10, 2, "INDICES", "NONE"),
        (pack_indices(np.arange(9)), 9, 8, "INDICES", "NONE"),
        (pack_indices(np.arange(9)), 9, 2, "INDICES", "EXPONENTIAL"),
        (b"\xd1", 1, 2, "INDICES", "NONE"),
        (b"\xe1" + bytes(17), 4, 2, "TRIANGLES", "NONE"),
        (b"\xe1\xff" + bytes(16), 3, 2, "TRIANGLES", "NONE"),
        (b"\xe1" + bytes(9), 3, 2, "TRIANGLES", "NONE"),
        (b"\xe1" + bytes(17), 3, 2, "CUBES", "NONE"),
    ],
)
def test_what_is_damaged_or_unknown_is_an_error(
    data: bytes, count: int, stride: int, mode: Any, kind: Any
) -> None:
    with pytest.raises(MeshoptError):
        unpack_buffer(data, count, stride, mode, kind)


@settings(max_examples=100)
@given(st.binary(max_size=200), st.integers(0, 90), st.sampled_from(["ATTRIBUTES", "TRIANGLES", "INDICES"]))
def test_any_bytes_are_read_or_an_error(data: bytes, count: int, mode: Any) -> None:
    head = {"ATTRIBUTES": b"\xa0", "TRIANGLES": b"\xe1", "INDICES": b"\xd1"}[mode]
    with suppress(MeshoptError):
        assert len(unpack_buffer(head + data, 3 * count, 4, mode)) == 12 * count
