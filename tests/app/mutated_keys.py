#!/usr/bin/env python3
"""Every key of every example deck, given a wrong value: a clean error or a valid run.

    mutated_keys.py WHIRL EXAMPLES                 a sample, quick
    mutated_keys.py WHIRL EXAMPLES --whole [N]     all of them through `whirl check`; of those it passes, every
                                                   N-th through `whirl run` (30)
    mutated_keys.py WHIRL EXAMPLES --only TEXT     of the sample or the whole: decks with TEXT in their path
    mutated_keys.py WHIRL EXAMPLES --seconds N     no mutant begins later: for a program that sanitizers slow down
                                                   (with WHIRL_NO_MEMORY_LIMIT=1); runs have 10 s instead of 20
    ... --set KEY=VALUE                            for every run

A fault is a crash, exit code 1, an error without a code or without anything said, a run that does not stop within
seconds of Ctrl-C, more memory than 4 GB, and numbers in a table that are none though nothing says what that means. Each
is a line with the deck, the key and the value; exit code 1 with any.
"""
import argparse
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import zlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

# what stands instead of the value; a function: of what stood there
VALUES = ['""', "[]", "{}", "0", "-1", '"x"', "1e300", "true", "[[]]", '"nan"', '"-1 mm"',
          lambda v: re.sub(r"(\d)", r"\g<1>000", v, count=1),   # a thousand times too large, or so
          lambda v: re.sub(r"\d+(\.\d+)?", "0", v),             # nothing
          lambda v: re.sub(r"(?<![\w.])(\d)", r"-\g<1>", v),    # the other sign
          lambda v: v.rstrip('"') + 'q"' if v.endswith('"') else v + "q",
          None]                                                 # the key is not there
SAMPLE_CHECKS, SAMPLE_RUNS = 72, 6
SECONDS, GRACE, MEMORY = 20, 30, 4 << 30
KEY = re.compile(r"^(\s*)([A-Za-z_][\w.-]*|\"[^\"]*\")(\s*=\s*)(.+?)(\s*(?:#.*)?)$")


def keys_of(lines):
    """Numbers of the lines that give a key its value there."""
    inside = 0   # of brackets over several lines
    for n, line in enumerate(lines):
        bare = re.sub(r'"[^"]*"', '""', line).split("#")[0]
        if inside == 0 and KEY.match(line):
            yield n
        if inside or not bare.lstrip().startswith("["):
            inside += bare.count("[") + bare.count("{") - bare.count("]") - bare.count("}")


def mutants_of(deck):
    lines = deck.read_text().split("\n")
    for n in keys_of(lines):
        space, key, equal, value, rest = KEY.match(lines[n]).groups()
        for k, v in enumerate(VALUES):
            new = None if v is None else v(value) if callable(v) else v
            if new == value:
                continue
            changed = list(lines)
            changed[n] = "" if new is None else f"{space}{key}{equal}{new}{rest}"
            what = f"line {n + 1}: {key} = {'(nothing)' if new is None else new}"
            yield what, "\n".join(changed), zlib.crc32(f"{deck.parent.name} {n} {k}".encode())


def limits():
    # sanitizers reserve address space by the terabyte
    if not os.environ.get("WHIRL_NO_MEMORY_LIMIT"):
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def call(command, folder):
    """(exit code, output, whether it was asked to stop); the code is None where it did not stop."""
    with subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          errors="replace", preexec_fn=limits) as process:
        asked = False
        for seconds in (SECONDS, GRACE):
            try:
                output = process.communicate(timeout=seconds)[0]
                return process.returncode, output, asked
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGINT)
                asked = True
        process.kill()
        process.communicate()
        return None, "", asked


def trouble(command, folder):
    """(nothing when all is well, whether the deck was taken)."""
    code, output, stopped = call(command, folder)
    if code is None:
        return f"does not stop: {SECONDS} s, and {GRACE} s after Ctrl-C", False
    if "Sanitizer" in output or "runtime error:" in output:
        return f"sanitizer: {output[-4000:]}", False
    if code not in (0, 2, 3, 4, 5) and not (code == 130 and stopped):
        return f"exit code {code}: {output[-2000:]}", False
    # exit code 4 may stand for a warning that a list is not complete
    said = re.search(r"error\[[A-Z]\d\d\]: \S", output) or (code == 4 and "warning[" in output)
    if code not in (0, 130) and not said:
        return f"exit code {code} and no error with a code: {output[-2000:]}", False
    return "", code == 0


def not_finite(results):
    """What the run says of numbers that are none."""
    summary = results / "summary.json"
    found = re.search(r'"[^"]* not finite [^"]*"', summary.read_text()) if summary.exists() else None
    return found[0] if found else ""


def try_one(whirl, also, deck, what, text, run):
    with tempfile.TemporaryDirectory(prefix="whirl_mutant_") as folder:
        work = Path(folder) / deck.parent.name
        shutil.copytree(deck.parent, work, ignore=shutil.ignore_patterns("results*", "*.svg", "*.png"))
        (work / "deck.toml").write_text(text)
        bad, taken = trouble([whirl, "check", "deck.toml", *also], work)
        if not bad and taken and run:
            out = Path(folder) / "out"
            bad, _ = trouble([whirl, "run", "deck.toml", "--quiet", "--jobs", "1", "--output", str(out), *also], work)
            bad = bad or not_finite(out)
        if what == "as it stands" and not taken:
            bad = "refused"
        return f"{deck.parent.name}: {what}: {bad}" if bad else "", taken


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("whirl")
    parser.add_argument("examples", type=Path)
    parser.add_argument("--whole", nargs="?", const=30, type=int)
    parser.add_argument("--only", default="")
    parser.add_argument("--seconds", type=float)
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    a = parser.parse_args()
    decks = [d for d in sorted(a.examples.glob("*/deck.toml")) if a.only in str(d)]
    if not decks:
        raise SystemExit(f"no decks in {a.examples}")
    work = []
    for deck in decks:
        mutants = sorted(mutants_of(deck), key=lambda m: m[2])
        if a.whole is None:
            per_deck = max(1, SAMPLE_CHECKS // len(decks))
            work += [(deck, *m[:2], False) for m in mutants[:per_deck]]
        else:
            work += [(deck, *m[:2], m[2] % a.whole == 0) for m in mutants]
    if a.whole is None:   # runs: of quick decks
        quick = [d for d in decks if d.parent.name[:2] in ("01", "08", "30", "06", "13", "26")]
        for k, deck in enumerate(quick[:SAMPLE_RUNS]):
            m = sorted(mutants_of(deck), key=lambda m: m[2])[-1 - k]
            work.append((deck, *m[:2], True))
    # as it stands each deck has to be taken, or nothing is tested
    work += [(deck, "as it stands", deck.read_text(), False) for deck in decks]
    whirl = str(Path(a.whirl).resolve())
    also = [part for value in a.set for part in ("--set", value)]
    if a.seconds is not None:   # the same order each time, all decks and runs mixed
        work.sort(key=lambda w: zlib.crc32(f"{w[0].parent.name} {w[1]}".encode()))
        global SECONDS
        SECONDS = 10
    end = time.monotonic() + (a.seconds or float("inf"))

    def in_time(w):
        return try_one(whirl, also, *w) if time.monotonic() < end else None

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = list(pool.map(in_time, work))
    if None in found:
        print(f"{found.count(None)} of {len(work)} left out for time")
        work = [w for w, f in zip(work, found) if f]
        found = [f for f in found if f]
        decks = [w[0] for w in work if w[1] == "as it stands"]
    if not found:
        raise SystemExit("nothing was tried")
    faults = [f for f, _ in found if f]
    print(f"{len(work) - len(decks)} mutants of {len(decks)} decks: {sum(t for _, t in found) - len(decks)} taken, "
          f"{sum(w[3] for w in work)} of them run if taken, {len(faults)} faults")
    for f in faults:
        print(f)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
