"""Writing files whole or not at all."""

from __future__ import annotations

import errno
import os
import uuid
from pathlib import Path

from metagraph.errors import FileError


def write_atomically(path: Path, content: bytes) -> None:
    """Write a file whole or not at all; a link is kept, its target written. Raises FileError."""
    temporary = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path = path.resolve()
        exists = path.exists()
        if exists and not os.access(path, os.W_OK):
            raise PermissionError(errno.EACCES, "it is read-only")
        temporary = path.with_name(f".saving-{uuid.uuid4().hex}")
        # The system takes the umask off; asking for it would mean to set it, for every thread of the process.
        handle = os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY | getattr(os, "O_BINARY", 0), 0o666)
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        if exists:
            temporary.chmod(path.stat().st_mode & 0o777)
        temporary.replace(path)
        temporary = None
    except OSError as error:
        raise FileError(
            path,
            f"cannot be written ({error.strerror or error})",
            "on saving it",
            "Choose a place you may write to, with space left.",
        ) from None
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)
