"""`python -m tests.benchmarks` lists the benchmarks; with names, or `all`, it runs one after the other."""

from __future__ import annotations

import ast
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).parent


def scripts() -> dict[str, Path]:
    """Return the scripts by name, `bench_` left out."""
    return {path.stem.removeprefix("bench_"): path for path in sorted(HERE.glob("bench_*.py"))}


def main(names: list[str]) -> int:
    """Run what is named; return the exit code: how many failed."""
    known = scripts()
    if not names:
        for name, path in known.items():
            words = (ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or "").partition("\n")[0]
            print(f"{name:20} {words}")
        return 0
    unknown = [name for name in names if name != "all" and name not in known]
    if unknown:
        print(f"there is no benchmark '{unknown[0]}'; there are {', '.join(known)}", file=sys.stderr)
        return 2
    failed = 0
    for name in known if "all" in names else names:
        print(f"--- {name}", flush=True)
        begin = time.perf_counter()
        code = subprocess.run([sys.executable, str(known[name])], cwd=HERE.parents[1]).returncode
        failed += code != 0
        print(
            f"    {time.perf_counter() - begin:.0f} s{'' if code == 0 else f', failed ({code})'}", flush=True
        )
    return failed


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
