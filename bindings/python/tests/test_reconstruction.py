# SPDX-License-Identifier: BSD-2-Clause
"""COLMAP reconstructs a rendered room from our database, at least as well as from its own SIFT; and the examples run."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parent.parent / "examples"


def test_reconstruction(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pycolmap")
    monkeypatch.syspath_prepend(str(EXAMPLES))
    import reconstruct

    ours, sift = reconstruct.compare(1, 5, tmp_path / "room")
    assert ours.views == 5 and ours.points > 100
    assert ours.track > 3.5 and ours.reprojection < 0.4
    assert ours.centres < 5  # mm
    assert ours.centres < sift.centres and ours.reprojection < sift.reprojection


def test_two_views(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    result = subprocess.run([sys.executable, str(EXAMPLES / "two_views.py"), str(tmp_path)], capture_output=True, text=True, check=True)
    assert "essential: rotation 0." in result.stdout
    assert sorted(path.name for path in tmp_path.iterdir()) == ["junctions.png", "matches.png"]
