"""Makes the part of the copyright file about the libraries of the page, which the program contains: from
web-viewer/package-lock.json and from the files that npm has installed."""
import json
import pathlib
import re

VIEWER = pathlib.Path(__file__).resolve().parents[2] / "web-viewer"
# Names of licences in Debian's format. The texts are in the file copyright.
LICENCES = {"MIT": "Expat", "(Apache-2.0 AND BSD-3-Clause)": "Apache-2.0 and BSD-3-Clause"}
# This library has no file with its licence, but notices in its source files.
NOTICES = {"@bufbuild/protobuf": ["2021-2025 Buf Technologies, Inc.", "2008 Google Inc."]}


def holders(name):
    """The holders of the copyright, as the library's own licence file names them."""
    if name in NOTICES:
        return NOTICES[name]
    (file,) = (VIEWER / "node_modules" / name).glob("LICENSE*")
    found = re.findall(r"^Copyright \([cC]\) (.*?)\.?$", file.read_text(encoding="utf-8"), re.MULTILINE)
    if not found:
        raise ValueError(f"{file} names no holder of the copyright")
    return [holder.replace(" by ", " ") for holder in found]


def stanzas():
    packages = json.loads((VIEWER / "package-lock.json").read_text(encoding="utf-8"))["packages"]
    text = ""
    for path, package in packages.items():
        if path and not package.get("dev") and not package.get("optional"):
            name = path.removeprefix("node_modules/")
            text += (f"\nFiles: {name}/*\nCopyright: " + "\n ".join(holders(name)) +
                     f"\nLicense: {LICENCES[package['license']]}\n")
    return text
