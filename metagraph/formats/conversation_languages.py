"""Which language each of two is read in: what was chosen, or what their words tell; and what there is to say
of that.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from metagraph.formats.conversation_words import Told
from metagraph.formats.transcript_words import count
from metagraph.graph.conversation import AUTO
from metagraph.speech.language_detection import Spoken, language_spoken
from metagraph.speech.language_packs import ENGLISH, Language, languages

_BY_LISTS = (
    "responses, hesitations and clauses go by that language's lists, lips by its letters as English spells. "
    "Choose another language if that is wrong."
)
Lists = tuple[tuple[str, ...], tuple[str, ...]]  # responses and hesitations


@dataclass(frozen=True, eq=False)
class Speaking:
    """language: a code for both, or `AUTO` for what each one's words tell. otherwise: the code of what is
    taken where they tell nothing, `AUTO` for English. packs: the languages that are known, by code. lists: of
    each side, responses and hesitations instead of its language's; None for those.
    """

    language: str = AUTO
    otherwise: str = AUTO
    packs: Mapping[str, Language] = field(default_factory=languages)
    lists: tuple[Lists | None, Lists | None] = (None, None)

    def __post_init__(self) -> None:
        if self.language not in (AUTO, *self.packs):
            raise ValueError(
                f"there are no words of '{self.language[:40]}': known are {', '.join(self.packs)}; choose "
                "one, 'auto', or give a list of words of your own"
            )

    @property
    def usual(self) -> Language:
        """What is taken where words tell nothing."""
        return self.packs.get(self.otherwise) or self.packs.get(ENGLISH) or next(iter(self.packs.values()))

    def lists_for(self, side: int, language: Language | None) -> Lists:
        """Return responses and hesitations of a side; none in a language that is not known."""
        given = self.lists[side]
        if given is not None:
            return given
        return (language.responses, language.hesitations) if language is not None else ((), ())


def languages_of(
    notes: list[str], called: Sequence[str], told: Sequence[Told], speaking: Speaking
) -> tuple[Language | None, Language | None]:
    """Return what each of the two is read in, None where nobody knows; say how that was found."""
    spoken = [_spoken(one, speaking) for one in told]
    if speaking.language != AUTO:
        chosen = speaking.packs[speaking.language]
        for name, found in zip(called, spoken, strict=True):
            if found is not None and found.language not in (None, chosen):
                assert found.language is not None
                notes.append(
                    f"{name}: its words look {found.language.called}; they are read as {chosen.called}, as "
                    "was chosen."
                )
        return chosen, chosen
    out: list[Language | None] = []
    for n, found in enumerate(spoken):
        partner = spoken[1 - n]
        as_partner = partner.language if partner is not None else None
        if found is None:  # no words: nothing to read, but the lists are the partner's
            out.append(as_partner or speaking.usual)
        elif found.how == "unknown" or (
            found.language is None and partner is not None and partner.how == "unknown"
        ):
            out.append(None)
        else:
            out.append(found.language or as_partner or speaking.usual)
    first, second = spoken
    if first is not None and second is not None and first.language is second.language is not None:
        notes += _both(first, second) if any(t.segments is None for t in told) else []
        return out[0], out[1]
    for n, (name, found) in enumerate(zip(called, spoken, strict=True)):
        if found is not None and told[n].segments is None:
            notes += _told(name, found, out[n], spoken[1 - n], speaking)
    return out[0], out[1]


def _both(first: Spoken, second: Spoken) -> list[str]:
    assert first.language is not None
    if first.language.code == ENGLISH:
        return []
    of = f"{first.known:,} of {first.words:,} and {second.known:,} of {second.words:,}"
    return [f"Both speak {first.language.called}, as {of} words tell; {_BY_LISTS}"]


def _spoken(told: Told, speaking: Speaking) -> Spoken | None:
    """Return what one's words tell; None where there are none."""
    texts = [w.text for w in told.words] or [s.text for s in told.segments or () if s.text]
    return language_spoken(texts, tuple(speaking.packs.values())) if texts else None


def _told(
    name: str, found: Spoken, read: Language | None, partner: Spoken | None, speaking: Speaking
) -> list[str]:
    if read is None and found.how != "unknown":
        return [
            f"{name}: {count(found.words, 'word')} do not tell the language; as the other's is not known, "
            "sound tells clauses and short answers here, too."
        ]
    if read is None:
        known = ", ".join(speaking.packs)
        return [
            f"{name}: its words are of no language that there are lists for ({known}), so sound tells "
            "clauses and short answers, and no word is taken for a response or a hesitation. Choose the "
            "language, or give a list of its words."
        ]
    if found.how == "sure":
        if read.code == ENGLISH:
            return []
        return [
            f"{name}: its words are {read.called}, as {found.known:,} of {found.words:,} tell; {_BY_LISTS}"
        ]
    if partner is not None and partner.language is read:
        why = "as the other's are"
    else:
        why = "which the project is set to" if speaking.otherwise == read.code else "which is taken then"
    few = "are too few to tell" if found.words < 12 else "do not tell"
    return [
        f"{name}: {count(found.words, 'word')} {few} the language by; undecided, they are read as "
        f"{read.called}, {why}."
    ]
