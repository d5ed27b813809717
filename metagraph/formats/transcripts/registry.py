"""The readers of transcripts, in the order in which they look at a file. The manual's table of them is
made from this list (`docs/readers_page.py`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from metagraph.formats.transcripts import (
    bas,
    chat,
    chat_logs,
    cues,
    json_files,
    subtitle_kinds,
    tables,
    tiers,
    xml_tiers,
)
from metagraph.formats.transcripts.services import (
    assemblyai,
    aws,
    azure,
    cartesia,
    deepgram,
    elevenlabs,
    gladia,
    google,
    polly,
    rev,
    speechmatics,
    youtube,
)
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.words import Transcript


@dataclass(frozen=True)
class TranscriptReader:
    """A kind of transcript. name: of the tool or format; versions: which of it. holds: what is read. endings:
    of its files. begins: whether a file is of this kind. read: raises FileError. by_tool: whether it was
    checked against a file that the tool itself made; else it follows the published description.
    """

    name: str
    versions: str
    holds: str
    endings: tuple[str, ...]
    begins: Callable[[TranscriptSource], bool]
    read: Callable[[TranscriptSource], Transcript]
    by_tool: bool = False


_JSON = (".json",)
TRANSCRIPT_READERS: tuple[TranscriptReader, ...] = (
    TranscriptReader(
        "Praat TextGrid",
        "long and short text",
        "words of the tiers that hold some, speakers by the tiers' names",
        (".TextGrid",),
        tiers.is_textgrid,
        tiers.read_textgrid_tiers,
        True,
    ),
    TranscriptReader(
        "Montreal Forced Aligner",
        "JSON of 2.x; TextGrid as Praat's",
        "words, speakers",
        _JSON,
        tiers.is_mfa_json,
        tiers.read_mfa_json,
    ),
    TranscriptReader(
        "Montreal Forced Aligner",
        "CSV of 2.x",
        "words, speakers",
        (".csv",),
        tables.is_mfa_table,
        tables.read_mfa_table,
    ),
    TranscriptReader(
        "ELAN",
        "EAF 2.x, 3.0",
        "words and phrases, speakers by participant or tier, the media's offset",
        (".eaf",),
        tiers.is_elan,
        tiers.read_elan_tiers,
        True,
    ),
    TranscriptReader(
        "Transcriber",
        "trans-13, trans-14",
        "turns with their synchronised parts, speakers",
        (".trs",),
        xml_tiers.is_transcriber,
        xml_tiers.read_transcriber,
    ),
    TranscriptReader(
        "EXMARaLDA",
        "basic transcription 1.x",
        "events of the transcription tiers, speakers",
        (".exb",),
        xml_tiers.is_exmaralda,
        xml_tiers.read_exmaralda,
    ),
    TranscriptReader(
        "Metagraph",
        "`metagraph speech -o`",
        "words, segments, speakers",
        _JSON,
        json_files.is_saved_conversation,
        json_files.read_saved_conversation,
        True,
    ),
    TranscriptReader(
        "Deepgram",
        "v1, pre-recorded",
        "words, speakers or channels",
        _JSON,
        deepgram.is_deepgram,
        deepgram.read_deepgram,
    ),
    TranscriptReader(
        "Rev AI, Rev.com", "monologues", "words with their marks, speakers", _JSON, rev.is_rev, rev.read_rev
    ),
    TranscriptReader(
        "Amazon Transcribe",
        "batch; Call Analytics",
        "words with their marks, speakers or channels",
        _JSON,
        aws.is_aws,
        aws.read_aws,
    ),
    TranscriptReader(
        "Google Speech-to-Text",
        "v1, v1p1beta1, v2; Video Intelligence v1",
        "words, speakers or channels",
        _JSON,
        google.is_google,
        google.read_google,
    ),
    TranscriptReader(
        "Azure Speech",
        "batch 3.x and 2024-11-15, fast transcription, Speech SDK",
        "words or phrases, speakers or channels",
        _JSON,
        azure.is_azure,
        azure.read_azure,
    ),
    TranscriptReader(
        "AssemblyAI", "v2", "words, speakers", _JSON, assemblyai.is_assemblyai, assemblyai.read_assemblyai
    ),
    TranscriptReader(
        "ElevenLabs",
        "Scribe v1; speech with timestamps v1",
        "words, speakers; characters joined to words",
        _JSON,
        elevenlabs.is_elevenlabs,
        elevenlabs.read_elevenlabs,
    ),
    TranscriptReader(
        "Amazon Polly", "speech marks", "words and when they begin", _JSON, polly.is_polly, polly.read_polly
    ),
    TranscriptReader(
        "Speechmatics",
        "json-v2",
        "words with their marks, speakers or channels",
        _JSON,
        speechmatics.is_speechmatics,
        speechmatics.read_speechmatics,
    ),
    TranscriptReader(
        "Gladia", "v2", "words or utterances, speakers", _JSON, gladia.is_gladia, gladia.read_gladia
    ),
    TranscriptReader(
        "Cartesia",
        "`word_timestamps`",
        "words",
        _JSON,
        cartesia.is_cartesia,
        cartesia.read_cartesia,
    ),
    TranscriptReader(
        "YouTube",
        "json3",
        "segments, each until the next begins",
        (".json3", ".json"),
        youtube.is_youtube,
        youtube.read_youtube,
    ),
    TranscriptReader(
        "NeMo (Parakeet, Canary)",
        "`timestamp` of a hypothesis",
        "words or segments",
        _JSON,
        json_files.is_nemo,
        json_files.read_nemo,
    ),
    TranscriptReader(
        "whisper.cpp",
        "`-oj`",
        "segments, or words with `-ml 1`",
        _JSON,
        json_files.is_whisper_cpp,
        json_files.read_whisper_cpp,
    ),
    TranscriptReader(
        "Transformers",
        "speech recognition pipeline",
        "words or segments",
        _JSON,
        json_files.is_transformers,
        json_files.read_transformers,
    ),
    TranscriptReader("Vosk", "0.3", "words", _JSON, json_files.is_vosk, json_files.read_vosk),
    TranscriptReader(
        "IBM Speech to Text", "v1", "words, speakers", _JSON, json_files.is_ibm, json_files.read_ibm
    ),
    TranscriptReader(
        "Whisper, faster-whisper, WhisperX, Gentle",
        "JSON; any JSON with a list of words or segments",
        "words, segments, speakers",
        _JSON,
        json_files.is_word_list,
        json_files.read_word_list,
    ),
    TranscriptReader(
        "CHAT (CLAN, TalkBank)",
        "`@UTF8`",
        "words of `%wor`, or utterances with their times; speakers",
        (".cha",),
        chat.is_chat,
        chat.read_chat,
    ),
    TranscriptReader(
        "BAS Partitur (WebMAUS)",
        "1.2, 1.3",
        "words by their phones",
        (".par",),
        bas.is_partitur,
        bas.read_partitur,
    ),
    TranscriptReader(
        "TTML (DFXP, IMSC)",
        "1 and 2, text profiles",
        "paragraphs and timed spans, speakers by agent",
        (".ttml", ".dfxp"),
        subtitle_kinds.is_ttml,
        subtitle_kinds.read_ttml,
    ),
    TranscriptReader(
        "SubStation Alpha",
        "SSA 4, ASS 4+",
        "lines of dialogue, speakers by Name",
        (".ass", ".ssa"),
        subtitle_kinds.is_substation,
        subtitle_kinds.read_substation,
    ),
    TranscriptReader(
        "SubViewer (YouTube's SBV)",
        "2.0",
        "texts",
        (".sbv",),
        subtitle_kinds.is_sbv,
        subtitle_kinds.read_sbv,
    ),
    TranscriptReader(
        "LRC",
        "also with times of words",
        "lines and when they begin",
        (".lrc",),
        subtitle_kinds.is_lyrics,
        subtitle_kinds.read_lyrics,
    ),
    TranscriptReader(
        "WebVTT, SubRip",
        "captions that roll up, grow or mark words too",
        "words, their times inside, speakers",
        (".vtt", ".srt"),
        cues.is_cues,
        cues.read_cues,
    ),
    TranscriptReader(
        "Tables",
        "start, end, text: GENEA, Audacity, Whisper",
        "words or texts",
        (".tsv", ".txt"),
        tables.is_word_table,
        tables.read_word_table,
    ),
    TranscriptReader(
        "CTM (NIST, Kaldi)",
        "with or without confidence",
        "words; recordings or channels are speakers",
        (".ctm",),
        tables.is_ctm,
        tables.read_ctm,
    ),
    TranscriptReader(
        "Chat logs",
        "a time and a name before each text",
        "texts and when they begin, speakers",
        (".txt",),
        chat_logs.is_chat_log,
        chat_logs.read_chat_log,
    ),
)
# Files that are looked for beside a sound. Tables with commas and plain texts are mostly something else.
_ASIDE = (".csv", ".txt")
_FIRST = (".TextGrid", ".eaf", ".vtt", ".srt", ".json", ".ctm", ".tsv")  # of several beside a sound
TRANSCRIPT_SUFFIXES = tuple(
    dict.fromkeys((*_FIRST, *(s for one in TRANSCRIPT_READERS for s in one.endings if s not in _ASIDE)))
)


def find_transcript_reader(source: TranscriptSource) -> TranscriptReader | None:
    """Return the first reader that knows a file; None if none does. Raises FileError for broken JSON."""
    return next((one for one in TRANSCRIPT_READERS if one.begins(source)), None)


def describe_transcript_formats(ending: str = "") -> str:
    """Return the names of all formats, as in a list; of those with an ending, if one is given."""
    return ", ".join(
        dict.fromkeys(one.name for one in TRANSCRIPT_READERS if not ending or ending in one.endings)
    )
