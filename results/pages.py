"""Generated parts of hand-written pages."""

from __future__ import annotations

import re


def with_parts(page, parts):
    """The page with the text after each `<!-- NAME, written by make.py -->` replaced, up to the
    next empty line."""
    for name, text in parts.items():
        head = f"<!-- {name}, written by make.py -->\n"
        page = re.sub(re.escape(head) + r"(?:.+\n)*", lambda _: head + text, page)
    return page
