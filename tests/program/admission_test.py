#!/usr/bin/env python3
"""Tests tokens, TLS and settings of a server: admission_test.py BINARY."""
import json
import os
import signal
import socket
import ssl
import sys
import time
import unittest
import warnings

from authorities import Authorities
from program import FolderTestCase, runner, wait_for
from serving import Server

BINARY = sys.argv.pop()
VIEWERS = "the-viewers-token-of-a-test"
CONTROLLERS = "the-controllers-token-of-a-test"


call = runner(BINARY, timeout=60)


class ServerTestCase(FolderTestCase):
    def serve(self, *options, **environment):
        return Server(BINARY, "serve", "two-spheres", "--device", "cpu:1", *options, cwd=self.folder,
                      env={**os.environ, **environment})

    def refused(self, *options, **environment):
        done = call("serve", "two-spheres", "--device", "cpu:1", *options, **environment)
        self.assertEqual(done.returncode, 2, done.stderr)
        return done.stderr


class Tokens(ServerTestCase):
    def test_ctl_needs_the_controllers_token(self):
        with self.serve("--controller-token-file", self.write("c", CONTROLLERS + "\n"),
                        SPHERULE_VIEWER_TOKEN=VIEWERS) as server:
            self.assertIn("it asks for a token", "".join(server.greeting))
            none = call("ctl", server.stream, "pause")
            self.assertEqual(none.returncode, 4)
            self.assertIn("this server asks for a token", none.stderr)
            viewer = call("ctl", server.stream, "pause", SPHERULE_TOKEN=VIEWERS)
            self.assertEqual(viewer.returncode, 4)
            self.assertIn("a viewer may not command", viewer.stderr)
            query = call("ctl", server.stream, "query", SPHERULE_TOKEN=VIEWERS)
            self.assertEqual(query.returncode, 0, query.stderr)
            self.assertEqual(call("ctl", server.stream, "pause", SPHERULE_TOKEN=CONTROLLERS).returncode, 0)
            self.assertEqual(server.end(), 0)
            for token in (VIEWERS, CONTROLLERS):
                self.assertNotIn(token, "".join(server.greeting) + server.said)

    def test_tokens_are_read_anew_on_sighup(self):
        tokens = self.write("c", CONTROLLERS)
        with self.serve("--controller-token-file", tokens) as server:
            self.write("c", "another-token-of-a-test")
            os.kill(server.pid, signal.SIGHUP)
            new = {"SPHERULE_TOKEN": "another-token-of-a-test"}
            self.assertTrue(wait_for(lambda: call("ctl", server.stream, "pause", **new).returncode == 0))
            self.assertEqual(call("ctl", server.stream, "pause", SPHERULE_TOKEN=CONTROLLERS).returncode, 4)
            self.write("c", "short")
            os.kill(server.pid, signal.SIGHUP)
            time.sleep(0.5)
            self.assertEqual(call("ctl", server.stream, "resume", **new).returncode, 0)
            self.assertEqual(server.end(), 0)
            self.assertIn("tokens and certificate stay as they were: --controller-token-file: the token has 5 characters",
                          server.said)

    def test_what_cannot_be_meant_is_refused_with_what_to_do(self):
        self.assertIn("other machines can reach this server", self.refused("--listen", "0.0.0.0:0"))
        self.assertIn("give 16 to 256", self.refused(SPHERULE_VIEWER_TOKEN="short"))
        self.assertIn("is empty", self.refused("--viewer-token-file", self.write("e", "")))
        self.assertIn("give one of the two", self.refused("--open", SPHERULE_VIEWER_TOKEN=VIEWERS))
        self.assertIn("give each their own",
                      self.refused(SPHERULE_VIEWER_TOKEN=VIEWERS, SPHERULE_CONTROLLER_TOKEN=VIEWERS))
        self.assertIn("TLS needs a certificate and its key", self.refused("--tls-key", self.write("k", "x")))
        self.assertIn("--origin: is \"example.org\"", self.refused("--origin", "example.org"))
        self.assertIn("--host: is \"*\"", self.refused("--host", "*"))

    def test_a_token_is_no_option(self):
        self.assertNotEqual(call("serve", "--viewer-token", VIEWERS).returncode, 0)


class Tls(ServerTestCase):
    def setUp(self):
        super().setUp()
        self.authorities = Authorities(self.folder)

    def certificate_of(self, server, **limits):
        """Returns TLS version and certificate, as seen by a client that trusts only the root."""
        context = ssl.create_default_context(cafile=self.authorities.root)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a warning that some TLS versions are old
            for name, value in limits.items():
                setattr(context, name, value)
        port = int(server.stream.split(":")[2].split("/")[0])
        with socket.create_connection(("127.0.0.1", port), timeout=10) as plain:
            with context.wrap_socket(plain, server_hostname="localhost") as secure:
                return secure.version(), secure.getpeercert()

    def serve_tls(self, *certificate):
        chain, key = self.authorities.certify(*certificate)
        return chain, key, self.serve("--tls-certificate", chain, "--tls-key", key)

    def test_the_stream_is_reached_by_who_trusts_the_root(self):
        _, _, serving = self.serve_tls("first")
        with serving as server:
            secure = server.stream.replace("ws:", "wss:")
            done = call("ctl", "--ca", self.authorities.root, secure, "query")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("its certificate is refused", call("ctl", secure, "query").stderr)
            self.assertEqual(call("ctl", server.stream, "query").returncode, 4, "in the clear")
            listen = server.stream.split("/")[2]
            healthy = call("health", SPHERULE_LISTEN=listen, SPHERULE_TLS_CERTIFICATE="chain.pem")
            self.assertEqual(healthy.returncode, 0, healthy.stderr)
            self.assertEqual(server.end(), 0)

    def test_a_certificate_of_somebody_else_is_refused(self):
        _, _, serving = self.serve_tls("other", "DNS:other.example")
        with serving as server:
            done = call("ctl", "--ca", self.authorities.root, server.stream.replace("ws:", "wss:"), "query")
            self.assertEqual(done.returncode, 4)
            self.assertIn("its certificate is refused", done.stderr)

    def test_old_versions_are_not_spoken(self):
        _, _, serving = self.serve_tls("first")
        with serving as server:
            self.assertIn(self.certificate_of(server)[0], ("TLSv1.2", "TLSv1.3"))
            self.assertEqual(self.certificate_of(server, maximum_version=ssl.TLSVersion.TLSv1_2)[0], "TLSv1.2")
            with self.assertRaises(ssl.SSLError):
                self.certificate_of(server, minimum_version=ssl.TLSVersion.TLSv1,
                                    maximum_version=ssl.TLSVersion.TLSv1_1)
            metrics = server.fetch("/metrics", ssl.create_default_context(cafile=self.authorities.root))
            self.assertIn('spherule_rejected_total{cause="tls"} 1', metrics)

    def test_a_new_certificate_is_taken_on_sighup_and_a_bad_one_is_not(self):
        chain, key, serving = self.serve_tls("first")
        with serving as server:
            first = self.certificate_of(server)[1]["serialNumber"]
            new_chain, new_key = self.authorities.certify("second")
            os.replace(new_chain, chain)
            os.replace(new_key, key)
            os.kill(server.pid, signal.SIGHUP)
            self.assertTrue(wait_for(lambda: self.certificate_of(server)[1]["serialNumber"] != first))
            second = self.certificate_of(server)[1]["serialNumber"]
            os.replace(self.authorities.certify("third")[0], chain)  # a certificate for another key
            os.kill(server.pid, signal.SIGHUP)
            time.sleep(0.5)
            self.assertEqual(self.certificate_of(server)[1]["serialNumber"], second)
            self.assertEqual(server.end(), 0)
            self.assertRegex(server.said, "tokens and certificate stay as they were: --tls-key: is ")


class Settings(ServerTestCase):
    def printed(self, *options, **environment):
        done = call("serve", "--print-config", *options, **environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_the_command_line_goes_before_the_environment_and_that_before_the_file(self):
        file = self.write("a.toml", "[serve]\nmax-sessions = 11\ndevice = \"cpu:1\"\nsubsteps = 3\n")
        text = self.printed("--config", file, "--substeps", "5", SPHERULE_SUBSTEPS="4", SPHERULE_MAX_SESSIONS="12")
        self.assertIn("max-sessions=12", text)
        self.assertIn('device="cpu:1"', text)
        self.assertIn("substeps=5", text)

    def test_what_is_printed_is_taken_again(self):
        once = self.printed("--max-sessions", "12", "--origin", "https://a.example", "--origin", "https://b.example")
        self.assertIn("https://b.example", once)
        self.assertEqual(self.printed("--config", self.write("b.toml", once)), once)

    def test_a_setting_that_does_not_exist_is_an_error(self):
        done = call("serve", "--config", self.write("c.toml", "[serve]\nmax-session = 3\n"))
        self.assertEqual(done.returncode, 2)
        self.assertIn("max-session", done.stderr)

    def test_a_config_file_that_is_not_there_is_an_error(self):
        self.assertEqual(call("serve", "--config", "/nowhere.toml").returncode, 2)

    def test_lists_are_given_with_commas_in_the_environment(self):
        with self.serve("--open", SPHERULE_HOST="a.example,b.example") as server:
            for host, status in (("b.example", 200), ("c.example", 421)):
                self.assertEqual(server.status("/healthz", Host=host), status)

    def test_the_log_can_be_json(self):
        with self.serve("--log-format", "json") as server:
            self.assertEqual(server.status("/", Host='evil".example'), 421)
            self.assertEqual(server.end(), 0)
            lines = [json.loads(line) for line in server.said.splitlines() if line.startswith("{")]
        rejected = [line for line in lines if line.get("event") == "rejected"]
        self.assertEqual([(line["cause"], line["from"], line["level"]) for line in rejected],
                         [("host", "127.0.0.1", "info")])
        self.assertRegex(rejected[0]["time"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z$")

    def test_health_is_asked_as_a_container_does(self):
        with self.serve() as server:
            listen = server.stream.split("/")[2]
            done = call("health", SPHERULE_LISTEN=listen.replace("127.0.0.1", "0.0.0.0"))
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(json.loads(done.stdout)["state"], "running")
            server.end()
        gone = call("health", "--listen", listen)
        self.assertEqual(gone.returncode, 4)
        self.assertIn("gives no answer", gone.stderr)


if __name__ == "__main__":
    unittest.main()
