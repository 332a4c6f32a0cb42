#!/usr/bin/env python3
"""Checks deploy/monitoring/ with a real server and a real Prometheus: monitoring_test.py BINARY"""
import re
import subprocess
import sys
import unittest

import yaml

from facts import ROOT, read
from monitoring import FOLDER, Prometheus, alerts, always_answered, dashboard, panels, rules, selectors, shown
from program import FolderTestCase, wait_for
from serving import Server
from viewer import Viewer

BINARY = sys.argv.pop()
TOKEN = "the-viewers-token-of-a-test"
UNIT_TESTS = ROOT / "tests/deploy/alerts.promtool.yml"
# Refused while a scene is made, as is expected.
WITHOUT_ALERT = {"not_ready"}


def promtool(*words):
    return subprocess.run(["promtool", *map(str, words)], capture_output=True, text=True, check=False)


class Files(FolderTestCase):
    def test_promtool_accepts_the_rules_and_the_configuration(self):
        for words in (("check", "rules", FOLDER / "alerts.yml"),
                      ("check", "config", "--syntax-only", FOLDER / "prometheus.yml")):
            done = promtool(*words)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_each_alert_has_a_severity_and_texts_and_is_in_the_manual(self):
        manual = read("docs/operations.md")
        for alert in alerts():
            with self.subTest(alert["alert"]):
                self.assertIn(alert["labels"]["severity"], {"critical", "warning"})
                self.assertEqual(set(alert["annotations"]), {"summary", "description"})
                self.assertIn(f"| `{alert['alert']}` |", manual)
        named = set(re.findall(r"^\| `(Spherule\w+)` \|", manual, re.MULTILINE))
        self.assertEqual(named, {alert["alert"] for alert in alerts()})

    def test_each_alert_fires_for_the_bad_server_and_not_for_the_good_one(self):
        made = yaml.safe_load(UNIT_TESTS.read_text(encoding="utf-8"))
        names = {alert["alert"] for alert in alerts()}
        for fires in (True, False):
            tested = {test["alertname"] for case in made["tests"] for test in case["alert_rule_test"]
                      if bool(test.get("exp_alerts")) == fires}
            self.assertEqual(tested, names, f"alerts with a test that they fire: {fires}")
        # promtool compares all annotations, so the copy has none.
        copy = rules()
        for alert in alerts(copy):
            del alert["annotations"]
        made["rule_files"] = [self.write("alerts.yml", yaml.safe_dump(copy))]
        done = promtool("test", "rules", self.write("test.yml", yaml.safe_dump(made)))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


class Dashboard(unittest.TestCase):
    def test_each_panel_has_title_unit_and_description(self):
        for panel in panels():
            with self.subTest(panel["title"]):
                self.assertRegex(panel["description"], r"^[A-Z0-9].*\.$")
                self.assertTrue(panel["fieldConfig"]["defaults"]["unit"])
                self.assertTrue(panel["targets"])
                for target in panel["targets"]:
                    self.assertTrue(target["legendFormat"])

    def test_all_queries_use_the_variables(self):
        variables = {one["name"]: one for one in dashboard()["templating"]["list"]}
        self.assertEqual({name: one["type"] for name, one in variables.items()},
                         {"datasource": "datasource", "instance": "query"})
        source = {"type": "prometheus", "uid": "${datasource}"}
        self.assertEqual(variables["instance"]["datasource"], source)
        for panel in panels():
            self.assertEqual(panel["datasource"], source)
            for target in panel["targets"]:
                self.assertEqual(target["datasource"], source)
                for selector in selectors(target["expr"]):
                    self.assertIn('{instance=~"$instance"', selector, panel["title"])

    def test_panels_do_not_overlap(self):
        every = dashboard()["panels"]
        self.assertEqual(len({panel["id"] for panel in every}), len(every))
        taken = set()
        for panel in every:
            place = panel["gridPos"]
            self.assertLessEqual(place["x"] + place["w"], 24)
            cells = {(x, y) for x in range(place["x"], place["x"] + place["w"])
                     for y in range(place["y"], place["y"] + place["h"])}
            self.assertFalse(cells & taken, panel["title"])
            taken |= cells


class Live(FolderTestCase):
    """A server with tokens, and a Prometheus that scrapes it once a second with the configuration of deploy/."""

    def setUp(self):
        super().setUp()
        self.server = self.enterContext(Server(
            BINARY, "serve", "fountain", "--device", "cpu:1", "--contact-sums", "--viewer-token-file",
            self.write("viewer-token", TOKEN), "--checkpoints", self.at("checkpoints"), token=TOKEN, cwd=self.folder))
        self.instance = f"127.0.0.1:{self.server.port}"

    def scrape(self, rules_text):
        """Starts Prometheus, and waits until it has scraped."""
        self.write("alerts.yml", rules_text)
        configuration = yaml.safe_load(read("deploy/monitoring/prometheus.yml"))
        configuration["global"] = {name: "1s" for name in configuration["global"]}
        (job,) = configuration["scrape_configs"]
        job["static_configs"] = [{"targets": [self.instance]}]
        checked = promtool("check", "config", self.write("checked.yml", yaml.safe_dump(configuration)))
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
        prometheus = self.enterContext(Prometheus(self.folder, configuration))
        self.assertTrue(wait_for(lambda: prometheus.values("up == 1")), prometheus.get("targets"))
        return prometheus

    def test_each_expression_has_data(self):
        prometheus = self.scrape(read("deploy/monitoring/alerts.yml"))
        viewer = Viewer(self.server.port, token=TOKEN).wait(lambda one: one.of("frame"))
        queries = [shown(target["expr"], self.instance) for panel in panels() for target in panel["targets"]]
        for alert in alerts():
            queries += [always_answered(alert["expr"]), *selectors(alert["expr"])]
        self.assertEqual(prometheus.unanswered(queries), [])
        self.assertEqual(prometheus.values("count(spherule_spheres)"), [1])
        variable = dashboard()["templating"]["list"][1]["query"]["query"]
        metric = re.fullmatch(r"label_values\((\w+), instance\)", variable).group(1)
        servers = [one["instance"] for one in prometheus.get("series", **{"match[]": metric})]
        self.assertEqual(servers, [self.instance])
        self.assertIsNone(viewer.closed)
        failed = [rule["name"] for group in prometheus.get("rules")["groups"] for rule in group["rules"]
                  if rule["health"] == "err"]
        self.assertEqual(failed, [])
        self.assertEqual([one for one in prometheus.get("alerts")["alerts"] if one["state"] == "firing"], [])

    def test_each_cause_of_a_refusal_has_an_alert_and_a_panel(self):
        every = {label for name, label in self.server.metrics() if name == "spherule_rejected_total"}
        named = {cause for alert in alerts() for selector in selectors(alert["expr"])
                 for cause in re.findall(r'spherule_rejected_total\{cause="(\w+)"', selector)}
        self.assertEqual(every - named, WITHOUT_ALERT)
        of_panels = [re.findall(r'spherule_rejected_total\{[^}]*cause(=~|!~)"([\w|]+)"', target["expr"])
                     for panel in panels() for target in panel["targets"]]
        (sessions, commands) = [found[0] for found in of_panels if found]
        self.assertEqual((sessions[0], commands[0]), ("!~", "=~"))
        self.assertEqual(sessions[1], commands[1])

    def test_alerts_fire(self):
        short = rules()
        for alert in alerts(short):
            if "for" in alert:
                alert["for"] = "1s"
        prometheus = self.scrape(yaml.safe_dump(short))
        for _ in range(40):
            self.assertEqual(self.server.status("/", Host="elsewhere.example.org"), 421)
        refused = wait_for(lambda: prometheus.firing("SpheruleOriginRefused", cause="host"))
        self.assertTrue(refused, prometheus.get("alerts"))
        self.server.end(kill=True)
        down = wait_for(lambda: prometheus.firing("SpheruleDown"))
        self.assertTrue(down, prometheus.get("alerts"))
        self.assertEqual(down["labels"]["severity"], "critical")
        for alert in (refused, down):
            text = " ".join(alert["annotations"].values())
            self.assertIn(self.instance, text)
            self.assertNotRegex(text, r"<error|no value|\{\{")


class Helpers(unittest.TestCase):
    """The queries are derived from the expressions by these functions."""

    def test_comparisons_give_0_or_1(self):
        self.assertEqual(always_answered('up{job="a"} == 0'), 'up{job="a"} == bool 0')
        self.assertEqual(always_answered("spherule_a < 1 and spherule_b > 0"),
                         "spherule_a < bool 1 and spherule_b > bool 0")
        self.assertEqual(always_answered('absent(up{job="a"})'), 'up{job="a"}')

    def test_each_alternative_is_a_selector(self):
        expression = 'rate(spherule_a_total{cause=~"b|c"}[5m]) > 0.02 * rate(spherule_d_total[5m])'
        self.assertEqual(selectors(expression),
                         ['spherule_a_total{cause="b"}', 'spherule_a_total{cause="c"}', "spherule_d_total"])


if __name__ == "__main__":
    unittest.main()
