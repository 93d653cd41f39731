#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""lint.py BUILD [FILE...]: runs clang-tidy on the kits and plug-ins, or on FILEs.

clang-tidy spends most of its time in headers, so the sources of a folder are checked as one unit.
Sources that use Highway are checked separately, because they include themselves, and so are
sources whose names clash with others of their folder.
"""
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).parents[1].resolve()
FOLDERS = ("nodekits", "osgPlugin")
# Clang does not know all of GCC's warning options; OSG's macros have unused parameters.
FLAGS = ["-Wno-unknown-warning-option", "-Wno-unused-parameter", "-Wdocumentation", "-Wreserved-identifier"]


def compiler_flags(command):
    """Returns the flags of a compile command without compiler, source, output, optimisation and precompiled headers."""
    words = iter(shlex.split(command)[1:])
    flags = []
    for word in words:
        if word in ("-o", "-c", "-include"):
            next(words)
        elif word != "-Winvalid-pch" and not word.startswith("-O") and not word.endswith("ccache") and "/c++" not in word:
            flags.append(word)
    return flags


def tidy(folder, flags, sources):
    """Runs clang-tidy on sources as one unit and returns its findings."""
    folder.mkdir(parents=True, exist_ok=True)
    unit = folder / "unit.cpp"
    unit.write_text("".join(f'#include "{source}"\n' for source in sources))
    command = {"directory": str(folder), "file": str(unit), "arguments": ["c++", *flags, *FLAGS, "-c", str(unit)]}
    (folder / "compile_commands.json").write_text(json.dumps([command]))
    done = subprocess.run(["clang-tidy", "-p", str(folder), "--quiet", "--checks=-bugprone-suspicious-include",
                           str(unit)], capture_output=True, text=True)
    if done.returncode and len(sources) > 1 and re.search(r"\[clang-diagnostic-(error|shadow)\]", done.stdout):
        clash = r":\d+:\d+: error: .*\[clang-diagnostic-(error|shadow)\]"
        blamed = [source for source in sources if re.search(re.escape(source) + clash, done.stdout)] or sources
        print("by themselves: " + " ".join(pathlib.Path(source).name for source in blamed), flush=True)
        found = [tidy(folder / pathlib.Path(source).stem, flags, [source]) for source in blamed]
        rest = [source for source in sources if source not in blamed]
        return "".join(found) + (tidy(folder, flags, rest) if rest else "")
    return (done.stdout or done.stderr) if done.returncode else ""


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    named = [str(pathlib.Path(name).resolve()) for name in sys.argv[2:]]
    units = collections.defaultdict(list)  # (folder, flags) -> sources
    for entry in json.loads((build / "compile_commands.json").read_text()):
        compiled = pathlib.Path(entry["file"])
        # A unity build compiles files that include the sources.
        sources = re.findall(r'#include "(.*)"', compiled.read_text()) if "/Unity/" in entry["file"] else [compiled]
        for source in map(pathlib.Path, sources):
            if not source.is_relative_to(ROOT) or source.relative_to(ROOT).parts[0] not in FOLDERS:
                continue
            if named and str(source) not in named:
                continue
            alone = source.name if "HWY_TARGET_INCLUDE" in source.read_text() else ""
            unit = units[source.parent, alone, tuple(compiler_flags(entry["command"]))]
            if str(source) not in unit:
                unit.append(str(source))
    work = sorted(units.items(), key=lambda unit: -sum(len(pathlib.Path(s).read_text()) for s in unit[1]))
    print(f"clang-tidy: {sum(len(sources) for _, sources in work)} sources in {len(work)} units", flush=True)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = list(pool.map(lambda job: tidy(build / "lint" / str(job[0]), list(job[1][0][2]), job[1][1]),
                              enumerate(work)))
    seen = set()
    for block in re.split(r"(?m)^(?=\S+:\d+:\d+: (?:warning|error))", "".join(found)):
        if block.strip() and block not in seen:
            seen.add(block)
            sys.stderr.write(block)
    return 1 if seen else 0


if __name__ == "__main__":
    sys.exit(main())
