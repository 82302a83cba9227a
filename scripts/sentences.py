#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Lengths of the sentences in the project's documents.

Usage: scripts/sentences.py [--over WORDS] [FILE...]     without files: README, ARCHITECTURE, CONTRIBUTING, CHANGELOG, docs/

Code, tables, headings, HTML and the targets of links are left out. A piece of code or a formula in `backticks` is one word. An
item of a list ends a sentence, a semicolon or a colon does not. Prints a line a page and one for all; --over prints each longer
sentence and where its paragraph begins. Fails where a sentence has over 40 words, over 3 % have more than 30, or the mean
is over 17.
"""
import argparse
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGES = ("README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/**/*.md", "examples/**/*.md")
LIMIT, LONG, LONG_SHARE, MEAN = 40, 30, 0.03, 17

COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
FENCE = re.compile(r"\s*(`{3,}|~{3,})")
ITEM = re.compile(r"\s*(?:[-*+]|(\d+)[.)])\s+")
NO_PROSE = re.compile(r"\s*(\||#{1,6} |</?[a-z]+[ >/]|\[[^\]]+\]: |[-=*_ ]{3,}$)")
IMAGE = re.compile(r"!\[[^\]]*\]\([^)]*\)")
LINK = re.compile(r"\[([^\]]*)\]\([^)]*\)")
CODE = re.compile(r"(`+)(?!`).+?(?<!`)\1(?!`)|\$[^$]+\$")
SENTENCE_END = re.compile(r"([.!?])['\")\]*_]*\s+(?=\S)")
ABBREVIATION = re.compile(r"(\b(e\.g|i\.e|eqs?|figs?|vs|cf|approx|ca|al|resp|nos?|pp|incl|min|max)\.|\.\.\.?)$", re.IGNORECASE)
WORD = re.compile(r"\w")


def paragraphs(text):
    """(first line, text) of each paragraph and of each item of a list."""
    fence, first, rows, content_indent = None, 0, [], 0
    text = COMMENT.sub(lambda match: "\n" * match.group().count("\n"), text)
    for number, row in enumerate(text.split("\n") + [""], start=1):
        row = row.expandtabs(4)
        indent = len(row) - len(row.lstrip())
        mark, item = FENCE.match(row), ITEM.match(row)
        if item and rows and indent >= content_indent and item.group(1) not in (None, "1"):
            item = None  # a number that ends a sentence
        if row.strip() and not item and not rows and indent < content_indent:
            content_indent = indent  # the list has ended
        is_fence = bool(fence or mark)
        if fence:
            fence = None if mark and mark.group(1).startswith(fence) else fence
        elif mark:
            fence = mark.group(1)
        is_code = is_fence or (not rows and indent >= content_indent + 4)
        ends = not row.strip() or is_code or NO_PROSE.match(row)
        if (ends or item) and rows:
            yield first, " ".join(rows)
            rows = []
        if ends:
            continue
        if item:
            content_indent = item.end()
            row = row[item.end():]
        first = first if rows else number
        rows.append(row.strip())


def sentences(text):
    """(first line of its paragraph, sentence, words) of each sentence. A single word is a label, not a sentence."""
    for line, paragraph in paragraphs(text):
        plain = LINK.sub(r"\1", IMAGE.sub(" ", CODE.sub("code", paragraph)))
        begin = 0
        for end in [*SENTENCE_END.finditer(plain), None]:
            stop = end.end() if end else len(plain)
            if end and ABBREVIATION.search(plain[begin:end.start(1) + 1]):
                continue
            sentence, begin = plain[begin:stop].strip(), stop
            words = sum(1 for word in sentence.split() if WORD.search(word))
            if words > 1:
                yield line, sentence, words


def summary(name, lengths):
    mean = sum(lengths) / max(len(lengths), 1)
    over = [sum(1 for length in lengths if length > limit) for limit in (LONG, LIMIT)]
    print(f"{name:32} {len(lengths):5} sentences, mean {mean:4.1f} words, {over[0]:3} over {LONG}, {over[1]:3} over {LIMIT}")
    return mean <= MEAN and over[0] <= LONG_SHARE * len(lengths) and over[1] == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--over", type=int, help="print every sentence with more words")
    parser.add_argument("files", nargs="*", type=Path)
    options = parser.parse_args()
    pages = options.files or sorted(page for pattern in PAGES for page in ROOT.glob(pattern) if "node_modules" not in page.parts)
    everything = []
    for page in pages:
        found = list(sentences(page.read_text()))
        everything += [words for _, _, words in found]
        for line, sentence, words in found:
            if options.over and words > options.over:
                print(f"{page}:{line}: {words} words: {sentence}")
        if found:
            summary(str(page.relative_to(ROOT) if page.is_relative_to(ROOT) else page), [words for _, _, words in found])
    return 0 if summary("all", everything) else 1


if __name__ == "__main__":
    sys.exit(main())
