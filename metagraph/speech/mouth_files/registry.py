"""The readers of mouth shapes, in the order in which they look at a file. The manual's table of them is
made from this list (`docs/readers_page.py`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from metagraph.common.budgets import MARKS_FILE
from metagraph.common.files import guard_reader, read_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.speech.mouth_files import cues, dumps
from metagraph.speech.mouth_files.model import MouthFile, MouthShapes
from metagraph.speech.phones import list_mouth_pieces, list_phone_tiers
from metagraph.speech.textgrid import read_textgrid


@dataclass(frozen=True)
class MouthReader:
    """A kind of file of mouth shapes. name: of the tool; versions: which of it. holds: what is read. endings:
    of its files. begins: whether a file is of this kind. read: raises FileError. by_tool: whether it was
    checked against a file that the tool itself made; else it follows the published description.
    """

    name: str
    versions: str
    holds: str
    endings: tuple[str, ...]
    begins: Callable[[MouthFile], bool]
    read: Callable[[MouthFile], MouthShapes]
    by_tool: bool = False


def _is_grid(file: MouthFile) -> bool:
    begins = file.head.startswith(('File type = "ooTextFile', '"ooTextFile'))
    return begins or file.path.suffix.casefold() == ".textgrid"


def _read_grid(file: MouthFile) -> MouthShapes:
    grid = read_textgrid(file.path)
    pieces = list_mouth_pieces(grid)
    tiers, notes = list_phone_tiers(grid), []
    if len(tiers) > 1:
        others = ", ".join(f"'{t.name}'" for t in tiers[1:6])
        notes.append(
            phrase(
                "its phones are those of tier '{name}'; not read: {others}", name=tiers[0].name, others=others
            )
        )
    return MouthShapes(tuple(pieces), end=max([grid.end, *(p.end for p in pieces)]), notes=tuple(notes))


MOUTH_READERS: tuple[MouthReader, ...] = (
    MouthReader(
        "Praat TextGrid",
        "Montreal Forced Aligner, WebMAUS and others",
        "phones (ARPAbet, IPA, SAMPA), else words by their letters",
        (".TextGrid",),
        _is_grid,
        _read_grid,
        True,
    ),
    MouthReader(
        "Rhubarb Lip Sync",
        "1.x, XML",
        "shapes A to H and X",
        (".xml",),
        cues.is_rhubarb_xml,
        cues.read_rhubarb_xml,
    ),
    MouthReader(
        "Moho switch (Rhubarb, Papagayo)",
        "MohoSwitch1",
        "Preston Blair's or Rhubarb's shapes; 24 frames a second, or as the sound tells",
        (".dat",),
        cues.is_moho,
        cues.read_moho,
    ),
    MouthReader(
        "Papagayo",
        "lipsync version 1",
        "phonemes of the first voice",
        (".pgo",),
        cues.is_papagayo,
        cues.read_papagayo,
    ),
    MouthReader(
        "Papagayo-NG",
        "version 2",
        "phonemes of the first voice",
        (".pg2",),
        cues.is_papagayo_ng,
        cues.read_papagayo_ng,
    ),
    MouthReader(
        "OVRLipSync",
        "sequence saved by Unity",
        "15 weights a frame",
        (".asset",),
        dumps.is_viseme_sequence,
        dumps.read_viseme_sequence,
    ),
    MouthReader(
        "OVRLipSync",
        "JSON dump",
        "15 weights a frame",
        (".json",),
        dumps.is_viseme_json,
        dumps.read_viseme_json,
    ),
    MouthReader("Gentle", "JSON", "phones of its words", (".json",), cues.is_gentle, cues.read_gentle),
    MouthReader(
        "Rhubarb, Amazon Polly, Azure Speech, Oculus",
        "JSON: mouth cues, speech marks, viseme events, pairs of time and viseme",
        "shapes of one set, or phones",
        (".json",),
        cues.is_cue_list,
        cues.read_cue_list,
    ),
    MouthReader(
        "OVRLipSync",
        "CSV dump, with or without a head",
        "15 weights a frame",
        (".csv",),
        dumps.is_viseme_table,
        dumps.read_viseme_table,
    ),
    MouthReader(
        "Rhubarb and others",
        "TSV, and tables of start, end and shape",
        "shapes of one set, or phones",
        (".tsv", ".txt", ".csv"),
        cues.is_cue_table,
        cues.read_cue_table,
    ),
)
MOUTH_SUFFIXES = tuple(dict.fromkeys(s for one in MOUTH_READERS for s in one.endings))


@guard_reader
def read_mouth_file(path: str | Path, sound: float | None = None) -> MouthShapes:
    """Read what the mouth does. sound: how long the line's sound is, seconds, which tells units that a file
    does not name. Raises FileError.
    """
    path = Path(path)
    raw = read_file(path, MARKS_FILE)
    text = raw.decode("utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig", "replace")
    file = MouthFile(path, text.replace("\r\n", "\n").replace("\r", "\n"), sound)
    reader = next((one for one in MOUTH_READERS if one.begins(file)), None)
    if reader is None:
        names = ", ".join(dict.fromkeys(one.name for one in MOUTH_READERS))
        raise FileError(
            path,
            phrase("holds no phones and no mouth shapes in a known format"),
            phrase("its beginning"),
            phrase("Known formats are {names}.", names=names),
        )
    found = reader.read(file)
    if sound is None or found.end <= 1.25 * sound + 1.0:
        return found
    told = phrase(
        "its shapes end at {end:.1f} s and the sound at {sound:.1f} s: the file may belong to "
        "another sound, or its times may have another unit",
        end=found.end,
        sound=sound,
    )
    return replace(found, notes=(*found.notes, told))
