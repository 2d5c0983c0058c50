"""tools.py TOOL read FILE KIND | TOOL write MESH OUTPUT: one file by one library of Python, in a process of its own. Prints
as JSON what the library says it has read: points, triangles, and the extent."""

import json
import sys


def extent(vertices, triangles):
    import numpy
    vertices = numpy.asarray(vertices, float).reshape(-1, 3)
    if len(vertices) == 0:
        return {"points": 0, "triangles": 0}
    return {"points": len(vertices), "triangles": triangles, "low": vertices.min(0).tolist(), "high": vertices.max(0).tolist()}


class MeshLab:
    @staticmethod
    def read(path, kind):
        import pymeshlab
        meshes = pymeshlab.MeshSet()
        meshes.load_new_mesh(path)
        return extent(meshes.current_mesh().transformed_vertex_matrix(), meshes.current_mesh().face_number())

    @staticmethod
    def write(mesh, output):
        import pymeshlab
        meshes = pymeshlab.MeshSet()
        meshes.load_new_mesh(mesh)
        meshes.save_current_mesh(output)


class Open3d:
    @staticmethod
    def read(path, kind):
        import open3d
        if kind == "cloud":
            return extent(open3d.io.read_point_cloud(path).points, 0)
        read = open3d.io.read_triangle_mesh(path)
        return extent(read.vertices, len(read.triangles))

    @staticmethod
    def write(mesh, output):
        import open3d
        read = open3d.io.read_triangle_mesh(mesh)
        read.compute_triangle_normals()  # its STL needs them
        if not open3d.io.write_triangle_mesh(output, read):
            sys.exit("not written")


def main():
    tool = {"meshlab": MeshLab, "open3d": Open3d}[sys.argv[1]]
    if sys.argv[2] == "read":
        print("\n" + json.dumps(tool.read(*sys.argv[3:])))
    else:
        tool.write(*sys.argv[3:])


main()
