"""Compiling loops to object code that is kept. Importing this imports numba.

A loop gets an entry that CPython calls as it calls C functions: arrays and tuples come as they are, and their
records are read as `numpy/ndarraytypes.h` and `cpython/tupleobject.h` say.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from types import ModuleType
from typing import Any

import numpy as np
from llvmlite import binding as llvm
from llvmlite import ir
from numba import cfunc, types
from numba.core import cgutils
from numba.extending import intrinsic

from metagraph.object_code import TYPES, digests, keep
from metagraph.object_linking import Image, linked

# Bytes from the beginning of an array's record, and of its description.
_TYPE, _DATA, _DIMENSIONS, _SHAPE, _KIND, _FLAGS = 8, 16, 24, 32, 56, 64
_ORDER, _NUMBER = 26, 28
_IN_ONE_PIECE = 0x101  # C order, aligned
_COUNT, _ITEMS = 16, 24  # of a tuple
_I64, _I32, _I8 = ir.IntType(64), ir.IntType(32), ir.IntType(8)
_OBJECT = _I8.as_pointer()
_RECORDS = types.Array, types.BaseTuple


for _name, _type in TYPES.items():  # numba loads what it makes, too
    llvm.add_symbol(f"metagraph_{_name}", id(_type))


def make(module: ModuleType, names: Sequence[str], sources: Sequence[ModuleType]) -> bool:
    """Compile loops of a module, each called already with what it is called with, and keep them. sources:
    modules that they are also compiled from. Return whether they could be kept.
    """
    files = [str(one.__file__) for one in (module, *sources, sys.modules[__name__])]
    loops = {name: _made(getattr(module, name)) for name in names}
    return keep(module.__name__, digests(files), loops)


def _made(loop: Any) -> Image:
    """Return a loop's code, which CPython calls as `METH_FASTCALL` says: self, arguments, their number."""
    (given,) = loop.overloads
    compiled = loop.overloads[given]

    @intrinsic
    def whole(typing: Any, me: Any, arguments: Any, count: Any) -> Any:
        def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            return _entry(context, builder, loop.__name__, compiled, given, values[1:])

        return types.voidptr(me, arguments, count), code

    def entry(me: Any, arguments: Any, count: Any) -> Any:
        return whole(me, arguments, count)

    # The entry knows where the loop is: linked with it, both would be optimised anew, and sums rounded in
    # other ways than numba has them.
    library, name = compiled.library, compiled.fndesc.llvm_func_name
    llvm.add_symbol(name, library.get_pointer_to_function(name))
    made = cfunc(types.voidptr(types.voidptr, types.voidptr, types.int64), nopython=True)(entry)
    return linked([_object(made._library), _object(library)], made._wrapper_name, name)


def _object(library: Any) -> bytes:
    return library.codegen._tm.emit_object(library._final_module)


def _entry(context: Any, builder: Any, name: str, compiled: Any, given: Any, values: Any) -> Any:
    """Build what looks at the arguments, lets other threads run, calls the loop and hands back what it
    returns.
    """
    arguments, count = values
    answer = cgutils.alloca_once_value(builder, ir.Constant(_OBJECT, None))
    records = [lambda n=n: _read(builder, arguments, 8 * n, _OBJECT) for n in range(len(given))]
    fine = cgutils.alloca_once_value(builder, cgutils.false_bit)
    with builder.if_then(builder.icmp_signed("==", count, ir.Constant(_I64, len(given)))):
        fit = cgutils.true_bit
        for one, record in zip(given, records, strict=True):
            if isinstance(one, _RECORDS):
                fit = builder.and_(fit, _fits(builder, one, record()))
        builder.store(fit, fine)
    with builder.if_else(builder.load(fine)) as (then, otherwise):
        with otherwise:
            _refuse(context, builder, "PyExc_TypeError", f"{name} was compiled for arguments of another kind")
        with then:
            taken = [
                _value(context, builder, one, record())
                if isinstance(one, _RECORDS)
                else _number(context, builder, one, record())
                for one, record in zip(given, records, strict=True)
            ]
            wrong = builder.icmp_unsigned(
                "!=", _call(builder, "PyErr_Occurred", _I64, []), ir.Constant(_I64, 0)
            )
            with builder.if_then(builder.not_(wrong)):
                held = _call(builder, "PyEval_SaveThread", _OBJECT, [])
                status, result = context.call_internal_no_propagate(
                    builder, compiled.fndesc, compiled.signature, taken
                )
                _call(builder, "PyEval_RestoreThread", ir.VoidType(), [held])
                with builder.if_else(status.is_error) as (failed, done):
                    with failed:
                        _refuse(context, builder, "PyExc_RuntimeError", f"{name} was not finished")
                    with done:
                        builder.store(
                            _boxed(context, builder, compiled.signature.return_type, result), answer
                        )
    return builder.load(answer)


def _call(builder: Any, name: str, returns: Any, values: Sequence[Any]) -> Any:
    kind = ir.FunctionType(returns, [value.type for value in values])
    return builder.call(cgutils.get_or_insert_function(builder.module, kind, name), values)


def _refuse(context: Any, builder: Any, kind: str, words: str) -> None:
    known = builder.module.globals.get(kind) or ir.GlobalVariable(builder.module, _OBJECT, kind)
    said = context.insert_const_string(builder.module, words)
    _call(builder, "PyErr_SetString", ir.VoidType(), [builder.load(known), said])


def _number(context: Any, builder: Any, given: Any, record: Any) -> Any:
    if isinstance(given, types.Float):
        value = _call(builder, "PyFloat_AsDouble", ir.DoubleType(), [record])
        return context.cast(builder, value, types.float64, given)
    value = _call(builder, "PyLong_AsLongLong", _I64, [record])
    return context.cast(builder, value, types.int64, given)


def _boxed(context: Any, builder: Any, kind: Any, result: Any) -> Any:
    """Build what Python gets: nothing, a whole number or some of them."""
    if isinstance(kind, types.BaseTuple):
        numbers = [
            _boxed(context, builder, one, builder.extract_value(result, n)) for n, one in enumerate(kind)
        ]
        return _call(builder, "PyTuple_Pack", _OBJECT, [ir.Constant(_I64, len(numbers)), *numbers])
    if kind is types.none:
        none = builder.module.globals.get("_Py_NoneStruct") or ir.GlobalVariable(
            builder.module, _I8, "_Py_NoneStruct"
        )
        _call(builder, "Py_IncRef", ir.VoidType(), [none])
        return none
    if not isinstance(kind, types.Integer):
        raise TypeError(f"{kind} is returned")
    return _call(builder, "PyLong_FromLongLong", _OBJECT, [context.cast(builder, result, kind, types.int64)])


def _read(builder: Any, record: Any, offset: int, kind: Any) -> Any:
    at = builder.gep(record, [ir.Constant(_I64, offset)])
    return builder.load(builder.bitcast(at, kind.as_pointer()))


def _kind_of(builder: Any, record: Any, name: str) -> Any:
    """Return whether an object is of this very type."""
    module = builder.module
    known = module.globals.get(name) or ir.GlobalVariable(module, _I8, name)
    return builder.icmp_unsigned("==", _read(builder, record, _TYPE, _I64), builder.ptrtoint(known, _I64))


def _fits(builder: Any, given: Any, record: Any) -> Any:
    """Build what tells whether a record is as it should be; later things are read only where earlier are."""
    fine = cgutils.alloca_once_value(builder, cgutils.false_bit)
    if isinstance(given, types.BaseTuple):
        with builder.if_then(_kind_of(builder, record, "metagraph_tuple")):
            count = builder.icmp_signed(
                "==", _read(builder, record, _COUNT, _I64), ir.Constant(_I64, len(given))
            )
            with builder.if_then(count):
                all_fit = cgutils.true_bit
                for n, one in enumerate(given.types):
                    item = _read(builder, record, _ITEMS + 8 * n, _OBJECT)
                    all_fit = builder.and_(all_fit, _fits(builder, one, item))
                builder.store(all_fit, fine)
    elif isinstance(given, types.Array):
        with builder.if_then(_kind_of(builder, record, "metagraph_array")):
            flags = _IN_ONE_PIECE | (0x400 if given.mutable else 0)
            kind = _read(builder, record, _KIND, _OBJECT)
            number = np.dtype(_dtype(given)).num
            tests = [
                (_read(builder, record, _DIMENSIONS, _I32), given.ndim),
                (builder.and_(_read(builder, record, _FLAGS, _I32), ir.Constant(_I32, flags)), flags),
                (_read(builder, kind, _NUMBER, _I32), number),
            ]
            same = builder.icmp_unsigned("!=", _read(builder, kind, _ORDER, _I8), ir.Constant(_I8, ord(">")))
            for value, wanted in tests:
                same = builder.and_(same, builder.icmp_signed("==", value, ir.Constant(value.type, wanted)))
            builder.store(same, fine)
    else:
        raise TypeError(f"{given} within a tuple")
    return builder.load(fine)


def _dtype(given: Any) -> Any:
    from numba.np.numpy_support import as_dtype

    return as_dtype(given.dtype)


def _value(context: Any, builder: Any, given: Any, record: Any) -> Any:
    if isinstance(given, types.BaseTuple):
        items = [_read(builder, record, _ITEMS + 8 * n, _OBJECT) for n in range(len(given))]
        values = [_value(context, builder, one, item) for one, item in zip(given.types, items, strict=True)]
        return context.make_tuple(builder, given, values)
    array = context.make_array(given)(context, builder)
    sizes = _read(builder, record, _SHAPE, _OBJECT)
    shape = [_read(builder, sizes, 8 * n, _I64) for n in range(given.ndim)]
    item = ir.Constant(_I64, context.get_abi_sizeof(context.get_data_type(given.dtype)))
    strides = [item]
    for size in reversed(shape[1:]):
        strides.insert(0, builder.mul(strides[0], size))
    context.populate_array(
        array,
        data=_read(builder, record, _DATA, array.data.type),
        shape=cgutils.pack_array(builder, shape),
        strides=cgutils.pack_array(builder, strides),
        itemsize=item,
        meminfo=None,
    )
    return array._getvalue()
