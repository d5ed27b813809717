"""Options whose values end up in a project: refused before anything is done that would be lost with them."""

from __future__ import annotations

from argparse import ArgumentTypeError


def kept_name(text: str) -> str:
    """Return the name that a performance is to be kept under; told to be too long before anything is done."""
    from metagraph.graph.requests import LONGEST_NAME

    if len(text) > LONGEST_NAME:
        raise ArgumentTypeError(f"the name has {len(text)} letters; at most {LONGEST_NAME} can be kept")
    return text


def kept_seed(text: str) -> int:
    """Return a seed as projects hold it."""
    if not (text.isascii() and text.isdigit() and int(text) <= 0xFFFFFFFF):
        raise ArgumentTypeError(f"'{text[:40]}' is not a seed: a whole number from 0 to 4294967295")
    return int(text)
