"""Loops that numba compiled once, run without it: numba and its LLVM take 0.7 s and 70 MB to import, what
they make a few hundred kilobytes.

The object code is kept in the user's folder for caches, and read only where that is the user's alone. It is
known by the interpreter, NumPy and numba it is for, the processor, and the text of what it was compiled from.
Arguments go to it as they are: it looks at the arrays' own records, as C code does, and refuses those it was
not made for. Of numba two small libraries are used, which hand out memory and tell what went wrong.

On Linux for x86-64 alone; elsewhere numba is imported, as it is where nothing is kept.
METAGRAPH_LOOP_CACHE names another folder; empty, nothing is kept.
"""

from __future__ import annotations

import ctypes
import hashlib
import json
import mmap
import os
import platform
import sys
import sysconfig
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import cache
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from metagraph.disk_cache import cache_folder
from metagraph.object_linking import PAGE, Image, raised
from metagraph.programs import read_own

MAGIC = b"metagraph loops 1\n"
MOST = 64 << 20  # bytes of a file
TYPES = {"array": np.ndarray, "tuple": tuple}  # whose addresses the code asks for, to know its arguments


def usable() -> bool:
    """Whether object code can be kept and run here: arrays and tuples lie in memory as is known."""
    return (
        sys.platform == "linux"
        and platform.machine() == "x86_64"
        and sys.implementation.name == "cpython"
        and ctypes.sizeof(ctypes.c_void_p) == 8
        and not sysconfig.get_config_var("Py_GIL_DISABLED")
        and not hasattr(sys, "getobjects")
    )


def folder() -> Path | None:
    """Return where object code is kept; None where nothing is."""
    told = os.environ.get("METAGRAPH_LOOP_CACHE")
    if not usable() or told == "":
        return None
    return Path(told) if told else cache_folder("loops")


class _Method(ctypes.Structure):
    """A C function as CPython knows it (`PyMethodDef`)."""

    _fields_ = (
        ("name", ctypes.c_char_p),
        ("call", ctypes.c_void_p),
        ("flags", ctypes.c_int),
        ("doc", ctypes.c_char_p),
    )


_FASTCALL = 0x80  # flag of functions that get their arguments as a row


def _callable(name: str, entry: int) -> Any:
    """Return what is called as the loop was written, with the very kinds of arrays it was compiled for.
    Raises TypeError for others.
    """
    method = _Method(name.encode(), entry, _FASTCALL, None)
    _kept_alive.append(method)
    kind = ctypes.PYFUNCTYPE(ctypes.py_object, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p)
    return kind(("PyCFunction_NewEx", ctypes.pythonapi))(ctypes.addressof(method), None, None)


_kept_alive: list[Any] = []  # memory that code lies in, and libraries it calls


def load(module: str) -> Any:
    """Return the loops kept of a module, by their names; None where there are none that fit."""
    place = path(module)
    content = read_own(place, MOST) if place is not None else None
    if content is None:
        return None
    try:
        head, images = _read(content)
        if head["sources"] != digests(head["sources"]):
            return None
        made = {name: _callable(name, _placed(image)) for name, image in images.items()}
    except (ValueError, KeyError, TypeError, IndexError, OSError, ImportError, AttributeError):
        return None  # broken, or of another kind: it is compiled anew
    return SimpleNamespace(**made)


def keep(module: str, sources: Mapping[str, str], loops: Mapping[str, Image]) -> bool:
    """Keep loops of a module. Return whether that could be done."""
    place = path(module)
    if place is None:
        return False
    told: dict[str, Any] = {}
    body = b""
    for name, image in loops.items():
        told[name] = {
            "entry": image.entry, "within": image.within,
            "outside": image.outside, "at": len(body), "code": len(image.code), "data": len(image.data),
        }  # fmt: skip
        body += image.code + image.data
    head = json.dumps({"sources": dict(sources), "loops": told}).encode()
    content = len(head).to_bytes(8, "little") + head + body
    beside = place.with_name(f"{place.name}.{os.getpid()}")
    try:
        place.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        _sweep(place.parent)
        handle = os.open(beside, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600)
        with os.fdopen(handle, "wb") as file:
            file.write(MAGIC + hashlib.sha256(content).digest() + content)
        beside.replace(place)
    except OSError:
        with suppress(OSError):
            beside.unlink()
        return False
    return True


def path(module: str) -> Path | None:
    """Return the file of a module's loops, for this interpreter, numba and processor; None where nothing is
    kept or numba is not there.
    """
    where, said = folder(), _here()
    return where / f"{module}-{said}.bin" if where is not None and said is not None else None


def digests(files: Any) -> dict[str, str]:
    """Return digests of files by their paths. Raises OSError."""
    return {str(file): hashlib.sha256(Path(file).read_bytes()).hexdigest() for file in files}


def _sweep(folder: Path, most: int = 32) -> None:
    """Leave the latest files, and nothing that was not finished."""
    files = sorted(folder.glob("*.bin"), key=lambda file: file.stat().st_mtime)
    for file in (*files[:-most], *folder.glob("*.bin.*")):
        with suppress(OSError):
            file.unlink()


def _read(content: bytes) -> tuple[dict[str, Any], dict[str, Image]]:
    """Return what a file says, and the images in it. Raises ValueError and others where it is broken."""
    begin = len(MAGIC) + 32
    if (
        content[: len(MAGIC)] != MAGIC
        or hashlib.sha256(content[begin:]).digest() != content[begin - 32 : begin]
    ):
        raise ValueError("it is broken")
    size = int.from_bytes(content[begin : begin + 8], "little")
    head = json.loads(content[begin + 8 : begin + 8 + size])
    body = content[begin + 8 + size :]
    images: dict[str, Image] = {}
    for name, told in head["loops"].items():
        a = told["at"]
        b = a + told["code"]
        c = b + told["data"]
        images[name] = Image(body[a:b], body[b:c], told["within"], told["outside"], told["entry"])
    return head, images


@cache
def _here() -> str | None:
    """Return what tells this package, interpreter, NumPy, numba and processor from others; None where numba
    is not there, or another than is known.
    """
    numba = _numba()
    with suppress(OSError):
        return None if numba is None else _said_of(numba)
    return None


def _said_of(numba: Path) -> str:
    said: list[Any] = [MAGIC.decode(), __file__, sys.version, np.__version__, platform.libc_ver()]
    asked = sorted((name, value) for name, value in os.environ.items() if name.startswith("NUMBA_"))
    said += [one for one in asked if not one[0].startswith("NUMBA_CACHE")]
    llvm = find_spec("llvmlite")
    for file in (*_libraries(numba), Path(str(llvm.origin)) if llvm is not None else numba):
        told = file.stat()
        said.append((str(file), told.st_size, told.st_mtime_ns))
    with Path("/proc/cpuinfo").open(encoding="utf-8", errors="replace") as lines:
        for line in lines:
            if not line.strip():
                break  # of the first core
            if line.startswith(("vendor_id", "cpu family", "model", "stepping", "flags")):
                said.append(line)
    return hashlib.sha256(repr(said).encode()).hexdigest()[:24]


def _numba() -> Path | None:
    """Return the folder numba is in, without importing it."""
    found = find_spec("numba")
    return Path(found.origin).parent if found is not None and found.origin else None


def _libraries(numba: Path) -> tuple[Path, Path]:
    ending = sysconfig.get_config_var("EXT_SUFFIX")
    return numba / f"_helperlib{ending}", numba / "core" / "runtime" / f"_nrt_python{ending}"


def _placed(image: Image) -> int:
    """Bring an image into memory and return where its entry is. Raises ValueError, OSError, KeyError."""
    size = len(image.code) + len(image.data)
    if len(image.code) % PAGE or not 0 <= image.entry < len(image.code):
        raise ValueError("it is broken")
    memory = mmap.mmap(-1, size, mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS, mmap.PROT_READ | mmap.PROT_WRITE)
    memory.write(image.code + image.data)
    begin = ctypes.addressof(ctypes.c_char.from_buffer(memory))
    whole = np.frombuffer(memory, np.uint8)
    raised(whole, image.within, begin)
    for name, places in image.outside.items():
        raised(whole, places, _address(name))
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.mprotect(ctypes.c_void_p(begin), len(image.code), mmap.PROT_READ | mmap.PROT_EXEC) != 0:
        raise OSError(ctypes.get_errno(), "memory may not be run")
    _kept_alive.append((memory, whole))
    return begin + image.entry


@cache
def _address(name: str) -> int:
    """Return where a function is that code refers to. Raises KeyError, OSError, ImportError."""
    if name in _helpers():
        return _helpers()[name]
    if name.startswith(("Py", "_Py")):
        return ctypes.addressof(ctypes.c_char.in_dll(ctypes.pythonapi, name))
    for library in (ctypes.CDLL("libm.so.6"), ctypes.CDLL("libc.so.6")):
        with suppress(ValueError):
            return ctypes.addressof(ctypes.c_char.in_dll(library, name))
    raise KeyError(name)


@cache
def _helpers() -> dict[str, int]:
    """Return where numba's own functions are, and the types of arguments."""
    numba = _numba()
    assert numba is not None
    names = {f"metagraph_{name}": id(kind) for name, kind in TYPES.items()}
    rules: tuple[tuple[str, Callable[[str], str]], ...] = (
        ("numba._helperlib", lambda name: f"numba_{name}"),
        ("numba.core.runtime._nrt_python", lambda name: name if name[0] == "_" else f"NRT_{name}"),
    )
    for (name, called), file in zip(rules, _libraries(numba), strict=True):
        library = sys.modules.get(name)
        if library is None:
            spec = spec_from_file_location(name, file)
            assert spec is not None and spec.loader is not None
            library = module_from_spec(spec)
            spec.loader.exec_module(library)
        _kept_alive.append(library)
        names |= {called(helper): address for helper, address in library.c_helpers.items()}
    return names
