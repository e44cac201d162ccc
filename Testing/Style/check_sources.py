# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks of the sources as text.

    check_sources.py ROOT format CLANG_FORMAT    C++ is formatted as .clang-format says
    check_sources.py ROOT includes               the layers include what they may
    check_sources.py ROOT licences               each source file names its licence
    check_sources.py ROOT xml XMLLINT            XML is well-formed, texts start at column 0
"""

import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

CPP = {".h", ".cpp", ".cxx"}
COMMENTED = CPP | {".py", ".sh", ".cmake", ".xml", ".svg"}
FOLDERS = (
    "Benchmarks CMake Core Data Documentation Examples Filters Plugin Scripts Testing".split()
)


def sources(root, suffixes, folders=FOLDERS):
    """Files of the layers, build folders excepted."""
    found = [
        path
        for folder in folders
        for path in sorted((root / folder).rglob("*"))
        if path.suffix in suffixes or (path.name == "CMakeLists.txt" and ".cmake" in suffixes)
    ]
    if not found:
        sys.exit(f"no sources in {root}")
    return found


def check_format(root, clang_format):
    files = sources(root, CPP)
    result = subprocess.run([clang_format, "--dry-run", "--Werror", "--style=file", *files])
    return [] if result.returncode == 0 else ["format: run clang-format-14 -i on the files above"]


def check_includes(root):
    """Core includes no host toolkit; CGAL, which is GPL, is a matter of Testing alone."""
    rules = [
        (["Core"], r"(vtk|pv|pq|Q[A-Z]|Qt|CGAL/|paraview)", "Core includes no VTK, ParaView, Qt or CGAL"),
        (["Filters", "Plugin", "Examples"], r"CGAL/", "only Testing includes CGAL"),
    ]
    faults = []
    for folders, banned, why in rules:
        pattern = re.compile(r'\s*#\s*include\s*[<"]' + banned)
        for path in sources(root, CPP, folders):
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                if pattern.match(line):
                    faults.append(f"{path.relative_to(root)}:{number}: {why}: {line.strip()}")
    return faults


def check_licences(root):
    faults = []
    for path in sources(root, COMMENTED) + [root / "CMakeLists.txt"]:
        head = path.read_text(encoding="utf-8")[:400]
        for tag in "SPDX-FileCopyrightText: ", "SPDX-License-Identifier: BSD-3-Clause":
            if tag not in head:
                faults.append(f"{path.relative_to(root)}: no {tag.split(':')[0]}")
    return faults


def check_xml(root, xmllint):
    files = sources(root, {".xml", ".svg", ".qrc"})
    faults = []
    if subprocess.run([xmllint, "--noout", *files]).returncode != 0:
        faults.append("xmllint: see above")
        return faults
    for path in sorted((root / "Plugin").glob("*.xml")):
        tree = ElementTree.parse(path)
        for text in tree.iter("Documentation"):
            for line in (text.text or "").splitlines():
                # ParaView reads the text as reStructuredText: an indented line is a quotation.
                if line.startswith(" ") and line.strip():
                    faults.append(f"{path.name}: text not at column 0: {line.strip()}")
        for proxy in tree.iter("SourceProxy"):
            for element in [proxy] + [e for e in proxy if e.tag.endswith("Property")]:
                if element.find("Documentation") is None:
                    faults.append(f"{path.name}: {element.get('name')} has no documentation")
    return faults


def main():
    root, check, *arguments = sys.argv[1:]
    checks = {
        "format": check_format,
        "includes": check_includes,
        "licences": check_licences,
        "xml": check_xml,
    }
    faults = checks[check](pathlib.Path(root), *arguments)
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
