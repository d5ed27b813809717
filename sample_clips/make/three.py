"""Speaks a conversation of three, each in a language of their own, with eSpeak NG.

    python -m sample_clips.make.three FOLDER

Writes `three.wav`, a channel each, and `three.vtt`, who says what. Nothing of it is kept among the samples.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

from sample_clips.make.talk import Said, SpeakingVoice, Talk, Turn, speak, write_sound

NAMES = ("Ann", "Uwe", "Zoé")
VOICES: tuple[SpeakingVoice, ...] = (("en-us+f3", 58, 170), ("de", 34, 165), ("fr-fr+f2", 60, 170))
TURNS = (
    Turn(0, 0.5, ("so where do we go for the *summer*", "and what do you want to *do* there Uwe")),
    Turn(1, 0.4, ("hesitation: ähm",)),
    Turn(1, 0.3, ("ich möchte gerne in die *Berge*", "und dort in einem *kleinen* Haus wohnen")),
    Turn(2, -0.3, ("response: d'accord",)),
    Turn(2, 0.5, ("mais moi je préfère la *mer*", "et il y a des *bateaux* pour tout le monde")),
    Turn(1, 0.2, ("response: genau",)),
    Turn(0, 0.5, ("then we take the *boat* to the mountains", "and *you* find us a house Zoé")),
    Turn(2, 0.3, ("response: oui",)),
    Turn(2, 0.5, ("c'est une *bonne* idée", "alors je vais *chercher* une maison pour nous")),
    Turn(0, 0.2, ("response: great",)),
)


def three() -> Talk:
    """Return it as it sounds. Raises MissingError if eSpeak NG is not there."""
    return speak(TURNS, voices=VOICES)


def write_cues(path: Path, said: Iterable[Said]) -> None:
    """Write what was said as WebVTT, a voice tag before each."""
    rows = sorted(said, key=lambda s: s.start)
    cues = [f"{_clock(s.start)} --> {_clock(s.end)}\n<v {NAMES[s.side]}>{s.text}</v>" for s in rows]
    path.write_text("\n\n".join(("WEBVTT", *cues)) + "\n", encoding="utf-8")


def _clock(seconds: float) -> str:
    minutes, rest = divmod(round(1000 * seconds), 60_000)
    return f"{minutes:02d}:{rest // 1000:02d}.{rest % 1000:03d}"


def main() -> None:
    folder = Path(sys.argv[1])
    talk = three()
    write_sound(folder / "three.wav", talk.samples, talk.rate)
    write_cues(folder / "three.vtt", talk.said)


if __name__ == "__main__":
    main()
