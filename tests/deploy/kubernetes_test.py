#!/usr/bin/env python3
"""Checks the manifests of deploy/kubernetes: the Kubernetes client accepts the output of kubectl, the manifests agree
with the Dockerfile, and the pod has no unnecessary rights."""
import json
import subprocess
import unittest

import yaml
from kubernetes import client

from facts import ROOT, STOP_S, VERSION, Dockerfile, read


def understood(manifest):
    """Returns the manifest as the Kubernetes client reads it: without unknown fields, and with the types of its fields.
    Raises ValueError if a required field is missing."""
    api = client.ApiClient()
    kind = "V1" + manifest["kind"]

    class Answer:
        data = json.dumps(manifest)

    return api.sanitize_for_serialization(api.deserialize(Answer, kind))


def built(overlay):
    """Returns the manifests that `kubectl apply -k` sends, as {kind: manifest}."""
    done = subprocess.run(["kubectl", "kustomize", str(ROOT / "deploy/kubernetes" / overlay)], capture_output=True,
                          text=True, check=True)
    return {manifest["kind"]: manifest for manifest in yaml.safe_load_all(done.stdout)}


class Overlay:
    """Tests of both overlays."""

    def setUp(self):
        self.image = Dockerfile()
        self.made = built(self.name)
        self.pod = self.made["Deployment"]["spec"]["template"]
        self.spec = self.pod["spec"]
        (self.container,) = self.spec["containers"]
        self.environment = {one["name"]: one["value"] for one in self.container["env"]}

    def test_all_of_it_is_what_kubernetes_understands(self):
        self.assertEqual(set(self.made), {"Deployment", "Service", "PersistentVolumeClaim", "NetworkPolicy"})
        for kind, manifest in self.made.items():
            with self.subTest(kind):
                self.assertEqual(understood(manifest), manifest)

    def test_image_and_user_are_the_dockerfiles(self):
        self.assertEqual(self.container["image"], f"spherule:{VERSION}")
        security = self.spec["securityContext"]
        self.assertEqual(security["runAsUser"], int(self.image.user))
        self.assertEqual(security["runAsGroup"], int(self.image.group))
        self.assertEqual(security["fsGroup"], int(self.image.group))

    def test_it_may_do_nothing_that_it_need_not(self):
        security = self.spec["securityContext"]
        self.assertIs(security["runAsNonRoot"], True)
        self.assertEqual(security["seccompProfile"], {"type": "RuntimeDefault"})
        self.assertEqual(self.container["securityContext"], {
            "allowPrivilegeEscalation": False, "readOnlyRootFilesystem": True, "capabilities": {"drop": ["ALL"]}})
        self.assertIs(self.spec["automountServiceAccountToken"], False)
        self.assertIn("memory", self.container["resources"]["limits"])
        # This variable would make all GPUs of the node visible, without the device plugin.
        self.assertNotIn("NVIDIA_VISIBLE_DEVICES", self.environment)

    def test_service_and_policy_lead_to_the_pod(self):
        labels = self.pod["metadata"]["labels"]
        self.assertEqual(self.made["Deployment"]["spec"]["selector"]["matchLabels"], labels)
        self.assertEqual(self.made["Service"]["spec"]["selector"], labels)
        policy = self.made["NetworkPolicy"]["spec"]
        self.assertEqual(policy["podSelector"]["matchLabels"], labels)
        self.assertEqual((policy["policyTypes"], policy["egress"]), (["Ingress", "Egress"], []))
        (port,) = self.container["ports"]
        self.assertEqual(port["containerPort"], self.image.port)
        asked = [self.made["Service"]["spec"]["ports"][0]["targetPort"], policy["ingress"][0]["ports"][0]["port"]]
        probes = [self.container[probe]["httpGet"] for probe in ("startupProbe", "readinessProbe", "livenessProbe")]
        self.assertEqual({*asked, *(probe["port"] for probe in probes)}, {port["name"]})

    def test_the_probes_are_answered_by_the_server(self):
        paths = {probe: self.container[probe]["httpGet"]["path"]
                 for probe in ("startupProbe", "readinessProbe", "livenessProbe")}
        self.assertEqual(paths, {"startupProbe": "/readyz", "readinessProbe": "/readyz", "livenessProbe": "/healthz"})
        routes = read("server/host/http_routes.cpp")
        for path in paths.values():
            self.assertIn(f'path == "{path}"', routes)

    def test_it_has_the_folders_that_it_writes_and_the_tokens(self):
        volumes = {volume["name"]: volume for volume in self.spec["volumes"]}
        at = {mount["mountPath"]: volumes[mount["name"]] for mount in self.container["volumeMounts"]}
        claim = at[self.image.volume]["persistentVolumeClaim"]["claimName"]
        self.assertEqual(claim, self.made["PersistentVolumeClaim"]["metadata"]["name"])
        self.assertIn("emptyDir", at[self.image.environment["XDG_CACHE_HOME"]])
        files = [self.environment[f"SPHERULE_{role}_TOKEN_FILE"] for role in ("VIEWER", "CONTROLLER")]
        self.assertEqual(files, ["/run/secrets/viewer-token", "/run/secrets/controller-token"])
        self.assertIn("secret", at["/run/secrets"])

    def test_it_has_time_to_end_and_room_to_record(self):
        self.assertIn("SPHERULE_CHECKPOINTS", self.environment)
        self.assertGreater(self.spec["terminationGracePeriodSeconds"], STOP_S)
        limit = int(self.environment["SPHERULE_RECORDINGS_LIMIT"].removesuffix("GiB"))
        storage = self.made["PersistentVolumeClaim"]["spec"]["resources"]["requests"]["storage"]
        spheres = 4_000_000  # more than the limit of memory allows
        self.assertGreaterEqual(int(storage.removesuffix("Gi")), limit + 4 * 260 * spheres / 2 ** 30)


class Gpu(Overlay, unittest.TestCase):
    name = "gpu"

    def test_it_gets_one_gpu_and_starts_on_nothing_else(self):
        self.assertEqual(self.container["resources"]["limits"]["nvidia.com/gpu"], "1")
        self.assertEqual(self.spec["runtimeClassName"], "nvidia")
        self.assertEqual(self.environment["SPHERULE_DEVICE"], "gpu")
        self.assertIn("graphics", self.image.environment["NVIDIA_DRIVER_CAPABILITIES"].split(","))


class Cpu(Overlay, unittest.TestCase):
    name = "cpu"

    def test_it_has_a_thread_for_each_processor_that_it_gets(self):
        resources = self.container["resources"]
        self.assertEqual(self.environment["SPHERULE_DEVICE"], "cpu:" + resources["limits"]["cpu"])
        self.assertEqual(resources["limits"]["cpu"], resources["requests"]["cpu"])
        self.assertNotIn("nvidia.com/gpu", resources["limits"])
        self.assertNotIn("runtimeClassName", self.spec)


class Understood(unittest.TestCase):
    """Tests of the function understood()."""

    def test_what_kubernetes_would_refuse_or_drop_is_found(self):
        service = built("cpu")["Service"]
        self.assertEqual(understood(service), service)
        for change in ({"sessionAfinity": "None"}, {"sessionAffinity": True},
                       {"ports": [{"name": "http", "port": "http"}]}, {"ports": [{"name": "http"}]}):
            with self.subTest(change):
                changed = {**service, "spec": {**service["spec"], **change}}
                try:
                    self.assertNotEqual(understood(changed), changed)
                except ValueError:
                    pass


if __name__ == "__main__":
    unittest.main()
