"""N*, the fewest triangles of a free triangulation within ±ε of a smooth surface, as ε goes to 0.

    N* = ∫ √K dA / (3√3 ε) where K > 0, plus ∫ √|K| dA / (4.6 ε) where K < 0

K is the Gaussian curvature. Pottmann, Krasauskas, Hamann, Joy and Seibold, "On piecewise linear
approximation of quadratic functions" (2000), gives the triangle of greatest area over a quadratic
function; Atariah, Rote and Wintraecken, "Optimal triangulation of saddle surfaces" (2018), the
constant of saddles. A triangulation that is less than two-sided, or an ε beyond the surface's
details, may need fewer.

usage: optimal_triangulation.py EPSILON SURFACE | FOLDER. SURFACE is sphere, smooth-torus,
torus or ellipsoid; FOLDER holds a mesh as tests/benchmarks/decimation/raw_mesh.h has it. Prints JSON.
"""

import json
import math
import sys
from pathlib import Path

import numpy

CONVEX, SADDLE = 3 * math.sqrt(3), 4.6
RINGS = [2, 3, 4]  # of neighbours that a quadric is fitted to; the spread shows what the choice changes
CHUNK = 20000  # vertices fitted together, which bounds the memory
STEPS = 2000  # of an integral over a known surface


def triangles(convex, saddle, epsilon):
    """From the integrals of √|K| over both kinds of points."""
    return (convex / CONVEX + saddle / SADDLE) / epsilon


def midpoints(length):
    return (numpy.arange(STEPS) + 0.5) * (length / STEPS)


def sphere(radius=1.0):
    return 4 * math.pi * radius, 0.0


def torus(axis=1.0, tube=0.35):
    """√|K| dA = √(tube |cos v| (axis + tube cos v)) du dv."""
    cosines = numpy.cos(midpoints(2 * math.pi))
    values = numpy.sqrt(tube * abs(cosines) * (axis + tube * cosines)) * (2 * math.pi) ** 2 / STEPS
    return values[cosines > 0].sum(), values[cosines < 0].sum()


def ellipsoid(a=1.0, b=0.7, c=0.45):
    """√K dA = sin θ / √(x²/a⁴ + y²/b⁴ + z²/c⁴) dθ dφ."""
    theta, phi = midpoints(math.pi)[:, None], midpoints(2 * math.pi)[None]
    weights = (numpy.sin(theta) * numpy.cos(phi) / a) ** 2 + (numpy.sin(theta) * numpy.sin(phi) / b) ** 2
    weights = weights + (numpy.cos(theta) / c) ** 2
    return (numpy.sin(theta) / numpy.sqrt(weights)).sum() * 2 * (math.pi / STEPS) ** 2, 0.0


SURFACES = {"sphere": sphere, "smooth-torus": torus, "torus": lambda: torus(tube=0.4), "ellipsoid": ellipsoid}


def vertex_areas_and_normals(vertices, faces):
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    crosses = numpy.cross(b - a, c - a)
    areas, normals = numpy.zeros(len(vertices)), numpy.zeros(vertices.shape)
    for k in range(3):
        areas += numpy.bincount(faces[:, k], numpy.linalg.norm(crosses, axis=1) / 6, len(vertices))
        for axis in range(3):
            normals[:, axis] += numpy.bincount(faces[:, k], crosses[:, axis], len(vertices))
    lengths = numpy.linalg.norm(normals, axis=1)
    return areas, normals / numpy.where(lengths > 0, lengths, 1)[:, None]


class Adjacency:
    """The neighbours of each vertex: `flat` from `first` on, `count` of them."""

    def __init__(self, vertices, faces):
        edges = numpy.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).astype(numpy.int64)
        edges = numpy.concatenate([edges, edges[:, ::-1]])
        keys = numpy.unique(edges[:, 0] * vertices + edges[:, 1])
        self.size, self.flat = vertices, keys % vertices
        self.count = numpy.bincount(keys // vertices, minlength=vertices)
        self.first = numpy.cumsum(self.count) - self.count

    def next_ring(self, inner, ring):
        """Of pairs centre * size + vertex, both sorted: the neighbours of `ring` that are in neither."""
        centres, at = ring // self.size, ring % self.size
        count = self.count[at]
        within = numpy.arange(count.sum()) - numpy.repeat(numpy.cumsum(count) - count, count)
        reached = self.flat[numpy.repeat(self.first[at], count) + within]
        reached = numpy.unique(numpy.repeat(centres, count) * self.size + reached)
        for known in (inner, ring):
            place = numpy.minimum(numpy.searchsorted(known, reached), len(known) - 1)
            reached = reached[known[place] != reached] if len(known) else reached
        return reached


def curvatures(vertices, normals, pairs, centres):
    """K at each centre, of z = a x² + b xy + c y² + d x + e y + f fitted to its neighbours."""
    of, at = pairs // len(vertices), pairs % len(vertices)
    facing = numpy.einsum("ij,ij->i", normals[of], normals[at]) > 0  # not the other side of a thin part
    of, at = of[facing], at[facing]
    normal = normals[of]
    axis = numpy.eye(3)[numpy.argmin(abs(normal), axis=1)]
    first = numpy.cross(normal, axis)
    first /= numpy.linalg.norm(first, axis=1)[:, None]
    second = numpy.cross(normal, first)
    offset = vertices[at] - vertices[of]
    row = of - centres.start
    count = numpy.bincount(row, minlength=len(centres))
    size = numpy.sqrt(numpy.bincount(row, (offset**2).sum(1), len(centres)) / numpy.maximum(count, 1))
    size[size == 0] = 1
    x, y, z = (numpy.einsum("ij,ij->i", offset, d) / size[row] for d in (first, second, normal))
    terms = [x * x, x * y, y * y, x, y, numpy.ones(len(x))]
    matrix, right = numpy.zeros((len(centres), 6, 6)), numpy.zeros((len(centres), 6, 1))
    for i, term in enumerate(terms):
        right[:, i, 0] = numpy.bincount(row, term * z, len(centres))
        for k in range(i + 1):
            matrix[:, i, k] = matrix[:, k, i] = numpy.bincount(row, term * terms[k], len(centres))
    matrix += 1e-9 * numpy.eye(6)  # too few neighbours or all on a conic
    a, b, c, d, e = numpy.linalg.solve(matrix, right)[:, :5, 0].T
    return (4 * a * c - b * b) / (1 + d * d + e * e) ** 2 / size**2


def of_mesh(vertices, faces, rings=None):
    """The two integrals for each number of rings."""
    areas, normals = vertex_areas_and_normals(vertices, faces)
    adjacency = Adjacency(len(vertices), faces)
    rings = rings or RINGS
    sums = numpy.zeros((len(rings), 2))
    for begin in range(0, len(vertices), CHUNK):
        centres = range(begin, min(begin + CHUNK, len(vertices)))
        shells = [numpy.array([], numpy.int64), numpy.arange(centres.start, centres.stop) * (len(vertices) + 1)]
        for ring in range(1, max(rings) + 1):
            shells.append(adjacency.next_ring(*shells[-2:]))
            if ring in rings:
                curvature = curvatures(vertices, normals, numpy.concatenate(shells), centres)
                roots = numpy.sqrt(abs(curvature)) * areas[centres.start:centres.stop]
                sums[rings.index(ring)] += roots[curvature > 0].sum(), roots[curvature < 0].sum()
    return sums


def read(folder):
    return (numpy.fromfile(folder / "vertices.f64").reshape(-1, 3),
            numpy.fromfile(folder / "triangles.u32", numpy.uint32).reshape(-1, 3).astype(numpy.int64))


def main():
    epsilon, source = float(sys.argv[1]), sys.argv[2]
    if source in SURFACES:
        found = [triangles(*SURFACES[source](), epsilon)]
    else:
        found = sorted(triangles(*sums, epsilon) for sums in of_mesh(*read(Path(source))))
    print(json.dumps({"triangles": round(found[len(found) // 2]), "least": round(found[0]), "greatest": round(found[-1])}))


if __name__ == "__main__":
    main()
