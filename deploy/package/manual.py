"""Makes the manual pages from the program's help and from docs/: one for the program and one for each command."""
import pathlib
import re

import roff

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = "/usr/share/doc/spherule/docs"


def read(path):
    return (ROOT / path).read_text(encoding="utf-8")


def sections(path):
    """The sections of a page of docs/: {heading: text}."""
    first, *others = re.split(r"^## +", read(path), flags=re.MULTILINE)
    return {"": first.split("\n", 1)[1]} | dict(other.split("\n", 1) for other in others)


def section_of(pages, words):
    """The section with the heading that begins with the command."""
    for heading, text in pages.items():
        if re.match(rf"`spherule {words[0]}\b", heading):
            return text
    raise ValueError(f"docs/cli.md has no section `spherule {words[0]}`")


def without_options(text, place="OPTIONS"):
    """The text without its tables of options, which come from the help."""
    return re.sub(r"(:)?\n\n\| option \|.*\n(?:\|.*\n)+", lambda found: f"; see {place}.\n" if found[1] else "\n", text)


def options(entries):
    made = []
    for entry in entries:
        tag = ", ".join(roff.bold(name) for name in entry.names)
        if entry.value:
            tag += " " + roff.italic("|".join(entry.choices) or entry.value)
        facts = ([f"default: `{entry.default}`"] if entry.default else []) + (
            [f"environment: `{entry.variable}`"] if entry.variable else [])
        made += roff.tagged(tag, roff.inline(entry.text + (f" ({'; '.join(facts)})" if facts else "")))
    return made


def option_sections(usage):
    made = []
    for heading, entries in usage.groups.items():
        name = "ARGUMENTS" if heading == "Positionals" else heading.upper()
        made += ["", f".SH {name}" if name in ("ARGUMENTS", "OPTIONS") else f".SS {heading}", *options(entries)]
    return made


def commands(usage):
    """The commands with their manual pages."""
    return [line for entry in usage.commands
            for line in roff.tagged(roff.bold(f"spherule-{entry.name}(1)"), roff.inline(entry.text))]


def examples(words):
    """The examples at the top of docs/cli.md that begin with the command."""
    lines = sections("docs/cli.md")[""].split("\n")
    chosen = [line for line in lines if line.split()[:1 + len(words)] == ["spherule", *words]]
    return ["", ".SH EXAMPLES", *roff.verbatim(chosen)] if chosen else []


def page(usage, version):
    pages = sections("docs/cli.md")
    name = "-".join(["spherule", *usage.words])
    made = [f'.TH {name.upper()} 1 "" "Spherule {version}" "User Commands"', ".SH NAME",
            f"{roff.escaped(name)} \\- {roff.escaped(usage.text.rstrip('.'))}", ".SH SYNOPSIS", roff.bold(usage.synopsis)]
    if usage.words:
        made += ["", ".SH DESCRIPTION", *roff.converted(without_options(section_of(pages, usage.words)))]
    else:
        made += ["", ".SH COMMANDS", *commands(usage)]
    made += option_sections(usage)
    if not usage.words:
        for heading in ("Quantities", "Scenes"):
            made += ["", f".SH {heading.upper()}", *roff.converted(without_options(pages[heading], "spherule-serve(1)"))]
    made += examples(usage.words)
    exit_codes = sections("docs/troubleshooting.md")["Exit codes"].strip().split("\n\n")[0]
    made += ["", ".SH EXIT STATUS", *roff.converted(exit_codes)]
    made += ["", ".SH FILES"]
    made += roff.tagged(roff.bold("/etc/spherule/serve.toml"), "The settings of the service.")
    made += roff.tagged(roff.bold(FOLDER), "The documentation.")
    others = ["spherule(1)"] if usage.words else ["systemctl(1)"]
    return "\n".join([*made, "", ".SH SEE ALSO", ", ".join(roff.bold(other) for other in others)]) + "\n"


def pages(usages, version):
    """The manual pages: {name: text}. `usages`: those of the program and of its commands."""
    return {"-".join(["spherule", *usage.words]) + ".1": page(usage, version)
            for usage in usages if len(usage.words) < 2}
