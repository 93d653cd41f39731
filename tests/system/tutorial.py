#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""tutorial.py PAGE SOURCES BUILD FOLDER [FILE...]: does what a tutorial's page says, in one shell.

Indented lines are commands. A block of code after "Save this as `NAME`:" is a file. The shell starts in a
folder that has the sources, the FILEs, and BUILD as build/release; its home is inside FOLDER. Programs that
open a window close it after a few frames. Fails with a command that fails or that warns. Needs a display.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

# A plug-in that is missing, an unknown option and a bad file are warnings to osgDB, or no more than a line.
COMPLAINTS = re.compile(r"warning|error|unknown|unsupported|could not|cannot|not found", re.I)


def script_of(page):
    """The page's commands and files as one shell script, and how many commands there are."""
    script, name, commands, file = ["set -euo pipefail"], "", 0, None
    for line in page.read_text().splitlines():
        if line.startswith("```"):
            if file is None:
                file = []
            else:
                if name:
                    script += [f"cat >{name} <<'END OF FILE'", *file, "END OF FILE"]
                name, file = "", None
        elif file is not None:
            file.append(line)
        elif line.startswith("    "):
            command = line.strip()
            script += [f"echo {shell_word('$ ' + command)}", command]
            commands += 1
        elif saved := re.search(r"Save this as `([\w.]+)`:$", line):
            name = saved[1]
    return "\n".join(script) + "\n", commands


def shell_word(text):
    return "'" + text.replace("'", "'\\''") + "'"


def main():
    page, sources, build, folder, *files = (pathlib.Path(word).resolve() for word in sys.argv[1:])
    shutil.rmtree(folder, ignore_errors=True)
    clone = folder / "clone"
    (clone / "build").mkdir(parents=True)
    for entry in ("data", "examples"):
        (clone / entry).symlink_to(sources / entry)
    (clone / "build/release").symlink_to(build)
    for file in files:
        (clone / file.name).symlink_to(file)
    script, commands = script_of(page)
    if not commands:
        sys.exit(f"{page}: no commands")
    environment = {name: value for name, value in os.environ.items()
                   if name not in ("OSG_LIBRARY_PATH", "LD_LIBRARY_PATH")}
    environment.update(HOME=str(folder / "home"), OSG_RUN_FRAME_COUNT="5")
    ran = subprocess.run(["bash", "-c", script], cwd=clone, env=environment, text=True,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    print(ran.stdout)
    if ran.returncode != 0:
        sys.exit(f"{page}: the last command above exits with {ran.returncode}")
    for line in ran.stdout.splitlines():
        if not line.startswith(("$ ", "-- ")) and COMPLAINTS.search(line):
            sys.exit(f"{page}: a command complains: {line}")
    print(f"{page}: {commands} commands")


if __name__ == "__main__":
    main()
