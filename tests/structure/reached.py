# SPDX-License-Identifier: MIT
"""Whether a source, compiled by itself, has what it names of ours, OpenSceneGraph and the standard library.

Sources that are compiled together (OSGSKIN_UNITY) take it from each other, and none would notice. By
reading: a header counts as included whatever #if it stands behind, and of our names those count alone
that no variable is likely to have: called or qualified, with a capital letter within.
"""
import collections
import functools
import json
import pathlib
import re
import subprocess

SYSTEM = pathlib.Path("/usr/include")
# Where a name of std:: is declared, for those of its own header's name or a few more.
STANDARD = {
    "function": "functional", "unique_ptr": "memory", "shared_ptr": "memory", "make_unique": "memory",
    "make_shared": "memory", "numeric_limits": "limits", "nullopt": "optional", "lock_guard": "mutex",
    "unique_lock": "mutex", "ofstream": "fstream", "ifstream": "fstream", "ostringstream": "sstream",
    "istringstream": "sstream", "runtime_error": "stdexcept", "accumulate": "numeric", "iota": "numeric",
    "sort": "algorithm", "any_of": "algorithm", "all_of": "algorithm", "find_if": "algorithm",
    "memcpy": "cstring", "sqrt": "cmath", "isfinite": "cmath", "to_string": "string", "cout": "iostream",
    "cerr": "iostream",
    **{name: name for name in ("vector", "map", "set", "unordered_map", "unordered_set", "optional", "array",
                               "atomic", "mutex", "thread", "variant", "deque", "string", "tuple", "bitset",
                               "string_view", "condition_variable", "list", "queue", "regex", "future")},
}
INNER_CAPITAL = re.compile("[a-z0-9][A-Z]")
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.M)


class Reached:
    """The files that a house's sources include, and what those include."""

    def __init__(self, root, sources):
        kits = [path for kit in (root / "nodekits").iterdir() for path in (kit / "include", kit / "src") if path.is_dir()]
        beside = sorted({path.parent for path in sources if path.suffix == ".h"})
        standard = sorted((SYSTEM / "c++").glob("*"))[-1:]
        self.folders = [*kits, *beside, SYSTEM, *standard]
        self.found = {}
        self.ours = set(sources)
        self.declaring = collections.defaultdict(set)  # name -> our headers
        self.defined = collections.defaultdict(set)  # source -> names
        command = ["ctags", "--kinds-C++=csgufpvet", "--language-force=C++", "--fields=+ZK",
                   "--output-format=json", "-f", "-", *map(str, sources)]
        tags = subprocess.run(command, check=True, capture_output=True, text=True).stdout if sources else ""
        for tag in map(json.loads, tags.splitlines()):
            path, name = pathlib.Path(tag["path"]), tag["name"]
            self.defined[path].add(name)
            if path.suffix != ".cpp" and tag.get("scopeKind") in (None, "namespace") and INNER_CAPITAL.search(name):
                self.declaring[name].add(path)

    def missing(self, path):
        """The names that a source uses and that nothing it includes can have declared."""
        code = plain(path)
        for space, name in sorted(set(re.findall(r"\b(osg\w*|OpenThreads|std)::(\w+)", code))):
            header = STANDARD.get(name) if space == "std" else f"{space}/{name}"
            header = header and self.system(header)
            if not header or header in self.closure(path):
                continue
            declared = re.compile(rf"\b(class|struct) {name}\b")
            if space == "std" or not any(declared.search(plain(other)) for other in self.closure(path)):
                yield f"{space}::{name}"

        for name in sorted(words(path) & set(self.declaring) - self.defined[path]):
            used = rf"(?<![.>\w]){name}\s*[(<]|\b(osgSkin|test)::{name}\b"
            around = self.closure(path) & self.ours - {path}
            variable = rf"\b(?!return|else|throw|case|new)\w+[>&*]*\s+[&*]?{name}\b"
            code = without_titles(path)
            if not any(name in words(other) for other in around) and re.search(used, code) and \
                    not re.search(variable, code):
                yield name

    def system(self, header):
        return next(((folder / header).resolve() for folder in self.folders[-2:] if (folder / header).is_file()), None)

    @functools.lru_cache(maxsize=None)
    def closure(self, path):
        seen, left = {path}, [path]
        while left:
            new = self.included(left.pop()) - seen
            seen |= new
            left += new
        return seen

    @functools.lru_cache(maxsize=None)
    def included(self, path):
        found = (self.resolve(name, path.parent) for name in INCLUDE.findall(path.read_text(errors="replace")))
        return {other for other in found if other}

    def resolve(self, name, beside):
        if (beside / name).is_file():
            return (beside / name).resolve()
        if name not in self.found:
            self.found[name] = next(((folder / name).resolve() for folder in self.folders
                                      if (folder / name).is_file()), None)
        return self.found[name]


@functools.lru_cache(maxsize=None)
def plain(path):
    """A source without its comments and strings."""
    return re.sub(r'"(\\.|[^"\\\n])*"', '""', re.sub(r"//.*", "", path.read_text(errors="replace")))


def without_titles(path):
    """The same without the names of tests."""
    return re.sub(r"^(TEST\w*|INSTANTIATE\w+)\(.*", "", plain(path), flags=re.M)


@functools.lru_cache(maxsize=None)
def words(path):
    return frozenset(re.findall(r"\w+", without_titles(path)))
