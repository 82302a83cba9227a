# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Every relative link in the project's Markdown leads to a file, and every #anchor to a heading."""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
HEADING = re.compile(r"^#+ (.*)$", re.MULTILINE)
FOLDERS = ("docs", "examples", "tests", "benchmarks", ".github")


def anchors(text):
    """As GitHub makes them from headings."""
    headings = HEADING.findall(FENCE.sub("", text))
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def broken_links(path):
    for target in LINK.findall(FENCE.sub("", path.read_text())):
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        name = name.split("?")[0]
        file = (path.parent / name) if name else path
        if not file.exists():
            yield f"{path.relative_to(ROOT)}: {target} does not exist"
        elif anchor and file.suffix == ".md" and anchor not in anchors(file.read_text()):
            yield f"{path.relative_to(ROOT)}: {target} names no heading"


def main():
    pages = sorted(ROOT.glob("*.md"))
    for folder in FOLDERS:
        pages += sorted(page for page in (ROOT / folder).rglob("*.md") if "node_modules" not in page.parts)
    broken = [line for page in pages for line in broken_links(page)]
    print("\n".join(broken) if broken else f"links of {len(pages)} pages hold")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
