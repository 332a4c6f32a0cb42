"""The kernels of a folder as GLSL, as server/compute/source.cpp makes it for the driver."""
import re

INCLUDE = re.compile(r'^#include "([^"]+)"$')
BUFFER = re.compile(r"^BUFFER\((\w+), (\w+), (\w+)\)")
FEATURE = re.compile(r"(?:\bHAS|^SHAPE)\((?!FEATURE\b)([A-Z_]+)\b")  # but for its definition and what explains it


def expand(root, name):
    """The lines of a file with its includes in place, each with the file and line it came from."""
    for number, line in enumerate((root / name).read_text(encoding="utf-8").splitlines(), 1):
        included = INCLUDE.match(line)
        if included:
            yield from expand(root, included.group(1))
        else:
            yield f"{name}:{number}", line


def declared(lines):
    """The lines with each buffer declared in GLSL."""
    binding = 0
    for place, line in lines:
        found = BUFFER.match(line)
        if found:
            access, kind, name = found.groups()
            line = f"layout(std430, binding = {binding}) {access} buffer {name}Block {{ {kind} {name}[]; }};"
            binding += 1
        yield place, line


def features_in(lines):
    """The names of the features that the lines test, in order."""
    return sorted({name for _, line in lines for name in FEATURE.findall(line)})


def prologue(features):
    """The lines before the kernel: its version, and a constant for each feature of the dict."""
    return ["#version 450 core"] + [f"#define {name} {str(on).lower()}" for name, on in features.items()]


def names(root):
    return sorted(path.name for path in root.glob("*.comp"))
