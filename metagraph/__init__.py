"""Metagraph: stance, gesture, fidget, transition - the domain, without Qt or OpenGL."""

from typing import Any

__version__ = "0.1.0"


def __getattr__(name: str) -> Any:
    """`from metagraph import Character` for programs that play an export; nothing is loaded by whoever does
    not.
    """
    if name == "Character":
        from metagraph.engines.character import Character

        return Character
    raise AttributeError(f"module 'metagraph' has no attribute '{name}'")
