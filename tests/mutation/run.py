#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Breaks the product on purpose, place by place, and tells which breaks no test notices.

    tests/mutation/run.py [--count N] [--seed S] [KIT...]

Works in a copy of the last commit, build/mutation/tree, which it builds by the preset release. Each mutant
changes one operator or number of one line; a kit's mutants are spread over its sources. What survives is
listed with its place, to be given a test or to be explained.
"""
import argparse
import random
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HOME = ROOT / "build" / "mutation"
TREE = HOME / "tree"
# Kit -> the test programs that are to notice.
KITS = {
    "osgSkin": ["runtime_test"],
    "osgSkinRig": ["importTests"],
    "osgSkinImport": ["importTests"],
    "osgSkinBind": ["bindTests"],
    "osgSkinCharacter": ["system_test"],
}
RULES = [
    (r" < ", " <= "), (r" <= ", " < "), (r" > ", " >= "), (r" >= ", " > "), (r" == ", " != "),
    (r" != ", " == "), (r" && ", " || "), (r" \|\| ", " && "), (r" \+ ", " - "), (r" - ", " + "),
    (r" \* ", " / "), (r"\breturn true;", "return false;"), (r"\breturn false;", "return true;"),
    (r"std::min\b", "std::max"), (r"std::max\b", "std::min"), (r"\b0\.5\b", "0.6"),
    (r"\bstd::lock_guard<std::mutex> lock\(\w+\);", ";"), (r"\bcontinue;", "break;"),
]
SKIPPED = re.compile(r'^\s*(//|#|using|template|namespace|static_assert)|"|fail|Error|OSG_|operator|&&\s*\w+\)')


def run(command, where=TREE, timeout=900):
    try:
        return subprocess.run(command, cwd=where, timeout=timeout, shell=True,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode
    except subprocess.TimeoutExpired:
        return 124  # a mutant that hangs is noticed


def places(kit):
    """All (file, line number, rule) of a kit where a rule applies."""
    found = []
    for file in sorted((TREE / "nodekits" / kit / "src").rglob("*.cpp")):
        for number, line in enumerate(file.read_text().splitlines()):
            if SKIPPED.search(line):
                continue
            found += [(file, number, rule) for rule in RULES if re.search(rule[0], line)]
    return found


def prepare(kits):
    HOME.mkdir(parents=True, exist_ok=True)
    if not TREE.exists():
        run(f"git worktree add --detach '{TREE}'", ROOT)
    run(f"git checkout --force --detach $(git -C '{ROOT}' rev-parse HEAD)")
    tests = " ".join(sorted({test for kit in kits for test in KITS[kit]}))
    if run("cmake --preset release -DOSGSKIN_GENERATOR=OFF", timeout=None) or run(
            f"ninja -C build/release osgdb_skin osgdb_serializers_osgskin {tests}", timeout=None):
        sys.exit("the copy does not build")


def is_noticed(kit):
    """None where the mutant does not compile."""
    if run(f"ninja -C build/release {kit}"):
        return None
    for test in KITS[kit]:
        if run(f"OSG_LIBRARY_PATH=build/release/lib nice build/release/bin/{test} "
               "--gtest_brief=1 --gtest_fail_fast", timeout=300):
            return True
    return False


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kits", nargs="*", default=list(KITS))
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    prepare(arguments.kits)
    random.seed(arguments.seed)
    noticed, survivors = 0, []
    for kit in arguments.kits:
        candidates = places(kit)
        random.shuffle(candidates)
        wanted = max(1, arguments.count // len(arguments.kits))
        for file, number, (pattern, by) in candidates:
            if wanted == 0:
                break
            text = file.read_text()
            lines = text.splitlines(keepends=True)
            before = lines[number].strip()
            lines[number] = re.sub(pattern, by, lines[number], count=1)
            place = f"{file.relative_to(TREE)}:{number + 1}: {before} -> {lines[number].strip()}"
            file.write_text("".join(lines))
            result = is_noticed(kit)
            file.write_text(text)
            if result is None:
                continue
            wanted -= 1
            noticed += result
            if not result:
                survivors.append(place)
            print("noticed " if result else "SURVIVED", place, flush=True)
    total = noticed + len(survivors)
    print(f"{noticed} of {total} noticed, {100.0 * noticed / max(1, total):.0f} %")
    return 0 if total and noticed >= 0.9 * total else 1


if __name__ == "__main__":
    sys.exit(main())
