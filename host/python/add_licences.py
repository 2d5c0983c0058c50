"""Adds to a repaired wheel the copyright files of the Debian packages whose libraries it holds.

usage: add_licences.py WHEEL; the wheel is replaced.
"""

import pathlib
import re
import subprocess
import sys
import tempfile


def packages_of(libraries):
    """The packages that the libraries of these names (without auditwheel's hash) come from."""
    named = [re.sub(r"-[0-9a-f]{8}(?=\.)", "", library.name) for library in libraries]
    cache = subprocess.run(["/sbin/ldconfig", "-p"], capture_output=True, text=True, check=True).stdout
    # auditwheel names a library as its file is named, not as the loader finds it.
    files = [pathlib.Path(path).resolve() for path in re.findall(r" => (\S+)$", cache, re.MULTILINE)]
    file_of = {file.name: file for file in files}
    packages = set()
    for name in named:
        real = file_of[name]
        for path in (str(real), str(real).removeprefix("/usr")):
            found = subprocess.run(["dpkg", "-S", path], capture_output=True, text=True)
            if found.returncode == 0:
                packages.add(found.stdout.split(":")[0])
                break
        else:
            raise SystemExit(f"{name}: no package has {real}")
    return sorted(packages)


def main():
    wheel = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        run = [sys.executable, "-m", "wheel"]
        subprocess.run([*run, "unpack", wheel, "--dest", folder], check=True, stdout=subprocess.DEVNULL)
        (root,) = pathlib.Path(folder).iterdir()
        licences = next(root.glob("*.dist-info")) / "licenses" / "libraries"
        licences.mkdir(parents=True, exist_ok=True)
        packages = packages_of(sorted(root.glob("emax.libs/*")))
        for package in packages:
            text = pathlib.Path(f"/usr/share/doc/{package}/copyright").read_bytes()
            (licences / f"{package}.copyright").write_bytes(text)
        subprocess.run([*run, "pack", root, "--dest-dir", wheel.parent], check=True, stdout=subprocess.DEVNULL)
    print(f"{wheel.name}: licences of {len(packages)} packages")


main()
