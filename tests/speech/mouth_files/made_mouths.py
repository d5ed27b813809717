"""A small file of each kind of mouth shapes, made by hand after its published description: kind -> name of the
file and its text. All open the mouth wide (aa) from 0.5 to 1.0 s and close the lips (PP) from 1.0 to 1.5 s.
"""

from __future__ import annotations

import json

_ORDER = ("sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "ih", "oh", "ou")


def _frames(rate: int) -> list[list[float]]:
    """Return 2 s of frames."""
    out = []
    for n in range(2 * rate):
        name = "aa" if 0.5 <= n / rate < 1 else "PP" if 1 <= n / rate < 1.5 else "sil"
        out.append([1.0 if one == name else 0.0 for one in _ORDER])
    return out


_CUES = [(0.0, 0.5, "X"), (0.5, 1.0, "D"), (1.0, 1.5, "A"), (1.5, 2.0, "X")]
_WORDS = [
    {
        "text": "ma",
        "start_frame": 12,
        "end_frame": 48,
        "phonemes": [
            {"text": "AI", "frame": 12},
            {"text": "MBP", "frame": 24},
            {"text": "rest", "frame": 36},
        ],
    }
]
_HEAD = ",".join(("time", *_ORDER))
MADE_MOUTHS: dict[str, tuple[str, str]] = {
    "rhubarb tsv": ("a.tsv", "".join(f"{s:.2f}\t{v}\n" for s, _, v in _CUES) + "2.00\tX\n"),
    "rhubarb json": ("a.json", json.dumps({"metadata": {"soundFile": "a.wav", "duration": 2.0}, "mouthCues": [{"start": s, "end": e, "value": v} for s, e, v in _CUES]})),
    "rhubarb xml": ("a.xml", '<?xml version="1.0" encoding="utf-8"?><rhubarbResult><metadata><duration>2.00</duration></metadata><mouthCues>' + "".join(f'<mouthCue start="{s:.2f}" end="{e:.2f}">{v}</mouthCue>' for s, e, v in _CUES) + "</mouthCues></rhubarbResult>"),
    "moho, rhubarb": ("a.dat", "MohoSwitch1\n1 X\n13 D\n25 A\n37 X\n49 X\n"),
    "moho, preston blair": ("a.dat", "MohoSwitch1\n1 rest\n13 AI\n25 MBP\n37 rest\n49 rest\n"),
    "papagayo": ("a.pgo", "lipsync version 1\na.wav\n24\n48\n2\n\tAnn\n\tma|\n\t1\n\t\tma\n\t\t12\n\t\t48\n\t\t1\n\t\t\tma 12 48 3\n\t\t\t\t12 AI\n\t\t\t\t24 MBP\n\t\t\t\t36 rest\n\tBen\n\tno|\n\t1\n\t\tno\n\t\t2\n\t\t48\n\t\t1\n\t\t\tno 2 48 1\n\t\t\t\t2 O\n"),
    "papagayo-ng": ("a.pg2", json.dumps({"version": 2, "fps": 24, "sound_duration": 48, "num_voices": 1, "voices": [{"name": "Ann", "phrases": [{"text": "ma", "words": _WORDS}]}]})),
    "polly": ("a.marks", "".join(json.dumps(x) + "\n" for x in [{"time": 0, "type": "sentence", "start": 0, "end": 2, "value": "ma"}, {"time": 400, "type": "word", "value": "ma"}, *({"time": t, "type": "viseme", "value": v} for t, v in ((0, "sil"), (500, "a"), (1000, "p"), (1500, "sil")))])),
    "azure ticks": ("a.json", json.dumps([{"audioOffset": round(t * 1e7), "visemeId": v} for t, v in ((0, 0), (0.5, 2), (1.0, 21), (1.5, 0))])),
    "azure milliseconds": ("a.json", json.dumps([{"AudioOffset": round(t * 1e3), "VisemeId": v} for t, v in ((0, 0), (0.5, 2), (1.0, 21), (1.5, 0))])),
    "oculus pairs": ("a.json", json.dumps([[0, "sil"], [0.5, "aa"], [1.0, "PP"], [1.5, "sil"]])),
    "oculus milliseconds": ("a.json", json.dumps({"visemes": [{"time": round(1000 * t), "viseme": v} for t, v in ((0, "sil"), (0.5, "aa"), (1.0, "PP"), (1.5, "sil"))]})),
    "arpabet table": ("a.txt", "0.0 0.5 SIL\n0.5 1.0 AA1\n1.0 1.5 B\n1.5 2.0 SIL\n"),
    "ipa table": ("a.txt", "start\tend\tphone\n0.5\t1.0\tɑ\n1.0\t1.5\tm\n"),
    "gentle": ("a.json", json.dumps({"words": [{"word": "am", "case": "success", "start": 0.5, "end": 1.5, "phones": [{"duration": 0.5, "phone": "aa_B"}, {"duration": 0.5, "phone": "m_E"}]}, {"word": "x", "case": "not-found-in-audio"}]})),
    "textgrid": ("a.TextGrid", '"ooTextFile"\n"TextGrid"\n0\n2\n<exists>\n1\n"IntervalTier"\n"phones"\n0\n2\n4\n0\n0.5\n""\n0.5\n1.0\n"AA1"\n1.0\n1.5\n"B"\n1.5\n2.0\n""\n'),
    "ovr csv": ("a.csv", _HEAD + "\n" + "".join(",".join(f"{x:g}" for x in (n / 50, *row)) + "\n" for n, row in enumerate(_frames(50)))),
    "ovr csv with semicolons": ("a.csv", _HEAD.replace(",", ";") + "\n" + "".join(";".join(f"{x:.2f}".replace(".", ",") for x in (n / 50, *row)) + "\n" for n, row in enumerate(_frames(50)))),
    "ovr csv without head": ("a.csv", "".join(",".join(f"{x:g}" for x in row) + "\n" for row in _frames(50))),
    "ovr json": ("a.json", json.dumps({"entries": [{"frameNumber": n, "Visemes": row, "laughterScore": 0} for n, row in enumerate(_frames(50))], "length": 2.0})),
    "ovr sequence": ("a.asset", "%YAML 1.1\n%TAG !u! tag:unity3d.com,2011:\n--- !u!114 &11400000\nMonoBehaviour:\n  entries:\n" + "".join(f"  - frameNumber: {n}\n    frameDelay: 0\n    Visemes:\n" + "".join(f"    - {x:g}\n" for x in row) + "    laughterScore: 0\n" for n, row in enumerate(_frames(50))) + "  length: 2\n"),
}  # fmt: skip
