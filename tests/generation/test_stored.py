"""The model's file: whole or not at all, and nothing else passes for one."""

from __future__ import annotations

import io
import pickle
import zipfile
from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from metagraph.errors import FileError
from metagraph.generation.sampler import generate_recording_poses
from metagraph.generation.stored import Model, TakeCard, read_card, read_model, write_model
from tests.generation.makers import tiny, untrained


@pytest.fixture(scope="module")
def kept(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("models") / "a.mgmodel"
    write_model(untrained(), path)
    return path


def _changed(kept: Path, path: Path, members=None, told=None, without=()) -> Path:
    """The file with members replaced or added, and fields of model.json changed."""
    with zipfile.ZipFile(kept) as old, zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as new:
        contents = {n: old.read(n) for n in old.namelist() if n not in without}
        if told:
            card = msgspec.json.decode(contents["model.json"])
            told(card)
            contents["model.json"] = msgspec.json.encode(card)
        for name, content in (contents | (members or {})).items():
            new.writestr(name, content)
    return path


def _npy(array) -> bytes:
    out = io.BytesIO()
    np.save(out, array)
    return out.getvalue()


@pytest.mark.parametrize("kind", ["flow-vae", "moglow", "cvae", "matching"])
def test_a_model_comes_back_to_the_bit(tmp_path, kind):
    model = untrained(kind)
    write_model(model, tmp_path / "m.mgmodel")
    back = read_model(tmp_path / "m.mgmodel")
    assert back.card == model.card == read_card(tmp_path / "m.mgmodel")
    assert list(back.weights) == list(model.weights)
    assert all((back.weights[n] == w).all() for n, w in model.weights.items())
    assert back.rig.skeleton == model.rig.skeleton
    assert back.rig.roles == model.rig.roles
    assert back.rig.lines == model.rig.lines


def test_a_model_of_the_first_format_moves_as_it_did(tmp_path):
    """Its pieces are given by their own tokens alone, and no file says so."""
    sizes = msgspec.structs.replace(tiny("matching"), around=0)
    model = untrained("matching", sizes=sizes)
    write_model(model, tmp_path / "new.mgmodel")

    def first(card):
        card["format"] = 1
        del card["sizes"]["around"]

    old = read_model(_changed(tmp_path / "new.mgmodel", tmp_path / "old.mgmodel", told=first))
    told = np.zeros((60, 31), np.float32)
    told[:, -1] = 1
    assert (
        generate_recording_poses(old, told, 3).tobytes() == generate_recording_poses(model, told, 3).tobytes()
    )
    assert (
        len(generate_recording_poses(old, told, 3))
        == len(generate_recording_poses(untrained("matching"), told, 3))
        == 60
    )


def test_what_is_told_of_a_model_comes_back(tmp_path):
    model = untrained()
    take = TakeCard(name="talk", sha256=("ab", "cd"), licence="MIT", seconds=7.5, mirrored=True)
    card = msgspec.structs.replace(
        model.card, takes=(take,), statistics={"role": 2.2}, hours=1.5, loss="paper"
    )
    write_model(Model(card, model.weights), tmp_path / "m.mgmodel")
    assert read_card(tmp_path / "m.mgmodel") == card


def test_written_twice_it_is_the_same_file(tmp_path, kept):
    write_model(untrained(), tmp_path / "b.mgmodel")
    assert (tmp_path / "b.mgmodel").read_bytes() == kept.read_bytes()


def test_weights_may_come_in_any_order_and_precision(tmp_path, kept):
    model = untrained()
    other = {n: w.astype(np.float64) for n, w in reversed(model.weights.items())}
    write_model(Model(model.card, other), tmp_path / "c.mgmodel")
    assert (tmp_path / "c.mgmodel").read_bytes() == kept.read_bytes()


def test_in_16_bits_it_is_smaller_and_nearly_the_same(tmp_path, kept):
    model = untrained()
    write_model(model, tmp_path / "h.mgmodel", half=True)
    assert (tmp_path / "h.mgmodel").stat().st_size < 0.7 * kept.stat().st_size
    back = read_model(tmp_path / "h.mgmodel")
    for n, w in model.weights.items():
        assert back.weights[n].dtype == np.float32
        assert np.abs(back.weights[n] - w).max() < 2e-3


@pytest.mark.nightly
@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(share=st.floats(0, 1, exclude_max=True), bit=st.integers(0, 7))
def test_a_flipped_bit_is_refused_or_changes_nothing(kept, tmp_path, share, bit):
    content = bytearray(kept.read_bytes())
    content[int(share * len(content))] ^= 1 << bit
    path = tmp_path / "flipped.mgmodel"
    path.write_bytes(content)
    try:
        back = read_model(path)
    except FileError as error:
        assert "flipped.mgmodel" in str(error)
        return
    whole = read_model(kept)  # a date, an attribute: nothing of what it says
    assert back.card == whole.card
    assert all((back.weights[n] == w).all() for n, w in whole.weights.items())


@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(share=st.floats(0, 1, exclude_max=True))
def test_a_cut_file_is_refused(kept, tmp_path, share):
    content = kept.read_bytes()
    path = tmp_path / "cut.mgmodel"
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(FileError, match=r"cut\.mgmodel"):
        read_model(path)


class _Trap:
    def __reduce__(self):
        return (Path("trapped").touch, ())


@pytest.mark.parametrize(
    ("content", "why"),
    [
        (pickle.dumps(_Trap()), "another size|no array"),
        (_npy(np.array([_Trap()], object)), "another size|16 or 32 bits"),
        (_npy(np.zeros((14, 16))), "64, not numbers of 16 or 32 bits|another size"),
        (_npy(np.zeros((16, 14), np.float32)), r"is \(16, 14\), expected \(14, 16\)"),
        (_npy(np.zeros((14, 16), np.float32, order="F")), "expected|holds"),
        (_npy(np.full((14, 16), np.inf, np.float32)), "not a number"),
        (_npy(np.zeros((14, 16), ">f4")), "not numbers of 16 or 32 bits"),
        (_npy(np.zeros((14, 16), np.int32)), "not numbers of 16 or 32 bits"),
        (_npy(np.zeros((14, 16), np.float32))[:-8], "more or fewer"),
        (b"\x93NUMPY\x01\x00\xff\xff" + b"(" * 200 + b"\0" * 200, "no array|another size"),
        (b"", "another size"),
    ],
)
def test_what_is_no_array_of_numbers_is_refused(kept, tmp_path, monkeypatch, content, why):
    monkeypatch.chdir(tmp_path)
    path = _changed(kept, tmp_path / "odd.mgmodel", {"weights/encode.2.weight.npy": content})
    with pytest.raises(FileError, match=why):
        read_model(path)
    assert not Path("trapped").exists()


def test_pickled_objects_are_never_made(kept, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    array = np.empty((14, 16), object)
    array.fill(_Trap())
    content = _npy(array)
    path = _changed(kept, tmp_path / "p.mgmodel", {"weights/encode.2.weight.npy": content[:1000]})
    with pytest.raises(FileError):
        read_model(path)
    assert not Path("trapped").exists()


def test_a_huge_shape_takes_no_memory(kept, tmp_path):
    head = str({"descr": "<f4", "fortran_order": False, "shape": (1 << 40,)}).encode().ljust(118) + b"\n"
    huge = b"\x93NUMPY\x01\x00" + len(head).to_bytes(2, "little") + head + bytes(14 * 16 * 4)
    with pytest.raises(FileError, match=r"\(1099511627776,\), expected"):
        read_model(_changed(kept, tmp_path / "huge.mgmodel", {"weights/encode.2.weight.npy": huge}))

    def grow(card):
        card["sizes"]["units"] = 8000

    with pytest.raises(FileError, match=r"MiB|another size"):
        read_model(_changed(kept, tmp_path / "grown.mgmodel", told=grow))


def test_a_bomb_is_not_unpacked(kept, tmp_path):
    path = _changed(kept, tmp_path / "bomb.mgmodel", {"weights/encode.2.weight.npy": bytes(80 << 20)})
    with pytest.raises(FileError, match="another size"):
        read_model(path)
    path = _changed(kept, tmp_path / "words.mgmodel", {"model.json": b"[" * (17 << 20)})
    with pytest.raises(FileError, match="larger than any"):
        read_model(path)


@pytest.mark.parametrize(
    "name", ["../evil.npy", "/etc/passwd", "weights/../../x.npy", "weights/more.npy", "a/"]
)
def test_other_members_are_refused(kept, tmp_path, name):
    with pytest.raises(FileError, match="holds what no model has"):
        read_model(_changed(kept, tmp_path / "more.mgmodel", {name: b"x"}))
    assert sorted(p.name for p in tmp_path.iterdir()) == ["more.mgmodel"]


def test_a_missing_weight_and_a_missing_card_are_told(kept, tmp_path):
    with pytest.raises(FileError, match=r"'encode\.0\.bias'"):
        read_model(_changed(kept, tmp_path / "x.mgmodel", without=("weights/encode.0.bias.npy",)))
    with pytest.raises(FileError, match=r"holds no model\.json"):
        read_model(_changed(kept, tmp_path / "y.mgmodel", without=("model.json",)))
    with pytest.raises(FileError, match="No such file"):
        read_model(tmp_path / "nowhere.mgmodel")
    with pytest.raises(FileError):
        read_model(tmp_path)
    (tmp_path / "z.mgmodel").write_bytes(b"PK nothing")
    with pytest.raises(FileError, match="damaged, or no model"):
        read_model(tmp_path / "z.mgmodel")


@pytest.mark.parametrize(
    ("field", "value", "why"),
    [
        ("format", 5, "has format 5, this version reads 4.*newer version"),
        ("kind", "gan", "Invalid enum"),
        ("fps", 30.0, "25 are made"),
        ("tracks", 2, "it hears 27 numbers a frame, 54"),
        ("pose_mean", [0.0], "expected 78 finite"),
        ("pose_deviation", [0.0] * 78, "more than 0"),
        ("audio_mean", ["x"] * 27, "float"),
        ("surprise", 1, "unknown field"),
    ],
)
def test_a_card_that_does_not_fit_is_told(kept, tmp_path, field, value, why):
    with pytest.raises(FileError, match=why):
        read_model(_changed(kept, tmp_path / "c.mgmodel", told=lambda card: card.update({field: value})))


def test_a_skeleton_that_is_none_is_told(kept, tmp_path):
    for n, change in enumerate(
        (
            lambda s: s["parents"].reverse(),
            lambda s: s["names"].pop(),
            lambda s: s["roles"].update(head=999),
            lambda s: s["roles"].pop("head"),
            lambda s: s.update(fingerprint="0"),
            lambda s: s["base"].pop(),
        )
    ):
        path = _changed(kept, tmp_path / f"{n}.mgmodel", told=lambda card, c=change: c(card["skeleton"]))
        with pytest.raises(FileError):
            read_model(path)


def test_what_no_reader_would_accept_is_not_written(tmp_path):
    model = untrained()
    path = tmp_path / "m.mgmodel"
    path.write_bytes(b"the old one")
    broken = dict(model.weights)
    broken["encode.0.bias"] = np.full_like(broken["encode.0.bias"], np.nan)
    for weights in (broken, {}, dict(list(model.weights.items())[:-1])):
        with pytest.raises(FileError, match="cannot be kept"):
            write_model(Model(model.card, weights), path)
    far = dict(model.weights)
    far["encode.0.bias"] = np.full_like(far["encode.0.bias"], 1e6)
    with pytest.raises(FileError, match="too large for 16 bits"):
        write_model(Model(model.card, far), path, half=True)
    assert path.read_bytes() == b"the old one"
    assert [p.name for p in tmp_path.iterdir()] == ["m.mgmodel"]
