"""Functions compiled by numba: those that build and search motion graphs, which NumPy takes minutes for.

numba and its LLVM take 210 MB, so they are installed only when a motion graph is first needed: into the
environment that run.py made, or by the user's own command elsewhere.
"""

from __future__ import annotations

import importlib
import os
import sys
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from threading import Lock
from types import ModuleType
from typing import Any

from metagraph.common.extra_steps import ExtraError, install_extra
from metagraph.common.extras import describe_missing_extra, is_bundle
from metagraph.common.programs import ROOT, is_own, run_program
from metagraph.common.wording import phrase

LOADING = "Installing the compiler that new motion needs (60 MB to load, once) ..."

_ONE = Lock()  # one thread installs, the others wait


class CompilerError(RuntimeError):
    """numba is not there and could not be installed; the message says what to do."""


def is_numba_installed() -> bool:
    """Return whether numba is installed, without importing it."""
    return sys.modules.get("numba") is not None or find_spec("numba") is not None


def find_compiler(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Return a decorator that compiles a function as `numba.njit` does with these options, and keeps the
    result on disk where the user's own folder allows it. Installs numba (a minute, once) where it may. Raises
    CompilerError.
    """
    if not is_numba_installed():
        with _ONE:
            if not is_numba_installed():
                _install()
    numba = _numba()

    def compiled(function: Callable[..., Any]) -> Any:
        try:
            loop = numba.njit(cache=True, **options)(function)
            if loop.stats.cache_path is None or is_own(Path(loop.stats.cache_path)):
                return loop
        except RuntimeError:  # no folder to cache in
            pass
        # What others may write to is not kept: it would be run.
        return numba.njit(**options)(function)

    return compiled


def _numba() -> ModuleType:
    """Return numba, which takes settings, such as where to load compiled code from, from a file in the
    working folder: not from there.
    """
    import numba  # half a second
    from numba.core import config

    settings: Any = config
    if getattr(settings, "_config_fname", None) != os.devnull:
        settings._config_fname = os.devnull
        settings._env_reloader.update(force=True)
    return numba


def _install() -> None:
    """Install numba: a bundle into the user's extras; run.py into the environment it made, since whoever
    started it asked for what it takes.
    """
    if is_bundle():
        try:
            print(LOADING, file=sys.stderr, flush=True)
            install_extra("compiled")
        except ExtraError as error:
            raise CompilerError(f"This needs numba. {error}") from None
        return
    setup = ROOT / "run.py"
    if not setup.exists() or not any(
        (Path(sys.prefix) / name).exists() for name in (".installed", ".installed-test")
    ):
        raise CompilerError(describe_missing_extra("compiled", phrase("This")))
    print(LOADING, file=sys.stderr, flush=True)
    retries = os.environ.get("PIP_RETRIES", "2")  # if there is no network that is given in seconds
    code, words = run_program(
        [sys.executable, "-I", str(setup), "install"], cwd=ROOT, env={"PIP_RETRIES": retries}
    )
    importlib.invalidate_caches()
    if code != 0 or not is_numba_installed():
        said = [line for line in words.splitlines() if "ERROR" in line] or ["nothing was said"]
        raise CompilerError(
            f"This needs numba, which could not be installed ({said[-1].strip()}). "
            "Check the network and try again, or install it before you go where there is none: python3 "
            "run.py install"
        )
