"""The locked package `three`: fetched once, checked by its checksum, unpacked as far as it is used."""

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

LOCK = Path(__file__).parent / "package-lock.json"
# What the page bundles, as paths in the package.
MEMBERS = ("package.json", "LICENSE", "build/three.module.js", "build/three.core.js",
           "examples/jsm/controls/OrbitControls.js")
DEFAULT_REGISTRY = "https://registry.npmjs.org/"


class PackageError(Exception):
    """One line: what is wrong, and the remedy."""


def locked():
    """(version, integrity) of package-lock.json."""
    entry = json.loads(LOCK.read_text())["packages"]["node_modules/three"]
    return entry["version"], entry["integrity"]


def check(data, integrity, name):
    method, expected = integrity.split("-", 1)
    found = base64.b64encode(hashlib.new(method, data).digest()).decode()
    if found != expected:
        raise PackageError(f"{name}: the checksum is not that of {LOCK.name}; fetch the package again")


def by_npm(version):
    """npm knows its registry, its proxy and its certificates."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(["npm", "pack", "--silent", f"three@{version}"], cwd=folder,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True)
        found = list(Path(folder).glob("*.tgz"))
        if done.returncode != 0 or len(found) != 1:
            raise OSError(f"npm pack: {(done.stderr.strip() or 'no package').splitlines()[-1]}")
        return found[0].read_bytes()


def by_url(version):
    registry = os.environ.get("npm_config_registry") or os.environ.get("NPM_CONFIG_REGISTRY")
    url = f"{(registry or DEFAULT_REGISTRY).rstrip('/')}/three/-/three-{version}.tgz"
    with urllib.request.urlopen(url, timeout=120) as answer:
        return answer.read()


def fetch(version):
    fetched_by = by_npm if shutil.which("npm") else by_url
    try:
        return fetched_by(version)
    except (OSError, urllib.error.URLError):
        pass  # downloads fail now and then
    try:
        return fetched_by(version)
    except (OSError, urllib.error.URLError) as error:
        raise PackageError(f"three-{version}.tgz: cannot be fetched ({error}); give a folder that has "
                           "it: cmake -DEMAX_THREE=FOLDER") from error


def package_bytes(given, work):
    """The package of the folder `given`, or that of `work`, where it is fetched to if it is missing."""
    version, integrity = locked()
    name = f"three-{version}.tgz"
    if given:
        try:
            data = (Path(given) / name).read_bytes()
        except OSError as error:
            raise PackageError(f"{given}: no {name} ({error.strerror}); `npm pack three@{version}` "
                               "writes it") from error
        check(data, integrity, Path(given) / name)
        return data
    kept = work / name
    if kept.is_file():
        try:
            check(kept.read_bytes(), integrity, kept)
            return kept.read_bytes()
        except PackageError:
            kept.unlink()
    data = fetch(version)
    check(data, integrity, name)
    partial = work / f"{name}.partial"
    partial.write_bytes(data)
    partial.replace(kept)
    return data


def unpack(given, work):
    """Puts MEMBERS into work/node_modules/three. Raises PackageError."""
    work.mkdir(parents=True, exist_ok=True)
    folder = work / "node_modules" / "three"
    with tarfile.open(fileobj=io.BytesIO(package_bytes(given, work)), mode="r:gz") as archive:
        for member in MEMBERS:
            path = folder / member
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(archive.extractfile(f"package/{member}").read())
    return folder
