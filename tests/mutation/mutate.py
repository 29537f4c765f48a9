#!/usr/bin/env python3
"""Seeds single faults into a copy of the sources and counts which the tests notice.

One build holds all faults of the samples, each behind a run-time switch (mutation_switch.hpp); a
traced run of every test says which sites it reaches; a fault meets only the tests that reach it,
quickest first, until one fails. CONTRIBUTING.md says how to use it.

    mutate.py build --seed 1 --seed 2 --count 400     # instrumented copy, in build/mutation
    mutate.py trace                                   # which test reaches which site
    mutate.py run --seed 1                            # goes on where it stopped
    mutate.py report --seed 1 [--survivors]
    mutate.py tests                                   # after editing tests: build and trace them
    mutate.py list --folder elements/films            # sites, nothing is built
    mutate.py build --given                           # faults that once passed, of given.toml: sample 'given'
"""
import argparse
import collections
import concurrent.futures
import json
import mmap
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import threading
import time
import tomllib
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import sites as seeding

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ["elements", "meshes", "src/system", "src/assembly", "src/analysis", "src/time", "src/la", "src/deck", "src/results",
           "src/steps", "src/io", "src/plot", "src/core", "src/model", "src/run", "src/study", "src/sweep", "src/convert", "src/app"]
LEFT_OUT = re.compile(r"error_catalogue|core/plugin|core/version|lu_dispatch|_avx|_base\.cpp|"
                      r"visitor_overrides|spin\.inl")  # those two stand in headers: every test would be built anew
TESTS_LEFT_OUT = re.compile(r"^(packaging|docs\.(?!deck_reference)|structure)|linkage|instruction_set|add_a_bearing|NOT_BUILT|MutatedDecks")
LIMIT_SITES = 20000


# ---- sites and samples ----

def all_sites(root, folders):
    out = []
    for folder in folders:
        for path in sorted((root / folder).rglob("*")) if (root / folder).is_dir() else [root / folder]:
            name = str(path.relative_to(root))
            if path.suffix in (".cpp", ".inl") and not LEFT_OUT.search(name):
                out += seeding.sites_of(name, path.read_text())
    return out


def sample(found, seed, count, taken=()):
    """Spread: files and operators weigh as the square root of their sites."""
    rng = random.Random(seed)
    by = collections.defaultdict(lambda: collections.defaultdict(list))
    for s in found:
        by[s.file][s.operator].append(s)
    for operators in by.values():
        for group in operators.values():
            rng.shuffle(group)
    chosen, clash = [], collections.defaultdict(list)
    for s in taken:
        clash[s.file].append(s)
    root = lambda n: n ** 0.5
    files = sorted(by)
    weights = [root(sum(map(len, by[f].values()))) for f in files]
    tries = 0
    while len(chosen) < count and tries < 50 * count:
        tries += 1
        f = rng.choices(files, weights)[0]
        operators = sorted(o for o in by[f] if by[f][o])
        if not operators:
            continue
        s = by[f][rng.choices(operators, [root(len(by[f][o])) for o in operators])[0]].pop()
        if any(s.name == t.name or seeding.clash(s, t) for t in clash[f]):
            continue
        clash[f].append(s)
        chosen.append(s)
    return chosen


def given_sites():
    """Of given.toml: faults that were noticed late, sample 'given'."""
    faults = tomllib.loads(Path(__file__).with_name("given.toml").read_text())["fault"]
    return [seeding.given_site((ROOT / f["file"]).read_text(), f) for f in faults]


# ---- the instrumented copy ----

class Work:
    def __init__(self, folder, flags):
        self.folder = Path(folder).resolve()
        self.tree = (self.folder / "tree").resolve()  # may be a link to a copy that has its tests built
        self.build = self.tree / "build" / "release"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.flags = flags
        self.lock = threading.Lock()

    def load(self, name, default):
        p = self.folder / name
        return json.loads(p.read_text()) if p.exists() else default

    def save(self, name, data):
        p = self.folder / name
        with self.lock:
            new = p.with_suffix(".new")
            new.write_text(json.dumps(data, indent=1))
            new.rename(p)


def is_instrumented(name):
    return name.endswith((".cpp", ".inl")) and any(name.startswith(f + "/") for f in FOLDERS)


def switch_of(work):
    return work.tree / "tests" / "mutation" / "mutation_switch.hpp"


def copy_files(work, under=""):
    """What git knows of the working tree, only files that changed; not those that are instrumented."""
    names = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", *([under] if under else [])],
                           cwd=ROOT, capture_output=True, check=True).stdout.decode().split("\0")
    for name in filter(None, names):
        source, target = ROOT / name, work.tree / name
        if not source.is_file() or is_instrumented(name):
            continue
        data = source.read_bytes()
        if name == "src/CMakeLists.txt":
            data = f'set(CMAKE_CXX_FLAGS_RELEASE "{work.flags}")\n'.encode() + data
        if name.startswith("tests/") and name.endswith(".cpp") and b".inl>" in data:
            data = seeding.instrumented(data.decode(), {}, switch_of(work)).encode()
        if not target.exists() or target.read_bytes() != data:
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(data)
            shutil.copymode(source, target)


def write_instrumented(work, chosen):
    """chosen: {number: site}. Every unit of the folders gets the switch, so that .inl files find it."""
    by_file = collections.defaultdict(dict)
    for number, s in chosen.items():
        by_file[s.file][number] = s
    for folder in FOLDERS:
        for path in (ROOT / folder).rglob("*"):
            name = str(path.relative_to(ROOT))
            if not is_instrumented(name):
                continue
            switch = switch_of(work) if path.suffix == ".cpp" and not path.name.endswith("version.cpp") else None
            text = seeding.instrumented(path.read_text(), by_file.get(name, {}), switch)
            target = work.tree / name
            if not target.exists() or target.read_text() != text:
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_text(text)


def compile_tree(work, jobs, targets):
    command = ["ninja", "-C", str(work.build), "-k", "0", f"-j{jobs}", *targets]
    return subprocess.run(command, capture_output=True, text=True)


def faulty_lines(log, work):
    """(file, line) of what the compiler refused, with where templates were called from."""
    out, context = set(), []
    for line in log.split("\n"):
        if line.startswith(("FAILED", "[")):
            context = []
        m = re.match(r"(?:In file included from )?(\S+?):(\d+):\d*:?\s*(.*)", line)
        path = Path(os.path.normpath(work.build / m.group(1))) if m else work.build
        if not m or not path.is_relative_to(work.tree):
            continue
        place = (str(path.relative_to(work.tree)), int(m.group(2)))
        if re.match(r"(fatal )?error:", m.group(3)):
            out.add(place)
            out.update(context)
            context = []
        elif "required from" in m.group(3):
            context.append(place)
        elif not m.group(3).startswith("note"):
            context = context if "In " in m.group(3) else []
    return out


def build(work, options):
    found = all_sites(ROOT, options.folder or FOLDERS)
    dropped = set(work.load("dropped.json", []))
    given = given_sites() if options.given else []
    chosen, samples = [], {}
    for seed in options.seed or []:
        part = sample([s for s in found if s.name not in dropped], seed, options.count, given + chosen)
        samples[str(seed)] = [s.name for s in part]
        chosen += part
    if given:
        samples["given"] = [s.name for s in given]
        chosen += given
    chosen = dict(enumerate(chosen, start=1))
    assert len(chosen) < LIMIT_SITES
    copy_files(work)
    write_instrumented(work, chosen)  # before the configuration, which lists the sources of each folder
    if not (work.build / "build.ninja").exists():
        subprocess.run(["cmake", "--preset", "release", "-DWHIRL_BUILD_TESTS=ON", *options.cmake], cwd=work.tree, check=True,
                       stdout=subprocess.DEVNULL)
    targets = options.target or ["whirl", *test_programs(work)]
    while True:
        write_instrumented(work, chosen)
        done = compile_tree(work, options.jobs, targets)
        (work.folder / "build.log").write_text(done.stdout + done.stderr)
        if done.returncode == 0:
            break
        bad = faulty_lines(done.stdout, work)
        drop = [k for k, s in chosen.items() if (s.file, s.line) in bad]
        if not drop:  # a statement has several lines, and the compiler names one of them
            drop = [k for k, s in chosen.items() if any(f == s.file and abs(n - s.line) <= 4 for f, n in bad)]
        if not drop:
            sys.exit(f"the build fails for another reason: {work.folder}/build.log")
        print(f"{len(drop)} sites do not compile", flush=True)
        for k in drop:
            dropped.add(chosen.pop(k).name)
        work.save("dropped.json", sorted(dropped))
    names = {s.name for s in chosen.values()}
    work.save("sites.json", {"samples": {k: [n for n in v if n in names] for k, v in samples.items()},
                             "sites": {str(k): {"name": s.name, "file": s.file, "line": s.line, "operator": s.operator,
                                                "text": s.text} for k, s in chosen.items()}})
    for gone in ("trace", "results.json"):
        p = work.folder / gone
        shutil.rmtree(p) if p.is_dir() else p.unlink(missing_ok=True)
    print(f"{len(chosen)} sites built in, {len(dropped)} do not compile")


def test_programs(work):
    folders = re.findall(r"^ *whirl_tests\((\w+)", (work.tree / "tests" / "CMakeLists.txt").read_text(), re.M)
    return [f"test_{f}" for f in folders]


# ---- tests ----

def list_tests(work):
    text = subprocess.run(["ctest", "--show-only=json-v1"], cwd=work.build, capture_output=True, text=True, check=True).stdout
    out = {}
    for t in json.loads(text)["tests"]:
        if "command" not in t or TESTS_LEFT_OUT.search(t["name"]):
            continue
        p = {x["name"]: x["value"] for x in t.get("properties", [])}
        labels = set(p.get("LABELS", []))
        if {"long", "hours"} & labels and "slow" not in labels:
            continue
        out[t["name"]] = {"command": t["command"], "folder": p.get("WORKING_DIRECTORY", str(work.build)),
                          "environment": dict(e.split("=", 1) for e in p.get("ENVIRONMENT", []))}
    return out


def cost_of(work):
    """{test: seconds}, as ctest remembers them; what it has not run yet costs nothing."""
    path = work.build / "Testing" / "Temporary" / "CTestCostData.txt"
    rows = [line.split(" ") for line in path.read_text().split("\n")] if path.exists() else []
    return {r[0]: float(r[2]) for r in rows if len(r) == 3}


def limited(seconds):
    def set_limits():
        os.setsid()
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 3))
        resource.setrlimit(resource.RLIMIT_AS, (6 << 30, 6 << 30))
        resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 30, 1 << 30))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    return set_limits


def execute(command, test, extra, scratch, cpu):
    """Exit code (None: out of time) and CPU seconds, wall seconds as a bound of them."""
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir(parents=True)
    environment = {**os.environ, **test["environment"], **extra, "TMPDIR": str(scratch)}
    if "WHIRL_VALIDATION_DIR" in environment:
        environment["WHIRL_VALIDATION_DIR"] = str(scratch)
    start = time.monotonic()
    p = subprocess.Popen(command, cwd=test["folder"], env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                         stderr=subprocess.STDOUT, preexec_fn=limited(cpu))
    try:
        out = p.communicate(timeout=20 + 8 * cpu)[0]
        code = p.returncode
    except subprocess.TimeoutExpired:
        os.killpg(p.pid, signal.SIGKILL)
        out, code = p.communicate()[0], None
    return code, time.monotonic() - start, out.decode(errors="replace")


def trace(work, options):
    """Every test once: what it reaches, how long it takes, whether it passes at all."""
    data = work.load("sites.json", None) or sys.exit("build first")
    folder = work.folder / "trace"
    folder.mkdir(exist_ok=True)
    known = work.load("trace/tests.json", {})
    again = re.compile(options.again) if options.again else None
    cost = cost_of(work) if options.quick else {}
    todo = {n: t for n, t in list_tests(work).items()
            if re.search(options.suites, n) and (n not in known or (again and again.search(n)))
            and cost.get(n, 0.0) <= (options.quick or 0.0)}
    numbers = [int(k) for k in data["sites"]]
    done = 0

    def one(item):
        name, test = item
        mine = folder / f"{threading.get_ident()}.bytes"
        mine.write_bytes(bytes(2 * LIMIT_SITES))
        code, seconds, text = execute(test["command"], test, {"WHIRL_MUTANT_TRACE": str(mine)},
                                      work.folder / "scratch" / str(threading.get_ident()), 600)
        hit = mine.read_bytes()
        mine.unlink()
        return name, {"seconds": round(seconds, 3), "passes": code == 0, "reaches": [k for k in numbers if hit[k]],
                      "void": [k for k in numbers if hit[LIMIT_SITES + k]], "said": "" if code == 0 else text[-2000:]}

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for name, row in pool.map(one, sorted(todo.items())):
            known[name] = row
            done += 1
            if done % 100 == 0:
                work.save("trace/tests.json", known)
                print(f"{done} of {len(todo)} tests traced", flush=True)
    work.save("trace/tests.json", known)
    failing = [n for n, r in known.items() if not r["passes"]]
    reached = {k for r in known.values() if r["passes"] for k in r["reaches"]}
    print(f"{len(known)} tests, {len(reached)} of {len(numbers)} sites reached; without a fault fail: {', '.join(failing) or 'none'}")


# ---- faults against tests ----

def batches(names, tests, traced, heat):
    """Lists of tests to run in one go, quickest first: the quick ones of one program together."""
    quick, out = collections.defaultdict(list), []
    for n in names:
        if traced[n]["seconds"] < 0.4 and any(a.startswith("--gtest_filter=") for a in tests[n]["command"]):
            quick[tests[n]["command"][0]].append(n)
        else:
            out.append([n])
    for group in quick.values():
        group.sort(key=lambda n: (-heat[n], traced[n]["seconds"]))
        size = 40
        out += [group[i:i + size] for i in range(0, len(group), size)]
    cost = lambda g: sum(traced[n]["seconds"] for n in g) + 0.02
    return sorted(out, key=lambda g: cost(g) / (1 + sum(heat[n] for n in g)))


def command_of(group, tests):
    command = list(tests[group[0]]["command"])
    if len(group) == 1:
        return command
    wanted = [a.split("=", 1)[1] for n in group for a in tests[n]["command"] if a.startswith("--gtest_filter=")]
    return [command[0], "--gtest_filter=" + ":".join(wanted), "--gtest_fail_fast", "--gtest_also_run_disabled_tests"]


def run(work, options):
    data = work.load("sites.json", None) or sys.exit("build first")
    traced = {n: r for n, r in work.load("trace/tests.json", {}).items() if r["passes"]} or sys.exit("trace first")
    tests = {n: t for n, t in list_tests(work).items() if n in traced and re.search(options.suites, n)}
    results = work.load("results.json", {})
    again = re.compile(options.again) if options.again else None
    number = {s["name"]: int(k) for k, s in data["sites"].items()}
    void = {k for r in traced.values() for k in r["void"]}
    reaching = collections.defaultdict(list)
    for n, r in traced.items():
        if n in tests:
            for k in r["reaches"]:
                reaching[k].append(n)
    wanted = [n for seed in (options.seed or data["samples"]) for n in data["samples"][str(seed)]]
    if options.folder:
        wanted = [n for n in wanted if any(n.startswith(f) for f in options.folder)]
    heat = collections.Counter(r["killer"] for r in results.values() if r.get("killer"))
    scratch = threading.local()
    counter, begun = [0], time.monotonic()

    def one(name):
        k = number[name]
        old = results.get(name, {})
        if k in void:
            return name, {"outcome": "void"}
        if old.get("outcome") == "killed":
            return name, old
        seen = {n for n in old.get("tests", []) if not (again and again.search(n))}
        names = [n for n in reaching[k] if n not in seen]
        if not reaching[k]:
            return name, {"outcome": "not reached", "tests": []}
        if options.until and time.time() > options.until:
            return name, old
        start = time.monotonic()
        where = work.folder / "scratch" / str(threading.get_ident())
        done = list(seen & set(reaching[k]))
        for group in batches(names, tests, traced, heat):
            usual = sum(traced[n]["seconds"] for n in group)
            code, seconds, said = execute(command_of(group, tests), tests[group[0]], {"WHIRL_MUTANT": str(k)}, where, 4 + 5 * usual)
            if code != 0:
                failed = re.findall(r"\[  FAILED  \] ([\w./]+)", said)
                killer = next((n for n in group if failed and n.endswith("." + failed[0])), group[0])
                heat[killer] += 1
                return name, {"outcome": "killed", "killer": killer, "how": "time" if code is None or code == -signal.SIGXCPU else
                              "signal" if code < 0 else "failed", "seconds": round(time.monotonic() - start, 1)}
            done += group
            if options.budget and time.monotonic() - start > options.budget:
                return name, {"outcome": "unfinished", "tests": sorted(done), "seconds": round(time.monotonic() - start, 1)}
        return name, {"outcome": "survived", "tests": sorted(done), "seconds": round(time.monotonic() - start, 1)}

    def keep(item):
        name, row = item
        if not row:
            return
        with work.lock:
            results[name] = row
            counter[0] += 1
            count = counter[0]
        if count % 20 == 0:
            work.save("results.json", dict(results))
            c = collections.Counter(r["outcome"] for r in results.values())
            print(f"{count} of {len(wanted)}, {(time.monotonic() - begun) / 60:.1f} min: {dict(c)}", flush=True)

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for f in concurrent.futures.as_completed([pool.submit(one, n) for n in wanted]):
            keep(f.result())
    work.save("results.json", results)
    report(work, options)


# ---- result ----

def equivalents():
    """{site: reason}: faults that change nothing anyone could see."""
    out = {}
    path = Path(__file__).with_name("equivalent.txt")
    for line in path.read_text().split("\n") if path.exists() else []:
        if line.strip() and not line.startswith("#"):
            site, reason = line.rsplit(" || ", 1)
            out[site.strip()] = reason.strip()
    return out


def interval(k, n):
    """Of the rate k/n, 95 % (Wilson 1927, doi 10.2307/2276774)."""
    z2 = 1.96 ** 2
    middle, half = k + z2 / 2, 1.96 * (k * (n - k) / n + z2 / 4) ** 0.5
    return f"{100 * (middle - half) / (n + z2):.1f} to {100 * (middle + half) / (n + z2):.1f} %"


def report(work, options):
    data, results, same = work.load("sites.json", {}), work.load("results.json", {}), equivalents()
    by_name = {s["name"]: s for s in data["sites"].values()}
    for seed in options.seed or data["samples"]:
        table = collections.defaultdict(collections.Counter)
        rows = []
        for name in data["samples"][str(seed)]:
            r = results.get(name)
            if not r or r["outcome"] == "void":
                continue
            outcome = "equivalent" if name in same and r["outcome"] != "killed" else r["outcome"]
            s = by_name[name]
            for key in (os.path.dirname(s["file"]), "all"):
                table[key][outcome] += 1
            rows.append({**s, "outcome": outcome, **{k: v for k, v in r.items() if k in ("killer", "how", "seconds")}})
        work.save(f"report_{seed}.json", rows)
        print(f"\nseed {seed}\n{'folder':28}{'killed':>8}{'survived':>10}{'not reached':>13}{'unfinished':>12}{'equivalent':>12}{'rate':>8}")
        for key in sorted(table, key=lambda k: (k == "all", k)):
            c = table[key]
            counted = c["killed"] + c["survived"] + c["not reached"] + c["unfinished"]
            rate = f"{100 * c['killed'] / counted:.1f}%" if counted else "-"
            print(f"{key:28}{c['killed']:8}{c['survived']:10}{c['not reached']:13}{c['unfinished']:12}{c['equivalent']:12}{rate:>8}"
                  + (f"  ({interval(c['killed'], counted)}, 95 %)" if key == "all" and counted else ""))
        if options.survivors:
            for r in sorted(rows, key=lambda r: (r["file"], r["line"])):
                if r["outcome"] not in ("killed", "equivalent"):
                    print(f"{r['outcome']:11} {r['file']}:{r['line']}  {r['name'].split(' | ', 1)[1]}")


def tests(work, options):
    copy_files(work, "tests")
    done = compile_tree(work, options.jobs, options.target or ["whirl", *test_programs(work)])
    if done.returncode:
        sys.exit(done.stdout[-6000:])
    trace(work, options)


def main():
    os.nice(max(0, 10 - os.nice(0)))
    p = argparse.ArgumentParser(description=__doc__.split("\n")[0], formatter_class=argparse.RawDescriptionHelpFormatter,
                                epilog=__doc__.split("\n", 1)[1])
    p.add_argument("command", choices=["list", "build", "trace", "run", "report", "tests"])
    p.add_argument("--work", default=ROOT / "build" / "mutation", help="folder of the copy and the results")
    p.add_argument("--seed", type=lambda s: s if s == "given" else int(s), action="append", help="a sample, or 'given'; repeatable")
    p.add_argument("--given", action="store_true", help="build: with the faults of given.toml")
    p.add_argument("--count", type=int, default=400, help="sites of each sample")
    p.add_argument("--folder", action="append", help="sites of this folder or file only; repeatable")
    p.add_argument("--jobs", type=int, default=os.cpu_count())
    p.add_argument("--suites", default=".", help="trace, tests, run: tests whose name matches")
    p.add_argument("--again", help="run, trace, tests: these tests once more though they ran before")
    p.add_argument("--quick", type=float, help="trace, tests: those that took ctest no longer, s; the others later, without this option")
    p.add_argument("--budget", type=float, default=0, help="run: seconds spent on one fault; then 'unfinished', which counts as survived")
    p.add_argument("--until", type=float, default=0, help="run: no new fault after this time (seconds since 1970)")
    p.add_argument("--target", action="append", help="build, tests: only these targets")
    p.add_argument("--cmake", action="append", default=[], help="build: option of the configuration")
    p.add_argument("--flags", default="-O1 -DNDEBUG", help="build: of the sources; tests are optimised as ever")
    p.add_argument("--survivors", action="store_true", help="report: list what no test noticed")
    options = p.parse_args()
    if options.command == "list":
        found = all_sites(ROOT, options.folder or FOLDERS)
        for s in found if not options.seed else sample(found, options.seed[0], options.count):
            print(f"{s.file}:{s.line}: {s.operator}: {s.text}")
        return
    work = Work(options.work, options.flags)
    if options.command == "build" and not options.seed and not options.given:
        options.seed = [1]
    {"build": build, "trace": trace, "run": run, "report": report, "tests": tests}[options.command](work, options)


if __name__ == "__main__":
    main()
