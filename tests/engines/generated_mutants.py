"""Generated mutants: one operator, number or word of a runtime changed at a time, and whether the conformance
vectors notice: `python -m tests.engines.generated_mutants javascript --count 400`.

What a vector cannot see is not changed: texts, messages, files that read files (packed ones have tests
of their own), an engine's own scenes; and what changes nothing: sizes of buffers, how far they are
filled or copied (what is behind is overwritten or never read), usual values of parameters that are
always given, numbers too small to divide by.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import random
import re
import select
import shutil
import signal
import subprocess
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from metagraph import engines
from tests.engines.godot_runtime import GODOT3

RUNTIMES = Path(engines.__file__).with_name("runtimes")
VECTORS = Path(engines.__file__).with_name("conformance")
SECONDS = 60.0  # what takes longer than this goes round for ever


@dataclass(frozen=True)
class Language:
    """A runtime and what of it is changed. folder: where it is. ends: of its sources' names. left_out: parts
    of paths of what vectors cannot see. silent: what a line holds that reports errors alone.
    """

    folder: str
    ends: str
    left_out: tuple[str, ...]
    comments: str = r"//[^\n]*|/\*.*?\*/"
    texts: str = r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|`(?:\\.|[^`\\])*`'
    silent: str = (
        r"\b(import|export \{|using|throw|describe|#include|#pragma|push_error|assert|constructor)\b"
        r"|new (Float(32|64)Array|double|float)\b|\.fill\(|\.resize\("
        r"|for \((let|int) k = 0; k < [34];"
    )


LANGUAGES = {
    "javascript": Language(
        "javascript",
        ".js",
        (
            "character.js", "describe.js", "glb.js", "graph.js", "three.js", "index.js", "words.js",
            "basics.js", "single_rules.js", "avatar", "react.js", "element.js", "stage.js", "sounds.js",
            "meshopt",
        ),
    ),
    "csharp": Language(
        "unity",
        ".cs",
        (
            "Component/", "Editor/", "Tests/", "Samples~/", "Character.cs", "Describe.cs", "Glb.cs",
            "Graph.cs", "Json.cs", "Loading", "Meshopt", "SharedGraphs", "Basics.cs", "Language.cs",
            "LifeSettings.cs", "Clip.cs", "SingleRules.cs", "LettersTable.cs",
        ),
        texts='@"(?:""|[^"])*"|' + Language.texts,
    ),
    "gdscript": Language(
        "godot/addons/metagraph",
        ".gd",
        (
            "metagraph_character", "plugin.gd", "conformance.gd", "character.gd", "check.gd",
            "describe.gd", "glb.gd", "graph.gd", "shim", "util.gd", "bones.gd", "clip.gd",
            "single_rules.gd", "letters_table.gd",
        ),
        comments=r"#[^\n]*",
        texts=r'"""(?:.|\n)*?"""|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'',
    ),
    "cpp": Language(
        "cpp",
        ".hpp",
        (
            "language.hpp", "json.hpp", "glb.hpp", "graph.hpp", "loading", "describe", "character.hpp",
            "clip", "conformance", "table", "meshopt", "single_rules",
        ),
    ),
}  # fmt: skip

SWAPS = {
    "<": "<=", "<=": "<", ">": ">=", ">=": ">", "===": "!==", "!==": "===", "==": "!=", "!=": "==",
    "+": "-", "-": "+", "*": "/", "/": "*", "%": "*", "&&": "||", "||": "&&", "+=": "-=", "-=": "+=",
    "and": "or", "or": "and", "true": "false", "false": "true", "min": "max", "max": "min", "Min": "Max",
    "Max": "Min", "minf": "maxf", "maxf": "minf", "break": "continue", "continue": "break",
}  # fmt: skip
SPACED = {"<", "<=", ">", ">=", "===", "!==", "==", "!=", "+", "-", "*", "/", "%", "&&", "||", "+=", "-="}
TOKEN = re.compile(
    r"(?P<number>(?<![\w.])\d+(?:\.\d+)?(?:e-?\d+)?f?(?![\w.]))|(?P<word>[A-Za-z_]\w*)|(?P<sign>[-+*/%<>=!&|?:]+)"
)


@dataclass(frozen=True, order=True)
class Edit:
    """One change. path: of the source, from the runtime's folder. at: the character it stands at."""

    path: str
    at: int
    old: str
    new: str
    line: int = field(compare=False, default=0)
    text: str = field(compare=False, default="")

    def __str__(self) -> str:
        return f"{self.path}:{self.line}: {self.old} -> {self.new}: {self.text}"


def edits(language: Language, folder: Path) -> list[Edit]:
    """Return every change that can be made to a runtime, in order."""
    out: list[Edit] = []
    for path in sorted(folder.rglob(f"*{language.ends}")):
        name = path.relative_to(folder).as_posix()
        if not any(part in name for part in language.left_out):
            out += _of(language, name, path.read_text(encoding="utf-8"))
    return out


def _of(language: Language, name: str, source: str) -> Iterator[Edit]:
    aside = re.compile(f"{language.comments}|{language.texts}", re.DOTALL)
    shown = aside.sub(lambda m: re.sub(r"[^\n]", "\x00", m[0]), source)
    ends = [0, *(m.end() for m in re.finditer("\n", source))]
    for row, start in enumerate(ends):
        line = shown[start : ends[row + 1] if row + 1 < len(ends) else len(shown)]
        if re.search(language.silent, line):
            continue
        for token in TOKEN.finditer(line):
            new = _instead(token, line)
            if new is not None:
                text = source[start : start + len(line)].strip()
                yield Edit(name, start + token.start(), token[0], new, row + 1, text[:140])


def _instead(token: re.Match[str], line: str) -> str | None:
    """Return what a token becomes; None if it stays."""
    old, before, after = token[0], line[: token.start()], line[token.end() :]
    if token["number"]:
        number = float(old.rstrip("f"))
        if "." not in old and "e" not in old:
            return str(int(number) + 1)
        end = "f" if old.endswith("f") else ""
        if 0 < number < 1e-3:
            return None
        return f"{number * 1.1 if number else 0.1:.6g}{end}"
    if old not in SWAPS:
        return None
    if old in SPACED:
        spaced = before.endswith(" ") and after.startswith(" ")
        beside_text = "\x00" in before.rstrip()[-1:] or "\x00" in after.lstrip()[:1]
        return SWAPS[old] if spaced and not (beside_text and old in "+-*/%") else None
    if old in ("min", "max", "Min", "Max", "minf", "maxf"):
        return SWAPS[old] if after.startswith("(") else None
    return SWAPS[old]


def apply(edit: Edit, folder: Path) -> str:
    """Make a change in a copy of a runtime; return what stood in the file before."""
    path = folder / edit.path
    source = path.read_text(encoding="utf-8")
    assert source[edit.at :].startswith(edit.old)
    path.write_text(source[: edit.at] + edit.new + source[edit.at + len(edit.old) :], encoding="utf-8")
    return source


# --- running


class NodeRunner:
    """One process of Node that runs changed copies of the JavaScript runtime; a new one after each that goes
    round for ever.
    """

    def __init__(self, scratch: Path) -> None:
        self.scratch = scratch
        self.count = 0
        self.process: subprocess.Popen[bytes] | None = None

    def notices(self, edit: Edit | None) -> str:
        """Return how vectors notice a change: "" if they do not."""
        self.count += 1
        folder = self.scratch / f"runtime{self.count}"
        shutil.copytree(RUNTIMES / "javascript", folder)
        if edit is not None:
            apply(edit, folder)
        if self.process is None:
            script = Path(__file__).parent / "run" / "mutants.mjs"
            self.process = subprocess.Popen(
                ["node", str(script)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
            )
        assert self.process.stdin is not None and self.process.stdout is not None
        asked = {"runtime": str(folder), "folders": [str(f) for f in vector_folders()]}
        self.process.stdin.write(json.dumps(asked).encode() + b"\n")
        self.process.stdin.flush()
        ready, _, _ = select.select([self.process.stdout], [], [], SECONDS)
        line = self.process.stdout.readline() if ready else b""
        shutil.rmtree(folder)
        if not line or self.count % 50 == 0:  # modules are never let go
            self.close()
        if not line:
            return "goes round for ever, or ends the process"
        said = json.loads(line)
        return str(said["fault"] or said["difference"])

    def close(self) -> None:
        if self.process is not None:
            self.process.kill()
            self.process.communicate()
            self.process = None


class CommandRunner:
    """Runs a changed copy of a runtime by commands, one after another, in one folder."""

    def __init__(self, scratch: Path, language: str) -> None:
        self.language = language
        self.folder = scratch / "game"
        self.runtime = self.folder / "runtime"
        source = RUNTIMES / LANGUAGES[language].folder
        if language == "gdscript":
            self.runtime = self.folder / "addons" / "metagraph"
            self.folder.mkdir()
            (self.folder / "project.godot").write_text(
                'config_version=4\n\n[application]\n\nconfig/name="test"\n'
            )
        shutil.copytree(source, self.runtime)
        if language == "gdscript":
            shutil.copytree(GODOT3, self.folder / "addons", dirs_exist_ok=True)

    def notices(self, edit: Edit | None) -> str:
        """Return how vectors notice a change: "" if they do not."""
        before = apply(edit, self.runtime) if edit is not None else ""
        try:
            for command in self._commands():
                code, said = self._run(command)
                if code:
                    return said.strip()[-200:] or f"ends with {code}"
            return ""
        finally:
            if edit is not None:
                (self.runtime / edit.path).write_text(before, encoding="utf-8")

    def _commands(self) -> list[list[str]]:
        """The folder that notices most comes first, so that most changes cost a tenth of all vectors."""
        every = vector_folders()
        parts = [[str(f) for f in part] for part in (every[:1], every[1:]) if part]
        if self.language == "csharp":
            sources = [
                str(p) for part in ("Runtime/Core", "Tests") for p in (self.runtime / part).rglob("*.cs")
            ]
            program = str(self.folder / "conformance.exe")
            compiler = ["mcs", "-langversion:7.2", "-nowarn:0162,0219,0414,0168,1717,1718", f"-out:{program}"]
            return [[*compiler, *sources], *(["mono", program, *part] for part in parts)]
        if self.language == "gdscript":
            engine = ["godot3-server", "--no-window", "--path", str(self.folder), "-s"]
            return [[*engine, "addons/metagraph/conformance.gd", *part] for part in parts]
        program = str(self.folder / "conformance")
        compiler = ["g++", "-std=c++17", "-O0", "-w", "-o", program, str(self.runtime / "conformance.cpp")]
        return [compiler, *([program, *part] for part in parts)]

    def _run(self, command: list[str]) -> tuple[int, str]:
        process = subprocess.Popen(
            command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            errors="replace", start_new_session=True,
        )  # fmt: skip
        try:
            said, _ = process.communicate(timeout=4 * SECONDS)
        except subprocess.TimeoutExpired:
            said = "goes round for ever"
            return 1, said
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        return process.returncode, said

    def close(self) -> None:
        pass


def vector_folders() -> list[Path]:
    """Return all folders, the one that notices most first."""
    return sorted((p for p in VECTORS.iterdir() if p.is_dir()), key=lambda p: (p.name != "stick", p.name))


def runner(language: str, scratch: Path) -> NodeRunner | CommandRunner:
    """Return what runs a language's mutants."""
    return NodeRunner(scratch) if language == "javascript" else CommandRunner(scratch, language)


def main(words: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("language", choices=[*LANGUAGES])
    parser.add_argument("--count", type=int, default=400, help="how many are drawn of all there are")
    parser.add_argument("--seed", type=int, default=1, help="of the draw")
    parser.add_argument("--minutes", type=float, default=1e9, help="to stop after, in the middle of the draw")
    parser.add_argument("--only", default="", help="part of the paths of sources to change")
    parser.add_argument("--out", type=Path, help="a file the survivors are written to, as JSON")
    parser.add_argument("--again", type=Path, help="such a file: try those alone")
    asked = parser.parse_args(words)
    language = LANGUAGES[asked.language]
    every = [e for e in edits(language, RUNTIMES / language.folder) if asked.only in e.path]
    if asked.again:
        known = {(p, text, old) for p, text, old in json.loads(asked.again.read_text())}
        drawn = [e for e in every if (e.path, e.text, e.old) in known]
    else:
        drawn = random.Random(asked.seed).sample(every, min(asked.count, len(every)))
    alive: list[Edit] = []
    tried = 0
    dead: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as scratch:
        running = runner(asked.language, Path(scratch))
        try:
            said = running.notices(None)
            assert said == "", f"the vectors do not hold before anything is changed: {said}"
            begun = time.monotonic()
            for edit in drawn:  # in the order they were drawn: those tried until any time are a fair share
                if time.monotonic() - begun > 60 * asked.minutes:
                    break
                tried += 1
                if running.notices(edit):
                    dead[edit.path] += 1
                else:
                    alive.append(edit)
                    print(f"lives: {edit}", flush=True)
        finally:
            running.close()
    total = tried
    print(f"\n{total} of {len(every)} changes tried in {time.monotonic() - begun:.0f} s")
    lived = Counter(e.path for e in alive)
    for path in sorted(dead | lived):
        print(f"  {path}: {dead[path]} of {dead[path] + lived[path]} noticed")
    print(
        f"{asked.language}: {total - len(alive)} of {total} noticed, {(1 - len(alive) / max(1, total)):.1%}"
    )
    if asked.out:
        asked.out.write_text(json.dumps([(e.path, e.text, e.old) for e in alive], indent=1))


if __name__ == "__main__":
    main()
