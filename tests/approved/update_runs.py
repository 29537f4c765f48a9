#!/usr/bin/env python3
"""Approves what the decks of the tests write today (tests/app/approved_runs.hpp): look at git diff before it is committed.

    update_runs.py BUILD [SUITE...]     all suites whose tests run decks, or these: KeysMatter SupportRuns

Runs the tests with the instructions of this machine and once more with those that all have. What differs between the runs by more than half
of what a comparison allows is written as "~": it only has to be there. Decks that are not the same in every
run (paths of temporary folders, seeds of the day) and suites that depend on the machine are left out.
"""
import collections
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

RUNS = Path(__file__).resolve().parent / "runs"
SETS = ("", "baseline")
LEFT_OUT = re.compile("MemoryLimits|ResultsFolder|Resume|Jobs|Sweep")  # what the machine has, and when a run is stopped


def run_tests(build, suites, kept, instruction_set):
    chosen = "|".join(suites) if suites else "."
    environment = {**os.environ, "WHIRL_APPROVED_RUNS_TO": kept}
    if instruction_set:
        environment["WHIRL_ISA"] = instruction_set
    command = ["ctest", "-j", str(os.cpu_count()), "-LE", "hours", "-R", rf"^(app|validation)\.({chosen})", "--timeout", "900"]
    done = subprocess.run(command, cwd=build, env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        print(f"{instruction_set or 'native'}:", *done.stdout.split("The following tests FAILED:")[1:])


def read(kept):
    """{suite: {deck: [{file: words}, ...]}}, a list of the runs of one deck."""
    found = collections.defaultdict(lambda: collections.defaultdict(list))
    for path in sorted(Path(kept).iterdir()):
        suite = path.stem.rsplit("-", 1)[0]
        for line in path.read_text().splitlines():
            if line.startswith("deck "):
                parts = {}
                found[suite][line.split()[1]].append(parts)
            else:
                words = line.split(" ")
                parts[words[0]] = words
    return found


def one_of(lines):
    """A line that all of these agree with."""
    first = lines[0]
    if any(len(line) != len(first) for line in lines):
        common = min(map(len, lines))
        return [*one_of([line[:common] for line in lines]), "*"]
    out = [first[0], "~" if any(line[1] != first[1] for line in lines) else first[1], first[2]]
    half = 5.0 if int(first[2]) > 50 else 2.5
    for values in zip(*(line[3:] for line in lines)):
        numbers = [float(v) for v in values]
        out.append(values[0] if max(numbers) - min(numbers) <= half else "~")
    return out


def merge(runs):
    """Lines of a deck, or None where its runs do not write the same files."""
    if any(run.keys() != runs[0].keys() for run in runs):
        return None
    return [" ".join(one_of([run[name] for run in runs])) for name in runs[0]]


def main():
    build, suites = Path(sys.argv[1]), sys.argv[2:]
    RUNS.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        sets = []
        for name in SETS:
            kept = Path(folder) / (name or "native")
            kept.mkdir()
            run_tests(build, suites, str(kept), name)
            sets.append(read(kept))
        for suite in sorted(set().union(*sets)):
            if LEFT_OUT.search(suite) or suites and not any(re.match(s, suite) for s in suites):
                continue
            lines = ["# What decks of this suite write: see tests/app/approved_runs.hpp"]
            for deck in sorted(set.intersection(*(set(s[suite]) for s in sets))):
                merged = merge([run for s in sets for run in s[suite][deck]])
                if merged:
                    lines += [f"deck {deck}", *merged]
            if len(lines) > 1:
                (RUNS / f"{suite}.txt").write_text("\n".join(lines) + "\n")


main()
