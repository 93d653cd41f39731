#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""site.py SOURCES HTML: writes every Markdown page as HTML, with the files that it links.

README.md becomes index.html. Links to public headers lead to the reference, which Doxygen has written to
HTML/reference before; other files are copied, those that browsers would not show with .txt after their
name. Folders without a README are not linked. Fails where a link of a page leads nowhere.
"""
import html
import os
import pathlib
import re
import shutil
import sys

import markdown_it

FOLDERS = ("cmake", "data", "examples", "findings", "nodekits", "osgPlugin", "tests")
SHOWN = {".png", ".webp", ".txt"}
MENU = {"osgSkin": "README.md", "Tutorial": "examples/tutorial/README.md", "Recipes": "examples/recipes/README.md",
        "Gallery": "examples/gallery/README.md", "Programs": "examples/README.md",
        ".skin files": "osgPlugin/skin/README.md", "Architecture": "nodekits/README.md",
        "Changes": "CHANGELOG.md"}
PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>{title}</title><style>
body {{ max-width: 60rem; margin: 0 auto; padding: 0 1rem 4rem; font: 1rem/1.5 sans-serif; color: #222; }}
nav {{ padding: 1rem 0; border-bottom: 1px solid #ccc; }} nav a {{ margin-right: 1rem; }}
a {{ color: #0645ad; }} img {{ max-width: 100%; vertical-align: middle; }}
pre, code {{ background: #f3f3f3; font-size: .9rem; }} pre {{ padding: .6rem; overflow-x: auto; }}
table {{ border-collapse: collapse; display: block; overflow-x: auto; }}
td, th {{ border: 1px solid #ccc; padding: .3rem .6rem; text-align: left; vertical-align: top; }}
</style></head><body><nav>{menu}</nav>
{body}</body></html>
"""


class Site:
    def __init__(self, sources, out):
        self.sources, self.out = sources, out
        self.broken = []

    def place(self, page):
        """The HTML file of a page."""
        name = "index.html" if page.name == "README.md" else page.stem + ".html"
        return self.out / page.relative_to(self.sources).parent / name

    def lead(self, page, link):
        """The link as the page's HTML has it; empty for a folder without a page."""
        if re.match(r"[a-z]+:", link):
            return link
        file, _, anchor = link.partition("#")
        to = (page.parent / file).resolve() if file else page
        parts = to.relative_to(self.sources).parts
        if to == self.sources / "nodekits/reference.md":
            target = self.out / "reference/index.html"
        elif to.suffix == ".md":
            target = self.place(to)
        elif (to / "README.md").is_file():
            target = self.place(to / "README.md")
        elif to.is_dir():
            return ""
        elif len(parts) == 5 and parts[2] == "include":
            target = self.out / "reference" / f"{to.name}.html"
        elif to.is_file():
            target = self.out / to.relative_to(self.sources)
            if to.suffix not in SHOWN:
                target = target.with_name(target.name + ".txt")
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(to, target)
        else:
            self.broken.append(f"{page.relative_to(self.sources)} links {link}, which does not exist")
            return link
        return os.path.relpath(target, self.place(page).parent) + ("#" + anchor if anchor else "")

    def write(self, page, reader):
        body = reader.render(page.read_text())
        body = re.sub(r"<(h\d)>(.*?)</\1>", heading, body)
        body = re.sub(r'<a href="([^"]*)">(.*?)</a>', lambda m: self.link(page, *m.groups()), body, flags=re.S)
        body = re.sub(r'(<img src=")([^"]*)', lambda m: m[1] + self.lead(page, m[2]), body)
        menu = [(name, self.lead(page, os.path.relpath(self.sources / file, page.parent))) for name, file in MENU.items()]
        menu.append(("Reference", self.lead(page, os.path.relpath(self.sources / "nodekits/reference.md", page.parent))))
        title = re.search(r"^# (.*)$", page.read_text(), re.M)[1]
        self.place(page).parent.mkdir(parents=True, exist_ok=True)
        self.place(page).write_text(PAGE.format(
            title=html.escape(title), body=body, menu=" ".join(f'<a href="{to}">{name}</a>' for name, to in menu)))

    def link(self, page, target, text):
        to = self.lead(page, html.unescape(target))
        return f'<a href="{html.escape(to)}">{text}</a>' if to else text

    def check(self, page):
        """Checks that everything that a written page names is there, headings included."""
        for link in re.findall(r'(?:href|src)="([^"]*)"', page.read_text()):
            file, _, anchor = html.unescape(link).partition("#")
            to = page.parent / file if file else page
            if re.match(r"[a-z]+:", link):
                continue
            if not to.is_file():
                self.broken.append(f"{page.relative_to(self.out)} links {link}, which does not exist")
            elif anchor and f'id="{anchor}"' not in to.read_text():
                self.broken.append(f"{page.relative_to(self.out)} links {link}, which has no such heading")


def heading(match):
    """A heading with the anchor that GitHub gives it."""
    text = html.unescape(re.sub(r"<[^>]*>", "", match[2]))
    anchor = re.sub(r"[^\w\- ]", "", text.lower()).strip().replace(" ", "-")
    return f'<{match[1]} id="{anchor}">{match[2]}</{match[1]}>'


def main():
    sources, out = (pathlib.Path(word).resolve() for word in sys.argv[1:])
    site = Site(sources, out)
    pages = [*sources.glob("*.md"), *(page for folder in FOLDERS for page in sorted((sources / folder).rglob("*.md")))]
    pages.remove(sources / "nodekits/reference.md")
    reader = markdown_it.MarkdownIt("commonmark", {"html": True}).enable("table")
    for page in pages:
        site.write(page, reader)
    for page in pages:
        site.check(site.place(page))
    for line in site.broken:
        print(line, file=sys.stderr)
    print(f"{len(pages)} pages, {len(site.broken)} broken links")
    return 1 if site.broken else 0


if __name__ == "__main__":
    sys.exit(main())
