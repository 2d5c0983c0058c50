"""Arrays that are wrong, arrays that are unusual, and objects of other packages."""

import pathlib
import subprocess
import sys
import types

import emax
import numpy as np
import pytest
import trimesh
from conftest import wave


def test_results_share_memory_and_cannot_be_changed(mesh):
    made = emax.decimate(mesh, 0.01)
    assert np.shares_memory(made.vertices, made._made.vertices)
    assert made.vertices.dtype == np.float64 and made.faces.dtype == np.uint32
    with pytest.raises(ValueError, match="read-only"):
        made.vertices[0] = 0
    vertices = made.vertices
    before = vertices.copy()
    del made
    assert (vertices == before).all(), "the array keeps its memory"


@pytest.mark.parametrize("change", [
    lambda v, f: (np.asfortranarray(v), f),
    lambda v, f: (v[::1][:, ::-1][:, ::-1], f.astype(np.int64)),
    lambda v, f: (v, f.astype(np.int16)),
    lambda v, f: (v.tolist(), f.tolist()),
])
def test_any_layout_gives_the_same(mesh, change):
    plain = emax.decimate(mesh, 0.01)
    other = emax.decimate(change(*mesh), 0.01)
    assert plain.vertices.tobytes() == other.vertices.tobytes()


def test_read_only_arrays_are_taken(mesh):
    for array in mesh:
        array.flags.writeable = False
    assert len(emax.decimate(mesh, 0.01).faces) < len(mesh[1])


@pytest.mark.parametrize("change, text", [
    (lambda v, f: (v[:, :2], f), r"vertices: an array of shape \(n, 3\)"),
    (lambda v, f: (v, f[:, :2]), r"faces: an array of shape \(m, 3\)"),
    (lambda v, f: (v, f.astype(float)), "faces: whole numbers"),
    (lambda v, f: (v.astype(complex), f), "vertices: numbers"),
    (lambda v, f: (v.astype(str), f), "vertices: numbers"),
    (lambda v, f: (np.empty((0, 3)), f), "no points"),
    (lambda v, f: (v, np.empty((0, 3), int)), "no triangles"),
    (lambda v, f: (v, f.astype(int) - 1), "below 0"),
    (lambda v, f: (np.where(np.arange(len(v))[:, None] == 7, np.nan, v), f), "point 7 is not finite"),
    (lambda v, f: 5, "a path, a pair"),
])
def test_wrong_meshes_are_a_value_error(mesh, change, text):
    with pytest.raises(ValueError, match=text):
        emax.decimate(change(*mesh), 0.01)


def test_what_only_emax_can_judge_is_its_error(mesh, tmp_path):
    vertices, faces = mesh
    with pytest.raises(emax.Error, match="has the index 99999"):
        emax.decimate((vertices, np.full((1, 3), 99999)), 0.01)
    with pytest.raises(emax.Error, match="max_error .* no less than the width"):
        emax.decimate(mesh, 5)
    with pytest.raises(emax.Error, match="missing.ply"):
        emax.error(tmp_path / "missing.ply", mesh)
    with pytest.raises(emax.Error, match="would round"):
        emax.decimate(mesh, 0.01).save(tmp_path / "small.stl")
    assert list(tmp_path.iterdir()) == [], "something was written"
    for wrong in (0, -1, np.nan):
        with pytest.raises(ValueError, match="max_error: a positive number"):
            emax.decimate(mesh, wrong)
    with pytest.raises(ValueError, match="effort: one of"):
        emax.decimate(mesh, 0.01, effort="hard")
    with pytest.raises(emax.Error, match="too few for a surface"):
        emax.error([[0, 0, 0], [1, 1, 1]], mesh)


def test_verify_says_no(mesh):
    made = emax.decimate(mesh, 0.01)
    assert emax.verify(made, cloud=mesh)
    assert not emax.verify(made, mesh=(made.vertices + [0, 0, 1e-3], made.faces), cloud=mesh)
    claims = dict(made.certificate, e_max=made.e_max / 2)
    assert "claims e_max" in emax.verify(claims, made, mesh, made.reference or mesh).reasons[0]
    with pytest.raises(emax.Error, match="give that mesh"):
        emax.verify(made, reference=mesh)


def test_trimesh_goes_in_and_out(mesh):
    plain = emax.decimate(mesh, 0.01)
    given = emax.decimate(trimesh.Trimesh(*mesh, process=False), 0.01)
    assert plain.vertices.tobytes() == given.vertices.tobytes()
    back = plain.to_trimesh()
    assert isinstance(back, trimesh.Trimesh)
    assert back.vertices.tobytes() == plain.vertices.tobytes() and (back.faces == plain.faces).all()
    cloud = trimesh.PointCloud(mesh[0])
    assert (emax.error(cloud, mesh).distances == emax.error(mesh[0], mesh).distances).all()


# Stand-ins with the attributes that emax uses of Open3D and PyVista, which are too large for tests.
def test_stand_ins_of_open3d(mesh, monkeypatch):
    vertices, faces = mesh
    given = types.SimpleNamespace(vertices=vertices, triangles=faces.astype(np.int32))
    plain = emax.decimate(mesh, 0.01)
    assert emax.decimate(given, 0.01).vertices.tobytes() == plain.vertices.tobytes()
    cloud = types.SimpleNamespace(points=vertices)
    assert emax.error(cloud, plain).e_max == plain.e_max
    module = types.ModuleType("open3d")
    module.geometry = types.SimpleNamespace(TriangleMesh=lambda v, t: types.SimpleNamespace(vertices=v, triangles=t))
    module.utility = types.SimpleNamespace(Vector3dVector=np.asarray, Vector3iVector=np.asarray)
    monkeypatch.setitem(sys.modules, "open3d", module)
    back = plain.to_open3d()
    assert back.triangles.dtype == np.int32 and (back.triangles == plain.faces).all()


def test_stand_ins_of_pyvista(mesh, monkeypatch):
    vertices, faces = mesh
    rows = np.column_stack([np.full(len(faces), 3), faces]).ravel()
    given = types.SimpleNamespace(points=vertices, faces=rows)
    plain = emax.decimate(mesh, 0.01)
    assert emax.decimate(given, 0.01).vertices.tobytes() == plain.vertices.tobytes()
    with pytest.raises(ValueError, match="triangulate"):
        emax.decimate(types.SimpleNamespace(points=vertices, faces=np.array([4, 0, 1, 2, 3])), 0.01)
    module = types.ModuleType("pyvista")
    module.PolyData = lambda points, faces: types.SimpleNamespace(points=points, faces=faces)
    monkeypatch.setitem(sys.modules, "pyvista", module)
    back = plain.to_pyvista()
    assert (back.faces.reshape(-1, 4)[:, 1:] == plain.faces).all()


def test_the_stub_is_that_of_the_module(tmp_path):
    made = tmp_path / "_core.pyi"
    subprocess.run([sys.executable, "-m", "nanobind.stubgen", "-q", "-m", "emax._core", "-o", made], check=True)
    ours = pathlib.Path(emax.__file__).parent / "_core.pyi"
    # Anew: python -m nanobind.stubgen -m emax._core -o host/python/emax/_core.pyi
    assert made.read_text() == ours.read_text()
