#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""lint.py BUILD [FILE...]: clang-tidy over our sources, or over these; fails on any complaint.

Nine tenths of clang-tidy's time go into headers, so sources are read several to a unit: first those
that are compiled alike, then units that are left small, where their targets' flags agree. Those that
share a name of their own file (by ctags) go into different units, and those that do not compile
beside others after all are read by themselves.
"""
import collections
import concurrent.futures
import functools
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).parents[1].resolve()
MOST_FILES = 80
MOST_LINES = 11000
MOST_BLAMED = 4  # of a unit that does not compile; with more it is read target by target
# Takes as long as all others together, in CGAL's templates; made of the sources that are named.
OF_NAMED = "performance-unnecessary-value-param"
# GCC's own warning options mean nothing to clang, and OSG's wrapper macros leave parameters unused.
FLAGS = ["-Wno-unknown-warning-option", "-Wno-unused-parameter", "-Wdocumentation",
         "-Wreserved-identifier"]
# Functions that each program has: called otherwise in each source of a unit.
ONE_A_PROGRAM = ["main", "LLVMFuzzerTestOneInput"]
# No part of this build: tests compile the first two by themselves, and sanitizers bring the third.
APART = ["downstream", "unit/headers", "support/DriverLeaks.cpp"]
# Made by macros, another in each file, or for a type of each file.
TESTS = {"PrintTo", "TEST", "TEST_F", "TEST_P", "INSTANTIATE_TEST_SUITE_P", "REGISTER_OBJECT_WRAPPER"}


def one_by_one(entries):
    """The build's commands with those that compile several sources (OSGSKIN_UNITY) taken apart."""
    for entry in entries:
        path = pathlib.Path(entry["file"])
        together = path.parent.name == "Unity"
        files = re.findall(r'#include "(.+)"', path.read_text()) if together else [entry["file"]]
        for file in files:
            yield {"file": file, "command": entry["command"].replace(entry["file"], file)}


def flags_of(entry):
    """What a source is compiled with, without its own name and the optimisation."""
    words, flags = shlex.split(entry["command"]), []
    words = words[next(i for i, word in enumerate(words) if word.startswith("-")):]
    skip = False
    for word in words:
        if skip or word == "-c" or word == entry["file"]:
            skip = False
        elif word == "-o":
            skip = True
        elif not word.startswith("-O"):
            flags.append(word)
    return tuple(flags + FLAGS)


def own_names(files):
    """For each file the names that it keeps to itself, macros among them, and marked with what must not meet them.

    "using NAME" is another's that it names so, "inner NAME" a function's own, "open NAME" a class of its folder's
    headers that is in no namespace.
    """
    names = collections.defaultdict(set)
    for tag in tags_of(files):
        scope = tag.get("scope", "")
        local = "__anon" in scope or tag.get("file") or tag["kind"] == "macro"
        if local and tag.get("scopeKind") in (None, "namespace") and tag["name"] not in TESTS:
            names[tag["path"]].add(tag["name"])
    opened_in = collections.defaultdict(set)
    headers_beside = [str(header) for folder in {pathlib.Path(file).parent for file in files}
                      for header in folder.glob("*.h")]
    for tag in tags_of(headers_beside):
        if "scope" not in tag and tag["kind"] in ("class", "struct", "enum", "union"):
            opened_in[pathlib.Path(tag["path"]).parent].add(f"open {tag['name']}")
    for file in files:
        text = pathlib.Path(file).read_text()
        names[file].update(f"using {name}" for name in re.findall(r"^using [\w:]+::(\w+);", text, re.M))
        names[file].update(f"inner {name}" for name in re.findall(r"^ +.*constexpr .*\b(k[A-Z]\w*)\b.* =", text, re.M))
        names[file].update(f"inner {name}" for name in re.findall(r"^ +using (\w+) =", text, re.M))
        names[file].update(opened_in[pathlib.Path(file).parent])
    return names


def tags_of(files):
    """What ctags finds in files."""
    if not files:
        return []
    command = ["ctags", "--kinds-C++=dfvscgtue", "--language-force=C++", "--fields=+ZfK", "--output-format=json",
               "-f", "-"]
    found = subprocess.run([*command, *files], check=True, capture_output=True, text=True).stdout
    return map(json.loads, found.splitlines())


def clash(some, others):
    """Whether a name of its own of one side is one of the other side's, or stands for another's there."""
    own = {name for name in some if " " not in name}, {name for name in others if " " not in name}
    marks = ("using", "inner", "open")
    return bool(own[0] & own[1] or {f"{mark} {name}" for mark in marks for name in own[0]} & others or
                {f"{mark} {name}" for mark in marks for name in own[1]} & some)


def units(entries):
    """Lists of (flags, files): a unit as a whole, and where it is of several, each target's part of it.

    Files of one unit share no name of their own.
    """
    names = own_names([e["file"] for e in entries])
    made = collections.defaultdict(list)  # flags -> [(files, names, lines)]
    for entry in entries:
        file = entry["file"]
        lines = len(pathlib.Path(file).read_text().splitlines())
        for unit in made[flags_of(entry)]:
            if len(unit[0]) < MOST_FILES and unit[2] + lines <= MOST_LINES and not clash(unit[1], names[file]):
                unit[0].append(file)
                unit[1].update(names[file])
                unit[2] += lines
                break
        else:
            made[flags_of(entry)].append([[file], set(names[file]), lines])
    result = []  # [flags, files, names, lines, parts]
    parts = [[list(flags), *unit, [(list(flags), list(unit[0]))]] for flags, list_ in made.items()
             for unit in list_]
    for part in sorted(parts, key=lambda part: -part[3]):
        if not any(join(unit, part) for unit in result):
            result.append(part)
    result.sort(key=lambda unit: -len(unit[1]))  # the longest first
    return [[(unit[0], unit[1]), *(unit[4] if len(unit[4]) > 1 else [])] for unit in result]


def join(unit, part):
    """Takes another target's sources into a unit; False where one of them would be read otherwise then."""
    if len(unit[1]) + len(part[1]) > MOST_FILES or unit[3] + part[3] > MOST_LINES or clash(unit[2], part[2]):
        return False
    # Names of two namespaces that are both opened may be alike.
    if len(opened(unit[1]) | opened(part[1])) > 1:
        return False
    flags = pairs(unit[0])
    added = [flag for flag in pairs(part[0]) if flag not in flags]
    # Of -DNAME=VALUE, -std=VALUE and the like each has one value.
    given = {flag[0].split("=")[0] for flag in flags}
    if any(flag[0].split("=")[0] in given for flag in added if "=" in flag[0]):
        return False
    # A header's name that two folders have would be found in the first.
    first, second = ([f[-1] for f in side if f not in other] for side, other in
                     ((flags, pairs(part[0])), (pairs(part[0]), flags)))
    if any(headers(a) & headers(b) for a in first for b in second):
        return False
    unit[0] += [word for flag in added for word in flag]
    unit[1] += part[1]
    unit[2] |= part[2]
    unit[3] += part[3]
    unit[4] += part[4]
    return True


def opened(files):
    """The namespaces whose names sources use as their own."""
    return {name for file in files for name in opened_by(file)}


@functools.lru_cache(maxsize=None)
def opened_by(file):
    return re.findall(r"^using namespace (\w+);", pathlib.Path(file).read_text(), re.M)


def pairs(words):
    """A command's options, each a tuple: ("-isystem", "folder") or ("-Wall",)."""
    words = iter(words)
    return [(word, next(words)) if word in ("-isystem", "-I", "-include") else (word,) for word in words]


@functools.lru_cache(maxsize=None)
def headers(flag):
    """What of ours can be included by name from an option's folder; nothing of the system's."""
    folder = pathlib.Path(flag.removeprefix("-I"))
    if not folder.is_absolute() or not folder.is_dir() or folder.is_relative_to("/usr"):
        return frozenset()
    return frozenset(str(path.relative_to(folder)) for path in folder.rglob("*") if path.suffix in ("", ".h"))


def unit_of(files):
    """A source that is made of these; first those that say by macros how headers are read."""
    lines = []
    for number, file in enumerate(sorted(files, key=lambda file: not defines(file))):
        lines += [f"#define {name} {name}{number}" for name in ONE_A_PROGRAM]
        lines += [f'#include "{file}"', *(f"#undef {name}" for name in ONE_A_PROGRAM)]
    return "\n".join(lines) + "\n"


@functools.lru_cache(maxsize=None)
def defines(file):
    return re.search("^#define", pathlib.Path(file).read_text(), re.M) is not None


def run(folder, flags, files, checks):
    """clang-tidy on files as one unit, with these checks added to ours. (exit status, complaints)."""
    folder.mkdir(parents=True, exist_ok=True)
    unit = folder / "unit.cpp"
    unit.write_text(unit_of(files))
    source = str(unit) if len(files) > 1 else files[0]
    command = {"directory": str(folder), "file": source, "arguments": ["c++", *flags, "-c", source]}
    (folder / "compile_commands.json").write_text(json.dumps([command]))
    done = subprocess.run(["clang-tidy", "-p", str(folder), "--quiet", f"--checks={checks}", source],
                          capture_output=True, text=True)
    return done.returncode, done.stdout or done.stderr


def tidy(folder, whole, *parts):
    """Complaints about one unit; part by part where that does not compile as a whole."""
    flags, files = whole
    without = ["bugprone-suspicious-include"] * (len(files) > 1) + [OF_NAMED] * (len(sys.argv) <= 2)
    status, found = run(folder, flags, files, ",".join(f"-{check}" for check in without))
    if status == 0:
        return ""
    # A name may also shadow that of another file.
    if len(files) == 1 or not re.search(r"\[clang-diagnostic-(error|shadow)\]", found):
        return found
    blamed = [f for f in files if re.search(rf"^{re.escape(f)}:\d+:\d+: error: .*\[clang-diagnostic-(error|shadow)\]",
                                            found, re.M)] or files
    if parts and len(blamed) > MOST_BLAMED:
        return "".join(tidy(folder / str(number), part) for number, part in enumerate(parts))
    rest = [f for f in files if f not in blamed]
    print("by themselves: " + " ".join(pathlib.Path(f).name for f in blamed), flush=True)
    texts = [tidy(folder / pathlib.Path(file).stem, (flags, [file])) for file in blamed]
    return "".join(texts) + (tidy(folder, (flags, rest)) if rest else "")


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    listed = subprocess.run(["git", "ls-files", "*.cpp", *(f":!tests/{part}" for part in APART)], cwd=ROOT, check=True,
                            capture_output=True, text=True).stdout.split()
    wanted = {str(ROOT / f) for f in listed}
    if sys.argv[2:]:
        wanted &= {str(pathlib.Path(f).resolve()) for f in sys.argv[2:]}
    commands = json.loads((build / "compile_commands.json").read_text())
    entries = {e["file"]: e for e in reversed(list(one_by_one(commands))) if e["file"] in wanted}
    missing = wanted - set(entries)
    if missing:
        print("not in the build, so not looked at: " + " ".join(sorted(missing)), file=sys.stderr)
    work = units(sorted(entries.values(), key=lambda e: e["file"]))
    print(f"clang-tidy: {len(entries)} sources in {len(work)} units", flush=True)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = list(pool.map(lambda job: tidy(build / "lint" / str(job[0]), *job[1]), enumerate(work)))
    seen = set()
    for block in re.split(r"(?m)^(?=\S+:\d+:\d+: (?:warning|error))", "".join(found)):
        if block.strip() and block not in seen:
            seen.add(block)
            sys.stderr.write(block)
    return 1 if seen or missing else 0


if __name__ == "__main__":
    sys.exit(main())
