"""Imports a module in a process of its own, to see whether an extra works: the module's name, and the folder
that it lies in, are the words after this one's.
"""

from __future__ import annotations

import sys
from importlib import import_module


def check_import(module: str, folder: str) -> int:
    """Import a module, also from a folder, and say what is wrong with it; return the exit status."""
    if folder:
        sys.path.append(folder)
    try:
        import_module(module)
    except Exception as error:  # whatever a library raises as it loads
        print(f"{type(error).__name__}: {error}".splitlines()[0])
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(check_import(sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else ""))
