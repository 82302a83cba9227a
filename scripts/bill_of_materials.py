#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Usage: bill_of_materials.py BUILD TARGET... > dermis.spdx.json

Prints what targets of a build are made of, with versions and licenses, as JSON of SPDX 2.3."""

import hashlib
import json
import re
import subprocess
import sys
import time
from pathlib import Path

import components

sys.path.append(str(components.ROOT / "bindings/python"))
import build_backend

UNKNOWN = "NOASSERTION"


def reference(name):
    return re.sub(r"[^A-Za-z0-9.-]", "-", name)


def package(component):
    return {
        "SPDXID": f"SPDXRef-{reference(component.name)}",
        "name": component.name,
        "versionInfo": component.version,
        "downloadLocation": UNKNOWN,
        "filesAnalyzed": False,
        "licenseConcluded": UNKNOWN,
        "licenseDeclared": f"LicenseRef-{reference(component.name)}",
        "copyrightText": UNKNOWN,
        "externalRefs": [
            {"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": component.url}
        ],
    }


def document(version, date, parts):
    dermis = package(components.Component("dermis", version, "", f"pkg:pypi/dermis@{version}"))
    dermis["licenseDeclared"] = "Apache-2.0"
    packages = [dermis, *map(package, parts)]
    contents = json.dumps(packages, sort_keys=True)
    relations = [("SPDXRef-DOCUMENT", "DESCRIBES", dermis["SPDXID"])]
    relations += [(dermis["SPDXID"], "DEPENDS_ON", part["SPDXID"]) for part in packages[1:]]
    return {
        "spdxVersion": "SPDX-2.3",
        "dataLicense": "CC0-1.0",
        "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"dermis-{version}",
        "documentNamespace": f"https://dermis.invalid/{version}/{hashlib.sha256(contents.encode()).hexdigest()}",
        "creationInfo": {"created": date, "creators": ["Organization: The dermis authors"]},
        "packages": packages,
        "relationships": [
            {"spdxElementId": one, "relationshipType": kind, "relatedSpdxElement": other}
            for one, kind, other in relations
        ],
        "hasExtractedLicensingInfos": [
            {"licenseId": f"LicenseRef-{reference(part.name)}", "name": part.name, "extractedText": part.license}
            for part in parts
        ],
    }


def main():
    seconds = subprocess.run(
        ["git", "log", "-1", "--format=%ct"], cwd=components.ROOT, check=True, capture_output=True, text=True
    ).stdout
    date = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(int(seconds)))
    parts = components.components(Path(sys.argv[1]), sys.argv[2:])
    json.dump(document(build_backend.version(), date, parts), sys.stdout, indent=1)


if __name__ == "__main__":
    main()
