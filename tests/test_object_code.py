"""Loops as kept object code: the same as by numba, and nothing of it where anything is wrong."""

from __future__ import annotations

import importlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from metagraph import object_code
from metagraph.object_linking import LinkError, linked, raised

ROOT = Path(__file__).parents[1]
NAME = "small_loops"
pytestmark = pytest.mark.skipif(not object_code.usable(), reason="object code is for Linux on x86-64")

SOURCE = '''
import numpy as np
from metagraph.compiling import compiler

compiled = compiler(keep=False, nogil=True, error_model="numpy")


@compiled
def several(numbers, pair, most, scale, doubled, out):
    """Sum what there is with what a compiled loop may have: lists, sines, new memory, what is returned."""
    some = [x for x in numbers if x < most]
    total = 0.0
    for x in some:
        total += np.sin(x) * scale
    more = np.zeros(len(some) + 1)
    more[0] = pair[0][0, 0] + pair[1][0]
    out[0] = (total + more.sum()) * (2 if doubled else 1)
    return len(some), len(numbers)


@compiled
def nothing(numbers):
    numbers[:] = 1


@compiled
def count(numbers):
    return len(numbers)


@compiled
def fails(numbers):
    some = [1.0]
    for _ in range(len(numbers) + 1):
        some.pop()


def warm():
    numbers = np.zeros(0)
    several(numbers, (np.zeros((1, 1), np.float32), np.zeros(1, np.int64)), 1, 1.0, True, np.zeros(1))
    nothing(numbers)
    count(numbers)
    fails(numbers)
'''


@pytest.fixture(scope="module")
def module(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ModuleType]:
    """A module of loops that were called."""
    folder = tmp_path_factory.mktemp("loops")
    (folder / f"{NAME}.py").write_text(SOURCE)
    sys.path.insert(0, str(folder))
    try:
        made: Any = importlib.import_module(NAME)
        made.warm()
        yield made
    finally:
        sys.path.remove(str(folder))
        del sys.modules[NAME]


@pytest.fixture(scope="module")
def kept(module: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder that the loops are kept in: made once, and copied for each test."""
    from metagraph.object_making import make

    folder = tmp_path_factory.mktemp("kept") / "cache"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("METAGRAPH_LOOP_CACHE", str(folder))
        assert make(module, ("several", "nothing", "count", "fails"), ())
    return folder


@pytest.fixture
def file(kept: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The file that the loops are kept in."""
    monkeypatch.setenv("METAGRAPH_LOOP_CACHE", str(shutil.copytree(kept, tmp_path / "cache")))
    found = object_code.path(NAME)
    assert found is not None and found.exists()
    return found


def given(out: Any) -> tuple[Any, ...]:
    numbers = np.linspace(0, 3, 7)
    return numbers, (np.full((1, 1), 0.5, np.float32), np.array([4])), 2, 1.5, True, out


def test_where_nothing_is_to_be_kept_nothing_is(module: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("METAGRAPH_LOOP_CACHE", "")
    assert object_code.path(NAME) is None and object_code.load(NAME) is None
    assert not object_code.keep(NAME, {}, {})


def test_elsewhere_than_on_linux_nothing_is_kept(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(object_code.platform, "machine", lambda: "riscv64")
    assert object_code.load(NAME) is None


def test_without_numba_nothing_is_loaded(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(object_code, "_here", lambda: None)
    assert object_code.load(NAME) is None


def test_loops_do_what_they_were_written_to_do(file: Path, module: Any) -> None:
    loops = object_code.load(NAME)
    out, expected = np.zeros(1), np.zeros(1)
    assert loops.several(*given(out)) == module.several(*given(expected)) == (4, 7)
    assert out[0] == expected[0] != 0
    numbers = np.zeros(3)
    assert loops.nothing(numbers) is None and numbers.tolist() == [1, 1, 1]
    assert loops.count(numbers) == 3 and loops.count(np.zeros(0)) == 0


def test_what_a_loop_was_not_compiled_for_is_refused(file: Path) -> None:
    loops = object_code.load(NAME)
    numbers, pair, most, scale, doubled, out = given(np.zeros(1))
    wide = np.zeros((3, 2))[:, 0]
    frozen = np.zeros(3)
    frozen.flags.writeable = False
    swapped = np.zeros(3, ">f8")
    for wrong in (wide, frozen, swapped, np.zeros(3, np.float32), np.zeros((3, 1)), [0.0, 1.0], None, 3):
        with pytest.raises(TypeError, match="count was compiled for"):
            loops.count(wrong)
    for wrong in ((pair[0],), (*pair, pair[0]), (pair[1], pair[0]), list(pair), None):
        with pytest.raises(TypeError, match="several was compiled for"):
            loops.several(numbers, wrong, most, scale, doubled, out)
    for few in ((), (numbers, numbers)):
        with pytest.raises(TypeError, match="count was compiled for"):
            loops.count(*few)
    with pytest.raises(TypeError):
        loops.several(numbers, pair, "2", scale, doubled, out)
    with pytest.raises(TypeError):
        loops.several(numbers, pair, most, None, doubled, out)


def test_a_loop_that_fails_says_so_and_the_next_call_works(file: Path) -> None:
    loops = object_code.load(NAME)
    with pytest.raises(RuntimeError, match="fails was not finished"):
        loops.fails(np.zeros(3))
    assert loops.fails(np.zeros(0)) is None


def test_another_process_needs_no_numba_and_may_import_it_afterwards(file: Path, module: Any) -> None:
    code = (
        "import sys, numpy as np; from metagraph import object_code;"
        f"loops = object_code.load({NAME!r}); out = np.zeros(1);"
        "given = np.linspace(0, 3, 7), (np.full((1, 1), 0.5, np.float32), np.array([4])), 2, 1.5, True, out;"
        "print(loops.several(*given), out[0], 'numba' in sys.modules);"
        "import numba; print(numba.njit(lambda n: [n, n])(2.0))"
    )
    made = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=300)
    expected = np.zeros(1)
    counts = module.several(*given(expected))
    assert made.stdout.splitlines() == [f"{counts} {expected[0]} False", "[2.0, 2.0]"], made.stderr


@pytest.mark.parametrize("left", [0, 10, 20, 60, 200, 5000, -1])
def test_a_file_that_was_cut_off_is_not_run(file: Path, left: int) -> None:
    file.write_bytes(file.read_bytes()[:left])
    assert object_code.load(NAME) is None


@pytest.mark.parametrize("at", [0, 20, 55, 100, -100])
def test_a_file_with_another_bit_in_it_is_not_run(file: Path, at: int) -> None:
    content = bytearray(file.read_bytes())
    content[at] ^= 4
    file.write_bytes(content)
    assert object_code.load(NAME) is None


@pytest.mark.parametrize(
    "change",
    [
        {"entry": 1 << 40},
        {"entry": -1},
        {"code": 100},
        {"within": [1 << 40]},
        {"within": [-8]},
        {"outside": {"NRT_unheard_of": [0]}},
        {"outside": {"PyUnheardOf": [0]}},
        {"within": "x"},
    ],
)
def test_a_file_that_says_what_cannot_be_is_not_run(file: Path, change: dict[str, Any]) -> None:
    head, images = object_code._read(file.read_bytes())
    size = len(object_code.MAGIC) + 32
    content = file.read_bytes()[size:]
    begin = 8 + int.from_bytes(content[:8], "little")
    head["loops"]["several"] |= change
    written = json.dumps(head).encode()
    content = len(written).to_bytes(8, "little") + written + content[begin:]
    file.write_bytes(object_code.MAGIC + object_code.hashlib.sha256(content).digest() + content)
    assert images and object_code.load(NAME) is None


@pytest.mark.parametrize("mode", [0o620, 0o602, 0o666])
def test_a_file_that_others_may_write_is_not_run(file: Path, mode: int) -> None:
    file.chmod(mode)
    assert object_code.load(NAME) is None
    file.chmod(0o600)
    assert object_code.load(NAME) is not None


def test_a_folder_that_others_may_write_to_is_not_trusted(file: Path) -> None:
    file.parent.chmod(0o777)
    assert object_code.load(NAME) is None


def test_a_file_of_another_user_is_not_run(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if os.geteuid() == 0:  # whose files everybody trusts
        os.chown(file, 65534, 65534)
    else:
        monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
    assert object_code.load(NAME) is None


def test_a_link_is_not_followed(file: Path, tmp_path: Path) -> None:
    file.rename(tmp_path / "elsewhere")
    file.symlink_to(tmp_path / "elsewhere")
    assert object_code.load(NAME) is None


def test_loops_of_other_sources_are_not_run(file: Path, module: ModuleType) -> None:
    source = Path(str(module.__file__))
    source.write_text(SOURCE + "\n# changed\n")
    try:
        assert object_code.load(NAME) is None
    finally:
        source.write_text(SOURCE)
    assert object_code.load(NAME) is not None


def test_old_files_go_and_what_was_not_finished(file: Path) -> None:
    for n in range(40):
        old = file.with_name(f"old{n}.bin")
        old.write_bytes(b"")
        os.utime(old, (n, n))
    file.with_name(f"{file.name}.123").write_bytes(b"")
    assert object_code.keep("another", {}, {})
    left = {path.name for path in file.parent.iterdir()}
    assert len(left) == 33 and file.name in left and "old39.bin" in left and "old0.bin" not in left


def test_a_folder_that_cannot_be_made_keeps_nothing(
    module: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("METAGRAPH_LOOP_CACHE", str(tmp_path / "file"))
    assert not object_code.keep(NAME, {}, {}) and object_code.load(NAME) is None


def test_what_is_no_object_file_is_not_linked() -> None:
    for content in (b"", b"\x7fELF", b"\x7fELF\x02\x01\x01" + bytes(60)):
        with pytest.raises(LinkError):
            linked([content], "entry")


def test_references_outside_of_the_code_are_refused() -> None:
    memory = np.zeros(16, np.uint8)
    raised(memory, [], 5)
    assert not memory.any()
    raised(memory, [8, 0], 258)
    assert memory.view(np.uint64).tolist() == [258, 258]
    for place in (9, -1, 1 << 60):
        with pytest.raises(ValueError, match="outside"):
            raised(memory, [place], 1)
