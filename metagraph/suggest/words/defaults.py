"""What the words in clips' names mean where no user has changed it (`words/patterns`). Words of other
languages stand for English ones: `synonyms`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from types import MappingProxyType
from typing import Final, Literal, get_args

from msgspec.structs import asdict

from metagraph.suggest.words.files import list_english_meanings, list_phrases
from metagraph.suggest.words.languages import list_synonyms

Field = Literal["kinds", "layers", "limbs", "tags", "postures", "joins", "junk", "synonyms"]
Meanings = Mapping[str, str]  # phrase -> meaning


@cache
def _english() -> Mapping[str, Meanings]:
    return {
        field: MappingProxyType(
            {phrase: meaning for meaning, said in of.items() for phrase in list_phrases(said)}
        )
        for field, of in asdict(list_english_meanings()).items()
    }


class _Defaults(Mapping[Field, Meanings]):
    """What is built in, read when it is first asked for."""

    def __getitem__(self, name: Field) -> Meanings:
        return list_synonyms() if name == "synonyms" else _english()[name]

    def __iter__(self) -> Iterator[Field]:
        return iter(get_args(Field))

    def __len__(self) -> int:
        return len(get_args(Field))


DEFAULTS: Final[Mapping[Field, Meanings]] = _Defaults()
