#!/usr/bin/env python3
"""Writes the tables of docs/scene-format.md: scene_tables.py BINARY [--check]

The program prints the tables, which follow from the comments and rules in proto/spherule/v1. A table is between the lines
`<!-- fields: MESSAGE ... -->` and `<!-- end -->`. With --check the page is not written; the exit code is 1 if it is not up
to date."""
import pathlib
import re
import subprocess
import sys

PAGE = pathlib.Path(__file__).resolve().parent / "scene-format.md"
TABLE = re.compile(r"(<!-- fields: (.+?) -->\n).*?(?=<!-- end -->)", re.DOTALL)


def updated(page, binary):
    def table(found):
        words = found.group(2).split()
        done = subprocess.run([binary, "scene", "fields", *words], capture_output=True, text=True, check=True)
        return f"{found.group(1)}\n{done.stdout}\n"

    return TABLE.sub(table, page)


if __name__ == "__main__":
    present = PAGE.read_text(encoding="utf-8")
    wanted = updated(present, sys.argv[1])
    if "--check" in sys.argv:
        if present != wanted:
            sys.exit(f"{PAGE.name} is not up to date: python3 docs/scene_tables.py BINARY writes its tables")
    else:
        PAGE.write_text(wanted, encoding="utf-8")
