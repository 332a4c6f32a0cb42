#!/usr/bin/env python3
"""Reports sentences that are hard to read: prose.py [--count] [PATH ...]

Reads Markdown, the comments of C++, shaders, TypeScript, JavaScript and protobuf, and the string literals of server/
and web-viewer/src (help texts and messages). A PATH is a file or a folder; without one, the whole project is read.
Prints `file:line: rule: text` for each finding and exits with 1 if there are any. --count prints the number of findings
of each folder in place of the findings."""
import argparse
import collections
import dataclasses
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
DEFAULT = ("README.md", "CHANGELOG.md", "docs", "server", "tests", "shaders", "web-viewer/src", "proto")
SOURCES = {".cpp", ".h", ".c", ".comp", ".glsl", ".vert", ".frag", ".ts", ".mjs", ".proto"}
SKIPPED = {"node_modules", "build", "gen", "golden", "seeds"}
WORDS_AT_MOST = 30

# A rule is a name, a pattern and the better way, which is printed with a finding.
# "^" is the beginning of a sentence. Each pattern stands for constructions that a reader has to decode.
PREPOSITIONS = "about|against|at|behind|beside|by|for|from|in|of|on|than|to|under|with|without"
RULES = [(name, re.compile(pattern), advice) for name, pattern, advice in (
    ("no-subject", r"^(Of|Hardly|Whoever|Whatever|Whose|As what)\b", "begin with the subject"),
    ("who", r"^Who\b(?!.*\?$)|[,;:] who(?= \w+s\b[^,]*,)", "name the person or the program"),
    ("who", rf"\b({PREPOSITIONS}|and|or|[Oo]ne) (who|whoever)\b", "name the person or the program"),
    ("what", r"^What\b(?!.*\?$)", "name the thing"),
    ("what", rf"\b({PREPOSITIONS}|and|or|but|like) (what|whatever)\b(?! to\b)", "name the thing"),
    ("what", r"\bwhat of (it|them|this)\b|\bwhat else\b", "name the thing"),
    ("that-of", r"\b([Tt]hat|[Tt]hose) of\b(?! course)", "repeat the noun"),
    ("the-same-of", r"\b[Tt]he same of\b", "repeat the noun"),
    ("number", r"\b(with|by|for|of) so many\b", "give the number or its name"),
    ("saying", r"\b(says|said|say|saying) whether\b", "write: returns true if"),
    ("saying", r"\b(is|are|was|were|be|been) told\b", "write: reported, notified"),
    ("saying", r"\b(has|have|had|having) a say\b|\bwithout a word\b|\blast word\b", "say it plainly"),
    ("numbers", r"\b(leaves?|left|leaving) the numbers\b", "write: became non-finite"),
    ("ending", r"\b(come|comes|came|coming) to (its|an|their) ends?\b", "write: ends, completed"),
    ("but-for", r"\bbut for\b", "write: except"),
    ("idiom", r"\b(as it were|by and by|of before|ha(ve|s) need of|the one here|may be others)\b", "say it plainly"),
)]

ABBREVIATIONS = {"e.g.", "i.e.", "etc.", "vs.", "cf.", "approx.", "fig.", "no.", "al.", "resp.", "ca.", "eq.", "sec."}


@dataclasses.dataclass
class Text:
    """Prose that belongs together: a paragraph, a list item, a table cell, a comment. `lines`: (number, line)."""
    lines: list


@dataclasses.dataclass
class Finding:
    line: int
    rule: str
    text: str

    def __str__(self):
        return f"{self.line}: {self.rule}: {self.text}"


def plain(text):
    """Markup away: links become their text, code a single word, emphasis nothing. Line breaks stay."""
    def kept(word):
        return lambda found: word + "\n" * found.group().count("\n")

    text = re.sub(r"!?\[([^\]]*)\]\(([^)]*)\)", r"\1", text)
    text = re.sub(r"``.+?``|`[^`]*`", kept("`"), text)
    text = re.sub(r"https?://\S*[^\s.,;:)\]]", "URL", text)
    return text.replace("**", "").replace("<br>", " ")


def sentences(text):
    """The sentences of a Text, each with the number of the line on which it begins."""
    words = []  # (word, line)
    joined = plain("\n".join(line for _, line in text.lines))
    for (number, _), line in zip(text.lines, joined.split("\n")):
        words += [(word, number) for word in line.split()]
    sentence = []
    for position, (word, number) in enumerate(words):
        sentence.append((word, number))
        if ends(word, words[position + 1][0] if position + 1 < len(words) else ""):
            yield sentence[0][1], " ".join(word for word, _ in sentence)
            sentence = []
    if sentence:
        yield sentence[0][1], " ".join(word for word, _ in sentence)


def ends(word, following):
    """Whether a sentence ends with this word."""
    bare = word.rstrip("\"')]*_»”’")
    if not bare or bare[-1] not in ".!?":
        return False
    if bare.lower().lstrip("\"'([*_") in ABBREVIATIONS or re.fullmatch(r"\W*[A-Z]\.", bare):
        return False
    if bare.endswith("..") or re.fullmatch(r"\W+", bare):  # an ellipsis
        return following[:1].isupper()
    return True


def length(sentence):
    return sum(any(character.isalnum() or character == "`" for character in word) for word in sentence.split())


def findings_of(text):
    for line, sentence in sentences(text):
        count = length(sentence)
        if count > WORDS_AT_MOST:
            yield Finding(line, f"long ({count} words)", sentence)
        for name, pattern, advice in RULES:
            found = pattern.search(sentence)
            if found:
                yield Finding(line, f"{name} (\"{found.group().strip()}\": {advice})", sentence)


def markdown(content):
    """The texts of a Markdown file: no code, no headings."""
    fenced = False
    block = []

    def flush():
        nonlocal block
        texts = [Text(block)] if block else []
        block = []
        return texts

    for number, line in enumerate(content.split("\n"), 1):
        stripped = line.strip()
        if stripped.startswith("```"):
            fenced = not fenced
            yield from flush()
        elif fenced:
            continue
        elif not stripped or stripped.startswith("#") or re.match(r" {4,}\S", line) and not block:
            yield from flush()
        elif stripped.startswith("|"):
            yield from flush()
            for cell in re.split(r"(?<!\\)\|", stripped.strip("|")):
                if re.search(r"[A-Za-z]", cell):
                    yield Text([(number, cell)])
        else:
            item = re.match(r"\s*([-*+]|\d+\.) +(.*)", line)
            if item:
                yield from flush()
            block.append((number, item.group(2) if item else stripped))
    yield from flush()


TOKEN = re.compile(
    r'(?P<skip>\b\d[\w\'.]*)'
    r'|(?P<raw>R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)")'
    r'|(?P<string>"(?:\\.|[^"\\\n])*"|`(?:\\.|[^`\\])*`)'
    r"|(?P<character>'(?:\\.|[^'\\\n])*')"
    r'|(?P<line>//[^\n]*)'
    r'|(?P<block>/\*.*?\*/)', re.DOTALL)


def tokens(content):
    """(kind, text, line, column, stands alone on its line) of each comment and string."""
    line = 1
    last = 0
    for token in TOKEN.finditer(content):
        line += content.count("\n", last, token.start())
        last = token.start()
        begin = content.rfind("\n", 0, token.start()) + 1
        alone = not content[begin:token.start()].strip()
        yield token.lastgroup if token.lastgroup != "mark" else "raw", token.group(), line, token.start() - begin, alone


def comments(content):
    """The texts of the comments: line comments that follow each other at one column belong together."""
    block = []
    place = None  # (line, column) of the last line comment

    def finished():
        nonlocal block
        texts = list(paragraphs(block))
        block = []
        return texts

    for kind, text, line, column, alone in tokens(content):
        if kind == "line":
            if not (alone and place == (line - 1, column)):
                yield from finished()
            block.append((line, text.lstrip("/")))
            place = (line, column)
        elif kind == "block":
            yield from finished()
            inner = text[2:-2].lstrip("*").split("\n")
            yield from paragraphs([(line + k, re.sub(r"^\s*\*(?=\s|$)", "", part)) for k, part in enumerate(inner)])
    yield from finished()


def paragraphs(lines):
    """Splits the lines of a comment where one is empty or drawn, or where a list item begins."""
    block = []
    for number, line in lines:
        stripped = line.strip()
        drawn = re.match(r" {5,}\S", line) or not re.search(r"[A-Za-z0-9]{2}", stripped) or stripped.startswith("|")
        directive = re.match(r"(NOLINT|clang-format|eslint|@ts-|prettier|language=|GCOV|IWYU)", stripped)
        item = re.match(r"([-*]|\d+[.)]) +(.*)", stripped)
        if drawn or directive or item:
            if block:
                yield Text(block)
            block = [(number, item.group(2))] if item and not drawn else []
        else:
            block.append((number, stripped))
    if block:
        yield Text(block)


def literals(content):
    """The texts of the string literals: those next to each other are one."""
    block = []
    end = None  # where the last literal ended
    for token in TOKEN.finditer(content):
        if token.lastgroup not in ("string", "character"):
            continue
        joined = end is not None and not content[end:token.start()].strip()
        if not joined and block:
            yield from said(block)
            block = []
        line = content.count("\n", 0, token.start()) + 1
        block.append((line, re.sub(r"\$?\{[^}]*\}", "X", token.group()[1:-1])))
        end = token.end()
    yield from said(block)


def said(block):
    """A literal with several words is prose; literals that are joined may split a word."""
    whole = "".join(part for _, part in block)
    whole = re.sub(r"\\[nt]", "\n", whole).replace('\\"', '"').replace("\\", "")
    if re.search(r"[a-z]+ [a-z]+ [a-z]+", whole):
        for line in whole.split("\n"):
            if not line.startswith("  "):
                yield Text([(block[0][0], line)])


def texts_of(path, content):
    if path.suffix == ".md":
        yield from markdown(content)
        return
    yield from comments(content)
    try:
        folder = path.resolve().relative_to(ROOT).parts[0]
    except ValueError:
        folder = ""
    if folder in ("server", "web-viewer"):
        yield from literals(content)


def files_in(path):
    if path.is_file():
        yield path
        return
    for file in sorted(path.rglob("*")):
        inner = file.relative_to(path).parts
        if file.suffix in SOURCES | {".md"} and file.is_file() and not SKIPPED & set(inner):
            yield file


def check(path):
    content = path.read_text(encoding="utf-8")
    found = [finding for text in texts_of(path, content) for finding in findings_of(text)]
    return sorted(found, key=lambda finding: finding.line)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--count", action="store_true", help="print the number of findings of each folder")
    parser.add_argument("paths", nargs="*", metavar="PATH")
    arguments = parser.parse_args()
    counts = collections.Counter()
    for path in [pathlib.Path(name) for name in arguments.paths] or [ROOT / name for name in DEFAULT]:
        if not path.exists():
            parser.error(f"{path}: there is no such file or folder")
        for file in files_in(path):
            name = file.resolve().relative_to(ROOT) if file.resolve().is_relative_to(ROOT) else file
            for finding in check(file):
                counts[str(name if name.parent == pathlib.Path() else name.parent)] += 1
                if not arguments.count:
                    print(f"{name}:{finding}")
    if arguments.count:
        for folder, count in sorted(counts.items()):
            print(f"{count:5} {folder}")
    return 1 if counts else 0


if __name__ == "__main__":
    sys.exit(main())
