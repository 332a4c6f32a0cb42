"""Converts the Markdown of docs/ to roff, the language of manual pages. Knows paragraphs, lists, tables, code, and
within lines code, links and emphasis."""
import re

CODE = re.compile(r"(`[^`]+`)")


def escaped(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"^([.'])", r"\\&\1", text, flags=re.MULTILINE)


def bold(text):
    return f"\\fB{escaped(text)}\\fR"


def italic(text):
    return f"\\fI{escaped(text)}\\fR"


def inline(text):
    """A link becomes its text, a link to an address on the web its text and the address."""
    text = re.sub(r"\[([^\]]*)\]\((https?://[^)]*)\)", r"\1 (\2)", text)
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text).replace("\\|", "|").replace("**", "")
    parts = CODE.split(text)
    return "".join(bold(part[1:-1]) if part.startswith("`") else escaped(part) for part in parts)


def paragraph(text):
    return ["", ".PP", inline(text)]


def tagged(tag, text):
    return ["", ".TP", tag, text]


def verbatim(lines):
    return ["", ".PP", ".RS 4", ".nf", *(escaped(line) for line in lines), ".fi", ".RE"]


def cells(row):
    return [cell.strip() for cell in re.split(r"(?<!\\)\|", row.strip().strip("|"))]


def table(rows):
    """The first column becomes tags, and the others their texts: the second as it is, the others with their headings."""
    heading, _, *body = (cells(row) for row in rows)
    made = []
    for first, *others in body:
        texts = others[:1] + [f"{name}: {cell}" for name, cell in zip(heading[2:], others[1:]) if cell]
        made += tagged(inline(first), inline(". ".join(texts)) or "\\&")
    return made


def listed(item):
    return ["", ".IP \\(bu 2", inline(item)]


def blocks(text):
    """The blocks of the text: lists of lines, each a paragraph, a list item, a table or code with its fences."""
    block, fenced = [], False
    for line in [*text.split("\n"), ""]:
        if line.startswith("```"):
            fenced = not fenced
            block.append(line)
        elif fenced:
            block.append(line)
        elif re.match(r"([-*]|\d+\.) ", line) or block and line.startswith("|") != block[0].startswith("|"):
            if block:
                yield block
            block = [line] if line else []
        elif line:
            block.append(line)
        elif block:
            yield block
            block = []
    if block:
        yield block


def converted(text):
    """Returns the lines of roff for the Markdown text, which has no headings."""
    made = []
    for block in blocks(text):
        if block[0].startswith("```"):
            made += verbatim(block[1:-1])
        elif block[0].startswith("|"):
            made += table(block)
        elif item := re.match(r"([-*]|\d+\.) +", block[0]):
            made += listed(" ".join(line.strip() for line in block)[item.end():])
        else:
            made += paragraph(" ".join(line.strip() for line in block))
    return made
