"""The package gives the bytes of the command."""

import json
import subprocess

import emax
import numpy as np
import pytest
from conftest import PEER, command, file_bytes, wave


def same_files(folder_of_command, folder, names):
    for name in names:
        assert file_bytes(folder_of_command / name) == file_bytes(folder / name), name


@pytest.fixture
def by_command(tmp_path):
    folder = tmp_path / "command"
    folder.mkdir()
    return folder


@pytest.mark.parametrize("options, words", [
    ({}, []),
    ({"two_sided": False, "effort": "quick"}, ["--bound", "one-sided", "--effort", "quick"]),
    ({"back_error": 0.02, "feature_angle": 40}, ["--back-error", "0.02", "--feature-angle", "40"]),
    ({"objective": "hoppe"}, ["--objective", "hoppe"]),
])
def test_decimate_a_file(mesh_file, by_command, tmp_path, options, words):
    command("decimate", mesh_file, "--max-error", "0.01", "-o", "small.ply", *words, folder=by_command)
    made = emax.decimate(mesh_file, 0.01, **options)
    made.save(tmp_path / "small.ply")
    same_files(by_command, tmp_path, ["small.ply", "small.ply.certificate.json"])


def test_decimate_a_mesh_to_a_cloud(mesh_file, by_command, tmp_path):
    rows = wave(12)[0].copy()
    middle = len(rows) // 2
    rows[middle:middle + 2] += [0, 0, 0.003]  # more than half of the tolerance, and not alone
    cloud = tmp_path / "cloud.xyz"
    cloud.write_text("".join(" ".join(repr(float(c)) for c in row) + "\n" for row in rows))
    command("decimate", mesh_file, "--cloud", cloud, "--max-error", "0.5%", "-o", "small.obj", folder=by_command)
    made = emax.decimate(mesh_file, "0.5%", cloud=cloud)
    made.save(tmp_path / "small.obj")
    names = [path.name for path in by_command.iterdir()]
    assert "small.obj.reference.ply" in names, "the far points were not joined"
    same_files(by_command, tmp_path, names)
    arrays = emax.decimate(wave(), "0.5%", cloud=rows)
    assert arrays.vertices.tobytes() == made.vertices.tobytes()
    assert arrays.faces.tobytes() == made.faces.tobytes()


def test_arrays_are_saved_so_that_the_command_verifies_them(mesh, tmp_path):
    for name, cloud in (("own.ply", None), ("other.off", wave(23)[0])):
        made = emax.decimate(mesh, 0.01, cloud=cloud)
        made.save(tmp_path / name)
        said = command("verify", f"{name}.certificate.json", folder=tmp_path)
        assert said.returncode == 0, said.stdout


@pytest.mark.parametrize("two_sided", [False, True])
def test_error(mesh_file, by_command, two_sided):
    words = ["--two-sided", "--reference", mesh_file] if two_sided else []
    small = by_command / "small.ply"
    command("decimate", mesh_file, "--max-error", "0.01", "-o", small, folder=by_command)
    command("error", mesh_file, small, "--max-error", "0.004", "--json", "errors.json", *words, folder=by_command)
    found = emax.error(mesh_file, small, 0.004, two_sided=two_sided, reference=mesh_file if two_sided else None)
    text = json.loads((by_command / "errors.json").read_text())
    ours = {key: value for key, value in text.items() if key in found.report}
    assert ours == found.report
    assert found.distances.max() == found.e_max == text["e_max"]
    assert found.kept is False and found.exceeding


def test_optimize(by_command, tmp_path):
    turns = np.arange(700) * 2.399963
    z = 1 - (2 * np.arange(700) + 1) / 700
    ball = np.column_stack([np.cos(turns) * np.sqrt(1 - z * z), np.sin(turns) * np.sqrt(1 - z * z), z])
    cloud = tmp_path / "ball.xyz"
    cloud.write_text("".join(" ".join(repr(float(c)) for c in row) + "\n" for row in ball))
    command("optimize", cloud, "--max-error", "1%", "--effort", "quick", "-o", "ball.ply", folder=by_command)
    seen = []
    made = emax.optimize(cloud, "1%", effort="quick", progress=seen.append)
    made.save(tmp_path / "ball.ply")
    same_files(by_command, tmp_path, ["ball.ply", "ball.ply.certificate.json", "ball.ply.reference.ply"])
    assert seen and all(isinstance(each, emax.Progress) for each in seen)
    arrays = emax.optimize(ball, "1%", effort="quick")
    assert arrays.vertices.tobytes() == made.vertices.tobytes()


def test_minimize():
    lines = subprocess.run([PEER], capture_output=True, text=True, check=True).stdout.splitlines()

    def sickle(x):
        c, d, e = x[0] - 5, x[1] - 5, x[0] - 6
        return [c * c + d * d - 100, 82.81 - (e * e + d * d)]

    g06 = emax.minimize(lambda x: (x[0] - 10) * (x[0] - 10) * (x[0] - 10) + (x[1] - 20) * (x[1] - 20) * (x[1] - 20),
                        [(13, 100), (0, 100)], {"type": "ineq", "fun": sickle}, budget=150, seed=3)

    class AtLeastHalf:
        A, lb, ub = [[1, 1]], [0.5], [np.inf]

    valley = emax.minimize(lambda x: (1 - x[0]) * (1 - x[0]) + 100 * ((x[1] - x[0] * x[0]) * (x[1] - x[0] * x[0])),
                           [(-2, 2), (-3, 3)], AtLeastHalf(), integrality=[0, 1], budget=120, seed=7, jobs=2)
    for line, found in zip(lines, (g06, valley), strict=True):
        count, objective, *genes = line.split()
        assert found.nfev == int(count)
        assert [found.fun, *found.x] == [float.fromhex(objective), *map(float.fromhex, genes)]
        assert found.success and found.constr_violation == 0
