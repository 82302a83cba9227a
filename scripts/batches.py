#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Which sources can be compiled together, as most of the time goes into the headers that they share.

    scripts/batches.py SOURCE...    prints the number of each source's batch, in order, separated by semicolons (for
    CMake);
                                    for a source that is compiled alone it says "alone"

Two sources of a batch have no name in common that their unnamed namespaces declare, but the same names for the same
things of other namespaces, so nobody needs to keep names apart."""

import re
import sys
from pathlib import Path

MOST_TOGETHER = 10
# Sources that are included again for each instruction set, and the headers of the kernel, which contradict those of C.
ALONE = re.compile(r"HWY_TARGET_INCLUDE|#include <asm/")
NOISE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|^\s*#[^\n]*', re.MULTILINE | re.DOTALL)
ALIAS = r"\b(?:namespace|using)\s+\w+\s*=[^;]+;|\busing\s+(?:\w+::)+\w+;"
TOKEN = re.compile(
    ALIAS + r"|namespace\s*\{|[{}()]|\b(?:struct|class|enum class|enum)\s+\w+"
    r"|(?<!::)(?<!public )\b(?!noexcept|static_assert)[A-Za-z_]\w*(?=\s*[({=;\[])"
)


def stays_alone(text):
    return bool(ALONE.search(text))


def alias_of(token):
    """The name that an alias gives and what it stands for: who says the same twice says it once."""
    name, _, meaning = (
        token.rstrip(";").partition("=") if "=" in token else (token.rstrip(";").split("::")[-1], "", token)
    )
    return name.split()[-1], "".join(meaning.split())


def own_names(text):
    """What unnamed namespaces of a source declare, roughly: names with what they are an alias of."""
    names, unnamed, depth, brackets = {}, [], 0, 0
    for token in TOKEN.findall(NOISE.sub(" ", text)):
        if re.match(r"namespace\s*\{", token):
            depth += 1
            unnamed.append(depth)
        elif token == "{":
            depth += 1
        elif token == "}":
            if unnamed and unnamed[-1] == depth:
                unnamed.pop()
            depth -= 1
        elif token in "()":
            brackets += 1 if token == "(" else -1
        elif unnamed and unnamed[-1] == depth and brackets == 0 and not token.isupper():
            name, meaning = alias_of(token) if token.endswith(";") else (token.split()[-1], "")
            names[name] = meaning
    return names


def agree(some, others):
    return all(some[name] and some[name] == others[name] for name in some.keys() & others.keys())


def batches(sources, room, size_of):
    """Lists of `sources` whose names agree, each of at most `room`, of which a source takes size_of(text)."""
    closed, still_open = [], []  # [sources, names, room that is left]
    for source in sources:
        text = Path(source).read_text()
        names, size = own_names(text), size_of(text)
        if stays_alone(text):
            closed.append([source])
            continue
        for batch in still_open:
            if agree(batch[1], names) and size <= batch[2]:
                batch[0].append(source)
                batch[1] |= names
                batch[2] -= size
                break
        else:
            still_open.append([[source], names, room - size])
    return closed + [batch[0] for batch in still_open]


if __name__ == "__main__":
    number_of = {}
    for number, batch in enumerate(batches(sys.argv[1:], MOST_TOGETHER, lambda text: 1)):
        number_of |= {source: str(number) if len(batch) > 1 else "alone" for source in batch}
    print(";".join(number_of[source] for source in sys.argv[1:]), end="")
