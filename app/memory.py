"""What is asked of the allocator: memory that is let go of goes back to the system."""

from __future__ import annotations

import ctypes
import sys

# glibc's numbers of what can be set, and what they are set to, bytes. Blocks as large as a picture are mapped
# by themselves: left alone it raises that limit to 32 MB once a large block is freed, and what lies between
# blocks that live long is kept for ever. Threads share two heaps instead of having one each.
_MMAP_THRESHOLD, _ARENAS = -3, -8
_LARGE = 256 * 1024


def free_memory_early() -> None:
    """Ask glibc, where it is the C library, to give memory back; nothing elsewhere."""
    if not sys.platform.startswith("linux"):
        return
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (OSError, AttributeError):
        return
    mallopt(_MMAP_THRESHOLD, _LARGE)
    mallopt(_ARENAS, 2)
