# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The table of docs/fleet-plan.md is that of scripts/fleet_plan."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
table = subprocess.run([ROOT / "scripts/fleet_plan"], check=True, capture_output=True, text=True).stdout
is_there = table in (ROOT / "docs/fleet-plan.md").read_text()
print("the document has the table" if is_there else f"docs/fleet-plan.md has another table than:\n{table}")
sys.exit(0 if is_there else 1)
