"""Locks: one window has a project file; what a crash left is taken over, what lives is not, wherever it
runs.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import msgspec
import pytest

from metagraph.formats import locking
from metagraph.formats.locking import STALE, Lock, Owner, find_holder, is_gone, lock_path, make_owner

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    path = tmp_path / "show.metagraph.yaml"
    path.write_text("metagraph: 1\n")
    return path


def elsewhere(**more: object) -> Owner:
    return msgspec.structs.replace(make_owner(), host="another", user="ada", **more)


def write(saved: Path, owner: Owner | bytes, age: float = 0.0) -> None:
    """Leave a lock as another computer would have."""
    path = lock_path(saved)
    path.write_bytes(owner if isinstance(owner, bytes) else msgspec.json.encode(owner))
    os.utime(path, (time.time() - age, time.time() - age))


def ended() -> int:
    """The number of a process that is over."""
    child = subprocess.Popen([sys.executable, "-c", ""])
    child.wait()
    return child.pid


def test_the_first_has_it_and_the_second_is_told_who(saved: Path) -> None:
    one, two = Lock(saved, make_owner()), Lock(saved, make_owner())
    assert one.acquire() is None and one.held
    found = two.acquire()
    assert found is not None and not two.held
    assert found.owner == one.owner and not found.gone
    assert two.acquire(take_over=True) is not None, "what lives is not taken over, whoever asks"
    one.release()
    assert not lock_path(saved).exists()
    assert two.acquire() is None and two.held


def test_taking_it_twice_is_having_it(saved: Path) -> None:
    owner = make_owner()
    one, again = Lock(saved, owner), Lock(saved, owner)
    assert one.acquire() is None and again.acquire() is None
    assert one.held and again.held


def test_a_link_and_its_target_are_one_file(saved: Path, tmp_path: Path) -> None:
    (tmp_path / "more").mkdir()
    link = tmp_path / "more" / "link.yaml"
    link.symlink_to(saved)
    assert Lock(saved, make_owner()).acquire() is None
    assert Lock(link, make_owner()).acquire() is not None


def test_of_many_at_once_one_gets_it(saved: Path) -> None:
    locks = [Lock(saved, make_owner()) for _ in range(16)]
    with ThreadPoolExecutor(16) as pool:
        list(pool.map(Lock.acquire, locks))
    assert sum(lock.held for lock in locks) == 1


def test_of_many_that_take_a_dead_one_over_at_once_one_keeps_it(saved: Path) -> None:
    for _ in range(10):
        write(saved, msgspec.structs.replace(make_owner(), pid=ended()))
        locks = [Lock(saved, make_owner()) for _ in range(4)]
        with ThreadPoolExecutor(4) as pool:
            list(pool.map(Lock.acquire, locks))
        assert sum(lock.refresh() and lock.held for lock in locks) == 1
        lock_path(saved).unlink()
    assert [p.name for p in saved.parent.iterdir()] == [saved.name]


def test_a_process_that_is_gone_leaves_nothing_to_ask_about(saved: Path) -> None:
    write(saved, msgspec.structs.replace(make_owner(), pid=ended()))
    lock = Lock(saved, make_owner())
    assert lock.acquire() is None and lock.held


def test_a_number_that_another_process_has_now_is_not_its_owner(saved: Path) -> None:
    write(saved, msgspec.structs.replace(make_owner(), started="1"))
    lock = Lock(saved, make_owner())
    assert lock.acquire() is None and lock.held


@pytest.mark.parametrize("pid", [-1, 0, 2**40])
def test_a_number_that_no_process_has_is_nobodys(saved: Path, pid: int) -> None:
    write(saved, msgspec.structs.replace(make_owner(), pid=pid))
    lock = Lock(saved, make_owner())
    assert lock.acquire() is None and lock.held


@pytest.mark.skipif(os.name == "nt", reason="there is no kill -9 on Windows")
def test_a_killed_process_is_gone_at_once_and_a_stopped_one_is_not(saved: Path) -> None:
    code = "import sys, time; from pathlib import Path; from metagraph.formats.locking import *; "
    code += (
        "lock = Lock(Path(sys.argv[1]), make_owner()); lock.acquire(); print(lock.held, flush=True); "
        "time.sleep(60)"
    )
    child = subprocess.Popen(
        [sys.executable, "-c", code, str(saved)], cwd=ROOT, stdout=subprocess.PIPE, text=True
    )
    try:
        assert child.stdout is not None and child.stdout.readline() == "True\n"
        child.send_signal(signal.SIGSTOP)
        lock = Lock(saved, make_owner())
        assert lock.acquire() is not None, "it may go on"
        child.kill()
        child.wait(10)
        assert lock.acquire() is None and lock.held
    finally:
        child.kill()
        child.wait(10)
        if child.stdout is not None:
            child.stdout.close()


def test_another_computers_lock_lives_while_it_is_touched(saved: Path) -> None:
    write(saved, elsewhere(pid=ended()), age=STALE / 2)
    lock = Lock(saved, make_owner())
    found = lock.acquire(take_over=True)
    assert found is not None and not found.gone and not lock.held


def test_another_computers_lock_that_was_not_touched_for_long_is_asked_about(saved: Path) -> None:
    write(saved, elsewhere(), age=STALE * 2)
    lock = Lock(saved, make_owner())
    found = lock.acquire()
    assert found is not None and found.gone and not found.sure, "it may only sleep"
    assert lock.acquire(take_over=True) is None and lock.held


def test_one_container_does_not_judge_the_numbers_of_another(saved: Path) -> None:
    owner = msgspec.structs.replace(make_owner(), machine="another namespace", pid=ended())
    write(saved, owner)
    assert not is_gone(owner, lock_path(saved))


@pytest.mark.parametrize("content", [b"", b"{", b"\xff\x00", b"[]", b'{"host": 3}'])
def test_a_lock_nobody_can_read_is_somebodys_until_it_is_old(saved: Path, content: bytes) -> None:
    write(saved, content)
    found = Lock(saved, make_owner()).acquire()
    assert found is not None and found.owner is None and not found.gone, "it may just be being written"
    write(saved, content, age=STALE * 2)
    lock = Lock(saved, make_owner())
    assert lock.acquire(take_over=True) is None and lock.held


def test_refreshing_touches_it_and_tells_when_it_was_taken_over(saved: Path) -> None:
    lock = Lock(saved, make_owner())
    lock.acquire()
    os.utime(lock_path(saved), (0, 0))
    assert lock.refresh()
    assert lock_path(saved).stat().st_mtime > time.time() - 60
    write(saved, elsewhere())
    assert not lock.refresh() and not lock.held
    lock.release()
    assert find_holder(lock_path(saved)) is not None, "what is not ours is not removed"


def test_a_lock_that_was_tidied_up_is_made_again(saved: Path) -> None:
    lock = Lock(saved, make_owner())
    lock.acquire()
    lock_path(saved).unlink()
    assert lock.refresh() and lock_path(saved).exists()


def test_a_folder_that_takes_no_lock_keeps_nobody_out(saved: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*args: object, **more: object) -> int:
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr(os, "open", refuse)
    lock = Lock(saved, make_owner())
    assert lock.acquire() is None and not lock.held
    assert lock.refresh()
    lock.release()


def test_a_folder_in_the_locks_place_keeps_nobody_out(saved: Path) -> None:
    lock_path(saved).mkdir()
    lock = Lock(saved, make_owner())
    assert lock.acquire() is None and not lock.held


def test_a_disk_without_room_leaves_no_half_lock(saved: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*args: object) -> int:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "write", full)
    lock = Lock(saved, make_owner())
    assert lock.acquire() is None and not lock.held
    assert not lock_path(saved).exists()


def test_age_is_told_by_the_clock_of_the_drive(saved: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(saved, elsewhere())
    monkeypatch.setattr(locking.time, "time", lambda: 1e12)  # this computer's clock is wrong
    found = find_holder(lock_path(saved))
    assert found is not None and not found.gone
