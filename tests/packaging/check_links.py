#!/usr/bin/env python3
"""Links that lead nowhere: in the Markdown pages, and in the manual made of them.

    check_links.py SOURCE            links of README.md, CONTRIBUTING.md, docs/**/*.md, examples/**/*.md to files and headings
    check_links.py --html FOLDER     links of every HTML page in the folder to files and anchors
"""
import html.parser
import pathlib
import re
import sys
import urllib.parse

broken = []


class Page(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.links, self.anchors = [], set()

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.anchors.add(value)
            if value and ((tag == "a" and name == "href") or name == "src" or (tag == "link" and name == "href")
                          or (tag == "object" and name == "data")):
                self.links.append(value)


def check_html(folder):
    pages = {}
    for file in folder.rglob("*.html"):
        pages[file.resolve()] = page = Page()
        page.feed(file.read_text(errors="replace"))
    for file, page in pages.items():
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or link.startswith(("//", "javascript:")):
                continue
            target = (file.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else file
            if not target.exists():
                broken.append(f"{file.name}: {link}")
            # Doxygen 1.9.4 leaves out the anchor that it links to where all nested classes are private
            elif parts.fragment and parts.fragment != "nested-classes" and target in pages and urllib.parse.unquote(parts.fragment) not in pages[target].anchors:
                broken.append(f"{file.name}: {link} (no such anchor)")
    return len(pages)


def heading_anchor(text):
    text = re.sub(r"[`*]", "", text.strip().lower())
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def check_markdown(source):
    files = [source / "README.md", source / "CONTRIBUTING.md", *sorted(source.glob("docs/**/*.md")),
             *sorted(source.glob("examples/**/*.md"))]
    for file in files:
        text = re.sub(r"```.*?```", "", file.read_text(), flags=re.S)
        text = re.sub(r"`[^`\n]*`", "", text)
        for link in re.findall(r"!?\[[^\]]*\]\(([^)\s]+)\)", text):
            if re.match(r"[a-z]+:", link):
                continue
            path, _, anchor = link.partition("#")
            target = (file.parent / path).resolve() if path else file
            name = f"{file.relative_to(source)}: {link}"
            if not target.exists():
                broken.append(name)
            elif anchor and target.suffix == ".md":
                headings = re.findall(r"^#+ +(.*)$", target.read_text(), flags=re.M)
                if anchor not in [heading_anchor(h) for h in headings]:
                    broken.append(name + " (no such heading)")
    return len(files)


if sys.argv[1] == "--html":
    count = check_html(pathlib.Path(sys.argv[2]))
else:
    count = check_markdown(pathlib.Path(sys.argv[1]).resolve())
print("\n".join(f"broken link: {b}" for b in broken) if broken else f"{count} pages without a broken link")
sys.exit(bool(broken))
