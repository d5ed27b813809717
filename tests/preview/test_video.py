"""MP4 files."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from metagraph.errors import FileError
from preview.video import Cancelled, write_video


def frames(count, size=(48, 64), value=None):
    for i in range(count):
        yield np.full((*size, 4), 20 * i % 255 if value is None else value, np.uint8)


def decoded(path):
    import av

    with av.open(str(path)) as container:
        return [f.to_ndarray(format="rgb24") for f in container.decode(video=0)], float(
            container.streams.video[0].average_rate
        )


def test_every_frame_comes_back_at_its_rate_and_brightness(tmp_path):
    told = []
    assert write_video(tmp_path / "a.mp4", frames(9, value=180), 29.97, progress=told.append) == 9
    pictures, fps = decoded(tmp_path / "a.mp4")
    assert len(pictures) == 9 and told == list(range(1, 10))
    assert fps == pytest.approx(29.97, abs=0.01)
    assert pictures[4].shape == (48, 64, 3)
    assert abs(int(pictures[4].mean()) - 180) < 6


def test_one_frame_of_odd_size_becomes_even(tmp_path):
    write_video(tmp_path / "a.mp4", frames(1, (33, 51)), 30)
    assert decoded(tmp_path / "a.mp4")[0][0].shape == (34, 52, 3)


def test_a_size_can_be_asked_for(tmp_path):
    write_video(tmp_path / "a.mp4", frames(3), 30, size=(32, 24))
    assert decoded(tmp_path / "a.mp4")[0][0].shape == (24, 32, 3)


def test_no_frames_are_refused_and_leave_no_file(tmp_path):
    with pytest.raises(FileError, match="no frames"):
        write_video(tmp_path / "a.mp4", [], 30)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("fps", [0, -1, float("nan")])
def test_an_impossible_rate_is_refused(tmp_path, fps):
    with pytest.raises(FileError, match="frame rate"):
        write_video(tmp_path / "a.mp4", frames(1), fps)


def test_cancelling_leaves_no_file(tmp_path):
    with pytest.raises(Cancelled):
        write_video(tmp_path / "a.mp4", frames(50), 30, cancelled=lambda: True)
    assert list(tmp_path.iterdir()) == []


def test_a_failed_frame_leaves_the_old_file_alone(tmp_path):
    path = tmp_path / "a.mp4"
    path.write_bytes(b"old")

    def broken():
        yield from frames(2)
        raise RuntimeError("drawing failed")

    with pytest.raises(RuntimeError):
        write_video(path, broken(), 30)
    assert path.read_bytes() == b"old"
    assert len(list(tmp_path.iterdir())) == 1


def test_a_picture_is_encoded_while_the_next_is_drawn_and_told_of_in_its_order(tmp_path):
    at_work, told = set(), []

    def drawn():
        for picture in frames(6):
            at_work.add(threading.get_ident())
            yield picture
            picture[:] = 255  # whoever draws may draw into the same memory again

    write_video(tmp_path / "a.mp4", drawn(), 30, progress=lambda n: told.append((n, threading.get_ident())))
    assert told == [(n, threading.get_ident()) for n in range(1, 7)] and at_work == {threading.get_ident()}
    assert [round(float(p.mean()) / 20) for p in decoded(tmp_path / "a.mp4")[0]] == list(range(6))


def test_a_failing_encoder_is_told_and_leaves_nothing(tmp_path, monkeypatch):
    import av

    class Full:
        """A file on a full disk."""

        def __init__(self, *words, **more):
            self.file = real(*words, **more)

        def __enter__(self):
            return self

        def __exit__(self, *error):
            self.file.close()

        def add_stream(self, *words, **more):
            return self.file.add_stream(*words, **more)

        def mux(self, packet):
            raise OSError(28, "No space left on device")

    real = av.open
    monkeypatch.setattr(av, "open", Full)
    with pytest.raises(FileError, match="No space left"):
        write_video(tmp_path / "a.mp4", frames(80), 30)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_not_there_is_named(tmp_path):
    with pytest.raises(FileError, match="folder"):
        write_video(tmp_path / "none" / "a.mp4", frames(2), 30)


# --- with sound


def heard(path):
    import av

    with av.open(str(path)) as container:
        stream = container.streams.audio[0]
        return np.concatenate([f.to_ndarray()[0] for f in container.decode(stream)]), stream.rate


def test_a_video_has_its_sound_where_it_belongs(tmp_path):
    rate = 44100
    sound = np.zeros(rate, np.float32)
    sound[rate // 2 : rate // 2 + 4410] = 0.5 * np.sin(2 * np.pi * 440 * np.arange(4410) / rate)
    write_video(tmp_path / "a.mp4", frames(30), 30, sound=(sound, rate))
    samples, found = heard(tmp_path / "a.mp4")
    assert found == rate and len(decoded(tmp_path / "a.mp4")[0]) == 30
    loud = np.flatnonzero(np.abs(samples) > 0.2) / rate
    assert loud.min() == pytest.approx(0.5, abs=0.06) and loud.max() == pytest.approx(0.6, abs=0.06)


@pytest.mark.parametrize("seconds", [0.0, 0.3, 5.0])
def test_sound_is_as_long_as_the_pictures(tmp_path, seconds):
    write_video(
        tmp_path / "a.mp4", frames(30), 30, sound=(np.full(round(seconds * 22050), 0.1, np.float32), 22050)
    )
    samples, rate = heard(tmp_path / "a.mp4")
    assert len(samples) / rate == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize(("ending", "decoder"), [(".mov", "prores"), (".webm", "libvpx-vp9")])
def test_videos_for_editing_and_for_the_web_keep_alpha_and_sound(tmp_path, ending, decoder):
    import av

    picture = np.zeros((64, 96, 4), np.uint8)
    picture[:, 48:] = (200, 100, 50, 255)
    path = tmp_path / f"a{ending}"
    write_video(path, [picture] * 6, 30, sound=(np.zeros(8820, np.float32), 44100))
    assert [one.name for one in tmp_path.iterdir()] == [path.name]
    with av.open(str(path)) as container:
        assert [stream.type for stream in container.streams] == ["video", "audio"]
        reader = av.codec.CodecContext.create(decoder, "r")
        packets = container.demux(container.streams.video[0])
        found = [f.to_ndarray(format="rgba").astype(int) for p in packets for f in reader.decode(p)]
    assert len(found) == 6
    assert found[3][32, 10, 3] < 5 and found[3][32, 80, 3] > 250
    assert np.abs(found[3][32, 80, :3] - (200, 100, 50)).max() < 16
