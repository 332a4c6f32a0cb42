#!/usr/bin/env python3
"""architecture.py ROOT: who includes whom in server/, and how long our files may be.

The arrows below are the architecture. The build refuses most wrong includes already, because a module's headers are
only visible to targets that use it; this also catches a USES line that should not have been added."""
import re
import sys
from pathlib import Path

ALLOWED = {
    "app": {"net", "measure", "quality", "sim", "store", "frame", "scene", "compute", "core"},
    "measure": {"sim", "scene", "compute", "core"},
    "sim": {"compute", "scene", "core"},
    "quality": {"scene", "core"},
    "frame": {"scene", "core"},
    "store": {"frame", "scene", "core"},
    "net": {"frame", "core"},
    "scene": {"core"},
    "compute": {"core"},
    "core": set(),
}
# Quoted includes that belong to no module: messages, files embedded at build time, kernels' layout.
SHARED = {"spherule", "embedded", "shared"}
# Modules that take and return plain values: they include no messages.
WITHOUT_MESSAGES = {"core", "compute", "sim", "measure"}

LONGEST = 400
FOLDERS = [".ci", "cmake", "deploy", "proto", "server", "shaders", "tests", "web-viewer"]
SOURCES = {".cpp", ".h", ".comp", ".glsl", ".proto", ".ts", ".mjs", ".css", ".html", ".py", ".sh", ".cmake"}
NOT_OURS = {"node_modules", "dist", "gen"}

INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"/]+)/[^"]*"', re.MULTILINE)
USES = re.compile(r"\bUSES\b([^)]*?)(?:\bSOURCES\b|\bLIBRARIES\b|\))")


def wrong_includes(server):
    for folder in sorted(path for path in server.iterdir() if path.is_dir() and path.name != "scenes"):
        module = folder.name
        if module not in ALLOWED:
            yield f"server/{module}: not in the architecture; add it to {Path(__file__).name} with its arrows"
            continue
        allowed = ALLOWED[module] | {module} | SHARED
        if module in WITHOUT_MESSAGES:
            allowed -= {"spherule"}
        for source in sorted(folder.rglob("*")):
            if source.suffix not in {".cpp", ".h"}:
                continue
            for target in INCLUDE.findall(source.read_text(encoding="utf-8")):
                if target not in allowed and not (folder / target).is_dir():
                    yield f"{source.relative_to(server.parent)}: {module} may not include {target}/"
        build = folder / "CMakeLists.txt"
        for used in USES.findall(build.read_text(encoding="utf-8")) if build.exists() else []:
            for target in set(used.split()) - ALLOWED[module] - (set() if module in WITHOUT_MESSAGES else {"proto"}):
                yield f"server/{module}/CMakeLists.txt: {module} may not use {target}"


def long_files(root):
    for folder in FOLDERS:
        for source in sorted((root / folder).rglob("*")):
            if source.suffix not in SOURCES or NOT_OURS & set(source.relative_to(root).parts) or not source.is_file():
                continue
            lines = len(source.read_text(encoding="utf-8").splitlines())
            if lines > LONGEST:
                yield f"{source.relative_to(root)}: {lines} lines, more than {LONGEST}"


root = Path(sys.argv[1])
problems = list(wrong_includes(root / "server")) + list(long_files(root))
print("\n".join(problems) or "every include follows the architecture; no file is too long")
sys.exit(1 if problems else 0)
