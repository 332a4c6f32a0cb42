#!/usr/bin/env python3
"""Tests the messages about invalid command lines, variables and files: usage_test.py BINARY."""
import os
import pathlib
import re
import sys
import tempfile
import unittest

from program import runner

BINARY = sys.argv.pop()
call = runner(BINARY, timeout=60)
COMMANDS = pathlib.Path(__file__).resolve().parents[2] / "docs/cli.md"


class Usage(unittest.TestCase):
    def refusal(self, *arguments, variables=None):
        done = call(*arguments, **(variables or {}))
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stdout, "")
        said = done.stderr.splitlines()[-1]
        self.assertTrue(said.startswith("spherule: "), done.stderr)
        return said.removeprefix("spherule: ")

    def test_what_is_unknown_is_named_with_what_is_like_it(self):
        self.assertEqual(self.refusal("rum"), '"rum" is no command (did you mean run?); there are serve, run, play, replay, compare, export, '
                                              'plan, scene, ctl, health, probe, measure; see `spherule --help`')
        self.assertNotIn("did you mean", self.refusal("simulate", "bounce"))
        self.assertEqual(self.refusal("run", "bounce", "--quailty", "fast"),
                         "--quailty: is no option (did you mean --quality?); see `spherule run --help`")
        self.assertEqual(self.refusal("run", "bounce", "box", "--for", "1s"),
                         '"box" is one word too many; see `spherule run --help`')

    def test_the_page_on_commands_names_each_command_and_option(self):
        def help_of(*words):
            done = call(*words, "--help")
            self.assertEqual(done.returncode, 0, done.stderr)
            return done.stdout

        def options(text):
            return re.findall(r"^  (?:-\w,)?(--[a-z-]+)", text, re.MULTILINE)

        page = COMMANDS.read_text(encoding="utf-8")
        general, _, commands = help_of().partition("\nSubcommands:\n")
        commands = re.findall(r"^  ([a-z]+) ", commands, re.MULTILINE)
        self.assertGreater(len(commands), 8)
        begin = page.index("## Options before the command")
        scenes = page.index("## Scenes\n")
        first = page.index("## `spherule serve")
        shared = page.index("`serve` and `play` have the options of access")
        sections = {"": page[begin:scenes]}
        for command in commands:
            section = re.search(rf"^## `spherule {command}\b.*?(?=^## |\Z)", page, re.MULTILINE | re.DOTALL)
            self.assertIsNotNone(section, f"{command} has no section")
            sections[command] = section.group()
            if command in ("serve", "run", "plan"):
                sections[command] += page[scenes:first]
            if command == "play":
                sections[command] += page[shared:page.index("## `spherule run")]
        for command, section in sections.items():
            named = set(re.findall(r"--[a-z-]+", section)) | {"--help"}
            listed = set(options(help_of(command) if command else general)) | {"--help"}
            self.assertEqual(listed - named, set(), f"not in docs/cli.md: {command}")
        everywhere = {option for command in ("", *commands) for option in options(help_of(*command.split()))}
        self.assertEqual(set(re.findall(r"`(--[a-z-]+)`", page)) - everywhere, set(), "in docs/cli.md, not in the program")

    def test_errors_of_usage_have_one_form(self):
        run = ("run", "bounce", "--device", "cpu")
        for arguments, said in {
                (): "A subcommand is required; see `spherule --help`",
                run: "--for is required; see `spherule run --help`",
                (*run, "--for", "soon"): '--for: is "soon"; give a time such as 2s, 250ms or 1.5min; see `spherule run --help`',
                (*run, "--for", "1s", "--substeps", "few"):
                    '--substeps: is "few", must be a whole number, not negative; see `spherule run --help`',
                (*run, "--for", "1s", "--quality", "best"):
                    "--quality: best not in {fast,balanced,accurate}; see `spherule run --help`",
                (*run, "--for", "1s", "--force"):
                    "--force: has nothing to replace; give --record, --dump, --surface-forces or --log; see `spherule run --help`",
                (*run, "--for", "1s", "--dump", "-"):
                    "--dump: cannot be standard output, where the report goes; give it a file; see `spherule run --help`",
                (*run, "--for", "1s", "--record", "-"):
                    "--record: cannot be standard output, where the report goes; give it a file; see `spherule run --help`",
                (*run, "--for", "1s", "--surface-forces", "-"):
                    "--surface-forces: cannot be standard output, where the report goes; give it a file; "
                    "see `spherule run --help`",
                (*run, "--for", "1s", "--surface-forces", "a.csv", "--dump", "a.csv"):
                    "--surface-forces: is the file of --dump; give each its own; see `spherule run --help`",
                ("measure", "--out", "-"): "--out: cannot be standard output: it is a folder; see `spherule measure --help`",
                ("serve", "bounce", "--listen", "here"):
                    '--listen: is "here"; give host:port, such as 127.0.0.1:8080; see `spherule serve --help`',
                ("run", "bounce", "--for", "1s", "--device", "abacus"):
                    '--device: "abacus" is none of auto, gpu, gpu:N (N from 0), gpu:cuda:N (as CUDA counts), cpu, cpu:N (N threads), software; '
                    'see `spherule run --help`',
        }.items():
            self.assertEqual(self.refusal(*arguments), said)

    def test_a_variable_that_cannot_be_read_is_named(self):
        for (name, value), said in {
                ("SPHERULE_MAX_SESSIONS", "abc"): 'is "abc", must be a whole number, not negative',
                ("SPHERULE_OPEN", "perhaps"): 'is "perhaps", must be true or false',
                ("SPHERULE_QUALITY", "best"): "best not in {fast,balanced,accurate}",
                ("SPHERULE_WATCHDOG", "soon"): 'is "soon"; give a time such as 2s, 250ms or 1.5min',
                ("SPHERULE_LISTEN", "here"): 'is "here"; give host:port, such as 127.0.0.1:8080',
                ("SPHERULE_LOG_FORMAT", "loud"): "loud not in {text,json}",
                ("SPHERULE_VIEWER_TOKEN_FILE", "/dev/zero"): "/dev/zero: is a device, must be a regular file",
                ("SPHERULE_CONFIG", "/none"): "/none: there is no such file",
        }.items():
            self.assertEqual(self.refusal("serve", "bounce", "--device", "cpu", variables={name: value}),
                             f"{name}: {said}; see `spherule serve --help`")
        self.assertTrue(self.refusal("serve", "--max-sessions", "abc", variables={"SPHERULE_MAX_SESSIONS": "7"})
                        .startswith("--max-sessions: "))

    def test_only_regular_files_are_read(self):
        with tempfile.TemporaryDirectory() as folder:
            pipe = os.path.join(folder, "pipe.json")
            os.mkfifo(pipe)
            for path, what in (pipe, "is a pipe"), ("/dev/zero", "is a device"), (folder, "is a folder"):
                for arguments in (("run", "{}", "--for", "1s", "--device", "cpu"), ("play", "{}", "--listen", "127.0.0.1:0"),
                                  ("export", "{}", "--format", "csv", "--out", folder + "/out"),
                                  ("serve", "--viewer-token-file", "{}"), ("serve", "--controller-token-file", "{}"),
                                  ("serve", "--tls-certificate", "{}", "--tls-key", "{}"),
                                  ("serve", "--quality-table", "{}"), ("serve", "--config", "{}"),
                                  ("ctl", "--token-file", "{}", "ws://127.0.0.1:1/ws", "pause"),
                                  ("ctl", "--ca", "{}", "ws://127.0.0.1:1/ws", "pause")):
                    said = self.refusal(*(word.format(path) for word in arguments))
                    self.assertIn(f"{path}: {what}, must be a regular file", said)
            self.assertEqual(os.listdir(folder), ["pipe.json"])

    def test_settings_may_be_named_by_a_variable(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "settings.toml")
            with open(path, "w", encoding="utf-8") as file:
                file.write("[serve]\nmax-sessions = 7\n")
            done = call("serve", "--print-config", SPHERULE_CONFIG=path)
        self.assertIn("\nmax-sessions=7\n", done.stdout)


if __name__ == "__main__":
    unittest.main()
