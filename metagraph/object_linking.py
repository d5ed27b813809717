"""Object code as LLVM writes it (ELF for x86-64, all far apart), laid out for `object_code` to load.

What refers to places in the code itself is told as a list of where it stands; what refers to functions of
others as their names. Source: System V ABI, AMD64 supplement, 4.4; ELF-64 object file format 1.5.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

PAGE = 4096
_WRITE, _ALLOC, _OF_THREADS = 1, 2, 0x400  # flags of sections
_SYMBOLS, _RELOCATIONS, _EMPTY = 2, 4, 8  # types of sections
_COMMON = 0xFFF2  # instead of a section's number
_SYMBOL = struct.Struct("<IBBHQQ")  # name, kind, -, section, value, size
_ABSOLUTE_64, _RELATIVE_64 = 1, 24  # kinds of references


class LinkError(ValueError):
    """The object code has something in it that is not known here."""


@dataclass
class Image:
    """Code that is ready but for where it is loaded. code: what runs and is read, whole pages; data: what is
    also written, behind it. within `[n]`: where 64 bits are to be raised by where it is loaded. outside: the
    names of others, and where 64 bits are to be raised by where each is. entry: where the function begins.
    """

    code: bytes
    data: bytes
    within: list[int]
    outside: dict[str, list[int]] = field(default_factory=dict)
    entry: int = 0


def linked(objects: Sequence[bytes], entry: str, *needed: str) -> Image:
    """Return object files, laid out together, as an image whose entry is a function of that name. needed:
    what else has to be in them. Raises LinkError.
    """
    files = [_File(content) for content in objects]
    code, data = bytearray(), bytearray()
    for file in files:
        file.add(code, False)
    code += bytes(-len(code) % PAGE)
    for file in files:
        file.add(data, True, len(code))
    known: dict[str, int] = {}
    for file in files:
        for name, section, value, size in file.symbols():
            if section == _COMMON and name not in known:  # a variable that is in no section
                data += bytes(-len(data) % max(1, value))
                known[name] = len(code) + len(data)
                data += bytes(size)
            elif section in file.places:
                known[name] = file.places[section] + value
    for name in (entry, *needed):
        if name not in known:
            raise LinkError(f"there is no {name}")
    data += bytes(-len(data) % PAGE)
    whole = code + data
    image = Image(b"", b"", [], {}, known[entry])
    for file in files:
        file.refer(known, whole, image)
    image.code, image.data = bytes(whole[: len(code)]), bytes(whole[len(code) :])
    return image


@dataclass
class _Section:
    name: int
    kind: int
    flags: int
    address: int
    offset: int
    size: int
    link: int
    info: int
    align: int
    entry_size: int


class _File:
    """An object file. places: of its sections that were laid out, by number."""

    def __init__(self, content: bytes) -> None:
        if content[:7] != b"\x7fELF\x02\x01\x01" or struct.unpack_from("<HH", content, 16) != (1, 62):
            raise LinkError("it is no object file for x86-64")
        (table,) = struct.unpack_from("<Q", content, 40)
        size, count, names = struct.unpack_from("<HHH", content, 58)
        at = range(table, table + count * size, size)
        self.content, self.places = content, dict[int, int]()
        self._sections = [_Section(*struct.unpack_from("<IIQQQQIIQQ", content, place)) for place in at]
        self._names = self._sections[names].offset

    def add(self, out: bytearray, written: bool, begin: int = 0) -> None:
        """Lay out what is written, or what is only read or run. Tables for unwinding are left out: nothing is
        thrown through the code.
        """
        for number, one in enumerate(self._sections):
            if not one.flags & _ALLOC or bool(one.flags & _WRITE) != written:
                continue
            if one.flags & _OF_THREADS:
                raise LinkError("it has variables of threads")
            if self._text(self._names + one.name) != ".eh_frame":
                out += bytes(-len(out) % max(1, one.align))
                self.places[number] = begin + len(out)
                empty = one.kind == _EMPTY
                out += bytes(one.size) if empty else self.content[one.offset : one.offset + one.size]

    def symbols(self) -> Iterator[tuple[str, int, int, int]]:
        """Yield what others may refer to: name, section, where in it, bytes."""
        for table in self._sections:
            if table.kind == _SYMBOLS:
                for at in range(table.offset, table.offset + table.size, _SYMBOL.size):
                    name, info, _, section, value, size = _SYMBOL.unpack_from(self.content, at)
                    if info >> 4:  # not local
                        yield self._text(self._sections[table.link].offset + name), section, value, size

    def refer(self, known: dict[str, int], whole: bytearray, image: Image) -> None:
        """Write what references come to, as far as it is known. known: where symbols are that all know."""
        for one in self._sections:
            if one.kind != _RELOCATIONS or one.info not in self.places:
                continue
            table = self._sections[one.link]
            for at in range(one.offset, one.offset + one.size, 24):
                offset, info, addend = struct.unpack_from("<QQq", self.content, at)
                kind, here = info & 0xFFFFFFFF, self.places[one.info] + offset
                symbol = table.offset + _SYMBOL.size * (info >> 32)
                named, bound, _, section, value, _ = _SYMBOL.unpack_from(self.content, symbol)
                name = self._text(self._sections[table.link].offset + named)
                if bound >> 4 == 0 and section in self.places:
                    to = self.places[section] + value + addend
                elif name in known:
                    to = known[name] + addend
                elif section == 0 and kind == _ABSOLUTE_64:
                    image.outside.setdefault(name, []).append(here)
                    to = addend
                else:
                    raise LinkError(f"it has references of kind {kind} to {name}")
                if kind == _RELATIVE_64:
                    to -= here
                elif kind != _ABSOLUTE_64:
                    raise LinkError(f"it has references of kind {kind}")
                elif section != 0 or name in known:
                    image.within.append(here)
                struct.pack_into("<q", whole, here, to)

    def _text(self, at: int) -> str:
        return self.content[at : self.content.index(b"\0", at)].decode()


def raised(memory: Any, places: list[int], by: int) -> None:
    """Raise 64 bits of memory, bytes `[n]` uint8, at places by a number. Raises ValueError where one is not
    within it.
    """
    at = np.array(places, np.int64)
    if len(at) and not (at.min() >= 0 and at.max() + 8 <= len(memory)):
        raise ValueError("a reference is outside of the code")
    eight = at[:, None] + np.arange(8)
    numbers = np.ascontiguousarray(memory[eight]).view(np.uint64)
    numbers += np.uint64(by % 2**64)
    memory[eight] = numbers.view(np.uint8)
