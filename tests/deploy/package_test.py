#!/usr/bin/env python3
"""Makes the Debian package of the program in the build folder and checks it, without root and without installing it:
package_test.py BUILD. installation_test.py installs it."""
import gzip
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import packing
from facts import ROOT, VERSION

BUILD = Path(sys.argv.pop()).resolve()
BINARY = BUILD / "spherule"
TIME = "1700000000"  # of the source
# Warnings of lintian that stay, with their reasons.
ACCEPTED = {
    "initial-upload-closes-no-bugs": "the package is not part of Debian, so no bug of Debian asks for it",
}


def help_of(*words):
    return subprocess.run([BINARY, *words, "--help"], capture_output=True, text=True, check=True).stdout


def commands():
    return re.findall(r"^  ([a-z]+) ", help_of().partition("\nSubcommands:\n")[2], re.MULTILINE)


def options(text):
    return re.findall(r"^  (?:-\w,)?(--[a-z-]+)", text, re.MULTILINE)


def squeezed(text):
    return re.sub(r"‐\n\s+|\s+", "", text)


def setUpModule():
    """Makes and unpacks the package once for all classes."""
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    Made.package = packing.make(BUILD, folder.name, SOURCE_DATE_EPOCH=TIME)
    Made.root = Path(folder.name) / "root"
    packing.unpack(Made.package, Made.root)


class Made(unittest.TestCase):
    package = root = None


class Package(Made):
    def test_lintian_finds_no_errors_and_only_known_warnings(self):
        # Tests may run as root, which lintian dislikes.
        done = subprocess.run(["lintian", "--allow-root", "--no-cfg", "--fail-on=none", self.package],
                              capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual([line for line in done.stdout.splitlines()
                          if not re.match(r"W: spherule: ", line) or line.split()[2] not in ACCEPTED], [])

    def test_it_has_the_files_of_the_service(self):
        self.assertEqual(self.package.name, f"spherule_{VERSION}-1_{packing.field(self.package, 'Architecture')}.deb")
        for path, source in (("lib/systemd/system/spherule.service", "deploy/systemd/spherule.service"),
                             ("usr/lib/sysusers.d/spherule.conf", "deploy/systemd/sysusers.conf"),
                             ("etc/spherule/serve.toml", "deploy/systemd/serve.toml"),
                             ("usr/share/doc/spherule/README.md", "README.md")):
            self.assertEqual((self.root / path).read_bytes(), (ROOT / source).read_bytes(), path)
        packed = self.root / "usr/share/doc/spherule/changelog.gz"
        self.assertEqual(gzip.decompress(packed.read_bytes()), (ROOT / "CHANGELOG.md").read_bytes())
        done = subprocess.run([self.root / "usr/bin/spherule", "--version"], capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout.strip(), VERSION)
        listed = subprocess.run(["dpkg-deb", "--contents", self.package], capture_output=True, text=True, check=True).stdout
        self.assertEqual({line.split()[1] for line in listed.splitlines()}, {"root/root"})
        for folder in ("nginx", "monitoring"):
            packed, source = self.root / "usr/share/doc/spherule/examples" / folder, ROOT / "deploy" / folder
            self.assertEqual({path.name for path in packed.iterdir()}, {path.name for path in source.iterdir()})

    def test_it_depends_on_the_libraries_of_the_program_and_has_settings_as_conffile(self):
        depends = {one.split()[0] for one in re.split(r"[,|] *", packing.field(self.package, "Depends"))}
        text = (ROOT / "deploy/packages.txt").read_text(encoding="utf-8")
        run = re.search(r"^# == run ==\n(.*?)(?=^# ==)", text, re.MULTILINE | re.DOTALL).group(1)
        libraries = {line for line in run.splitlines() if line and not line.startswith("#")} - {"libglvnd0"}
        # spdlog's package provides a name for each version of its own dependency.
        self.assertLessEqual(libraries - {"libspdlog1.10"} | {"libspdlog1.10-fmt9", "libc6", "systemd"}, depends)
        conffiles = subprocess.run(["dpkg-deb", "--info", self.package, "conffiles"], capture_output=True, text=True,
                                   check=True).stdout
        in_etc = {"/" + str(path.relative_to(self.root)) for path in (self.root / "etc").rglob("*") if path.is_file()}
        self.assertEqual(set(conffiles.split()), in_etc)

    def test_the_copyright_names_all_libraries_of_the_page(self):
        text = (self.root / "usr/share/doc/spherule/copyright").read_text(encoding="utf-8")
        wanted = json.loads((ROOT / "web-viewer/package.json").read_text(encoding="utf-8"))["dependencies"]
        self.assertEqual({name for name in wanted if f"\nFiles: {name}/*\n" not in text}, set())
        named = set(re.findall(r" and |([\w.-]+)", " ".join(re.findall(r"^License: (.*)", text, re.MULTILINE)))) - {""}
        with_text = set(re.findall(r"^License: (\S+)\n (?!\.)", text, re.MULTILINE))
        self.assertEqual(named, with_text)

    def test_two_packages_of_the_same_time_have_the_same_bytes(self):
        with tempfile.TemporaryDirectory() as folder:
            other = packing.make(BUILD, folder, SOURCE_DATE_EPOCH=TIME).read_bytes()
        self.assertEqual(other, self.package.read_bytes())


class Manual(Made):
    """The manual pages, as man shows them."""

    def shown(self, name):
        page = self.root / f"usr/share/man/man1/{name}.1.gz"
        done = subprocess.run(["man", "--warnings", "--local-file", page], capture_output=True, text=True, check=False,
                              env={**os.environ, "LC_ALL": "C.UTF-8", "MANWIDTH": "120"})
        self.assertEqual((done.returncode, done.stderr), (0, ""), name)
        return done.stdout

    def test_each_command_has_a_page_with_its_help(self):
        self.assertGreater(len(commands()), 8)
        for words in ([], *([command] for command in commands())):
            text = help_of(*words)
            page = self.shown("-".join(["spherule", *words]))
            shown = squeezed(page)
            self.assertEqual([option for option in options(text) if option not in page], [], words)
            for line in re.findall(r"^ {30}(\S.*)", text, re.MULTILINE):
                self.assertIn(squeezed(line.replace("`", ""))[1:], shown, words)
            for variable in re.findall(r"Env:(\w+)", text):
                self.assertIn(f"environment:{variable}", shown)
            self.assertNotIn("](", page)

    def test_the_first_page_lists_commands_scenes_and_exit_codes(self):
        page = self.shown("spherule")
        for command in commands():
            self.assertIn(f"spherule-{command}(1)", page)
        for word in ("landslide", "gpu:cuda:N", "EXIT STATUS", "device was lost"):
            self.assertIn(word, page)


class Completion(Made):
    """The completion, as bash calls it."""

    def offered(self, *words):
        """The words that bash offers in place of the last one."""
        script = 'source "$0"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _spherule; printf "%s\\n" "${COMPREPLY[@]}"'
        file = self.root / "usr/share/bash-completion/completions/spherule"
        done = subprocess.run(["bash", "--norc", "-u", "-c", script, file, "spherule", *words], capture_output=True, text=True,
                              check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""), words)
        return done.stdout.split()

    def test_it_offers_every_command_and_every_option(self):
        self.assertEqual(self.offered(""), commands())
        for words in ([], *([command] for command in commands())):
            self.assertEqual(set(options(help_of(*words))) - set(self.offered(*words, "--")), set(), words)
        self.assertEqual(set(self.offered("run", "--rec")), {"--record", "--record-log", "--record-tier", "--record-rate"})

    def test_it_offers_values(self):
        for words in (["run", "--quality", ""], ["run", "box", "--seed", "3", "--quality", "="],
                      ["run", "--quality", "=", ""]):
            self.assertEqual(self.offered(*words), ["fast", "balanced", "accurate"])
        self.assertEqual(self.offered("run", "--quality", "f"), ["fast"])
        self.assertEqual(self.offered("serve", "--config", ""), [])  # bash completes names of files
        for device in self.offered("run", "--device", ""):
            done = subprocess.run([BINARY, "probe", "--device", device], capture_output=True, check=False)
            self.assertIn(done.returncode, (0, 3), device)

    def test_it_offers_scenes_templates_and_commands_of_ctl(self):
        self.assertIn("landslide", self.offered("serve", ""))
        self.assertEqual(self.offered("run", "--device", "cpu", "--no-sleep", "pou"), ["pour"])
        self.assertEqual(self.offered("run", "box", ""), [])
        self.assertEqual(self.offered("scene", ""), ["check", "new", "schema", "fields"])
        self.assertEqual(set(self.offered("scene", "new", "")), {"box", "drum", "empty", "hopper"})
        # bash splits the address at its colons.
        address = ("ws", ":", "//127.0.0.1", ":", "8080/ws")
        self.assertLessEqual({"pause", "set", "spawn", "record"}, set(self.offered("ctl", *address, "")))
        self.assertEqual(self.offered("ctl", *address, "set", ""), [])


if __name__ == "__main__":
    unittest.main()
