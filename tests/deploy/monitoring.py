"""The files of deploy/monitoring/ as the tests use them, and a real Prometheus."""
import json
import os
import re
import subprocess
import urllib.error
import urllib.parse
import urllib.request

import yaml

from facts import ROOT, read
from program import wait_for

FOLDER = ROOT / "deploy/monitoring"
COMPARISON = re.compile(r" (==|!=|<=|>=|<|>) ")
SELECTOR = re.compile(r"\b(?:up|scrape_\w+|spherule_\w+)(?:\{[^}]*\})?")
ALTERNATIVES = re.compile(r'=~"(\w+(?:\|\w+)+)"')


def dashboard():
    return json.loads(read("deploy/monitoring/grafana-dashboard.json"))


def panels():
    """Returns the panels that show something: without the titles of rows."""
    return [panel for panel in dashboard()["panels"] if panel["type"] != "row"]


def rules():
    return yaml.safe_load(read("deploy/monitoring/alerts.yml"))


def alerts(of=None):
    return [rule for group in (of or rules())["groups"] for rule in group["rules"]]


def always_answered(expression):
    """Returns the expression of an alert with a result also while the alert does not fire. Comparisons give 0 or 1, in
    place of no series."""
    return COMPARISON.sub(r" \1 bool ", re.sub(r"absent\(([^()]*)\)", r"\1", expression))


def selectors(expression):
    """Returns the selectors of the expression. A matcher with alternatives gives a selector for each of them."""
    found = []
    for selector in SELECTOR.findall(expression):
        names = ALTERNATIVES.search(selector)
        for name in names.group(1).split("|") if names else [""]:
            found.append(ALTERNATIVES.sub(f'="{name}"', selector) if name else selector)
    return found


def shown(expression, instance):
    """Returns the expression of a panel as Grafana sends it for one server."""
    return expression.replace("$instance", instance).replace("$__rate_interval", "1m")


class Prometheus:
    """Runs Debian's Prometheus with the configuration (a dict) within a with statement. `folder`: for its files."""

    def __init__(self, folder, configuration):
        self._log = os.path.join(folder, "prometheus.log")
        file = os.path.join(folder, "prometheus.yml")
        with open(file, "w", encoding="utf-8") as out:
            yaml.safe_dump(configuration, out)
        self._command = ["prometheus", "--config.file", file, "--storage.tsdb.path", os.path.join(folder, "data"),
                         "--web.listen-address", "127.0.0.1:0"]

    def __enter__(self):
        with open(self._log, "w", encoding="utf-8") as log:
            self._process = subprocess.Popen(self._command, stdout=log, stderr=log)
        try:
            self._address = wait_for(self._ready)
            if not self._address:
                raise RuntimeError(self._said())
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        self._process.kill()
        self._process.wait()

    def _said(self):
        with open(self._log, encoding="utf-8") as log:
            return log.read()

    def _ready(self):
        """Returns the address, or None while queries would be answered with 503."""
        if self._process.poll() is not None:
            raise RuntimeError(self._said())
        found = re.search(r'msg="Listening on" address=(127\.0\.0\.1:\d+)', self._said())
        if not found:
            return None
        try:
            with urllib.request.urlopen(f"http://{found.group(1)}/-/ready", timeout=60):
                return found.group(1)
        except urllib.error.HTTPError as refusal:
            refusal.close()
            return None

    def get(self, path, **query):
        url = f"http://{self._address}/api/v1/{path}?{urllib.parse.urlencode(query)}"
        with urllib.request.urlopen(url, timeout=60) as answer:
            return json.load(answer)["data"]

    def values(self, expression):
        """Returns the values of all series of the expression, without those that are not a number."""
        result = self.get("query", query=expression)["result"]
        return [float(one["value"][1]) for one in result if one["value"][1] != "NaN"]

    def unanswered(self, expressions, seconds=60):
        """Waits until each expression has a value. Returns those that have none after `seconds`."""
        waiting = set(expressions)

        def all_answered():
            waiting.difference_update([one for one in waiting if self.values(one)])
            return not waiting
        wait_for(all_answered, seconds)
        return sorted(waiting)

    def firing(self, name, **labels):
        """Returns the alert that fires, or None."""
        wanted = {"alertname": name, **labels}
        for alert in self.get("alerts")["alerts"]:
            if alert["state"] == "firing" and wanted.items() <= alert["labels"].items():
                return alert
        return None
