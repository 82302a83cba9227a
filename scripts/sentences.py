#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Lengths of the sentences in the project's documents, or in the comments of its code.

Usage: scripts/sentences.py [--over WORDS] [FILE...]     without files: those of make docs
       scripts/sentences.py --comments [--over WORDS] [FILE...]     without files: the production code

Code, tables, headings, HTML and the targets of links are left out. A piece of code or a formula in `backticks` is one
word. An item of a list ends a sentence, a semicolon or a colon does not. Prints a line a page and one for all; --over
prints each longer sentence and where its paragraph begins. Fails where a sentence has over 40 words, over 3 % have
more than 30, or the mean is over 17.

--comments reads // and /* */ of C++ and TypeScript, # and docstrings of Python. Comments on rows below each other are
one; rows of formulas and tables are left out. A comment beside code is a label, not a sentence, where it has no full
stop or at most six words ("///< Each line [ohm]"). Prints the sentences with over 25 words and those that begin with
"What" or "Of". Fails where the first are over 1 % or the second over 40.
"""

import argparse
import io
import re
import sys
import tokenize
from pathlib import Path

from source_folders import PRODUCTION

ROOT = Path(__file__).resolve().parent.parent
PAGES = ("README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/**/*.md", "examples/**/*.md")
LIMIT, LONG, LONG_SHARE, MEAN = 40, 30, 0.03, 17

CODE_FOLDERS = (*PRODUCTION, "viewer/src")
CODE_SUFFIXES = (".cpp", ".hpp", ".h", ".ts", ".py", ".pyi")
COMMENT_LIMIT, COMMENT_LONG_SHARE, COMMENT_OBLIQUE, LABEL_WORDS = 25, 0.01, 40, 6
OBLIQUE = re.compile(r"(What|Of)\b")
TEXT_OR_COMMENT = re.compile(
    r"""R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<!\w)'(?:\\.|[^'\\\n])*'|`(?:\\.|[^`\\])*`|(//[^\n]*|/\*.*?\*/)""",
    re.DOTALL,
)
MARKS = re.compile(r"^\s*(?:///?<?|/\*\*?<?|\*/|\*|#)|\*/$")
FORMULA = re.compile(r" {3,}\S|.*\S {3,}\S")  # or a row of a table
NO_COMMENT = re.compile(r"\s*(SPDX-|NOLINT|clang-format|biome-|eslint-|@ts-|!/|type: |pylint|ruff|noqa|namespace |\})")

COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
FENCE = re.compile(r"\s*(`{3,}|~{3,})")
ITEM = re.compile(r"\s*(?:[-*+]|(\d+)[.)])\s+")
NO_PROSE = re.compile(r"\s*(\||#{1,6} |</?[a-z]+[ >/]|\[[^\]]+\]: |[-=*_ ]{3,}$)")
IMAGE = re.compile(r"!\[[^\]]*\]\([^)]*\)")
LINK = re.compile(r"\[([^\]]*)\]\([^)]*\)")
CODE = re.compile(r"(`+)(?!`).+?(?<!`)\1(?!`)|\$[^$]+\$")
SENTENCE_END = re.compile(r"([.!?])['\")\]*_]*\s+(?=\S)")
ABBREVIATION = re.compile(
    r"(\b(e\.g|i\.e|eqs?|figs?|vs|cf|approx|ca|al|resp|nos?|pp|incl|min|max)\.|\.\.\.?)$", re.IGNORECASE
)
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
            row = row[item.end() :]
        first = first if rows else number
        rows.append(row.strip())


def sentences(text):
    """(first line of its paragraph, sentence, words) of each sentence. A single word is a label, not a sentence."""
    for line, paragraph in paragraphs(text):
        plain = LINK.sub(r"\1", IMAGE.sub(" ", CODE.sub("code", paragraph)))
        begin = 0
        for end in [*SENTENCE_END.finditer(plain), None]:
            stop = end.end() if end else len(plain)
            if end and ABBREVIATION.search(plain[begin : end.start(1) + 1]):
                continue
            sentence, begin = plain[begin:stop].strip(), stop
            words = sum(1 for word in sentence.split() if WORD.search(word))
            if words > 1:
                yield line, sentence, words


def remarks(path):
    """(row, column, code before it, text) of each row of a comment or docstring; column 0 where it continues one."""
    text = path.read_text()
    if path.suffix.startswith(".py"):
        before = tokenize.NEWLINE
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            is_docstring = token.type == tokenize.STRING and before in (tokenize.NEWLINE, tokenize.INDENT, tokenize.NL)
            if token.type == tokenize.COMMENT or is_docstring:
                yield from rows_of(token.start[0], token.line[: token.start[1]], token.string.strip("\"'"))
            before = token.type
        return
    for match in TEXT_OR_COMMENT.finditer(text):
        if match.group(2):
            row_begin = text.rfind("\n", 0, match.start()) + 1
            yield from rows_of(text.count("\n", 0, row_begin) + 1, text[row_begin : match.start()], match.group(2))


def rows_of(first, before, text):
    for row, line in enumerate(text.split("\n"), start=first):
        yield (row, len(before) + 1, before, line) if row == first else (row, 0, "", line)


def comments(path):
    """(first row, prose) of each comment of a file, labels beside code left out."""
    blocks, last, last_column = [], -1, 0
    for row, column, before, text in remarks(path):
        text = MARKS.sub("", text.strip())
        if NO_COMMENT.match(text):
            continue
        if blocks and row == last + 1 and not before.strip() and column in (0, last_column):
            blocks[-1][1].append(text)
        else:
            blocks.append((row, [text], bool(before.strip())))
        last, last_column = row, column or last_column
    for row, rows, is_beside in blocks:
        is_sentence = rows[-1].rstrip().endswith((".", "?", "!")) and len(" ".join(rows).split()) > LABEL_WORDS
        if not is_beside or is_sentence:
            yield row, "\n".join("" if FORMULA.match(line) else line.strip() for line in rows)


def judge_comments(files, over):
    """Prints the sentences that are long or oblique; whether they are few enough."""
    found = [
        (path, first + line - 1, sentence, words)
        for path in files
        for first, text in comments(path)
        for line, sentence, words in sentences(text)
    ]
    long = [one for one in found if one[3] > COMMENT_LIMIT]
    oblique = [one for one in found if OBLIQUE.match(one[2])]
    for path, line, sentence, words in found:
        if words > (over or COMMENT_LIMIT) or OBLIQUE.match(sentence):
            print(f"{path.relative_to(ROOT)}:{line}: {words} words: {sentence}")
    print(f"{len(found)} sentences, {len(long)} over {COMMENT_LIMIT} words, {len(oblique)} begin with What or Of")
    return len(long) <= COMMENT_LONG_SHARE * len(found) and len(oblique) <= COMMENT_OBLIQUE


def summary(name, lengths):
    mean = sum(lengths) / max(len(lengths), 1)
    over = [sum(1 for length in lengths if length > limit) for limit in (LONG, LIMIT)]
    print(
        f"{name:32} {len(lengths):5} sentences, mean {mean:4.1f} words, {over[0]:3} over {LONG}, "
        f"{over[1]:3} over {LIMIT}"
    )
    return mean <= MEAN and over[0] <= LONG_SHARE * len(lengths) and over[1] == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--over", type=int, help="print every sentence with more words")
    parser.add_argument("--comments", action="store_true", help="read the comments of code")
    parser.add_argument("files", nargs="*", type=Path)
    options = parser.parse_args()
    if options.comments:
        code = options.files or sorted(
            path
            for folder in CODE_FOLDERS
            for path in (ROOT / folder).rglob("*")
            if path.suffix in CODE_SUFFIXES and "node_modules" not in path.parts
        )
        return 0 if judge_comments([path.resolve() for path in code], options.over) else 1
    pages = options.files or sorted(
        page for pattern in PAGES for page in ROOT.glob(pattern) if "node_modules" not in page.parts
    )
    everything = []
    for page in pages:
        found = list(sentences(page.read_text()))
        everything += [words for _, _, words in found]
        for line, sentence, words in found:
            if options.over and words > options.over:
                print(f"{page}:{line}: {words} words: {sentence}")
        if found:
            summary(
                str(page.relative_to(ROOT) if page.is_relative_to(ROOT) else page), [words for _, _, words in found]
            )
    return 0 if summary("all", everything) else 1


if __name__ == "__main__":
    sys.exit(main())
