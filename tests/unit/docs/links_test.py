#!/usr/bin/env python3
"""Every link of the documents within the project leads to a file, and to a heading where it names one."""
import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").glob("*.md"))]


def without_code(text):
    return re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)


def anchors(page):
    """The anchors that GitHub gives to the headings of the page."""
    headings = re.findall(r"^#+ (.*)", without_code(page.read_text(encoding="utf-8")), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


class Links(unittest.TestCase):
    def test_links_lead_to_files_and_headings(self):
        broken = []
        for page in PAGES:
            for target in re.findall(r"\]\(([^)\s]+)\)", without_code(page.read_text(encoding="utf-8"))):
                if target.startswith(("http:", "https:")):
                    continue
                name, _, anchor = target.partition("#")
                file = page.parent / name if name else page
                if not file.exists() or anchor and anchor not in anchors(file):
                    broken.append(f"{page.relative_to(ROOT)}: {target}")
        self.assertEqual(broken, [])

    def test_the_front_page_leads_to_every_document(self):
        front = PAGES[0].read_text(encoding="utf-8")
        self.assertEqual([page.name for page in PAGES[1:] if f"{page.name})" not in front], [])

    def test_pictures_are_used(self):
        text = "".join(page.read_text(encoding="utf-8") for page in PAGES)
        self.assertEqual([file.name for file in (ROOT / "docs/images").iterdir() if file.name not in text], [])


if __name__ == "__main__":
    unittest.main()
