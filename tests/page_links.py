#!/usr/bin/env python3
"""Checks that every link between pages names a file that exists, and a heading or anchor of it.

Usage: page_links.py ROOT
"""
import glob
import os
import re
import sys


def anchors_of(text):
    headings = re.findall(r"^#+ (.*)$", text, flags=re.M)
    names = [re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings]
    return {*names, *re.findall(r'<a id="([^"]+)"', text)}


def main():
    os.chdir(sys.argv[1])
    pages = [page for page in sorted(glob.glob("**/*.md", recursive=True))
             if not page.startswith(("build/", "tests/data/")) and not page.endswith("/table.md")]
    texts = {page: open(page, encoding="utf-8").read() for page in pages}
    wrong = []
    for page, text in texts.items():
        for link in re.findall(r"\]\(([^)\s]+)\)", text):
            path, _, anchor = link.partition("#")
            target = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
            if ":" in link:
                continue
            if not os.path.exists(target) or (anchor and anchor not in anchors_of(texts.get(target, ""))):
                wrong.append(f"{page}: {link} is not there")
    print("\n".join(wrong) or f"the links of {len(pages)} pages are right")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
