#!/usr/bin/env python3
"""embed.py OUT FUNCTION BASE FILE...: writes OUT/FUNCTION.cpp and OUT/embedded/FUNCTION.h (see Embed.cmake)."""
import os
import sys

out, function, base, files = sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:]
os.makedirs(os.path.join(out, "embedded"), exist_ok=True)

with open(os.path.join(out, "embedded", function + ".h"), "w", encoding="utf-8") as header:
    header.write(f"""#pragma once

#include <span>
#include <string_view>

namespace spherule::embedded {{

#ifndef SPHERULE_EMBEDDED_FILE
#define SPHERULE_EMBEDDED_FILE
struct File {{
    std::string_view path;
    std::string_view bytes;
}};
#endif

std::span<const File> {function}();

}}  // namespace spherule::embedded
""")


def literal(data):
    """Octal escapes of three digits cannot run into the character that follows."""
    plain = set(b" !#$%&'()*+,-./0123456789:;<=>@ABCDEFGHIJKLMNOPQRSTUVWXYZ[]^_`abcdefghijklmnopqrstuvwxyz{|}~")
    lines = []
    for start in range(0, len(data), 256):
        part = data[start:start + 256]
        lines.append('"' + "".join(chr(b) if b in plain else f"\\{b:03o}" for b in part) + '"')
    return "\n".join(lines) or '""'


with open(os.path.join(out, function + ".cpp"), "w", encoding="utf-8") as source:
    source.write(f'#include "embedded/{function}.h"\n\nnamespace spherule::embedded {{\n\nnamespace {{\n\n')
    for number, path in enumerate(files):
        with open(path, "rb") as file:
            data = file.read()
        source.write(f"constexpr char data{number}[] =\n{literal(data)};\n\n")
    source.write(f"constexpr File files[] = {{\n")
    for number, path in enumerate(files):
        name = os.path.relpath(path, base)
        source.write(f'    {{"{name}", {{data{number}, sizeof(data{number}) - 1}}}},\n')
    source.write("};\n\n}  // namespace\n\n")
    source.write(f"std::span<const File> {function}() {{ return files; }}\n\n}}  // namespace spherule::embedded\n")
