# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""What README and Documentation show works: their Python runs, their links lead somewhere."""

import os
import pathlib
import re
import subprocess

import pytest

ROOT = pathlib.Path(__file__).parents[2]
PAGES = sorted(ROOT.glob("*.md")) + sorted(ROOT.glob("*/*.md"))
PLUGIN = "build/lib/paraview-5.11/plugins/Undecimate/Undecimate.so"


@pytest.mark.parametrize("page", ["README.md", "Documentation/plugin.md"])
def test_python(page, tmp_path):
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), re.S)
    assert len(blocks) == 1 and PLUGIN in blocks[0]
    script = tmp_path / "script.py"
    script.write_text(blocks[0].replace(PLUGIN, os.environ["DEMO_PLUGIN"]) + """
fine.UpdatePipeline()
count = fine.GetDataInformation().GetNumberOfPoints()
base = coarse.GetDataInformation().GetNumberOfPoints()
print("nodes", base, count, abs(count - (base + 15559) / 2) <= 0.5)
""", encoding="utf-8")
    result = subprocess.run(
        [os.environ["DEMO_PVPYTHON"], script], cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert result.returncode == 0, result.stderr
    assert "ERR|" not in result.stderr, result.stderr
    assert re.search(r"nodes \d{3} \d{4} True", result.stdout), result.stdout


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links(page):
    for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
        if not target.startswith("http"):
            assert (page.parent / target.split("#")[0]).exists(), f"{page.name}: {target}"


def test_commands_exist():
    for command in re.findall(r"^    (Scripts/\S+)", (ROOT / "README.md").read_text(), re.M):
        assert os.access(ROOT / command, os.X_OK), command


def test_every_page_is_listed():
    listed = set(re.findall(r"\((\w+\.md)\)", (ROOT / "Documentation" / "README.md").read_text()))
    there = {page.name for page in (ROOT / "Documentation").glob("*.md")} - {"README.md"}
    assert listed == there
