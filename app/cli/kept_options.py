"""Check options whose values the project keeps, before the command does any work."""

from __future__ import annotations

from argparse import ArgumentTypeError


def check_kept_name(text: str) -> str:
    """Return the name for a saved performance. A name that is too long is refused before any work is done."""
    from metagraph.graph.requests import LONGEST_NAME

    if len(text) > LONGEST_NAME:
        raise ArgumentTypeError(f"the name has {len(text)} letters; at most {LONGEST_NAME} can be kept")
    return text


def parse_kept_seed(text: str) -> int:
    """Return a seed in the form that projects have."""
    if not (text.isascii() and text.isdigit() and int(text) <= 0xFFFFFFFF):
        raise ArgumentTypeError(f"'{text[:40]}' is not a seed; a seed is a whole number from 0 to 4294967295")
    return int(text)
