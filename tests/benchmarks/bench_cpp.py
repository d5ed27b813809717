"""What poses and planning cost in C++, C# and Python: one character on three layers, the sample project.

    .venv/bin/python tests/benchmarks/bench_cpp.py [rounds, 7]

Each round times each in turn; printed are medians and how many times as long as C++ the others take. C++ is
compiled with -O2, C# runs on Mono. Poses: one after another, 1/60 s apart, life included or not, of a plan of
a minute. Planning: an hour that the models write, in one go.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import perf_counter

from metagraph.engines.export import export_project
from metagraph.engines.reading import read_export
from metagraph.formats.store import open_project
from metagraph.playback.planner import make_plan
from tests.posing import pose_at

ROOT = Path(__file__).resolve().parents[2]
RUNTIMES = ROOT / "metagraph" / "engines" / "runtimes"
HOUR, MINUTE, FRAMES = 3600.0, 60.0, 3000

CPP = r"""
#include <chrono>
#include <iostream>
#include "conformance.hpp"
using namespace metagraph;
static double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
int main(int, char** words) {
    const std::string json = *conformance::file(words[1]), glb = *conformance::file(words[2]);
    const Loaded loaded = load(json, reinterpret_cast<const std::uint8_t*>(glb.data()), glb.size());
    double sum = 0;
    for (std::string line; std::getline(std::cin, line);) {
        double begun = now();
        const auto hour = hear(*loaded.graph, Plan(3), 0, {}, 3600);
        const double planning = now() - begun;
        Player player(loaded.graph, hear(*loaded.graph, Plan(3), 0, {}, 60));
        double posing[2];
        for (int alive = 0; alive < 2; alive++) {
            begun = now();
            for (int n = 0; n < 3000; n++) sum += player.pose(n / 60.0, alive == 1)[0].translation.y;
            posing[alive] = (now() - begun) / 3000;
        }
        std::cout << "[" << planning << "," << posing[0] << "," << posing[1] << "]" << std::endl;
    }
    return sum == 0;
}
"""

CSHARP = r"""
using System; using System.Diagnostics; using System.Globalization; using System.IO; using Metagraph;
public static class Bench {
    static string R(double x) { return x.ToString("R", CultureInfo.InvariantCulture); }
    public static void Main(string[] words) {
        Graph graph = Graph.Load(File.ReadAllText(words[0]), File.ReadAllBytes(words[1]));
        while (Console.ReadLine() != null) {
            var watch = Stopwatch.StartNew();
            Hearing.Hear(graph, Plan.Empty(3), 0, new Ask[0], 3600);
            double planning = watch.Elapsed.TotalSeconds;
            Plan plan = Hearing.Hear(graph, Plan.Empty(3), 0, new Ask[0], 60);
            var player = new Player(graph); var pose = new BodyPose(graph); var posing = new double[2];
            for (int alive = 0; alive < 2; alive++) {
                watch.Restart();
                for (int n = 0; n < 3000; n++) { player.PoseAt(plan, n / 60.0, alive == 1, pose); }
                posing[alive] = watch.Elapsed.TotalSeconds / 3000;
            }
            Console.WriteLine("[" + R(planning) + "," + R(posing[0]) + "," + R(posing[1]) + "]");
            Console.Out.Flush();
        }
    }
}
"""


def python(path: Path) -> list[float]:
    project = read_export(path, resolved=True)
    begun = perf_counter()
    make_plan(project, HOUR, seed=3)
    planning = perf_counter() - begun
    plan = make_plan(project, MINUTE, seed=3)
    out = [planning]
    for alive in (False, True):
        begun = perf_counter()
        for n in range(0, FRAMES, 10):
            pose_at(plan, project, n / 60, alive=alive)
        out.append((perf_counter() - begun) / (FRAMES // 10))
    return out


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 7
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        sample = open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project
        json_path = export_project(sample, folder / "export").json
        files = [str(json_path), str(json_path.with_suffix(".glb"))]
        source = folder / "bench.cpp"
        source.write_text(CPP)
        subprocess.run(
            ["g++", "-std=c++17", "-O2", f"-I{RUNTIMES / 'cpp'}", str(source), "-o", str(folder / "bench")],
            check=True, timeout=600,
        )  # fmt: skip
        commands = {"C++": [str(folder / "bench"), *files]}
        if shutil.which("mcs"):
            source = folder / "bench.cs"
            source.write_text(CSHARP)
            sources = [source, *sorted((RUNTIMES / "unity" / "Runtime" / "Core").rglob("*.cs"))]
            program = folder / "bench.exe"
            subprocess.run(
                ["mcs", "-langversion:7.2", "-optimize", f"-out:{program}", *map(str, sources)],
                check=True, timeout=600, capture_output=True,
            )  # fmt: skip
            commands["C#"] = ["mono", str(program), *files]
        found: dict[str, list[list[float]]] = {name: [] for name in (*commands, "Python")}
        running = {
            name: subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
            for name, command in commands.items()
        }
        for n in range(rounds + 1):
            for name, process in running.items():
                assert process.stdin and process.stdout
                process.stdin.write("\n")
                process.stdin.flush()
                found[name].append(json.loads(process.stdout.readline()))
            found["Python"].append(python(json_path))
            if n == 0:
                for each in found.values():
                    each.clear()  # warmed up
        for process in running.values():
            assert process.stdin
            process.stdin.close()
            process.wait(10)
    print(f"medians of {rounds} rounds; times as slow as C++ in brackets")
    for place, words in enumerate(("planning an hour, ms", "a pose, us", "a pose with life, us")):
        scale = 1e3 if place == 0 else 1e6
        middle = {name: median(row[place] for row in rows) for name, rows in found.items()}
        told = [f"{name} {x * scale:.1f} ({x / middle['C++']:.1f})" for name, x in middle.items()]
        print(f"{words:24} " + "   ".join(told))


if __name__ == "__main__":
    main()
