#!/usr/bin/env python3
"""Checks the dependencies of server/, the names of test files and the length of source files: architecture.py ROOT

MODULES lists the modules from the lowest to the highest, with the modules that each may use. The build refuses most wrong
includes already, because only targets that use a module see its headers. This script also checks the USES lines of
CMake, and finds include cycles between files."""
import re
import sys
from pathlib import Path

# A module may use only modules above its own line in this table.
MODULES = {
    "core": set(),
    "compute": {"core"},
    "scene": {"core"},
    "sim": {"compute", "scene", "core"},
    "diagnostics": {"sim", "scene", "core"},
    "measure": {"sim", "scene", "compute", "core"},
    "codec": {"scene", "core"},
    "encode": {"codec", "sim", "compute", "core"},
    "recording": {"codec", "scene", "core"},
    "checkpoint": {"recording", "sim", "scene", "compute", "core"},
    "net": {"codec", "core"},
    "client": {"net", "core"},
    "host": {"net", "checkpoint", "recording", "encode", "diagnostics", "codec", "sim", "scene", "compute", "core"},
    "cli": {
        "host", "client", "measure", "net", "checkpoint", "recording", "encode", "codec", "diagnostics", "sim", "scene",
        "compute", "core",
    },
}
# Quoted includes outside of server/: messages, files embedded at build time, layout of the kernels' data.
SHARED = {"spherule", "embedded", "shared"}
# Modules that take and return plain values: they include no messages.
WITHOUT_MESSAGES = {"core", "compute", "sim", "measure"}

LONGEST = 400
FOLDERS = [".ci", "cmake", "deploy", "proto", "server", "shaders", "tests", "web-viewer"]
SOURCES = {".cpp", ".h", ".comp", ".glsl", ".proto", ".ts", ".mjs", ".css", ".html", ".py", ".sh", ".cmake"}
NOT_OURS = {"node_modules", "dist", "gen"}
TESTS = {".cpp": re.compile(r"^TEST(_F|_P)?\(", re.MULTILINE),
         ".py": re.compile(r"^    def test_", re.MULTILINE)}

INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"/]+)/[^"]*"', re.MULTILINE)
QUOTED = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)
USES = re.compile(r"\bUSES\b([^)]*?)(?:\bSOURCES\b|\bLIBRARIES\b|\))")


def wrong_includes(server):
    for folder in sorted(path for path in server.iterdir() if path.is_dir() and path.name != "scenes"):
        module = folder.name
        if module not in MODULES:
            yield f"server/{module}: not in the architecture; add it to {Path(__file__).name} with the modules it uses"
            continue
        allowed = MODULES[module] | {module} | SHARED
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
            for target in set(used.split()) - MODULES[module] - (set() if module in WITHOUT_MESSAGES else {"proto"}):
                yield f"server/{module}/CMakeLists.txt: {module} may not use {target}"


def upward_modules():
    names = list(MODULES)
    for module, used in MODULES.items():
        for target in sorted(used):
            if names.index(target) >= names.index(module):
                yield f"{Path(__file__).name}: {module} may not use {target}, which is not a lower module"


def include_cycles(server):
    """Follows the quoted includes of the files of server/. Each cycle is reported once, where a walk closes it."""
    includes = {}
    for source in sorted(server.rglob("*")):
        if source.suffix in {".cpp", ".h"}:
            names = QUOTED.findall(source.read_text(encoding="utf-8"))
            found = [path for name in names for path in (server / name, source.parent / name) if path.is_file()]
            includes[source] = [path.resolve() for path in found]
    finished = set()

    def walk(source, path):
        if source in path:
            cycle = [*path[path.index(source):], source]
            yield "include cycle: " + " -> ".join(str(file.relative_to(server.parent)) for file in cycle)
        elif source not in finished:
            for target in includes.get(source, []):
                yield from walk(target, [*path, source])
            finished.add(source)

    for source in includes:
        yield from walk(source, [])


def misnamed_tests(root):
    """Files with tests, and no others, are named SUBJECT_test.cpp or SUBJECT_test.py."""
    for source in sorted((root / "tests").rglob("*")):
        pattern = TESTS.get(source.suffix)
        if pattern and not NOT_OURS & set(source.parts):
            if bool(pattern.search(source.read_text(encoding="utf-8"))) != source.stem.endswith("_test"):
                yield f"{source.relative_to(root)}: files with tests, and no others, end with _test{source.suffix}"


def long_files(root):
    for folder in FOLDERS:
        for source in sorted((root / folder).rglob("*")):
            if source.suffix not in SOURCES or NOT_OURS & set(source.relative_to(root).parts) or not source.is_file():
                continue
            lines = len(source.read_text(encoding="utf-8").splitlines())
            if lines > LONGEST:
                yield f"{source.relative_to(root)}: {lines} lines, more than {LONGEST}"


root = Path(sys.argv[1]).resolve()
server = root / "server"
problems = [*wrong_includes(server), *upward_modules(), *include_cycles(server), *misnamed_tests(root), *long_files(root)]
print("\n".join(problems) or "every include follows the architecture, without a cycle; no file is too long")
sys.exit(1 if problems else 0)
