#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Shows that check.py can fail: a tiny valid source tree, and one change that breaks each rule."""
import pathlib
import subprocess
import sys
import tempfile

MIT = "// SPDX-License-Identifier: MIT\n"
GPL = "// SPDX-License-Identifier: GPL-3.0-or-later\n"

PICTURE = "```\nlow <- high\n```\n"
ROWS = PICTURE + "| low | `ground`, `first` |\n| high | `only` |\n"

RECIPE = "# Recipes\n\n## A crowd\n![it](../pictures/recipes/makeCrowd.png)\n\n[makeCrowd.cpp](makeCrowd.cpp).\n"

LATER = MIT + '#include "first/Late.h"\nvoid later() {\n' + "    1;\n" * 60 + "}\n"

ROOMS = ("kit low MIT\n  ground  Export\n  first\n"
         "kit high GPL-3.0-or-later needs low*\n  only\n"
         "long nodekits/low/src/first/Later.cpp later: steps\n")

SOUND = {
    "nodekits/rooms.txt": ROOMS,
    "nodekits/low/include/low/Export": MIT,
    "nodekits/low/include/low/Up": MIT + "#include <low/Export>\nnamespace n { void up(); }\n",
    "nodekits/low/src/ground/Base.h": MIT + "namespace n { int base(); struct S { int f(); }; }\n",
    "nodekits/low/src/ground/Base.cpp": MIT + '#include "ground/Base.h"\nnamespace n {\n'
                                        "namespace { int up() { return 1; } }\n"
                                        "int base() { return up(); }\nint S::f() { return 2; }\n}\n",
    "nodekits/low/src/first/Up.cpp": MIT + '#include <low/Up>\n#include "ground/Base.h"\n'
                                     "namespace n { void up() { base(); } }\n",
    "nodekits/low/src/first/Late.h": MIT + "void down();\nvoid later();\n",
    "nodekits/low/src/first/Down.cpp": MIT + '#include "first/Late.h"\n#include "ground/Base.h"\nvoid down() {}\n',
    "nodekits/low/src/first/Later.cpp": LATER,
    "nodekits/high/src/only/Top.h": GPL + "#include <low/Up>\nvoid top();\nvoid other();\n",
    "nodekits/high/src/only/Top.cpp": GPL + '#include "only/Top.h"\n',
    "nodekits/high/src/only/Other.cpp": GPL + '#include "only/Top.h"\n\n#include "ground/Base.h"\nvoid other() {}\n',
    "nodekits/high/src/only/Another.cpp": GPL + '#include "only/Top.h"\nvoid top() {}\n',
    "nodekits/README.md": ROWS + "# House\n\nSee [the base](low/src/ground/Base.cpp), `S::f()`, and [above](#house).\n",
    "README.md": "#include <osgSkin/A>\n// Shown.\nint a = 1;\n",
    "examples/Plain.cpp": MIT + "int main() {}\n",
    "examples/osgskinthrow/ThrowScene.cpp": MIT + "// [readme] Shown.\n int a = 1;\n// [readme]\n",
    "tests/downstream/main.cpp": MIT + "#include <osgSkin/A>\n",
    "examples/recipes/Recipes.cpp": MIT + '    {"makeCrowd", makeCrowd}\n',
    "examples/recipes/makeCrowd.cpp": MIT + "int crowd;\n",
    "examples/recipes/README.md": RECIPE + "```cpp\nint crowd;\n```\n",
    "examples/pictures/recipes/makeCrowd.png": "",
    "nodekits/osgSkinGpu/README.md": "\n## Crowds\n```cpp\nint crowd;\n```\nTo make a character by hand: ...\n",
}

# The change, and the start of the expected complaint.
BROKEN = [
    ({"nodekits/rooms.txt": ROOMS.replace("*", "")},
     'nodekits/high/src/only/Other.cpp: includes "ground/Base.h", which is not ROOM/File.h'),
    ({"nodekits/README.md": ROWS.replace("low <- high", "low, high")},
     "nodekits/README.md: its picture lets high need []; rooms.txt: ['low']"),
    ({"nodekits/low/src/ground/Base.h": MIT + "#include <low/Up>\n"},
     "nodekits/low/src/ground/Base.h: includes <low/Up>: an arrow upward, ground -> first"),
    ({"nodekits/low/src/ground/Low.cpp": MIT + '#include "first/Late.h"\nvoid down() {}\n'},
     'nodekits/low/src/ground/Low.cpp: includes "first/Late.h": an arrow upward'),
    ({"nodekits/low/src/first/Up.cpp": MIT + '#include "ground/Base.h"\n#include <low/Up>\n'},
     "nodekits/low/src/first/Up.cpp: does not include <low/Up> first"),
    ({"nodekits/low/src/first/Later.cpp": LATER.replace("first/Late.h", "ground/Base.h").replace("later", "base").replace("1;\n    ", "1;"),
      "nodekits/rooms.txt": ROOMS.split("long")[0]},
     "nodekits/low/src/first/Late.h: only nodekits/low/src/first/Down.cpp uses it"),
    ({"nodekits/low/src/first/Late.h": MIT + "#include <high/Thing>\nvoid down();\nvoid later();\n"},
     "nodekits/low/src/first/Late.h: includes <high/Thing>, and low does not need high"),
    ({"nodekits/low/src/first/Late.h": MIT + '#include "Base.h"\nvoid down();\nvoid later();\n'},
     'nodekits/low/src/first/Late.h: includes "Base.h", which is not ROOM/File.h'),
    ({"nodekits/low/src/attic/Thing.cpp": MIT + "#include <low/Up>\nvoid up() {}\n"}, "nodekits/low/src/attic/Thing.cpp: stands in no room"),
    ({"nodekits/low/include/low/Loose": MIT}, "nodekits/low/include/low/Loose: stands in no room"),
    ({"examples/Plain.cpp": MIT + "\n" * 600}, "examples/Plain.cpp: has 601 lines"),
    ({"nodekits/rooms.txt": ROOMS.split("long")[0]}, "nodekits/low/src/first/Later.cpp: later() has 62 lines"),
    ({"nodekits/low/src/first/Later.cpp": LATER.replace("    1;\n" * 9, "")},
     "nodekits/rooms.txt: nodekits/low/src/first/Later.cpp has no long later()"),
    ({"nodekits/low/src/first/Down.cpp": MIT + '#include "first/Late.h"\n#include "ground/Base.h"\nvoid other() {}\n'},
     'nodekits/low/src/first/Down.cpp: begins with "first/Late.h", which declares'),
    ({"examples/run": "#!/bin/sh\n"}, "examples/run: no SPDX-License-Identifier"),
    ({"nodekits/high/src/only/Top.h": MIT + "void top();\nvoid other();\n"}, "nodekits/high/src/only/Top.h: MIT, in a kit that is GPL"),
    ({"examples/Plain.cpp": MIT + "/// Adds. \\return the sum\n"},
     "examples/Plain.cpp: line 2: a \\param, \\return or \\throw begins"),
    ({"README.md": "#include <osgSkin/A>\n// Shown.\nint a = 2;\n"},
     "README.md: lacks a line of examples/osgskinthrow/ThrowScene.cpp: int a = 1;"),
    ({"tests/downstream/main.cpp": MIT}, "README.md: shows #include <osgSkin/A>, which tests/downstream"),
    ({"debian/copyright": "Files: *\nCopyright: us\nLicense: GPL-3+\n\n"
                          "Files:\n nodekits/low/*\n nodekits/osg*\n tests/*\n examples/osgskinthrow/*\n examples/recipes/*\nCopyright: us\nLicense: Expat\n"},
     "debian/copyright: examples/Plain.cpp is MIT, not GPL-3.0-or-later"),
    ({"nodekits/README.md": ROWS + "[gone](low/Gone.h)\n"}, "nodekits/README.md: links low/Gone.h, which does not exist"),
    ({"nodekits/README.md": ROWS + "# House\n[there](#hut)\n"}, "nodekits/README.md: links #hut, which has no such heading"),
    ({"nodekits/README.md": ROWS.replace("`ground`", "`cellar`")},
     "nodekits/README.md: its table does not end low's row"),
    ({"nodekits/README.md": ROWS + "[the base](low/src/ground/Base.cpp): `S::g()`\n"},
     "nodekits/README.md: line 4: no file linked in it has S::g()"),
    ({"examples/recipes/makeCrowd.cpp": MIT + "int crowd;\n" + "\n" * 39},
     "examples/recipes/makeCrowd.cpp: has 41 lines; at most 40"),
    ({"examples/recipes/README.md": "# Recipes\n"},
     "examples/recipes/README.md: has no section with a picture for examples/recipes/makeCrowd.cpp"),
    ({"examples/recipes/README.md": RECIPE + "```cpp\nint people;\n```\n"},
     "examples/recipes/README.md: shows a line that examples/recipes/makeCrowd.cpp lacks: int people;"),
    ({"nodekits/osgSkinGpu/README.md": "\n## Crowds\n```cpp\nint people;\n```\nTo make a character by hand: ...\n"},
     "nodekits/osgSkinGpu/README.md: shows a line that examples/recipes/makeCrowd.cpp lacks: int people;"),
]


def breaches(changes):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in {**SOUND, **changes}.items():
            path = pathlib.Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        check = pathlib.Path(__file__).with_name("check.py")
        done = subprocess.run([sys.executable, check, folder], capture_output=True, text=True)
        found = done.stdout.splitlines()[:-1]
        if done.stderr or done.returncode != bool(found):
            sys.exit(f"check.py left with {done.returncode}\n{done.stdout}{done.stderr}")
        return found


def main():
    failures = [f"the sound house: {breach}" for breach in breaches({})]
    for changes, expected in BROKEN:
        found = breaches(changes)
        if not any(breach.startswith(expected) for breach in found) or len(found) != 1:
            failures.append(f"expected only: {expected}\n  got: " + "\n       ".join(found or ["nothing"]))
    print("\n".join(failures) or f"{len(BROKEN)} breaches noticed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
