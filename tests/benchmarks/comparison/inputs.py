"""inputs.py FOLDER: the files that the tools of the comparison are given. Python's library writes them, or, where a
format takes more, laspy and libE57Format; nothing of emax does. inputs.json says what each file holds."""

import json
import struct
import sys
import zipfile
from pathlib import Path

import laspy
import numpy as np
import pye57

FOLDER = Path(sys.argv[1])
COUNT = 1000
# As surveys have them: metres in a national grid, told to the millimetre.
ORIGIN = np.array([691234.567, 5334567.891, 512.345])
random = np.random.default_rng(26)
points = ORIGIN + np.round(random.uniform(0, 40, (COUNT, 3)), 3)
# A double pyramid, small and near the origin.
corners = np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, 1.5], [0, 0, -1.5]])
faces = np.array([[i, (i + 1) % 4, 4] for i in range(4)] + [[(i + 1) % 4, i, 5] for i in range(4)], dtype=np.uint32)
told = {}


def rows(values, separator=" "):
    return "".join(separator.join(repr(float(v)) for v in row) + "\n" for row in values)


def put(name, data, kind, group):
    path = FOLDER / name
    if data is not None:
        path.write_bytes(data if isinstance(data, bytes) else data.encode())
    told[name] = {"kind": kind, "group": group}
    return path


def cloud(name, data, unit=None):
    put(name, data, "cloud", "clouds")
    told[name].update(points=COUNT, triangles=0, low=points.min(0).tolist(), high=points.max(0).tolist(), unit=unit)


def mesh(name, data, unit=None):
    put(name, data, "mesh", "meshes")
    told[name].update(points=len(corners), triangles=len(faces), low=corners.min(0).tolist(), high=corners.max(0).tolist(), unit=unit)


def ply_header(form, count, properties, triangles=None):
    face = "" if triangles is None else f"element face {triangles}\nproperty list uchar int vertex_indices\n"
    return f"ply\nformat {form} 1.0\nelement vertex {count}\n" + "".join(
        f"property double {p}\n" for p in properties) + face + "end_header\n"


def write_clouds():
    cloud("text.ply", ply_header("ascii", COUNT, "xyz") + rows(points))
    cloud("binary.ply", ply_header("binary_little_endian", COUNT, "xyz").encode() + points.astype("<f8").tobytes())
    cloud("cloud.xyz", rows(points))
    cloud("cloud.pts", f"{COUNT}\n" + rows(points))
    pcd = ("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\n"
           f"WIDTH {COUNT}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {COUNT}\nDATA binary\n")
    cloud("cloud.pcd", pcd.encode() + points.astype("<f8").tobytes())
    ptx = f"{COUNT}\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n" + " ".join(map(repr, ORIGIN.tolist())) + " 1\n"
    cloud("cloud.ptx", ptx + "".join(line + " 0.5\n" for line in rows(points - ORIGIN).splitlines()))
    header = laspy.LasHeader(version="1.4", point_format=6)
    header.scales, header.offsets = [0.001] * 3, np.floor(ORIGIN)
    las = laspy.LasData(header)
    las.x, las.y, las.z = points.T
    for name in ("cloud.las", "cloud.laz"):
        cloud(name, None)
        las.write(FOLDER / name)
    cloud("cloud.e57", None, "m")
    # libE57Format's Python writes 32 bits, so the scan has its place by its pose.
    scan = {"cartesian" + axis.upper(): points[:, k] - ORIGIN[k] for k, axis in enumerate("xyz")}
    with pye57.E57(str(FOLDER / "cloud.e57"), mode="w") as e57:
        e57.write_scan_raw(scan, translation=ORIGIN)


def glb():
    vertices, indices = corners.astype("<f4").tobytes(), faces.astype("<u4").tobytes()
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(corners), "type": "VEC3",
                       "min": corners.min(0).tolist(), "max": corners.max(0).tolist()},
                      {"bufferView": 1, "componentType": 5125, "count": faces.size, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": len(vertices)},
                        {"buffer": 0, "byteOffset": len(vertices), "byteLength": len(indices)}],
        "buffers": [{"byteLength": len(vertices) + len(indices)}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(vertices + indices), 0x004E4942) + vertices + indices
    return struct.pack("<III", 0x46546C67, 2, 12 + len(body)) + body


def write_3mf(path):
    vertices = "".join('<vertex x="%r" y="%r" z="%r"/>' % tuple(map(float, v)) for v in corners)
    triangles = "".join('<triangle v1="%d" v2="%d" v3="%d"/>' % tuple(f) for f in faces)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", '<?xml version="1.0" encoding="UTF-8"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
                         '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
                         '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>')
        archive.writestr("_rels/.rels", '<?xml version="1.0" encoding="UTF-8"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
                         '<Relationship Target="/3D/3dmodel.model" Id="r0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>')
        archive.writestr("3D/3dmodel.model", '<?xml version="1.0" encoding="UTF-8"?><model unit="millimeter" xml:lang="en-US" '
                         'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources><object id="1" type="model"><mesh>'
                         f'<vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh></object></resources>'
                         '<build><item objectid="1"/></build></model>')


def binary_stl():
    data = bytes(80) + struct.pack("<I", len(faces))
    for face in faces:
        a, b, c = corners[face]
        data += struct.pack("<12fH", *np.cross(b - a, c - a), *a, *b, *c, 0)
    return data


def write_meshes():
    listed = "".join(f"3 {a} {b} {c}\n" for a, b, c in faces)
    mesh("mesh.ply", ply_header("ascii", len(corners), "xyz", len(faces)) + rows(corners) + listed)
    mesh("mesh.obj", "".join("v " + line + "\n" for line in rows(corners).splitlines()) +
         "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces))
    mesh("mesh.stl", binary_stl())
    mesh("mesh.off", f"OFF\n{len(corners)} {len(faces)} 0\n" + rows(corners) + listed)
    mesh("mesh.glb", glb(), "m")
    mesh("mesh.3mf", None, "mm")
    write_3mf(FOLDER / "mesh.3mf")


def bad(name, data, what):
    put(name, data, "cloud" if name.endswith((".xyz", ".pcd", ".laz", ".e57", ".pts")) else "mesh", "bad")
    told[name]["what"] = what


def write_bad():
    text = (FOLDER / "mesh.ply").read_text()
    bad("empty.ply", "", "an empty file")
    bad("cut.ply", (FOLDER / "mesh.ply").read_bytes()[:-12], "PLY, its last triangles cut off")
    bad("index.ply", text.replace("3 0 1 4", "3 0 1 99"), "PLY, a triangle with a vertex that is not there")
    bad("nan.ply", text.replace("1.0 0.0 0.0", "nan 0.0 0.0", 1), "PLY, a coordinate that is NaN")
    bad("more.ply", text.replace("element vertex 6", "element vertex 600000000"), "PLY, more vertices promised than there are")
    bad("index.obj", (FOLDER / "mesh.obj").read_text() + "f 1 2 99\n", "OBJ, a triangle with a vertex that is not there")
    bad("cut.stl", (FOLDER / "mesh.stl").read_bytes()[:-70], "STL, cut off within a triangle")
    bad("index.off", (FOLDER / "mesh.off").read_text().replace("3 0 1 4", "3 0 1 99"), "OFF, a triangle with a vertex that is not there")
    data = (FOLDER / "mesh.glb").read_bytes()
    bad("cut.glb", data[:-30], "GLB, cut off within its indices")
    whole = (FOLDER / "mesh.3mf").read_bytes()
    bad("cut.3mf", whole[:len(whole) // 2], "3MF, cut off")
    lines = (FOLDER / "cloud.xyz").read_text().splitlines()
    bad("word.xyz", "\n".join(lines[:500] + ["691234.5 none 512.3"] + lines[500:]) + "\n", "XYZ, a word in place of a number")
    bad("comma.xyz", "\n".join(lines).replace(".", ",") + "\n", "XYZ, decimal commas")
    bad("cut.pts", f"{COUNT}\n" + "\n".join(lines[:400]) + "\n", "PTS, fewer points than it promises")
    bad("cut.pcd", (FOLDER / "cloud.pcd").read_bytes()[:9000], "PCD, cut off")
    whole = (FOLDER / "cloud.laz").read_bytes()
    bad("cut.laz", whole[:len(whole) // 2], "LAZ, cut off")
    damaged = bytearray((FOLDER / "cloud.e57").read_bytes())
    damaged[5000] ^= 0x10
    bad("flipped.e57", bytes(damaged), "E57, one bit flipped (pages have checksums)")


FOLDER.mkdir(parents=True, exist_ok=True)
write_clouds()
write_meshes()
write_bad()
(FOLDER / "inputs.json").write_text(json.dumps(told, indent=1))
