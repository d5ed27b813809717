"""AssemblyAI's transcripts: words[] and utterances[], in milliseconds."""

from __future__ import annotations

from metagraph.formats.transcripts.json_files import add_words
from metagraph.formats.transcripts.json_values import (
    list_of,
    list_row_dicts,
    name_of,
    parse_json_seconds,
    parse_text,
)
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.words import Collected, Transcript

_MARKS = {"acoustic_model", "audio_url", "audio_duration", "language_model", "speech_model", "speaker_labels"}


def is_assemblyai(source: TranscriptSource) -> bool:
    return isinstance(source.data, dict) and bool(
        {"words", "utterances"} & source.keys and len(_MARKS & source.keys) > 1
    )


def read_assemblyai(source: TranscriptSource) -> Transcript:
    """Read words by their speaker; utterances where no words are listed. Raises FileError."""
    out = Collected(source.path)
    out.unit = 1e-3
    if source.data.get("words"):
        add_words(out, list_of(out, source.data["words"], "words"), "", "words")
    for where, one in [] if source.data.get("words") else list_row_dicts(out, source.data, "utterances"):
        who = name_of(one.get("speaker", ""))
        start, end = (
            parse_json_seconds(out, one.get("start"), where),
            parse_json_seconds(out, one.get("end"), where),
        )
        if one.get("words"):
            words = list_of(out, one["words"], f"{where}.words")
            add_words(out, words, who, f"{where}.words", (start, end))
        else:
            add_words(
                out,
                [{"word": parse_text(one.get("text")), "start": one.get("start"), "end": one.get("end")}],
                who,
                where,
            )
    return out.finished()
