# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""A fleet of two robots, of which two servers are killed: campaign_test.py BUILD"""

import subprocess
import sys
from pathlib import Path

CAMPAIGN = Path(__file__).resolve().parents[2] / "scripts/fleet_campaign"
SMALL = ["--robots", "2", "--arrays", "2", "--seconds", "8", "--kill", "2"]

sys.exit(subprocess.run([CAMPAIGN, "--build", sys.argv[1], *SMALL], check=False).returncode)
