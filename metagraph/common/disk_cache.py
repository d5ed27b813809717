"""Files on disk that can be made again, kept between runs: losing them costs time alone."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from metagraph.common.user_folders import find_user_folder

LEFT = 0.8  # of what a cache may hold, after a clearing
SEEN = 3600.0  # seconds after which the use of a file is written down again


def cache_folder(name: str) -> Path | None:
    """Return the folder below the system's for caches in which such things are kept, which may not be there
    yet; None if nobody's home is known.
    """
    caches = find_user_folder("caches")
    return caches / "metagraph" / name if caches is not None else None


class DiskCache:
    """Contents by keys, which are hex digits. folder: made when there is something to keep; None keeps
    nothing. most: bytes; beyond them those unused longest go. ending: of its files' names. Read from any
    thread, written from one. Whatever the disk refuses, nothing comes from it and nothing is kept.
    """

    def __init__(self, folder: Path | None, most: int, ending: str) -> None:
        self.folder, self.most, self.ending = folder, most, ending
        self._bytes: int | None = None  # of all files there, once it was looked

    def read(self, key: str) -> bytes | None:
        """Return what was kept; None if nothing is."""
        path = self._path(key)
        if path is None:
            return None
        try:
            content = path.read_bytes()
        except OSError:
            return None
        with suppress(OSError):
            if time.time() - path.stat().st_mtime > SEEN:
                os.utime(path)
        return content

    def write(self, key: str, content: bytes) -> None:
        """Keep a content, whole or not at all."""
        path = self._path(key)
        if path is None:
            return
        beside = path.with_name(f"{path.name}.{os.getpid()}")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            beside.write_bytes(content)
            beside.replace(path)
        except OSError:
            with suppress(OSError):
                beside.unlink()
            return
        if self._bytes is None:
            self._bytes = sum(size for _, size, _ in self._files())
        else:
            self._bytes += len(content)
        if self._bytes > self.most:
            self.clear_old()

    def drop(self, key: str) -> None:
        """Forget what turned out to be broken."""
        path = self._path(key)
        if path is not None:
            with suppress(OSError):
                path.unlink()

    def clear_old(self) -> None:
        """Let those unused longest go until there is room again; half-written ones are files like others."""
        files = sorted(self._files())
        total = sum(size for _, size, _ in files)
        for _, size, path in files:
            if total <= self.most * LEFT:
                break
            with suppress(OSError):
                path.unlink()
            total -= size
        self._bytes = total

    def _files(self) -> Iterator[tuple[int, int, Path]]:
        """Yield of every file when it was used last, nanoseconds, its bytes, and where it is."""
        for path in self.folder.glob("*/*") if self.folder is not None else ():
            with suppress(OSError):
                told = path.stat()
                yield told.st_mtime_ns, told.st_size, path

    def _path(self, key: str) -> Path | None:
        return None if self.folder is None else self.folder / key[:2] / f"{key[2:]}{self.ending}"
