# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""interface.py HEADER OUT: a C source that defines every function of the header and does nothing.

Its library has the interface's types and no others, so that its ABI fits a page. libdermis_c has the same types, as it
is compiled against the same header, and programs_test.py holds its symbols to those of the header."""

import re
import sys
from pathlib import Path

header, out = map(Path, sys.argv[1:3])
code = re.sub(r"/\*.*?\*/", "", header.read_text(), flags=re.DOTALL)
functions = re.findall(r"^((?:[a-z_]+[ *]+)+dermis_\w+\([^;]*\));", code, flags=re.MULTILINE)
bodies = (f"{function} {{\n  abort();\n}}\n" for function in functions)
out.write_text(f'#include "{header.name}"\n#include <stdlib.h>\n\n' + "\n".join(bodies))
