#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""check.py [ROOT]: checks the sources against nodekits/rooms.txt and the rules below.

Prints each breach as PATH: what is wrong, and exits with 1 if there is any. rooms.txt describes its
own format; the other rules:
  - at most 600 lines in any source, an SPDX line in all;
  - at most 60 lines in any function of nodekits and osgPlugin but those that rooms.txt lists, at most ten;
  - \\param, \\return and \\throw begin a line of their comment;
  - debian/copyright gives each source the licence of its SPDX line;
  - a source includes the public header of its name first; a source that has no header of its name begins with
    the header that declares its functions;
  - an internal header of a kit has two users or a test; with one user it belongs in that user's file
    (except for Highway's -inl.h parts of a kernel);
  - links and backquoted paths in Markdown exist; if a line of nodekits/README.md names a function(),
    a file linked in that line has it; its picture of the kits has the arrows of rooms.txt; README.md
    shows the code that is compiled.
"""
import collections
import fnmatch
import pathlib
import re
import sys

MAX_LINES = 600
MAX_FUNCTION_LINES = 60
MAX_LONG_FUNCTIONS = 10
MAX_RECIPE_LINES = 40
FOLDERS = ("nodekits", "osgPlugin", "examples", "tests", "data", "cmake", ".ci")
SCRIPTS = {".cmake", ".sh", ".py", ".txt"}


class House:
    """rooms.txt and the files that it describes."""

    def __init__(self, root):
        self.root = root
        self.breaches = []
        self.licence = {}  # kit -> SPDX name
        self.needs = {}  # kit -> kits
        self.inside = {}  # kit -> the kits of these whose internal headers it may include
        self.rooms = collections.defaultdict(list)  # kit -> rooms, bottom to top
        self.headers = {}  # (kit, public header without a source) -> room
        self.long = {}  # (path, function) -> why it is long
        self.read_rooms()

    def breach(self, path, what):
        self.breaches.append(f"{self.name(path)}: {what}")

    def name(self, path):
        return path.relative_to(self.root).as_posix()

    def read_rooms(self):
        path, kit = self.root / "nodekits/rooms.txt", None
        for line in path.read_text().splitlines():
            words = line.split()
            if not words or words[0].startswith("#"):
                continue
            if words[0] == "kit":
                kit, self.licence[words[1]] = words[1], words[2]
                self.needs[kit] = [word.removesuffix("*") for word in words[4:]]
                self.inside[kit] = [word.removesuffix("*") for word in words[4:] if word.endswith("*")]
                for other in self.needs[kit]:
                    if other not in self.needs or other == kit:
                        self.breach(path, f"{kit} needs {other}, which does not stand above it")
            elif words[0] == "long":
                place, _, why = line.removeprefix("long ").partition(": ")
                self.long[tuple(place.split())] = why
                if not why or len(self.long) > MAX_LONG_FUNCTIONS:
                    self.breach(path, f"{place}: no reason, or more than {MAX_LONG_FUNCTIONS} long functions")
            else:
                self.rooms[kit].append(words[0])
                if not (self.root / "nodekits" / kit / "src" / words[0]).is_dir():
                    self.breach(path, f"{kit} has no room {words[0]}")
                for header in words[1:]:
                    self.headers[kit, header] = words[0]
                    if not (self.root / "nodekits" / kit / "include" / kit / header).is_file():
                        self.breach(path, f"{kit} has no header {header}")

    def files(self, *folders):
        """Our sources and scripts in these folders."""
        for folder in folders:
            for path in sorted((self.root / folder).rglob("*")):
                if path.is_file() and (is_code(path) or path.suffix in SCRIPTS or path.name == "run"):
                    yield path

    def place(self, path):
        """(kit, room) of a file of nodekits, or None."""
        parts = path.relative_to(self.root / "nodekits").parts
        kit = parts[0]
        if parts[1] == "src":
            room = "/".join(parts[2:-1])
        else:
            room = self.public_room(kit, path.name)
        return (kit, room) if room in self.rooms.get(kit, []) else None

    def internal(self, kit, header):
        """The path of ROOM/File.h as a source of the kit includes it; its own where none exists."""
        found = [self.root / "nodekits" / k / "src" / header for k in (kit, *self.inside.get(kit, []))]
        return next((path for path in found if path.is_file()), found[0])

    def public_room(self, kit, header):
        sources = self.root / "nodekits" / kit / "src"
        found = [p for p in sources.rglob(header + ".cpp")]
        if len(found) == 1:
            return found[0].parent.relative_to(sources).as_posix()
        return self.headers.get((kit, header))


def is_code(path):
    """C++, including public headers without an extension."""
    return path.suffix in (".cpp", ".h") or (not path.suffix and path.parts[-3:-1][:1] == ("include",))


def includes(path):
    return re.findall(r'^\s*#\s*include\s*([<"][^>"]+[>"])', path.read_text(), re.M)


def check_sizes(house):
    for path in house.files(*FOLDERS):
        if "data" in path.relative_to(house.root).parts and path.suffix == ".txt":
            continue
        lines = path.read_text().splitlines()
        if len(lines) > MAX_LINES:
            house.breach(path, f"has {len(lines)} lines; at most {MAX_LINES}")
        licence = re.search(r"SPDX-License-Identifier: (\S+)", "\n".join(lines[:3]))
        parts = path.relative_to(house.root).parts
        if path.name == "rooms.txt":
            continue
        for number, line in enumerate(lines, 1) if is_code(path) else []:
            if re.search(r"^\s*///.*\S \\(param|return|throw|pre|post)\b", line):
                house.breach(path, f"line {number}: a \\param, \\return or \\throw begins a line of its own")
        if not licence:
            house.breach(path, "no SPDX-License-Identifier in its first lines")
        elif parts[0] == "nodekits" and len(parts) > 2:
            expected = house.licence.get(parts[1])
            if is_code(path) and licence[1] != expected:
                house.breach(path, f"{licence[1]}, in a kit that is {expected}")


def check_copyright(house):
    """Checks that debian/copyright, where the last matching pattern counts, agrees with the sources."""
    page = house.root / "debian/copyright"
    if not page.is_file():
        return
    names = {"Expat": "MIT", "GPL-3+": "GPL-3.0-or-later", "CC0-1.0": "CC0-1.0"}
    stanzas = re.findall(r"^Files:(.*(?:\n .+)*)\nCopyright:.*\nLicense: (\S+)$", page.read_text(), re.M)
    patterns = [(pattern, names[licence]) for files, licence in stanzas for pattern in files.split()]
    for path in house.files(*FOLDERS):
        own = re.search(r"SPDX-License-Identifier: (\S+)", "\n".join(path.read_text().splitlines()[:3]))
        stated = [licence for pattern, licence in patterns if fnmatch.fnmatchcase(house.name(path), pattern)]
        if own and own[1] != stated[-1]:
            house.breach(page, f"{house.name(path)} is {own[1]}, not {stated[-1]}")


def check_includes(house):
    """Checks that includes go one way. Returns the arrows between rooms."""
    arrows = set()
    for path in filter(is_code, house.files("nodekits")):
        here = house.place(path)
        if not here:
            house.breach(path, "stands in no room of nodekits/rooms.txt")
            continue
        kit, room = here
        for include in includes(path):
            target = include[1:-1]
            first = target.split("/")[0]
            if include[0] == "<":
                if first not in house.licence:
                    continue
                if first != kit:
                    if first not in house.needs[kit]:
                        house.breach(path, f"includes {include}, and {kit} does not need {first}")
                    continue
                there = house.place(house.root / "nodekits" / kit / "include" / target)
            else:
                file = house.internal(kit, target)
                if not file.is_file():
                    house.breach(path, f'includes {include}, which is not ROOM/File.h in {kit}/src')
                    continue
                there = house.place(file)
            if not there or there[0] != kit:
                continue  # reported when that file itself is checked, or of a kit below
            order = house.rooms[kit]
            if order.index(there[1]) > order.index(room):
                house.breach(path, f"includes {include}: an arrow upward, {room} -> {there[1]}")
            elif there[1] != room:
                arrows.add((kit, room, there[1]))
    return arrows


def check_own_headers(house):
    """A source includes the public header of its name first, so that the header compiles alone."""
    for path in house.files("nodekits"):
        kit = path.relative_to(house.root / "nodekits").parts[0]
        own = f"{kit}/{path.stem}"
        if path.suffix == ".cpp" and (house.root / "nodekits" / kit / "include" / own).is_file():
            if includes(path)[:1] != [f"<{own}>"]:
                house.breach(path, f"does not include <{own}> first")


def check_declared(house):
    """The first include of a source without a header of its name declares one of its functions."""
    for path in house.files("nodekits"):
        parts = path.relative_to(house.root / "nodekits").parts
        public = house.root / "nodekits" / parts[0] / "include"
        if path.suffix != ".cpp" or path.with_suffix(".h").is_file() or (public / parts[0] / path.stem).is_file():
            continue
        first = (includes(path) or ['""'])[0]
        header = public / first[1:-1] if first[0] == "<" else house.internal(parts[0], first[1:-1])
        functions = set(re.findall(r"^\w[^;=]*?\b(\w+)\(", path.read_text(), re.M))
        if not header.is_file() or not any(re.search(rf"\b{f}\(", header.read_text()) for f in functions):
            house.breach(path, f"begins with {first}, which declares none of its functions")


def functions(lines, first=0, last=None, indent=0):
    """(begin, end, head) of the functions in formatted C++: their bodies end where their heads are indented."""
    last, pad = len(lines) if last is None else last, " " * indent
    while first < last:
        head = first
        if lines[head][:indent] != pad or not lines[head][indent:indent + 1].strip("}#/ "):
            first += 1
            continue
        while first < last and not re.search(r"[{;}](\s*//.*)?$", lines[first]):
            first += 1
        text = " ".join(line.strip() for line in lines[head:first + 1])
        first += 1
        if not re.search(r"\{(\s*//.*)?$", text) or re.match(r"(inline )?namespace\b|extern \"C\"", text):
            continue
        end = next((i for i in range(first, last) if lines[i].startswith(pad + "}")), last)
        if re.match(r"(template ?<.*?> ?)?(class|struct|union)\b[^(]*\{$", text):
            yield from functions(lines, first, end, indent + 4)
        elif "(" in text and not re.search(r"=\s*\{$", text):
            yield head, end, text
        first = end + 1


def check_functions(house):
    """Checks the length of functions, those in shaders' texts left out."""
    unused = set(house.long)
    for path in filter(is_code, house.files("nodekits", "osgPlugin")):
        text = re.sub(r'R"\(.*?\)"', lambda raw: '""' + "\n" * raw[0].count("\n"), path.read_text(), flags=re.S)
        for begin, end, head in functions(text.splitlines()):
            name = (re.findall(r"(\w+)\(", head) or ["?"])[0]
            unused.discard((house.name(path), name)) if end - begin >= MAX_FUNCTION_LINES else None
            if end - begin >= MAX_FUNCTION_LINES and (house.name(path), name) not in house.long:
                house.breach(path, f"{name}() has {end - begin + 1} lines; at most {MAX_FUNCTION_LINES}")
    for path, name in unused:
        house.breach(house.root / "nodekits/rooms.txt", f"{path} has no long {name}()")


def check_users(house):
    """Checks that an internal header has two users, or a test."""
    users = collections.defaultdict(set)  # header -> files that include it, except its own source
    tests = " ".join(p.read_text() for p in house.files("tests", "osgPlugin", "examples", "data") if is_code(p))
    paths = [p for p in house.files("nodekits") if is_code(p)]
    for path in paths:
        kit = path.relative_to(house.root / "nodekits").parts[0]
        for include in includes(path):
            header = house.internal(kit, include[1:-1])
            if include[0] == '"' and header.with_suffix("") != path.with_suffix(""):
                users[header].add(path)
    for path in paths:
        if path.suffix != ".h" or path.stem.endswith("-inl"):
            continue
        name = "/".join(path.relative_to(house.root / "nodekits").parts[2:])
        if len(users[path]) < 2 and f'"{name}"' not in tests and f"<{name}>" not in tests:
            only = [f"only {house.name(user)}" for user in users[path]] or ["nobody"]
            house.breach(path, f"{only[0]} uses it")


def anchors(path):
    """GitHub's anchors for a page's headings."""
    titles = re.findall(r"^#+ +(.*)$", path.read_text(), re.M)
    return {re.sub(r"[^\w\- ]", "", t.lower()).strip().replace(" ", "-") for t in titles}


def check_pages(house):
    top = [p for p in house.root.glob("*.md")]
    for page in top + [p for f in FOLDERS for p in sorted((house.root / f).rglob("*.md"))]:
        text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.M | re.S)
        for target in re.findall(r"\]\(([^)\s]+)\)", text):
            if re.match(r"[a-z]+:", target):
                continue
            file, _, anchor = target.partition("#")
            to = (page.parent / file).resolve() if file else page
            if not to.exists():
                house.breach(page, f"links {target}, which does not exist")
            elif anchor and anchor not in anchors(to):
                house.breach(page, f"links {target}, which has no such heading")
        if page == house.root / "nodekits/README.md":
            check_steps(house, page, text)


def check_steps(house, page, text):
    """Checks that the folders, files and functions named by the architecture's page exist."""
    for kit, rooms in house.rooms.items():
        row = re.search(rf"^\| \[?{kit}\b.*\| ([^|]*)\|$", text, re.M)
        if not row or re.findall(r"`([^`]+)`", row[1]) != rooms:
            house.breach(page, f"its table does not end {kit}'s row with the rooms of rooms.txt")
    check_picture(house, page)
    for number, line in enumerate(text.splitlines(), 1):
        linked = re.findall(r"\]\(([^)#:\s]+)\)", line)
        files = [f for f in (page.parent / name for name in linked) if f.is_file()]
        for name in re.findall(r"`([\w:]+)\(\)`", line):
            short = name.split("::")[-1]
            if not any(re.search(rf"\b{short}\s*\(", f.read_text()) for f in files):
                house.breach(page, f"line {number}: no file linked in it has {name}()")


def check_picture(house, page):
    """Checks that the picture of the kits, lines "a <- b, c <- d", has the kits and arrows of rooms.txt."""
    drawn = {kit: set() for kit in house.needs}  # kit -> kits that it needs, directly or not
    picture = re.search(r"^```\n(.*?)^```", page.read_text(), re.M | re.S)
    for line in picture[1].splitlines() if picture else []:
        below = set()
        for group in line.split(" <- "):
            kits = {name.strip() for name in group.split(",")} & set(drawn)
            for kit in kits:
                drawn[kit] |= below
            below |= kits
    for kit, needs in house.needs.items():
        if drawn[kit] != set(needs):
            house.breach(page, f"its picture lets {kit} need {sorted(drawn[kit])}; rooms.txt: {sorted(needs)}")


def check_shown(house, example, readme):
    """Checks that a page shows an example's lines between its [readme] marks."""
    if not example.is_file() or not readme.is_file():
        return
    shown = set(map(str.strip, readme.read_text().splitlines()))
    for line in example.read_text().split("[readme]")[1].splitlines():
        line = line.strip().removesuffix("//").strip()
        if line and line not in shown and f"// {line}" not in shown:
            house.breach(readme, f"lacks a line of {house.name(example)}: {line}")


def check_example(house):
    """Checks that pages show examples as tests compile them, and README.md the headers that tests/downstream does."""
    example = house.root / "examples/osgskinthrow/ThrowScene.cpp"
    readme = house.root / "README.md"
    if not example.is_file() or not readme.is_file():
        return
    check_shown(house, example, readme)
    downstream = house.root / "tests/downstream/main.cpp"
    for include in re.findall(r"^#include <osgSkin.*>$", readme.read_text(), re.M):
        if include not in downstream.read_text():
            house.breach(readme, f"shows {include}, which {house.name(downstream)} does not compile")


def check_blocks(house, page, text, source):
    """Checks that a source has the lines of a text's C++ blocks."""
    known = set(map(str.strip, source.read_text().splitlines()))
    for block in re.findall(r"^```cpp\n(.*?)^```", text, re.M | re.S):
        for line in filter(None, map(str.strip, block.splitlines())):
            if line not in known:
                house.breach(page, f"shows a line that {house.name(source)} lacks: {line}")


def check_recipes(house):
    """Checks that each recipe is short, and has a picture and a section that shows its own lines."""
    folder = house.root / "examples/recipes"
    page, table = folder / "README.md", folder / "Recipes.cpp"
    if not page.is_file():
        return
    sections = page.read_text().split("\n## ")
    for name in re.findall(r'^ +\{"(\w+)",', table.read_text(), re.M):
        source = folder / f"{name}.cpp"
        lines = len(source.read_text().splitlines())
        if lines > MAX_RECIPE_LINES:
            house.breach(source, f"has {lines} lines; at most {MAX_RECIPE_LINES}")
        section = [text for text in sections if f"\n[{name}.cpp]({name}.cpp)" in text]
        if len(section) != 1 or f"](../pictures/recipes/{name}.png)" not in section[0]:
            house.breach(page, f"has no section with a picture for {house.name(source)}")
        else:
            check_blocks(house, page, section[0], source)
    crowds = house.root / "nodekits/osgSkinGpu/README.md"
    check_blocks(house, crowds, crowds.read_text().split("\n## Crowds")[1].split("To make a character by hand")[0],
                 folder / "makeCrowd.cpp")


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2])
    house = House(root.resolve())
    check_sizes(house)
    check_copyright(house)
    arrows = check_includes(house)
    check_own_headers(house)
    check_declared(house)
    check_functions(house)
    check_users(house)
    check_pages(house)
    check_example(house)
    check_recipes(house)
    for line in house.breaches:
        print(line)
    rooms = sum(map(len, house.rooms.values()))
    print(f"{len(house.licence)} kits, {rooms} rooms, {len(arrows)} arrows between rooms, "
          f"{len(house.breaches)} breaches")
    return 1 if house.breaches else 0


if __name__ == "__main__":
    sys.exit(main())
