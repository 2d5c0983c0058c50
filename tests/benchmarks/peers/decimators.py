"""One decimator from PyPI in a process of its own, for emax_decimation_benchmark.

usage: decimators.py TOOL FOLDER. The protocol stands in tests/benchmarks/decimation/external_tool.h.
A tool has a name, a package, and sets of options: (name, what is bisected, settings). `prepared`
makes the tool's own form of the start, which is not timed; `run` is timed; `arrays` brings the
result back.
"""

import json
import os
import sys
import time
from importlib.metadata import version
from pathlib import Path

# One thread: what the libraries start beside it shares its processor.
os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
for name in ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "TBB_NUM_THREADS"]:
    os.environ[name] = "1"

import numpy

TRIANGLES, TOLERANCE = "triangles", "tolerance"


class Pyfqmr:
    name, package = "pyfqmr", "pyfqmr"
    # The threshold of pass i is alpha (i + 3)^aggressiveness, in squares of the mesh's unit. With the
    # standard alpha that of the first pass is coarser than most tolerances here.
    sets = [(f"aggressiveness {aggressiveness}, alpha {alpha:g}", TRIANGLES,
             {"aggressiveness": aggressiveness, "alpha": alpha, "preserve_border": False})
            for aggressiveness, alpha in [(4, 1e-9), (7, 1e-17), (5, 1e-13), (3, 1e-9), (2, 1e-9), (7, 1e-9)]]
    sets += [("aggressiveness 4, alpha 1e-9, preserve_border", TRIANGLES,
              {"aggressiveness": 4, "alpha": 1e-9, "preserve_border": True}),
             ("lossless, threshold", TOLERANCE, None)]

    def prepared(self, vertices, triangles):
        import pyfqmr
        mesh = pyfqmr.Simplify()
        mesh.setMesh(vertices, triangles)
        return mesh

    def run(self, mesh, settings, parameter):
        if settings is None:
            mesh.simplify_mesh_lossless(verbose=False, epsilon=parameter**2)
        else:
            mesh.simplify_mesh(target_count=int(parameter), verbose=False, **settings)
        return mesh

    def arrays(self, mesh):
        return mesh.getMesh()[:2]


class FastSimplification:
    name, package = "fast-simplification", "fast-simplification"
    sets = [(f"agg {agg:g}", TRIANGLES, agg) for agg in [4, 5, 3, 2, 7]]

    def prepared(self, vertices, triangles):
        import fast_simplification
        self.simplify = fast_simplification.simplify
        return vertices, triangles

    def run(self, mesh, agg, parameter):
        return self.simplify(*mesh, target_count=int(parameter), agg=agg)

    def arrays(self, mesh):
        return mesh


class Manifold:
    name, package = "Manifold", "manifold3d"
    sets = [("simplify", TOLERANCE, None)]

    def prepared(self, vertices, triangles):
        import manifold3d
        solid = manifold3d.Manifold(manifold3d.Mesh64(vertices, triangles.astype(numpy.uint64)))
        if solid.status() != manifold3d.Error.NoError:
            raise ValueError(f"it takes closed manifolds alone ({solid.status().name})")
        return solid

    def run(self, solid, _, parameter):
        result = solid.simplify(parameter)
        result.num_tri()  # what was asked for is computed when it is used
        return result

    def arrays(self, solid):
        mesh = solid.to_mesh64()
        return mesh.vert_properties[:, :3], mesh.tri_verts


class Meshlab:
    name, package = "MeshLab quadric edge collapse", "pymeshlab"
    sets = [("standard", TRIANGLES, {}),
            ("preservenormal, preservetopology", TRIANGLES, {"preservenormal": True, "preservetopology": True}),
            ("qualitythr 1, preservenormal", TRIANGLES, {"qualitythr": 1, "preservenormal": True}),
            ("qualitythr 0.1", TRIANGLES, {"qualitythr": 0.1}),
            ("planarquadric", TRIANGLES, {"planarquadric": True}),
            ("planarquadric, planarweight 1e-5", TRIANGLES, {"planarquadric": True, "planarweight": 1e-5}),
            ("preserveboundary, preservenormal", TRIANGLES, {"preserveboundary": True, "preservenormal": True})]

    def prepared(self, vertices, triangles):
        import pymeshlab
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(vertices, triangles))
        return meshes

    def run(self, meshes, settings, parameter):
        meshes.apply_filter("meshing_decimation_quadric_edge_collapse", targetfacenum=int(parameter), **settings)
        return meshes

    def arrays(self, meshes):
        return meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()


TOOLS = {"pyfqmr": Pyfqmr, "fast-simplification": FastSimplification, "manifold": Manifold, "meshlab": Meshlab}


def read(folder):
    vertices = numpy.fromfile(folder / "vertices.f64").reshape(-1, 3)
    return vertices, numpy.fromfile(folder / "triangles.u32", numpy.uint32).reshape(-1, 3).astype(numpy.int32)


def write(folder, vertices, triangles):
    numpy.ascontiguousarray(vertices, numpy.float64).tofile(folder / "vertices.f64")
    numpy.ascontiguousarray(triangles, numpy.uint32).tofile(folder / "triangles.u32")


def called(tool, folder, request):
    """The mesh is written; the processor time that the call took."""
    mesh = tool.prepared(*read(folder / "start"))
    settings = tool.sets[request["set"]][2]
    before = time.process_time()
    result = tool.run(mesh, settings, request["parameter"])
    seconds = time.process_time() - before
    write(folder / "result", *tool.arrays(result))
    return {"seconds": seconds}


def answered(give):
    """What it gives, or why it cannot."""
    try:
        return give()
    except Exception as error:  # whatever a package cannot do is said in the table
        return {"failure": " ".join(str(error).split())[:100] or type(error).__name__}


def greeting(tool):
    sets = [{"name": name, "parameter": parameter} for name, parameter, _ in tool.sets]
    return {"name": tool.name, "version": version(tool.package), "sets": sets}


def serve(tool, folder, requests, answers):
    def say(answer):
        answers.write(json.dumps(answer) + "\n")
        answers.flush()
    say(answered(lambda: greeting(tool)))
    for line in requests:
        say(answered(lambda: called(tool, folder, json.loads(line))))


def main():
    # What the libraries print goes to standard error, away from the answers.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    serve(TOOLS[sys.argv[1]](), Path(sys.argv[2]), sys.stdin, answers)


if __name__ == "__main__":
    main()
