"""Errors nobody foresaw: each told once, on whatever thread or process, and a report without the project's words."""

from __future__ import annotations

import subprocess
import sys
import threading
from pathlib import Path

import pytest
from PySide6.QtWidgets import QFileDialog, QWidget

from app import faults
from app.project.document import Document
from app.project.jobs import Jobs
from app.shell.fault_dialog import FaultDialog, FaultTeller
from metagraph.errors import FileError
from metagraph.formats.locking import process_mark
from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from tests.failing_system import failing
from tests.sittings import ended

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(autouse=True)
def anew():
    faults.forget_faults()
    yield
    faults.forget_faults()


@pytest.fixture
def told():
    heard = []
    faults.listeners.append(heard.append)
    yield heard
    faults.listeners.remove(heard.append)


def raised(work, where="window"):
    try:
        work()
    except Exception as error:
        faults.report_error(error, where)


def zero():
    return 1 / 0


# --- what is reported


def test_a_fault_is_told_once_and_counted(told):
    for _ in range(5):
        raised(zero)
    raised(lambda: {}["secret name"])
    assert [fault.what for fault in told] == ["ZeroDivisionError: division by zero", "KeyError: '…'"]
    assert told[0].count == 5 and "5 times" in faults.format_fault_report()


def test_endless_different_faults_are_not_kept_for_ever(told):
    for n in range(3 * faults.KEPT):
        raised(lambda n=n: exec(compile(f"{chr(10) * n}1 / 0", "x", "exec")))
    assert len(told) == faults.KEPT


@pytest.mark.parametrize("error", [EditError("no such stance"), FileError("a.bvh", "is broken")])
def test_what_says_in_words_what_can_be_done_is_no_fault(told, error):
    faults.report_error(error, "window")
    assert (
        told == [error]
        and "broken" not in faults.format_fault_report()
        and "stance" not in faults.format_fault_report()
    )


@pytest.mark.parametrize(
    ("words", "left"),
    [
        ("'Anna waves' is not in list", "'…' is not in list"),
        ('no "Anna"', "no '…'"),
        (
            "[Errno 2] No such file or directory: '/home/anna/show.yaml'",
            "[Errno 2] No such file or directory: '…'",
        ),
        ("cannot open /home/anna/show now", "cannot open … now"),
        ("cannot open C:\\Users\\anna\\show", "cannot open …"),
    ],
)
def test_names_and_places_are_left_out(words, left):
    assert faults.strip_quotes(words) == left


def test_a_report_tells_versions_actions_and_places_of_ours_alone(told):
    faults.note("export")

    class StrangeError(Exception):
        pass

    def strange():
        try:
            zero()
        except ZeroDivisionError:
            raise StrangeError("Anna's own words")  # noqa: B904 - what was raised before is reported, too

    raised(strange)
    text = faults.format_fault_report()
    assert "Metagraph 0." in text and "PySide6" in text and "  " in text and "export" in text
    assert "StrangeError" in text and "Anna" not in text and "division by zero" not in told[0].what
    assert "tests/app/test_faults.py:" in text and "and then" in text
    assert str(ROOT) not in text and str(Path.home()) not in text


def test_a_listener_that_fails_does_not_keep_others_from_hearing(told):
    def broken(fault):
        raise RuntimeError

    faults.listeners.insert(0, broken)
    try:
        raised(zero)
    finally:
        faults.listeners.remove(broken)
    assert len(told) == 1


# --- jobs


def test_a_job_that_fails_unforeseen_or_unheard_is_told(qtbot, told):
    jobs, heard = Jobs(), []

    def words():
        raise FileError("a.bvh", "is broken")

    for work in (zero, words):
        jobs.start("Reading Anna", lambda _, work=work: work(), failed=heard.append)
        jobs.start("quick", lambda _, work=work: work(), quick=True)
    qtbot.waitUntil(lambda: len(heard) == 2 and len(told) >= 2)
    qtbot.wait(50)
    assert sorted(type(x).__name__ for x in told) == ["FileError", "UncaughtError"], (
        "what was heard and foreseen is not"
    )
    assert "Anna" not in faults.format_fault_report()
    jobs.stop()


# --- processes


CHILD = """
import sys, threading, time
from pathlib import Path
from app import faults
told = []
faults.listeners.append(lambda fault: told.append((fault.where, fault.what)))
faults.install(Path(sys.argv[1]))
what = sys.argv[2]
if what == "thread":
    thread = threading.Thread(target=lambda: [][0], name="worker"); thread.start(); thread.join()
    print(told)
if what == "del":
    class X:
        def __del__(self): 1 / 0
    X(); print(told)
if what == "hook":
    sys.excepthook(*[(type(e), e, None) for e in [KeyError("x")]][0]); print(told)
if what == "segfault":
    import ctypes; ctypes.string_at(0)
if what == "child":
    import subprocess
    subprocess.run([sys.executable, "-c", "from app.faults import install_in_child; install_in_child(); {}['Anna']"])
    faults.read_child_faults(Path(sys.argv[1])); print(told)
"""


def child(folder, what):
    words = [sys.executable, "-c", CHILD, folder, what]
    return subprocess.run(words, cwd=ROOT, capture_output=True, text=True, timeout=120, check=False)


@pytest.mark.parametrize(
    ("what", "where"),
    [
        ("thread", "('thread worker', 'IndexError: list index out of range')"),
        ("del", "('the interpreter', 'ZeroDivisionError: division by zero')"),
        ("hook", "('window', \"KeyError: '…'\")"),
        ("child", "('process', \"process -c: KeyError: '…'\")"),
    ],
)
def test_it_is_taken_wherever_it_happens(tmp_path, what, where):
    done = child(tmp_path, what)
    assert done.returncode == 0 and done.stdout == f"[{where}]\n", done.stderr
    # data is where the program keeps its own: a window of an earlier test may make it while this one waits.
    assert not {p.name for p in tmp_path.iterdir()} - {"data"}, "a run that ended well leaves nothing"


def test_what_ended_the_program_is_found_by_the_next_start_once(tmp_path):
    assert child(tmp_path, "segfault").returncode != 0
    mine = tmp_path / f"crash-{process_mark()}.txt"
    mine.write_text("of a window that is open")
    killed = tmp_path / f"crash-{process_mark().split('-')[0]}-{ended()}-1.txt"
    killed.write_text("")
    text = faults.read_crash_reports(tmp_path)
    assert "Segmentation fault" in text and "of a window" not in text and str(ROOT) not in text
    assert faults.read_crash_reports(tmp_path) == "" and mine.exists() and not killed.exists()


# --- what is shown


@pytest.fixture
def teller(qtbot):
    window, words = QWidget(), []
    qtbot.addWidget(window)
    document = Document(window)
    found = FaultTeller(document, window, words.append)
    found.said = words
    yield found
    found.stop()
    document.close_journal()


def dialog_of(qtbot, teller):
    qtbot.waitUntil(lambda: teller.window.findChild(FaultDialog) is not None)
    return teller.window.findChild(FaultDialog)


def test_a_fault_on_any_thread_is_one_dialog_beside_the_window(qtbot, teller):
    teller.document.edit("Change", lambda p: edits.set_settings(p, seed=7))
    thread = threading.Thread(target=lambda: raised(zero))
    thread.start()
    thread.join()
    dialog = dialog_of(qtbot, teller)
    assert "in the journal" in dialog.sentence.text()
    assert "division by zero" in dialog.text.toPlainText() and ": Change" in dialog.text.toPlainText()
    raised(lambda: [][0])
    qtbot.waitUntil(lambda: "IndexError" in dialog.text.toPlainText())
    assert len(teller.window.findChildren(FaultDialog)) == 1 and not dialog.isModal()


def test_edits_that_are_in_no_file_are_said_to_be(qtbot, teller):
    with failing(teller.document.journal_place.parent, 0, "error", for_ever=True):
        teller.document.edit("Change", lambda p: edits.set_settings(p, seed=7))
        raised(zero)
        dialog = dialog_of(qtbot, teller)
    assert "not in any file" in dialog.sentence.text()


def test_what_can_be_mended_by_the_user_is_said_in_the_status_bar(qtbot, teller):
    raised(lambda: teller.document.edit("Seed", lambda p: edits.set_settings(p, seed=-1)))
    qtbot.waitUntil(lambda: bool(teller.said))
    assert "seed" in teller.said[0] and teller.window.findChild(FaultDialog) is None


def test_the_report_is_saved_where_one_chooses(qtbot, teller, tmp_path, monkeypatch):
    raised(zero)
    dialog = dialog_of(qtbot, teller)
    place = tmp_path / "report.txt"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *a: (str(place), ""))
    dialog.save.click()
    assert "ZeroDivisionError" in place.read_text() and "Saved report.txt" in dialog.sentence.text()
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *a: (str(tmp_path / "report.txt" / "x"), ""))
    dialog.save.click()
    assert "cannot be written" in dialog.sentence.text()


def test_a_crash_of_the_last_time_is_offered(qtbot, teller, monkeypatch):
    monkeypatch.setattr(faults, "read_crash_reports", lambda folder: "Fatal Python error: Segmentation fault")
    teller.offer_left()
    dialog = dialog_of(qtbot, teller)
    assert "quit unexpectedly" in dialog.windowTitle() and "Segmentation" in dialog.text.toPlainText()
