"""Remembering what was found of projects without keeping them: a closed project's motion is let go."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import Any, Generic, TypeVar
from weakref import ref

from metagraph.graph.model import Project

T = TypeVar("T")


class Remembered(Generic[T]):
    """What was found of the parts of projects, for as long as a project with the same parts lives.

    parts: of a project, those that what is found depends on; compared by identity. most: how many results are
    remembered, the latest. What is found must not refer to the project or its clips.
    """

    def __init__(self, parts: Callable[[Project], tuple[object, ...]], most: int = 8) -> None:
        self._parts, self._most = parts, most
        # Ids alone would be taken for those of other parts once theirs are gone: a project vouches for them.
        self._known: OrderedDict[Hashable, tuple[T, tuple[ref[Project], ...]]] = OrderedDict()

    def of(self, project: Project, more: Hashable, find: Callable[[], T]) -> T:
        """Return what was found before, else what `find` finds. more: what else it depends on, by value."""
        parts = self._parts(project)
        key = (*map(id, parts), more)
        known = self._known.get(key)
        if known is not None:
            value, owners = known
            if owners[-1]() is project:
                return value
            living = tuple(o for o in owners if (p := o()) is not None and self._same(p, parts))
            if living:  # one from before is kept beside this one, which may be a passing copy
                self._known[key] = value, (living[0], ref(project))
                return value
        value = find()
        self._known[key] = value, (ref(project),)
        while len(self._known) > self._most:
            self._known.popitem(last=False)
        return value

    def _same(self, project: Project, parts: tuple[Any, ...]) -> bool:
        return all(a is b for a, b in zip(self._parts(project), parts, strict=True))


class Latest(Generic[T]):
    """What a function finds of projects, the last few remembered: a project is a value, so the same one has
    the same answer. What is found must not refer to the project or its clips.
    """

    def __init__(self, find: Callable[[Project], T], most: int = 4) -> None:
        self._find, self._most = find, most
        self._known: list[tuple[ref[Project], T]] = []

    def __call__(self, project: Project) -> T:
        for whose, value in tuple(self._known):
            if whose() is project:
                return value
        value = self._find(project)
        self._known.insert(0, (ref(project), value))
        del self._known[self._most :]
        return value
