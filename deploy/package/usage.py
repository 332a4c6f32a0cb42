"""Reads the help of the program: its commands and their options. For manual.py and completion.py."""
import dataclasses
import re
import subprocess

INDENT = 30  # column of the descriptions in a help


@dataclasses.dataclass
class Entry:
    """An option, a positional argument or a command."""
    names: list  # such as ["-v", "--verbose"], ["scene"]
    value: str  # its kind, such as TEXT; empty for a flag
    choices: list  # the only allowed values; empty: any
    default: str
    variable: str  # of the environment
    text: str

    @property
    def name(self):
        return self.names[-1]


@dataclasses.dataclass
class Usage:
    """The help of a command. `words`: the command with the commands above it, such as ["scene", "check"]."""
    words: list
    text: str  # the first line
    synopsis: str
    groups: dict  # {heading: [Entry]}, without commands
    commands: list  # [Entry]
    notes: dict  # {heading: [line]} of the sections that follow, such as exit codes

    @property
    def options(self):
        return [entry for group in self.groups.values() for entry in group if entry.name.startswith("-")]


ENTRY = re.compile(r"(?P<names>\S+)(?: (?!REQUIRED\b)(?P<value>[A-Z]{2,})(?P<more>[:=]\S*)?)?( .*)?")


def entry_of(name, text):
    found = ENTRY.fullmatch(name)
    # The help names no kind of value for --config.
    value, more = found["value"] or ("TEXT" if found["names"] == "--config" else ""), found["more"] or ""
    choices = re.search(r"\{(.*)\}", more)
    default = re.search(r"=(\S+)$", re.sub(r" (\(Env|Needs|REQUIRED).*", "", name))
    variable = re.search(r"\(Env:(\w+)\)", name)
    return Entry(found["names"].split(","), value, choices[1].split(",") if choices else [],
                 default[1] if default else "", variable[1] if variable else "", " ".join(text.split()))


def entries_of(lines):
    """The entries of a group. A name that reaches the column of the descriptions has its description on the next line."""
    entries = []
    for line in lines:
        if line.startswith(" " * INDENT):
            name, text = entries.pop()
            entries.append((name + text if name.endswith(" ") else name, line))
        elif len(line) > INDENT and line[INDENT - 1] == " ":
            entries.append((line[:INDENT], line[INDENT:]))
        else:
            entries.append((line, ""))
    return [entry_of(name.strip(), text) for name, text in entries]


def parse(words, text):
    head, *rest = text.rstrip("\n").split("\n")
    synopsis = ""
    sections = {}
    for line in rest:
        if line.startswith("Usage: "):
            synopsis = line.removeprefix("Usage: ")
        elif line and not line.startswith(" "):
            lines = sections.setdefault(line.rstrip(":"), [])
        elif line:
            lines.append(line)
    notes = {name: sections.pop(name) for name in ("Exit codes", "Commands") if name in sections}
    commands = entries_of(sections.pop("Subcommands", []))
    return Usage(words, head, synopsis, {name: entries_of(lines) for name, lines in sections.items()}, commands, notes)


def usage_of(binary, *words):
    done = subprocess.run([binary, *words, "--help"], capture_output=True, text=True, check=True)
    return parse(list(words), done.stdout)


def all_usages(binary):
    """The program and its commands, each before the commands below it."""
    found = [usage_of(binary)]
    for usage in found:
        found += [usage_of(binary, *usage.words, command.name) for command in usage.commands]
    return found
