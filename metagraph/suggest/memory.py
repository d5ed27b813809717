"""Keep what is learned between projects: what words in names mean, from the user's changes and corrections,
and labelled clips of earlier projects.

A Memory is a value: every change gives a new one, so that a file can be read, changed and written whole. It
is kept as plain data by programs that have a place for it; others start from `Memory()`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final

from metagraph.suggest.alike import LabelledExample, decode_example
from metagraph.suggest.words.names import learn_correction
from metagraph.suggest.words.patterns import Patterns, PatternsError, forget_learned

VERSION: Final = 1
PROJECTS: Final = 50  # projects whose examples are kept, the latest
EXAMPLES: Final = 5000  # examples kept of all projects together


class MemoryFormatError(ValueError):
    """Raised if kept data cannot be read; the message names the place of the first error."""


@dataclass(frozen=True)
class Memory:
    """What is learned between projects.

    `patterns` say what words mean. `examples` has labelled clips by project key, any text that stays the same
    for a project, the latest last.
    """

    patterns: Patterns = field(default_factory=Patterns)
    examples: Mapping[str, tuple[LabelledExample, ...]] = field(default_factory=dict)

    def corrected(
        self, name: str, field: str, value: str | Sequence[str], names: Sequence[str] = ()
    ) -> Memory:
        """Remember that a clip of this name was corrected. `field` is one of `words_patterns.LEARNABLE`.
        `value` is the name of a stance or end stance, several tags, or a label. `names` are those of its
        batch. Raises PatternsError for an unknown field or value.
        """
        return replace(self, patterns=learn_correction(self.patterns, name, field, value, names))

    def with_project(self, key: str, examples: Sequence[LabelledExample]) -> Memory:
        """Return memory with a project's labelled clips replaced; without clips, the project is forgotten.
        The oldest projects are removed if there are more than PROJECTS, or more than EXAMPLES in total. A
        larger project keeps an even selection.
        """
        kept = {k: v for k, v in self.examples.items() if k != key}
        if examples:
            step = max(1, -(-len(examples) // EXAMPLES))
            kept[key] = tuple(examples[::step])
        while len(kept) > PROJECTS or sum(map(len, kept.values())) > EXAMPLES:
            kept.pop(next(iter(kept)))
        return replace(self, examples=kept)

    def others(self, key: str) -> list[LabelledExample]:
        """Return the examples of all other projects; this one's own labels are used directly."""
        return [example for k, some in self.examples.items() if k != key for example in some]

    def forgotten(
        self, words: bool = True, projects: bool = True, field: str | None = None, phrase: str | None = None
    ) -> Memory:
        """Return memory without what was learned. `words` removes what was learned from corrections, all or
        for one field or phrase; patterns that the user wrote stay. `projects` removes all examples.
        """
        narrow = field is not None or phrase is not None
        patterns = forget_learned(self.patterns, field, phrase) if words else self.patterns
        return Memory(patterns, {} if projects and not narrow else self.examples)

    def to_json(self) -> dict[str, Any]:
        """Return plain values for a file."""
        return {
            "learned": VERSION,
            "names": self.patterns.to_json(),
            "projects": {key: [e.to_data() for e in some] for key, some in self.examples.items()},
        }

    @staticmethod
    def from_json(data: Any) -> Memory:
        """Read the result of `to_json`; missing parts are empty. Raises MemoryFormatError naming the first
        wrong place.
        """
        if not isinstance(data, Mapping):
            raise MemoryFormatError(f"what was learned should be an object, not {type(data).__name__}")
        version = data.get("learned")
        if version != VERSION:
            raise MemoryFormatError(
                f"'learned' is version {version!r}, this program reads {VERSION}; update it, or delete the "
                "file"
            )
        for key in data:
            if key not in ("learned", "names", "projects"):
                raise MemoryFormatError(f"'{key}' is not known; there are 'names' and 'projects'")
        try:
            patterns = Patterns.from_json(data["names"]) if "names" in data else Patterns()
        except PatternsError as error:
            raise MemoryFormatError(f"'names': {error}") from None
        projects = data.get("projects", {})
        if not isinstance(projects, Mapping):
            raise MemoryFormatError(f"'projects' should be an object, not {type(projects).__name__}")
        return Memory(patterns, {str(key): _examples(str(key), some) for key, some in projects.items()})


def _examples(key: str, data: Any) -> tuple[LabelledExample, ...]:
    if not isinstance(data, list):
        raise MemoryFormatError(f"'projects', '{key}' should be a list, not {type(data).__name__}")
    out = []
    for n, each in enumerate(data):
        try:
            out.append(decode_example(each))
        except ValueError as error:
            raise MemoryFormatError(f"'projects', '{key}', number {n + 1}: {error}") from None
    return tuple(out)
