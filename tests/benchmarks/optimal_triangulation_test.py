"""N* of known surfaces, and what quadrics fitted to their meshes make of it."""

import math
import sys
import unittest
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
import optimal_triangulation as optimal

EPSILON = 0.001


def grid(rows, columns, point, rows_closed):
    """A mesh over a grid of angles; the columns go around, and the rows where they are closed."""
    vertices = numpy.array([point(i, j) for i in range(rows) for j in range(columns)])
    i, j = numpy.meshgrid(numpy.arange(rows if rows_closed else rows - 1), numpy.arange(columns), indexing="ij")
    below, right = (i + 1) % rows, (j + 1) % columns
    a, b, c, d = (k.ravel() for k in (i * columns + j, below * columns + j, below * columns + right, i * columns + right))
    return vertices, numpy.concatenate([numpy.stack([a, b, c], 1), numpy.stack([a, c, d], 1)])


def torus(around=120, across=60, tube=0.35):
    def point(i, j):
        u, v = 2 * math.pi * i / around, 2 * math.pi * j / across
        radius = 1 + tube * math.cos(v)
        return radius * math.cos(u), radius * math.sin(u), tube * math.sin(v)
    return grid(around, across, point, True)


def band(width=1, rows=25, columns=160):
    """The sphere between two latitudes, its area 4 pi sin(width / 2)."""
    def point(i, j):
        u, v = width * (i / (rows - 1) - 0.5), 2 * math.pi * j / columns
        return math.cos(u) * math.cos(v), math.cos(u) * math.sin(v), math.sin(u)
    return grid(rows, columns, point, False)


class OptimalTriangulationTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.fitted = optimal.of_mesh(*torus())

    def test_known_surfaces_have_the_known_numbers(self):
        for name, wanted in (("sphere", 2418), ("smooth-torus", 3587), ("ellipsoid", 1578)):
            self.assertEqual(round(optimal.triangles(*optimal.SURFACES[name](), EPSILON)), wanted, name)

    def test_a_thicker_torus_needs_more(self):
        self.assertGreater(optimal.triangles(*optimal.SURFACES["torus"](), EPSILON), 3587)

    def test_an_ellipsoid_of_equal_axes_is_a_sphere(self):
        for radius in (1, 3):
            self.assertAlmostEqual(optimal.ellipsoid(radius, radius, radius)[0], optimal.sphere(radius)[0], 4)

    def test_the_number_goes_as_one_over_the_tolerance(self):
        self.assertAlmostEqual(optimal.triangles(3, 2, EPSILON / 10), 10 * optimal.triangles(3, 2, EPSILON))

    def test_fits_to_a_mesh_come_near_the_integral(self):
        exact = optimal.torus()
        for fitted in self.fitted:
            for kind in range(2):
                self.assertAlmostEqual(fitted[kind] / exact[kind], 1, delta=0.04)

    def test_borders_and_the_place_do_not_matter(self):
        vertices, faces = band()
        for scale in (1, 1e-3):
            for convex, saddle in optimal.of_mesh(scale * vertices + 5, faces):
                self.assertAlmostEqual(convex / (scale * 4 * math.pi * math.sin(0.5)), 1, delta=0.02)
                self.assertLess(saddle, 0.01 * convex)

    def test_a_plane_needs_next_to_nothing(self):
        vertices, faces = torus()
        vertices[:, 2] = 0
        convex, saddle = optimal.of_mesh(vertices, faces, [2])[0]
        self.assertLess(convex + saddle, 1e-3 * sum(optimal.torus()))

    def test_fits_do_not_depend_on_the_chunks(self):
        chunk, optimal.CHUNK = optimal.CHUNK, 777
        try:
            numpy.testing.assert_allclose(optimal.of_mesh(*torus()), self.fitted, rtol=1e-9)
        finally:
            optimal.CHUNK = chunk

    def test_a_lost_factor_is_seen_fault(self):
        exact = optimal.torus()
        for fitted in self.fitted:
            self.assertGreater(abs(math.sqrt(2) * fitted[0] / exact[0] - 1), 0.04)


if __name__ == "__main__":
    unittest.main()
