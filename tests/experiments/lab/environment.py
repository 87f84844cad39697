# SPDX-License-Identifier: BSD-2-Clause
"""Where the experiments run: a virtual environment with Python's packages, and a build of the library. Needs nothing but Python."""
import importlib.util
import os
import subprocess
import sys

MARK = "ASJ_EXPERIMENTS_PYTHON"
PROGRAMS = ("asj-cli", "accuracy", "match_room", "noise", "repeatability", "sample-room", "isotropic_junctions", "room_judge")


class Unavailable(Exception):
    """Something that the experiments need is not available here."""


def _has_packages():
    return all(importlib.util.find_spec(name) for name in ("numpy", "cv2", "matplotlib"))


def _has_line_descriptors(python):
    """Whether that Python's OpenCV has what only opencv-contrib has."""
    probe = "import numpy, matplotlib, cv2; cv2.line_descriptor; cv2.SIFT_create()"
    return subprocess.run([python, "-c", probe], capture_output=True).returncode == 0


def _make(folder, requirements):
    python = os.path.join(folder, "bin", "python")
    if os.path.exists(python) and _has_line_descriptors(python):
        return python
    print("experiments: making a virtual environment in %s" % folder, flush=True)
    steps = ([sys.executable, "-m", "venv", folder],
             [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--retries", "1", "--timeout", "20", "-r",
              requirements])
    for step in steps:
        try:
            done = subprocess.run(step, capture_output=True, text=True, timeout=600)
        except subprocess.TimeoutExpired as late:
            raise Unavailable("no virtual environment: %s took more than ten minutes" % " ".join(step[:4])) from late
        if done.returncode != 0:
            lines = (done.stderr or done.stdout).strip().splitlines() or ["no message"]
            raise Unavailable("no virtual environment: %s" % lines[-1])
    return python


def enter(root, here, as_it_is):
    """Goes on in the virtual environment, one thread for each library: what runs beside what is the jobs' affair."""
    if os.environ.get(MARK):
        return
    python = sys.executable
    if not as_it_is:
        python = _make(os.path.join(root, "out", "experiments-python"), os.path.join(here, "requirements.txt"))
    elif not _has_packages():
        raise Unavailable("this Python lacks numpy, OpenCV or matplotlib")
    settings = dict(os.environ, OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1", PYTHONDONTWRITEBYTECODE="1")
    settings[MARK] = python
    os.execve(python, [python, os.path.join(here, "run.py")] + sys.argv[1:], settings)


def build(root):
    """Builds the programs in build-experiments/ and returns that folder."""
    folder = os.path.join(root, "build-experiments")
    print("experiments: building in %s" % folder, flush=True)
    steps = [["meson", "compile", "-C", folder] + list(PROGRAMS)]
    if not os.path.exists(os.path.join(folder, "build.ninja")):
        steps.insert(0, ["meson", "setup", folder, root, "-Dio=enabled", "-Dcli=enabled"])
    for step in steps:
        try:
            done = subprocess.run(step, capture_output=True, text=True)
        except FileNotFoundError as missing:
            raise Unavailable("meson is missing: run sh scripts/test.sh once, it installs what is needed") from missing
        if done.returncode != 0:
            raise Unavailable("cannot build:\n%s" % "\n".join(done.stdout.splitlines()[-20:]))
    return folder
