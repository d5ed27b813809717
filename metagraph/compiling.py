"""Loops compiled by numba, for the few things that NumPy takes ten times as long for.

numba and its LLVM are 210 MB, and most people's work never meets such a loop: they are installed when the
first one is asked for, into the environment that run.py made, and by the user's own command elsewhere.
"""

from __future__ import annotations

import importlib
import os
import sys
import zlib
from collections.abc import Callable, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from threading import Lock
from types import BuiltinFunctionType, FunctionType, ModuleType
from typing import Any

from metagraph.programs import ROOT, is_own, run

NUMBA = "numba>=0.60"

kept_by_numba = [True]  # whether numba keeps on disk what it makes, and takes it from there
unkept: list[str] = []  # loops that found no folder to be kept in
_ONE = Lock()  # one thread installs, the others wait


class CompilerError(RuntimeError):
    """numba is not there and could not be installed; the message says what to do."""


def there() -> bool:
    """Return whether numba is installed, without importing it."""
    return sys.modules.get("numba") is not None or find_spec("numba") is not None


class Loops:
    """A module of compiled loops that stand in for NumPy as soon as they are loaded. now: the module, or what
    is kept of its object code, None until then.

    The module has `warm()`, which calls what it compiles with nothing, `KEPT`, the names of its loops that
    are kept, and `SOURCES`, the modules that they are compiled from, too.
    """

    def __init__(self, module: str) -> None:
        self.module = module
        self.now: Any = None

    def load(self) -> None:
        """Load what is kept of the loops; where nothing is, import the module and have it make them ready."""
        if self.now is None and not self.load_kept():
            self.now = self._warmed()

    def load_kept(self) -> bool:
        """Load what is kept of the loops, in a few milliseconds; return whether they are loaded."""
        if self.now is None:
            from metagraph import object_code  # what it takes is not needed to open a window

            self.now = object_code.load(self.module)
        return self.now is not None

    def keep(self, by_numba: bool = False) -> bool:
        """Compile the loops and keep their object code, where that is not done yet; return whether it is
        kept. For a process that has not loaded them: of what numba takes from its own cache there is none.
        by_numba: have numba keep them, too, for which its cache must be empty.
        """
        from metagraph import object_code

        if object_code.load(self.module) is not None:
            return True
        if object_code.path(self.module) is None:
            return False
        kept_by_numba[0] = by_numba
        module = self._warmed()
        from metagraph.object_making import make

        return make(module, module.KEPT, (*module.SOURCES, sys.modules[__name__]))

    def _warmed(self) -> Any:
        module: Any = importlib.import_module(self.module)
        module.warm()
        return module


def plain(array: Any) -> Any:
    """Return an array as loops take it, in one piece and free to be written to: numba compiles anew for any
    other. A copy only where it is not so.
    """
    return array if array.flags.carray else array.copy(order="C")


def compiler(keep: bool = True, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Return a decorator that compiles a loop as `numba.njit` does with these options, and with `keep` keeps
    what it made on disk where there is a folder for that. Installs numba (a minute, once) where it may.
    Raises CompilerError.
    """
    if not there():
        with _ONE:
            if not there():
                _install()
    numba = _numba()

    def compiled(function: Callable[..., Any]) -> Any:
        try:
            loop = numba.njit(cache=keep and kept_by_numba[0], **options)(function)
            if loop.stats.cache_path is None or is_own(Path(loop.stats.cache_path)):
                return loop
        except RuntimeError:  # no folder to cache in
            pass
        unkept.append(function.__name__)  # or others could have put there what would be run
        return numba.njit(**options)(function)

    return compiled


def compiled_from(
    modules: Sequence[ModuleType], otherwise: Mapping[Any, Any], inside: Callable[[Any], Any]
) -> dict[str, dict[str, Any]]:
    """Return the names of modules that are written in plain numbers, their functions compiled with `inside`.
    otherwise: what stands in for functions that numba does not take. Numba takes tuples and named tuples for
    dataclasses.
    """
    spaces: dict[str, dict[str, Any]] = {module.__name__: {} for module in modules}
    made: dict[Any, Any] = {}
    for module in modules:
        for value in vars(module).values():
            if isinstance(value, FunctionType) and value.__module__ == module.__name__:
                code = otherwise.get(value, value).__code__
                made[value] = inside(FunctionType(code, spaces[module.__name__], value.__name__))
    for module in modules:
        for name, value in vars(module).items():
            if isinstance(value, FunctionType) and value in made:
                spaces[module.__name__][name] = made[value]
            elif isinstance(value, (int, float, tuple, BuiltinFunctionType)):
                spaces[module.__name__][name] = value
    return spaces


def stamp(modules: Sequence[ModuleType]) -> int:
    """Return a number that is another as soon as one of some modules is. Numba keeps what it compiled for as
    long as its own file stays as it is: a loop that is compiled from others' is made with this number.
    """
    said = 0
    for module in modules:
        said = zlib.crc32(Path(str(module.__file__)).read_bytes(), said)
    return said


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
    """Have run.py install numba into the environment it made: whoever started run.py asked for what it
    takes.
    """
    setup = ROOT / "run.py"
    if not setup.exists() or not any(
        (Path(sys.prefix) / name).exists() for name in (".installed", ".installed-test")
    ):
        raise CompilerError(
            f'This needs numba, which is not installed. Install it: "{sys.executable}" -m pip install '
            f'"{NUMBA}"'
        )
    print(
        "Installing the compiler that new motion needs (60 MB to load, once) ...", file=sys.stderr, flush=True
    )
    retries = os.environ.get("PIP_RETRIES", "2")  # where there is no network that is told in seconds
    code, words = run([sys.executable, "-I", str(setup), "install"], cwd=ROOT, env={"PIP_RETRIES": retries})
    importlib.invalidate_caches()
    if code != 0 or not there():
        said = [line for line in words.splitlines() if "ERROR" in line] or ["nothing was said"]
        raise CompilerError(
            f"This needs numba, which could not be installed ({said[-1].strip()}). "
            "Check the network and try again, or install it before you go where there is none: python3 "
            "run.py install"
        )
