"""Every reader, with sound files to begin from and the words that matter in them.

python -m tests.fuzz.readers all|READER,READER... [COUNT] [SEED] reads COUNT (1,000,000) broken files a reader and says
what went wrong with which; nights are meant for it. Each input that was found is kept among `KEPT`, or as a
file in tests/fuzz/kept/READER.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import random
import struct
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from metagraph.common import files
from metagraph.errors import FileError
from metagraph.formats.fbx import processes as fbx_readers
from tests.formats.props.three_mf_file import write_box
from tests.fuzz.seed_files import BML, ascii_fbx, model_file, spoilt_archive
from tests.fuzz.spoiling import JSON, NUMBERS, XML, spoilt_glb, spoilt_json, spoilt_words

ROOT = Path(__file__).resolve().parents[2]
KEPT = Path(__file__).with_name("kept")
SAMPLES = ROOT / "sample_clips"


@dataclass(frozen=True)
class Fuzzed:
    """A reader. read: of a path. endings: of the files it is given. seeds: sound files' bytes by name. words:
    what is put into their midst. structured: makes a broken file by knowing what it is made of.
    """

    read: Callable[[Path], object]
    seeds: Callable[[], dict[str, bytes]]
    words: tuple[bytes, ...] = ()
    structured: Callable[[random.Random, bytes], bytes] | None = None


def mutated(chance: random.Random, seeds: list[bytes], one: Fuzzed) -> bytes:
    """Return a broken file."""
    data = chance.choice(seeds)
    if one.structured is not None and chance.random() < 0.6:
        data = one.structured(chance, data)
        if chance.random() < 0.7:
            return data
    out = bytearray(data)
    for _ in range(chance.choice((1, 1, 2, 8))):
        at = chance.randrange(len(out) + 1)
        match chance.randrange(6):
            case 0:
                out[at : at + 1] = chance.randbytes(1)
            case 1:
                del out[at : at + chance.choice((1, 4, 30, 400))]
            case 2:
                out[at:at] = chance.choice((*one.words, *NUMBERS))
            case 3:
                out[at:at] = out[chance.randrange(len(out) + 1) :][: chance.choice((4, 60, 500))]
            case 4:
                out = out[: max(1, at)]
            case _:
                out[at : at + 4] = struct.pack("<I", chance.choice((0, 1, 0xFFFFFFFF, 0x7FFFFFFF, 1 << 24)))
    return bytes(out)


# --- the readers

_LIVE_LINK = b"Timecode,BlendShapeCount,JawOpen,EyeLookOutLeft,HeadYaw,LeftEyeYaw\r\n" + b"".join(
    b"12:00:%02d:%02d.5,61,0.5,0.%d,-0.1,0.2\r\n" % (n // 60, n % 60, n % 10) for n in range(150)
)


def _clip_seeds(ending: str) -> Callable[[], dict[str, bytes]]:
    def make() -> dict[str, bytes]:
        from metagraph.formats.bvh.file import write_bvh
        from metagraph.formats.gltf.reader import write_glb
        from tests.fuzz.test_clip_files import sample

        clip, character = sample()
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"a{ending}"
            if ending == ".bvh":
                write_bvh(clip, path)
            else:
                write_glb(path, [clip], character)
            return {path.name: path.read_bytes()}

    return make


def _fixed(**seeds: bytes) -> Callable[[], dict[str, bytes]]:
    return lambda: {name.replace("_", "."): data for name, data in seeds.items()}


def _talks() -> dict[str, bytes]:
    from metagraph.formats.conversations.writers import write_elan, write_json, write_textgrid
    from tests.fuzz import test_transcripts as talks

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_elan(talks.TALK, folder / "a.eaf")
        write_textgrid(talks.TALK, folder / "a.TextGrid")
        write_json(talks.TALK, folder / "a.json")
        made = {p.name: p.read_bytes() for p in folder.iterdir()}
    return {**{f"a{k}": v.encode() for k, v in talks.SEEDS.items()}, **made}


def _only(*endings: str) -> Callable[[], dict[str, bytes]]:
    return lambda: {n: d for n, d in _talks().items() if Path(n).suffix in endings}


def _services(*endings: str) -> Callable[[], dict[str, bytes]]:
    from tests.formats.transcripts.made_transcripts import made_transcripts

    files = {f"{n}{Path(name).suffix}": text for n, (name, text) in enumerate(made_transcripts().values())}
    return lambda: {n: text.encode() for n, text in files.items() if Path(n).suffix in endings}


def _faces() -> dict[str, bytes]:
    from tests.formats.test_face_exports import audio2face, azure, table

    found = {"a.csv": table(), "b.json": json.dumps(audio2face()), "c.json": json.dumps(azure())}
    return {name: text.encode() for name, text in found.items()}


def _smpl() -> dict[str, bytes]:
    from tests.formats.test_smpl import amass

    with tempfile.TemporaryDirectory() as folder:
        return {"a.npz": amass(Path(folder) / "a.npz", 24).read_bytes()}


def _acclaim() -> dict[str, bytes]:
    from tests.formats.test_acclaim import amc, asf

    return {"a.amc": amc().encode(), "b.asf": asf().encode()}


def _mouths(json_files: bool) -> Callable[[], dict[str, bytes]]:
    from tests.speech.mouth_files.made_mouths import MADE_MOUTHS

    files = {f"{n}{Path(name).suffix}": text.encode() for n, (name, text) in enumerate(MADE_MOUTHS.values())}
    return lambda: {
        n: text for n, text in files.items() if (Path(n).suffix in (".json", ".pg2")) == json_files
    }


def _wav() -> dict[str, bytes]:
    import io

    import numpy as np
    import soundfile

    sound = 0.3 * np.sin(np.arange(1600) * 0.2) * np.hanning(1600)
    out = {}
    for name, kind, subtype in (
        ("a.wav", "WAV", "PCM_16"),
        ("f.wav", "WAV", "FLOAT"),
        ("a.flac", "FLAC", "PCM_16"),
        ("a.ogg", "OGG", "VORBIS"),
    ):
        content = io.BytesIO()
        soundfile.write(content, np.stack([sound, 0.5 * sound], 1), 16000, format=kind, subtype=subtype)
        out[name] = content.getvalue()
    return out


def _project() -> dict[str, bytes]:
    from metagraph.formats.project.data import to_data
    from metagraph.formats.project.text import to_text
    from tests.conftest import Toy

    return {"a.metagraph.yaml": to_text(to_data(Toy().project())).encode()}


def _export() -> dict[str, bytes]:
    from metagraph.engines.export import export_project
    from tests.conftest import Toy

    with tempfile.TemporaryDirectory() as name:
        return {"a.json": export_project(Toy().project(), name).json.read_bytes()}


def _journal() -> dict[str, bytes]:
    from dataclasses import replace

    from metagraph.formats.project.journal import Journal
    from tests.conftest import Toy

    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "j"
        journal, project = Journal(path, None), Toy().project()
        journal.begin(project, 1)
        journal.edit(project, replace(project, name="other"), "Rename")
        journal.close()
        return {"a.journal": path.read_bytes()}


def _log() -> dict[str, bytes]:
    from metagraph.research.study.logs.log import Writer

    with tempfile.TemporaryDirectory() as name:
        log = Writer(Path(name) / "log.jsonl")
        log.begin(participant="p1")
        log.add("edit", what="x")
        log.close()
        return {"log.jsonl": log.path.read_bytes()}


def _answers() -> dict[str, bytes]:
    events = [
        {"n": 0, "type": "begin", "at": "2026-01-01T00:00:00.000Z", "mono": 0.5, "agent": "x"},
        {"n": 1, "type": "answer", "trial": "a1", "value": "left", "seconds": 1.5, "watched": [6.0, 6.0]},
        {"n": 2, "type": "answer", "trial": "a2", "value": {"natural": 4}, "first": 2.5, "replays": 1},
        {"n": 3, "type": "end"},
    ]
    whole = {"perceive": 1, "design": "0" * 64, "code": "P01", "run": "0123456789ab", "events": events}
    return {"a.json": json.dumps(whole).encode()}


def _perceive() -> dict[str, bytes]:
    from tests.research.study.perceive.perceive_makers import CHOICE, RATING, text

    more = "compare: [[all, deaf]]\nchecks: {told: 2, same: 1}\nvideo: {width: 64}\n"
    return {"perceive.yaml": text(asked=CHOICE + RATING, more=more).encode()}


def _keypoints() -> dict[str, bytes]:
    rows = [{"t": n / 30, "keypoints": [[100 + k, 50 + 9 * k + n, 0.9] for k in range(17)]} for n in range(3)]
    people = {"frames": [{"people": [{"pose_keypoints_2d": [1.0, 2.0, 0.5] * 25}]}] * 2, "fps": 30}
    one = {
        "keypoints": [[100 + k, 50 + 9 * k] for k in range(17)],
        "keypoint_scores": [0.9] * 17,
        "bbox": [[0, 0, 9, 9]],
    }
    mmpose = {
        "meta_info": {"dataset_name": "h36m"},
        "instance_info": [{"frame_id": n, "instances": [one]} for n in range(2)],
    }
    old = {
        "frames": [
            {"people": [{"pose_keypoints": [1.0, 2.0, 0.5] * 18}]},
            {"bodies": [{"joints": [1.0, 2.0, 0.5] * 18}]},
        ]
    }
    found = {"a.json": rows, "b.json": people, "c.json": mmpose, "d.json": old, "e.json": [one, one]}
    return {name: json.dumps(data).encode() for name, data in found.items()}


def _markers() -> dict[str, bytes]:
    from metagraph.formats.clips import read_clips
    from tests.formats.markers.made_markers import joint_markers, skin_markers, write_c3d, write_trc

    clip = read_clips(min(SAMPLES.glob("clips/*.glb")))[0]
    few = {name: places[:6] for name, places in skin_markers(clip).items()}
    joints = {name: places[:6] for name, places in joint_markers(clip).items()}
    return {"a.trc": write_trc(few, 60), "b.trc": write_trc(joints, 60, "m"), "c.c3d": write_c3d(few, 60)}


def _props() -> dict[str, bytes]:
    import trimesh

    box, out = trimesh.creation.box(), {}
    box.visual.face_colors = [[n * 20, 9, 9, 255] for n in range(12)]
    for ending in ("obj", "stl", "ply", "off"):
        data = box.export(file_type=ending)
        out[f"a.{ending}"] = data.encode() if isinstance(data, str) else data
    return {**out, "a.3mf": write_box(box), "b.glb": (SAMPLES / "props" / "cup.glb").read_bytes()}


def every_reader() -> dict[str, Fuzzed]:
    from app.features.lines.line_files import read_lines
    from app.project.pattern_files import read_patterns
    from metagraph.common.pictures import read_picture_size
    from metagraph.engines.reading import read_export
    from metagraph.formats.clips import read_clips
    from metagraph.formats.elan import read_elan
    from metagraph.formats.fbx.reader import read_fbx_clips
    from metagraph.formats.gltf.reader import (
        has_skinned_mesh,
        read_character,
        read_morph_targets,
        read_vrm_roles,
    )
    from metagraph.formats.keypoints.reader import read_keypoints
    from metagraph.formats.language_files import read_pack
    from metagraph.formats.live_link_face import read_live_link
    from metagraph.formats.props.reader import read_prop
    from metagraph.formats.recovery import read_journal
    from metagraph.formats.store import read_project
    from metagraph.formats.transcripts.reader import read_transcript
    from metagraph.generation.stored import read_card, read_model
    from metagraph.graph.requests import RequestError
    from metagraph.live.osc_bytes import OscError, pad_osc, read_osc_messages
    from metagraph.playback.bml.reader import read_bml
    from metagraph.research.study.logs.log import read_log as read_log
    from metagraph.research.study.perceive.answers import read_answers
    from metagraph.research.study.perceive.perceive_plan import read_perceive_plan
    from metagraph.research.study.study_plan import read_study
    from metagraph.speech.lines import make_voice_from_phones, read_line_voice
    from metagraph.speech.mouth_files.registry import read_mouth_file

    def drawn(path: Path) -> None:
        for read in (read_character, read_vrm_roles, read_morph_targets, has_skinned_mesh):
            survives(read, path)

    def acclaim(path: Path) -> None:
        """Read a broken motion on a sound skeleton, or a sound motion on a broken one."""
        whole = _acclaim()
        for other in (path.with_suffix(".asf"), path.with_suffix(".amc")):
            if other != path:
                other.write_bytes(whole["a.amc" if other.suffix == ".amc" else "b.asf"])
        read_clips(path.with_suffix(".amc"))

    def listed(path: Path) -> None:
        read_lines([path], path.parent)

    def osc(path: Path) -> None:
        try:
            list(read_osc_messages(path.read_bytes()))
        except OscError as error:
            assert str(error).isascii() and str(error).isprintable()

    def picture(path: Path) -> None:
        size = read_picture_size(path.read_bytes())
        assert size is None or min(size) > 0

    def bml(path: Path) -> None:
        with contextlib.suppress(RequestError):
            read_bml(path.read_text(errors="replace"))

    def model(path: Path) -> None:
        survives(read_card, path)
        read_model(path)

    def message(path: Path) -> None:
        from metagraph.live.messages import read_live_request, split_message

        try:
            for request in split_message(path.read_bytes())[0]:
                read_live_request(request)
        except RequestError:
            pass

    bvh = (
        b"{",
        b"}",
        b"ROOT",
        b"JOINT",
        b"End Site",
        b"OFFSET",
        b"CHANNELS",
        b"MOTION",
        b"Frames:",
        b"Xrotation",
    )
    study = SAMPLES / "study" / "study.yaml"
    note = (
        pad_osc("/metagraph/gesture")
        + pad_osc(",sfb")
        + pad_osc("beat")
        + struct.pack(">f", 1)
        + b"\0\0\0\4abcd"
    )
    bundle = b"#bundle\0" + bytes(8) + struct.pack(">I", len(note)) + note
    return {
        "model": Fuzzed(model, model_file, (b"PK", b"NUMPY"), spoilt_archive),
        "bml": Fuzzed(bml, _fixed(a_xml=BML), XML, spoilt_words),
        "fbx": Fuzzed(read_fbx_clips, _fixed(a_fbx=ascii_fbx()), (b"{", b"}", b"*9", b"Model:", b'"'), spoilt_words),
        "bvh": Fuzzed(read_clips, _clip_seeds(".bvh"), bvh, spoilt_words),
        "live link": Fuzzed(read_live_link, _fixed(a_csv=_LIVE_LINK), (b",", b"\n", b"12:00:00:01", b";", b"nan", b"-"), spoilt_words),
        "faces": Fuzzed(read_clips, _faces, JSON, spoilt_words),
        "smpl": Fuzzed(read_clips, _smpl, (b"PK", b"NUMPY", b"poses.npy", b"<f8"), spoilt_archive),
        "markers": Fuzzed(read_clips, _markers, (b"\t", b"\n", b"nan", b"1e300", b"LASI", b"POINT", b"\xff\xff"), spoilt_words),
        "acclaim": Fuzzed(acclaim, _acclaim, (b":bonedata", b"begin", b"dof rx", b"root", b"length"), spoilt_words),
        "props": Fuzzed(read_prop, _props, (b"f ", b"v ", b"element face", b"nan", b"\xff\xff", b"JSON"), spoilt_words),
        "gltf": Fuzzed(read_clips, _clip_seeds(".glb"), JSON, spoilt_glb),
        "character": Fuzzed(drawn, _clip_seeds(".glb"), JSON, spoilt_glb),
        "textgrid": Fuzzed(make_voice_from_phones, _only(".TextGrid"), (b'"', b"<exists>", b"IntervalTier"), spoilt_words),
        "elan": Fuzzed(read_elan, _only(".eaf"), XML, spoilt_words),
        "subtitles": Fuzzed(read_transcript, _only(".vtt", ".srt", ".ctm", ".tsv"), (b" --> ", b"<v Ann>", b"WEBVTT"), spoilt_words),
        "transcript": Fuzzed(read_transcript, _only(".json", ".whisper", ".ibm"), JSON, spoilt_json),
        "services": Fuzzed(read_transcript, _services(".json"), JSON, spoilt_json),
        "transcribers": Fuzzed(read_transcript, _services(".trs", ".exb", ".cha", ".par", ".csv", ".tsv", ".ctm", ".marks", ".ttml", ".ass", ".sbv", ".lrc"), XML, spoilt_words),
        "mouths": Fuzzed(read_mouth_file, _mouths(False), XML, spoilt_words),
        "mouth lists": Fuzzed(read_mouth_file, _mouths(True), JSON, spoilt_json),
        "words": Fuzzed(read_pack, _fixed(sv_yaml=b"code: sv\nname: x\nresponses: [ja, 'n\xc3\xa5']\nsmall: i, den\n"), (b"&a", b"{", b"- ", b", "), spoilt_words),
        "sound": Fuzzed(read_line_voice, _wav, (b"RIFF", b"fmt ", b"data", b"OggS", b"fLaC"), None),
        "keypoints": Fuzzed(read_keypoints, _keypoints, JSON, spoilt_json),
        "project": Fuzzed(read_project, _project, (b"&a", b"*a", b"!!x", b"{", b"[", b"- ", b"? "), spoilt_words),
        "journal": Fuzzed(lambda path: read_journal(path, None), _journal, JSON, None),
        "export": Fuzzed(lambda path: read_export(path, motions=False), _export, JSON, spoilt_json),
        "log": Fuzzed(read_log, _log, JSON, None),
        "study": Fuzzed(read_study, lambda: {"study.yaml": study.read_bytes()} if study.is_file() else {"study.yaml": b"study: 1\n"}, (b"&a", b"{", b"- "), spoilt_words),
        "answers": Fuzzed(read_answers, _answers, JSON, spoilt_json),
        "perceive": Fuzzed(read_perceive_plan, _perceive, (b"&a", b"{", b"- ", b"{item}"), spoilt_words),
        "lines": Fuzzed(listed, _fixed(a_csv=b"id,text\nl1,Hello\nl2,\"Well, no\"\n"), (b'"', b",", b"\0", b";", b"\t"), spoilt_words),
        "patterns": Fuzzed(read_patterns, _fixed(a_json=b'{"words":{"beat":["x"]},"patterns":[]}'), JSON, None),
        "osc": Fuzzed(osc, _fixed(a_osc=note, b_osc=bundle), (b",", b"[", b"]", b"#bundle\0"), None),
        "message": Fuzzed(message, _fixed(a_json=b'[{"do":"gesture","tags":["beat"],"in":1.5},{"do":"look","to":[0,1,2]}]'), JSON, spoilt_json),
        "picture": Fuzzed(picture, _fixed(a_png=b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1" + bytes(9), b_jpg=b"\xff\xd8\xff\xe0\0\4ab\xff\xc0\0\x0b\x08\0\1\0\1\1\1\x11\0" + bytes(9)), (b"\xff\xc0", b"IHDR"), None),
    }  # fmt: skip


def survives(read: Callable[[Path], object], path: Path) -> None:
    """Run a reader; it may only succeed or raise a FileError that helps."""
    try:
        read(path)
    except FileError as error:
        assert error.cause and error.remedy, repr(error)
        assert str(error).isprintable() and len(str(error)) < 2000, repr(str(error))


def fuzz(name: str, count: int, seed: int, folder: Path) -> Iterator[tuple[bytes, str]]:
    """Yield each of `count` broken files that a reader tripped over, and how."""
    one = every_reader()[name]
    seeds = one.seeds()
    chance = random.Random(f"{name} {seed}")
    for n in range(count):
        ending = chance.choice(list(seeds))
        data = mutated(chance, [seeds[ending]], one)
        path = folder / f"fuzz{''.join(Path(ending).suffixes[-2:])}"
        path.write_bytes(data)
        begin = time.perf_counter()
        try:
            survives(one.read, path)
        except Exception:
            yield data, traceback.format_exc(limit=-4)
        if time.perf_counter() - begin > 10:
            yield data, f"it took {time.perf_counter() - begin:.0f} s (input {n})"


def main(names: str, count: int = 1_000_000, seed: int = 0) -> int:
    """Fuzz a reader, or all; keep what is found. Returns how many inputs were."""
    files.strict = True
    warnings.simplefilter("error")
    found = 0
    for name in every_reader() if names == "all" else names.split(","):
        begin, own, seen = time.perf_counter(), 0, set[str]()
        with tempfile.TemporaryDirectory() as folder, fbx_readers.batch():
            for data, why in fuzz(name, count, seed, Path(folder)):
                own += 1
                key = why.strip().splitlines()[-1][:80] + "".join(why.splitlines()[-3:-1])
                if key not in seen:
                    seen.add(key)
                    place = KEPT / name / hashlib.sha256(data).hexdigest()[:12]
                    place.parent.mkdir(parents=True, exist_ok=True)
                    place.write_bytes(data)
                    print(f"{name}: kept as {place.relative_to(ROOT)}\n{why}", flush=True)
        found += own
        print(f"{name}: {count:,} inputs, {own} found, {time.perf_counter() - begin:.0f} s", flush=True)
    return found


if __name__ == "__main__":
    sys.exit(bool(main(sys.argv[1], *map(int, sys.argv[2:4]))))
