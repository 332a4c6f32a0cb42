"""Makes certificates for tests with the openssl program: a root, an intermediate, and server certificates."""
import os
import subprocess

LEAF = "basicConstraints=CA:FALSE\nextendedKeyUsage=serverAuth\n"
CA = "basicConstraints=critical,CA:TRUE\nkeyUsage=critical,keyCertSign\n"


class Authorities:
    def __init__(self, folder):
        self._folder = folder
        self.root = self._at("root.pem")
        self._openssl("req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2",
                      "-subj", "/CN=A root of a test", "-keyout", self._at("root.key"), "-out", self.root)
        self._sign("between", "A certifier of a test", CA, "root")

    def certify(self, name, places="DNS:localhost,IP:127.0.0.1"):
        """Makes a certificate; returns the paths of its chain (without the root) and of its key."""
        self._sign(name, name, f"subjectAltName={places}\n{LEAF}", "between")
        chain = self._at(f"{name}-chain.pem")
        with open(chain, "w", encoding="ascii") as out:
            for part in (name, "between"):
                with open(self._at(f"{part}.pem"), encoding="ascii") as file:
                    out.write(file.read())
        return chain, self._at(f"{name}.key")

    def _at(self, name):
        return os.path.join(self._folder, name)

    def _sign(self, name, subject, extensions, by):
        request, certificate, more = self._at(f"{name}.csr"), self._at(f"{name}.pem"), self._at(f"{name}.ext")
        with open(more, "w", encoding="ascii") as file:
            file.write(extensions)
        self._openssl("req", "-new", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes",
                      "-subj", f"/CN={subject}", "-keyout", self._at(f"{name}.key"), "-out", request)
        self._openssl("x509", "-req", "-in", request, "-CA", self._at(f"{by}.pem"), "-CAkey", self._at(f"{by}.key"),
                      "-CAcreateserial", "-days", "2", "-extfile", more, "-out", certificate)

    @staticmethod
    def _openssl(*words):
        subprocess.run(["openssl", *words], check=True, capture_output=True)
