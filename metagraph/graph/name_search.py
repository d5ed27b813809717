"""What is typed to find names: words, words that must not be there, and several of these."""

from __future__ import annotations


def matches_search(words: str, name: str) -> bool:
    """Whether a name fits what is searched for: it holds all words of one of the parts between |, and none of
    those that begin with -. Capitals do not matter. Nothing fits no words.
    """
    name = name.lower()
    return any(_fits(part.split(), name) for part in words.lower().split("|"))


def _fits(terms: list[str], name: str) -> bool:
    terms = [t for t in terms if t != "-"]
    return bool(terms) and all((t[1:] not in name) if t[0] == "-" else t in name for t in terms)
