"""A small file of each kind of transcript, made by hand after its published description: kind -> its name
and content. Each says "so we" and most say "yes" afterwards, at the times in WORDS.
"""

from __future__ import annotations

import json
from typing import Any

# start and end of each word, seconds, and who says it
WORDS = (("so", 0.1, 0.3, "A"), ("we", 0.3, 0.6, "A"), ("yes", 1.0, 1.4, "B"))


def _rows(**names: Any) -> list[dict[str, Any]]:
    """names: what the word, start, end and speaker are called; a callable gives the value of a time."""
    scale = names.pop("scale", lambda t: t)
    out = []
    for word, start, end, who in WORDS:
        row = {names["word"]: word, names["start"]: scale(start), names["end"]: scale(end)}
        if "who" in names:
            row[names["who"]] = who
        out.append(row)
    return out


def _ms(seconds: float) -> int:
    return round(seconds * 1000)


def _ticks(seconds: float) -> int:
    return round(seconds * 10_000_000)


_deepgram_words = [
    {**r, "confidence": 0.9, "punctuated_word": r["word"]}
    for r in _rows(word="word", start="start", end="end")
]
for _row, (_, _, _, _who) in zip(_deepgram_words, WORDS, strict=True):
    _row["speaker"] = "AB".index(_who)
_google = [
    {"startTime": f"{s:.3f}s", "endTime": f"{e:.3f}s", "word": w, "speakerTag": "AB".index(p) + 1}
    for w, s, e, p in WORDS
]
_aws = [
    {
        "type": "pronunciation",
        "start_time": str(s),
        "end_time": str(e),
        "speaker_label": f"spk_{'AB'.index(p)}",
        "alternatives": [{"confidence": "0.9", "content": w}],
    }
    for w, s, e, p in WORDS
]
_mark = {"type": "punctuation", "alternatives": [{"confidence": "0.0", "content": "."}]}
JSON_TRANSCRIPTS: dict[str, Any] = {
    "deepgram v1": {"metadata": {"duration": 2.0}, "results": {"channels": [{"alternatives": [{"transcript": "so we yes", "words": _deepgram_words}]}]}},
    "deepgram v1 utterances": {"results": {"utterances": [{"start": 0.1, "end": 0.6, "speaker": 0, "words": _deepgram_words[:2]}, {"start": 1.0, "end": 1.4, "speaker": 1, "words": _deepgram_words[2:]}]}},
    "rev ai": {"monologues": [
        {"speaker": 0, "elements": [{"type": "text", "value": "so", "ts": 0.1, "end_ts": 0.3}, {"type": "punct", "value": " "}, {"type": "text", "value": "we", "ts": 0.3, "end_ts": 0.6}]},
        {"speaker": 1, "elements": [{"type": "text", "value": "yes", "ts": 1.0, "end_ts": 1.4}]}]},
    "rev.com": {"speakers": [{"id": 0, "name": "Ann"}, {"id": 1, "name": "Ben"}], "monologues": [
        {"speaker": 0, "elements": [{"type": "text", "value": "so", "timestamp": "00:00:00,100", "end_timestamp": "00:00:00,300"}, {"type": "text", "value": "we", "timestamp": "00:00:00,300", "end_timestamp": "00:00:00,600"}]},
        {"speaker": 1, "elements": [{"type": "text", "value": "yes", "timestamp": "00:00:01,000", "end_timestamp": "00:00:01,400"}]}]},
    "aws transcribe": {"jobName": "j", "status": "COMPLETED", "results": {"transcripts": [{"transcript": "so we yes"}], "items": _aws}},
    "aws transcribe labels": {"results": {"transcripts": [], "items": [{k: v for k, v in i.items() if k != "speaker_label"} for i in _aws],
        "speaker_labels": {"speakers": 2, "segments": [{"items": [{"start_time": i["start_time"], "end_time": i["end_time"], "speaker_label": i["speaker_label"]} for i in _aws]}]}}},
    "aws transcribe channels": {"results": {"transcripts": [], "items": [], "channel_labels": {"channels": [
        {"channel_label": f"ch_{n}", "items": [{k: v for k, v in i.items() if k != "speaker_label"} for i in some]} for n, some in enumerate((_aws[:2], _aws[2:]))]}}},
    "aws call analytics": {"Transcript": [
        {"ParticipantRole": "AGENT", "BeginOffsetMillis": 100, "EndOffsetMillis": 600, "Content": "so we", "Items": [{"Type": "pronunciation", "Content": w, "BeginOffsetMillis": _ms(s), "EndOffsetMillis": _ms(e)} for w, s, e, _ in WORDS[:2]]},
        {"ParticipantRole": "CUSTOMER", "BeginOffsetMillis": 1000, "EndOffsetMillis": 1400, "Content": "yes"}]},
    "google v1": {"results": [{"alternatives": [{"transcript": "so we", "words": [{k: v for k, v in w.items() if k != "speakerTag"} for w in _google]}]}, {"alternatives": [{"words": _google}]}]},
    "google v1 operation": {"name": "1", "done": True, "response": {"results": [{"alternatives": [{"words": _google}], "channelTag": 1}]}},
    "google v2": {"results": {"gs://b/a.wav": {"transcript": {"results": [{"alternatives": [{"words": [
        {"startOffset": f"{s:.3f}s", "endOffset": f"{e:.3f}s", "word": w, "speakerLabel": p} for w, s, e, p in WORDS]}]}]}}}},
    "google v1 protobuf": {"results": [{"alternatives": [{"words": [
        {"start_time": {"seconds": str(int(s)), "nanos": round(s % 1 * 1e9)}, "end_time": {"seconds": int(e), "nanos": round(e % 1 * 1e9)}, "word": w, "speaker_tag": "AB".index(p) + 1} for w, s, e, p in WORDS]}]}]},
    "azure batch": {"source": "x", "durationInTicks": 20_000_000, "combinedRecognizedPhrases": [], "recognizedPhrases": [
        {"recognitionStatus": "Success", "channel": 0, "speaker": n, "offset": "PT0.1S", "duration": "PT0.5S", "offsetInTicks": 1_000_000.0, "durationInTicks": 5_000_000.0,
         "nBest": [{"confidence": 0.9, "lexical": "x", "display": "x", "words": [{"word": w, "offset": f"PT{s}S", "duration": f"PT{e - s:.1f}S", "offsetInTicks": float(_ticks(s)), "durationInTicks": float(_ticks(e - s))} for w, s, e, _ in some]}]}
        for n, some in enumerate((WORDS[:2], WORDS[2:]), 1)]},
    "azure fast": {"durationMilliseconds": 2000, "combinedPhrases": [{"text": "so we yes"}], "phrases": [
        {"speaker": n, "offsetMilliseconds": _ms(some[0][1]), "durationMilliseconds": 500, "text": "x", "words": [{"text": w, "offsetMilliseconds": _ms(s), "durationMilliseconds": _ms(e - s)} for w, s, e, _ in some]}
        for n, some in enumerate((WORDS[:2], WORDS[2:]))]},
    "azure sdk": {"Id": "1", "RecognitionStatus": "Success", "DisplayText": "So we yes.", "Offset": 1_000_000, "Duration": 13_000_000, "NBest": [
        {"Confidence": 0.9, "Lexical": "so we yes", "Display": "So we yes.", "Words": [{"Word": w, "Offset": _ticks(s), "Duration": _ticks(e - s)} for w, s, e, _ in WORDS]}]},
    "assemblyai v2": {"id": "1", "status": "completed", "audio_url": "u", "audio_duration": 2, "words": _rows(word="text", start="start", end="end", who="speaker", scale=_ms)},
    "assemblyai v2 utterances": {"audio_url": "u", "audio_duration": 2, "utterances": [{"speaker": "A", "start": 100, "end": 600, "text": "so we", "words": _rows(word="text", start="start", end="end", scale=_ms)[:2]}, {"speaker": "B", "start": 1000, "end": 1400, "text": "yes", "words": []}]},
    "elevenlabs scribe": {"language_code": "en", "text": "so we yes", "words": [
        x for w, s, e, p in WORDS for x in ({"text": w, "start": s, "end": e, "type": "word", "speaker_id": f"speaker_{'AB'.index(p)}"}, {"text": " ", "start": e, "end": e, "type": "spacing"})]},
    "elevenlabs speech": {"audio_base64": "", "alignment": {"characters": list("so we yes"), "character_start_times_seconds": [0.1, 0.2, 0.3, 0.3, 0.45, 0.6, 1.0, 1.1, 1.2], "character_end_times_seconds": [0.2, 0.3, 0.3, 0.45, 0.6, 0.6, 1.1, 1.2, 1.4]}},
    "elevenlabs stream": {"alignment": {"chars": list("so we yes"), "charStartTimesMs": [100, 200, 300, 300, 450, 600, 1000, 1100, 1200], "charDurationsMs": [100, 100, 0, 150, 150, 0, 100, 100, 200]}},
    "whisper": {"text": "so we yes", "segments": [{"id": 0, "start": 0.1, "end": 1.4, "text": " so we yes", "words": [{"word": f" {w}", "start": s, "end": e, "probability": 0.9} for w, s, e, _ in WORDS]}], "language": "en"},
    "whisper api": {"task": "transcribe", "duration": 2.0, "text": "so we yes", "words": _rows(word="word", start="start", end="end"), "segments": [{"id": 0, "start": 0.1, "end": 1.4, "text": "so we yes"}]},
    "faster-whisper": [{"id": 1, "seek": 0, "start": 0.1, "end": 1.4, "text": " so we yes", "words": [{"start": s, "end": e, "word": f" {w}", "probability": 0.9} for w, s, e, _ in WORDS]}],
    "faster-whisper tuples": [{"id": 1, "start": 0.1, "end": 1.4, "text": " so we yes", "words": [[s, e, f" {w}", 0.9] for w, s, e, _ in WORDS]}],
    "whisperx": {"segments": [{"start": 0.1, "end": 0.6, "text": "so we", "speaker": "SPEAKER_00", "words": _rows(word="word", start="start", end="end")[:2]}, {"start": 1.0, "end": 1.4, "text": "yes", "speaker": "SPEAKER_01", "words": _rows(word="word", start="start", end="end")[2:]}], "word_segments": []},
    "whisper.cpp": {"systeminfo": "", "transcription": [{"timestamps": {"from": "00:00:00,100"}, "offsets": {"from": _ms(s), "to": _ms(e)}, "text": f" {w}"} for w, s, e, _ in WORDS]},
    "transformers": {"text": "so we yes", "chunks": [{"text": f" {w}", "timestamp": [s, e]} for w, s, e, _ in WORDS]},
    "vosk": {"result": [{"conf": 1.0, "start": s, "end": e, "word": w} for w, s, e, _ in WORDS], "text": "so we yes"},
    "gentle": {"transcript": "so we yes", "words": [{"alignedWord": w, "case": "success", "word": w, "start": s, "end": e, "startOffset": 0, "endOffset": 2, "phones": [{"duration": e - s, "phone": "s_B"}]} for w, s, e, _ in WORDS]},
    "speechmatics": {"format": "2.9", "metadata": {"type": "transcription"}, "results": [
        *({"type": "word", "start_time": s, "end_time": e, "alternatives": [{"content": w, "confidence": 0.9, "language": "en", "speaker": f"S{'AB'.index(p) + 1}"}]} for w, s, e, p in WORDS)]},
    "gladia": {"id": "1", "status": "done", "result": {"metadata": {}, "transcription": {"full_transcript": "so we yes", "utterances": [
        {"text": "x", "start": some[0][1], "end": some[-1][2], "speaker": n, "channel": 0, "words": [{"word": f" {w}", "start": s, "end": e, "confidence": 0.9} for w, s, e, _ in some]} for n, some in enumerate((WORDS[:2], WORDS[2:]))]}}},
    "cartesia": {"type": "timestamps", "context_id": "c", "word_timestamps": {"words": [w for w, *_ in WORDS], "start": [s for _, s, _, _ in WORDS], "end": [e for _, _, e, _ in WORDS]}},
    "youtube": {"wireMagic": "pb3", "events": [{"tStartMs": 0, "dDurationMs": 2000, "id": 1}, {"tStartMs": 100, "dDurationMs": 500, "segs": [{"utf8": "so"}, {"utf8": " we", "tOffsetMs": 200}]},
        {"tStartMs": 600, "dDurationMs": 400, "aAppend": 1, "segs": [{"utf8": "\n"}]}, {"tStartMs": 1000, "dDurationMs": 400, "segs": [{"utf8": "yes"}]}]},
    "nemo": {"text": "so we yes", "timestamp": {"word": [{"word": w, "start": s, "end": e, "start_offset": 1, "end_offset": 2} for w, s, e, _ in WORDS], "segment": []}},
    "mfa json": {"start": 0, "end": 2, "tiers": {"words": {"type": "interval", "entries": [[s, e, w] for w, s, e, _ in WORDS]}, "phones": {"type": "interval", "entries": [[0.1, 0.3, "S"]]}}},
}  # fmt: skip
_utf8 = {
    "kaldi ctm": ("a.ctm", "utt 1 0.10 0.20 so\nutt 1 0.30 0.30 we\nutt 1 1.00 0.40 yes\n"),
    "ttml": ("a.ttml", '<?xml version="1.0"?><tt xmlns="http://www.w3.org/ns/ttml" xmlns:ttm="http://www.w3.org/ns/ttml#metadata" xmlns:ttp="http://www.w3.org/ns/ttml#parameter" ttp:frameRate="10"><head><metadata><ttm:agent xml:id="a" type="person"><ttm:name type="full">Ann</ttm:name></ttm:agent><ttm:agent xml:id="b" type="person"><ttm:name type="full">Ben</ttm:name></ttm:agent></metadata></head><body begin="0.1s"><div><p ttm:agent="a" begin="0s" end="00:00:00:05"><span begin="0s">so </span><span begin="200ms">we</span></p><p ttm:agent="b" begin="9f" dur="0.4s">yes</p></div></body></tt>'),
    "substation": ("a.ass", "[Script Info]\nTitle: x\n\n[V4+ Styles]\nFormat: Name, Fontname\n\n[Events]\nFormat: Layer, Start, End, Style, Name, MarginL, MarginR, MarginV, Effect, Text\nDialogue: 0,0:00:01.00,0:00:01.40,Default,Ben,0,0,0,,{\\i1}yes{\\i0}\nComment: 0,0:00:01.50,0:00:01.60,Default,Ben,0,0,0,,no\nDialogue: 0,0:00:00.10,0:00:00.30,Default,Ann,0,0,0,,so\nDialogue: 0,0:00:00.30,0:00:00.60,Default,Ann,0,0,0,,we\n"),
    "sbv": ("a.sbv", "0:00:00.100,0:00:00.300\nso\n\n0:00:00.300,0:00:00.600\nwe\n\n0:00:01.000,0:00:01.400\nyes\n"),
    "lrc": ("a.lrc", "[ti:talk]\n[00:00.10]so\n[00:00.30]<00:00.30>we <00:00.60>\n[00:01.00]yes <00:01.40>\n"),
    "mfa csv": ("a.csv", "Begin,End,Label,Type,Speaker\n0.1,0.3,so,words,A\n0.3,0.6,we,words,A\n0.1,0.2,S,phones,A\n1.0,1.4,yes,words,B\n"),
    "whisper tsv": ("a.tsv", "start\tend\ttext\n100\t300\tso\n300\t600\twe\n1000\t1400\tyes\n"),
    "polly": ("a.marks", '{"time":100,"type":"word","start":0,"end":2,"value":"so"}\n{"time":300,"type":"word","start":3,"end":5,"value":"we"}\n{"time":300,"type":"viseme","value":"u"}\n{"time":1000,"type":"word","start":6,"end":9,"value":"yes"}\n{"time":1400,"type":"viseme","value":"sil"}\n'),
    "transcriber": ("a.trs", '<?xml version="1.0" encoding="ISO-8859-1"?><!DOCTYPE Trans SYSTEM "trans-14.dtd"><Trans version="1"><Speakers><Speaker id="spk1" name="Ann"/><Speaker id="spk2" name="Ben"/></Speakers><Episode><Section type="report" startTime="0" endTime="2"><Turn speaker="spk1" startTime="0.1" endTime="0.6"><Sync time="0.1"/>so<Sync time="0.3"/>we</Turn><Turn startTime="0.6" endTime="1.4" speaker="spk2"><Sync time="0.6"/><Sync time="1.0"/>yes <Event desc="rire" type="noise"/></Turn></Section></Episode></Trans>'),
    "exmaralda": ("a.exb", '<?xml version="1.0" encoding="UTF-8"?><basic-transcription><head><speakertable><speaker id="SPK0"><abbreviation>ANN</abbreviation></speaker><speaker id="SPK1"><abbreviation>BEN</abbreviation></speaker></speakertable></head><basic-body><common-timeline><tli id="T0" time="0.1"/><tli id="T1" time="0.3"/><tli id="T2" time="0.6"/><tli id="T3" time="1.0"/><tli id="T4" time="1.4"/></common-timeline><tier id="TIE0" speaker="SPK0" category="v" type="t"><event start="T0" end="T1">so </event><event start="T1" end="T2">we</event></tier><tier id="TIE1" speaker="SPK0" category="de" type="a"><event start="T0" end="T2">also wir</event></tier><tier id="TIE2" speaker="SPK1" category="v" type="t"><event start="T3" end="T4">yes</event></tier></basic-body></basic-transcription>'),
    "chat wor": ("a.cha", "@UTF8\n@Begin\n@Languages:\teng\n@Participants:\tANN Ann Adult, BEN Ben Adult\n@Media:\ttalk, audio\n*ANN:\tso [//] we . \x15100_600\x15\n%wor:\tso \x15100_300\x15 we \x15300_600\x15 .\n*BEN:\tyes &=laughs . \x151000_1400\x15\n@End\n"),
    "partitur": ("a.par", "LHD: Partitur 1.3\nSAM: 16000\nKAN: 0 s@U\nORT: 0 so\nORT: 1 we\nORT: 2 yes\nMAU: 0 1599 -1 <p:>\nMAU: 1600 1599 0 s\nMAU: 3200 1599 0 @U\nMAU: 4800 4799 1 wi:\nMAU: 9600 6399 -1 <p:>\nMAU: 16000 6399 2 jEs\n"),
    "webmaus": ("a.TextGrid", 'File type = "ooTextFile"\nObject class = "TextGrid"\n0\n2\n<exists>\n3\n"IntervalTier"\n"ORT-MAU"\n0\n2\n5\n0\n0.1\n""\n0.1\n0.3\n"so"\n0.3\n0.6\n"we"\n0.6\n1.0\n""\n1.0\n1.4\n"yes"\n"IntervalTier"\n"KAN-MAU"\n0\n2\n1\n0.1\n0.3\n"s@U"\n"IntervalTier"\n"MAU"\n0\n2\n2\n0.1\n0.2\n"s"\n0.2\n0.3\n"@U"\n'),
}  # fmt: skip


def made_transcripts() -> dict[str, tuple[str, str]]:
    """Return the files: kind -> name of the file, and its text."""
    return {
        **{name: ("a.json", json.dumps(data)) for name, data in JSON_TRANSCRIPTS.items()},
        **_utf8,
    }
