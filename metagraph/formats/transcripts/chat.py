"""CHAT transcripts of CHILDES and TalkBank (.cha): main lines `*ANN:` with a bullet of the utterance's start
and end in milliseconds, and `%wor:` lines with a bullet for each word. (MacWhinney, The CHILDES Project, CHAT
manual, "Media linkage" and "%wor".)
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from metagraph.common.wording import phrase, plural_phrase
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.words import Collected, Transcript

_BULLET = re.compile(r"[\x15•]\s*(?:%snd:\"[^\"]*\"[_ ])?(\d{1,10})_(\d{1,10})\s*-?[\x15•]")
_TIMED = re.compile(r"([^\x15•]*)[\x15•](\d{1,10})_(\d{1,10})[\x15•]")
_TIER = re.compile(r"([*%@])([^:\t\n]{1,40}):?[ \t]*(.*)$", re.DOTALL)
# What CHAT writes between words: <of> [//] retraced, [= comments], &=laughs, &-um is a word, (.) pauses.
_CODES = re.compile(r"\[[^\]]{0,300}\]|&=\S+|&\*\S+|\(\.{1,3}\)|\(\d+(?::\d+)?\.\d*\)|\+\S*|‡|„|[<>]")
_UNHEARD = ("xxx", "yyy", "www")
_WORD = re.compile(r"^&[-~+]|@\S*$|[()↑↓⌈⌉⌊⌋°∆∇:]")


def is_chat(source: TranscriptSource) -> bool:
    return source.head.startswith(("@UTF8", "@Begin", "@Font", "@ColorWords")) or (
        "\n@Begin" in source.head and "\n*" in source.text
    )


def read_chat(source: TranscriptSource) -> Transcript:
    """Read the words of `%wor` lines, else those of main lines, which share the time of their bullet.
    Speakers are called as `@Participants` names them, else by their codes. Raises FileError.
    """
    out = Collected(source.path)
    names: dict[str, str] = {}
    untimed = timed = 0
    held: tuple[int, str, str] | None = None  # a main line whose %wor may follow
    for line, mark, tier, text in _tiers(source.text):
        if mark == "@" and tier.casefold() == "participants":
            names = _participants(text)
        elif mark == "%" and tier.casefold() == "wor" and held is not None:
            for word, start, end in _TIMED.findall(text):
                for part in _plain(word)[-1:]:
                    out.add(
                        names.get(held[1], held[1]), part, int(start) / 1000, int(end) / 1000, f"line {line}"
                    )
                    timed += 1
            held = None
        elif mark == "*":
            timed, untimed = _main(out, held, names, timed, untimed)
            held = (line, tier, text)
    timed, untimed = _main(out, held, names, timed, untimed)
    if untimed and not timed:
        raise out.fail(
            phrase("its utterances have no times"),
            "",
            phrase("Link it to its sound in CLAN, so that each utterance has a bullet with its times."),
        )
    if untimed:
        out.notes.append(
            plural_phrase(
                "{count:,} utterance without times was skipped",
                "{count:,} utterances without times were skipped",
                untimed,
            )
        )
    return out.finished()


def _tiers(text: str) -> Iterator[tuple[int, str, str, str]]:
    """Yield line, mark, name and text of each tier; lines that begin with a tab go on with the one before."""
    held: list[str] = []
    first = 0
    for n, line in enumerate([*text.split("\n"), "@End"], 1):
        if line.startswith(("\t", " ")) and held:
            held.append(line.strip())
            continue
        found = _TIER.match(" ".join(held)) if held else None
        if found is not None:
            yield first, found[1], found[2].strip(), found[3]
        held, first = ([line], n) if line[:1] in "*%@" and line else ([], n)


def _participants(text: str) -> dict[str, str]:
    """Return names by codes: "MOT Mary Mother, CHI Target_Child"; a code without a name keeps the code."""
    out = {}
    for one in text.split(","):
        words = one.split()
        if words:
            out[words[0]] = words[1].replace("_", " ") if len(words) > 2 else words[0]
    return out if len(set(out.values())) == len(out) else {}


def _main(
    out: Collected, held: tuple[int, str, str] | None, names: dict[str, str], timed: int, untimed: int
) -> tuple[int, int]:
    """Add what a main line says, shared over its bullets; return how many are timed and untimed by then."""
    if held is None:
        return timed, untimed
    line, code, text = held
    who = names.get(code, code)
    at = 0
    for bullet in _BULLET.finditer(text):
        words = _plain(text[at : bullet.start()])
        out.add(who, " ".join(words), int(bullet[1]) / 1000, int(bullet[2]) / 1000, f"line {line}")
        timed += 1
        at = bullet.end()
    return timed, untimed + (at == 0 and bool(_plain(text)))


def _plain(text: str) -> list[str]:
    """Return the words of a main line as they are said, without codes."""
    words = [_WORD.sub("", w) for w in _CODES.sub(" ", text).split() if not w.startswith(("&=", "0"))]
    return [w.replace("_", " ") for w in words if w not in _UNHEARD and any(map(str.isalnum, w))]
