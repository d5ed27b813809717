"""BAS Partitur files (.par), which WebMAUS writes: ORT has the words, MAU the phones of each with their start
and length in samples, SAM how many samples a second there are. (Schiel, Burger, Geumann and Weilhammer 1998,
The Partitur Format at BAS.)
"""

from __future__ import annotations

import re

from metagraph.common.wording import phrase
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.words import Collected, Transcript

_LINE = re.compile(r"([A-Z]{3}):[ \t]*(.*)$")


def is_partitur(source: TranscriptSource) -> bool:
    return source.head.startswith("LHD:") or ("\nORT:" in source.text and "\nSAM:" in source.text)


def read_partitur(source: TranscriptSource) -> Transcript:
    """Read words by the phones that belong to them; a word lasts from its first phone to the end of its last.
    Raises FileError.
    """
    out = Collected(source.path)
    words: dict[int, str] = {}
    spans: dict[int, tuple[float, float]] = {}
    rate, speaker = 0.0, ""
    for n, line in enumerate(source.text.split("\n"), 1):
        found = _LINE.match(line)
        if found is None:
            continue
        key, cells = found[1], found[2].split()
        try:
            if key == "SAM":
                rate = float(cells[0])
            elif key == "SPN" and cells:
                speaker = cells[0]
            elif key == "ORT":
                words[int(cells[0])] = " ".join(cells[1:])
            elif key == "MAU" and int(cells[2]) >= 0:
                start, length, word = float(cells[0]), float(cells[1]), int(cells[2])
                # A phone's last sample is start + length, and the next one's first follows it.
                first, last = spans.get(word, (start, start))
                spans[word] = min(first, start), max(last, start + length + 1)
        except (ValueError, IndexError):
            raise out.fail(
                phrase("'{value}' does not have what belongs there", value=line.strip()[:60]), f"line {n}"
            ) from None
    if not 1 <= rate <= 1e6:
        raise out.fail(phrase("it does not give its sample rate (SAM)"))
    if words and not spans:
        raise out.fail(phrase("it has words (ORT), but no times of phones (MAU)"))
    for number, text in sorted(words.items()):
        if number in spans:
            start, end = spans[number]
            out.add(speaker, text, start / rate, end / rate, f"ORT {number}", whole=True)
    return out.finished()
