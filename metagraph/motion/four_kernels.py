"""Forward kinematics of four characters at once: a joint's four numbers side by side, and those of four
characters behind one another.

Numba makes such rows of sixteen of loops over neighbours, but of nothing that puts numbers in another order,
so they are said to LLVM itself, in instructions as wide as the processor has them. Importing this imports
numba.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic

from metagraph.compiling import compiler

Array = Any
FOUR = 4
ROW = 4 * FOUR  # numbers of a row

# Kept as part of what calls it alone.
_inside = compiler(keep=False, nogil=True, error_model="numpy")

_FLOAT, _INT = ir.FloatType(), ir.IntType(32)
_FLAGS = ("contract", "nsz")  # a product and a sum in one
# The product of two turns by the numbers of the first: x, y, z and w each times the second's in this order,
# with these signs.
_TIMES = (((3, 2, 1, 0), (1, -1, 1, -1)), ((2, 3, 0, 1), (1, 1, -1, -1)), ((1, 0, 3, 2), (-1, 1, 1, -1)))


class _Rows:
    """Rows of sixteen and what is done with them, built into a loop."""

    def __init__(self, builder: Any) -> None:
        self.builder = builder

    def load(self, place: Any, width: int = ROW) -> Any:
        """Return so many numbers from a place on."""
        kind = ir.VectorType(_FLOAT, width).as_pointer()
        return self.builder.load(self.builder.bitcast(place, kind), align=4)

    def store(self, row: Any, place: Any) -> None:
        """Put numbers where a place is."""
        self.builder.store(row, self.builder.bitcast(place, row.type.as_pointer()), align=4)

    def chosen(self, row: Any, places: Sequence[int], other: Any = None) -> Any:
        """Return the numbers of a row, and of another behind it, at some places."""
        other = ir.Constant(row.type, ir.Undefined) if other is None else other
        return self.builder.shuffle_vector(
            row, other, ir.Constant(ir.VectorType(_INT, len(places)), list(places))
        )

    def each(self, row: Any, order: Sequence[int]) -> Any:
        """Return a row with each character's four numbers in another order."""
        return self.chosen(row, [4 * n + place for n in range(FOUR) for place in order])

    def joined(self, fours: Sequence[Any]) -> Any:
        """Return the numbers of four characters as a row."""
        pairs = [self.chosen(a, range(8), b) for a, b in zip(fours[::2], fours[1::2], strict=True)]
        return self.chosen(pairs[0], range(ROW), pairs[1])

    def times(self, a: Any, b: Any) -> Any:
        return self.builder.fmul(a, b, flags=_FLAGS)

    def plus(self, a: Any, b: Any) -> Any:
        return self.builder.fadd(a, b, flags=_FLAGS)

    def signed(self, row: Any, signs: Sequence[int]) -> Any:
        return self.times(row, ir.Constant(row.type, [float(sign) for sign in signs] * FOUR))

    def cross(self, a: Any, b: Any) -> Any:
        """Return the cross products of vectors x, y, z; nothing of what stands behind those."""
        further = (1, 2, 0, 3)
        first, second = self.times(a, self.each(b, further)), self.times(self.each(a, further), b)
        return self.each(self.builder.fsub(first, second, flags=_FLAGS), further)


@intrinsic
def _sixteen(typing: Any, blocks: Any, block: Any, turns: Any, n: Any) -> Any:
    """Write sixteen joints of one character, the `n`-th of four; arguments as of `spread`."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        rows = _Rows(builder)
        given, made = (
            context.make_array(kind)(context, builder, value).data
            for kind, value in ((signature.args[0], values[0]), (signature.args[2], values[2]))
        )
        block, n = values[1], values[3]

        def far(place: Any, whole: int, more: Any) -> Any:
            return builder.add(builder.mul(place, ir.Constant(place.type, whole)), more)

        begin = [far(block, 4 * ROW, ir.Constant(block.type, ROW * k)) for k in range(4)]
        x, y, z, w = (rows.load(builder.gep(given, [place])) for place in begin)
        for half in range(2):
            two = [8 * half + i // 2 + ROW * (i % 2) for i in range(ROW)]
            xy, zw = rows.chosen(x, two, y), rows.chosen(z, two, w)
            for quarter in range(2):
                at = [8 * quarter + 2 * (i // 4) + i % 2 + ROW * (i % 4 // 2) for i in range(ROW)]
                some = rows.chosen(xy, at, zw)
                for i in range(4):
                    joint = far(block, ROW, ir.Constant(block.type, 8 * half + 4 * quarter + i))
                    place = far(joint, ROW, builder.mul(n, ir.Constant(n.type, 4)))
                    rows.store(rows.chosen(some, range(4 * i, 4 * i + 4)), builder.gep(made, [place]))
        return context.get_dummy_value()

    return types.void(blocks, block, turns, n), code


@intrinsic
def _joint(
    typing: Any, turns: Any, ways: Any, model_turns: Any, model_places: Any, out_r: Any, out_p: Any,
    four: Any, j: Any, row_of: Any, parent: Any,
) -> Any:  # fmt: skip
    """Take joint `j` of characters `four (4)`, whose turns are in row `row_of`, into their own spaces;
    arrays as of `to_models`. model_turns, model_places `[J + 1, 16]`: what is known of the joints before.
    """
    given = (turns, ways, model_turns, model_places, out_r, out_p, four, j, row_of, parent)

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        rows = _Rows(builder)
        arrays = [
            context.make_array(kind)(context, builder, value)
            for kind, value in zip(signature.args[:6], values[:6], strict=True)
        ]
        characters = cgutils.unpack_tuple(builder, values[6])
        j, row_of, parent = values[7:]

        def row(n: int, joint: Any) -> Any:
            return builder.gep(arrays[n].data, [builder.mul(joint, ir.Constant(joint.type, ROW))])

        def of(n: int, character: Any, joint: Any) -> Any:
            _, joints, width = cgutils.unpack_tuple(builder, arrays[n].shape)
            place = builder.add(builder.mul(character, joints), joint)
            return builder.gep(arrays[n].data, [builder.mul(place, width)])

        above, here = rows.load(row(2, parent)), rows.load(row(0, row_of))
        turn = rows.times(rows.each(above, (3, 3, 3, 3)), here)
        for place, (order, signs) in enumerate(_TIMES):
            part = rows.signed(rows.each(here, order), signs)
            turn = rows.plus(turn, rows.times(rows.each(above, (place,) * 4), part))
        rows.store(turn, row(2, j))

        way = rows.joined([rows.load(of(1, n, j), 4) for n in characters])
        across = rows.cross(above, way)
        across = rows.plus(across, across)
        there = rows.plus(way, rows.times(rows.each(above, (3, 3, 3, 3)), across))
        there = rows.plus(rows.plus(there, rows.cross(above, across)), rows.load(row(3, parent)))
        rows.store(there, row(3, j))

        for n, character in enumerate(characters):
            rows.store(rows.chosen(turn, range(4 * n, 4 * n + 4)), of(4, character, j))
            place = of(5, character, j)
            rows.store(rows.chosen(there, (4 * n, 4 * n + 1)), place)
            last = builder.extract_element(there, ir.Constant(_INT, 4 * n + 2))
            builder.store(last, builder.gep(place, [ir.Constant(ir.IntType(64), 2)]))
        return context.get_dummy_value()

    return types.void(*given), code


@_inside
def spread(blocks: Array, turns: Array, n: int) -> None:
    """Write the joints of one character, `[B, 64]`, in blocks of x, y, z and w of sixteen, as the `n`-th of
    four to `turns [16 B, 16]`.
    """
    for block in range(len(blocks)):
        _sixteen(blocks, block, turns, n)


@_inside
def to_models(
    parents: Array, rows: Array, blocks: Array, ways: Array, turns: Array, out_r: Array, out_p: Array
) -> None:
    """Write poses in the characters' spaces to `out_r [C, J, 4]`, `out_p [C, J, 3]`.

    blocks `[C, B, 64]`: how joints are turned in their parents, as `spread` takes them, joint j in row
    `rows[j]` of what it writes. ways `[C, J, 4]`: where they lie there, 0 behind x, y, z. turns `[16 B, 16]`:
    scratch. A pose is the same, whatever others are beside it.
    """
    count, joints = len(out_r), len(parents)
    # The last row is above what has no parent.
    model_places = np.zeros((joints + 1, ROW), np.float32)
    model_turns = np.zeros((joints + 1, ROW), np.float32)
    model_turns[joints, 3::4] = 1
    for c in range(0, count, FOUR):
        four = (c, min(c + 1, count - 1), min(c + 2, count - 1), min(c + 3, count - 1))
        for n in range(FOUR):
            spread(blocks[four[n]], turns, n)
        for j in range(joints):
            parent = parents[j] if parents[j] >= 0 else joints
            _joint(turns, ways, model_turns, model_places, out_r, out_p, four, j, rows[j], parent)
