#!/usr/bin/env python3
"""Set up and start Metagraph: `python3 run.py`. Test it: `python3 run.py test`. Needs Python 3.11 to 3.14 and
nothing else.

Makes `.venv`, installs the pinned dependencies into it, installs missing system libraries on Debian and
Ubuntu (at once as root, through sudo after asking otherwise), then runs. Whatever follows is passed on:
`python3 run.py check my.metagraph.yaml`. `python3 run.py install` installs now what is otherwise installed
when first needed, for work without a network.
"""

import ctypes
import hashlib
import os
import shlex
import shutil
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent
VENV = ROOT / ".venv"
WINDOWS = os.name == "nt"
PYTHON = VENV / ("Scripts/python.exe" if WINDOWS else "bin/python")
# Everybody needs the first list, new motion and hours of BVH the second, and tests all.
LISTS = ("requirements.txt", "requirements-compiled.txt", "requirements-test.txt")

# Library or program -> Debian package. Drawing without a screen needs the first group, a window the second,
# tests the third.
DRAWING = {"libEGL.so.1": "libegl1", "libGL.so.1": "libgl1"}
WINDOW = {
    "libglib-2.0.so.0": "libglib2.0-0",
    "libxkbcommon.so.0": "libxkbcommon0",
    "libdbus-1.so.3": "libdbus-1-3",
    "libfontconfig.so.1": "libfontconfig1",
    "libxcb-cursor.so.0": "libxcb-cursor0",
    "libxcb-icccm.so.4": "libxcb-icccm4",
    "libxcb-keysyms.so.1": "libxcb-keysyms1",
    "libxcb-shape.so.0": "libxcb-shape0",
    "libxkbcommon-x11.so.0": "libxkbcommon-x11-0",
    "libportaudio.so.2": "libportaudio2",
}
TESTING = {"Xvfb": "xvfb", "xauth": "xauth", "xdotool": "xdotool", "espeak-ng": "espeak-ng"}
# Exports are run in these; without one its tests skip, and say so.
ENGINES = {
    "node": "nodejs",
    "npm": "npm",
    "mcs": "mono-mcs",
    "mono": "mono-runtime",
    "godot3-server": "godot3-server",
    "chromium": "chromium",
}


# Programs are the system's own, wherever PATH leads: in a folder of somebody's, `npm` may be anything.
PLACES = ("/usr/local/sbin", "/usr/local/bin", "/usr/sbin", "/usr/bin", "/sbin", "/bin", "/opt/homebrew/bin")


def main(arguments):
    if not (3, 11) <= sys.version_info[:2] <= (3, 14):
        return f"Python 3.11 to 3.14 is needed, this is {sys.version_info[0]}.{sys.version_info[1]}."
    if arguments == ["install"]:
        return environment(1)
    testing = arguments[:1] == ["test"]
    screen = not sys.platform.startswith("linux") or bool(
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )
    trouble = system_libraries(screen, testing) if sys.platform.startswith("linux") else None
    if trouble:
        return trouble
    if testing:
        return prepare_and_test(arguments[1:])
    # In the folder it was called from, which paths are relative to; no module is taken from there (-P).
    problem = environment(0)
    if problem is None and not arguments and not screen:
        print(
            "There is no screen (DISPLAY is not set), so no window opens: the same is done without one.",
            flush=True,
        )
    words = arguments or (["window", "--sample"] if screen else ["demo"])
    # What it prints to type starts it as it was started.
    started = {"METAGRAPH_COMMAND": shlex.join([Path(sys.executable).name, sys.argv[0]])}
    return problem or become([str(PYTHON), "-P", "-m", "app.cli", *words], {**os.environ, **started})


def become(command, environ):
    """Go on as another program, so that whoever ends this one ends that; where there is no such thing, wait
    for it and return its exit status.
    """
    if WINDOWS:
        return subprocess.call(command, env=environ)
    sys.stdout.flush()
    return os.execve(command[0], command, environ)


# --- system libraries


def program(name):
    """Return the path of one of the system's programs, None where it has none."""
    return shutil.which(name, path=None if WINDOWS else os.pathsep.join(PLACES))


def missing(screen, testing):
    """Return the Debian packages that are not there."""
    wanted = {**DRAWING, **(WINDOW if screen or testing else {})}
    out = [package for library, package in wanted.items() if not loads(library)]
    if testing:
        out += [package for name, package in TESTING.items() if shutil.which(name) is None]
    return out


def loads(library):
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def system_libraries(screen, testing):
    packages = missing(screen, testing)
    if not packages:
        return None
    install = ["apt-get", "install", "-y", "--no-install-recommends", *packages]
    line = "sudo apt-get update && sudo " + " ".join(install)
    if program("apt-get") is None:
        return (
            "System libraries are missing. This installs them on Debian and Ubuntu; elsewhere they have "
            "similar names:\n  "
        ) + line
    if os.geteuid() == 0:
        prefix = []
    elif program("sudo") and sys.stdin.isatty():
        print("System libraries are missing: " + " ".join(packages))
        if input("Install them now with sudo? [Y/n] ").strip().lower() not in ("", "y", "yes"):
            return "Then install them yourself and start again:\n  " + line
        prefix = [program("sudo")]
    else:
        return "System libraries are missing. Install them and start again:\n  " + line
    print("Installing system libraries: " + " ".join(packages), flush=True)
    environ = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    for command in (["update", "-qq"], install[1:]):
        if (
            subprocess.call([*prefix, program("apt-get"), *command], env=environ, stdout=subprocess.DEVNULL)
            != 0
        ):
            return "That failed. Install them yourself and start again:\n  " + line
    left = missing(screen, testing)
    return f"Still missing after the installation: {' '.join(left)}" if left else None


def engines():
    """Install what exports are run in, as far as this system offers it."""
    absent = [package for name, package in ENGINES.items() if shutil.which(name) is None]
    if not absent or not sys.platform.startswith("linux") or program("apt-get") is None:
        return
    apt = program("apt-get")
    install = [apt, "install", "-y", "--no-install-recommends"]
    if os.geteuid() == 0:
        prefix = []
    elif program("sudo") and sys.stdin.isatty():
        if input(
            f"Install {', '.join(absent)} as well, to test exports in engines? [Y/n] "
        ).strip().lower() not in ("", "y", "yes"):
            return
        prefix = [program("sudo")]
    else:
        print(
            "(Tests in engines are skipped; to run them: sudo apt-get "
            + " ".join([*install[1:], *absent])
            + ")"
        )
        return
    print("Installing engines to test exports in: " + " ".join(absent), flush=True)
    environ = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "env": environ}
    subprocess.call([*prefix, apt, "update", "-qq"], **quiet)
    if subprocess.call([*prefix, *install, *absent], **quiet) == 0:
        return
    for package in absent:  # not every system has all of them
        if subprocess.call([*prefix, *install, package], **quiet) != 0:
            print(f"({package} could not be installed: its tests are skipped)")


# --- the environment


def environment(most):
    """Make .venv and install what is pinned in the lists up to number `most`; nothing to do when that was
    done before.
    """
    current = [n for n in range(len(LISTS)) if stamp(n).exists() and stamp(n).read_text() == wanted(n)]
    if current and current[-1] >= most:
        return None
    if any(stamp(n).exists() for n in range(1, len(LISTS))):
        most = max(most, 1)  # a compiler that is there has to fit the rest
    if not PYTHON.exists() or not pip("--version", quiet=True):
        print("Making the environment in .venv (once, less than a minute) ...", flush=True)
        shutil.rmtree(VENV, ignore_errors=True)
        made = subprocess.run([sys.executable, "-I", "-m", "venv", str(VENV)], capture_output=True, text=True)
        if made.returncode != 0:
            shutil.rmtree(VENV, ignore_errors=True)
            hint = (
                " On Debian or Ubuntu: sudo apt-get install -y python3-venv"
                if sys.platform.startswith("linux")
                else ""
            )
            return (
                "The environment could not be made: "
                f"{(made.stdout + made.stderr).strip().splitlines()[-1]}.{hint}"
            )
    print("Installing dependencies ...", flush=True)
    # Modules are compiled when they are first imported: most never are.
    install = ("install", "--disable-pip-version-check", "-q", "--no-compile")
    # What only tests need comes at the same time, by uv, which unpacks it in a quarter of pip's time.
    with ThreadPoolExecutor() as beside:
        tested = beside.submit(install_tests, install) if most == 2 else None
        installed = pip(*install, *listed(LISTS[: min(most, 1) + 1]))
    if not installed or (tested is not None and not tested.result()):
        return (
            "The dependencies could not be installed; what pip said is above. Check the network and "
            "start "
            "again."
        )
    if not current and not pip(*install, "--no-deps", "--no-build-isolation", "-e", str(ROOT)):
        return "Metagraph could not be installed into its environment; what pip said is above."
    # FBX is an extra with no wheel for every system: welcome where it installs, not missed where it does not.
    if not current and not pip(*install, "--only-binary", ":all:", "ufbx==0.0.5", quiet=True):
        print("(FBX files cannot be read on this system; BVH and glTF can.)")
    stamp(most).write_text(wanted(most))
    return None


def install_tests(install):
    """Install what only tests need, by uv; by pip where uv fails, as behind a mirror that only pip knows."""
    pinned = [line for line in (ROOT / LISTS[2]).read_text().splitlines() if line.startswith("uv==")]
    words = ("--no-deps", *listed(LISTS[2:]))
    if pinned and pip(*install, "--no-deps", *pinned):
        uv = [str(PYTHON), "-m", "uv", "pip", "install", "-q", "--no-cache", "--python", str(PYTHON), *words]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        if subprocess.call(uv, cwd=ROOT, **quiet) == 0:
            return True
    return pip(*install, *words)


def listed(names):
    """Return pip's options for some lists."""
    return [word for name in names for word in ("-r", str(ROOT / name))]


def stamp(most):
    """Return the file that tells which lists were installed."""
    return VENV / (".installed", ".installed-compiled", ".installed-test")[most]


def wanted(most):
    """Return what the stamp holds while nothing has changed."""
    return hashlib.sha256(
        b"".join((ROOT / name).read_bytes() for name in (*LISTS[: most + 1], "pyproject.toml"))
    ).hexdigest()


def pip(*arguments, quiet=False):
    options = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL} if quiet else {}
    environ = {**os.environ, "PIP_ROOT_USER_ACTION": "ignore"}
    return subprocess.call([str(PYTHON), "-m", "pip", *arguments], env=environ, cwd=ROOT, **options) == 0


# --- tests


def prepare_and_test(arguments):
    """Install what tests need, then test. What exports are run in comes meanwhile, since only the tests wait
    for it.
    """
    beside = threading.Thread(target=lambda: (engines(), node_packages()))
    beside.start()
    if hasattr(os, "geteuid") and os.geteuid() != 0:
        beside.join()  # it may ask
    try:
        return environment(2) or run_tests(arguments, beside.join)
    finally:
        beside.join()


def node_packages():
    """Install what exports are checked in with Node, where it is."""
    npm = program("npm")
    stamp, wanted = ROOT / "tests" / "node_modules" / ".installed", ROOT / "tests" / "package.json"
    wanted = wanted.read_text() if wanted.exists() else None
    if npm and wanted and not (stamp.exists() and stamp.read_text() == wanted):
        options = [
            "--prefix",
            str(ROOT / "tests"),
            "--no-package-lock",
            "--no-audit",
            "--no-fund",
            "--silent",
            "--fetch-retries=1",
            "--ignore-scripts",  # one would copy an engine beside the tests
        ]
        if (
            subprocess.call([npm, "install", *options], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            == 0
        ):
            stamp.write_text(wanted)


def run_tests(arguments, ready=lambda: None):
    """Lint, types, import rules, then the tests, once `ready` has returned; with arguments, only pytest with
    those.
    """

    def tool(name):
        return str(PYTHON.with_name(name + (".exe" if WINDOWS else "")))

    keep_bytecode()
    give_memory_back()
    one_thread_each()
    lint = [
        [tool("ruff"), "check", "."],
        [tool("ruff"), "format", "--check", "."],
        [tool("mypy")],
        [tool("lint-imports")],
    ]
    tests = [str(PYTHON), "-m", "pytest", *spread(arguments), *arguments]
    if arguments:
        ready()
        return told(tests)
    # What the tests call compiled is compiled meanwhile, and they themselves are: on another core, and once
    # for all of their processes.
    compiling = subprocess.Popen([str(PYTHON), "-m", "tests.prepare"], cwd=ROOT)
    try:
        failed = [told(step) for step in lint]
    finally:
        compiling.wait()
    ready()
    return max(*failed, told(tests))


def keep_bytecode():
    """Where bytecode is not to be written beside the sources, keep it with what else the tests keep: they
    start some hundred processes, and each would compile all that it imports.
    """
    if os.environ.pop("PYTHONDONTWRITEBYTECODE", None):
        os.environ.setdefault("PYTHONPYCACHEPREFIX", str(ROOT / ".pytest_cache" / "bytecode"))


def give_memory_back():
    """Have glibc give back what the tests let go of: as it is, each large array that goes makes it keep more,
    until their processes hold a third more than is in use. Arrays of less than some megabytes are not
    worth it: the system clears each page anew, which took a quarter of the time of what works on whole takes.
    """
    for name, value in (("MMAP_THRESHOLD_", 1 << 22), ("TRIM_THRESHOLD_", 1 << 24), ("ARENA_MAX", 2)):
        os.environ.setdefault("MALLOC_" + name, str(value))


def one_thread_each():
    """Have what multiplies matrices and what draws keep to one thread: each core has a process of the tests
    already, and threads that wait for each other take time from both (a quarter of drawing, two thirds of
    small matrices). The program itself does so with matrices.
    """
    for name in ("OPENBLAS_NUM_THREADS", "LP_NUM_THREADS"):
        os.environ.setdefault(name, "1")


def told(command):
    print("$ " + " ".join([Path(command[0]).name, *command[1:]]), flush=True)
    return subprocess.call(command, cwd=ROOT)


def spread(arguments):
    """Return pytest's options to run in a process for each core and one more, each with a screen of its own,
    since some tests wait for a clock; none for named files or where asked otherwise.
    """
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    own = (
        "-n",
        "--numprocesses",
        "--dist",
        "-s",
        "--capture",
        "--pdb",
        "--trace",
        "--co",
        "-pno:xdist",
        "no:xdist",
    )
    if cores < 2 or any(word.startswith(own) or ".py" in word for word in arguments):
        return []
    # Whole files, since many make something dear once; in the order that tests/conftest.py gives them, the
    # longest first.
    # A process that crashes ends the run at once: the others would wait for its tests for ever.
    return ["-n", str(cores + 1), "--dist", "loadfile", "--no-loadscope-reorder", "--max-worker-restart", "0"]


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
