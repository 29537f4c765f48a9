"""Follows docs/developer/add_a_bearing_law.md: what the page says is all a new bearing law takes, and what is left out of it does not compile.

usage: add_a_bearing_law.py REPOSITORY BUILD SCRATCH

Applies the blocks of the page to a copy of the sources in SCRATCH, configures it with clang or the compiler of BUILD, shows for every registration that the sources without it do not
compile, builds the program (what knows no law is linked from BUILD) and the tests of the law, runs them, and the deck of the page with its numbers against the closed form. Standard library only.
"""
import csv
import json
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

PAGE = "docs/developer/add_a_bearing_law.md"
LAW = "ElastomerRing"
# They know no bearing law: the new one is linked with those of BUILD as they are.
TAKEN = ["core", "la", "time", "system", "elements", "analysis"]


def blocks(page):
    """(file, how, anchor, text) of every marked block of the page."""
    for mark, text in re.findall(r"^```\w+ (file=[^\n]*)\n(.*?)^```$", page, re.M | re.S):
        file, how, anchor = re.fullmatch(r'file=(\S+) (new|before|replace)(?:="(.*)")?', mark).groups()
        yield file, how, anchor, text


def apply(tree, file, how, anchor, text):
    path = tree / file
    if how == "new":
        assert not path.exists(), f"{file} is there already"
        path.write_text(text)
        return
    lines = path.read_text().splitlines(keepends=True)
    at = [i for i, line in enumerate(lines) if line.strip().startswith(anchor)]
    assert len(at) == 1, f"{file}: {len(at)} lines begin with {anchor!r}"
    lines[at[0]:at[0] + (how == "replace")] = [text]
    path.write_text("".join(lines))


def copy_of_sources(repository, tree):
    def left_out(folder, names):
        here = pathlib.Path(folder)
        if here == repository:
            return {n for n in names if n in ("build", "results", ".git")}
        if here == repository / "tests/elements":   # of the elements' tests the new one is enough
            return {n for n in names if n.startswith("test_")}
        return set()

    shutil.rmtree(tree, ignore_errors=True)
    shutil.copytree(repository, tree, ignore=left_out)


def cached(build, *names):
    """-DNAME=value of the entries that a build is configured with."""
    text = (build / "CMakeCache.txt").read_text()
    return [f"-D{name}={value}" for name, value in re.findall(r"^(\w+):\w+=(.+)$", text, re.M) if name in names]


def quickest_compiler(build):
    """clang, which takes half the time without optimisation and links with what GCC built; or that of BUILD."""
    return shutil.which("clang++") or cached(build, "CMAKE_CXX_COMPILER")[0].partition("=")[2]


def run(*command, **options):
    print("+", shlex.join(map(str, command)), flush=True)
    subprocess.run(command, check=True, **options)


def run_quietly(*command):
    """What it printed is shown only where it fails."""
    print("+", shlex.join(map(str, command)), flush=True)
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        raise SystemExit(done.stdout[-8000:])


def compiles(build, source):
    """Whether a source file of the copy passes the compiler; what it says otherwise."""
    for entry in json.loads((build / "compile_commands.json").read_text()):
        if entry["file"].endswith("/" + source):
            command = re.sub(r"-Xclang -include-pch -Xclang \S+", "", entry["command"])  # the precompiled header is not there yet
            command += f" -I{build.parents[1] / 'cmake'} -fsyntax-only"
            done = subprocess.run(command, shell=True, cwd=entry["directory"], capture_output=True, text=True)
            return done.returncode == 0, done.stderr
    raise SystemExit(f"{source} is not compiled")


# what is left out: (file, text of the block's part) .., and the source that notices
OMISSIONS = [
    ("an answer of the traits", [("src/model/bearing_laws.cpp", "          .gap = false,\n")], "src/model/bearing_laws.cpp"),
    ("the traits", [("src/model/bearing_laws.hpp", f"SupportTraits traits(const {LAW}&);\n"),
                    ("src/model/bearing_laws.cpp", None)], "src/model/bearing_laws.cpp"),
    ("the keys of the deck", [("src/deck/keys/bearing_kinds.hpp", None)], "src/deck/keys/bearings.cpp"),
    ("the way into the system", [("src/assembly/support_parts.hpp", None)], "src/assembly/supports.cpp"),
]


def show_omissions(tree, build, page):
    texts = {file: text for file, how, _, text in page if how == "before"}
    for what, parts, source in OMISSIONS:
        saved = {file: (tree / file).read_text() for file, _ in parts}
        for file, part in parts:
            block = texts[file]
            whole = saved[file]
            assert whole.count(block) == 1, f"{file}: block not found"
            (tree / file).write_text(whole.replace(block, block.replace(part, "") if part else ""))
        ok, said = compiles(build, source)
        for file, text in saved.items():
            (tree / file).write_text(text)
        assert not ok and any(name in said for name in (LAW, "SupportTraits", "field 'gap'")), f"without {what} {source} compiles"
        print(f"without {what}: {source} does not compile", flush=True)


def check_deck(whirl, tree, scratch):
    results = scratch / "results"
    shutil.rmtree(results, ignore_errors=True)
    run(whirl, "run", tree / "elastomer_ring.toml", "--output", results, "--quiet")
    k, s, load = 1e6, 1e-3, 2000.0
    rho = 1e-3                      # k rho (1 + (rho/s)^2) = load
    assert abs(k * rho * (1 + (rho / s) ** 2) - load) < 1e-9
    expected = {"load [N]": load, "eccentricity [m]": rho, "kyy [N/m]": k * (1 + 3 * (rho / s) ** 2), "kzz [N/m]": k * (1 + (rho / s) ** 2)}
    with open(results / "load_coefficients.csv") as file:
        rows = list(csv.DictReader(file))
    assert [row["bearing [-]"] for row in rows] == ["DE", "NDE"], rows
    for row in rows:
        for name, value in expected.items():
            found = float(row[name])
            print(f"{row['bearing [-]']}: {name} = {found:.10g}, closed form {value:.10g}")
            assert abs(found - value) <= 1e-8 * value, name


def main():
    repository, parent, scratch = (pathlib.Path(a).resolve() for a in sys.argv[1:4])
    tree = scratch / "sources"
    build = tree / "build" / parent.name   # as far from the sources as the build it is like: a compiler cache finds its objects
    page = list(blocks((repository / PAGE).read_text()))
    copy_of_sources(repository, tree)
    for block in page:
        apply(tree, *block)
    changed = sorted({file for file, how, _, _ in page if how != "new"})
    new = sorted({file for file, how, _, _ in page if how == "new"})

    # without optimisation: what is built here is run once. Each file by itself until it is seen which of them does not compile.
    run_quietly("cmake", "-S", tree, "-B", build, "-G", "Ninja", "-DWHIRL_BUILD_TESTS=ON", "-DWHIRL_WITH_VTK=OFF", "-DWHIRL_UNITY=0",
        "-DCMAKE_BUILD_TYPE=Plain", "-DCMAKE_CXX_FLAGS_PLAIN=-O0 -DNDEBUG", f"-DWHIRL_BUILT={parent}", f"-DWHIRL_TAKEN={';'.join(TAKEN)}",
        f"-DCMAKE_CXX_COMPILER={quickest_compiler(parent)}", *cached(parent, "CMAKE_CXX_COMPILER_LAUNCHER", "CMAKE_CXX_FLAGS", "WHIRL_WITH_SUNDIALS"))
    show_omissions(tree, build, page)
    run_quietly("cmake", build, "-DWHIRL_UNITY=64")
    run_quietly("cmake", "--build", build, "--target", "test_elements", "test_model", "whirl")
    run(build / "bin/test_elements", "--gtest_brief=1")
    run(build / "bin/test_model", "--gtest_brief=1", "--gtest_filter=*lastomer*:SupportTraitsOf.*")
    check_deck(build / "bin/whirl", tree, scratch)
    reference = subprocess.run([build / "bin/whirl", "schema", "--reference"], check=True, capture_output=True, text=True).stdout
    assert "elastomer_ring" in reference
    run(tree / "tests/packaging/check_includes.sh", tree)
    for kind, files in (("changed", changed), ("new", new)):
        print(f"{len(files)} files {kind}: {', '.join(files)}")
    program = [f for f in changed + new if not f.startswith("tests/") and not f.endswith(".toml")]
    print(f"{len(program)} of them in the program, the rest tests and the deck of the page")


main()
