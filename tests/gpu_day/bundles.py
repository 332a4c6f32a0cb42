"""Bundles of tests/gpu_day.sh, for its tests."""
import re
import subprocess
from pathlib import Path

SCRIPT = Path(__file__).resolve().parent.parent / "gpu_day.sh"
PARTS = ("probe", "launches", "compile", "same", "runs", "ladder", "largest", "threads", "codec", "serve", "tests",
         "physics", "methods")
MOST_FILES = 8


def make(folder, build):
    done = subprocess.run([SCRIPT, "bundle", folder, build], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def outcomes(out):
    """The rows of the report, as (what, outcome, log)."""
    rows = re.findall(r"^\| (.*?) \| (.*?) \| .*? s \| (.*?) \|$", (out / "report.md").read_text("utf-8"), re.M)
    assert rows, "the report has no rows"
    return rows


def check_files(out):
    names = sorted(path.name for path in out.iterdir())
    assert len(names) <= MOST_FILES, f"more than {MOST_FILES} files: {names}"


def contents(out):
    return "\n".join(f"== {path.name}\n{path.read_text('utf-8', 'replace')[-6000:]}" for path in sorted(out.iterdir()))
