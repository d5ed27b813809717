"""Install and remove extras: in folders of the user's own, or in the environment that run.py made."""

from __future__ import annotations

import importlib
import os
import queue
import shutil
import sys
import threading
import time
from collections.abc import Callable, Sequence
from importlib.metadata import distributions
from pathlib import Path

from metagraph.common.extras import (
    CPU,
    EXTRAS,
    add_extras,
    can_install,
    describe_missing_extra,
    find_extras_folder,
    find_wants,
    holds_all,
    is_in_own_folder,
    is_installed,
    make_install_command,
    make_remove_command,
    measure_extra,
)
from metagraph.common.pip_words import describe_pip_line, explain_pip_failure, find_download_size
from metagraph.common.programs import ROOT, make_own, make_python_command, run_program, start
from metagraph.common.wording import Phrase, phrase

MINUTES = 30.0  # the longest that pip may take
CHECK = 120.0  # seconds that an import may take; torch takes 20 from a cold disk
Tell = Callable[[float, str], object]
_ONE = threading.Lock()  # one thread installs, the others wait


class ExtraError(RuntimeError):
    """An extra could not be installed or removed; the message says why and what to do."""


class StoppedError(ExtraError):
    """The user stopped it; nothing was changed."""


def install_extra(
    name: str,
    tell: Tell = lambda share, words: None,
    stopped: Callable[[], bool] = lambda: False,
    folder: Path | None = None,
) -> None:
    """Install an extra, see that it can be imported, and have it found at once; it takes minutes.

    tell: is given the share that is done, 0..1, and what is done now. stopped: asked ten times a second.
    folder: take the files from there and ask no network. Raises ExtraError, StoppedError where it was
    stopped, and KeyError for a name that is no extra's.
    """
    extra = EXTRAS[name]
    if extra.newest is not None and sys.version_info[:2] > (3, extra.newest):
        raise ExtraError(
            phrase(
                "Its packages are made for Python 3.{newest} and older. Metagraph runs with Python {version} "
                "here. Use a Metagraph that brings its own Python, or install it with Python 3.{newest}.",
                newest=extra.newest,
                version=f"{sys.version_info[0]}.{sys.version_info[1]}",
            )
        )
    if not can_install(name):
        raise ExtraError(
            phrase(
                "Install it the way Metagraph was installed: {command}",
                command=make_install_command(name),
            )
        )
    place = find_extras_folder() if is_in_own_folder(name) else Path(sys.prefix)
    if place is None:
        raise ExtraError(phrase("The user's folder for data is not known: set HOME"))
    if is_in_own_folder(name) and not make_own(place):
        raise ExtraError(phrase("{folder} cannot be written to", folder=place))
    free = shutil.disk_usage(place).free / 1e6
    if free < 1.3 * extra.megabytes:
        raise ExtraError(
            phrase(
                "It needs {megabytes:.0f} MB on the disk of {folder}, which has {free:.0f} MB free. Make "
                "room and try again.",
                megabytes=1.3 * extra.megabytes,
                folder=place,
                free=free,
            )
        )
    source = ["--no-index", "--find-links", str(folder.resolve())] if folder is not None else []
    if is_in_own_folder(name):
        _install_apart(name, place, source, tell, stopped)
        add_extras()
        return
    fits = [word for file in sorted(ROOT.glob("requirements*.txt")) for word in ("--constraint", str(file))]
    _run_pip(name, ["install", *fits, *source], tell, stopped, whole=False)
    importlib.invalidate_caches()
    try:
        _check(name, None, tell)
    except ExtraError:
        remove_extra(name)
        raise


def bring_extra(name: str, what: Phrase) -> None:
    """See that an extra is there, and install it first where Metagraph itself may: whoever asked for what
    needs it asked for that. what: what needs it, in words. Raises ExtraError, and KeyError for a name that is
    no extra's.
    """
    with _ONE:
        if is_installed(name):
            return
        if not can_install(name):
            raise ExtraError(describe_missing_extra(name, what))
        extra = EXTRAS[name]
        told = f"Installing {extra.module} ({extra.download} MB to load, once) ..."
        print(told, file=sys.stderr, flush=True)
        install_extra(name)


def _install_apart(
    name: str, place: Path, source: Sequence[str], tell: Tell, stopped: Callable[[], bool]
) -> None:
    """Install into a folder of its own first: what fails half way leaves nothing."""
    extra = EXTRAS[name]
    fresh, fits = place.parent / f"{place.name}-{name}-new", place.parent / f"{place.name}-fits.txt"
    try:
        shutil.rmtree(fresh, ignore_errors=True)
        fits.write_text("\n".join(_list_own_packages()), encoding="utf-8")
        options = ["install", "--target", str(fresh), "--only-binary", ":all:"]
        options += ["--no-deps"] if extra.holds else ["--constraint", str(fits)]
        _run_pip(name, [*options, *source], tell, stopped)
        if not holds_all(fresh, extra):
            raise ExtraError(phrase("The downloaded package lacks the files that Metagraph needs."))
        for part in () if extra.holds else fresh.iterdir():
            if (ROOT / part.name).exists():  # the bundle has it, and its own comes first
                shutil.rmtree(part) if part.is_dir() else part.unlink()
        if extra.holds:  # only a process of its own imports it
            tell(1.0, phrase("Installed."))
        else:
            _check(name, fresh, tell)
        target = place / name
        shutil.rmtree(target, ignore_errors=True)
        fresh.replace(target)
        make_own(target)  # whatever the user's mask is, others cannot write there
    except (OSError, TimeoutError) as error:
        raise ExtraError(str(error)) from None
    finally:
        shutil.rmtree(fresh, ignore_errors=True)
        fits.unlink(missing_ok=True)


def _list_own_packages() -> list[str]:
    """Return the packages that a bundle has, pinned, so that what an extra brings fits them."""
    found = {
        d.metadata["Name"]: d.version
        for d in distributions()
        if Path(str(d.locate_file(""))).resolve() == ROOT.resolve()
    }
    return [f"{name}=={number}" for name, number in sorted(found.items())]


def _run_pip(
    name: str, words: Sequence[str], tell: Tell, stopped: Callable[[], bool], whole: bool = True
) -> None:
    """Run pip on what an extra wants, and tell what it does. whole: it may be stopped while it unpacks, too.
    Raises ExtraError, StoppedError, TimeoutError.
    """
    import subprocess

    extra = EXTRAS[name]
    offline = "--no-index" in words
    wants = [word for word in find_wants(name) if not (offline and word in CPU)]
    common = ["--disable-pip-version-check", "--no-input", "--progress-bar", "off"]
    lines: list[str] = []
    heard: queue.Queue[str | None] = queue.Queue()
    tell(0.0, phrase("Starting…"))
    with start(
        make_python_command("pip", *words, *common, *wants),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        encoding="utf-8",
        errors="replace",
        env={"PIP_RETRIES": os.environ.get("PIP_RETRIES", "2")},
    ) as process:
        reader = threading.Thread(target=_pass_lines, args=(process.stdout, heard), daemon=True)
        reader.start()
        end, loaded, unpacking = time.monotonic() + MINUTES * 60, 0.0, False
        try:
            while True:
                if stopped() and (whole or not unpacking):
                    raise StoppedError(phrase("Stopped. Nothing was changed."))
                if time.monotonic() > end:
                    raise TimeoutError(f"pip took more than {MINUTES * 60:g} s")
                try:
                    line = heard.get(timeout=0.1)
                except queue.Empty:
                    continue
                if line is None:
                    break
                lines.append(line)
                doing = describe_pip_line(line)
                if doing is not None:
                    unpacking = unpacking or line.strip().startswith("Installing")
                    tell(0.85 if unpacking else 0.8 * min(1.0, loaded / (extra.download * 1e6)), doing)
                loaded += find_download_size(line)
        except BaseException:
            process.kill()
            raise
        code = process.wait()
    if code != 0:
        raise ExtraError(explain_pip_failure(lines, code, extra.wants[0], offline))


def _pass_lines(lines: object, to: queue.Queue[str | None]) -> None:
    for line in lines:  # type: ignore[attr-defined]
        to.put(line.rstrip("\n"))
    to.put(None)


def _check(name: str, folder: Path | None, tell: Tell) -> None:
    """See that an extra can be imported. Raises ExtraError that says what its module says."""
    tell(0.95, phrase("Checking that it works…"))
    command = make_python_command("metagraph.common.extra_check", EXTRAS[name].module, str(folder or ""))
    code, said = run_program(command, CHECK)
    if code != 0:
        why = (said.strip().splitlines() or [f"status {code}"])[-1]
        raise ExtraError(
            phrase(
                "It was downloaded but does not work here ({why}), so Metagraph removed it again.", why=why
            )
        )
    tell(1.0, phrase("Installed."))


def remove_extra(name: str) -> int:
    """Remove an extra; return the bytes that became free, 0 if it was not there. What is in use goes with the
    next start. Raises ExtraError where Metagraph may not remove it, and KeyError for a name that is no
    extra's.
    """
    size, place = measure_extra(name), find_extras_folder()
    if is_in_own_folder(name):
        if place is None or not (place / name).is_dir():
            return 0
        try:
            shutil.rmtree(place / name)
        except OSError as error:  # Windows keeps what is loaded
            raise ExtraError(
                phrase("{folder} is in use. Restart Metagraph and remove it then.", folder=place / name)
            ) from error
        if str(place / name) in sys.path:
            sys.path.remove(str(place / name))
        importlib.invalidate_caches()
        return size
    if not can_install(name):
        raise ExtraError(
            phrase(
                "Remove it the way Metagraph was installed: {command}",
                command=make_remove_command(name),
            )
        )
    if not size:
        return 0
    code, said = run_program(
        make_python_command("pip", "uninstall", "--yes", "--no-input", *EXTRAS[name].packages), 300
    )
    importlib.invalidate_caches()
    if code != 0:
        raise ExtraError(explain_pip_failure(said.splitlines(), code, name, False))
    return size
