"""fetch_validator.py PAGE WORK: puts gltf-validator, as package-lock.json here names it, into WORK. PAGE is the folder of
npm_package.py."""

import sys
from pathlib import Path

sys.path.insert(0, sys.argv[1])
from npm_package import NpmPackage, PackageError  # noqa: E402

try:
    NpmPackage(Path(__file__).parent / "package-lock.json", "gltf-validator").unpack(
        ("package.json", "index.js", "gltf_validator.dart.js", "LICENSE"), "", Path(sys.argv[2]))
except (PackageError, OSError) as error:
    sys.exit(f"gltf-validator: {error}")
