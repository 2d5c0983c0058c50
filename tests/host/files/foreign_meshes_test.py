"""foreign_meshes_test.py CONVERT NODE VALIDATOR [--fault]: GLB, 3MF and DXF files of emax, read by trimesh,
lib3mf and ezdxf, and files of trimesh and lib3mf, read by emax. CONVERT is the program of
convert_mesh.cpp, VALIDATOR the folder of gltf-validator, a package for the program NODE. With
--fault a bit of each expected coordinate is wrong, which must be seen."""

import logging
import subprocess
import sys
import tempfile
from pathlib import Path

import ezdxf
import lib3mf
import numpy as np
import trimesh

CONVERT, NODE, VALIDATOR = sys.argv[1:4]
FAULT = "--fault" in sys.argv
checks = 0
logging.disable()  # trimesh tells at length that it does without SciPy


def expect(holds, what):
    global checks
    checks += 1
    if not holds:
        raise SystemExit(f"foreign meshes: {what}")


def expect_equal(what, found, expected):
    expected = np.ascontiguousarray(expected, "<f8")
    if FAULT:
        expected = (expected.view("<u8") ^ np.uint64(1)).view("<f8")
    found = np.ascontiguousarray(found, "<f8")
    expect(found.shape == expected.shape, f"{what}: shape {found.shape}, not {expected.shape}")
    expect(np.array_equal(found, expected), f"{what}: other coordinates")


def convert(source, target, *unit):
    done = subprocess.run([CONVERT, source, target, *unit], capture_output=True, text=True, timeout=60)
    expect(done.returncode == 0, f"{source}: {done.stderr}")
    return done.stdout.strip()


def faults_of_glb(path):
    """What gltf-validator says of the file."""
    done = subprocess.run([NODE, Path(__file__).parent / "validate_glb.js", VALIDATOR, path],
                          capture_output=True, text=True, timeout=60)
    expect(done.returncode == 0, f"{path}: gltf-validator: {done.stderr}")
    return done.stdout


def write_off(path, vertices, triangles):
    lines = ["OFF", f"{len(vertices)} {len(triangles)} 0"]
    lines += [" ".join(repr(float(c)) for c in v) for v in vertices]
    lines += ["3 " + " ".join(map(str, t)) for t in triangles]
    path.write_text("\n".join(lines) + "\n")


def read_off(path):
    lines = path.read_text().split("\n")
    count, faces, _ = map(int, lines[1].split())
    vertices = np.array([line.split() for line in lines[2:2 + count]], float)
    triangles = np.array([line.split()[1:] for line in lines[2 + count:2 + count + faces]], int)
    return vertices, triangles


def sphere():
    mesh = trimesh.creation.icosphere(subdivisions=3)
    random = np.random.default_rng(24)
    return np.asarray(mesh.vertices) * 40 + random.normal(scale=0.01, size=mesh.vertices.shape), mesh.faces


def corner_sets(mesh):
    """The triangles whatever their order, and that of their corners, within a rounding."""
    return sorted(sorted(map(tuple, np.round(t, 6) + 0.0)) for t in mesh.triangles)


def check_written_glb(folder, vertices, triangles):
    """In metres and with y up the mesh must have its size and stand upright."""
    scales = {"mm": 1e-3, "cm": 1e-2, "m": 1, "in": 0.0254, "ft": 0.3048, "us-ft": 1200 / 3937, "um": 1e-6}
    for unit, scale in scales.items():
        path = folder / f"{unit}.glb"
        shifted = vertices + [5e5, -4e6, 100]
        write_off(folder / "glb.off", shifted, triangles)
        convert(folder / "glb.off", path, unit)
        faults = faults_of_glb(path)
        expect(faults == "", f"{path}: {faults}")
        scene = trimesh.load_scene(path)
        expect(len(scene.geometry) == 1, f"{path}: {scene.geometry}")
        (name,) = scene.graph.nodes_geometry
        matrix, geometry = scene.graph[name]
        mesh = scene.geometry[geometry]
        expect(np.array_equal(mesh.faces, triangles), f"{path}: other triangles")
        origin = shifted.min(axis=0)
        expect_equal(path.name, mesh.vertices, (shifted - origin).astype("<f4"))
        world = np.asarray(mesh.vertices) @ matrix[:3, :3].T + matrix[:3, 3]
        there = np.stack([shifted[:, 0], shifted[:, 2], -shifted[:, 1]], axis=1) * scale
        expect(np.allclose(world, there, rtol=0, atol=1e-5 * scale), f"{path}: not in its place")
        expect(convert(path, folder / "again.off") == unit, f"{path}: another unit")
        again, faces = read_off(folder / "again.off")
        expect_equal("again", again, origin + (shifted - origin).astype("<f4").astype(float))
        expect(np.array_equal(faces, triangles), f"{path}: other triangles read again")


def check_the_validator(folder):
    """It must see a vertex outside of the bounds that the file states."""
    wrong = (folder / "m.glb").read_bytes()
    at = wrong.index(b'"min":[0.0') + len(b'"min":[')
    (folder / "wrong.glb").write_bytes(wrong[:at] + b"9" + wrong[at + 1:])
    expect("ACCESSOR_MIN_MISMATCH" in faults_of_glb(folder / "wrong.glb"), "the validator sees no fault")


def check_read_glb(folder, vertices, triangles):
    scene = trimesh.Scene()
    mesh = trimesh.Trimesh(vertices, triangles, process=False)
    turned = trimesh.transformations.rotation_matrix(0.5, [1, 2, 3])
    turned[:3, 3] = [100, 0, -3]
    scene.add_geometry(mesh, transform=turned)
    scene.add_geometry(trimesh.creation.box((1, 2, 3)), transform=trimesh.transformations.scale_matrix(-2))
    path = folder / "foreign.glb"
    path.write_bytes(scene.export(file_type="glb", include_normals=True))
    expect(convert(path, folder / "foreign.off") == "m", f"{path}: not in metres")
    found, faces = read_off(folder / "foreign.off")
    whole = trimesh.load_scene(path).to_mesh()
    expect(len(faces) == len(triangles) + 12, f"{path}: {len(faces)} triangles")
    ours = trimesh.Trimesh(found, faces, process=False)
    expect(corner_sets(ours) == corner_sets(whole), f"{path}: triangles elsewhere")
    expect(ours.is_watertight and ours.volume > 0, f"{path}: seams are open, or a mirrored part is inside out")


def check_3mf(folder, vertices, triangles):
    wrapper = lib3mf.get_wrapper()
    names = {"mm": "MilliMeter", "cm": "CentiMeter", "m": "Meter", "in": "Inch", "ft": "Foot", "um": "MicroMeter"}
    write_off(folder / "3mf.off", vertices, triangles)
    for unit, name in names.items():
        path = folder / f"{unit}.3mf"
        convert(folder / "3mf.off", path, unit)
        model = wrapper.CreateModel()
        reader = model.QueryReader("3mf")
        reader.SetStrictModeActive(True)
        reader.ReadFromFile(str(path))
        expect(reader.GetWarningCount() == 0, f"{path}: lib3mf warns")
        expect(model.GetUnit() == getattr(lib3mf.ModelUnit, name), f"{path}: {model.GetUnit()}")
        objects = model.GetMeshObjects()
        expect(objects.MoveNext(), f"{path}: no mesh")
        mesh = objects.GetCurrentMeshObject()
        expect(mesh.IsManifoldAndOriented(), f"{path}: not manifold for lib3mf")
        found = np.array([list(v.Coordinates) for v in mesh.GetVertices()])
        # lib3mf keeps 32 bits.
        expect_equal(path.name, found, vertices.astype("<f4"))
        expect([list(t.Indices) for t in mesh.GetTriangleIndices()] == triangles.tolist(), f"{path}: other triangles")
        expect(convert(path, folder / "again.off") == unit, f"{path}: another unit")
        expect_equal("again", read_off(folder / "again.off")[0], vertices)

    # Components in components, moved, and two items.
    model = wrapper.CreateModel()
    model.SetUnit(lib3mf.ModelUnit.Inch)
    mesh = model.AddMeshObject()
    mesh.SetGeometry([lib3mf.Position(tuple(v)) for v in vertices.astype("<f4")],
                     [lib3mf.Triangle(tuple(int(i) for i in t)) for t in triangles])
    inner, outer = model.AddComponentsObject(), model.AddComponentsObject()
    inner.AddComponent(mesh, wrapper.GetTranslationTransform(1, 2, 3))
    outer.AddComponent(inner, wrapper.GetUniformScaleTransform(2))
    outer.AddComponent(mesh, wrapper.GetIdentityTransform())
    model.AddBuildItem(outer, wrapper.GetTranslationTransform(0, 0, 100))
    model.AddBuildItem(mesh, wrapper.GetIdentityTransform())
    path = folder / "foreign.3mf"
    model.QueryWriter("3mf").WriteToFile(str(path))
    expect(convert(path, folder / "foreign.off") == "in", f"{path}: another unit")
    found, faces = read_off(folder / "foreign.off")
    expect(len(faces) == 3 * len(triangles), f"{path}: {len(faces)} triangles")
    single = vertices.astype("<f4").astype(float)
    placed = np.concatenate([(single + [1, 2, 3]) * 2 + [0, 0, 100], single + [0, 0, 100], single])
    expect(np.allclose(found, placed, rtol=0, atol=2e-4), f"{path}: not in its place")  # written with few digits


def check_dxf(folder, vertices, triangles):
    codes = {"mm": 4, "cm": 5, "m": 6, "in": 1, "ft": 2, "us-ft": 21, "um": 13}
    write_off(folder / "dxf.off", vertices, triangles)
    for unit, code in codes.items():
        path = folder / f"{unit}.dxf"
        convert(folder / "dxf.off", path, unit)
        drawing = ezdxf.readfile(path)
        expect(drawing.header["$INSUNITS"] == code, f"{path}: {drawing.header['$INSUNITS']}")
        expect(not drawing.audit().has_errors, f"{path}: ezdxf finds errors")
        faces = list(drawing.modelspace().query("3DFACE"))
        corners = np.array([[list(f.dxf.vtx0), list(f.dxf.vtx1), list(f.dxf.vtx2)] for f in faces])
        expect_equal(path.name, corners, vertices[triangles])
        expect(all(f.dxf.vtx3 == f.dxf.vtx2 for f in faces), f"{path}: four corners")
        expect(convert(path, folder / "again.off") == unit, f"{path}: another unit")
    drawing = ezdxf.new("R2010", units=6)
    for triangle in vertices[triangles]:
        drawing.modelspace().add_3dface([tuple(p) for p in triangle])
    drawing.saveas(folder / "foreign.dxf")
    expect(convert(folder / "foreign.dxf", folder / "foreign.off") == "m", "foreign.dxf: another unit")
    found, faces = read_off(folder / "foreign.off")
    expect(len(found) == len(vertices), "foreign.dxf: vertices are not merged")
    expect(np.allclose(found[faces], vertices[triangles], rtol=0, atol=1e-9), "foreign.dxf: elsewhere")


def main():
    vertices, triangles = sphere()
    with tempfile.TemporaryDirectory(prefix="emax_meshes_") as name:
        folder = Path(name)
        check_written_glb(folder, vertices, triangles)
        check_the_validator(folder)
        check_read_glb(folder, vertices, triangles)
        check_3mf(folder, vertices, triangles)
        check_dxf(folder, vertices, triangles)
    print(f"foreign meshes: {checks} checks hold")


main()
