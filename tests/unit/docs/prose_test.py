#!/usr/bin/env python3
"""Tests of tests/prose.py: which sentences it finds, and in which texts it looks."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "prose.py"
sys.path.insert(0, str(SCRIPT.parent))
import prose  # noqa: E402

LONG = "The " + "very " * 29 + "end"  # 31 words


def rules(sentence):
    return [finding.rule.split(" (")[0] for finding in prose.findings_of(prose.Text([(1, sentence)]))]


def split(*lines):
    return list(prose.sentences(prose.Text(list(enumerate(lines, 1)))))


def read(suffix, content):
    """The texts of a file with this content, as single lines."""
    path = pathlib.Path("a" + suffix)
    return [" ".join(line.strip() for _, line in text.lines) for text in prose.texts_of(path, content)]


class Sentences(unittest.TestCase):
    def test_sentences_end_with_full_stops_and_keep_their_first_line(self):
        self.assertEqual(split("A sphere falls. It", "meets the floor! Does it?", "Yes"),
                         [(1, "A sphere falls."), (1, "It meets the floor!"), (2, "Does it?"), (3, "Yes")])

    def test_dots_within_a_sentence_end_nothing(self):
        for text in ("Values, e.g. 0.5 or 1.5e3, and files such as plan.cpp, etc. are kept", "J. Smith and E. Jones wrote it",
                     "The list 0, 1, ... continues", "Versions 2.0.2 and 1.7 work"):
            self.assertEqual(len(split(text)), 1, text)

    def test_dots_behind_brackets_and_quotes_end_a_sentence(self):
        self.assertEqual(len(split('It stops (at once.) It said "done." The end')), 3)

    def test_code_links_and_addresses_count_as_one_word(self):
        for markup in ("`a b c d`", "[word](https://example.org/a.b?c d)", "https://example.org/a,b.", "**word**"):
            self.assertEqual(prose.length(prose.plain(markup)), 1, markup)

    def test_code_on_two_lines_moves_no_sentence(self):
        self.assertEqual(split("Run `a", "b` now. It", "works. End"), [(1, "Run ` now."), (2, "It works."), (3, "End")])

    def test_thirty_words_are_enough(self):
        self.assertEqual(rules(LONG + "."), ["long"])
        self.assertEqual(rules(LONG.replace("very ", "", 1) + "."), [])


class Rules(unittest.TestCase):
    def test_constructions_that_have_to_be_decoded_are_found(self):
        for sentence, rule in {
                "Of spheres in order.": "no-subject",
                "Hardly, so that they touch.": "no-subject",
                "Whoever asks waits.": "no-subject",
                "Who asks waits.": "who",
                "A delta comes to who needs no keyframe.": "who",
                "One who listens is asked.": "who",
                "It is done for what has changed.": "what",
                "What is silent is dropped.": "what",
                "Headers and what else there is.": "what",
                "The size is that of the frame.": "that-of",
                "The same of none.": "the-same-of",
                "The same, with so many spheres.": "number",
                "Returns nothing and says whether it did.": "saying",
                "The change is told.": "saying",
                "A sphere left the numbers.": "numbers",
                "No kernel has come to its end.": "ending",
                "All but for the first.": "but-for",
                "Its last word, as it were.": "saying",
                "By and large, by and by.": "idiom",
        }.items():
            self.assertIn(rule, rules(sentence), sentence)

    def test_plain_sentences_pass(self):
        for sentence in ("Returns false when the queue is full.", "The people who watch see it.", "What is a sphere?",
                         "It shows what is missing.", "The server reports which keys are wrong.", "That is all.",
                         "There are so many spheres that the grid grows.", "Those spheres sleep."):
            self.assertEqual(rules(sentence), [], sentence)


class Files(unittest.TestCase):
    def test_markdown_has_paragraphs_items_and_cells_but_no_code(self):
        content = ("# Of headings\n\nOne\ntwo.\n\n- first\n  goes on\n- second\n\n```sh\nOf code\n```\n\n    Of code\n\n"
                   "| a | b \\| c |\n|---|--:|\n| words | 1.5 |\n")
        self.assertEqual(read(".md", content), ["One two.", "first goes on", "second", "a", "b \\| c", "words"])

    def test_comments_are_joined_and_strings_are_none(self):
        content = ('// One\n// two.\n//\n// Three.\nint a = 1\'000; // behind\nauto s = "// no"; char c = \'"\'; // last\n'
                   "/* A block\n * of lines. */\n/** Of one. */\n")
        self.assertEqual(read(".cpp", content), ["One two.", "Three.", "behind", "last", "A block of lines.", "Of one."])

    def test_drawings_and_directives_are_no_prose(self):
        content = "// Text.\n//     a --> b\n// NOLINTNEXTLINE(this)\n// | a | b |\n// - item\n//   goes on\n// 1. other\n"
        self.assertEqual(read(".ts", content), ["Text.", "item goes on", "other"])

    def test_help_texts_are_read(self):
        content = 'add("--for", time, "how long " "it takes");\nadd("key", R"(raw text that is code)");\n'
        literals = [text.lines for text in prose.literals(content)]
        self.assertEqual(literals, [[(1, "how long it takes")]])

    def test_findings_name_file_and_line_and_fail(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "page.md")
            path.write_text(f"Good.\n\nAll is well.\n{LONG}.\n", encoding="utf-8")
            done = subprocess.run([sys.executable, SCRIPT, folder], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 1)
            self.assertEqual(done.stdout, f"{path.resolve()}:4: long (31 words): {LONG}.\n")
            path.write_text("Good.\n", encoding="utf-8")
            done = subprocess.run([sys.executable, SCRIPT, path], capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stdout), (0, ""))


if __name__ == "__main__":
    unittest.main()
