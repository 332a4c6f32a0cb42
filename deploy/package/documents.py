#!/usr/bin/env python3
"""documents.py BINARY VERSION REVISION MAINTAINER FOLDER: writes the files of /usr/share that are made from the program's
help and from the sources: manual pages, bash's completion, copyright and changelogs."""
import datetime
import email.utils
import gzip
import os
import pathlib
import sys

import completion
import manual
import notices
import usage

PACKAGE = """\
spherule ({version}-{revision}) unstable; urgency=medium

  * Package of Spherule {version}. Its changes are in changelog.gz.

 -- {maintainer}  {date}
"""


def date():
    """The time of the source, which package.sh sets, or now."""
    seconds = float(os.environ.get("SOURCE_DATE_EPOCH", datetime.datetime.now().timestamp()))
    return email.utils.format_datetime(datetime.datetime.fromtimestamp(seconds, datetime.timezone.utc))


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def write_packed(path, text):
    """Writes a gzip file without a time, so that the same text gives the same bytes."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "wb") as file, gzip.GzipFile("", "wb", 9, file, mtime=0) as packed:
        packed.write(text.encode())


def main():
    binary, version, revision, maintainer, folder = sys.argv[1:]
    out = pathlib.Path(folder)
    usages = usage.all_usages(binary)
    for name, text in manual.pages(usages, version).items():
        write_packed(out / "man/man1" / (name + ".gz"), text)
    write(out / "bash-completion/completions/spherule", completion.script(binary, usages))
    write(out / "doc/spherule/copyright", manual.read("deploy/package/copyright") + notices.stanzas())
    write_packed(out / "doc/spherule/changelog.gz", manual.read("CHANGELOG.md"))
    write_packed(out / "doc/spherule/changelog.Debian.gz",
                 PACKAGE.format(version=version, revision=revision, maintainer=maintainer, date=date()))


if __name__ == "__main__":
    main()
