#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Mutation testing: makes deliberate bugs, one at a time, and lists those that no test detects.

    tests/mutation/run.py [--count N] [--seed S] [--again LIST] [--tests BUILD] [KIT...]

Works in a copy of the last commit, build/mutation/tree. Each mutant changes one operator, number or
order in one line; a kit's mutants are spread over its sources. Each mutant compiles one source and links
one library, into build/mutation/broken, where the test programs find it first; assertions are on, also
the standard library's, as in tests/sanitizers. A kit's programs run in the order of KITS until one fails.
Surviving mutants are listed with their locations: add a test or, if no test could detect one, explain it
in explained.txt. --again repeats the mutants of an earlier output.
"""
import argparse
import json
import os
import random
import re
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HOME = ROOT / "build" / "mutation"
TREE = HOME / "tree"
BUILD = TREE / "build" / "release"
BROKEN = HOME / "broken"
EXPLAINED = Path(__file__).with_name("explained.txt")
# Kit -> its test programs, the most effective and fastest first.
KITS = {
    "osgSkin": ["runtime_test", "serializers_test", "scene_test", "allocation_test", "bindTests"],
    "osgSkinRig": ["runtime_test", "importTests", "bindTests", "system_test"],
    "osgSkinMotion": ["runtime_test", "walk_test", "springs_test", "constraints_test", "live_test"],
    "osgSkinGpu": ["gpu_test --gtest_filter=-OldDriver.*"],
    "osgSkinImport": ["importTests", "system_test"],
    "osgSkinBind": ["bindTests", "system_test"],
    "osgSkinBinder": ["bindTests", "system_test"],
    "osgSkinCharacter": ["system_test"],
}
RULES = [
    (r" < ", " <= "), (r" <= ", " < "), (r" > ", " >= "), (r" >= ", " > "), (r" == ", " != "),
    (r" != ", " == "), (r" && ", " || "), (r" \|\| ", " && "), (r" \+ ", " - "), (r" - ", " + "),
    (r" \* ", " / "), (r" \+= ", " -= "), (r" -= ", " += "), (r"\breturn true;", "return false;"),
    (r"\breturn false;", "return true;"), (r"std::min\b", "std::max"), (r"std::max\b", "std::min"),
    (r"\b0\.5\b", "0.6"), (r"\bstd::lock_guard<std::mutex> lock\(\w+\);", ";"),
    (r"\bcontinue;", "break;"), (r"\+\+(\w+)\)", r"\1 += 2)"), (r"\bif \(!", "if ("),
]
# Messages and declarations, in which these operators have another meaning.
SKIPPED = re.compile(r'^\s*(//|\*|#|using|template|namespace|static_assert)|"|fail|Error|OSG_|operator')


def shell(command, where, timeout=None, **environment):
    running = subprocess.Popen(command, cwd=where, shell=True, env={**os.environ, **environment},
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    try:
        return running.wait(timeout)
    except subprocess.TimeoutExpired:
        os.killpg(running.pid, signal.SIGKILL)  # kills the shell's child, too
        running.wait()
        return 124  # a mutant that hangs counts as detected


def prepare(kits, tests):
    """Builds the copy's libraries, and its test programs unless another build's are used."""
    BROKEN.mkdir(parents=True, exist_ok=True)
    if not TREE.exists():
        # --force: a copy that was deleted by hand is still in git's list.
        shell(f"git worktree add --force --detach '{TREE}'", ROOT)
    shell(f"git checkout --force --detach $(git -C '{ROOT}' rev-parse HEAD)", TREE)
    programs = sorted({test for kit in kits for test in KITS[kit]})
    wanted = kits if tests else [*kits, "osgdb_skin", "osgdb_serializers_osgskin", "osgskinbake",
                                        *(program.split()[0] for program in programs)]
    if shell("cmake --preset release -DOSGSKIN_UNITY=OFF", TREE) or shell(
            f"ninja -C build/release {' '.join(wanted)}", TREE):
        sys.exit("the copy does not build")


def run(program, build, limit, libraries):
    return shell(f"bin/{program} --gtest_brief=1 --gtest_fail_fast", build, limit,
                 LD_LIBRARY_PATH=str(libraries), OSG_LIBRARY_PATH=str(build / "lib"))


def notices(program, build, limits):
    """True if a test of this program fails with the broken library."""
    if program not in limits:
        start = time.monotonic()
        if run(program, build, None, build / "lib"):
            sys.exit(f"{program} fails where nothing is broken")
        limits[program] = 60 + 10 * (time.monotonic() - start)
    return run(program, build, limits[program], BROKEN) != 0


def places(kit, commands):
    """(file, line number, rule) for each line of a kit's sources that a rule matches, alternating files."""
    files = []
    for file in sorted((TREE / "nodekits" / kit / "src").rglob("*.cpp")):
        # Sources that a test program compiles or links itself would be broken in the library only.
        entries = commands.get(str(file), [])
        if len(entries) != 1 or f"/{kit}.dir/" not in entries[0]["command"]:
            continue
        lines = [line for line in enumerate(file.read_text().splitlines()) if not SKIPPED.search(line[1])]
        found = [(file, number, rule) for number, line in lines for rule in RULES if re.search(rule[0], line)]
        random.shuffle(found)
        files.append(found)
    random.shuffle(files)
    for turn in range(max(map(len, files), default=0)):
        yield from (found[turn] for found in files if turn < len(found))


def compile_broken(kit, entry):
    """Compiles a source as it is now and links its library into BROKEN; false if that fails."""
    words = shlex.split(entry["command"])
    made = words[words.index("-o") + 1]
    words[words.index("-o") + 1] = str(BROKEN / "broken.o")
    words += ["-D_GLIBCXX_ASSERTIONS", "-UNDEBUG"]
    if shell(shlex.join(words), entry["directory"]):
        return False
    library = sorted((BUILD / "lib").glob(f"lib{kit}.so.*"), key=lambda path: len(path.name))
    link = subprocess.run(["ninja", "-t", "commands", f"lib/{library[-1].name}"], cwd=BUILD, check=True,
                          capture_output=True, text=True).stdout.splitlines()[-1]
    broken = BROKEN / library[0].name  # under the name that programs link to
    link = re.sub(rf"(?<= ){re.escape(made)}(?= )", str(BROKEN / "broken.o"), link)
    return shell(re.sub(r" -o \S+", f" -o {broken}", link), BUILD) == 0


def explained():
    lines = EXPLAINED.read_text().splitlines() if EXPLAINED.exists() else []
    return {line for line in lines if line and not line.startswith("#") and not line.startswith("    ")}


def chosen(kit, arguments, commands):
    """(file, line number, broken line) for all mutants."""
    random.seed(f"{arguments.seed} {kit}")
    for file, number, (pattern, by) in places(kit, commands):
        lines = file.read_text().splitlines(keepends=True)
        yield file, number, re.sub(pattern, by, lines[number], count=1)


def listed(kit, again):
    """The same for the lines of an earlier run's output."""
    for line in again.read_text().splitlines():
        found = re.search(rf"({kit}/\S+): (.*) -> (.*)", line)
        if not found:
            continue
        file = TREE / "nodekits" / found[1]
        at = [n for n, text in enumerate(file.read_text().splitlines(keepends=True)) if text.strip() == found[2]]
        if at:
            yield file, at[0], found[3] + "\n"
        else:
            print(f"gone: {line}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kits", nargs="*", default=list(KITS))
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--again", type=Path, help="a file of lines that were printed by a run: those mutants "
                        "and no others")
    parser.add_argument("--tests", type=Path, help="a finished build of the same commit, whose test "
                        "programs are run instead of others that take minutes to build")
    arguments = parser.parse_args()
    prepare(arguments.kits, arguments.tests)
    limits = {}
    build = arguments.tests.resolve() if arguments.tests else BUILD
    commands = {}
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        commands.setdefault(entry["file"], []).append(entry)
    noticed, survivors = 0, []
    for kit in arguments.kits:
        wanted = -1 if arguments.again else -(-arguments.count // len(arguments.kits))
        mutants = listed(kit, arguments.again) if arguments.again else chosen(kit, arguments, commands)
        for file, number, broken in mutants:
            if wanted == 0:
                break
            text = file.read_text()
            lines = text.splitlines(keepends=True)
            before = lines[number].strip()
            lines[number] = broken
            place = f"{file.relative_to(TREE / 'nodekits')}: {before} -> {broken.strip()}"
            if place in explained() and not arguments.again:
                continue
            file.write_text("".join(lines))
            compiles = compile_broken(kit, commands[str(file)][0])
            file.write_text(text)
            by = compiles and next((test for test in KITS[kit] if notices(test, build, limits)), None)
            for library in BROKEN.glob("*.so*"):
                library.unlink()
            if not compiles:
                continue
            wanted -= 1
            if by:
                noticed += 1
            else:
                survivors.append(place)
            print(f"{'noticed by ' + by if by else 'SURVIVED'}: {place}", flush=True)
    total = noticed + len(survivors)
    print(f"{noticed} of {total} noticed, {100.0 * noticed / max(1, total):.0f} %")
    return 0 if total and noticed >= 0.9 * total else 1


if __name__ == "__main__":
    sys.exit(main())
