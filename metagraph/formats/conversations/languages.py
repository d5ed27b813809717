"""Find the language of each speaker: the chosen one, or the one that the words suggest; and report how it was
found.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from metagraph.common.wording import phrase
from metagraph.formats.conversations.words import TranscribedSide
from metagraph.formats.transcripts.words import count, join_as_list
from metagraph.graph.conversation.model import AUTO
from metagraph.speech.language_detection import SpokenLanguage, detect_language
from metagraph.speech.language_packs import ENGLISH, LanguagePack, list_language_packs

_BY_LISTS = phrase(
    "that language's lists decide on responses, hesitations and clauses, and "
    "its letters, read as in English, move the lips. Choose another language "
    "if that is wrong."
)
Lists = tuple[tuple[str, ...], tuple[str, ...]]  # responses and hesitations


@dataclass(frozen=True, eq=False)
class Speaking:
    """language: a code for all, or `AUTO` for what each one's words tell. otherwise: the code of what is
    taken where they tell nothing, `AUTO` for English. packs: the languages that are known, by code. lists: of
    each side, responses and hesitations instead of its language's; None for those, as for sides beyond.
    """

    language: str = AUTO
    otherwise: str = AUTO
    packs: Mapping[str, LanguagePack] = field(default_factory=list_language_packs)
    lists: tuple[Lists | None, ...] = ()

    def __post_init__(self) -> None:
        if self.language not in (AUTO, *self.packs):
            raise ValueError(
                phrase(
                    "there are no words of '{language}'. Known languages are {names}. Choose "
                    "one of them, 'auto', or a list of your own words",
                    language=self.language[:40],
                    names=", ".join(self.packs),
                )
            )

    @property
    def usual(self) -> LanguagePack:
        """What is taken where words tell nothing."""
        return self.packs.get(self.otherwise) or self.packs.get(ENGLISH) or next(iter(self.packs.values()))

    def lists_for(self, side: int, language: LanguagePack | None) -> Lists:
        """Return responses and hesitations of a side; none in a language that is not known."""
        given = self.lists[side] if side < len(self.lists) else None
        if given is not None:
            return given
        return (language.responses, language.hesitations) if language is not None else ((), ())


def choose_languages(
    notes: list[str], called: Sequence[str], said: Sequence[TranscribedSide], speaking: Speaking
) -> tuple[LanguagePack | None, ...]:
    """Return what each is read in, None if nobody knows; say how that was found."""
    spoken = [_spoken(one, speaking) for one in said]
    if speaking.language != AUTO:
        chosen = speaking.packs[speaking.language]
        for name, found in zip(called, spoken, strict=True):
            if found is not None and found.language not in (None, chosen):
                assert found.language is not None
                notes.append(
                    phrase(
                        "{name}: its words look {called}, but they are read as {called2}, as you chose.",
                        name=name,
                        called=found.language.called,
                        called2=chosen.called,
                    )
                )
        return (chosen,) * len(said)
    partners = [_partner(spoken, n) for n in range(len(spoken))]
    out: list[LanguagePack | None] = []
    for found, partner in zip(spoken, partners, strict=True):
        as_partner = partner.language if partner is not None else None
        if found is None:  # no words: nothing to read, but the lists are the partner's
            out.append(as_partner or speaking.usual)
        elif found.how == "unknown" or (
            found.language is None and partner is not None and partner.how == "unknown"
        ):
            out.append(None)
        else:
            out.append(found.language or as_partner or speaking.usual)
    worded = [s for s in spoken if s is not None]
    alike = len(worded) == len(spoken) and len({s.language for s in worded}) == 1
    if alike and worded[0].language is not None:
        notes += _all_alike(worded) if any(t.segments is None for t in said) else []
        return tuple(out)
    for n, (name, found) in enumerate(zip(called, spoken, strict=True)):
        if found is not None and said[n].segments is None:
            notes += _told(name, found, out[n], partners[n], speaking)
    return tuple(out)


def _partner(spoken: Sequence[SpokenLanguage | None], n: int) -> SpokenLanguage | None:
    """Return what the words of those who talk with one tell: of several, of the first whose language they
    tell.
    """
    others = [s for m, s in enumerate(spoken) if m != n and s is not None]
    return next((s for s in others if s.language is not None), others[0] if others else None)


def _all_alike(spoken: Sequence[SpokenLanguage]) -> list[str]:
    assert spoken[0].language is not None
    if spoken[0].language.code == ENGLISH:
        return []
    of = join_as_list([phrase("{known:,} of {words:,}", known=s.known, words=s.words) for s in spoken])
    return [
        phrase(
            "Both speak {language}, judging by {of} words; {lists}"
            if len(spoken) == 2
            else "All speak {language}, judging by {of} words; {lists}",
            language=spoken[0].language.called,
            of=of,
            lists=_BY_LISTS,
        )
    ]


def _spoken(said: TranscribedSide, speaking: Speaking) -> SpokenLanguage | None:
    """Return what one's words tell; None if there are none."""
    texts = [w.text for w in said.words] or [s.text for s in said.segments or () if s.text]
    return detect_language(texts, tuple(speaking.packs.values())) if texts else None


def _told(
    name: str,
    found: SpokenLanguage,
    read: LanguagePack | None,
    partner: SpokenLanguage | None,
    speaking: Speaking,
) -> list[str]:
    if read is None and found.how != "unknown":
        return [
            phrase(
                "{name}: {count} do not show the language. The other side's is unknown, "
                "too, so clauses and short answers come from the sound.",
                name=name,
                count=count(found.words, "word"),
            )
        ]
    if read is None:
        known = ", ".join(speaking.packs)
        return [
            phrase(
                "{name}: there are no lists for the language of its words (only for "
                "{known}), so clauses and short answers come from the sound, and no word "
                "counts as a response or a hesitation. Choose the language, or add a list "
                "of its words.",
                name=name,
                known=known,
            )
        ]
    if found.how == "sure":
        if read.code == ENGLISH:
            return []
        return [
            phrase(
                "{name}: its words are {language}, judging by {known:,} of {words:,}; {lists}",
                name=name,
                language=read.called,
                known=found.known,
                words=found.words,
                lists=_BY_LISTS,
            )
        ]
    if partner is not None and partner.language is read:
        why = phrase("like the other side's")
    elif speaking.otherwise == read.code:
        why = phrase("the language of the project")
    else:
        why = phrase("the default")
    return [
        phrase(
            ("{name}: the language is undecided from only {count}; read as {language}, {why}.")
            if found.words < 12
            else "{name}: {count} do not show the language, so it is undecided; read as {language}, {why}.",
            name=name,
            count=count(found.words, "word"),
            language=read.called,
            why=why,
        )
    ]
